//! What is put on top of an ordinary car: signs and lights.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::Material;

use super::car::CarPlan;
use super::palette::Palette;
use crate::shape::{Model, Prism, Shape};

/// Nothing.
pub(crate) fn none(_: &mut Model, _: &Palette, _: &CarPlan) {}

/// A lit sign on the roof.
pub(crate) fn taxi(model: &mut Model, palette: &Palette, plan: &CarPlan) {
    let (s, z) = plan.profile.peak;
    let sign = Shape::rounded_block(vec3(0.2, 0.7, 0.14), 0.04).moved(vec3(-s + 0.1, 0.0, z + 0.09));
    model.add(palette.plate, sign);
    model.add(palette.trim, Shape::block(vec3(0.16, 0.5, 0.04)).moved(vec3(-s + 0.1, 0.0, z + 0.01)));
}

/// A light bar on the roof and a band along the sides.
pub(crate) fn police(model: &mut Model, palette: &Palette, plan: &CarPlan) {
    light_bar(model, palette, plan.profile.peak, 1.2);
    let blue = model.slot(Material::plain("reflective blue", vec3(0.01, 0.05, 0.35), 0.4), &[]);
    let p = &plan.profile;
    let band = [vec2(-p.length_m + 0.3, 0.66), vec2(-0.6, 0.62), vec2(-0.6, 0.74), vec2(-p.length_m + 0.3, 0.8)];
    model.mark_both(&Prism::side(&band, 0.6..=2.0), palette.paint, blue);
}

/// Windows and seams of the doors behind and of a sliding door.
pub(crate) fn load_doors(model: &mut Model, palette: &Palette, plan: &CarPlan) {
    let p = &plan.profile;
    let rect = |a: f32, b: f32, low: f32, high: f32| [vec2(a, low), vec2(b, low), vec2(b, high), vec2(a, high)];
    let (low, high) = (p.belt_m[1] + 0.12, p.rear_header.1 - 0.3);
    let back = |polygon: &[Vec2]| Prism::front(polygon, -p.length_m - 0.1..=-p.length_m + 0.4);
    for (margin, slot) in [(0.0, palette.trim), (0.025, palette.interior)] {
        let pane = rect(0.06 + margin, 0.62 - margin, low + margin, high - margin);
        model.mark_both(&back(&pane), palette.paint, slot);
        model.mark_both(&back(&pane), palette.trim, slot);
    }
    model.mark(&back(&rect(-0.006, 0.006, p.clearance_m + 0.2, p.rear_header.1 - 0.1)), palette.paint, palette.seam);
    let (front, rear) = (-plan.blind_from_m - 0.02, -plan.blind_from_m - 1.25);
    let (foot, head) = (p.clearance_m + 0.12, p.rear_header.1 - 0.22);
    let rail = p.belt_m[1] - 0.02;
    for line in [
        rect(rear, rear + 0.01, foot, head),
        rect(rear, front, head, head + 0.01),
        rect(-p.length_m + 0.25, rear, rail, rail + 0.03),
    ] {
        model.mark_both(&Prism::side(&line, 0.5..=2.0), palette.paint, palette.seam);
    }
}

/// Light bars and bands of an ambulance.
pub(crate) fn ambulance(model: &mut Model, palette: &Palette, plan: &CarPlan) {
    load_doors(model, palette, plan);
    let p = &plan.profile;
    light_bar(model, palette, (p.header.0 + 0.25, p.header.1 + 0.06), 1.4);
    light_bar(model, palette, (p.length_m - 0.35, p.rear_header.1), 1.2);
    let red = model.slot(Material::plain("reflective red", vec3(0.5, 0.015, 0.01), 0.4), &[]);
    let yellow = model.slot(Material::plain("reflective yellow", vec3(0.6, 0.6, 0.02), 0.4), &[]);
    let band = |low: f32, high: f32| {
        let (back, front) = (-p.length_m + 0.05, -0.3);
        [vec2(back, low), vec2(front, low), vec2(front, high), vec2(back, high)]
    };
    model.mark_both(&Prism::side(&band(0.85, 1.05), 0.5..=2.0), palette.paint, yellow);
    model.mark_both(&Prism::side(&band(0.72, 0.85), 0.5..=2.0), palette.paint, red);
    let cross = |w: f32, h: f32| {
        let (x, z) = (-p.length_m + 1.3, 1.62);
        [vec2(x - w, z - h), vec2(x + w, z - h), vec2(x + w, z + h), vec2(x - w, z + h)]
    };
    for (w, h) in [(0.26, 0.09), (0.09, 0.26)] {
        model.mark_both(&Prism::side(&cross(w, h), 0.5..=2.0), palette.paint, red);
    }
}

fn light_bar(model: &mut Model, palette: &Palette, (s, z): (f32, f32), width_m: f32) {
    let lens = |name: &str, color: Vec3| Material { coat: 1.0, ..Material::plain(name, color, 0.2) };
    let blue = model.slot(lens("blue light", vec3(0.01, 0.06, 0.6)), &[]);
    let place = vec3(-s, 0.0, z + 0.08);
    model.add(palette.trim, Shape::block(vec3(0.2, width_m * 0.9, 0.06)).moved(place - Vec3::Z * 0.06));
    let half = Shape::rounded_block(vec3(0.26, width_m * 0.42, 0.11), 0.04);
    model.add(blue, half.clone().moved(place + Vec3::Y * width_m * 0.28));
    model.add(palette.red, half.moved(place - Vec3::Y * width_m * 0.28));
    model.add(palette.plate, Shape::rounded_block(vec3(0.24, width_m * 0.13, 0.1), 0.04).moved(place));
}

//! What is put on an ordinary car: signs, lights, liveries, loads.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::Material;

use super::car::CarPlan;
use super::grid::rect;
use super::palette::Palette;
use super::plate;
use crate::shape::{Model, Prism, Shape};

const BLUE: Vec3 = vec3(0.01, 0.05, 0.35);
const YELLOW: Vec3 = vec3(0.62, 0.62, 0.02);
const WHITE: Vec3 = vec3(0.72, 0.72, 0.7);

/// Nothing.
pub(crate) fn none(_: &mut Model, _: &Palette, _: &CarPlan) {}

/// A lit sign on the roof.
pub(crate) fn taxi(model: &mut Model, palette: &Palette, plan: &CarPlan) {
    let (s, z) = plan.profile.peak;
    let at = vec3(-s + 0.1, 0.0, z + 0.075);
    let sign = Shape::rounded_block(vec3(0.16, 0.6, 0.15), 0.03).moved(at);
    model.add(palette.plate, sign);
    model.add(palette.trim, Shape::block(vec3(0.12, 0.46, 0.04)).moved(at - Vec3::Z * 0.08));
    let size = vec2(0.5, 0.115);
    let word = model.slot(plate::word("sign/taxi", "TAXI", size, Vec3::splat(0.01), vec3(0.7, 0.5, 0.03)), &[]);
    let front = plate::face(size, Vec3::X * 0.083);
    let back = front.clone().turned(glam::Quat::from_rotation_z(std::f32::consts::PI));
    model.add(word, front.and(back).moved(at));
}

/// A box for skis and luggage on the roof.
pub(crate) fn roof_box(model: &mut Model, palette: &Palette, plan: &CarPlan) {
    let (s, z) = plan.profile.peak;
    let shell = Shape::ellipsoid(vec3(1.05, 0.4, 0.26), 24);
    let flat = shell.bent(|p| {
        // A flat floor, sides like a boat's.
        let square = |v: f32, half: f32| half * (v / half).abs().powf(0.6) * v.signum();
        vec3(p.x, square(p.y, 0.4), if p.z < 0.0 { p.z * 0.35 } else { square(p.z, 0.26) })
    });
    let at = vec3(-s - 0.1, 0.0, z + 0.15);
    model.add(palette.trim, flat.moved(at));
    for x in [0.45, -0.45] {
        let wide = plan.half_m() * 1.15;
        model.add(palette.chrome, Shape::rounded_block(vec3(0.05, wide, 0.03), 0.012).moved(at + vec3(x, 0.0, -0.085)));
    }
}

/// White doors on a dark car.
pub(crate) fn police_two_tone(model: &mut Model, palette: &Palette, plan: &CarPlan) {
    light_bar(model, palette, plan.profile.peak, 1.15);
    let white = model.slot(Material { coat: 1.0, ..Material::plain("white doors", WHITE, 0.4) }, &[]);
    let p = &plan.profile;
    let [front, back] = plan.axles_m;
    let doors = rect(vec2(-back + 0.42, p.clearance_m + 0.06), vec2(-front - 0.47, p.belt_m[0] + 0.1));
    model.mark_both(&Prism::side(&doors, 0.55..=2.0), palette.paint, white);
    let at = [vec2(-back + 0.7, p.belt_m[0] - 0.36), vec2(-front - 0.62, p.belt_m[0] - 0.16)];
    word(model, white, at, "POLICE", vec3(0.01, 0.012, 0.02), WHITE);
}

/// A reflecting band along the sides.
pub(crate) fn police_band(model: &mut Model, palette: &Palette, plan: &CarPlan) {
    light_bar(model, palette, plan.profile.peak, 1.2);
    let p = &plan.profile;
    let blue = sheeting(model, "reflective blue", BLUE);
    let middle = p.clearance_m + (p.belt_m[0] - p.clearance_m) * 0.66;
    let band = [
        vec2(-p.length_m + 0.25, middle - 0.06),
        vec2(-0.5, middle - 0.12),
        vec2(-0.5, middle + 0.06),
        vec2(-p.length_m + 0.25, middle + 0.16),
    ];
    model.mark_both(&Prism::side(&band, 0.6..=2.0), palette.paint, blue);
    let doors = [vec2(-plan.axles_m[1] + 0.5, middle - 0.09), vec2(-plan.axles_m[0] - 0.7, middle + 0.1)];
    word(model, blue, doors, "POLICE", WHITE, BLUE);
}

/// Large checks along the sides.
pub(crate) fn police_checks(model: &mut Model, palette: &Palette, plan: &CarPlan) {
    light_bar(model, palette, plan.profile.peak, 1.1);
    checks(model, palette, plan, BLUE, 0.22);
}

/// Two rows of checks, in yellow and another colour, from the front wheels to the tail.
fn checks(model: &mut Model, palette: &Palette, plan: &CarPlan, color: Vec3, row_m: f32) {
    let p = &plan.profile;
    let yellow = sheeting(model, "reflective yellow", YELLOW);
    let other = sheeting(model, "reflective check", color);
    let low = p.clearance_m + (p.belt_m[0] - p.clearance_m) * 0.36;
    let whole = rect(vec2(-p.length_m + 0.12, low), vec2(-0.45, low + 2.0 * row_m));
    model.mark_both(&Prism::side(&whole, 0.5..=2.0), palette.paint, yellow);
    let wide = 2.0 * row_m;
    for k in 0..(p.length_m / wide) as usize {
        let corner = vec2(-0.45 - wide * (k + 1) as f32, low + if k % 2 == 0 { 0.0 } else { row_m });
        let check = rect(corner, corner + vec2(wide, row_m));
        model.mark_both(&Prism::side(&check, 0.5..=2.0), yellow, other);
    }
}

/// Windows and seams of the doors behind and of a sliding door.
pub(crate) fn load_doors(model: &mut Model, palette: &Palette, plan: &CarPlan) {
    let p = &plan.profile;
    let (low, high) = (p.belt_m[1] + 0.12, (p.rear_header.1 - 0.3).min(p.belt_m[1] + 0.7));
    let back = |polygon: &[Vec2]| Prism::front(polygon, -p.length_m - 0.1..=-p.length_m + 0.4);
    for (margin, slot) in [(0.0, palette.trim), (0.025, palette.privacy)] {
        let pane = rect(vec2(0.06 + margin, low + margin), vec2(0.6 - margin, high - margin));
        model.mark_both(&back(&pane), palette.paint, slot);
        model.mark_both(&back(&pane), palette.trim, slot);
    }
    let middle = rect(vec2(-0.006, p.clearance_m + 0.2), vec2(0.006, p.rear_header.1 - 0.1));
    model.mark(&back(&middle), palette.paint, palette.seam);
    let (front, rear) = (-plan.blind_from_m - 0.06, -plan.blind_from_m - 1.3);
    let (foot, head) = (p.clearance_m + 0.12, p.rear_header.1 - 0.22);
    let rail = p.belt_m[1] - 0.06;
    for line in [
        rect(vec2(rear, foot), vec2(rear + 0.009, head)),
        rect(vec2(front, foot), vec2(front + 0.009, head)),
        rect(vec2(rear, head), vec2(front, head + 0.009)),
        rect(vec2(-p.length_m + 0.25, rail), vec2(rear, rail + 0.03)),
    ] {
        model.mark_both(&Prism::side(&line, 0.5..=2.0), palette.paint, palette.seam);
    }
}

/// Lights, bands and words of an ambulance.
pub(crate) fn ambulance(model: &mut Model, palette: &Palette, plan: &CarPlan) {
    load_doors(model, palette, plan);
    let p = &plan.profile;
    light_bar(model, palette, (p.header.0 + 0.3, p.header.1 + 0.03), 1.4);
    light_bar(model, palette, (p.length_m - 0.45, p.rear_header.1), 1.2);
    let green = vec3(0.01, 0.2, 0.05);
    checks(model, palette, plan, green, 0.25);
    let z = p.belt_m[1] + (p.rear_header.1 - p.belt_m[1]) * 0.42;
    let at = [vec2(-p.length_m + 0.5, z - 0.14), vec2(-plan.blind_from_m - 0.35, z + 0.14)];
    word(model, palette.paint, at, "AMBULANCE", green, WHITE);
}

/// A word on both sides, on what is in a slot there.
fn word(model: &mut Model, on: u16, at: [Vec2; 2], text: &str, ink: Vec3, ground: Vec3) {
    let size = at[1] - at[0];
    let slot = model.slot(plate::word(&format!("livery/{}", text.to_lowercase()), text, size, ink, ground), &[]);
    for is_left in [true, false] {
        let decal = plate::decal(model.shape(), on, at, is_left);
        model.add(slot, decal);
    }
}

fn sheeting(model: &mut Model, name: &str, color: Vec3) -> u16 {
    model.slot(Material { dirt: 0.3, ..Material::plain(name, color, 0.35) }, &[])
}

fn light_bar(model: &mut Model, palette: &Palette, (s, z): (f32, f32), width_m: f32) {
    let lens = |name: &str, color: Vec3| Material { coat: 1.0, ..Material::plain(name, color, 0.2) };
    let blue = model.slot(lens("blue light", vec3(0.01, 0.06, 0.6)), &[]);
    let place = vec3(-s, 0.0, z + 0.065);
    model.add(palette.trim, Shape::rounded_block(vec3(0.24, width_m, 0.04), 0.015).moved(place - Vec3::Z * 0.05));
    let cell = |wide: f32| Shape::rounded_block(vec3(0.27, wide, 0.085), 0.035);
    for side in [1.0, -1.0] {
        let y = |share: f32| Vec3::Y * side * width_m * share;
        model.add(blue, cell(width_m * 0.2).moved(place + y(0.4)));
        model.add(blue, cell(width_m * 0.14).moved(place + y(0.22)));
        model.add(if side > 0.0 { palette.red } else { blue }, cell(width_m * 0.1).moved(place + y(0.095)));
    }
    model.add(palette.trim, cell(width_m * 0.08).moved(place));
}

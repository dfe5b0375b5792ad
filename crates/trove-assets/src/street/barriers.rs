//! Barriers. As in nuScenes, forward (x) is the thin side and the long side lies along y.

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Material};

use super::finish::{bar, concrete, galvanised, plastic, polygon, reflective, rubber, swept};
use crate::shape::{Model, Shape};

const RED: Vec3 = vec3(0.5, 0.085, 0.045);
const WHITE: Vec3 = vec3(0.56, 0.55, 0.51);

pub(super) fn assets() -> Vec<Asset> {
    vec![
        water_filled("barrier/water-red", RED, &[RED, WHITE, RED * 0.85, WHITE * 0.85]),
        water_filled("barrier/water-white", WHITE, &[WHITE, RED, vec3(0.5, 0.48, 0.42), vec3(0.55, 0.13, 0.07)]),
        jersey(),
        crowd(),
        planks(),
    ]
}

fn asset(model: Model, id: &str) -> Asset {
    model.asset(id, Kind::Barrier, Class::Barrier)
}

/// Half the width of a jersey profile at a height (both as shares of the whole).
fn jersey_half(height: f32) -> f32 {
    let knots = [(0.0, 1.0), (0.12, 1.0), (0.35, 0.6), (1.0, 0.3)];
    let next = knots.iter().position(|k| k.0 >= height).unwrap_or(3).max(1);
    let ((x0, y0), (x1, y1)) = (knots[next - 1], knots[next]);
    y0 + (y1 - y0) * (height - x0) / (x1 - x0)
}

/// A hollow plastic barrier of two metres: grooves in its sides, steps at its ends, a filler cap.
fn water_filled(id: &str, color: Vec3, paints: &[Vec3]) -> Asset {
    let mut model = Model::default();
    let shell = model.slot(plastic(color), paints);
    let dark = model.slot(rubber(), &[]);
    let (half_m, height_m, length_m) = (0.31, 1.05, 2.0);
    let heights = [0.0, 0.1, 0.13, 0.24, 0.35, 0.45, 0.62, 0.8, 0.93, 0.97, 1.0];
    // Grooves run up the upper face, five of them.
    let groove = |y: f32, h: f32| {
        let phase = ((y / 0.36 + 0.5).rem_euclid(1.0) - 0.5).abs();
        let within = if y.abs() < 0.92 && (0.3..0.95).contains(&h) { 1.0 } else { 0.0 };
        0.035 * within * f32::from(phase < 0.2)
    };
    let ring = |y: f32| -> Vec<Vec3> {
        let end = if y.abs() > 0.93 * length_m / 2.0 { 0.8 } else { 1.0 };
        let side = |h: f32| jersey_half(h) * half_m * end - groove(y, h) - if h >= 1.0 { 0.02 } else { 0.0 };
        let top = |h: f32| h * height_m * if end < 1.0 { 0.93 } else { 1.0 };
        let right = heights.iter().map(|&h| vec3(-side(h), y, top(h)));
        let left = heights.iter().rev().map(|&h| vec3(side(h), y, top(h)));
        right.chain(left).collect()
    };
    let steps = [-1.0, -0.935, -0.925];
    let fine = (0..=48).map(|i| -0.9 + 1.8 * i as f32 / 48.0);
    let rings: Vec<Vec<Vec3>> =
        steps.into_iter().chain(fine).chain(steps.into_iter().rev().map(|y| -y)).map(ring).collect();
    model.add(shell, Shape::loft(&rings));
    // Openings for a forklift, a filler cap, a drain.
    for y in [-0.5, 0.5] {
        model.add(dark, Shape::block(vec3(half_m * 2.0 + 0.004, 0.3, 0.085)).moved(vec3(0.0, y, 0.055)));
    }
    model.add(dark, Shape::cylinder(0.05, 0.02, 16).moved(vec3(0.0, 0.3, height_m)));
    asset(model, id)
}

/// A cast concrete jersey barrier.
fn jersey() -> Asset {
    let mut model = Model::default();
    let body = model.slot(concrete(), &[]);
    let dark = model.slot(rubber(), &[]);
    let (half_m, height_m) = (0.3, 0.86);
    let heights = [0.0, 0.09, 0.36, 0.97, 1.0];
    let half = |h: f32| jersey_half(h) * half_m - if h >= 1.0 { 0.02 } else { 0.0 };
    let right = heights.iter().map(|&h| vec2(half(h), h * height_m));
    let left = heights.iter().rev().map(|&h| vec2(-half(h), h * height_m));
    let profile: Vec<Vec2> = right.chain(left).collect();
    model.add(body, swept(&profile, 2.4));
    for y in [-0.6, 0.6] {
        model.add(dark, Shape::block(vec3(half_m * 2.0 + 0.004, 0.35, 0.06)).moved(vec3(0.0, y, 0.032)));
    }
    asset(model, "barrier/jersey")
}

/// A steel crowd barrier: a bent tube with bars, on flat feet.
fn crowd() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let (half_m, low_m, high_m, corner_m) = (1.15, 0.2, 1.08, 0.12);
    let arc = |centre: Vec2, from: f32| {
        (0..=4).map(move |i| centre + Vec2::from_angle((from + i as f32 / 4.0) * std::f32::consts::FRAC_PI_2) * 0.12)
    };
    let mut frame: Vec<Vec3> = arc(vec2(half_m - corner_m, high_m - corner_m), 0.0)
        .chain(arc(vec2(corner_m - half_m, high_m - corner_m), 1.0))
        .chain(arc(vec2(corner_m - half_m, low_m + corner_m), 2.0))
        .chain(arc(vec2(half_m - corner_m, low_m + corner_m), 3.0))
        .map(|p| vec3(0.0, p.x, p.y))
        .collect();
    frame.push(frame[0]);
    model.add(steel, Shape::tube(&frame, 0.019, 10));
    for i in 1..18 {
        let y = -half_m + 2.0 * half_m * i as f32 / 18.0;
        model.add(steel, Shape::tube(&[vec3(0.0, y, low_m), vec3(0.0, y, high_m)], 0.007, 6));
    }
    for y in [-0.85, 0.85] {
        model.add(steel, bar(vec3(0.0, y, 0.012), vec3(0.56, 0.06, 0.024)));
        model.add(steel, Shape::tube(&[vec3(0.0, y, 0.02), vec3(0.0, y, low_m)], 0.016, 8));
    }
    asset(model, "barrier/crowd")
}

/// Planks with slanting stripes on A-shaped legs.
fn planks() -> Asset {
    let mut model = Model::default();
    let legs = model.slot(plastic(vec3(0.5, 0.3, 0.03)), &[]);
    let (red, white) = (vec3(0.5, 0.03, 0.025), vec3(0.62, 0.62, 0.6));
    let slots = [model.slot(reflective(red), &[red, vec3(0.66, 0.12, 0.02)]), model.slot(reflective(white), &[])];
    let light = model.slot(Material { emission: vec3(0.6, 0.25, 0.02), ..plastic(vec3(0.7, 0.35, 0.02)) }, &[]);
    for y in [-0.85, 0.85] {
        for x in [-1.0, 1.0] {
            let lean = Quat::from_rotation_y(x * -0.2);
            model.add(legs, bar(Vec3::ZERO, vec3(0.03, 0.07, 1.02)).turned(lean).moved(vec3(x * 0.14, y, 0.5)));
        }
        model.add(legs, bar(vec3(0.0, y, 0.3), vec3(0.32, 0.05, 0.03)));
    }
    for (x, z) in [(0.072, 0.86), (-0.072, 0.86), (0.15, 0.48)] {
        let (width, height, stripes) = (2.0, 0.2, 10);
        let plank = |i: usize| {
            let at = |k: usize| -width / 2.0 + width * k as f32 / stripes as f32;
            let (a, b) = (at(i), at(i + 1));
            let slant = if i == 0 { 0.0 } else { 0.1 };
            let after = if i + 1 == stripes { 0.0 } else { 0.1 };
            let stripe = [vec2(a - slant, 0.0), vec2(b - after, 0.0), vec2(b + after, height), vec2(a + slant, height)];
            super::finish::upright(Shape::extruded(&stripe, 0.02))
        };
        for i in 0..stripes {
            model.add(slots[i % 2], plank(i).moved(vec3(x - 0.01, 0.0, z - height / 2.0)));
        }
    }
    model.add(
        light,
        Shape::lathe(&[vec2(0.0, 0.0), vec2(0.06, 0.0), vec2(0.06, 0.1), vec2(0.0, 0.12)], 16)
            .moved(vec3(0.0, 0.85, 0.98)),
    );
    model.add(legs, Shape::extruded(&polygon(12, 0.065, 0.0), 0.03).moved(vec3(0.0, 0.85, 0.955)));
    asset(model, "barrier/planks")
}

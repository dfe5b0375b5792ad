//! Barriers. As in nuScenes, forward (x) is the thin side and the long side lies along y.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Material};

use super::finish::{
    bar, board, cloth, dark, galvanised, painted, plastic, polygon, reflective, rubber, swept, upright,
};
use crate::shape::{Curve, Model, Shape};
use crate::surfaces;

const RED: Vec3 = vec3(0.62, 0.1, 0.05);
const WHITE: Vec3 = vec3(0.7, 0.68, 0.62);

pub(super) fn assets() -> Vec<Asset> {
    // Of all barriers those of plastic are the most common.
    let common = |asset: Asset| Asset { commonness: 4.0, ..asset };
    vec![
        common(water_filled("water-red", &[RED, WHITE, vec3(0.52, 0.1, 0.06), WHITE * 0.85])),
        common(water_filled("water-white", &[WHITE, RED, vec3(0.62, 0.59, 0.5), vec3(0.66, 0.15, 0.08)])),
        jersey(),
        steel(),
        crowd(),
        works_fence(),
        planks(),
    ]
}

fn asset(model: Model, name: &str) -> Asset {
    model.asset(&format!("barrier/{name}"), Kind::Barrier, Class::Barrier).tagged([name])
}

/// A hollow plastic barrier of two metres: a flared foot, scoops in its sides, a thick rim, knuckles at its ends; bags of
/// sand hang over many.
fn water_filled(name: &str, paints: &[Vec3]) -> Asset {
    let mut model = Model::default();
    let shell = model.slot(plastic(paints[0]), paints);
    let black = model.slot(dark(), &[]);
    let (half_m, height_m) = (0.31, 1.05);
    let half = Curve::new(&[
        (0.0, 0.97),
        (0.015, 1.0),
        (0.075, 1.0),
        (0.1, 0.95),
        (0.2, 0.7),
        (0.32, 0.52),
        (0.45, 0.43),
        (0.785, 0.37),
        (0.8, 0.38),
        (0.82, 0.46),
        (0.97, 0.45),
        (0.99, 0.42),
        (1.0, 0.36),
    ]);
    let scoop = Curve::new(&[(0.2, 0.0), (0.3, 0.5), (0.5, 0.9), (0.74, 1.0), (0.785, 0.0)]);
    let heights = [
        0.0, 0.015, 0.075, 0.1, 0.15, 0.2, 0.26, 0.32, 0.4, 0.5, 0.62, 0.72, 0.755, 0.785, 0.8, 0.82, 0.9, 0.97, 0.99,
        1.0,
    ];
    let groove = |y: f32, h: f32| {
        let from_middle = (y / 0.42).fract().abs() - 0.5;
        let within = (1.0 - (from_middle * 0.42 / 0.085).powi(2)).max(0.0).sqrt();
        0.045 * within * scoop.at(h) * f32::from(y.abs() < 0.84)
    };
    let ring = |y: f32, shrink: f32| -> Vec<Vec3> {
        // Moulded walls are not quite flat.
        let bulge = 1.0 + 0.02 * (y * 3.1).cos();
        let side = |h: f32| half.at(h) * half_m * shrink * bulge - groove(y, h);
        let top = |h: f32| h * height_m * (0.5 + 0.5 * shrink).max(0.9);
        let right = heights.iter().map(|&h| vec3(-side(h), y, top(h)));
        let left = heights.iter().rev().map(|&h| vec3(side(h), y, top(h)));
        right.chain(left).collect()
    };
    let ends = [(-1.0, 0.72), (-0.975, 0.78), (-0.96, 0.8), (-0.955, 0.96), (-0.945, 1.0)];
    let fine = (0..=60).map(|i| (-0.93 + 1.86 * i as f32 / 60.0, 1.0));
    let rings: Vec<Vec<Vec3>> = ends
        .into_iter()
        .chain(fine)
        .chain(ends.into_iter().rev().map(|(y, s)| (-y, s)))
        .map(|(y, s)| ring(y, s))
        .collect();
    model.add(shell, Shape::loft(&rings));
    // Openings for a forklift, a filler cap, a drain, knuckles with their pin.
    for y in [-0.5, 0.5] {
        model.add(black, Shape::rounded_block(vec3(half_m * 2.0 + 0.003, 0.26, 0.075), 0.03).moved(vec3(0.0, y, 0.05)));
    }
    model.add(
        shell,
        Shape::lathe(&[vec2(0.065, 0.0), vec2(0.065, 0.018), vec2(0.05, 0.028), vec2(0.0, 0.028)], 16).moved(vec3(
            0.0,
            0.32,
            height_m - 0.002,
        )),
    );
    model.add(
        black,
        Shape::cylinder(0.02, 0.006, 10).turned(Quat::from_rotation_y(FRAC_PI_2)).moved(vec3(0.272, -0.86, 0.12)),
    );
    for (y, z) in [(-1.0, 0.3), (-1.0, 0.72), (1.0, 0.5), (1.0, 0.9)] {
        model.add(shell, Shape::cylinder(0.055, 0.11, 14).moved(vec3(0.0, y * 0.985, z - 0.055)));
    }
    // Bags at one or two places, white or blue, each over its cord.
    let bag = model
        .slot(cloth(vec3(0.62, 0.6, 0.55)), &[vec3(0.62, 0.6, 0.55), vec3(0.55, 0.52, 0.45), vec3(0.16, 0.3, 0.5)]);
    let bags =
        |places: &[(f32, f32)]| Shape::join(places.iter().map(|&(y, side)| sandbag(y, side, height_m))).slot(bag);
    model.add_extra("sandbags", 0.2, false, bags(&[(-0.2, 1.0)]));
    model.add_extra("sandbags", 0.15, false, bags(&[(0.55, -1.0), (-0.45, 1.0)]));
    asset(model, name)
}

/// A filled bag that hangs down a barrier's side from a cord over its rim.
fn sandbag(y: f32, side: f32, rim_m: f32) -> Shape {
    let profile = [
        (0.0, 0.0),
        (0.07, 0.01),
        (0.125, 0.06),
        (0.13, 0.14),
        (0.1, 0.25),
        (0.055, 0.36),
        (0.02, 0.43),
        (0.03, 0.47),
        (0.0, 0.48),
    ];
    let sack = Shape::lathe(&profile.map(|(r, z)| vec2(r, z)), 18).bent(|p| {
        let angle = p.y.atan2(p.x);
        let fold = 1.0 + 0.07 * (angle * 4.0 + p.z * 14.0).sin() + 0.05 * (angle * 9.0 - p.z * 23.0).sin();
        vec3(p.x * 0.62 * fold, p.y * fold, p.z) + vec3(0.0, 0.03 * p.z, 0.0)
    });
    let hung = sack.scaled(vec3(side, 1.0, 1.0)).moved(vec3(side * 0.2, y, rim_m - 0.62));
    let cord = Shape::tube(
        &[
            vec3(side * 0.195, y, rim_m - 0.16),
            vec3(side * 0.143, y, rim_m - 0.005),
            vec3(-side * 0.1, y, rim_m - 0.003),
        ],
        0.005,
        5,
    );
    hung.and(cord)
}

/// A cast concrete barrier with a kinked side, its edges knocked off.
fn jersey() -> Asset {
    let mut model = Model::default();
    let body = model.slot(
        Material { dirt: 0.7, ..surfaces::set("concrete/weathered") },
        &[vec3(0.95, 0.94, 0.92), vec3(0.8, 0.8, 0.78), vec3(1.0, 0.97, 0.9)],
    );
    let black = model.slot(dark(), &[]);
    let rod = model.slot(super::finish::rusty(), &[]);
    let amber = model.slot(reflective(vec3(0.75, 0.4, 0.03)), &[]);
    let (height_m, length_m) = (0.86, 2.4);
    let profile = Curve::new(&[(0.0, 0.3), (0.09, 0.3), (0.36, 0.18), (1.0, 0.1)]);
    let half = |h: f32| profile.at(h);
    let heights = [0.0, 0.03, 0.08, 0.1, 0.2, 0.33, 0.36, 0.39, 0.6, 0.8, 0.965, 0.99, 1.0];
    let ring = |y: f32, inset: f32| -> Vec<Vec3> {
        let chip = |h: f32, s: f32| 0.006 * surfaces::hash((y * 23.0) as i32, (h * 40.0 * s) as i32, 5);
        let top = |h: f32| (h - if h > 0.98 { inset / height_m } else { 0.0 }) * height_m;
        let side = |h: f32, s: f32| half(h) - inset - chip(h, s) - if h > 0.995 { 0.02 } else { 0.0 };
        let right = heights.iter().map(|&h| vec3(-side(h, 1.0), y, top(h)));
        let left = heights.iter().rev().map(|&h| vec3(side(h, -1.0), y, top(h)));
        right.chain(left).collect()
    };
    let end = length_m / 2.0;
    let inner = (0..=20).map(|i| (-end + 0.02 + (length_m - 0.04) * i as f32 / 20.0, 0.0));
    let rings: Vec<Vec<Vec3>> =
        [(-end, 0.016)].into_iter().chain(inner).chain([(end, 0.016)]).map(|(y, inset)| ring(y, inset)).collect();
    model.add(body, Shape::loft(&rings));
    for y in [-0.6, 0.6] {
        model.add(black, Shape::rounded_block(vec3(0.603, 0.3, 0.07), 0.02).moved(vec3(0.0, y, 0.03)));
        model.add(
            rod,
            Shape::tube(
                &arch(vec3(0.0, y - 0.07, height_m - 0.01), vec3(0.0, y + 0.07, height_m - 0.01), 0.05),
                0.008,
                6,
            ),
        );
        model.add(amber, bar(vec3(0.132, y * 0.4, 0.62), vec3(0.03, 0.06, 0.09)));
    }
    for (y, z) in [(-end, 0.25), (-end, 0.6), (end, 0.25), (end, 0.6)] {
        let around = |i: usize| Vec2::from_angle(TAU * i as f32 / 16.0 - FRAC_PI_2) * 0.045;
        let eye: Vec<Vec3> = (0..=8).map(around).map(|a| vec3(a.y, y + a.x * y.signum(), z)).collect();
        model.add(rod, Shape::tube(&eye, 0.009, 6));
    }
    asset(model, "jersey")
}

/// Points of a bow from one point to another, rising in between.
fn arch(from: Vec3, to: Vec3, rise_m: f32) -> Vec<Vec3> {
    (0..=8).map(|i| i as f32 / 8.0).map(|t| from.lerp(to, t) + Vec3::Z * rise_m * (t * TAU / 2.0).sin()).collect()
}

/// A steel safety barrier on a broad foot, as set out along roadworks.
fn steel() -> Asset {
    let mut model = Model::default();
    let zinc = model.slot(galvanised(), &[]);
    let band = model.slot(reflective(vec3(0.7, 0.7, 0.66)), &[]);
    let black = model.slot(rubber(), &[]);
    let profile: [(f32, f32); 10] = [
        (0.27, 0.0),
        (0.27, 0.05),
        (0.12, 0.14),
        (0.1, 0.3),
        (0.14, 0.36),
        (0.14, 0.46),
        (0.1, 0.52),
        (0.1, 0.74),
        (0.13, 0.8),
        (0.1, 0.88),
    ];
    let right = profile.iter().map(|&(x, z)| vec2(x, z));
    let left = profile.iter().rev().map(|&(x, z)| vec2(-x, z));
    let outline: Vec<Vec2> = right.chain(left).collect();
    model.add(zinc, swept(&outline, 2.36));
    for y in [-1.18, 1.18] {
        model.add(zinc, bar(vec3(0.0, y, 0.42), vec3(0.22, 0.035, 0.76)));
        model.add(black, bar(vec3(0.0, y * 0.93, 0.01), vec3(0.58, 0.16, 0.025)));
    }
    for (i, y) in [-0.9, -0.3, 0.3, 0.9].into_iter().enumerate() {
        let x = if i % 2 == 0 { 0.141 } else { -0.141 };
        model.add(band, bar(vec3(x, y, 0.41), vec3(0.004, 0.12, 0.06)));
        for side in [-1.0, 1.0] {
            let bolt = Shape::cylinder(0.016, 0.012, 6).turned(Quat::from_rotation_y(side * FRAC_PI_2));
            model.add(zinc, bolt.moved(vec3(side * 0.1, y + 0.2, 0.63)));
        }
    }
    asset(model, "steel")
}

/// A plastic fence for footpaths beside works: a frame with upright slots, a striped board, feet across.
fn works_fence() -> Asset {
    let mut model = Model::default();
    let orange = vec3(0.72, 0.17, 0.025);
    let shell = model.slot(plastic(orange), &[orange, vec3(0.62, 0.13, 0.03), vec3(0.72, 0.42, 0.03)]);
    let stripes =
        [model.slot(reflective(vec3(0.5, 0.03, 0.025)), &[]), model.slot(reflective(vec3(0.7, 0.7, 0.66)), &[])];
    let foot = model.slot(rubber(), &[]);
    let (half, low, high) = (0.98, 0.12, 1.0);
    for y in [-half, half] {
        model.add(
            shell,
            Shape::rounded_block(vec3(0.05, 0.07, high - low), 0.018).moved(vec3(0.0, y, (high + low) / 2.0)),
        );
    }
    for (z, size) in [(high - 0.04, 0.09), (0.7, 0.06), (low + 0.05, 0.1)] {
        model.add(shell, Shape::rounded_block(vec3(0.045, half * 2.0, size), 0.018).moved(vec3(0.0, 0.0, z)));
    }
    for i in 1..13 {
        let y = -half + 2.0 * half * i as f32 / 13.0;
        model.add(shell, Shape::rounded_block(vec3(0.03, 0.045, 0.5), 0.01).moved(vec3(0.0, y, 0.43)));
    }
    for side in [-1.0f32, 1.0] {
        for (i, stripe) in slanting(1.8, 0.15, 9).into_iter().enumerate() {
            let turned = upright(stripe).turned(Quat::from_rotation_z(if side < 0.0 { TAU / 2.0 } else { 0.0 }));
            model.add(stripes[i % 2], turned.moved(vec3(side * 0.02, 0.0, 0.81)));
        }
    }
    for y in [-0.75, 0.75] {
        model.add(foot, Shape::rounded_block(vec3(0.6, 0.16, 0.07), 0.02).moved(vec3(0.0, y, 0.035)));
        model.add(shell, Shape::rounded_block(vec3(0.06, 0.06, 0.16), 0.01).moved(vec3(0.0, y, 0.1)));
    }
    asset(model, "works-fence")
}

/// Slanting stripes of a board about the origin in x (width) and y (height), thin in z.
fn slanting(width: f32, height: f32, count: usize) -> Vec<Shape> {
    let at = |k: usize| -width / 2.0 + width * k as f32 / count as f32;
    let slant = height / 2.0;
    let stripe = |i: usize| {
        let (a, b) = (at(i), at(i + 1));
        let before = if i == 0 { 0.0 } else { slant };
        let after = if i + 1 == count { 0.0 } else { slant };
        let low = -height / 2.0;
        Shape::extruded(
            &[vec2(a - before, low), vec2(b - after, low), vec2(b + after, -low), vec2(a + before, -low)],
            0.016,
        )
    };
    (0..count).map(stripe).collect()
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
    asset(model, "crowd")
}

/// Planks with slanting stripes on A-shaped legs.
fn planks() -> Asset {
    let mut model = Model::default();
    let legs = model.slot(painted(vec3(0.55, 0.33, 0.03)), &[]);
    let (red, white) = (vec3(0.5, 0.03, 0.025), vec3(0.62, 0.62, 0.6));
    let slots = [model.slot(reflective(red), &[red, vec3(0.66, 0.12, 0.02)]), model.slot(reflective(white), &[])];
    let wood = model.slot(super::finish::grey_timber(), &[]);
    let light = model.slot(Material { emission: vec3(0.6, 0.25, 0.02), ..plastic(vec3(0.7, 0.35, 0.02)) }, &[]);
    for y in [-0.85, 0.85] {
        for x in [-1.0, 1.0] {
            let lean = Quat::from_rotation_y(x * -0.2);
            model.add(legs, bar(Vec3::ZERO, vec3(0.03, 0.07, 1.02)).turned(lean).moved(vec3(x * 0.14, y, 0.5)));
        }
        model.add(legs, bar(vec3(0.0, y, 0.3), vec3(0.32, 0.05, 0.03)));
    }
    for (x, z) in [(0.072, 0.86), (-0.072, 0.86), (0.15, 0.48)] {
        let back = x - 0.01 * f32::signum(x);
        model.add(wood, board(vec3(back, 0.0, z), vec3(0.018, 2.0, 0.2)));
        for (i, stripe) in slanting(1.98, 0.19, 10).into_iter().enumerate() {
            let turned = upright(stripe).turned(Quat::from_rotation_z(if x < 0.0 { TAU / 2.0 } else { 0.0 }));
            model.add(slots[i % 2], turned.moved(vec3(x - 0.006 * f32::signum(x), 0.0, z)));
        }
    }
    model.add(
        light,
        Shape::lathe(&[vec2(0.0, 0.0), vec2(0.06, 0.0), vec2(0.06, 0.1), vec2(0.0, 0.12)], 16)
            .moved(vec3(0.0, 0.85, 0.98)),
    );
    model.add(legs, Shape::extruded(&polygon(12, 0.065, 0.0), 0.03).moved(vec3(0.0, 0.85, 0.955)));
    asset(model, "planks")
}

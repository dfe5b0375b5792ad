//! Construction machines.

use std::f32::consts::TAU;

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Kind};

use super::palette::Palette;
use super::wheel::{Rim, upright, wheel};
use crate::shape::{Model, Prism, Shape};

/// Yellow mostly, then orange, green and white.
const PAINTS: [Vec3; 6] = [
    vec3(0.62, 0.36, 0.015),
    vec3(0.62, 0.36, 0.015),
    vec3(0.66, 0.42, 0.03),
    vec3(0.58, 0.18, 0.015),
    vec3(0.12, 0.3, 0.1),
    vec3(0.6, 0.6, 0.58),
];

/// Every machine.
pub(crate) fn assets() -> Vec<Asset> {
    let machine = |id: &str, scale: f32, build: &dyn Fn(&Palette) -> Shape| {
        let mut model = Model::default();
        let palette = Palette::new(&mut model, &PAINTS, &[]);
        model.add_marked(build(&palette).scaled(Vec3::splat(scale)));
        model.asset(id, Kind::ConstructionVehicle, Kind::ConstructionVehicle.class())
    };
    vec![
        machine("machine/excavator", 1.0, &excavator),
        machine("machine/excavator-compact", 0.62, &excavator),
        machine("machine/wheel-loader", 1.0, &wheel_loader),
        machine("machine/wheel-loader-compact", 0.72, &wheel_loader),
        machine("machine/roller", 1.0, &roller),
        machine("machine/mobile-crane", 1.0, &mobile_crane),
    ]
}

fn block(size: [f32; 3], at: [f32; 3], bevel: f32) -> Shape {
    Shape::rounded_block(Vec3::from(size), bevel).moved(Vec3::from(at))
}

/// A cab with windows all around.
fn cab(palette: &Palette, size: Vec3, at: Vec3) -> Shape {
    let half = size / 2.0;
    let ring = |z: f32, inset: f32| -> Vec<Vec3> {
        let (x, y) = (half.x - inset, half.y - inset * 0.7);
        let c = 0.08;
        [(x, -y + c), (x, y - c), (x - c, y), (-x + c, y), (-x, y - c), (-x, -y + c), (-x + c, -y), (x - c, -y)]
            .map(|(x, y)| vec3(x, y, z))
            .to_vec()
    };
    let shell =
        Shape::loft(&[ring(-half.z, 0.0), ring(-half.z * 0.1, 0.0), ring(half.z * 0.88, 0.09), ring(half.z, 0.16)]);
    let mut shell = shell.slot(palette.paint);
    let pane = |h: f32| {
        let (low, high) = (-half.z * 0.35, half.z * 0.78);
        [vec2(-h + 0.13, low), vec2(h - 0.13, low), vec2(h - 0.2, high), vec2(-h + 0.2, high)]
    };
    shell = shell.mark_both(&Prism::side(&pane(half.x), 0.1..=2.0), palette.glass);
    shell = shell.mark(&Prism::front(&pane(half.y), 0.1..=2.0), palette.glass);
    shell = shell.mark(&Prism::front(&pane(half.y), -2.0..=-0.1), palette.glass);
    let seat = block([0.5, 0.5, 0.15], [-0.05, 0.0, -half.z * 0.45], 0.05).and(block(
        [0.14, 0.5, 0.7],
        [-0.3, 0.0, -half.z * 0.1],
        0.05,
    ));
    let roof = block([size.x * 0.9, size.y * 0.9, 0.06], [0.0, 0.0, half.z + 0.02], 0.02);
    let beacon = Shape::cylinder(0.07, 0.14, 12).moved(vec3(-half.x * 0.5, half.y * 0.4, half.z + 0.04));
    Shape::join([shell, seat.slot(palette.interior), roof.slot(palette.trim), beacon.slot(palette.amber)]).moved(at)
}

/// A beam between two points in the plane y, deeper in the middle.
fn beam(points: &[(f32, f32, f32)], y: f32, width_m: f32) -> Shape {
    let rings: Vec<Vec<Vec3>> = points
        .iter()
        .enumerate()
        .map(|(i, &(x, z, depth))| {
            let at = |k: usize| vec2(points[k].0, points[k].1);
            let along = (at((i + 1).min(points.len() - 1)) - at(i.saturating_sub(1))).normalize_or(Vec2::X);
            let up = along.perp() * depth / 2.0;
            let w = width_m / 2.0;
            // Counter-clockwise seen from where the beam goes to.
            [(up, w), (up, -w), (-up, -w), (-up, w)].map(|(u, dy)| vec3(x + u.x, y + dy, z + u.y)).to_vec()
        })
        .collect();
    Shape::loft(&rings).smooth(0.3)
}

fn cylinder_between(palette: &Palette, from: Vec3, to: Vec3, radius_m: f32) -> Shape {
    let middle = from.lerp(to, 0.55);
    let barrel = Shape::tube(&[from, middle], radius_m, 12).slot(palette.paint);
    barrel.and(Shape::tube(&[middle, to], radius_m * 0.6, 10).slot(palette.chrome))
}

fn excavator(palette: &Palette) -> Shape {
    let mut parts = Vec::new();
    // Tracks: a belt around two wheels, with shoes.
    let (reach, r) = (1.35, 0.4);
    let outline: Vec<Vec2> = (0..=24)
        .map(|i| {
            let a = TAU * i as f32 / 24.0 + TAU / 4.0;
            vec2(a.cos() * r + if a.cos() < 0.0 { -reach } else { reach }, a.sin() * r + r)
        })
        .collect();
    // Put upright, what was y runs down.
    let outline: Vec<Vec2> = outline[..24].iter().map(|p| vec2(p.x, -p.y)).collect();
    let track = upright(Shape::extruded(&counter_clockwise(outline), 0.5));
    let track = track.moved(vec3(0.0, 0.75, 0.0));
    let mut undercarriage = vec![track];
    let length = 2.0 * reach;
    for i in 0..14 {
        let x = -reach + length * i as f32 / 13.0;
        for z in [0.0, 2.0 * r] {
            undercarriage.push(block([0.12, 0.52, 0.04], [x, 1.0, z], 0.01));
        }
    }
    parts.push(Shape::join(undercarriage).both_sides().slot(palette.rubber));
    let rollers =
        (0..6).map(|i| upright(Shape::cylinder(0.14, 0.06, 14)).moved(vec3(-1.1 + 0.44 * i as f32, 1.22, 0.2)));
    parts.push(Shape::join(rollers).both_sides().slot(palette.rim));
    parts.push(block([2.2, 1.5, 0.35], [0.0, 0.0, 0.55], 0.08).slot(palette.trim));
    parts.push(Shape::cylinder(0.65, 0.2, 24).moved(vec3(0.0, 0.0, 0.72)).slot(palette.trim));
    // House: floor, engine cover, counterweight, cab.
    parts.push(block([2.9, 2.4, 0.25], [-0.45, 0.0, 1.05], 0.06).slot(palette.paint));
    parts.push(block([1.5, 2.4, 0.85], [-1.1, 0.0, 1.55], 0.14).slot(palette.paint));
    parts.push(block([0.7, 2.44, 0.95], [-1.85, 0.0, 1.45], 0.24).slot(palette.trim));
    for k in 0..5 {
        parts
            .push(block([0.9, 0.02, 0.04], [-1.05, 1.2, 1.35 + 0.1 * k as f32], 0.005).both_sides().slot(palette.seam));
    }
    parts.push(Shape::tube(&[vec3(-1.3, -0.5, 1.9), vec3(-1.3, -0.5, 2.3)], 0.06, 10).slot(palette.trim));
    parts.push(cab(palette, vec3(1.5, 0.95, 1.65), vec3(0.25, 0.72, 1.95)));
    parts.push(block([1.2, 0.9, 0.55], [0.25, -0.72, 1.4], 0.08).slot(palette.paint));
    // Boom, arm and bucket, folded in.
    let boom = [(0.55, 1.35, 0.35), (1.6, 2.75, 0.55), (2.3, 3.05, 0.5), (4.0, 2.65, 0.3)];
    parts.push(beam(&boom, -0.1, 0.34).slot(palette.paint));
    let arm = [(3.55, 3.15, 0.25), (3.95, 2.6, 0.42), (3.5, 0.95, 0.22)];
    parts.push(beam(&arm, -0.1, 0.26).slot(palette.paint));
    parts.push(cylinder_between(palette, vec3(1.0, -0.1, 1.2), vec3(1.85, -0.1, 2.6), 0.09));
    parts.push(cylinder_between(palette, vec3(1.9, -0.1, 3.35), vec3(3.55, -0.1, 3.15), 0.08));
    parts.push(cylinder_between(palette, vec3(4.15, -0.1, 2.4), vec3(3.75, -0.1, 1.1), 0.07));
    let bucket: Vec<Vec2> = [
        (3.55, 1.0),
        (3.2, 0.95),
        (2.75, 0.62),
        (2.7, 0.25),
        (2.95, 0.02),
        (3.35, 0.0),
        (3.45, 0.1),
        (3.0, 0.15),
        (2.85, 0.35),
        (2.95, 0.6),
        (3.3, 0.82),
    ]
    .map(|(x, z)| vec2(x, -z))
    .to_vec();
    let bucket = upright(Shape::extruded(&counter_clockwise(bucket), 1.0)).moved(vec3(0.0, -0.6, 0.0));
    parts.push(bucket.slot(palette.trim));
    let cheek: Vec<Vec2> =
        [(3.5, 1.0), (2.75, 0.62), (2.7, 0.25), (2.95, 0.02), (3.4, 0.02)].map(|(x, z)| vec2(x, -z)).to_vec();
    for y in [-0.6, 0.37] {
        let side = upright(Shape::extruded(&counter_clockwise(cheek.clone()), 0.03)).moved(vec3(0.0, y, 0.0));
        parts.push(side.slot(palette.trim));
    }
    Shape::join(parts)
}

fn counter_clockwise(mut polygon: Vec<Vec2>) -> Vec<Vec2> {
    let area: f32 = (0..polygon.len()).map(|i| polygon[i].perp_dot(polygon[(i + 1) % polygon.len()])).sum();
    if area < 0.0 {
        polygon.reverse();
    }
    polygon
}

fn big_wheel(palette: &Palette, radius_m: f32, width_m: f32, at: Vec3) -> Shape {
    let mut parts = vec![wheel(palette, radius_m, width_m, Rim::Steel)];
    for i in 0..20 {
        let a = TAU * i as f32 / 20.0;
        for (y, skew) in [(width_m * 0.24, 0.5), (-width_m * 0.24, -0.5)] {
            let lug = Shape::block(vec3(0.05, width_m * 0.5, 0.07) * vec3(radius_m / 0.7, 1.0, 1.0))
                .turned(Quat::from_rotation_z(skew))
                .moved(vec3(0.0, y, radius_m))
                .turned(Quat::from_rotation_y(a + y.signum() * 0.08));
            parts.push(lug.slot(palette.rubber));
        }
    }
    Shape::join(parts).moved(at).both_sides()
}

fn wheel_loader(palette: &Palette) -> Shape {
    let r = 0.72;
    let mut parts = vec![
        big_wheel(palette, r, 0.55, vec3(1.45, 0.92, r)),
        big_wheel(palette, r, 0.55, vec3(-1.35, 0.92, r)),
        block([2.3, 1.3, 0.95], [-1.75, 0.0, 1.45], 0.2).slot(palette.paint),
        block([0.5, 1.9, 0.75], [-2.75, 0.0, 1.1], 0.16).slot(palette.trim),
        block([1.5, 0.85, 0.6], [1.2, 0.0, 0.95], 0.08).slot(palette.paint),
        block([1.1, 0.6, 0.5], [0.1, 0.0, 0.85], 0.08).slot(palette.trim),
        cab(palette, vec3(1.4, 1.3, 1.6), vec3(-0.35, 0.0, 2.3)),
    ];
    let fender = |x: f32| {
        let row = |y: f32| -> Vec<Vec3> {
            let angles = (0..=10).map(|i| 0.5 + 2.1 * i as f32 / 10.0);
            angles.map(|a| vec3(x + a.cos() * (r + 0.12), y, r + a.sin() * (r + 0.12))).collect()
        };
        Shape::sheet(&[row(0.62), row(1.2)]).inside_out().plate(0.03)
    };
    parts.push(fender(-1.35).and(fender(1.45)).both_sides().slot(palette.paint));
    for side in [1.0, -1.0] {
        let lift = [(0.85, 1.55, 0.3), (1.9, 1.35, 0.34), (2.9, 0.55, 0.2)];
        parts.push(beam(&lift, side * 0.45, 0.12).slot(palette.paint));
        parts.push(cylinder_between(palette, vec3(0.9, side * 0.3, 0.9), vec3(2.0, side * 0.4, 1.15), 0.07));
        for k in 0..2 {
            let lamp = vec3(0.4 + 0.01 * k as f32, side * 0.55, 3.02);
            parts.push(Shape::ellipsoid(vec3(0.06, 0.08, 0.06), 10).moved(lamp).slot(palette.lamp));
        }
    }
    parts.push(cylinder_between(palette, vec3(1.0, 0.0, 1.75), vec3(2.75, 0.0, 1.1), 0.08));
    let bucket: Vec<Vec2> =
        [(2.75, 1.25), (2.7, 0.5), (2.95, 0.12), (3.75, 0.05), (3.8, 0.1), (3.05, 0.2), (2.82, 0.55), (2.85, 1.2)]
            .map(|(x, z)| vec2(x, -z))
            .to_vec();
    let cheek: Vec<Vec2> =
        [(2.75, 1.25), (2.7, 0.5), (2.95, 0.12), (3.75, 0.05), (3.1, 1.15)].map(|(x, z)| vec2(x, -z)).to_vec();
    let bucket = upright(Shape::extruded(&counter_clockwise(bucket), 2.5)).moved(vec3(0.0, -1.25, 0.0));
    parts.push(bucket.slot(palette.rim));
    for y in [-1.27, 1.24] {
        parts.push(
            upright(Shape::extruded(&counter_clockwise(cheek.clone()), 0.03))
                .moved(vec3(0.0, y, 0.0))
                .slot(palette.rim),
        );
    }
    parts.push(Shape::tube(&[vec3(-1.6, 0.4, 1.9), vec3(-1.6, 0.4, 2.45)], 0.06, 10).slot(palette.trim));
    Shape::join(parts)
}

fn roller(palette: &Palette) -> Shape {
    let r = 0.62;
    let drum = upright(Shape::cylinder(r, 1.7, 40)).moved(vec3(1.5, -0.85, r)).slot(palette.rim);
    let hub = upright(Shape::cylinder(0.2, 1.86, 16)).moved(vec3(1.5, -0.93, r)).slot(palette.trim);
    let arm = block([1.5, 0.1, 0.2], [1.2, 0.95, r], 0.03).both_sides();
    let front = block([0.25, 2.0, 0.3], [0.62, 0.0, r + 0.05], 0.05).and(block([0.2, 2.0, 0.2], [2.22, 0.0, r], 0.05));
    Shape::join([
        drum,
        hub,
        arm.and(front).slot(palette.paint),
        big_wheel(palette, 0.6, 0.5, vec3(-1.25, 0.68, 0.6)),
        block([1.7, 1.15, 0.75], [-1.3, 0.0, 1.3], 0.18).slot(palette.paint),
        block([1.0, 1.2, 0.4], [-0.1, 0.0, 0.95], 0.08).slot(palette.trim),
        cab(palette, vec3(1.2, 1.3, 1.6), vec3(-0.1, 0.0, 1.95)),
    ])
}

fn mobile_crane(palette: &Palette) -> Shape {
    let r = 0.55;
    let mut parts = vec![
        block([8.4, 2.5, 0.5], [0.0, 0.0, 1.15], 0.1).slot(palette.paint),
        cab(palette, vec3(1.5, 2.3, 1.5), vec3(4.2, 0.0, 1.75)),
        block([0.4, 2.5, 0.6], [4.85, 0.0, 0.8], 0.1).slot(palette.trim),
        cab(palette, vec3(1.5, 0.85, 1.4), vec3(0.3, 0.85, 2.2)),
        block([2.2, 2.3, 0.9], [-2.1, 0.0, 1.95], 0.2).slot(palette.paint),
        Shape::cylinder(0.9, 0.3, 24).moved(vec3(-0.5, 0.0, 1.35)).slot(palette.trim),
    ];
    for x in [3.3, 1.8, -1.7, -3.1] {
        parts.push(wheel(palette, r, 0.4, Rim::Steel).moved(vec3(x, 1.03, r)).both_sides());
    }
    for (k, (from, to)) in [(-2.2, 5.2), (-1.6, 5.45), (-1.0, 5.7)].into_iter().enumerate() {
        let width = 0.62 - 0.1 * k as f32;
        let lift = 2.55 + 0.02 * k as f32;
        parts.push(block([to - from, width, width * 1.1], [(from + to) / 2.0, -0.15, lift], 0.06).slot(palette.paint));
    }
    parts.push(cylinder_between(palette, vec3(-0.4, -0.15, 1.6), vec3(2.0, -0.15, 2.3), 0.14));
    parts.push(block([0.3, 0.3, 0.35], [5.6, -0.15, 2.15], 0.06).slot(palette.trim));
    for x in [2.55, -4.0] {
        parts.push(block([0.35, 2.6, 0.3], [x, 0.0, 0.85], 0.03).slot(palette.trim));
        parts.push(block([0.3, 0.05, 0.3], [x, 1.32, 0.85], 0.01).both_sides().slot(palette.amber));
    }
    for y in [0.9, -0.9] {
        parts.push(Shape::ellipsoid(vec3(0.04, 0.16, 0.1), 12).moved(vec3(5.05, y, 0.85)).slot(palette.lamp));
        parts.push(block([0.04, 0.3, 0.14], [-4.22, y, 1.1], 0.01).slot(palette.red));
    }
    Shape::join(parts)
}

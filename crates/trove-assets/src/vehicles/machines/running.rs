//! What machines roll on: crawler tracks, wheels with lugs.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec2, Vec3, vec2, vec3};

use crate::shape::{Shape, arc};
use crate::vehicles::wheel::{Rim, wheel};
use crate::vehicles::workshop::{Workshop, block, cut_out};

/// A pair of tracks whose wheels are `reach` before and behind the middle.
pub(super) fn tracks(work: &mut Workshop, reach: f32, radius: f32, y: f32, width: f32) {
    let slots = work.slots;
    // Shoes along a loop: the lower run flat, the upper one sagging a little.
    let straight = reach * 2.0;
    let turn = PI * radius;
    let length = 2.0 * straight + 2.0 * turn;
    let shoes = (length / 0.17).round() as usize;
    let at = |d: f32| -> (Vec2, f32) {
        if d < straight {
            (vec2(-reach + d, 0.0), 0.0)
        } else if d < straight + turn {
            let a = (d - straight) / radius;
            (vec2(reach + radius * a.sin(), radius - radius * a.cos()), a)
        } else if d < 2.0 * straight + turn {
            let s = d - straight - turn;
            (vec2(reach - s, 2.0 * radius - 0.05 * (PI * s / straight * 2.0).sin().abs()), PI)
        } else {
            let a = (d - 2.0 * straight - turn) / radius;
            (vec2(-reach - radius * a.sin(), radius + radius * a.cos()), PI + a)
        }
    };
    let mut plates = Vec::new();
    let mut links = Vec::new();
    for i in 0..shoes {
        let (p, a) = at(length * (i as f32 + 0.5) / shoes as f32);
        let place = |s: Shape| s.turned(Quat::from_rotation_y(-a)).moved(vec3(p.x, y, p.y));
        plates.push(place(Shape::block(vec3(0.158, width, 0.022)).moved(Vec3::Z * 0.031)));
        plates.push(place(Shape::block(vec3(0.022, width, 0.03)).moved(vec3(-0.055, 0.0, 0.015))));
        plates.push(place(Shape::block(vec3(0.018, width, 0.02)).moved(vec3(0.02, 0.0, 0.02))));
        links.push(place(Shape::block(vec3(0.165, 0.16, 0.06)).moved(Vec3::Z * 0.07)));
    }
    work.pair(slots.steel, Shape::join(plates));
    work.pair(slots.frame, Shape::join(links));
    // Frame, sprocket, idler, rollers.
    let frame = [
        vec2(-reach + 0.2, radius * 0.55),
        vec2(reach - 0.2, radius * 0.55),
        vec2(reach - 0.1, radius * 1.3),
        vec2(-reach + 0.1, radius * 1.3),
    ];
    work.pair(slots.paint, cut_out(&frame, width * 0.62).moved(Vec3::Y * y));
    for (x, teeth) in [(-reach, 20), (reach, 0)] {
        let rim: Vec<Vec2> = (0..40)
            .map(|i| {
                let r = radius * if teeth > 0 && i % 2 == 0 { 0.9 } else { 0.8 };
                Vec2::from_angle(TAU * i as f32 / 40.0) * r
            })
            .collect();
        let disc = Shape::extruded(&rim, width * 0.3).upright().moved(vec3(x, y - width * 0.15, radius));
        work.pair(slots.frame, disc);
        work.pair(
            slots.paint,
            Shape::cylinder(radius * 0.5, width * 0.66, 20).upright().moved(vec3(x, y - width * 0.33, radius)),
        );
        work.pair(
            slots.steel,
            Shape::cylinder(radius * 0.22, width * 0.74, 14).upright().moved(vec3(x, y - width * 0.37, radius)),
        );
    }
    let rollers = (straight / 0.42) as usize;
    for i in 0..rollers {
        let x = -reach + straight * (i as f32 + 0.5) / rollers as f32;
        work.pair(slots.frame, Shape::cylinder(0.12, width * 0.5, 14).upright().moved(vec3(x, y - width * 0.25, 0.2)));
    }
}

/// A big wheel with lugs, its outside towards +y, on both sides.
pub(super) fn lugged(work: &mut Workshop, radius_m: f32, width_m: f32, at: Vec3) {
    let slots = work.slots;
    let r = radius_m * 0.96;
    let mut parts = vec![wheel(&slots, r, width_m, Rim::Steel)];
    let count = 18;
    for i in 0..count {
        for (side, shift) in [(1.0, 0.0), (-1.0, 0.5)] {
            let a = TAU * (i as f32 + shift) / count as f32;
            // A lug from the middle of the tread outwards and down the shoulder.
            let rung = |y: f32, lift: f32, back: f32| -> Vec3 {
                let angle = a + back;
                vec3(angle.cos() * (r + lift), side * y, angle.sin() * (r + lift))
            };
            let (m, e) = (width_m * 0.02, width_m * 0.47);
            let path = [(rung(m, 0.0, 0.0), 0.028), (rung(e * 0.75, 0.004, 0.1), 0.03), (rung(e, -0.05, 0.14), 0.026)];
            parts.push(Shape::tapered_tube(&path.map(|(p, k)| (p, k * radius_m / 0.7)), 5).slot(slots.rubber));
        }
    }
    work.model.add_marked(Shape::join(parts).moved(at).both_sides());
}

/// An axle's beam.
pub(super) fn axle(work: &mut Workshop, x: f32, z: f32, half: f32) {
    work.add(work.slots.frame, Shape::tube(&[vec3(x, -half, z), vec3(x, half, z)], 0.12, 12));
    work.add(work.slots.frame, Shape::ellipsoid(Vec3::splat(0.24), 14).moved(vec3(x, 0.0, z)));
}

/// A fender over a wheel, on both sides.
pub(super) fn fender(work: &mut Workshop, centre_xz: Vec2, radius: f32, y: [f32; 2], angles: [f32; 2]) {
    let row = |y: f32, r: f32| arc(centre_xz, r, angles[0], angles[1], 12, y);
    let sheet = Shape::sheet(&[
        row(y[0], radius),
        row(y[1], radius),
        row(y[1] + 0.02, radius - 0.03),
        row(y[1] + 0.02, radius - 0.09),
    ]);
    work.pair(work.slots.paint, sheet.plate(0.015));
}

/// Steps and a handrail up to a cabin, on the left.
pub(super) fn ladder(work: &mut Workshop, x: f32, y: f32, low: f32, high: f32) {
    let slots = work.slots;
    let steps = ((high - low) / 0.35) as usize;
    for i in 0..=steps {
        work.add(slots.frame, block([0.34, 0.2, 0.04], [x, y, low + 0.35 * i as f32], 0.01));
    }
    for dx in [-0.2, 0.2] {
        let rail = [vec3(x + dx, y + 0.08, low), vec3(x + dx, y + 0.08, high + 0.5), vec3(x + dx, y - 0.1, high + 0.6)];
        work.add(slots.yellow, Shape::tube(&rail, 0.017, 6));
    }
}

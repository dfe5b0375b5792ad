//! Forklifts, telescopic handlers, mobile cranes.

use glam::{Vec2, Vec3, vec2, vec3};

use super::arm::{beam, pin};
use super::cabin::cabin;
use super::running::{axle, fender, lugged};
use crate::shape::{Prism, Shape, pane, rect, shrunk};
use crate::vehicles::decal::{HAZARD, on_back, on_side, slanted, tiled};
use crate::vehicles::hull::{Hull, Row, Section, lying};
use crate::vehicles::wheel::{Rim, wheel};
use crate::vehicles::workshop::{Workshop, bar, block, cylinder};

pub(super) fn forklift(work: &mut Workshop) {
    let slots = work.slots;
    for (x, r) in [(0.75, 0.34), (-0.72, 0.27)] {
        let tyre = wheel(&slots, r, 0.24, Rim::Steel).moved(vec3(x, 0.46, r));
        work.model.add_marked(tyre.both_sides());
        axle(work, x, r, 0.36);
    }
    let body = lying(&[
        Section { x: -1.22, z: 0.72, half: vec2(0.4, 0.4), corner: 0.22 },
        Section { x: -1.08, z: 0.7, half: vec2(0.54, 0.46), corner: 0.2 },
        Section { x: -0.5, z: 0.68, half: vec2(0.57, 0.44), corner: 0.1 },
        Section { x: -0.3, z: 0.52, half: vec2(0.57, 0.3), corner: 0.08 },
        Section { x: 0.5, z: 0.5, half: vec2(0.55, 0.24), corner: 0.08 },
    ]);
    let body = body.slot(slots.paint).mark(&Prism::front(&rect(-3.0, 3.0, 0.0, 3.0), -2.0..=-0.85), slots.frame);
    work.model.add_marked(body);
    work.add(slots.interior, block([0.2, 0.9, 0.5], [0.5, 0.0, 0.95], 0.06));
    let hazard = slanted(&mut work.model, "hazard", HAZARD);
    work.add(hazard, tiled(on_back(vec3(-1.235, 0.0, 0.72), vec2(0.5, 0.12)), vec2(2.4, 0.6)));
    // Guard over the driver.
    for side in [1.0, -1.0] {
        let post = [
            vec3(0.55, side * 0.5, 0.7),
            vec3(0.4, side * 0.5, 2.08),
            vec3(-0.75, side * 0.48, 2.12),
            vec3(-0.95, side * 0.46, 1.0),
        ];
        work.add(slots.frame, Shape::tube(&post, 0.035, 8));
    }
    for k in 0..7 {
        let x = 0.35 - 0.17 * k as f32;
        work.add(slots.frame, block([0.03, 1.0, 0.04], [x, 0.0, 2.1], 0.008));
    }
    work.beacon(vec3(-0.7, 0.0, 2.12));
    let hips = vec3(-0.35, 0.0, 1.22);
    work.seat(hips - Vec3::Z * 0.1, 0.46);
    work.steering_wheel(hips + vec3(0.5, 0.0, 0.22), 0.17, 0.5);
    work.driver(hips, hips + vec3(0.5, 0.0, 0.22));
    // Mast, carriage, forks.
    for side in [1.0, -1.0] {
        work.add(slots.frame, block([0.12, 0.06, 2.08], [1.12, side * 0.34, 1.1], 0.01));
        work.add(slots.steel, block([0.1, 0.05, 2.02], [1.14, side * 0.27, 1.13], 0.01));
        work.add(slots.chrome, Shape::tube(&[vec3(1.06, side * 0.2, 0.25), vec3(1.06, side * 0.2, 2.05)], 0.03, 10));
        cylinder(work, vec3(0.55, side * 0.36, 0.45), vec3(1.06, side * 0.36, 0.9), 0.035, 0.5);
        work.add(slots.frame, block([1.1, 0.11, 0.045], [1.78, side * 0.28, 0.1], 0.012));
        work.add(slots.frame, block([0.05, 0.11, 0.55], [1.25, side * 0.28, 0.35], 0.012));
        work.add(slots.lamp, Shape::ellipsoid(vec3(0.03, 0.06, 0.06), 12).moved(vec3(0.55, side * 0.56, 1.75)));
        work.tail_lens(slots.red, vec3(-0.97, side * 0.44, 1.3), 0.045);
    }
    for z in [0.28, 0.6, 0.98, 1.2] {
        work.add(slots.frame, block([0.05, 1.0, 0.06], [1.22, 0.0, z], 0.01));
    }
    for k in -3_i32..=3 {
        work.add(slots.frame, block([0.03, 0.03, 0.6], [1.22, 0.15 * k as f32, 0.92], 0.006));
    }
    work.add(slots.frame, block([0.14, 0.72, 0.08], [1.12, 0.0, 2.1], 0.01));
}

pub(super) fn telehandler(work: &mut Workshop) {
    let slots = work.slots;
    for x in [1.35, -1.35] {
        lugged(work, 0.6, 0.46, vec3(x, 0.9, 0.6));
        axle(work, x, 0.6, 0.8);
        fender(work, vec2(x, 0.6), 0.72, [0.62, 1.12], [0.2, 2.94]);
    }
    work.add(slots.paint, block([4.0, 0.9, 0.5], [-0.1, 0.0, 0.82], 0.08));
    let engine = lying(&[
        Section { x: -1.3, z: 1.15, half: vec2(0.32, 0.3), corner: 0.12 },
        Section { x: -1.1, z: 1.18, half: vec2(0.36, 0.36), corner: 0.12 },
        Section { x: 0.6, z: 1.14, half: vec2(0.36, 0.34), corner: 0.12 },
        Section { x: 0.9, z: 1.05, half: vec2(0.3, 0.24), corner: 0.12 },
    ]);
    work.add(slots.paint, engine.moved(Vec3::Y * -0.76));
    cabin(work, vec3(1.5, 0.92, 1.55), vec3(-0.1, 0.64, 0.85));
    let boom = [(-2.2, 1.75, 0.42), (0.0, 1.6, 0.42), (2.3, 1.35, 0.38)];
    work.add(slots.paint, beam(&boom, -0.12, 0.36));
    work.add(slots.second, beam(&[(1.6, 1.42, 0.28), (3.0, 1.22, 0.28), (3.35, 0.72, 0.22)], -0.12, 0.26));
    pin(work, vec3(-2.1, -0.12, 1.75), 0.1, 0.6);
    work.add(slots.paint, block([0.5, 0.7, 1.1], [-1.95, -0.12, 1.2], 0.08));
    cylinder(work, vec3(-0.9, -0.12, 1.0), vec3(1.2, -0.12, 1.32), 0.08, 0.5);
    work.add(slots.frame, block([0.08, 1.0, 0.5], [3.45, -0.12, 0.5], 0.02));
    for y in [-0.4, 0.16] {
        work.add(slots.frame, block([1.15, 0.12, 0.05], [4.02, y, 0.14], 0.012));
        work.add(slots.frame, block([0.06, 0.12, 0.6], [3.47, y, 0.42], 0.012));
    }
    for side in [1.0, -1.0] {
        work.tail_lens(slots.red, vec3(-2.2, side * 0.36, 0.95), 0.05);
        work.add(slots.lamp, Shape::ellipsoid(vec3(0.03, 0.07, 0.06), 12).moved(vec3(1.9, side * 0.36, 0.95)));
    }
    work.number_plate(vec3(-2.22, 0.0, 1.1), false);
}

pub(super) fn crane(work: &mut Workshop) {
    let slots = work.slots;
    let r = 0.58;
    for x in [3.1, 1.6, -1.7, -3.15] {
        let tyre = wheel(&slots, r, 0.4, Rim::Steel).moved(vec3(x, 1.05, r));
        work.model.add_marked(tyre.both_sides());
        axle(work, x, r, 0.85);
    }
    // Carrier: frame, deck, wings, boxes.
    work.add(slots.frame, block([8.6, 0.95, 0.5], [-0.2, 0.0, 0.95], 0.05));
    for (a, b) in [(3.85, 0.85), (-0.95, -4.4)] {
        work.add(slots.paint, block([a - b, 2.5, 0.12], [(a + b) / 2.0, 0.0, 1.3], 0.03));
        work.pair(slots.paint, block([a - b, 0.03, 0.16], [(a + b) / 2.0, 1.24, 1.22], 0.01));
    }
    work.add(slots.paint, block([1.7, 2.4, 0.7], [-0.05, 0.0, 1.0], 0.05));
    work.add(slots.steel, block([1.6, 2.3, 0.02], [-0.05, 0.0, 1.36], 0.004));
    // Low cab across the front.
    let row = |z: f32, front: f32, inset: f32| Row {
        z,
        front: 5.3 - front,
        back: 3.75,
        half: 1.25 - inset,
        corner: [0.25, 0.06],
        bow: [0.12, 0.0],
    };
    let hull = Hull::new(vec![
        row(0.45, 0.08, 0.04),
        row(0.55, 0.0, 0.0),
        row(1.35, 0.02, 0.0),
        row(2.05, 0.32, 0.05),
        row(2.2, 0.45, 0.1),
        row(2.3, 0.62, 0.2),
        row(2.33, 0.85, 0.4),
    ]);
    let mut skin = hull.skin().slot(slots.paint);
    let ahead = |p: &[Vec2]| Prism::front(p, 4.3..=5.6);
    let screen = rect(-1.18, 1.18, 1.36, 2.04);
    skin = skin
        .mark(&ahead(&pane(&screen, 0.14)), slots.trim)
        .mark(&ahead(&pane(&shrunk(&screen, 0.04), 0.12)), slots.glass);
    let side = |p: &[Vec2]| Prism::side(p, 0.4..=3.0);
    let window = [vec2(3.95, 1.4), vec2(4.95, 1.32), vec2(4.72, 2.02), vec2(3.95, 2.02)];
    skin = skin
        .mark_both(&side(&pane(&window, 0.08)), slots.trim)
        .mark_both(&side(&pane(&shrunk(&window, 0.03), 0.07)), slots.glass);
    skin = skin.mark(&ahead(&rect(-3.0, 3.0, 0.4, 0.78)), slots.trim);
    skin = work.headlamps(skin, &hull, &rect(0.72, 1.2, 0.84, 1.04), &[(0.84, 0.94, 0.08), (1.04, 0.94, 0.07)]);
    work.model.add_marked(skin);
    work.number_plate(vec3(hull.front_at(0.0, 0.62) + 0.012, 0.0, 0.62), true);
    work.wiper(&hull, vec2(0.1, 1.35), vec2(0.95, 1.44));
    work.wiper(&hull, vec2(-0.95, 1.35), vec2(-0.1, 1.44));
    work.mirror([vec3(4.9, 1.2, 2.0), vec3(4.9, 1.2, 1.5)], vec3(5.0, 1.36, 1.75), vec3(0.09, 0.17, 0.34));
    let hips = vec3(4.2, 0.6, 1.22);
    work.seat(hips - Vec3::Z * 0.1, 0.5);
    work.add(slots.interior, block([0.3, 2.2, 0.2], [4.85, 0.0, 1.28], 0.05));
    work.driver(hips, hips + vec3(0.46, 0.0, 0.22));
    // Superstructure: ring, engine, counterweight, cabin, boom.
    work.add(slots.frame, Shape::cylinder(0.85, 0.3, 30).moved(vec3(-0.6, 0.0, 1.3)));
    work.add(slots.paint, block([2.2, 2.2, 0.3], [-0.9, 0.0, 1.72], 0.06));
    let weight = |z: f32, inset: f32| Row {
        z,
        front: -2.0,
        back: -3.1 + inset,
        half: 1.22 - inset,
        corner: [0.05, 0.35],
        bow: [0.0, 0.1],
    };
    let weight = Hull::new(vec![weight(1.5, 0.04), weight(1.56, 0.0), weight(2.5, 0.0), weight(2.58, 0.05)]);
    work.add(slots.second, weight.skin());
    let hazard = slanted(&mut work.model, "hazard", HAZARD);
    for s in [1.0, -1.0] {
        work.add(hazard, tiled(on_back(vec3(-3.11, s * 0.7, 1.9), vec2(0.5, 0.2)), vec2(2.0, 0.8)));
        work.add(hazard, tiled(on_side(s, vec3(-2.5, s * 1.225, 1.7), vec2(0.7, 0.2)), vec2(2.8, 0.8)));
    }
    cabin(work, vec3(1.5, 0.85, 1.5), vec3(0.5, 0.82, 1.55));
    for (k, (from, to)) in [(-3.0, 4.9), (-2.6, 5.15), (-2.2, 5.35), (-1.8, 5.5)].into_iter().enumerate() {
        let (w, z) = (0.34 - 0.04 * k as f32, 2.62 + 0.012 * k as f32);
        let slot = if k == 0 { slots.paint } else { slots.steel };
        let boom = lying(&[
            Section { x: from, z, half: vec2(w, w * 1.25), corner: 0.14 },
            Section { x: to, z, half: vec2(w, w * 1.25), corner: 0.14 },
        ]);
        work.add(slot, boom.moved(Vec3::Y * -0.2));
    }
    cylinder(work, vec3(-0.2, -0.2, 1.6), vec3(2.4, -0.2, 2.25), 0.15, 0.4);
    for y in [-0.42, 0.02] {
        work.add(slots.frame, bar(vec3(-1.9, y, 1.7), vec3(-2.6, y, 2.9), 0.06, 0.5));
    }
    work.add(slots.paint, block([0.4, 0.4, 0.5], [5.55, -0.2, 2.55], 0.06));
    let rope = [vec3(5.65, -0.2, 2.35), vec3(5.5, -0.2, 1.95)];
    work.add(slots.frame, Shape::tube(&rope, 0.015, 5));
    work.add(slots.yellow, block([0.2, 0.16, 0.34], [5.5, -0.2, 1.86], 0.05));
    // Outriggers.
    for x in [2.35, -4.15] {
        work.add(slots.paint, block([0.4, 2.58, 0.34], [x, 0.0, 0.86], 0.03));
        work.pair(slots.frame, Shape::cylinder(0.22, 0.05, 18).moved(vec3(x, 1.14, 0.42)));
        work.pair(slots.chrome, Shape::tube(&[vec3(x, 1.14, 0.46), vec3(x, 1.14, 0.75)], 0.06, 10));
        for s in [1.0, -1.0] {
            work.add(hazard, tiled(on_side(s, vec3(x, s * 1.294, 0.86), vec2(0.38, 0.3)), vec2(1.3, 1.0)));
        }
    }
    work.pair(slots.trim, block([0.07, 0.46, 0.15], [-4.42, 0.9, 1.1], 0.02));
    for s in [1.0, -1.0] {
        for (k, slot) in [slots.amber, slots.red, slots.white].into_iter().enumerate() {
            work.tail_lens(slot, vec3(-4.46, s * (1.05 - 0.15 * k as f32), 1.1), 0.055);
        }
    }
    work.number_plate(vec3(-4.44, 0.0, 1.05), false);
    work.beacon(vec3(4.2, 0.6, 2.32));
}

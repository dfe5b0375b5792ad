//! Wheel loaders and backhoe loaders.

use glam::{Vec2, Vec3, vec2, vec3};

use super::arm::{beam, bucket, pin};
use super::cabin::cabin;
use super::running::{axle, fender, ladder, lugged};
use crate::shape::{Prism, Shape, pane, rect};
use crate::vehicles::decal::{HAZARD, on_back, slanted, tiled};
use crate::vehicles::hull::{Section, lying};
use crate::vehicles::workshop::{Workshop, block, cylinder};

pub(super) fn wheel_loader(work: &mut Workshop) {
    loader(work, vec2(2.95, 0.55), 0.0);
}

/// With its bucket up and tilted.
pub(super) fn raised(work: &mut Workshop) {
    loader(work, vec2(3.0, 1.75), 0.45);
}

/// The bucket's hinge is at (x, z), its mouth turned up by an angle.
fn loader(work: &mut Workshop, hinge: Vec2, turn: f32) {
    let slots = work.slots;
    let r = 0.74;
    for x in [1.5, -1.45] {
        lugged(work, r, 0.56, vec3(x, 0.94, r));
        axle(work, x, r, 0.8);
        fender(work, vec2(x, r), r + 0.14, [0.62, 1.22], [0.55, 2.5]);
    }
    // Rear frame with the engine under a rounded cover, the counterweight behind.
    let cover = lying(&[
        Section { x: -2.95, z: 1.5, half: vec2(0.6, 0.36), corner: 0.2 },
        Section { x: -2.8, z: 1.48, half: vec2(0.68, 0.46), corner: 0.22 },
        Section { x: -1.6, z: 1.55, half: vec2(0.7, 0.52), corner: 0.2 },
        Section { x: -0.85, z: 1.58, half: vec2(0.7, 0.54), corner: 0.16 },
    ]);
    let mut cover = cover.slot(slots.paint);
    for k in 0..7 {
        let z = 1.32 + 0.06 * k as f32;
        cover = cover.mark_both(&Prism::side(&rect(-2.6, -1.9, z, z + 0.026), 0.3..=2.0), slots.seam);
        cover = cover.mark(&Prism::front(&rect(-0.45, 0.45, z, z + 0.03), -3.2..=-2.7), slots.seam);
    }
    cover = cover.mark_both(&Prism::side(&rect(-1.78, -1.77, 1.05, 2.2), 0.3..=2.0), slots.seam);
    work.model.add_marked(cover);
    let weight = lying(&[
        Section { x: -3.12, z: 0.95, half: vec2(0.7, 0.22), corner: 0.14 },
        Section { x: -3.02, z: 0.95, half: vec2(0.95, 0.32), corner: 0.14 },
        Section { x: -2.45, z: 0.95, half: vec2(1.0, 0.34), corner: 0.1 },
    ]);
    work.add(slots.frame, weight);
    let hazard = slanted(&mut work.model, "hazard", HAZARD);
    for side in [1.0, -1.0] {
        work.add(hazard, tiled(on_back(vec3(-3.135, side * 0.42, 0.95), vec2(0.36, 0.14)), vec2(1.6, 0.6)));
        work.tail_lens(slots.red, vec3(-3.0, side * 0.56, 1.42), 0.06);
    }
    work.add(slots.frame, block([1.9, 0.8, 0.5], [-1.5, 0.0, 0.86], 0.06));
    work.add(slots.frame, block([1.0, 0.62, 0.6], [0.05, 0.0, 0.86], 0.06));
    work.add(slots.frame, Shape::cylinder(0.16, 0.9, 14).moved(vec3(0.1, 0.0, 0.45)));
    // Front frame with its tower.
    work.add(slots.paint, block([1.2, 0.9, 0.46], [1.3, 0.0, 0.92], 0.06));
    for y in [-0.36, 0.36] {
        let tower = [vec2(0.62, 0.8), vec2(1.7, 0.8), vec2(1.35, 1.5), vec2(1.1, 1.95), vec2(0.8, 1.9)];
        work.add(slots.paint, crate::vehicles::workshop::cut_out(&pane(&tower, 0.1), 0.08).moved(Vec3::Y * y));
    }
    cabin(work, vec3(1.45, 1.36, 1.72), vec3(-0.45, 0.0, 1.42));
    ladder(work, -0.4, 0.86, 0.55, 1.3);
    work.add(
        slots.frame,
        Shape::tube(&[vec3(-1.7, 0.36, 2.0), vec3(-1.7, 0.36, 2.52), vec3(-1.78, 0.36, 2.6)], 0.06, 12),
    );
    work.add(slots.frame, Shape::cylinder(0.1, 0.3, 14).moved(vec3(-2.1, -0.3, 2.0)));
    // Lift arms, rams, linkage.
    let knee = vec2(2.0, (hinge.y + 1.75) / 2.0 + 0.42);
    for side in [1.0, -1.0] {
        let lift = [
            (0.95, 1.78, 0.24),
            (1.5, 1.72 + (knee.y - 1.6) * 0.5, 0.34),
            (knee.x, knee.y, 0.36),
            (2.5, (knee.y + hinge.y) / 2.0, 0.28),
            (hinge.x, hinge.y, 0.18),
        ];
        work.add(slots.paint, beam(&lift, side * 0.52, 0.14));
        cylinder(work, vec3(1.0, side * 0.52, 1.05), vec3(knee.x - 0.05, side * 0.52, knee.y - 0.12), 0.075, 0.5);
        pin(work, vec3(hinge.x, side * 0.52, hinge.y), 0.06, 0.24);
        pin(work, vec3(0.95, side * 0.46, 1.78), 0.07, 0.3);
    }
    work.add(slots.paint, Shape::tube(&[vec3(knee.x, -0.5, knee.y - 0.05), vec3(knee.x, 0.5, knee.y - 0.05)], 0.1, 12));
    let bell = vec2(knee.x + 0.12, knee.y + 0.42);
    work.add(slots.paint, beam(&[(knee.x + 0.02, knee.y - 0.05, 0.2), (bell.x, bell.y, 0.16)], 0.0, 0.12));
    cylinder(work, vec3(1.05, 0.0, 1.75), vec3(bell.x, 0.0, bell.y), 0.075, 0.45);
    let spin = |p: Vec2| Vec2::from_angle(turn).rotate(p) + hinge;
    let rod = spin(vec2(0.1, 0.5));
    work.add(slots.frame, beam(&[(bell.x, bell.y, 0.12), (rod.x, rod.y, 0.12)], 0.0, 0.1));
    let shell =
        [vec2(0.42, 0.85), vec2(0.2, 0.6), vec2(0.12, 0.1), vec2(0.22, -0.32), vec2(0.5, -0.47), vec2(1.1, -0.46)]
            .map(spin);
    bucket(work, &shell, 0.0, 2.55, 8);
    for side in [1.0, -1.0] {
        let stalk = [vec3(0.75, side * 0.6, 1.5), vec3(0.75, side * 0.85, 1.9)];
        work.add(slots.frame, Shape::tube(&stalk, 0.025, 6));
        work.add(slots.trim, block([0.1, 0.22, 0.18], [0.77, side * 0.88, 1.98], 0.03));
        work.add(slots.lamp, Shape::ellipsoid(vec3(0.02, 0.08, 0.065), 12).moved(vec3(0.825, side * 0.88, 1.98)));
        work.add(slots.amber, block([0.05, 0.06, 0.12], [0.8, side * 1.02, 1.98], 0.015));
    }
    work.number_plate(vec3(-3.145, 0.0, 1.22), false);
}

/// A tractor with a loading bucket in front and a digging arm behind.
pub(super) fn backhoe(work: &mut Workshop) {
    let slots = work.slots;
    lugged(work, 0.72, 0.5, vec3(-0.95, 0.9, 0.72));
    lugged(work, 0.5, 0.36, vec3(1.2, 0.86, 0.5));
    axle(work, -0.95, 0.72, 0.8);
    axle(work, 1.2, 0.5, 0.8);
    fender(work, vec2(-0.95, 0.72), 0.86, [0.6, 1.14], [0.3, 2.6]);
    let hood = lying(&[
        Section { x: -0.2, z: 1.3, half: vec2(0.46, 0.42), corner: 0.12 },
        Section { x: 0.8, z: 1.27, half: vec2(0.45, 0.38), corner: 0.13 },
        Section { x: 1.62, z: 1.2, half: vec2(0.42, 0.32), corner: 0.14 },
        Section { x: 1.74, z: 1.18, half: vec2(0.36, 0.26), corner: 0.12 },
    ]);
    let mut hood = hood.slot(slots.paint);
    for k in 0..6 {
        let z = 1.02 + 0.055 * k as f32;
        hood = hood.mark(&Prism::front(&rect(-0.3, 0.3, z, z + 0.026), 1.5..=2.0), slots.seam);
        hood = hood.mark_both(&Prism::side(&rect(0.9, 1.5, z, z + 0.026), 0.2..=2.0), slots.seam);
    }
    work.model.add_marked(hood);
    work.add(slots.frame, block([3.1, 0.6, 0.36], [-0.05, 0.0, 0.78], 0.05));
    cabin(work, vec3(1.5, 1.4, 1.7), vec3(-0.75, 0.0, 1.1));
    ladder(work, 0.1, 0.75, 0.5, 0.9);
    work.add(slots.frame, Shape::tube(&[vec3(0.9, -0.34, 1.5), vec3(0.9, -0.34, 2.3)], 0.05, 10));
    for side in [1.0, -1.0] {
        let lift = [(0.1, 1.55, 0.2), (1.0, 1.58, 0.26), (1.7, 1.2, 0.26), (2.45, 0.42, 0.16)];
        work.add(slots.paint, beam(&lift, side * 0.62, 0.12));
        cylinder(work, vec3(0.35, side * 0.62, 0.95), vec3(1.55, side * 0.62, 1.22), 0.06, 0.5);
        cylinder(work, vec3(1.1, side * 0.5, 1.62), vec3(2.4, side * 0.5, 0.78), 0.05, 0.5);
    }
    let shell =
        [vec2(2.78, 0.98), vec2(2.6, 0.82), vec2(2.55, 0.42), vec2(2.62, 0.13), vec2(2.85, 0.03), vec2(3.3, 0.04)];
    bucket(work, &shell, 0.0, 2.25, 7);
    // The digging arm, folded up behind, and the feet.
    work.add(slots.frame, block([0.3, 1.9, 0.6], [-1.85, 0.0, 0.85], 0.04));
    for y in [-0.85, 0.85] {
        work.add(slots.paint, block([0.2, 0.2, 1.0], [-1.9, y, 0.85], 0.03));
        work.add(slots.frame, block([0.36, 0.4, 0.07], [-1.9, y, 0.32], 0.02));
    }
    let boom = [(-2.0, 0.75, 0.3), (-2.2, 1.6, 0.36), (-2.1, 2.5, 0.32), (-2.25, 2.95, 0.22)];
    work.add(slots.paint, beam(&boom, 0.0, 0.26));
    let stick = [(-2.05, 3.2, 0.16), (-2.45, 2.85, 0.3), (-2.65, 1.9, 0.28), (-2.7, 1.25, 0.18)];
    work.add(slots.paint, beam(&stick, 0.0, 0.22));
    cylinder(work, vec3(-2.05, 0.0, 1.1), vec3(-1.9, 0.0, 2.35), 0.06, 0.5);
    cylinder(work, vec3(-2.45, 0.0, 1.5), vec3(-2.1, 0.0, 3.15), 0.055, 0.5);
    cylinder(work, vec3(-2.75, 0.0, 2.6), vec3(-2.95, 0.0, 1.4), 0.05, 0.5);
    let shell =
        [vec2(-2.72, 1.25), vec2(-2.95, 1.3), vec2(-3.05, 1.0), vec2(-2.95, 0.68), vec2(-2.65, 0.55), vec2(-2.4, 0.7)];
    bucket(work, &shell, 0.0, 0.62, 4);
    work.number_plate(vec3(-1.96, 0.5, 1.35), false);
}

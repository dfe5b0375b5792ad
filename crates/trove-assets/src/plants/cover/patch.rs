//! A patch under construction: triangles whose colours are tints of one material.

use std::sync::Arc;

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{CoverKind, GroundCover, Mesh, Random, Slot};

/// Triangles with tints.
#[derive(Default)]
pub(super) struct Patch {
    mesh: Mesh,
}

/// One blade of grass or stalk.
pub(super) struct Blade {
    /// Where it comes out of the ground.
    pub(super) foot: Vec3,
    /// Where it leans, unit.
    pub(super) towards: Vec2,
    /// Between it and the vertical, at the foot and at the tip, radians.
    pub(super) lean_rad: [f32; 2],
    pub(super) length_m: f32,
    pub(super) width_m: f32,
    /// Of the tip; the foot is darker.
    pub(super) tint: Vec3,
}

impl Patch {
    pub(super) fn vertex(&mut self, position: Vec3, normal: Vec3, tint: Vec3) -> u32 {
        self.mesh.positions.push(position);
        self.mesh.normals.push(normal.normalize_or(Vec3::Z));
        self.mesh.tints.push(tint);
        self.mesh.positions.len() as u32 - 1
    }

    pub(super) fn triangle(&mut self, a: u32, b: u32, c: u32) {
        self.mesh.triangles.push([a, b, c]);
    }

    /// A blade of three triangles that bends at half its height, or of one.
    pub(super) fn blade(&mut self, blade: &Blade, bent: bool) {
        let Blade { foot, towards, lean_rad, length_m, width_m, tint } = *blade;
        let across = towards.perp().extend(0.0) * width_m / 2.0;
        // Lit like the lawn that it is part of: grass shines upwards, not to where each blade looks.
        let normal = Vec3::Z * 0.8 + towards.extend(0.0) * 0.35;
        let along = |rad: f32| (towards * rad.sin()).extend(rad.cos());
        let dark = tint * 0.62;
        let (a, b) = (self.vertex(foot - across, normal, dark), self.vertex(foot + across, normal, dark));
        if bent {
            let middle = foot + along(lean_rad[0]) * length_m * 0.55;
            let (c, d) = (
                self.vertex(middle + across * 0.8, normal, tint * 0.9),
                self.vertex(middle - across * 0.8, normal, tint * 0.9),
            );
            let tip = self.vertex(middle + along(lean_rad[1]) * length_m * 0.45, normal, tint);
            self.triangle(a, b, c);
            self.triangle(a, c, d);
            self.triangle(d, c, tip);
        } else {
            let tip = self.vertex(foot + along((lean_rad[0] + lean_rad[1]) / 2.0) * length_m, normal, tint);
            self.triangle(a, b, tip);
        }
    }

    /// A leaf that lies on the ground, folded along its rib.
    pub(super) fn lying_leaf(&mut self, middle: Vec3, towards: Vec2, length_m: f32, curl_m: f32, tint: Vec3) {
        let along = towards.extend(0.0) * length_m / 2.0;
        let across = towards.perp().extend(0.0) * length_m * 0.34;
        let lift = Vec3::Z * curl_m;
        let foot = self.vertex(middle - along, Vec3::Z, tint * 0.8);
        let tip = self.vertex(middle + along + lift * 0.7, Vec3::Z, tint);
        let left = self.vertex(middle + across + lift - along * 0.1, Vec3::Z - across / length_m, tint);
        let right = self.vertex(middle - across + lift * 0.6 - along * 0.1, Vec3::Z + across / length_m, tint * 0.93);
        self.triangle(foot, tip, left);
        self.triangle(foot, right, tip);
    }

    /// The cover: everything in one slot.
    pub(super) fn cover(self, name: &str, kind: CoverKind, side_m: f32, slot: Slot) -> GroundCover {
        GroundCover {
            id: format!("cover/{name}"),
            kind,
            side_m: f64::from(side_m),
            mesh: Arc::new(self.mesh),
            slots: vec![slot],
        }
    }
}

/// A point of a square about the origin.
pub(super) fn point(side_m: f32, random: &mut Random) -> Vec3 {
    (vec2(random.unit() as f32, random.unit() as f32) - 0.5).extend(0.0) * side_m
}

/// A direction in the plane.
pub(super) fn heading(random: &mut Random) -> Vec2 {
    Vec2::from_angle(random.range(0.0, std::f64::consts::TAU) as f32)
}

/// Brighter or darker, and a little towards yellow or blue.
pub(super) fn varied(tint: Vec3, spread: f64, random: &mut Random) -> Vec3 {
    let tone = 1.0 + random.range(-spread, spread) as f32;
    let hue = random.range(-0.12, 0.12) as f32;
    tint * tone * vec3(1.0 + hue, 1.0, 1.0 - hue)
}

//! Roofs.

use glam::{Quat, Vec2, Vec3, vec3};

use super::site::{Site, rectangle, slope};
use crate::shape::Shape;

/// A pitched roof over a rectangle.
pub(super) struct Pitched {
    /// Tiles, and what gables and undersides are made of.
    pub(super) slots: [u16; 2],
    /// Middle of the rectangle, at the height of the wall's top.
    pub(super) middle: Vec3,
    /// Along its ridge, and across.
    pub(super) size: Vec2,
    pub(super) rise_m: f32,
    /// How far the ridge's ends are pulled in; 0: gables.
    pub(super) hip_m: f32,
    /// The ridge runs along y.
    pub(super) across: bool,
}

impl Site<'_> {
    /// A flat roof behind a parapet with a coping.
    pub(super) fn flat_roof(&mut self, outline: &[Vec2], z_m: f32, parapet_m: f32, covering: u16, coping: u16) {
        self.add(covering, Shape::flat(outline).moved(Vec3::Z * z_m));
        self.band(coping, outline, z_m..z_m + parapet_m, 0.0, 0.3);
        self.band(coping, outline, z_m + parapet_m..z_m + parapet_m + 0.08, 0.06, 0.36);
    }

    /// A pitched roof with eaves.
    pub(super) fn pitched_roof(&mut self, roof: &Pitched) {
        let eaves = if roof.hip_m > 0.0 { Vec2::new(0.45, 0.45) } else { Vec2::new(0.2, 0.4) };
        let [tiles, gable] = roof.slots;
        let half = roof.size / 2.0;
        let out = half + eaves;
        // Eaves lie lower, along the slope.
        let low = -roof.rise_m * eaves.y / half.y;
        let ridge = if roof.hip_m > 0.0 { half.x - roof.hip_m } else { out.x };
        let turn = if roof.across { Quat::from_rotation_z(std::f32::consts::FRAC_PI_2) } else { Quat::IDENTITY };
        let at = |x: f32, y: f32, z: f32| roof.middle + turn * vec3(x, y, z);
        for side in [-1.0f32, 1.0] {
            let corner = |x: f32| at(x * side, -out.y * side, low);
            let end = |x: f32| at(x * side, 0.0, roof.rise_m);
            self.roof_plane(tiles, gable, &[corner(-out.x), corner(out.x), end(ridge), end(-ridge)]);
            if roof.hip_m > 0.0 {
                let foot = |y: f32| at(out.x * side, y * out.y * side, low);
                self.roof_plane(tiles, gable, &[foot(-1.0), foot(1.0), end(ridge)]);
            } else {
                let end = |y: f32, z: f32| at(half.x * side, y * half.y * side, z);
                self.add(gable, slope(&[end(-1.0, 0.0), end(1.0, 0.0), end(0.0, roof.rise_m)]));
            }
        }
    }

    /// Four steep planes that lean in, and a flat top; `slots` are tiles, covering and trim.
    pub(super) fn mansard_roof(&mut self, slots: [u16; 3], middle: Vec3, size: Vec2, rise_m: f32, in_m: f32) {
        let [tiles, covering, trim] = slots;
        let at = middle.truncate();
        let ring = |by: f32| -> Vec<Vec2> { rectangle(size - 2.0 * by).iter().map(|p| *p + at).collect() };
        let (foot, top) = (ring(0.0), ring(in_m));
        for i in 0..4 {
            let j = (i + 1) % 4;
            let (low, high) = (|p: Vec2| p.extend(middle.z), |p: Vec2| p.extend(middle.z + rise_m));
            self.add(tiles, slope(&[low(foot[i]), low(foot[j]), high(top[j]), high(top[i])]));
        }
        let z = middle.z + rise_m;
        self.add(covering, Shape::flat(&top).moved(Vec3::Z * z));
        self.band(trim, &top, z - 0.1..z + 0.12, 0.12, 0.25);
    }

    /// One sloping plane with its underside and its edges, counter-clockwise from above.
    pub(super) fn roof_plane(&mut self, tiles: u16, under: u16, corners: &[Vec3]) {
        let thick = Vec3::Z * 0.12;
        self.add(tiles, slope(corners));
        let below: Vec<Vec3> = corners.iter().rev().map(|&c| c - thick).collect();
        self.add(under, slope(&below));
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            self.add(under, slope(&[a - thick, b - thick, b, a]));
        }
    }
}

//! What a relief hides of itself from the eye: the mesh lies at its mean height.
//!
//! The way of sight is followed into the relief in equal steps, and the last of them is cut where it meets the surface
//! (Policarpo, Oliveira, Comba, "Real-Time Relief Mapping on Arbitrary Polygonal Surfaces", 2005, without their search).

use glam::{Vec2, Vec3, vec2};

use super::Material;
use super::texturing::Spot;
use crate::lookups::Lookups;
use crate::math::unit_or;
use crate::surface::Surface;
use crate::texture::Texture;

/// Steps from the top of a relief to its ground.
const STEPS: usize = 16;
/// Least cosine with the normal: at a glancing eye joints are hidden anyway, and long steps would miss stones.
const LEAST_COS: f32 = 0.15;
/// A relief of which a sample covers more than this many heights looks flat.
const FLAT_FROM: f32 = 1.0;

impl<T> Material<T> {
    /// By how much what is seen at a spot lies beside it, in texture coordinates; `width_m` is the width of what a sample
    /// covers there.
    #[inline(always)]
    pub(super) fn shift(
        &self,
        lookups: &Lookups,
        heights: Texture<'_>,
        surface: &Surface,
        spot: &Spot,
        width_m: f32,
    ) -> Vec2 {
        let Some([along_u, along_v]) = spot.axes else { return Vec2::ZERO };
        let normal = surface.shading;
        let cos = surface.wo.dot(normal);
        if !surface.is_front || cos <= 0.0 || width_m > FLAT_FROM * self.height_m {
            return Vec2::ZERO;
        }
        // For a metre of depth.
        let along = vec2(surface.wo.dot(unit_or(along_u, Vec3::ZERO)), surface.wo.dot(unit_or(along_v, Vec3::ZERO)));
        let way = -along / spot.metres * (self.height_m / cos.max(LEAST_COS));
        // In shares of the range below its top.
        let way_to = |depth: f32| way * (depth - self.height_of_mesh);
        let relief_at = |depth: f32| 1.0 - heights.sample(lookups, spot.uv + way_to(depth), spot.footprint, 0.0).z;
        let step = 1.0 / STEPS as f32;
        let mut above = relief_at(0.0);
        for i in 1..=STEPS {
            let depth = i as f32 * step;
            let below = depth - relief_at(depth);
            if below >= 0.0 {
                return way_to(depth - step * below / (above + below).max(f32::MIN_POSITIVE));
            }
            above = -below;
        }
        way_to(1.0)
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use glam::vec3;

    use super::*;
    use crate::testing::{LOOKUPS, plain};

    /// Where the eye, from the side of `wo`, sees a relief 0.1 m high instead of at `u` of a texture of a metre.
    fn seen(height: impl Fn(f32) -> f32, u: f32, wo: Vec3, width_m: f32) -> f32 {
        let side = 256;
        let row: Vec<f32> = (0..side).map(|i| height(i as f32 / side as f32)).collect();
        let texels: Vec<_> =
            (0..side * side).map(|i| [128, 128, (row[(i % side) as usize] * 255.0).round() as u8, 0]).collect();
        let heights = Texture { size: [side; 2], firsts: &[0], texels: &texels, is_srgb: false };
        let height_of_mesh = 1.0 - row.iter().sum::<f32>() / side as f32;
        let surface = Surface { wo: wo.normalize(), ..Surface::plain(Vec3::ZERO, Vec3::Z) };
        let axes = Some([Vec3::X, Vec3::Y]);
        let spot = Spot { uv: vec2(u, 0.3), footprint: Vec2::ZERO, axes, metres: Vec2::ONE, dither: 0.5 };
        let material = Material { height_m: 0.1, height_of_mesh, ..plain() };
        let shift = material.shift(&LOOKUPS, heights, &surface, &spot, width_m);
        assert_eq!(shift.y, 0.0);
        shift.x
    }

    const ASLANT: Vec3 = vec3(-1.0, 0.0, 1.0);

    #[test]
    fn what_lies_deep_is_seen_further_on_and_what_stands_out_before() {
        // A terrace 3 cm below the mesh and one 3 cm above it, at 45°.
        let terraces = |u: f32| if u < 0.5 { 0.4 } else { 1.0 };
        let [deep, high] = [0.2, 0.75].map(|u| seen(terraces, u, ASLANT, 0.001));
        assert!((deep - 0.03).abs() < 1e-3 && (high + 0.03).abs() < 1e-3, "{deep} {high}");
        assert!(seen(terraces, 0.2, Vec3::Z, 0.001).abs() < 1e-6);
    }

    #[test]
    fn stones_hide_the_joints_behind_them() {
        // Of the ground, which would be met 5 cm further on, the flank of a stone is seen that begins after 2 cm.
        let stone = |u: f32| if (0.22..0.72).contains(&u) { 1.0 } else { 0.0 };
        let flank = seen(stone, 0.2, ASLANT, 0.001);
        assert!((flank - 0.02).abs() < 0.005, "{flank}");
    }

    #[test]
    fn a_relief_that_is_smaller_than_a_pixel_is_flat() {
        assert_eq!(seen(|u| u, 0.1, ASLANT, 0.2), 0.0);
    }
}

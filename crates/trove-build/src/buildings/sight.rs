//! How near cameras come to a wall.

use glam::DVec2;
use trove_model::Drive;

use crate::roads::RoadSurfaces;

/// Walls this near to a camera are built with frames and rooms, metres.
const FULL_M: f64 = 45.0;
/// Walls this near have their windows set back, metres.
const SIMPLE_M: f64 = 110.0;
/// Standpoints nearer to each other than this are one, metres.
const APART_M: f64 = 4.0;

/// How much of a wall is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Detail {
    /// A texture.
    Flat,
    /// Holes for the openings, closed by the texture.
    Simple,
    /// Everything.
    Full,
}

/// Where the cameras stand, and on which streets.
pub(super) struct Sight<'a> {
    standpoints: Vec<DVec2>,
    pub streets: &'a RoadSurfaces,
}

impl<'a> Sight<'a> {
    pub(super) fn new(drive: &Drive, streets: &'a RoadSurfaces) -> Self {
        let mut standpoints: Vec<DVec2> = Vec::new();
        for keyframe in &drive.keyframes {
            let at = keyframe.world_from_ego.translation.truncate();
            if standpoints.last().is_none_or(|last| last.distance(at) > APART_M) {
                standpoints.push(at);
            }
        }
        Self { standpoints, streets }
    }

    /// What a wall from `a` to `b` (the building on its left) is worth.
    pub(super) fn detail(&self, a: DVec2, b: DVec2) -> Detail {
        let out = -(b - a).perp();
        let along = (b - a) / (b - a).length_squared().max(1e-9);
        let distance_m = |p: &DVec2| a.lerp(b, (*p - a).dot(along).clamp(0.0, 1.0)).distance(*p);
        let before = self.standpoints.iter().filter(|p| (**p - a).dot(out) > 0.0);
        match before.map(distance_m).fold(f64::INFINITY, f64::min) {
            m if m < FULL_M => Detail::Full,
            m if m < SIMPLE_M => Detail::Simple,
            _ => Detail::Flat,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use trove_model::{Bounds, HeightField};

    #[test]
    fn walls_near_a_camera_that_they_face_are_built_and_the_others_stay_flat() {
        let drive = testing::drive();
        let ground = HeightField::flat(Bounds::square(DVec2::ZERO, 600.0), 0.0);
        let streets = testing::surfaces(&drive, &ground);
        let sight = Sight::new(&drive, &streets);
        let at = drive.keyframes[0].world_from_ego.translation.truncate();
        let wall = |from_m: f64| [at + DVec2::new(5.0, from_m), at + DVec2::new(-5.0, from_m)];
        let towards = |y: f64| sight.detail(wall(y)[1], wall(y)[0]);
        assert_eq!(towards(20.0), Detail::Full);
        assert_eq!(towards(80.0), Detail::Simple);
        assert_eq!(towards(300.0), Detail::Flat);
        assert_eq!(sight.detail(wall(20.0)[0], wall(20.0)[1]), Detail::Flat);
    }
}

//! Boxes with a pose.

use glam::DVec3;

use crate::{Body, Pose, World};

/// An oriented box in World.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// Pose of the box's centre.
    pub world_from_body: Pose<World, Body>,
    /// Length (x), width (y), height (z).
    pub size_m: DVec3,
}

impl Cuboid {
    /// The eight corners: bottom then top, each counter-clockwise from front left.
    pub fn corners_world(&self) -> [DVec3; 8] {
        const SIGNS: [[f64; 3]; 8] = [
            [1.0, 1.0, -1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, -1.0, -1.0],
            [1.0, -1.0, -1.0],
            [1.0, 1.0, 1.0],
            [-1.0, 1.0, 1.0],
            [-1.0, -1.0, 1.0],
            [1.0, -1.0, 1.0],
        ];
        SIGNS.map(|s| self.world_from_body.point(DVec3::from_array(s) * self.size_m * 0.5))
    }

    /// Whether a point lies in the box or on it.
    pub fn contains(&self, point_world: DVec3) -> bool {
        let p = self.world_from_body.inverse().point(point_world).abs();
        p.cmple(self.size_m * 0.5).all()
    }

    /// The box with `margin_m` added on every side.
    pub fn grown(&self, margin_m: f64) -> Self {
        Self { size_m: self.size_m + DVec3::splat(2.0 * margin_m), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corners_of_a_turned_box_are_where_they_should_be() {
        let cuboid = Cuboid {
            world_from_body: Pose::from_yaw(std::f64::consts::FRAC_PI_2, DVec3::new(10.0, 0.0, 1.0)),
            size_m: DVec3::new(4.0, 2.0, 2.0),
        };
        assert!((cuboid.corners_world()[0] - DVec3::new(9.0, 2.0, 0.0)).length() < 1e-9);
        assert!(cuboid.corners_world().iter().all(|&c| cuboid.grown(1e-6).contains(c)));
        assert!(!cuboid.contains(DVec3::new(12.0, 0.0, 1.0)));
    }
}

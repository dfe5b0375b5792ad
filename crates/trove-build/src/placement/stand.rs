//! Where things stand.

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use trove_model::{Cuboid, HeightField, Kind, Pose};

use crate::roads::RoadSurfaces;

/// Wheels stand this share of the length and width from the middle of a vehicle.
const WHEELS: f64 = 0.35;

/// What there is to stand on.
#[derive(Clone, Copy)]
pub(crate) struct Stand<'a> {
    /// Height of the carriageway.
    pub ground: &'a HeightField,
    /// Kerbs.
    pub surfaces: &'a RoadSurfaces,
}

/// A box on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    /// From a frame with its origin at the middle of the box's bottom, x forward, z away from the ground.
    pub world_from_base: DAffine3,
    /// The box as placed.
    pub cuboid: Cuboid,
}

impl Stand<'_> {
    /// Height of the surface at a position: carriageway, or kerb high beside it.
    pub(crate) fn surface_m(&self, position: DVec2) -> f64 {
        self.ground.height_m(position) + self.surfaces.elevation_m(position)
    }

    /// How far the bottom of an annotated box is above the surface, metres.
    pub(crate) fn lift_m(&self, annotated: &Cuboid) -> f64 {
        let centre = annotated.world_from_body.translation;
        centre.z - annotated.size_m.z / 2.0 - self.surface_m(centre.truncate())
    }

    /// Puts an annotated box on the ground: position and heading are kept, vehicles and long things follow the slope.
    pub(crate) fn place(&self, annotated: &Cuboid, kind: Kind) -> Placement {
        let position = annotated.world_from_body.translation.truncate();
        let follows_slope = kind.is_vehicle() || matches!(kind, Kind::Barrier | Kind::BicycleRack);
        let (elevation_m, up) = if follows_slope {
            (self.wheels_elevation_m(annotated), self.ground.normal(position))
        } else {
            (self.surfaces.elevation_m(position), DVec3::Z)
        };
        let base_world = position.extend(self.ground.height_m(position) + elevation_m);
        Placement::new(annotated, base_world, up)
    }

    /// Leaves an annotated box at its own height, for someone on a platform.
    pub(crate) fn keep(&self, annotated: &Cuboid) -> Placement {
        let centre = annotated.world_from_body.translation;
        Placement::new(annotated, centre - DVec3::Z * annotated.size_m.z / 2.0, DVec3::Z)
    }

    /// A vehicle stands on the kerb where most of its wheels do.
    fn wheels_elevation_m(&self, vehicle: &Cuboid) -> f64 {
        const WHEEL_SIGNS: [[f64; 2]; 4] = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let mut elevations_m = WHEEL_SIGNS.map(|sign| {
            let wheel = DVec2::from_array(sign) * vehicle.size_m.truncate() * WHEELS;
            self.surfaces.elevation_m(vehicle.world_from_body.point(wheel.extend(0.0)).truncate())
        });
        elevations_m.sort_by(f64::total_cmp);
        elevations_m[1].max(0.0)
    }
}

impl Placement {
    fn new(annotated: &Cuboid, base_world: DVec3, up: DVec3) -> Self {
        let rotation = upright(annotated.world_from_body.yaw_rad(), up);
        let centre_world = base_world + rotation * DVec3::new(0.0, 0.0, annotated.size_m.z / 2.0);
        Self {
            world_from_base: DAffine3::from_rotation_translation(rotation, base_world),
            cuboid: Cuboid { world_from_body: Pose::new(rotation, centre_world), size_m: annotated.size_m },
        }
    }
}

/// The rotation with z along `up` and x as near to the heading as that allows.
fn upright(yaw_rad: f64, up: DVec3) -> DQuat {
    let heading = DVec3::new(yaw_rad.cos(), yaw_rad.sin(), 0.0);
    let forward = (heading - up * heading.dot(up)).normalize();
    DQuat::from_mat3(&DMat3::from_cols(forward, up.cross(forward), up))
}

//! Where things stand.

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use trove_model::{Cuboid, HeightField, Kind, Pose};

use crate::roads::{Footing, KERB_M, RoadSurfaces};

/// An annotation further than this above or below the ground is believed rather than the ground, metres.
const MAX_LIFT_M: f64 = 0.6;
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
    /// The annotation's height above the ground where it was kept, metres.
    pub kept_lift_m: Option<f64>,
}

impl Stand<'_> {
    /// Height of the surface at a position: carriageway, or kerb high beside it.
    pub(crate) fn surface_m(&self, position: DVec2) -> f64 {
        self.ground.height_m(position) + self.surfaces.elevation_m(position)
    }

    /// Puts an annotated box on the ground: position and heading are kept, vehicles follow the slope.
    pub(crate) fn place(&self, annotated: &Cuboid, kind: Kind) -> Placement {
        let pose = annotated.world_from_body;
        let position = pose.translation.truncate();
        let yaw_rad = pose.yaw_rad();
        let up = if kind.is_vehicle() { self.ground.normal(position) } else { DVec3::Z };
        let elevation_m =
            if kind.is_vehicle() { self.wheels_elevation_m(annotated) } else { self.surfaces.elevation_m(position) };
        let surface_m = self.ground.height_m(position) + elevation_m;
        let lift_m = pose.translation.z - annotated.size_m.z / 2.0 - surface_m;
        let kept_lift_m = (lift_m > MAX_LIFT_M).then_some(lift_m);
        let base_world = position.extend(surface_m + kept_lift_m.unwrap_or(0.0));
        let rotation = upright(yaw_rad, up);
        let centre_world = base_world + rotation * DVec3::new(0.0, 0.0, annotated.size_m.z / 2.0);
        Placement {
            world_from_base: DAffine3::from_rotation_translation(rotation, base_world),
            cuboid: Cuboid { world_from_body: Pose::new(rotation, centre_world), size_m: annotated.size_m },
            kept_lift_m,
        }
    }

    /// A vehicle stands on the kerb where most of its wheels do.
    fn wheels_elevation_m(&self, vehicle: &Cuboid) -> f64 {
        const WHEEL_SIGNS: [[f64; 2]; 4] = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let on_kerb = |sign: &&[f64; 2]| {
            let wheel = DVec2::from_array(**sign) * vehicle.size_m.truncate() * WHEELS;
            let wheel_world = vehicle.world_from_body.point(wheel.extend(0.0)).truncate();
            self.surfaces.footing(wheel_world) != Footing::Carriageway
        };
        if WHEEL_SIGNS.iter().filter(on_kerb).count() >= 3 { KERB_M } else { 0.0 }
    }
}

/// The rotation with z along `up` and x as near to the heading as that allows.
pub(crate) fn upright(yaw_rad: f64, up: DVec3) -> DQuat {
    let heading = DVec3::new(yaw_rad.cos(), yaw_rad.sin(), 0.0);
    let forward = (heading - up * heading.dot(up)).normalize();
    DQuat::from_mat3(&DMat3::from_cols(forward, up.cross(forward), up))
}

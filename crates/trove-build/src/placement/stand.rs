//! Where things stand.

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use trove_model::{Class, Cuboid, HeightField, Kind, Pose};

use crate::roads::RoadSurfaces;

/// Wheels stand this share of the length and width from the middle of a vehicle.
const WHEELS: f64 = 0.35;
/// And this share of the length of one on two wheels.
const AXLES: f64 = 0.31;

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

    /// Puts an annotated box on the ground: position and heading are kept, vehicles and long things follow the slope, and
    /// what has two wheels stands with one on a kerb and one beside it.
    pub(crate) fn place(&self, annotated: &Cuboid, kind: Kind) -> Placement {
        let position = annotated.world_from_body.translation.truncate();
        let follows_slope = kind.is_vehicle() || matches!(kind, Kind::Barrier | Kind::BicycleRack);
        let has_two_wheels = matches!(kind.class(), Class::CycleRider | Class::MotorcycleRider);
        let (elevation_m, up) = if has_two_wheels {
            let [front_m, back_m] = self.axles_elevation_m(annotated);
            let pitch = (front_m - back_m) / (2.0 * AXLES * annotated.size_m.x);
            let heading = annotated.world_from_body.vector(DVec3::X).truncate().normalize_or_zero().extend(0.0);
            ((front_m + back_m) / 2.0, (self.ground.normal(position) - heading * pitch).normalize())
        } else if follows_slope {
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

    /// How high the front and the back wheel of something on two are above the carriageway, metres.
    fn axles_elevation_m(&self, annotated: &Cuboid) -> [f64; 2] {
        [AXLES, -AXLES].map(|share| {
            let axle = annotated.world_from_body.point(DVec3::X * share * annotated.size_m.x);
            self.surfaces.elevation_m(axle.truncate()).max(0.0)
        })
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn a_bicycle_across_a_kerb_has_a_wheel_on_it_and_one_beside_it() {
        let drive = testing::drive();
        let area = crate::site::area(&drive).unwrap();
        let ground = HeightField::flat(area.grown(20.0), 0.0);
        let surfaces = testing::surfaces(&drive, &ground);
        let stand = Stand { ground: &ground, surfaces: &surfaces };
        // Across the edge of the carriageway, wherever that is.
        let start = drive.keyframes[0].world_from_ego.translation.truncate();
        let edge = (0..400)
            .map(|i| start + DVec2::Y * 0.05 * f64::from(i))
            .find(|p| stand.surface_m(*p) > 0.05)
            .expect("a kerb beside the road");
        let pose = Pose::from_yaw(std::f64::consts::FRAC_PI_2, edge.extend(0.5));
        let annotated = Cuboid { world_from_body: pose, size_m: DVec3::new(1.7, 0.6, 1.1) };
        let placed = stand.place(&annotated, Kind::Bicycle);
        for share in [AXLES, -AXLES] {
            let wheel = placed.world_from_base.transform_point3(DVec3::X * share * 1.7);
            assert!((wheel.z - stand.surface_m(wheel.truncate())).abs() < 0.01, "{wheel}");
        }
        let height_m = |share: f64| placed.world_from_base.transform_point3(DVec3::X * share).z;
        assert!(height_m(0.5) - height_m(-0.5) > 0.05);
    }
}

//! OXTS: where the car was, by GPS and IMU.

use glam::{DQuat, DVec3, EulerRot};
use trove_model::{Ego, MapProjection, Outcome, Pose, Report, SensorFrame, World};

use super::text;

/// Farther from the first fix nothing belongs to the same drive, metres.
const FARTHEST_M: f64 = 1e5;
/// Roll, pitch and yaw are within ±π; more is no angle in radians.
const LARGEST_RAD: f64 = 7.0;

/// One line: the IMU's place and attitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fix {
    lat_deg: f64,
    lon_deg: f64,
    altitude_m: f64,
    roll_rad: f64,
    pitch_rad: f64,
    /// Counter-clockwise from east.
    yaw_rad: f64,
}

/// A fix from the first six of a line's numbers; `None` where they are none.
pub(super) fn fix(line: &str) -> Option<Fix> {
    let mut words = line.split_whitespace().map(text::number);
    let mut next = || words.next().flatten();
    let (lat_deg, lon_deg, altitude_m) = (next()?, next()?, next()?);
    let (roll_rad, pitch_rad, yaw_rad) = (next()?, next()?, next()?);
    let is_angle = [roll_rad, pitch_rad, yaw_rad].iter().all(|angle| angle.abs() < LARGEST_RAD);
    let is_place = lat_deg.abs() < 89.0 && lon_deg.abs() <= 180.0 && altitude_m.abs() < 20_000.0;
    (is_place && is_angle).then_some(Fix { lat_deg, lon_deg, altitude_m, roll_rad, pitch_rad, yaw_rad })
}

/// World of a drive: where it lies on the earth, and at which height.
pub(super) struct Georeference {
    pub(super) projection: MapProjection,
    altitude_m: f64,
    ego_from_imu: Pose<Ego, SensorFrame>,
}

impl Georeference {
    /// World's origin at the first fix, at the height of its Ego.
    pub(super) fn at(first: &Fix, ego_from_imu: Pose<Ego, SensorFrame>) -> Self {
        let projection = MapProjection::spherical(first.lat_deg, first.lon_deg, glam::DVec2::ZERO);
        let mut georeference = Self { projection, altitude_m: 0.0, ego_from_imu };
        georeference.altitude_m = georeference.pose(first).translation.z;
        georeference
    }

    /// The vehicle at a fix.
    pub(super) fn pose(&self, fix: &Fix) -> Pose<World, Ego> {
        let rotation = DQuat::from_euler(EulerRot::ZYX, fix.yaw_rad, fix.pitch_rad, fix.roll_rad);
        let position = self.projection.world_from_geo(fix.lat_deg, fix.lon_deg);
        let world_from_imu: Pose<World, SensorFrame> =
            Pose::new(rotation, position.extend(fix.altitude_m - self.altitude_m));
        world_from_imu * self.ego_from_imu.inverse()
    }

    /// As [`Georeference::pose`]; `None` far from the first fix, which is reported.
    pub(super) fn near_pose(&self, fix: &Fix, name: &str, report: &Report) -> Option<Pose<World, Ego>> {
        let pose = self.pose(fix);
        let is_near = pose.translation.abs().cmplt(DVec3::splat(FARTHEST_M)).all();
        if !is_near {
            report.note(Outcome::Dropped, "OXTS fix far from the drive's first", name);
        }
        is_near.then_some(pose)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: &str = "49.0 8.4 112.0 0.02 0.01 1.5707963267948966 1 2 3";

    #[test]
    fn yaw_is_counter_clockwise_from_east_and_the_wheels_of_the_first_pose_stand_at_0() {
        let first = fix(LINE).unwrap();
        let georeference = Georeference::at(&first, Pose::new(DQuat::IDENTITY, DVec3::new(0.0, 0.32, 0.93)));
        let pose = georeference.pose(&first);
        assert!(pose.vector(DVec3::X).distance(DVec3::Y) < 0.03 && pose.translation.z.abs() < 1e-9);
        // Nose up by the pitch is down in z about y, as the devkit has it.
        assert!((pose.vector(DVec3::X).z + 0.01f64.sin()).abs() < 1e-9);
        // The IMU itself is at the first fix, and rises with its altitude.
        let higher = georeference.pose(&Fix { altitude_m: 113.5, ..first });
        assert!((higher.translation.z - 1.5).abs() < 1e-9);
        assert!((pose.point(DVec3::new(0.0, 0.32, 0.93)).truncate()).length() < 1e-9);
    }

    #[test]
    fn a_line_that_is_no_fix_has_none() {
        for line in ["", "49 8 1 0 0", "nan 8 1 0 0 0", "90 8 1 0 0 0", "49 8 1 0 0 100", "x"] {
            assert_eq!(fix(line), None, "{line}");
        }
    }

    #[test]
    fn within_a_kilometre_world_is_the_devkit_s_mercator_to_a_decimetre() {
        let first = fix(LINE).unwrap();
        let georeference = Georeference::at(&first, Pose::IDENTITY);
        let radius_m = 6_378_137.0;
        let scale = first.lat_deg.to_radians().cos();
        let mercator = |f: &Fix| {
            let y = (std::f64::consts::FRAC_PI_4 + f.lat_deg.to_radians() / 2.0).tan().ln();
            glam::DVec2::new(f.lon_deg.to_radians(), y) * scale * radius_m
        };
        for (north_m, most_m) in [(0.0, 1e-6), (100.0, 1e-3), (1000.0, 0.1)] {
            let lat_deg = first.lat_deg + f64::to_degrees(north_m / radius_m);
            let there = Fix { lat_deg, lon_deg: first.lon_deg + 0.01, ..first };
            let devkit = mercator(&there) - mercator(&first);
            let ours = georeference.pose(&there).translation.truncate();
            assert!(devkit.distance(ours) < most_m, "{north_m}: {devkit} {ours}");
        }
    }
}

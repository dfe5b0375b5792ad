//! How the recording vehicle moves at a moment of its drive.

use std::f64::consts::PI;

use glam::DVec3;

use crate::{Drive, Ego, Pose, World};

/// Motion is told from poses so long before and after a moment where the recorded path has them: longer than a path's noise,
/// shorter than what drivers do.
const BESIDE_NS: i64 = 100_000_000;

/// The motion of the vehicle's origin, the middle of the rear axle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EgoMotion {
    /// Velocity in World.
    pub velocity_mps: DVec3,
    /// How fast the heading turns about World's z, counter-clockwise, radians a second.
    pub yaw_rate_radps: f64,
}

impl Drive {
    /// The vehicle's motion at a keyframe, by differences over 0.2 s of its recorded path, else over the keyframes beside; on
    /// one side where the other is missing. `None` for a keyframe that the drive does not have, or that is its only one.
    pub fn ego_motion(&self, keyframe: usize) -> Option<EgoMotion> {
        let moment = self.keyframes.get(keyframe)?;
        let on_path = |by_ns: i64| {
            let time_ns = moment.time_ns.saturating_add(by_ns);
            Some((time_ns, self.path.at(time_ns)?))
        };
        let of_keyframe = |k: usize| self.keyframes.get(k).map(|k| (k.time_ns, k.world_from_ego));
        let apart = |before: Option<_>, now: Option<_>, after: Option<_>| match (before, after) {
            (None, None) => None,
            (before, after) => between(before.or(now)?, after.or(now)?),
        };
        apart(on_path(-BESIDE_NS), on_path(0), on_path(BESIDE_NS)).or_else(|| {
            apart(keyframe.checked_sub(1).and_then(of_keyframe), of_keyframe(keyframe), of_keyframe(keyframe + 1))
        })
    }
}

fn between((from_ns, from): (i64, Pose<World, Ego>), (to_ns, to): (i64, Pose<World, Ego>)) -> Option<EgoMotion> {
    let apart_s = to_ns.saturating_sub(from_ns) as f64 * 1e-9;
    let turn_rad = (to.yaw_rad() - from.yaw_rad() + PI).rem_euclid(2.0 * PI) - PI;
    (apart_s > 0.0).then(|| EgoMotion {
        velocity_mps: (to.translation - from.translation) / apart_s,
        yaw_rate_radps: turn_rad / apart_s,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DriveOrigin, EgoBody, Keyframe, MapProjection, Trajectory};
    use glam::DVec2;

    const SECOND_NS: i64 = 1_000_000_000;
    const RADIUS_M: f64 = 20.0;
    const RATE_RADPS: f64 = 0.5;

    /// On a circle about the origin, counter-clockwise.
    fn on_circle(time_ns: i64) -> Pose<World, Ego> {
        let angle = RATE_RADPS * time_ns as f64 * 1e-9;
        Pose::from_yaw(angle + PI / 2.0, DVec3::new(angle.cos(), angle.sin(), 0.0) * RADIUS_M)
    }

    fn drive(times_ns: &[i64], path_ns: &[i64]) -> Drive {
        let keyframe = |&time_ns: &i64| Keyframe {
            time_ns,
            token: String::new(),
            world_from_ego: on_circle(time_ns),
            exposures: Vec::new(),
            boxes: Vec::new(),
            lidar: None,
        };
        Drive {
            id: String::new(),
            dataset: String::new(),
            origin: DriveOrigin::Recorded,
            place: String::new(),
            projection: MapProjection::spherical(0.0, 0.0, DVec2::ZERO),
            is_georeferenced: false,
            rig: Vec::new(),
            lidars: Vec::new(),
            ego_body: EgoBody { centre_ego: DVec3::ZERO, size_m: DVec3::ONE },
            keyframes: times_ns.iter().map(keyframe).collect(),
            path: Trajectory::new(path_ns.iter().map(|&t| (t, on_circle(t))).collect()).0,
            sweeps: Vec::new(),
            tracks: Vec::new(),
            lane_map: None,
            licence: String::new(),
        }
    }

    #[test]
    fn motion_on_a_circle_is_its_tangent_and_rate() {
        let keyframes = [0, SECOND_NS / 2, SECOND_NS];
        let path: Vec<i64> = (0..=100).map(|i| i * SECOND_NS / 100).collect();
        for (path, at, within_mps) in
            [(&path[..], 1, 0.01), (&path[..], 0, 0.3), (&path[..], 2, 0.3), (&[][..], 1, 0.11)]
        {
            let motion = drive(&keyframes, path).ego_motion(at).unwrap();
            let expect = on_circle(keyframes[at]).vector(DVec3::X) * RADIUS_M * RATE_RADPS;
            assert!((motion.velocity_mps - expect).length() < within_mps, "{motion:?} {expect}");
            assert!((motion.yaw_rate_radps - RATE_RADPS).abs() < 1e-3, "{motion:?}");
        }
        // Once round: the heading passes from π to −π.
        let half_round = (PI / RATE_RADPS * 1e9) as i64;
        let wrapped =
            drive(&[half_round / 2 - SECOND_NS / 4, half_round / 2 + SECOND_NS / 4], &[]).ego_motion(0).unwrap();
        assert!((wrapped.yaw_rate_radps - RATE_RADPS).abs() < 1e-6);
    }

    #[test]
    fn a_drive_of_one_keyframe_has_no_motion() {
        assert_eq!(drive(&[0], &[]).ego_motion(0), None);
        assert_eq!(drive(&[0, SECOND_NS], &[]).ego_motion(2), None);
    }
}

//! Where the vehicle's LiDARs are while they turn.

use trove_model::{Drive, Ego, LidarShot, Pose, RigLidar, Scanner, SensorRay, SweepPhase, World};

use crate::place::{Seeds, next, previous};
use crate::site::Site;

/// Stretches of even motion in a sweep.
const STRETCHES: u32 = 20;

/// A LiDAR so far from the vehicle's box stands clear of it, metres.
const CLEAR_M: f64 = 0.25;

/// A LiDAR with its place on the recording vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct MountedLidar {
    /// What it is.
    pub scanner: Scanner,
    /// Name and place.
    pub mount: RigLidar,
}

/// The sweeps of a keyframe, one a LiDAR; none for a keyframe that the drive does not have.
///
/// Things move for [`SensorRay::MOVING_S`] around the keyframe: a sweep that would leave that time is shifted into it, and one
/// that is longer is centred about the keyframe.
pub fn lidar_shots(
    drive: &Drive,
    site: &Site,
    keyframe: usize,
    lidars: &[MountedLidar],
    seeds: &Seeds,
) -> Vec<LidarShot> {
    let Some(moment) = drive.keyframes.get(keyframe) else { return Vec::new() };
    let shot = |MountedLidar { scanner, mount }: &MountedLidar| {
        let phase = SweepPhase { over: over(mount.phase.over, scanner.sweep_s), ..mount.phase };
        let at = |share: f64| {
            let time_s = scanner.sweep_s * (share - phase.over);
            world_from_ego(drive, keyframe, time_s) * mount.ego_from_lidar
        };
        let world_from_lidar = moment.world_from_ego * mount.ego_from_lidar;
        // Well above the roof the vehicle is in the way, as it is in the recording. Close to it the model's roof, which is not
        // the vehicle's own, would hide too much, and inside everything.
        let vehicle = site.placed(drive.tracks.len(), keyframe);
        let is_close = vehicle.is_some_and(|vehicle| vehicle.grown(CLEAR_M).contains(world_from_lidar.translation));
        let view = format!("ego.{}", mount.name);
        LidarShot {
            scanner: scanner.clone(),
            phase,
            time_ns: moment.time_ns,
            world_from_lidar,
            world_from_ego: moment.world_from_ego,
            way: (0..=STRETCHES).map(|i| at(f64::from(i) / f64::from(STRETCHES))).collect(),
            seed: seeds.noise.child("lidar").nth(keyframe as u64).child(&view),
            carrier: is_close.then(|| site.ego_id(drive)),
            view,
        }
    };
    lidars.iter().map(shot).collect()
}

/// The share of a sweep before its time, as near to what is wanted as things move.
fn over(wanted: f64, sweep_s: f64) -> f64 {
    let most = SensorRay::MOVING_S / sweep_s;
    if most < 0.5 { 0.5 } else { wanted.clamp(1.0 - most.min(1.0), most.min(1.0)) }
}

/// The vehicle some seconds after a keyframe: as its path says, else as between the keyframes, and on from one where the other
/// is missing.
pub(crate) fn world_from_ego(drive: &Drive, keyframe: usize, time_s: f64) -> Pose<World, Ego> {
    let moment = &drive.keyframes[keyframe];
    let on_path = |time_s: f64| drive.path.at(moment.time_ns.saturating_add((time_s * 1e9) as i64));
    if let (Some(then), Some(now)) = (on_path(time_s), on_path(0.0)) {
        // The keyframe's own pose may be another than the path's; the motion is the path's.
        return then * now.inverse() * moment.world_from_ego;
    }
    let beside = [previous(drive, keyframe), next(drive, keyframe)].map(|k| k.map(|k| &drive.keyframes[k]));
    let other = match beside {
        [Some(before), None] => before,
        [Some(before), _] if time_s < 0.0 => before,
        [_, Some(after)] => after,
        [None, None] => return moment.world_from_ego,
    };
    let apart_s = (other.time_ns - moment.time_ns) as f64 * 1e-9;
    let share = if apart_s == 0.0 { 0.0 } else { time_s / apart_s };
    moment.world_from_ego.interpolate(&other.world_from_ego, share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use glam::DVec3;
    use trove_model::Trajectory;

    #[test]
    fn a_sweep_lies_where_things_move() {
        for (wanted, sweep_s, expect) in [
            (1.0, 0.05, 1.0),
            (0.0, 0.05, 0.0),
            (1.0, 0.1, 0.5),
            (1.0, 0.08, 0.625),
            (0.0, 0.08, 0.375),
            (1.0, 0.2, 0.5),
        ] {
            assert!((over(wanted, sweep_s) - expect).abs() < 1e-12, "{wanted} {sweep_s}");
        }
    }

    #[test]
    fn the_vehicle_follows_its_path_and_else_its_keyframes() {
        let mut drive = testing::drive();
        let [a, b] = [0, 1].map(|k| drive.keyframes[k].world_from_ego.translation);
        // Before the first keyframe it goes on as after it.
        let before = world_from_ego(&drive, 0, -0.05).translation;
        assert!((before - (a - (b - a) * 0.1)).length() < 1e-9, "{before} {a} {b}");
        let time_ns = drive.keyframes[1].time_ns;
        let at = |i: i64| (time_ns + i * 50_000_000, Pose::from_yaw(0.0, DVec3::X * (i * i) as f64));
        drive.path = Trajectory::new((-2..3).map(at).collect()).0;
        let moved = world_from_ego(&drive, 1, -0.1).translation - b;
        assert!((moved - DVec3::X * 4.0).length() < 1e-9, "{moved}");
    }
}

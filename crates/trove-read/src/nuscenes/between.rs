//! What was recorded between the keyframes.

use rayon::prelude::*;
use trove_model::{Ego, Outcome, Report, Sweep, Trajectory, World};

use super::can_bus;
use super::exposures::{GlobalFromEgo, Revolution};
use super::files::Files;
use super::lidar;

/// One sweep is read for so many metres that the vehicle drove: from a place nearby it saw the same ground.
const SPACING_M: f64 = 2.0;
/// All sweeps of a scene: 20 million points, which take 240 MB in memory. A drive of 20 s at 100 km/h has half of it.
const MOST_BYTES: u64 = 20_000_000 * lidar::POINT_BYTES as u64;

/// The vehicle's path through the poses of all LiDAR revolutions and of the CAN bus, in the dataset's global frame; empty
/// where those of the keyframes are all.
pub(super) fn path<'a>(
    files: &Files,
    scene: &str,
    keyframes: impl Iterator<Item = &'a Revolution>,
    between: &'a [Revolution],
    report: &Report,
) -> Trajectory<World, Ego> {
    let moments: Vec<_> = keyframes.chain(between).map(|r| (r.time_ns, r.global_from_ego)).collect();
    let keyframes = moments.len() - between.len();
    // The table knows no order.
    let (path, disorder) = Trajectory::new(moments);
    if disorder.duplicates > 0 {
        let example = format!("{scene}: {}", disorder.duplicates);
        report.note(Outcome::Dropped, "pose of a LiDAR sweep of a time that another has", example);
    }
    let path = can_bus::refined(files.root, scene, path, report);
    if path.moments().len() > keyframes { path } else { Trajectory::default() }
}

/// Those sweeps between the keyframes that are read, in the order of time.
pub(super) fn chosen<'a>(
    files: &Files,
    keyframes: impl Iterator<Item = &'a Revolution>,
    between: &'a [Revolution],
    report: &Report,
) -> Vec<&'a Revolution> {
    let keyframes = keyframes.filter(|r| r.file.is_some()).map(|r| (r, true));
    let mut all: Vec<_> = keyframes.chain(between.iter().map(|r| (r, false))).collect();
    all.sort_by_key(|(r, _)| r.time_ns);
    let (mut chosen, mut left, mut last) = (Vec::new(), MOST_BYTES, None);
    for (revolution, is_keyframe) in all {
        let at = revolution.global_from_ego.translation;
        let is_near = last.is_some_and(|last| at.distance(last) < SPACING_M);
        if is_keyframe {
            last = Some(at);
            continue;
        }
        let Some(file) = revolution.file.as_ref().filter(|_| !is_near) else { continue };
        let bytes = files.path(file).metadata().map_or(0, |m| m.len());
        if bytes > left {
            report.note(Outcome::Dropped, "LiDAR sweep between keyframes: a scene has too many points", file);
            continue;
        }
        left -= bytes;
        last = Some(at);
        chosen.push(revolution);
    }
    chosen
}

/// Reads chosen sweeps.
pub(super) fn sweeps(
    files: &Files,
    chosen: &[&Revolution],
    world_pose: impl Fn(GlobalFromEgo) -> GlobalFromEgo + Sync,
    report: &Report,
) -> Vec<Sweep> {
    let sweep = |revolution: &&Revolution| {
        let points = revolution.file.as_ref()?;
        let world_from_sensor = world_pose(revolution.global_from_ego) * revolution.ego_from_sensor;
        // Labels are of keyframes alone.
        let lidar = lidar::sweep(files.root, points, None, world_from_sensor, report)?;
        Some(Sweep { time_ns: revolution.time_ns, lidar })
    };
    chosen.par_iter().filter_map(sweep).collect()
}

//! Velodyne sweeps: `.bin` of little-endian float32 x, y, z, reflectance; `.txt` of the same in unsynced recordings.

use std::path::Path;

use glam::DVec3;
use rayon::prelude::*;
use trove_files::read_regular;
use trove_model::{Keyframe, LidarSweep, Outcome, Pose, Report, SensorFrame, World};

use super::text;

const POINT_BYTES: usize = 16;
/// Several times a sweep of 64 beams, as text.
const LARGEST_SWEEP: u64 = 128 << 20;
/// Two sweeps a second tell all that they do about walls and ground, as nuScenes' keyframes; ten would take gigabytes.
const STEP_NS: i64 = 450_000_000;
/// However long the drive is.
const MOST_SWEEPS: usize = 200;

/// Reads the sweeps of keyframes, each the keyframe's index, its file below the root, and its pose: where there are more
/// than two a second, or too many for memory, some of them.
pub(super) fn read(
    root: &Path,
    sweeps: &[(usize, String, Pose<World, SensorFrame>)],
    keyframes: &mut [Keyframe],
    report: &Report,
) {
    let mut last_ns = i64::MIN;
    let mut spaced = Vec::new();
    for sweep in sweeps {
        let time_ns = keyframes[sweep.0].time_ns;
        if time_ns.saturating_sub(last_ns) >= STEP_NS {
            last_ns = time_ns;
            spaced.push(sweep);
        }
    }
    let every = spaced.len().div_ceil(MOST_SWEEPS).max(1);
    let chosen: Vec<_> = spaced.into_iter().step_by(every).collect();
    if chosen.len() < sweeps.len() {
        let example = format!("{} of {} are read", chosen.len(), sweeps.len());
        report.note(Outcome::Dropped, "LiDAR sweeps closer in time than is needed", example);
    }
    let one = |(keyframe, file, pose): &&(usize, String, Pose<World, SensorFrame>)| {
        (*keyframe, sweep(root, file, *pose, report))
    };
    let read: Vec<_> = chosen.par_iter().map(one).collect();
    for (keyframe, sweep) in read {
        keyframes[keyframe].lidar = sweep;
    }
}

/// A sweep; `None` where the file cannot be used, which is reported.
fn sweep(root: &Path, file: &str, world_from_sensor: Pose<World, SensorFrame>, report: &Report) -> Option<LidarSweep> {
    let unusable = |what: &str, why: String| report.note(Outcome::Dropped, what, format!("{file}: {why}"));
    let bytes = read_regular(&root.join(file), LARGEST_SWEEP)
        .inspect_err(|error| unusable("LiDAR file that cannot be read", error.to_string()))
        .ok()?;
    let points = if file.ends_with(".txt") {
        of_text(&String::from_utf8_lossy(&bytes))
    } else if bytes.is_empty() || bytes.len() % POINT_BYTES != 0 {
        unusable("truncated LiDAR sweep", format!("{} bytes, not a multiple of {POINT_BYTES}", bytes.len()));
        return None;
    } else {
        of_binary(&bytes)
    };
    let usable = points.iter().flatten().filter(|point| point.is_finite());
    let points_world: Vec<_> = usable.map(|point| world_from_sensor.point(*point).as_vec3()).collect();
    if points_world.len() < points.len() {
        let what = "LiDAR point that is not a number";
        report.note(Outcome::Dropped, what, format!("{file}: {}", points.len() - points_world.len()));
    }
    let origin_world = world_from_sensor.translation;
    (!points_world.is_empty()).then_some(LidarSweep { origin_world, points_world, classes: Vec::new() })
}

fn of_binary(bytes: &[u8]) -> Vec<Option<DVec3>> {
    let point = |point: &[u8]| {
        let value = |at: usize| f64::from(f32::from_le_bytes([point[at], point[at + 1], point[at + 2], point[at + 3]]));
        Some(DVec3::new(value(0), value(4), value(8)))
    };
    bytes.chunks_exact(POINT_BYTES).map(point).collect()
}

fn of_text(lines: &str) -> Vec<Option<DVec3>> {
    let point = |line: &str| {
        let values = text::numbers(line)?;
        (values.len() == 4).then(|| DVec3::new(values[0], values[1], values[2]))
    };
    lines.lines().filter(|line| !line.trim().is_empty()).map(point).collect()
}

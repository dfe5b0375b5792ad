//! `LIDAR_TOP` sweeps and their lidarseg labels.

use std::path::Path;

use trove_files::read_regular;
use trove_model::{LidarClass, LidarSweep, Outcome, Pose, Report, SensorFrame, World};

/// x, y, z, intensity, ring: each a little-endian float32.
const POINT_BYTES: usize = 20;

/// Several times a sweep of 128 beams.
const LARGEST_SWEEP: u64 = 128 << 20;

/// Where a sweep and its labels lie; `labels` is empty where there are none.
pub(super) struct SweepFiles<'a> {
    pub(super) points: &'a str,
    pub(super) labels: Option<&'a str>,
}

/// A sweep; `None` where the file cannot be used, which is reported.
pub(super) fn sweep(
    root: &Path,
    files: &SweepFiles,
    world_from_sensor: Pose<World, SensorFrame>,
    classes: &[LidarClass; 256],
    report: &Report,
) -> Option<LidarSweep> {
    let bytes = read(root, files.points, report)?;
    if bytes.is_empty() || bytes.len() % POINT_BYTES != 0 {
        let example = format!("{}: {} bytes, not a multiple of {POINT_BYTES}", files.points, bytes.len());
        report.note(Outcome::Dropped, "truncated LiDAR sweep", example);
        return None;
    }
    let labels = files.labels.and_then(|file| labels(root, file, bytes.len() / POINT_BYTES, report));
    let mut sweep =
        LidarSweep { origin_world: world_from_sensor.translation, points_world: Vec::new(), classes: Vec::new() };
    for (i, point) in bytes.chunks_exact(POINT_BYTES).enumerate() {
        let value = |at: usize| f64::from(f32::from_le_bytes([point[at], point[at + 1], point[at + 2], point[at + 3]]));
        let point_sensor = glam::DVec3::new(value(0), value(4), value(8));
        if !point_sensor.is_finite() {
            report.note(Outcome::Dropped, "LiDAR point that is not a number", files.points);
            continue;
        }
        sweep.points_world.push(world_from_sensor.point(point_sensor).as_vec3());
        if let Some(labels) = &labels {
            sweep.classes.push(classes[usize::from(labels[i])]);
        }
    }
    Some(sweep)
}

/// One category number a point; `None` where there are none, or not one a point.
fn labels(root: &Path, file: &str, points: usize, report: &Report) -> Option<Vec<u8>> {
    let labels = read(root, file, report)?;
    if labels.len() == points {
        return Some(labels);
    }
    report.note(Outcome::Dropped, "lidarseg labels", format!("{file}: {} for {points} points", labels.len()));
    None
}

fn read(root: &Path, file: &str, report: &Report) -> Option<Vec<u8>> {
    read_regular(&root.join(file), LARGEST_SWEEP)
        .inspect_err(|e| report.note(Outcome::Dropped, "LiDAR file that cannot be read", format!("{file}: {e}")))
        .ok()
}

//! `LIDAR_TOP` sweeps and their lidarseg labels.

use std::path::Path;

use trove_files::read_regular;
use trove_model::{LidarClass, LidarSweep, Outcome, Pose, Report, SensorFrame, World};

/// x, y, z, intensity, ring: each a little-endian float32.
pub(super) const POINT_BYTES: usize = 20;

/// Several times a sweep of 128 beams.
const LARGEST_SWEEP: u64 = 128 << 20;

/// A sweep; `None` where the file cannot be used, which is reported. `labels` are the file of them, where there is one, and
/// what the numbers in it mean.
pub(super) fn sweep(
    root: &Path,
    points: &str,
    labels: Option<(&str, &[LidarClass; 256])>,
    world_from_sensor: Pose<World, SensorFrame>,
    report: &Report,
) -> Option<LidarSweep> {
    let bytes = read(root, points, report)?;
    if bytes.is_empty() || bytes.len() % POINT_BYTES != 0 {
        let example = format!("{points}: {} bytes, not a multiple of {POINT_BYTES}", bytes.len());
        report.note(Outcome::Dropped, "truncated LiDAR sweep", example);
        return None;
    }
    let count = bytes.len() / POINT_BYTES;
    let labels = labels.and_then(|(file, classes)| Some((read_labels(root, file, count, report)?, classes)));
    let mut sweep = LidarSweep {
        origin_world: world_from_sensor.translation,
        points_world: Vec::with_capacity(count),
        classes: Vec::new(),
    };
    for (i, point) in bytes.chunks_exact(POINT_BYTES).enumerate() {
        let value = |at: usize| f64::from(f32::from_le_bytes([point[at], point[at + 1], point[at + 2], point[at + 3]]));
        let point_sensor = glam::DVec3::new(value(0), value(4), value(8));
        if !point_sensor.is_finite() {
            report.note(Outcome::Dropped, "LiDAR point that is not a number", points);
            continue;
        }
        sweep.points_world.push(world_from_sensor.point(point_sensor).as_vec3());
        if let Some((labels, classes)) = &labels {
            sweep.classes.push(classes[usize::from(labels[i])]);
        }
    }
    Some(sweep)
}

/// One category number a point; `None` where there are none, or not one a point.
fn read_labels(root: &Path, file: &str, points: usize, report: &Report) -> Option<Vec<u8>> {
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

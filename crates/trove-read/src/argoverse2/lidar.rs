//! LiDAR sweeps: the returns of both sensors in one file, in the vehicle's frame at the sweep's time.

use std::path::Path;

use glam::DVec3;
use trove_model::{LidarSweep, Outcome, Pose, Report, World};

use super::feather::Table;
use super::frames::Axle;

/// A sweep; `None`, reported, where the file cannot be used.
pub(super) fn sweep(
    path: &Path,
    world_from_axle: &Pose<World, Axle>,
    lidar_axle: DVec3,
    report: &Report,
) -> Option<LidarSweep> {
    let columns = Table::read(path, &["x", "y", "z"])
        .and_then(|table| Ok([table.numbers("x")?, table.numbers("y")?, table.numbers("z")?]));
    let [x, y, z] = columns
        .inspect_err(|e| report.note(Outcome::Dropped, "Argoverse 2 LiDAR sweep that cannot be read", e))
        .ok()?;
    let mut points_world = Vec::with_capacity(x.len());
    for ((x, y), z) in x.into_iter().zip(y).zip(z) {
        let point_axle = DVec3::new(x, y, z);
        if point_axle.is_finite() {
            points_world.push(world_from_axle.point(point_axle).as_vec3());
        } else {
            report.note(Outcome::Dropped, "LiDAR point that is not a number", path.display());
        }
    }
    Some(LidarSweep { origin_world: world_from_axle.point(lidar_axle), points_world, classes: Vec::new() })
}

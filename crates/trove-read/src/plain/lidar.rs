//! LiDAR sweeps and their labels.

use glam::DVec3;
use trove_files::read_regular;
use trove_format::PlainLidar;
use trove_model::{Ego, LidarClass, LidarSweep, Outcome, Pose, Report, SensorFrame, World};

use super::earth::Earth;
use super::exposures::Place;
use super::faults::{Faults, Part};
use super::poses;
use crate::lidar_file;

/// Larger files of labels are refused, bytes.
const MOST_LABELS: u64 = 256 << 20;
/// What the numbers in a file of labels mean.
const CLASSES: [LidarClass; 6] = [
    LidarClass::Other,
    LidarClass::Road,
    LidarClass::Sidewalk,
    LidarClass::Terrain,
    LidarClass::Vegetation,
    LidarClass::Manmade,
];

/// A sweep; `None` where its file cannot be used, which is reported, or its record is at fault.
pub(super) fn sweep(
    lidar: &PlainLidar,
    world_from_ego: Pose<World, Ego>,
    (earth, place): (&Earth, &Place),
    part: &Part,
    faults: &mut Faults,
    report: &Report,
) -> Option<LidarSweep> {
    let mounted = lidar.ego_from_lidar.as_ref().map(|p| poses::pose("lidar.ego_from_lidar", p)).transpose();
    let mounted: Option<Option<Pose<Ego, SensorFrame>>> = faults.take(part, mounted);
    let file = faults.take(part, place.file("lidar.file", &lidar.file))?;
    let labels = match &lidar.labels {
        Some(labels) => Some(faults.take(part, place.file("lidar.labels", labels))?),
        None => None,
    };
    if lidar.is_in_world && !earth.has_world() {
        faults.say(part, "lidar.is_in_world: expected false, since the georeference is wgs84, found true");
        return None;
    }
    let world_from_sensor = world_from_ego * mounted?.unwrap_or(Pose::IDENTITY);
    let points = lidar_file::read(&place.root.join(&file))
        .inspect_err(|why| report.note(Outcome::Dropped, "LiDAR file that cannot be used", format!("{file}: {why}")))
        .ok()?;
    let labels = labels.and_then(|labels| read_labels(place, &labels, points.len(), report));
    let mut sweep = LidarSweep { origin_world: world_from_sensor.translation, points_world: vec![], classes: vec![] };
    sweep.points_world.reserve(points.len());
    for (i, point) in points.into_iter().enumerate() {
        let point = if lidar.is_in_world { earth.point(point) } else { world_from_sensor.point(point) };
        if !point.abs().cmplt(DVec3::splat(f64::from(f32::MAX))).all() {
            report.note(Outcome::Dropped, "LiDAR point that is not a number", &file);
            continue;
        }
        sweep.points_world.push(point.as_vec3());
        if let Some(labels) = &labels {
            sweep.classes.push(CLASSES.get(usize::from(labels[i])).copied().unwrap_or(LidarClass::Other));
        }
    }
    Some(sweep)
}

/// One number a point; `None` where there are none, or not one a point.
fn read_labels(place: &Place, file: &str, points: usize, report: &Report) -> Option<Vec<u8>> {
    let dropped = |why: String| report.note(Outcome::Dropped, "LiDAR labels", format!("{file}: {why}"));
    let labels = read_regular(&place.root.join(file), MOST_LABELS).inspect_err(|e| dropped(e.to_string())).ok()?;
    if labels.len() != points {
        dropped(format!("expected {points} bytes, one a point, found {}", labels.len()));
        return None;
    }
    let unknown = labels.iter().filter(|&&label| usize::from(label) >= CLASSES.len()).count();
    if unknown > 0 {
        report.note(Outcome::Warned, "LiDAR labels above 5, taken as other", format!("{file}: {unknown}"));
    }
    Some(labels)
}

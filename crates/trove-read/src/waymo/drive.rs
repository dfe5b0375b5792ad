//! A segment's records → `Drive`.

use std::path::Path;

use glam::{DVec2, DVec3};
use trove_model::{
    Drive, DriveOrigin, Ego, EgoBody, Keyframe, LidarSweep, MapProjection, Outcome, Pose, Report, Trajectory, World,
};

use super::records::{FrameRecord, Returns, Segment};
use super::{boxes, cameras, fault, lane_map, vocabulary};
use crate::ReadError;

/// A Chrysler Pacifica, which carried Waymo's fourth generation: published length, width without mirrors, and height. The
/// wheelbase of 3.089 m and the overhangs put the car's centre about 1.46 m before the rear axle.
const EGO_BODY: EgoBody = EgoBody { centre_ego: DVec3::new(1.46, 0.0, 0.888), size_m: DVec3::new(5.176, 2.022, 1.777) };

/// The drive of a segment that was read from a file.
pub(super) fn drive(path: &Path, mut segment: Segment, report: &Report) -> Result<Drive, ReadError> {
    in_order(&mut segment, report);
    let Some(first) = segment.frames.first() else {
        return Err(fault::damaged(path, &segment.name, "at least one frame with a vehicle pose", "none usable"));
    };
    let anchor_m = first.global_from_ego.translation.round();
    let world_pose = |mut pose: Pose<World, _>| {
        pose.translation -= anchor_m;
        pose
    };
    let rig = cameras::rig(&segment, report);
    let (mut keyframes, mut labels) = (Vec::with_capacity(segment.frames.len()), Vec::new());
    for frame in std::mem::take(&mut segment.frames) {
        let world_from_ego = world_pose(frame.global_from_ego);
        keyframes.push(Keyframe {
            time_ns: frame.time_us.saturating_mul(1000),
            token: frame.time_us.to_string(),
            world_from_ego,
            exposures: cameras::exposures(&frame, &rig, world_pose, report),
            boxes: Vec::new(),
            lidar: frame.returns.map(|returns| sweep(returns, &world_from_ego)),
        });
        labels.push(frame.labels);
    }
    let tracks = boxes::place(&mut keyframes, labels, report);
    let path: Vec<DVec2> = keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let world_from_map = -(anchor_m + segment.map_from_global_m).truncate();
    Ok(Drive {
        lane_map: lane_map::of(&segment.map, world_from_map, &path, report),
        projection: projection(&segment.location, report),
        id: segment.name,
        dataset: "waymo".to_owned(),
        origin: DriveOrigin::Recorded,
        place: segment.location,
        is_georeferenced: false,
        rig: rig.into_iter().map(|(_, camera)| camera).collect(),
        ego_body: EGO_BODY,
        keyframes,
        path: Trajectory::default(),
        lidars: Vec::new(),
        sweeps: Vec::new(),
        tracks,
        licence: vocabulary::licence().to_owned(),
    })
}

/// Sorts frames by time and leaves out those of a time that another has.
fn in_order(segment: &mut Segment, report: &Report) {
    let frames = &mut segment.frames;
    if !frames.is_sorted_by_key(|frame| frame.time_us) {
        report.note(Outcome::Substituted, "Waymo frames out of order, put in order of time", &segment.name);
        frames.sort_by_key(|frame| frame.time_us);
    }
    frames.dedup_by(|second: &mut FrameRecord, first| {
        let is_same = second.time_us == first.time_us;
        if is_same {
            report.note(Outcome::Dropped, "Waymo frame: second of its time", second.time_us);
        }
        is_same
    });
}

fn sweep(returns: Returns, world_from_ego: &Pose<World, Ego>) -> LidarSweep {
    let mut points_world = returns.points_ego;
    for point in &mut points_world {
        *point = world_from_ego.point(point.as_dvec3()).as_vec3();
    }
    LidarSweep { origin_world: world_from_ego.point(returns.origin_ego), points_world, classes: Vec::new() }
}

/// The middle of the segment's city.
fn projection(location: &str, report: &Report) -> MapProjection {
    let place = vocabulary::place(location);
    if place.is_none() {
        let example = if location.is_empty() { "a segment without location" } else { location };
        report.note(Outcome::Warned, "place of unknown origin: sun and customs are those of 0° N, 0° E", example);
    }
    let (lat_deg, lon_deg) = place.map_or((0.0, 0.0), |place| (place.lat_deg, place.lon_deg));
    MapProjection::ellipsoidal(lat_deg, lon_deg, DVec2::ZERO)
}

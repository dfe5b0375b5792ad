//! Labels → boxes and tracks.

use std::collections::BTreeMap;

use glam::DVec3;
use trove_model::{Body, Cuboid, Ego, Keyframe, Kind, ObjectBox, Outcome, Pose, Report, Track};

use super::records::LabelRecord;
use super::vocabulary;

/// Nothing that is annotated is longer, metres.
const LONGEST_BOX_M: f64 = 200.0;
/// Nor farther away, metres.
const FARTHEST_BOX_M: f64 = 1000.0;
/// Nor faster, m/s.
const FASTEST_MPS: f64 = 200.0;
/// Signs that reach higher hang on gantries and wires, of which the dataset says nothing, metres.
const TALLEST_SIGN_M: f64 = 4.5;
/// Signs that begin lower stand on the ground, metres.
const LOWEST_PANEL_M: f64 = 0.3;

/// Puts each keyframe's labels into it and follows the objects, in the order in which they appear.
pub(super) fn place(keyframes: &mut [Keyframe], labels: Vec<Vec<LabelRecord>>, report: &Report) -> Vec<Track> {
    let (mut tracks, mut track_of) = (Vec::<Track>::new(), BTreeMap::<String, usize>::new());
    let mut largest_m: Vec<(i64, DVec3)> = Vec::new();
    for (k, (keyframe, labels)) in keyframes.iter_mut().zip(labels).enumerate() {
        for label in labels {
            let token = format!("{}-{}", keyframe.token, label.id);
            let label = with_pole(label, report);
            let mut object = match object(keyframe, &label, token.clone()) {
                Ok(object) => object,
                Err(why) => {
                    report.note(Outcome::Dropped, &format!("Waymo label: {why}"), &token);
                    continue;
                }
            };
            let track = *track_of.entry(label.id).or_insert_with_key(|id| {
                tracks.push(Track { token: id.clone(), kind: object.kind, boxes: Vec::new() });
                largest_m.push((label.kind, DVec3::ZERO));
                tracks.len() - 1
            });
            if tracks[track].boxes.last().is_some_and(|(last, _)| *last == k) {
                report.note(Outcome::Dropped, "Waymo label: second of its object in a frame", &token);
                continue;
            }
            largest_m[track].1 = largest_m[track].1.max(object.cuboid.size_m);
            tracks[track].boxes.push((k, object.cuboid));
            object.track = track;
            keyframe.boxes.push(object);
        }
    }
    // A track is one thing, whatever part of it a frame shows.
    for (track, (number, size_m)) in tracks.iter_mut().zip(largest_m) {
        track.kind = vocabulary::kind(number, size_m).map_or(track.kind, |row| row.kind);
    }
    for object in keyframes.iter_mut().flat_map(|keyframe| &mut keyframe.boxes) {
        object.kind = tracks[object.track].kind;
    }
    tracks
}

/// Waymo's boxes of signs are those of their panels; ours stand on poles. The ground is where the vehicle's wheels are.
fn with_pole(mut label: LabelRecord, report: &Report) -> LabelRecord {
    let is_sign = vocabulary::kind(label.kind, label.size_m).is_some_and(|row| row.kind == Kind::TrafficSign);
    let (bottom_m, top_m) = (label.centre_ego.z - label.size_m.z / 2.0, label.centre_ego.z + label.size_m.z / 2.0);
    if is_sign && bottom_m > LOWEST_PANEL_M && top_m <= TALLEST_SIGN_M {
        report.note(Outcome::Guessed, "pole of a Waymo sign, whose box is its panel's", &label.id);
        (label.centre_ego.z, label.size_m.z) = (top_m / 2.0, top_m);
    }
    label
}

fn object(keyframe: &Keyframe, label: &LabelRecord, token: String) -> Result<ObjectBox, &'static str> {
    if label.id.is_empty() {
        return Err("no id");
    }
    if !(label.centre_ego.abs().cmplt(DVec3::splat(FARTHEST_BOX_M)).all() && label.heading_rad.is_finite()) {
        return Err("no usable position");
    }
    if !(label.size_m.cmpgt(DVec3::ZERO).all() && label.size_m.cmple(DVec3::splat(LONGEST_BOX_M)).all()) {
        return Err("no usable size");
    }
    let row = vocabulary::kind(label.kind, label.size_m).ok_or("unknown type")?;
    if row.kind == Kind::TrafficSign && label.centre_ego.z + label.size_m.z / 2.0 > TALLEST_SIGN_M {
        return Err("sign high above the road, on what is not told");
    }
    let ego_from_body = Pose::<Ego, Body>::from_yaw(label.heading_rad, label.centre_ego);
    Ok(ObjectBox {
        track: 0,
        kind: row.kind,
        category: row.category.clone(),
        token,
        cuboid: Cuboid { world_from_body: keyframe.world_from_ego * ego_from_body, size_m: label.size_m },
        velocity_mps: label.velocity_mps.filter(|v| v.abs().cmplt(DVec3::splat(FASTEST_MPS)).all()),
        is_parked: None,
        attributes: Vec::new(),
        lidar_points: label.lidar_points.and_then(|points| u32::try_from(points).ok()),
        visibility: None,
    })
}

//! Boxes and tracks.

use std::collections::BTreeMap;

use glam::DVec3;
use trove_format::PlainBox;
use trove_model::{Body, Cuboid, Ego, Keyframe, Kind, ObjectBox, Pose, Track, World};

use super::earth::{self, Earth};
use super::faults::Faults;
use super::keyframes::Posed;
use super::poses;

/// Nothing that is annotated is longer, metres.
const LONGEST_BOX_M: f64 = 200.0;
/// Neighbours in time farther apart than this tell no velocity, seconds; twice this where there is one on either side.
const LONGEST_GAP_S: f64 = 1.5;

/// Puts the boxes into their keyframes, and numbers the tracks in the order in which they appear.
pub(super) fn place(posed: &[Posed], keyframes: &mut [Keyframe], earth: &Earth, faults: &mut Faults) -> Vec<Track> {
    let (mut tracks, mut track_of) = (Vec::<Track>::new(), BTreeMap::<&str, usize>::new());
    for (k, (posed, keyframe)) in posed.iter().zip(keyframes.iter_mut()).enumerate() {
        for located in &posed.moment.value.boxes {
            let given = &located.value;
            let Some(mut object) = faults.take(&located.part, object(given, posed.world_from_ego, earth)) else {
                continue;
            };
            let track = *track_of.entry(&given.track).or_insert_with(|| {
                tracks.push(Track { token: given.track.clone(), kind: given.kind, boxes: Vec::new() });
                tracks.len() - 1
            });
            if tracks[track].boxes.last().is_some_and(|(last, _)| *last == k) {
                faults.say(&located.part, &format!("expected one box of track {:?}, found a second", given.track));
                continue;
            }
            tracks[track].boxes.push((k, object.cuboid));
            object.track = track;
            keyframe.boxes.push(object);
        }
    }
    name_kinds(keyframes, &mut tracks);
    let times_ns: Vec<i64> = keyframes.iter().map(|k| k.time_ns).collect();
    for (k, keyframe) in keyframes.iter_mut().enumerate() {
        for object in keyframe.boxes.iter_mut().filter(|object| object.velocity_mps.is_none()) {
            object.velocity_mps = velocity_mps(&tracks[object.track], k, &times_ns);
        }
    }
    tracks
}

fn object(given: &PlainBox, world_from_ego: Pose<World, Ego>, earth: &Earth) -> Result<ObjectBox, String> {
    let world_from_body: Pose<World, Body> = match (&given.world_from_body, &given.ego_from_body) {
        (Some(world), None) if earth.has_world() => earth.pose(poses::pose("world_from_body", world)?),
        (None, Some(ego)) => world_from_ego * poses::pose("ego_from_body", ego)?,
        (Some(_), None) => return Err("expected ego_from_body, since the georeference is wgs84".to_owned()),
        (Some(_), Some(_)) => return Err("expected world_from_body or ego_from_body, found both".to_owned()),
        (None, None) => return Err("expected world_from_body or ego_from_body, found neither".to_owned()),
    };
    earth::near("the box", world_from_body.translation)?;
    let size_m = DVec3::from_array(given.size_m);
    if !(size_m.min_element() > 0.0 && size_m.max_element() <= LONGEST_BOX_M) {
        return Err(format!("size_m: expected more than 0 and at most {LONGEST_BOX_M}, found {:?}", given.size_m));
    }
    let velocity = given.velocity_mps.map(DVec3::from_array);
    if velocity.is_some_and(|v| v.abs().max_element() > 1e3) {
        return Err(format!("velocity_mps: expected at most 1000, found {:?}", given.velocity_mps.unwrap_or_default()));
    }
    let is_share = given.visibility.is_none_or(|share| (0.0..=1.0).contains(&share));
    if !is_share {
        return Err(format!("visibility: expected 0 to 1, found {}", given.visibility.unwrap_or_default()));
    }
    Ok(ObjectBox {
        track: 0,
        kind: given.kind,
        category: given.category.clone().unwrap_or_else(|| given.kind.name().to_owned()),
        token: given.token.clone(),
        cuboid: Cuboid { world_from_body, size_m },
        velocity_mps: velocity.map(|v| earth.vector(v)),
        is_parked: given.parked,
        attributes: given.attributes.clone(),
        lidar_points: given.lidar_points,
        visibility: given.visibility,
    })
}

/// A track is what most of its boxes are, and of equally many the first.
fn name_kinds(keyframes: &[Keyframe], tracks: &mut [Track]) {
    let mut votes = vec![BTreeMap::<Kind, usize>::new(); tracks.len()];
    for object in keyframes.iter().flat_map(|k| &k.boxes) {
        *votes[object.track].entry(object.kind).or_default() += 1;
    }
    for (track, votes) in tracks.iter_mut().zip(votes) {
        let most = votes.values().max().copied().unwrap_or_default();
        if votes.get(&track.kind).is_none_or(|&of_first| of_first < most) {
            track.kind = votes.into_iter().find(|&(_, n)| n == most).map_or(track.kind, |(kind, _)| kind);
        }
    }
}

/// From the box before to the one after, or this one where there is none.
fn velocity_mps(track: &Track, keyframe: usize, times_ns: &[i64]) -> Option<DVec3> {
    let i = track.boxes.binary_search_by_key(&keyframe, |(k, _)| *k).ok()?;
    let (first, last) = (i.saturating_sub(1), (i + 1).min(track.boxes.len() - 1));
    let longest_s = if first < i && i < last { 2.0 * LONGEST_GAP_S } else { LONGEST_GAP_S };
    let ((first, from), (last, to)) = (track.boxes[first], track.boxes[last]);
    let seconds = times_ns[last].saturating_sub(times_ns[first]) as f64 * 1e-9;
    let path_m = to.world_from_body.translation - from.world_from_body.translation;
    (seconds > 0.0 && seconds <= longest_s).then(|| path_m / seconds)
}

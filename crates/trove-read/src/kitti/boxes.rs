//! Annotated objects → boxes and tracks.

use std::collections::BTreeMap;

use glam::DVec3;
use trove_model::{Body, Cuboid, Ego, Keyframe, ObjectBox, Outcome, Pose, Report, Track};

use super::facts::FACTS;

/// Boxes farther apart in time than this from one tell nothing of its velocity; at ten a second nearer ones jitter.
const REACH_NS: i64 = 510_000_000;

/// An object as it was annotated at a keyframe.
pub(super) struct Annotation {
    pub(super) keyframe: usize,
    /// The dataset's name of the object.
    pub(super) instance: String,
    pub(super) category: String,
    /// The dataset's name of the annotation.
    pub(super) token: String,
    pub(super) ego_from_body: Pose<Ego, Body>,
    pub(super) size_m: DVec3,
    /// The words for truncation and occlusion, as the file has them.
    pub(super) truncation: String,
    pub(super) occlusion: String,
}

/// Puts annotations into their keyframes and follows their instances.
pub(super) fn place(mut annotations: Vec<Annotation>, keyframes: &mut [Keyframe], report: &Report) -> Vec<Track> {
    annotations.sort_by_key(|annotation| annotation.keyframe);
    let (mut tracks, mut track_of) = (Vec::<Track>::new(), BTreeMap::new());
    for annotation in annotations {
        let Annotation { keyframe, instance, category, token, ego_from_body, size_m, truncation, occlusion } =
            annotation;
        let dropped = |why: &str| report.note(Outcome::Dropped, &format!("KITTI label: {why}"), &token);
        let Some(kind) = FACTS.kind(&category) else {
            dropped(&format!("unknown class '{category}'"));
            continue;
        };
        let track = *track_of.entry(instance.clone()).or_insert_with(|| {
            tracks.push(Track { token: instance, kind, boxes: Vec::new() });
            tracks.len() - 1
        });
        if tracks[track].boxes.last().is_some_and(|(last, _)| *last == keyframe) {
            dropped("second of its object in a frame");
            continue;
        }
        let cuboid = Cuboid { world_from_body: keyframes[keyframe].world_from_ego * ego_from_body, size_m };
        tracks[track].boxes.push((keyframe, cuboid));
        keyframes[keyframe].boxes.push(ObjectBox {
            track,
            kind,
            category,
            token,
            cuboid,
            velocity_mps: None,
            visibility: occlusion.parse().ok().and_then(|number| FACTS.visibility(number)),
            is_parked: None,
            attributes: vec![format!("truncation={truncation}"), format!("occlusion={occlusion}")],
            lidar_points: None,
        });
    }
    tracks
}

/// Velocities of all boxes, from the first to the last of their objects' boxes about half a second before and after.
pub(super) fn tell_velocities(tracks: &[Track], keyframes: &mut [Keyframe]) {
    for (track, Track { boxes, .. }) in tracks.iter().enumerate() {
        let times_ns: Vec<i64> = boxes.iter().map(|(keyframe, _)| keyframes[*keyframe].time_ns).collect();
        let (mut first, mut last) = (0, 0);
        for (i, (keyframe, _)) in boxes.iter().enumerate() {
            while times_ns[i].saturating_sub(times_ns[first]) > REACH_NS {
                first += 1;
            }
            while last + 1 < boxes.len() && times_ns[last + 1].saturating_sub(times_ns[i]) <= REACH_NS {
                last += 1;
            }
            let seconds = (times_ns[last] - times_ns[first]) as f64 * 1e-9;
            let at = |i: usize| boxes[i].1.world_from_body.translation;
            let velocity_mps = (seconds > 0.0).then(|| (at(last) - at(first)) / seconds);
            let object = keyframes[*keyframe].boxes.iter_mut().find(|object| object.track == track);
            if let Some(object) = object {
                object.velocity_mps = velocity_mps;
            }
        }
    }
}

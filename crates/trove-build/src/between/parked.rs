//! Vehicles that stand for good: one place for the whole stay, however their boxes wander.

use std::ops::Range;

use glam::DVec3;
use trove_model::{Body, Drive, ObjectBox, Outcome, Pose, Report, World};

use super::course::is_tremor;

/// Boxes of what is told to be parked lie no farther from their middle, metres: those of nuScenes' scene 0103 lie 8 cm from it
/// at most in half of the vehicles, 26 cm in 90 %, and 92 cm in the worst …
const WANDERS_M: f64 = 1.0;
/// … and of what is not told to be, but stands.
const STANDS_M: f64 = 0.3;
/// Nor are they turned farther from it, radians.
const TURNS_RAD: f64 = 0.1;
/// Fewer boxes do not tell that something never moves where the annotator does not say so.
const FEWEST: usize = 4;

/// Gives every vehicle that is parked the middle of its boxes' poses for as long as it is: what the annotator calls so, and
/// what is not told but never leaves its place. What its boxes say of its size stays.
pub(super) fn settle(drive: &mut Drive, report: &Report) {
    for i in 0..drive.tracks.len() {
        let track = &drive.tracks[i];
        if !track.kind.is_vehicle() {
            continue;
        }
        let told: Vec<Option<bool>> =
            track.boxes.iter().map(|(k, _)| annotated(drive, *k, i).and_then(|object| object.is_parked)).collect();
        for stay in stays(&told) {
            let boxes = &drive.tracks[i].boxes[stay.clone()];
            let most_m = if told[stay.clone()].contains(&Some(true)) { WANDERS_M } else { STANDS_M };
            let poses = boxes.iter().map(|(_, cuboid)| cuboid.world_from_body);
            let Some(middle) = middle(poses, most_m) else { continue };
            let wanders_m = boxes.iter().map(|(_, c)| off_m(&c.world_from_body, &middle)).fold(0.0, f64::max);
            // Heights are the ground's.
            let flat = |pose: &Pose<World, Body>| (pose.rotation, pose.translation.with_z(0.0));
            if boxes.iter().all(|(_, c)| is_tremor(flat(&c.world_from_body), flat(&middle))) {
                continue;
            }
            let name = format!("{} ({}), {wanders_m:.2} m", drive.tracks[i].token, drive.tracks[i].kind.name());
            report.note(Outcome::Substituted, "boxes of a parked vehicle that wander, held in their middle", name);
            for place in stay {
                let (k, cuboid) = &mut drive.tracks[i].boxes[place];
                cuboid.world_from_body = middle;
                let keyframe = drive.keyframes.get_mut(*k);
                let object = keyframe.and_then(|k| k.boxes.iter_mut().find(|object| object.track == i));
                if let Some(object) = object {
                    object.cuboid.world_from_body = middle;
                    object.velocity_mps = Some(DVec3::ZERO);
                }
            }
        }
    }
}

fn annotated(drive: &Drive, keyframe: usize, track: usize) -> Option<&ObjectBox> {
    drive.keyframes.get(keyframe)?.boxes.iter().find(|object| object.track == track)
}

/// The boxes of a track during which it may be parked.
fn stays(told: &[Option<bool>]) -> Vec<Range<usize>> {
    if told.iter().all(Option::is_none) {
        return (told.len() >= FEWEST).then_some(0..told.len()).into_iter().collect();
    }
    let mut stays = Vec::new();
    let mut first = 0;
    // A box about which nothing is told is as those around it.
    for run in told.chunk_by(|a, b| (*a == Some(false)) == (*b == Some(false))) {
        if run.contains(&Some(true)) && run.len() > 1 {
            stays.push(first..first + run.len());
        }
        first += run.len();
    }
    stays
}

/// The pose with the middle place that is turned the middle way; `None` where some pose is too far from it to be the same.
fn middle(poses: impl Iterator<Item = Pose<World, Body>> + Clone, most_m: f64) -> Option<Pose<World, Body>> {
    let middle = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    let place = |axis: usize| middle(poses.clone().map(|pose| pose.translation[axis]).collect());
    let first = poses.clone().next()?;
    let turn_rad = |pose: &Pose<World, Body>| {
        let ahead = first.inverse().vector(pose.vector(DVec3::X));
        ahead.y.atan2(ahead.x)
    };
    let turned = middle(poses.clone().map(|pose| turn_rad(&pose)).collect())?;
    let rotation = poses.clone().find(|pose| turn_rad(pose) == turned)?.rotation;
    let found = Pose::new(rotation, DVec3::new(place(0)?, place(1)?, place(2)?));
    let is_near =
        |pose: Pose<World, Body>| off_m(&pose, &found) <= most_m && (turn_rad(&pose) - turned).abs() <= TURNS_RAD;
    poses.clone().all(is_near).then_some(found)
}

/// How far apart two poses are over the ground.
fn off_m(a: &Pose<World, Body>, b: &Pose<World, Body>) -> f64 {
    a.translation.truncate().distance(b.translation.truncate())
}

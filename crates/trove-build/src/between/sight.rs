//! Who comes and goes before the cameras' eyes.

use trove_model::{Cuboid, Drive, Exposure, Keyframe, Outcome, Report};

use super::times::MAX_STEP_NS;

/// Tells of everybody whose annotation begins or ends at a keyframe of which a camera looks at its place: in the rendered
/// moments someone appears or is gone there. What hides the place is not asked.
pub(super) fn tell_who_comes_and_goes(drive: &Drive, report: &Report) {
    for track in &drive.tracks {
        let is_at = |k: usize| track.boxes.iter().any(|(there, _)| *there == k);
        for &(k, cuboid) in &track.boxes {
            let Some(keyframe) = drive.keyframes.get(k) else { continue };
            let beside = [k.checked_sub(1), Some(k + 1)];
            let whats = ["object that appears in a camera's picture", "object that is gone from a camera's picture"];
            for (other, what) in beside.into_iter().zip(whats) {
                let neighbour = other.filter(|&other| are_neighbours(drive, k, other));
                if neighbour.is_none_or(is_at) || !is_seen(keyframe, &cuboid) {
                    continue;
                }
                let far_m = keyframe.world_from_ego.translation.distance(cuboid.world_from_body.translation);
                let example = format!("{} ({}) at keyframe {k}, {far_m:.0} m away", track.token, track.kind.name());
                report.note(Outcome::Warned, what, example);
            }
        }
    }
}

fn are_neighbours(drive: &Drive, a: usize, b: usize) -> bool {
    let times = drive.keyframes.get(a).zip(drive.keyframes.get(b));
    times.is_some_and(|(a, b)| a.time_ns.abs_diff(b.time_ns) <= MAX_STEP_NS as u64)
}

/// Whether the middle of a box lies in a picture.
fn is_seen(keyframe: &Keyframe, cuboid: &Cuboid) -> bool {
    let in_picture = |exposure: &Exposure| {
        let point = exposure.world_from_camera().inverse().point(cuboid.world_from_body.translation);
        exposure.lens.project(point).is_some_and(|pixel| exposure.lens.contains(pixel))
    };
    keyframe.exposures.iter().any(in_picture)
}

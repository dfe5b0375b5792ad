//! Which keyframes follow one another.

use trove_model::Drive;

/// Keyframes further apart than this are not neighbours, nanoseconds: what moved between them cannot be told.
const MAX_STEP_NS: i64 = 2_000_000_000;

/// The keyframe before, where the recording runs through.
pub(crate) fn previous(drive: &Drive, keyframe: usize) -> Option<usize> {
    neighbour(drive, keyframe, keyframe.checked_sub(1)?)
}

/// The keyframe after, where the recording runs through.
pub(crate) fn next(drive: &Drive, keyframe: usize) -> Option<usize> {
    neighbour(drive, keyframe, keyframe + 1)
}

fn neighbour(drive: &Drive, keyframe: usize, other: usize) -> Option<usize> {
    let (a, b) = (drive.keyframes.get(keyframe)?, drive.keyframes.get(other)?);
    (a.time_ns.abs_diff(b.time_ns) <= MAX_STEP_NS as u64).then_some(other)
}

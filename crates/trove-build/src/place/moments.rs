//! Which keyframes follow one another.

use trove_model::Drive;

use crate::between::MAX_STEP_NS;

/// The keyframe before, where the recording runs through.
pub(crate) fn previous(drive: &Drive, keyframe: usize) -> Option<usize> {
    neighbour(drive, keyframe, keyframe.checked_sub(1)?)
}

/// The keyframe after, where the recording runs through.
pub(crate) fn next(drive: &Drive, keyframe: usize) -> Option<usize> {
    neighbour(drive, keyframe, keyframe + 1)
}

/// When a keyframe is, seconds after the first.
pub(crate) fn moment_s(drive: &Drive, keyframe: usize) -> f64 {
    let time_ns = |k: usize| drive.keyframes.get(k).map_or(0, |k| k.time_ns);
    (time_ns(keyframe) - time_ns(0)) as f64 * 1e-9
}

/// Seconds between a keyframe and its neighbour; infinite without one, or with one at the same time.
pub(crate) fn apart_s(drive: &Drive, keyframe: usize, neighbour: Option<usize>) -> f64 {
    let time_ns = |k: usize| Some(drive.keyframes.get(k)?.time_ns);
    let apart_ns = time_ns(keyframe).zip(neighbour.and_then(time_ns)).map_or(0, |(a, b)| a.abs_diff(b));
    if apart_ns == 0 { f64::INFINITY } else { apart_ns as f64 * 1e-9 }
}

fn neighbour(drive: &Drive, keyframe: usize, other: usize) -> Option<usize> {
    let (a, b) = (drive.keyframes.get(keyframe)?, drive.keyframes.get(other)?);
    (a.time_ns.abs_diff(b.time_ns) <= MAX_STEP_NS as u64).then_some(other)
}

//! How a camera moves while it gathers light.

use trove_model::{Camera, CameraBeside, Pose, Trajectory, World};

/// How long before and after an exposure's middle the vehicle's own path says where it was: short enough that it moves evenly,
/// and long against the noise between one pose and the next, nanoseconds.
const BESIDE_NS: i64 = 100_000_000;

/// A camera on the recording vehicle, before and after a moment: by the vehicle's path where that is recorded more densely
/// than the keyframes, else as given by `keyframes`.
pub(super) fn on_path(
    path: &Trajectory<World, trove_model::Ego>,
    time_ns: i64,
    world_from_camera: Pose<World, Camera>,
    keyframes: [Option<CameraBeside>; 2],
) -> [Option<CameraBeside>; 2] {
    let beside = |by_ns: i64| {
        // The exposure's own pose may be another than the path's; the motion is the path's.
        let moved = path.at(time_ns.saturating_add(by_ns))? * path.at(time_ns)?.inverse();
        let apart_s = by_ns.unsigned_abs() as f64 * 1e-9;
        Some(CameraBeside { apart_s, world_from_camera: moved * world_from_camera })
    };
    let dense = [-BESIDE_NS, BESIDE_NS].map(beside);
    if dense == [None; 2] { keyframes } else { dense }
}

/// A camera's pose at a keyframe beside a moment; `None` at the same time, where there is no motion to tell.
pub(super) fn at_keyframe(time_ns: i64, other: Option<(Pose<World, Camera>, i64)>) -> Option<CameraBeside> {
    let (world_from_camera, other_ns) = other?;
    let apart_ns = other_ns.abs_diff(time_ns);
    (apart_ns > 0).then_some(CameraBeside { apart_s: apart_ns as f64 * 1e-9, world_from_camera })
}

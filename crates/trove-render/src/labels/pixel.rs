//! Everything that one pixel shows.

use trove_model::Occlusion;

use super::flow;

/// Indices of no instance: the sky, and what lies outside the lens's image circle.
pub(super) const SKY: u32 = u32::MAX;
pub(super) const OUTSIDE: u32 = u32::MAX - 1;

/// Everything that one pixel shows.
pub(super) struct Pixel {
    /// Index into the scene's instances, [`SKY`] or [`OUTSIDE`].
    pub instance: u32,
    /// From the camera, infinite where there is nothing.
    pub range_m: f64,
    pub depth_m: f32,
    pub normal: [f32; 3],
    /// To the previous keyframe, and to the next.
    pub flow: [[f32; 2]; 2],
    pub occlusion: [Occlusion; 2],
}

/// A pixel that no ray belongs to.
pub(super) const OUTSIDE_LENS: Pixel = Pixel {
    instance: OUTSIDE,
    range_m: f64::INFINITY,
    depth_m: f32::INFINITY,
    normal: [0.0; 3],
    flow: [flow::NONE; 2],
    occlusion: [Occlusion::Undefined; 2],
};

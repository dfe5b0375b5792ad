//! What stands for someone at a moment: an asset, or something between two postures of a person.

use trove_model::Asset;

/// Less than this of the way from one posture to another is none of it.
const LEAST: f64 = 1.0 / 256.0;

/// What of the library is seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shown<'a> {
    /// An asset.
    pub asset: &'a Asset,
    /// Another of the same triangles, slots and materials, and the share of the way that each vertex has moved towards it, 0
    /// to 1.
    pub towards: Option<(&'a Asset, f32)>,
}

impl<'a> Shown<'a> {
    /// Between two postures of one person.
    pub(super) fn between(before: &'a Asset, after: &'a Asset, share: f64) -> Self {
        let is_one = before.id == after.id || share < LEAST;
        Self { asset: before, towards: (!is_one).then_some((after, share as f32)) }
    }
}

impl<'a> From<&'a Asset> for Shown<'a> {
    fn from(asset: &'a Asset) -> Self {
        Self { asset, towards: None }
    }
}

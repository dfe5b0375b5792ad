//! What stands for someone at a moment: an asset, or something between two postures of a person.

use glam::DVec3;
use trove_model::{Asset, Posture};

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
    /// How far its mesh is moved in its own axes, metres.
    pub shift_m: DVec3,
    /// How far it is turned to the left in its box: who walks looks along the way.
    pub turn_rad: f64,
    /// Whether its left and its right foot stand on the ground.
    pub stands: [bool; 2],
}

impl<'a> Shown<'a> {
    /// Between two postures of one person, each moved by some way.
    pub(super) fn between((before, from): (&'a Asset, DVec3), (after, to): (&'a Asset, DVec3), share: f64) -> Self {
        let is_one = before.id == after.id || share < LEAST;
        let towards = (!is_one).then_some((after, share as f32));
        Self { asset: before, towards, shift_m: from.lerp(to, share), turn_rad: 0.0, stands: [false; 2] }
    }
}

impl<'a> From<&'a Asset> for Shown<'a> {
    fn from(asset: &'a Asset) -> Self {
        let stands = asset.figure.as_ref().is_some_and(|figure| figure.posture == Posture::Standing);
        Self { asset, towards: None, shift_m: DVec3::ZERO, turn_rad: 0.0, stands: [stands; 2] }
    }
}

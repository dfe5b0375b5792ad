//! How high above the ground roads run of themselves, because the ground falls or rises below them.

use glam::DVec2;
use trove_model::{HeightField, Road};

use crate::ground::Spans;
use crate::roads::network::resampled;

/// A bridge of which some point is this high is above the ground though it crosses nothing, metres.
const HIGH_M: f64 = 2.0;

/// The ground and the bridges and tunnels over and under it.
#[derive(Clone, Copy, Debug)]
pub(in crate::roads) struct Lift<'a> {
    pub ground: &'a HeightField,
    pub spans: &'a Spans,
}

impl Lift<'_> {
    /// Height of a bridge's or tunnel's road above the ground, metres, were nothing to cross it; 0 for other roads and
    /// where there is no relief.
    pub(super) fn at(&self, road: &Road, position: DVec2) -> f64 {
        self.spans.height_m(road, position).map_or(0.0, |height_m| height_m - self.ground.height_m(position))
    }

    /// Whether a bridge leads over a valley.
    pub(super) fn is_high(&self, road: &Road) -> bool {
        resampled(&road.centreline).iter().any(|&p| self.at(road, p) > HIGH_M)
    }
}

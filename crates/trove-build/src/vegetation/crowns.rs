//! How far a plant reaches at every height.

use trove_model::Asset;

/// Height of a step, metres.
const STEP_M: f64 = 0.25;
/// Crowns may touch what they hang over by single twigs, metres.
const TWIG_M: f64 = 0.15;

/// The outline of a model from the side.
#[derive(Clone, Debug)]
pub(super) struct Crown {
    /// Largest distance from the trunk of anything up to the top of each step, metres.
    reach_m: Vec<f64>,
}

impl Crown {
    pub(super) fn new(asset: &Asset) -> Self {
        let mut reach_m = vec![0.0f64; (asset.size_m.z / STEP_M).ceil() as usize + 1];
        let last = reach_m.len() - 1;
        for p in &asset.mesh.positions {
            let step = ((f64::from(p.z) / STEP_M).max(0.0) as usize).min(last);
            reach_m[step] = reach_m[step].max(f64::from(p.truncate().length()));
        }
        for i in 1..reach_m.len() {
            reach_m[i] = reach_m[i].max(reach_m[i - 1]);
        }
        Self { reach_m }
    }

    /// The farthest that anything below a height reaches, metres.
    pub(super) fn reach_below_m(&self, height_m: f64) -> f64 {
        let step = ((height_m / STEP_M).max(0.0) as usize).min(self.reach_m.len() - 1);
        (self.reach_m[step] - TWIG_M).max(0.0)
    }

    /// The farthest that anything reaches, metres.
    pub(super) fn reach_m(&self) -> f64 {
        (self.reach_m.last().copied().unwrap_or(0.0) - TWIG_M).max(0.0)
    }
}

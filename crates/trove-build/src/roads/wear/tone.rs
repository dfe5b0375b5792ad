//! How light and dark a surface is from place to place.

use glam::DVec2;
use trove_model::Seed;

/// Smooth random values over the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tone {
    seed: Seed,
}

impl Tone {
    pub(super) fn new(seed: Seed) -> Self {
        Self { seed }
    }

    /// About −1 to 1; features of about `feature_m`.
    pub(super) fn at(&self, p: DVec2, feature_m: f64) -> f64 {
        let p = p / feature_m;
        let cell = p.floor();
        let f = p - cell;
        let w = f * f * (3.0 - 2.0 * f);
        let value = |dx: f64, dy: f64| {
            let corner = cell + DVec2::new(dx, dy);
            let index = (corner.x as i64 as u64).rotate_left(32) ^ corner.y as i64 as u64;
            self.seed.nth(index).random().unit() * 2.0 - 1.0
        };
        let (low, high) = (
            value(0.0, 0.0) + (value(1.0, 0.0) - value(0.0, 0.0)) * w.x,
            value(0.0, 1.0) + (value(1.0, 1.0) - value(0.0, 1.0)) * w.x,
        );
        low + (high - low) * w.y
    }
}

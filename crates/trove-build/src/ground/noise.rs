//! Smooth noise over World's plane.

use glam::DVec2;
use trove_model::Seed;

/// Value noise from 0 to 1 with features of about `feature_m`.
pub(crate) fn noise(seed: Seed, p: DVec2, feature_m: f64) -> f64 {
    let node = |x: f64, y: f64| seed.nth(x as i64 as u64).nth(y as i64 as u64).random().unit();
    let cell = (p / feature_m).floor();
    let f = p / feature_m - cell;
    let f = f * f * (3.0 - 2.0 * f);
    let south = node(cell.x, cell.y) * (1.0 - f.x) + node(cell.x + 1.0, cell.y) * f.x;
    let north = node(cell.x, cell.y + 1.0) * (1.0 - f.x) + node(cell.x + 1.0, cell.y + 1.0) * f.x;
    south * (1.0 - f.y) + north * f.y
}

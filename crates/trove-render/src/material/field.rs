//! Noise that weather follows, over World's plane: it repeats after long, and every machine has the same.

use std::sync::LazyLock;

use glam::{Vec2, vec2};
use trove_model::Seed;

use crate::light::Plane;

/// Samples that cover more than this see the mean of what weather does, metres.
pub(super) const TOO_WIDE_M: f32 = 3.0;

/// A repeating field, as evenly spread from 0 to 1 as can be: of any area the share `s` lies above 1 − s.
static FIELD: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let plane = Plane::fractal(Seed(0x77e7), SIDE, 16, 4, 0.55);
    let value = |i: usize| plane.at(vec2((i % SIDE) as f32, (i / SIDE) as f32) / SIDE as f32);
    let values: Vec<f32> = (0..SIDE * SIDE).map(value).collect();
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut field = vec![0; values.len()];
    for (rank, i) in order.into_iter().enumerate() {
        field[i] = (rank * 256 / values.len()) as u8;
    }
    field
});
/// Its cells a side.
const SIDE: usize = 256;

/// The field at a point; features are a sixteenth of its period 1 and finer.
pub(super) fn field(p: Vec2) -> f32 {
    let p = p * SIDE as f32;
    let low = p.floor();
    let t = p - low;
    let mask = SIDE as i32 - 1;
    let (x, y) = (low.x as i32 & mask, low.y as i32 & mask);
    let (x1, y1) = ((x + 1) & mask, (y + 1) & mask);
    let at = |x: i32, y: i32| f32::from(FIELD[y as usize * SIDE + x as usize]);
    let (top, bottom) = (at(x, y) + (at(x1, y) - at(x, y)) * t.x, at(x, y1) + (at(x1, y1) - at(x, y1)) * t.x);
    (top + (bottom - top) * t.y) / 255.0
}

/// From 0 below `low` to 1 above `high`.
pub(super) fn step(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_is_spread_evenly() {
        let n = 20_000;
        let above = |limit: f32| (0..n).filter(|&i| field(vec2(i as f32 * 0.617, i as f32 * 0.383)) > limit).count();
        for share in [0.1, 0.5, 0.9] {
            assert!((above(1.0 - share) as f32 / n as f32 - share).abs() < 0.05);
        }
    }
}

//! The tables that all materials share, made once.

use std::sync::LazyLock;

use glam::vec2;
use trove_model::Seed;
use trove_trace::{Lookups, NOISE_SIDE};

use crate::noise::Plane;

/// Lobes, bytes as light, and the noise that weather follows over World's plane: it repeats after long, and every machine
/// has the same.
pub(crate) static LOOKUPS: LazyLock<Lookups> = LazyLock::new(|| Lookups::new(std::array::from_fn(linear), noise()));

/// A byte of sRGB as linear light.
fn linear(byte: usize) -> f32 {
    let s = byte as f32 / 255.0;
    if s <= 0.04045 { s / 12.92 } else { ((s + 0.055) / 1.055).powf(2.4) }
}

/// Of any area as much is above 1 − s as the share s of it.
fn noise() -> [u8; NOISE_SIDE * NOISE_SIDE] {
    let plane = Plane::fractal(Seed(0x77e7), NOISE_SIDE, 16, 4, 0.55);
    let at = |i: usize| vec2((i % NOISE_SIDE) as f32, (i / NOISE_SIDE) as f32) / NOISE_SIDE as f32;
    let values: Vec<f32> = (0..NOISE_SIDE * NOISE_SIDE).map(|i| plane.at(at(i))).collect();
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut noise = [0; NOISE_SIDE * NOISE_SIDE];
    for (rank, i) in order.into_iter().enumerate() {
        noise[i] = (rank * 256 / values.len()) as u8;
    }
    noise
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_noise_is_spread_evenly() {
        let n = 20_000;
        let at = |i: usize| vec2(i as f32 * 0.617, i as f32 * 0.383);
        for share in [0.1, 0.5, 0.9] {
            let above = (0..n).filter(|&i| LOOKUPS.noise(at(i)) > 1.0 - share).count();
            assert!((above as f32 / n as f32 - share).abs() < 0.05);
        }
    }
}

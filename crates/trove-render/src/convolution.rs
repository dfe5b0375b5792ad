//! Pictures seen through a filter.

use rayon::prelude::*;
use trove_model::Raster;

/// Convolved with a kernel of an odd number of weights, first along rows, then along columns; beyond the border it goes on as
/// at it.
pub(crate) fn convolved(picture: &Raster<[f32; 3]>, kernel: &[f32]) -> Raster<[f32; 3]> {
    let reach = (kernel.len() / 2) as i64;
    let along = |from: &Raster<[f32; 3]>, step: [i64; 2]| {
        let last = [i64::from(from.width) - 1, i64::from(from.height) - 1];
        let pixel = |x: u32, y: u32| {
            let mut sum = [0.0f32; 3];
            for (i, weight) in (-reach..=reach).zip(kernel) {
                let at = |p: u32, axis: usize| (i64::from(p) + i * step[axis]).clamp(0, last[axis]) as u32;
                let colour = from.at(at(x, 0), at(y, 1));
                (0..3).for_each(|c| sum[c] += weight * colour[c]);
            }
            sum
        };
        let rows = (0..from.height).into_par_iter().map(|y| (0..from.width).map(|x| pixel(x, y)).collect::<Vec<_>>());
        Raster { width: from.width, height: from.height, data: rows.flatten_iter().collect() }
    };
    along(&along(picture, [1, 0]), [0, 1])
}

/// A Gaussian's weights, which sum to 1.
pub(crate) fn gaussian(sigma_px: f64) -> Vec<f32> {
    let reach = (3.0 * sigma_px).ceil() as i64;
    let weights = || (-reach..=reach).map(|i| (-0.5 * (i as f64 / sigma_px).powi(2)).exp());
    let whole: f64 = weights().sum();
    weights().map(|weight| (weight / whole) as f32).collect()
}

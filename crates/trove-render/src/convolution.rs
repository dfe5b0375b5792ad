//! Pictures seen through a filter.

use rayon::prelude::*;
use trove_model::Raster;

/// Convolved with a kernel of an odd number of weights, first along columns, then along rows; beyond the border it goes on
/// as at it.
pub(crate) fn convolved<const N: usize>(picture: &Raster<[f32; N]>, kernel: &[f32]) -> Raster<[f32; N]> {
    let &Raster { width, height, .. } = picture;
    if picture.data.is_empty() {
        return picture.clone();
    }
    let (width, last_row, reach) = (width as usize, height as usize - 1, kernel.len() / 2);
    let mut out = Raster::filled(picture.width, height, [0.0; N]);
    // A row goes on to both sides, so that all of its pixels are alike and several are summed at once.
    let rows = out.data.par_chunks_mut(width).enumerate();
    rows.for_each_init(Vec::new, |wide, (y, row)| {
        let column = |k: usize| &picture.data[(y + k).saturating_sub(reach).min(last_row) * width..][..width];
        wide.clear();
        wide.resize(width + 2 * reach, [0.0; N]);
        let middle = &mut wide[reach..][..width];
        (0..).zip(kernel).for_each(|(k, weight)| add(middle, column(k), *weight));
        let (first, last) = (wide[reach], wide[reach + width - 1]);
        wide[..reach].fill(first);
        wide[reach + width..].fill(last);
        (0..).zip(kernel).for_each(|(k, weight)| add(row, &wide[k..][..width], *weight));
    });
    out
}

fn add<const N: usize>(to: &mut [[f32; N]], from: &[[f32; N]], weight: f32) {
    let floats = to.as_flattened_mut().iter_mut().zip(from.as_flattened());
    floats.for_each(|(to, from)| *to += weight * from);
}

/// A Gaussian's weights, which sum to 1.
pub(crate) fn gaussian(sigma_px: f64) -> Vec<f32> {
    let reach = (3.0 * sigma_px).ceil() as i64;
    let weights = || (-reach..=reach).map(|i| (-0.5 * (i as f64 / sigma_px).powi(2)).exp());
    let whole: f64 = weights().sum();
    weights().map(|weight| (weight / whole) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_is_the_sum_of_its_neighbours_and_the_border_goes_on() {
        // Taller and wider than the kernel, and neither.
        for (width, height) in [(9, 7), (2, 1), (1, 3), (0, 4)] {
            let picture = Raster::from_fn(width, height, |x, y| [(x * x + 10 * y) as f32, 1.0]);
            let kernel = [0.1, 0.2, 0.4, 0.25, 0.05];
            let found = convolved(&picture, &kernel);
            assert_eq!((found.width, found.height), (width, height));
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                let at = |p: u32, i: usize, size: u32| (p + i as u32).saturating_sub(2).min(size - 1);
                let terms = (0..25)
                    .map(|i| (i % 5, i / 5))
                    .map(|(i, j)| kernel[i] * kernel[j] * picture.at(at(x, i, width), at(y, j, height))[0]);
                let (sum, [value, one]): (f32, _) = (terms.sum(), *found.at(x, y));
                assert!(
                    (sum - value).abs() < 1e-4 && (one - 1.0).abs() < 1e-6,
                    "{value} instead of {sum} at ({x}, {y})"
                );
            }
        }
    }
}

//! Clean pictures with as much of the noisy ones in them as is nearer to the truth.

use rayon::prelude::*;
use trove_model::Raster;

use crate::convolution::{convolved, gaussian};

/// Weights of neighbours that turn means over the squares of pixels into nearly those under a picture's tents.
const TENT: [f32; 3] = [0.07, 0.86, 0.07];
/// Errors are judged over so much of a picture.
const SIGMA_PX: f64 = 1.5;
/// A pixel is mixed as if it were no farther from its clean value than so many times what is usual around it: speckles that
/// the denoiser took away stay away.
const FARTHEST: f32 = 1.5;

/// A noisy picture, with the variance of its brightness, mixed with what a denoiser made of its pixels' own samples.
///
/// Each has the share that is best for two estimates of one value with independent errors. The clean picture's squared
/// error is taken to be how far the two are apart. That has the noise in it, too; but variance from two halves of
/// stratified samples is too large also.
pub(crate) fn blended(clean: &Raster<[f32; 3]>, noisy: &Raster<[f32; 3]>, variance: &Raster<f32>) -> Raster<[f32; 3]> {
    let mut picture = convolved(clean, &TENT);
    let errors = picture.data.iter().zip(&noisy.data).map(|(a, b)| apart(a, b)).zip(&variance.data);
    let data = errors.map(|(apart, &variance)| [apart * apart, variance, apart]).collect();
    let errors = convolved(&Raster { width: picture.width, height: picture.height, data }, &gaussian(SIGMA_PX));
    let pixels = picture.data.par_iter_mut().zip(&noisy.data).zip(&errors.data);
    pixels.for_each(|((to, noisy), &[squared, variance, usual])| {
        let most = FARTHEST * usual / apart(to, noisy).max(f32::MIN_POSITIVE);
        let share = squared / (squared + variance).max(f32::MIN_POSITIVE) * most.min(1.0);
        (0..3).for_each(|c| to[c] += share * (noisy[c] - to[c]));
    });
    picture
}

/// Difference of two pixels' brightness.
fn apart(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    ((0..3).map(|c| a[c] - b[c]).sum::<f32>() / 3.0).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Seed;

    #[test]
    fn a_mix_is_nearer_to_the_truth_than_either_picture() {
        // Noise of variance 0.01; the clean picture is right on the left and off by 0.1 or 0.4 on the right.
        let mut random = Seed(3).random();
        let noisy = Raster::from_fn(120, 40, |_, _| [(1.0 + 0.1 * random.normal()) as f32; 3]);
        let variance = Raster::filled(120, 40, 0.01);
        for off in [0.1, 0.4f32] {
            let clean = Raster::from_fn(120, 40, |x, _| [if x < 60 { 1.0 } else { 1.0 + off }; 3]);
            let mixed = blended(&clean, &noisy, &variance);
            let error = |picture: &Raster<[f32; 3]>, columns: std::ops::Range<u32>| {
                let pixels = (0..40).flat_map(|y| columns.clone().map(move |x| picture.at(x, y)[1] - 1.0));
                pixels.map(|e| e * e).sum::<f32>() / (40 * columns.len()) as f32
            };
            let right = error(&mixed, 65..120);
            assert!(right < error(&noisy, 65..120) && right < error(&clean, 65..120), "{off}: {right}");
            assert!(error(&mixed, 0..55) < 0.4 * error(&noisy, 0..55));
        }
    }

    #[test]
    fn speckles_that_the_denoiser_took_away_stay_away() {
        let mut random = Seed(3).random();
        let mut noisy = Raster::from_fn(41, 41, |_, _| [(1.0 + 0.1 * random.normal()) as f32; 3]);
        let mut variance = Raster::filled(41, 41, 0.01);
        let speckle = 5.0f32;
        *noisy.at_mut(20, 20) = [1.0 + speckle; 3];
        *variance.at_mut(20, 20) = speckle * speckle;
        let mixed = blended(&Raster::filled(41, 41, [1.0; 3]), &noisy, &variance);
        assert!(mixed.at(20, 20)[0] < 1.0 + 0.1 * speckle, "{:?}", mixed.at(20, 20));
    }

    #[test]
    fn a_picture_without_noise_stays_and_black_is_no_trouble() {
        // A chequerboard: every pixel is as far from the clean one as those around it.
        let noisy = Raster::from_fn(9, 9, |x, y| [if (x + y) % 2 == 0 { 3.0 } else { 0.0 }; 3]);
        let exact = Raster::filled(9, 9, 0.0);
        let clean = Raster::filled(9, 9, [1.5f32; 3]);
        let mixed = blended(&clean, &noisy, &exact);
        let differ = |a: &[f32; 3], b: &[f32; 3]| (0..3).any(|c| (a[c] - b[c]).abs() > 1e-5);
        assert!(!mixed.data.iter().zip(&noisy.data).any(|(a, b)| differ(a, b)));
        let black = Raster::filled(9, 9, [0.0f32; 3]);
        assert_eq!(blended(&black, &black, &exact), black);
    }
}

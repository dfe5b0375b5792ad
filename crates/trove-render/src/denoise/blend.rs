//! Clean pictures with as much of the noisy ones in them as is nearer to the truth.

use rayon::prelude::*;
use trove_model::Raster;

use crate::convolution::{convolved, gaussian};

/// Weights of neighbours that turn means over the squares of pixels into nearly those under a picture's tents.
const TENT: [f32; 3] = [0.07, 0.86, 0.07];
/// Noise and brightness are judged over so much of a picture.
const SIGMA_PX: f64 = 1.5;
/// Squared error of what a denoiser makes of streets, as a share of the squared brightness. It hardly falls with the noise:
/// texture and edges that the denoiser takes for noise are most of it.
const CLEAN: f32 = 0.003;

/// A noisy picture, with the variance of its brightness, mixed with what a denoiser made of its pixels' own samples: each has
/// the share that is best for two estimates of one value with independent errors.
///
/// How far the two are apart is not asked: that is nearly all noise where there is much, and would let it back in.
pub(crate) fn blended(clean: &Raster<[f32; 3]>, noisy: &Raster<[f32; 3]>, variance: &Raster<f32>) -> Raster<[f32; 3]> {
    let mut picture = convolved(clean, &TENT);
    let pixels = picture.data.iter().zip(&variance.data);
    let data = pixels.map(|(rgb, &variance)| [(rgb.iter().sum::<f32>() / 3.0).powi(2), variance]).collect();
    let squares = Raster { width: picture.width, height: picture.height, data };
    let squares = convolved(&squares, &gaussian(SIGMA_PX));
    let pixels = picture.data.par_iter_mut().zip(&noisy.data).zip(&squares.data);
    pixels.for_each(|((to, noisy), [brightness, variance])| {
        let error = CLEAN * brightness;
        let share = error / (error + variance).max(f32::MIN_POSITIVE);
        (0..3).for_each(|c| to[c] += share * (noisy[c] - to[c]));
    });
    picture
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Seed;

    #[test]
    fn a_mix_is_nearer_to_the_truth_than_either_picture_however_much_noise_there_is() {
        for noise in [0.01, 0.05, 0.2, 1.0f32] {
            let mut random = Seed(3).random();
            let mut picture = |sigma: f32| Raster::from_fn(80, 80, |_, _| [1.0 + sigma * random.normal() as f32; 3]);
            let (noisy, wide) = (picture(noise), picture(1.2 * CLEAN.sqrt()));
            // Errors of the clean picture, as independent from pixel to pixel as convolution leaves them.
            let clean = convolved(&wide, &TENT);
            let mixed = blended(&wide, &noisy, &Raster::filled(80, 80, noise * noise));
            let error = |picture: &Raster<[f32; 3]>| {
                picture.data.iter().map(|rgb| (rgb[1] - 1.0).powi(2)).sum::<f32>() / (80 * 80) as f32
            };
            let least = error(&noisy).min(error(&clean));
            assert!(error(&mixed) < 1.02 * least, "{noise}: {} of {least}", error(&mixed));
            let both = 1.0 / (1.0 / error(&noisy) + 1.0 / error(&clean));
            assert!(error(&mixed) < 1.1 * both, "{noise}: {} instead of {both}", error(&mixed));
        }
    }

    #[test]
    fn speckles_that_the_denoiser_took_away_stay_away() {
        let (mut noisy, mut variance) = (Raster::filled(41, 41, [1.0; 3]), Raster::filled(41, 41, 0.01));
        let speckle = 5.0f32;
        *noisy.at_mut(20, 20) = [1.0 + speckle; 3];
        *variance.at_mut(20, 20) = speckle * speckle;
        let mixed = blended(&Raster::filled(41, 41, [1.0; 3]), &noisy, &variance);
        assert!(mixed.at(20, 20)[0] < 1.0 + 0.01 * speckle, "{:?}", mixed.at(20, 20));
    }

    #[test]
    fn a_picture_without_noise_stays_and_black_is_no_trouble() {
        let noisy = Raster::from_fn(9, 9, |x, y| [if (x + y) % 2 == 0 { 3.0 } else { 0.0 }; 3]);
        let exact = Raster::filled(9, 9, 0.0);
        let mixed = blended(&Raster::filled(9, 9, [1.5; 3]), &noisy, &exact);
        let differ = |a: &[f32; 3], b: &[f32; 3]| (0..3).any(|c| (a[c] - b[c]).abs() > 1e-5);
        assert!(!mixed.data.iter().zip(&noisy.data).any(|(a, b)| differ(a, b)));
        let black = Raster::filled(9, 9, [0.0f32; 3]);
        assert_eq!(blended(&black, &black, &exact), black);
    }
}

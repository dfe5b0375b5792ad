//! How sharp images are: how strong fine detail is beside coarser detail. What is there to be seen, and its contrast,
//! change both alike; lens, sensor and processing do not.

/// Octaves of detail that are matched, of periods of 2 to 4 and 4 to 8 pixels; the next is what they are held to.
pub(super) const MATCHED: usize = 2;
/// Detail becomes at most so many times as strong, or as weak: of stronger detail there would be little but noise.
const MOST: f64 = 3.0;
/// Octaves overlap, so that one is not strengthened alone: after so many rounds each is about what it should be.
const ROUNDS: usize = 6;
/// An 8-bit image whose coarser detail is weaker on the average says nothing, in units of the space's lightness squared.
const LEAST_SQUARE: f64 = 1e-6;
/// So that what is not there can be divided by.
const LEAST_SHARPNESS: f64 = 1e-9;
/// A cubic B-spline's, with which the wavelets smooth.
const WEIGHTS: [f32; 5] = [0.0625, 0.25, 0.375, 0.25, 0.0625];

/// Sums of the squares of an image's lightness by octave, finest first: of its à trous wavelets (Starck, Murtagh and Fadili
/// 2010, "Sparse Image and Signal Processing").
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Detail {
    squares: [f64; MATCHED + 1],
    pixels: f64,
}

impl Detail {
    /// Of pixels, row by row, whose first channel is lightness.
    pub fn of(pixels: &[[f32; 3]], width: usize) -> Self {
        Self::of_octaves(&octaves(pixels, width))
    }

    fn of_octaves(octaves: &[Vec<f32>; MATCHED + 1]) -> Self {
        let sum = |octave: &Vec<f32>| octave.iter().map(|v| f64::from(*v).powi(2)).sum();
        Self { squares: octaves.each_ref().map(sum), pixels: octaves[0].len() as f64 }
    }

    /// Takes another's pixels in.
    pub fn join(&mut self, other: &Self) {
        self.squares.iter_mut().zip(other.squares).for_each(|(sum, square)| *sum += square);
        self.pixels += other.pixels;
    }

    /// The amplitude of each matched octave, finest first, in that of the next coarser one that is not; `None` where there is
    /// nothing to be seen.
    pub fn sharpness(&self) -> Option<[f64; MATCHED]> {
        let coarse = self.squares[MATCHED];
        let is_enough = coarse > LEAST_SQUARE * self.pixels;
        is_enough.then(|| std::array::from_fn(|octave| (self.squares[octave] / coarse).sqrt().max(LEAST_SHARPNESS)))
    }
}

/// Strengthens or weakens fine detail until an image is `strength` of the way from `from` to `to`: as sharp as `to` is, if
/// `from` is its own.
pub(super) fn sharpen(pixels: &mut [[f32; 3]], width: usize, from: &Detail, to: &Detail, strength: f32) {
    let (Some(from), Some(to)) = (from.sharpness(), to.sharpness()) else { return };
    let times: [f64; MATCHED] = std::array::from_fn(|octave| {
        1.0 + f64::from(strength) * ((to[octave] / from[octave]).clamp(1.0 / MOST, MOST) - 1.0)
    });
    let mut wanted = None;
    for _ in 0..ROUNDS {
        let octaves = octaves(pixels, width);
        let Some(own) = Detail::of_octaves(&octaves).sharpness() else { return };
        let wanted: [f64; MATCHED] =
            *wanted.get_or_insert_with(|| std::array::from_fn(|octave| own[octave] * times[octave]));
        for (octave, detail) in octaves[..MATCHED].iter().enumerate() {
            let more = (wanted[octave] / own[octave] - 1.0) as f32;
            pixels.iter_mut().zip(detail).for_each(|(pixel, detail)| pixel[0] += more * detail);
        }
    }
}

/// What each smoothing takes away, finest first; the image is continued by its border.
fn octaves(pixels: &[[f32; 3]], width: usize) -> [Vec<f32>; MATCHED + 1] {
    let mut lightness: Vec<f32> = pixels.iter().map(|pixel| pixel[0]).collect();
    std::array::from_fn(|octave| {
        let smooth = smoothed(&lightness, width, 1 << octave);
        let detail = lightness.iter().zip(&smooth).map(|(a, b)| a - b).collect();
        lightness = smooth;
        detail
    })
}

/// Smoothed along both axes by weights that lie `step` pixels apart.
fn smoothed(values: &[f32], width: usize, step: usize) -> Vec<f32> {
    if values.is_empty() {
        return Vec::new();
    }
    let height = values.len() / width;
    // Of the five that one at `i` is made of.
    let around =
        |i: usize, side: usize| [0, 1, 2, 3, 4].map(|k: usize| (i + k * step).saturating_sub(2 * step).min(side - 1));
    let mut across = vec![0.0; values.len()];
    for (row, out) in values.chunks_exact(width).zip(across.chunks_exact_mut(width)) {
        for (x, value) in out.iter_mut().enumerate() {
            *value = around(x, width).iter().zip(WEIGHTS).map(|(from, weight)| weight * row[*from]).sum();
        }
    }
    let mut both = vec![0.0; values.len()];
    for (y, out) in both.chunks_exact_mut(width).enumerate() {
        for (from, weight) in around(y, height).iter().zip(WEIGHTS) {
            let row = &across[from * width..][..width];
            out.iter_mut().zip(row).for_each(|(sum, value)| *sum += weight * value);
        }
    }
    both
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 256;

    /// Waves along x of so many pixels' period, one for each amplitude.
    fn waves(waves: &[(f32, f32)]) -> Vec<[f32; 3]> {
        (0..SIDE * SIDE)
            .map(|i| {
                let x = (i % SIDE) as f32;
                let wave = |(period, amplitude): &(f32, f32)| amplitude * (std::f32::consts::TAU * x / period).sin();
                [50.0 + waves.iter().map(wave).sum::<f32>(), 3.0, -4.0]
            })
            .collect()
    }

    #[test]
    fn octaves_of_a_wave_are_those_of_the_splines_transform() {
        // At ω a pass by weights `step` apart leaves cos⁴(ω step / 2).
        for period in [9.0f32, 13.0, 20.0] {
            let detail = Detail::of(&waves(&[(period, 8.0)]), SIDE);
            let half = std::f64::consts::PI / f64::from(period);
            let left = |step: f64| (half * step).cos().powi(4);
            let amplitudes =
                [1.0 - left(1.0), left(1.0) * (1.0 - left(2.0)), left(1.0) * left(2.0) * (1.0 - left(4.0))];
            let expected = [0, 1].map(|octave: usize| amplitudes[octave].abs() / amplitudes[2].abs());
            let found = detail.sharpness().expect("detail");
            for octave in 0..MATCHED {
                let off = found[octave] / expected[octave] - 1.0;
                assert!(off.abs() < 0.05, "period {period}: {found:?}, expected {expected:?}");
            }
        }
    }

    #[test]
    fn a_blurred_image_becomes_as_sharp_as_it_was_and_colors_stay() {
        let sharp = waves(&[(2.7, 5.0), (5.0, 7.0), (12.0, 9.0), (60.0, 20.0)]);
        // A softer image of half the contrast, whose finest detail alone is weaker by half.
        let soft = waves(&[(2.7, 1.25), (5.0, 3.5), (12.0, 4.5), (60.0, 10.0)]);
        let (from, to) = (Detail::of(&soft, SIDE), Detail::of(&sharp, SIDE));
        for strength in [1.0, 0.5] {
            let mut pixels = soft.clone();
            sharpen(&mut pixels, SIDE, &from, &to, strength);
            assert!(pixels.iter().all(|pixel| pixel[1..] == [3.0, -4.0]));
            let found = Detail::of(&pixels, SIDE).sharpness().unwrap();
            let [soft, sharp] = [&from, &to].map(|detail| detail.sharpness().unwrap());
            for octave in 0..MATCHED {
                let expected = soft[octave] + f64::from(strength) * (sharp[octave] - soft[octave]);
                assert!((found[octave] / expected - 1.0).abs() < 0.1, "{strength}: {found:?}, expected {expected}");
            }
        }
    }

    #[test]
    fn nothing_is_made_of_an_empty_image_or_towards_one() {
        let (flat, sharp) = (waves(&[]), waves(&[(3.0, 5.0), (12.0, 5.0)]));
        let [none, some] = [&flat, &sharp].map(|pixels| Detail::of(pixels, SIDE));
        assert_eq!((none.sharpness(), Detail::default().sharpness()), (None, None));
        for (pixels, from, to) in [(&flat, none, some), (&sharp, some, none)] {
            let mut same = pixels.clone();
            sharpen(&mut same, SIDE, &from, &to, 1.0);
            assert_eq!(&same, pixels);
        }
    }
}

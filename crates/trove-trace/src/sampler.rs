//! The numbers of a sample: Owen-scrambled Sobol points in blue-noise order.

/// Draws pairs of numbers for one sample of one pixel.
///
/// All samples of all pixels are points of one sequence, along a Z-curve over the picture that is shuffled within its
/// squares (Ahmed, Wonka 2020): those of a pixel are stratified, and so are those of neighbouring pixels together,
/// which makes the error blue noise. Every pair is a sequence of its own, shuffled and scrambled by a hash (Burley 2020).
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Sampler {
    index: u32,
    seed: u32,
}

impl Sampler {
    /// For the `index`-th of up to 2 to the power of `log2_count` samples of pixel (x, y).
    #[inline]
    pub fn new(seed: u64, [x, y]: [u32; 2], index: u32, log2_count: u32) -> Self {
        // Bits that find no room let the order repeat after hundreds of pixels at least.
        let pixel = (spread_bits(y) << 1) | spread_bits(x);
        let index = pixel.checked_shl(log2_count).unwrap_or(0).wrapping_add(index);
        Self { index, seed: (seed ^ (seed >> 32)) as u32 }
    }

    /// The next pair in [0, 1)².
    #[inline]
    pub fn next2(&mut self) -> [f32; 2] {
        self.seed = mixed(self.seed.wrapping_add(0x9e37_79b9));
        let index = scrambled(self.index.reverse_bits(), self.seed).reverse_bits();
        // Sobol's first two dimensions, last binary digit first: the index itself, and Pascal's triangle times it.
        let second = [(16, 0x0000_ffff), (8, 0x00ff_00ff), (4, 0x0f0f_0f0f), (2, 0x3333_3333), (1, 0x5555_5555)]
            .into_iter()
            .fold(index, |digits, (shift, mask)| digits ^ ((digits >> shift) & mask));
        let unit = |digits: u32, seed: u32| (scrambled(digits, seed).reverse_bits() >> 8) as f32 * (1.0 / 16_777_216.0);
        [unit(index, self.seed ^ 0xa511_e9b3), unit(second, self.seed.rotate_left(16) ^ 0x63d8_3595)]
    }
}

/// Owen scrambling of a number whose last binary digit comes first: every digit is flipped or not by a hash of those
/// before it (Laine, Karras 2011, with Burley's constants).
#[inline(always)]
fn scrambled(mut digits: u32, seed: u32) -> u32 {
    digits = digits.wrapping_add(seed);
    for factor in [0x6c50_b47c, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6u32] {
        digits ^= digits.wrapping_mul(factor);
    }
    digits
}

/// A hash of all digits (Wellons' `lowbias32`).
#[inline(always)]
fn mixed(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// The lower 16 bits with zeros between them.
#[inline(always)]
fn spread_bits(x: u32) -> u32 {
    [(8, 0x00ff_00ff), (4, 0x0f0f_0f0f), (2, 0x3333_3333), (1, 0x5555_5555u32)]
        .into_iter()
        .fold(x & 0xffff, |x, (shift, mask)| (x | (x << shift)) & mask)
}

#[cfg(test)]
mod tests {
    use std::{vec, vec::Vec};

    use super::*;

    /// How often each cell of a `columns × rows` grid is hit by the second pair of each sample.
    fn counts(samples: impl Iterator<Item = Sampler>, [columns, rows]: [usize; 2]) -> Vec<u32> {
        let mut counts = vec![0; columns * rows];
        for mut sampler in samples {
            sampler.next2();
            let [x, y] = sampler.next2();
            counts[(y * rows as f32) as usize * columns + (x * columns as f32) as usize] += 1;
        }
        counts
    }

    #[test]
    fn samples_of_a_pixel_fall_one_into_each_cell() {
        for grid in [[4, 4], [16, 1], [1, 16], [2, 8]] {
            for first in [0, 16, 48] {
                let samples = (first..first + 16).map(|i| Sampler::new(3, [117, 45], i, 6));
                assert_eq!(counts(samples, grid), vec![1; 16], "{grid:?} from {first}");
            }
        }
    }

    #[test]
    fn samples_of_a_square_of_pixels_fall_one_into_each_cell() {
        let square = || (0..16).map(|i| [40 + i % 4, 80 + i / 4]);
        let samples = square().flat_map(|pixel| (0..4).map(move |i| Sampler::new(3, pixel, i, 2)));
        assert_eq!(counts(samples, [8, 8]), vec![1; 64]);
    }

    #[test]
    fn pairs_of_a_sample_do_not_know_each_other() {
        let (n, mut sum) = (4096, 0.0);
        for i in 0..n {
            let mut sampler = Sampler::new(1, [5, 9], i, 12);
            let ([a, _], [b, _]) = (sampler.next2(), sampler.next2());
            sum += (a - 0.5) * (b - 0.5);
        }
        assert!((sum / n as f32 * 12.0).abs() < 0.05, "{sum}");
    }
}

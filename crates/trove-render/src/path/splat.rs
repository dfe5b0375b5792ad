//! What a block of pixels brings to the picture: a sample counts for every pixel whose filter it lies under.

use glam::Vec3;
use trove_model::Raster;

/// Side of the blocks of pixels that get the same number of samples, pixels.
pub(super) const BLOCK_PX: u32 = 4;
/// Pixels around the picture that are sampled too, since pixels at its border are seen through filters that reach beyond it.
pub(super) const MARGIN_PX: u32 = 1;

/// A block with the pixels around it, to which its samples reach.
const SIDE: usize = BLOCK_PX as usize + 2;

/// Halves of stratified samples are less well spread than all together, and tell too much variance: on two streets 1.6 to 1.75
/// times at 4 samples, 1.9 to 2.0 at 16 and 2.0 to 2.3 at 64.
const OF_HALVES: f32 = 0.5;

/// Mean of the three colours.
pub(super) fn brightness(radiance: Vec3) -> f32 {
    radiance.element_sum() / 3.0
}

/// Where a path's sample belongs.
pub(super) struct Place {
    /// In its tile.
    pub(super) block: usize,
    /// In the block.
    pub(super) pixel: usize,
    /// In the block, pixels.
    pub(super) position: [f32; 2],
}

/// Sums over samples, weighted by a pixel's tent of radius 1.
#[derive(Clone, Copy, Default)]
pub(super) struct Splat {
    radiance: Vec3,
    weight: f32,
    /// Brightness and weights of every other sample alone.
    odd: [f32; 2],
}

impl Splat {
    /// The mean radiance.
    pub(super) fn mean(&self) -> Vec3 {
        self.radiance / self.weight.max(f32::MIN_POSITIVE)
    }

    /// Variance of the brightness, by how far that of every other sample is from it.
    pub(super) fn variance(&self) -> f32 {
        let [odd, weight] = self.odd;
        let apart = odd / weight.max(f32::MIN_POSITIVE) - brightness(self.mean());
        OF_HALVES * apart * apart
    }

    fn add(&mut self, other: &Self, share: f32) {
        self.radiance += other.radiance * share;
        self.weight += other.weight * share;
        (0..2).for_each(|i| self.odd[i] += other.odd[i] * share);
    }
}

/// What a block's samples bring to the pixels in and around it.
pub(super) struct Splats([Splat; SIDE * SIDE]);

impl Splats {
    pub(super) fn none() -> Self {
        Self([Splat::default(); SIDE * SIDE])
    }

    /// Adds a sample at a position in the block's pixels.
    pub(super) fn add(&mut self, position: [f32; 2], radiance: Vec3, is_odd: bool) {
        // From the centre of the pixel before the first.
        let [x, y] = position.map(|p| p + 0.5);
        let (column, row) = (x as usize, y as usize);
        let (u, v) = (x - column as f32, y - row as f32);
        let odd = if is_odd { [brightness(radiance), 1.0] } else { [0.0; 2] };
        let sample = Splat { radiance, weight: 1.0, odd };
        self.0[row * SIDE + column].add(&sample, (1.0 - u) * (1.0 - v));
        self.0[row * SIDE + column + 1].add(&sample, u * (1.0 - v));
        self.0[(row + 1) * SIDE + column].add(&sample, (1.0 - u) * v);
        self.0[(row + 1) * SIDE + column + 1].add(&sample, u * v);
    }

    /// What the block itself knows of a pixel in it.
    pub(super) fn at(&self, [x, y]: [u32; 2]) -> &Splat {
        &self.0[(y as usize + 1) * SIDE + x as usize + 1]
    }

    /// Adds one over `count` of them to a film; `corner` is the block's in it.
    pub(super) fn develop(&self, corner: [u32; 2], count: u32, film: &mut Raster<Splat>) {
        for (i, splat) in self.0.iter().enumerate() {
            let place = [corner[0] as usize + i % SIDE, corner[1] as usize + i / SIDE];
            // The first splat is of the pixel before the block's corner, which is counted from the margin's.
            let [x, y] = place.map(|p| (p as u32).wrapping_sub(1 + MARGIN_PX));
            if x < film.width && y < film.height {
                film.at_mut(x, y).add(splat, 1.0 / count as f32);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_means_under_a_tent_also_at_the_border() {
        // Light is (x² in the picture, y², 1) over blocks that cover a picture of 6 × 6 pixels with its margin.
        let mut film = Raster::filled(6, 6, Splat::default());
        for corner in [[0, 0], [4, 0], [0, 4], [4, 4]] {
            let mut splats = Splats::none();
            let fine = || (0..400).map(|i| (i as f32 + 0.5) / 100.0);
            for (x, y) in fine().flat_map(|y| fine().map(move |x| (x, y))) {
                let at = |corner: u32, p: f32| (corner as f32 + p - MARGIN_PX as f32).powi(2);
                splats.add([x, y], Vec3::new(at(corner[0], x), at(corner[1], y), 1.0), false);
            }
            splats.develop(corner, 10_000, &mut film);
        }
        for (x, y) in (0..6).flat_map(|y| (0..6).map(move |x| (x, y))) {
            let Splat { radiance: Vec3 { x: r, y: g, z: b }, weight, .. } = *film.at(x, y);
            // The mean of squares under a tent is the centre's square and its variance, 1/6.
            let mean = |p: u32| (p as f32 + 0.5).powi(2) + 1.0 / 6.0;
            assert!((weight - 1.0).abs() < 1e-3 && (b - weight).abs() < 1e-6, "{weight} at ({x}, {y})");
            assert!((r - mean(x)).abs() < 0.02 && (g - mean(y)).abs() < 0.02, "{r}, {g} at ({x}, {y})");
        }
    }
}

//! What a block of pixels brings to the picture: a sample counts for every pixel whose filter it lies under.

use glam::Vec3;
use trove_model::Raster;

use super::tile::{BLOCK_PX, MARGIN_PX};

/// A block with the pixels around it, to which its samples reach.
const SIDE: usize = BLOCK_PX as usize + 2;

/// Weighted radiance, and the weights.
pub(super) type Splat = [f32; 4];

/// Share of the variance of a pixel's own samples that is left when pixels share theirs: the integral of the tent's square.
pub(super) const SHARED: f32 = 4.0 / 9.0;

/// What a block's samples bring to the pixels in and around it, which are means under a tent of radius 1.
pub(super) struct Splats([Splat; SIDE * SIDE]);

impl Splats {
    pub(super) fn none() -> Self {
        Self([[0.0; 4]; SIDE * SIDE])
    }

    /// Adds a sample at a position in the block's pixels.
    pub(super) fn add(&mut self, position: [f32; 2], radiance: Vec3) {
        // From the centre of the pixel before the first.
        let [x, y] = position.map(|p| p + 0.5);
        let (column, row) = (x as usize, y as usize);
        let (u, v) = (x - column as f32, y - row as f32);
        for (place, weight) in [
            (row * SIDE + column, (1.0 - u) * (1.0 - v)),
            (row * SIDE + column + 1, u * (1.0 - v)),
            ((row + 1) * SIDE + column, (1.0 - u) * v),
            ((row + 1) * SIDE + column + 1, u * v),
        ] {
            let [r, g, b] = (radiance * weight).to_array();
            let splat = &mut self.0[place];
            *splat = [splat[0] + r, splat[1] + g, splat[2] + b, splat[3] + weight];
        }
    }

    /// Adds one over `count` of them to a film; `corner` is the block's in it.
    pub(super) fn develop(&self, corner: [u32; 2], count: u32, film: &mut Raster<Splat>) {
        for (i, splat) in self.0.iter().enumerate() {
            let place = [corner[0] as usize + i % SIDE, corner[1] as usize + i / SIDE];
            // The first splat is of the pixel before the block's corner, which is counted from the margin's.
            let [x, y] = place.map(|p| (p as u32).wrapping_sub(1 + MARGIN_PX));
            if x < film.width && y < film.height {
                let to = film.at_mut(x, y);
                (0..4).for_each(|c| to[c] += splat[c] / count as f32);
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
        let mut film = Raster::filled(6, 6, [0.0; 4]);
        for corner in [[0, 0], [4, 0], [0, 4], [4, 4]] {
            let mut splats = Splats::none();
            let fine = || (0..400).map(|i| (i as f32 + 0.5) / 100.0);
            for (x, y) in fine().flat_map(|y| fine().map(move |x| (x, y))) {
                let at = |corner: u32, p: f32| (corner as f32 + p - MARGIN_PX as f32).powi(2);
                splats.add([x, y], Vec3::new(at(corner[0], x), at(corner[1], y), 1.0));
            }
            splats.develop(corner, 10_000, &mut film);
        }
        for (x, y) in (0..6).flat_map(|y| (0..6).map(move |x| (x, y))) {
            let [r, g, b, weight] = *film.at(x, y);
            // The mean of squares under a tent is the centre's square and its variance, 1/6.
            let mean = |p: u32| (p as f32 + 0.5).powi(2) + 1.0 / 6.0;
            assert!((weight - 1.0).abs() < 1e-3 && (b - weight).abs() < 1e-6, "{weight} at ({x}, {y})");
            assert!((r - mean(x)).abs() < 0.02 && (g - mean(y)).abs() < 0.02, "{r}, {g} at ({x}, {y})");
        }
    }
}

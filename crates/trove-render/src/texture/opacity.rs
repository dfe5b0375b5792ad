//! Where a cut-out texture is there: one bit a cell, so that rays need neither its colours nor arithmetic.

use glam::Vec2;
use trove_model::Texture;
use trove_trace::Mask;

use super::mip_map::MipMap;

/// Cells a texel's side: between texels the edge runs as filtered alpha has it.
const FINER: u32 = 2;
/// Sides beyond this many cells would not stay in the caches.
const SIDE_MAX: u32 = 4096;
/// Mixed alpha may be beyond what it is mixed from by this.
const ROUNDING: f32 = 1e-3;

/// Cells of a repeating texture whose alpha reaches the cut-off, in blocks of 8×8 bits.
pub(crate) struct OpacityMask {
    /// As in [`Mask`].
    size: [i32; 2],
    blocks: Vec<u64>,
    cutoff: f32,
}

impl OpacityMask {
    /// Alpha filtered as the texture is, against `cutoff`.
    pub(crate) fn new(texture: &Texture, map: &MipMap, cutoff: f32) -> Self {
        let side = |texels: u32| (texels * FINER).next_power_of_two().clamp(8, SIDE_MAX);
        let (width, height) = (side(texture.width), side(texture.height));
        let (columns, rows) = (width / 8, height / 8);
        let size = Vec2::new(width as f32, height as f32);
        let centre = |x: u32, y: u32| (Vec2::new(x as f32, y as f32) + 0.5) / size;
        let bit = |x: u32, y: u32| map.alpha(centre(x, y)) >= cutoff;
        let block = |i: u32| {
            let (x, y) = (i % columns * 8, i / columns * 8);
            // Most blocks are far from any edge.
            let [least, most] = map.alphas(centre(x, y), centre(x + 7, y + 7));
            if least - ROUNDING > cutoff || most + ROUNDING < cutoff {
                return if least > cutoff { u64::MAX } else { 0 };
            }
            (0..64).fold(0u64, |bits, k| bits | u64::from(bit(x + k % 8, y + k / 8)) << k)
        };
        Self { size: [width as i32, height as i32], blocks: (0..columns * rows).map(block).collect(), cutoff }
    }

    /// The cut-off that it was made for.
    pub(crate) fn cutoff(&self) -> f32 {
        self.cutoff
    }

    /// Whether the surface is there at `uv`.
    pub(crate) fn covers(&self, uv: Vec2) -> bool {
        self.cells().covers(uv)
    }

    /// As kernels look at it.
    pub(crate) fn cells(&self) -> Mask<'_> {
        Mask { size: self.size, blocks: &self.blocks }
    }
}

#[cfg(test)]
mod tests {
    use glam::vec2;
    use trove_model::{ColorSpace, Seed};

    use super::*;

    /// Round leaves, side by side.
    fn leaves(width: u32, height: u32) -> (Texture, MipMap) {
        let alpha = |x: u32, y: u32| {
            let p = vec2(x as f32 + 0.5, y as f32 + 0.5) % 32.0 - 16.0;
            if p.length() < 11.0 { 255 } else { 0 }
        };
        let rgba = (0..width * height).map(|i| [0, 99, 0, alpha(i % width, i / width)]).collect();
        let texture = Texture { name: "leaves".into(), width, height, rgba, color_space: ColorSpace::Srgb };
        let map = MipMap::new(&texture);
        (texture, map)
    }

    #[test]
    fn the_mask_is_where_filtered_alpha_reaches_the_cut_off() {
        for (width, height) in [(64, 64), (96, 160), (3, 1)] {
            let (texture, map) = leaves(width, height);
            let mask = OpacityMask::new(&texture, &map, 0.5);
            let mut random = Seed(3).random();
            let n = 20_000;
            let uvs = (0..n).map(|_| vec2(random.range(-3.0, 3.0) as f32, random.range(-3.0, 3.0) as f32));
            let differs = uvs.filter(|&uv| mask.covers(uv) != (map.alpha(uv) >= 0.5)).count();
            assert!(differs * 50 < n, "{differs} of {n} for {width}×{height}"); // at the leaves' edges
        }
    }

    #[test]
    fn blocks_far_from_an_edge_are_what_their_cells_are() {
        for (width, height) in [(64, 64), (96, 160), (3, 1), (5, 7)] {
            let (texture, map) = leaves(width, height);
            for cutoff in [0.1, 0.5, 1.0] {
                let mask = OpacityMask::new(&texture, &map, cutoff);
                let [columns, rows] = mask.size.map(|side| side as f32);
                for i in 0..mask.size[0] * mask.size[1] {
                    let cell = vec2((i % mask.size[0]) as f32, (i / mask.size[0]) as f32);
                    let uv = (cell + 0.5) / vec2(columns, rows);
                    assert_eq!(mask.covers(uv), map.alpha(uv) >= cutoff, "{width}×{height}, {cutoff}: {cell}");
                }
            }
        }
    }

    #[test]
    fn a_leaf_card_keeps_its_coverage_however_far_it_is() {
        let (texture, map) = leaves(128, 128);
        let mask = OpacityMask::new(&texture, &map, 0.5);
        let share = std::f32::consts::PI * 11.0 * 11.0 / (32.0 * 32.0);
        // Samples of a pixel that is as wide as 1/64, 1/8, 1 and 8 cards fall all over it.
        for pixel in [1.0 / 64.0, 1.0 / 8.0, 1.0, 8.0f32] {
            let mut random = Seed(5).random();
            let n = 40_000;
            let mut unit = || random.unit() as f32;
            let there = (0..n).filter(|_| {
                let corner = vec2(unit(), unit());
                mask.covers(corner + pixel * vec2(unit(), unit()))
            });
            let covered = there.count() as f32 / n as f32;
            assert!((covered / share - 1.0).abs() < 0.03, "{covered} instead of {share} at {pixel}");
        }
    }
}

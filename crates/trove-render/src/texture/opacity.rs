//! Where a cut-out texture is there: one bit a cell, so that rays need neither its colours nor arithmetic.

use glam::Vec2;
use trove_model::{Mesh, Texture};

use super::MipMap;

/// Cells a texel's side: between texels the edge runs as filtered alpha has it.
const FINER: u32 = 2;
/// Sides beyond this many cells would not stay in the caches.
const SIDE_MAX: u32 = 4096;

/// Cells of a repeating texture whose alpha reaches the cut-off, in blocks of 8×8 bits.
pub(crate) struct OpacityMask {
    /// Powers of two, at least 8.
    width: i32,
    height: i32,
    /// Blocks in a row of them, as a power of two.
    row_shift: u32,
    /// Bit 8·y + x of a block; rows run up with v.
    blocks: Vec<u64>,
    cutoff: f32,
}

/// What a cut-out texture leaves of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coverage {
    /// All of it is there.
    Full,
    /// Some of it is there, or it was not worth looking.
    Partial,
    /// Nothing of it is there.
    Empty,
}

impl OpacityMask {
    /// Alpha filtered as the texture is, against `cutoff`.
    pub(crate) fn new(texture: &Texture, map: &MipMap, cutoff: f32) -> Self {
        let side = |texels: u32| (texels * FINER).next_power_of_two().clamp(8, SIDE_MAX);
        let (width, height) = (side(texture.width), side(texture.height));
        let (columns, rows) = (width / 8, height / 8);
        let size = Vec2::new(width as f32, height as f32);
        let bit = |x: u32, y: u32| map.alpha((Vec2::new(x as f32, y as f32) + 0.5) / size) >= cutoff;
        let block = |i: u32| {
            let (x, y) = (i % columns * 8, i / columns * 8);
            (0..64).fold(0u64, |bits, k| bits | u64::from(bit(x + k % 8, y + k / 8)) << k)
        };
        Self {
            width: width as i32,
            height: height as i32,
            row_shift: columns.trailing_zeros(),
            blocks: (0..columns * rows).map(block).collect(),
            cutoff,
        }
    }

    /// The cut-off that it was made for.
    pub(crate) fn cutoff(&self) -> f32 {
        self.cutoff
    }

    /// Whether the surface is there at `uv`.
    pub(crate) fn covers(&self, uv: Vec2) -> bool {
        self.bit(floor(uv.x * self.width as f32), floor(uv.y * self.height as f32))
    }

    /// A cell, counted from the lower left, repeating.
    fn bit(&self, x: i32, y: i32) -> bool {
        let (x, y) = (x & (self.width - 1), y & (self.height - 1));
        let block = ((y >> 3) << self.row_shift) | (x >> 3);
        self.blocks[block as usize] >> (((y & 7) << 3) | (x & 7)) & 1 != 0
    }

    /// What is there of a triangle with these texture coordinates, never claiming too much.
    pub(crate) fn coverage(&self, corners: [Vec2; 3]) -> Coverage {
        let size = Vec2::new(self.width as f32, self.height as f32);
        let corners = corners.map(|uv| uv * size);
        let low = corners[0].min(corners[1]).min(corners[2]);
        let high = corners[0].max(corners[1]).max(corners[2]);
        // NaN is not worth looking at either.
        if !((high - low).cmple(size).all()) {
            return Coverage::Partial;
        }
        let mut seen = [false; 2];
        for y in floor(low.y)..=floor(high.y) {
            let Some((from, to)) = row_of(corners, y as f32) else { continue };
            for x in floor(from)..=floor(to) {
                seen[usize::from(self.bit(x, y))] = true;
            }
            if seen == [true; 2] {
                return Coverage::Partial;
            }
        }
        if seen[1] { Coverage::Full } else { Coverage::Empty }
    }

    /// What is there of each triangle of a mesh that it is drawn on, texture coordinates times `uv_scale`.
    pub(crate) fn coverages(&self, mesh: &Mesh, uv_scale: Vec2) -> Vec<Coverage> {
        if mesh.uvs.is_empty() {
            let all = if self.covers(Vec2::ZERO) { Coverage::Full } else { Coverage::Empty };
            return vec![all; mesh.triangles.len()];
        }
        mesh.triangles.iter().map(|t| self.coverage(t.map(|i| mesh.uvs[i as usize] * uv_scale))).collect()
    }
}

/// The largest whole number that is not above `x`; the library's `floor` is a call on many processors.
fn floor(x: f32) -> i32 {
    let whole = x as i32;
    whole - i32::from(whole as f32 > x)
}

/// From where to where a triangle reaches between the heights `y` and `y` + 1.
fn row_of(corners: [Vec2; 3], y: f32) -> Option<(f32, f32)> {
    let (mut from, mut to) = (f32::INFINITY, f32::NEG_INFINITY);
    let mut take = |x: f32| (from, to) = (from.min(x), to.max(x));
    for i in 0..3 {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        if (y..=y + 1.0).contains(&a.y) {
            take(a.x);
        }
        for level in [y, y + 1.0] {
            if (a.y < level) != (b.y < level) {
                take(a.x + (b.x - a.x) * ((level - a.y) / (b.y - a.y)));
            }
        }
    }
    (from <= to).then_some((from, to))
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

    #[test]
    fn a_triangle_is_full_or_empty_only_if_every_point_of_it_is() {
        let (texture, map) = leaves(64, 64);
        let mask = OpacityMask::new(&texture, &map, 0.5);
        let mut random = Seed(7).random();
        let mut found = [0; 3];
        for _ in 0..3000 {
            let mut unit = || random.unit() as f32;
            let at = 4.0 * vec2(unit(), unit()) - 2.0;
            let corners = [(); 3].map(|()| at + 0.3 * vec2(unit(), unit()));
            let coverage = mask.coverage(corners);
            found[coverage as usize] += 1;
            for _ in 0..50 {
                let (a, b) = (unit(), unit());
                let (a, b) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
                let is_there = mask.covers(corners[0] * (1.0 - a - b) + corners[1] * a + corners[2] * b);
                assert!(coverage == Coverage::Partial || is_there == (coverage == Coverage::Full), "{corners:?}");
            }
        }
        assert!(found.iter().all(|&n| n > 100), "{found:?}");
    }
}

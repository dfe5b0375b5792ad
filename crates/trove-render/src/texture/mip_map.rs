//! A texture and ever smaller copies of it.

use std::ops::Range;
use std::sync::LazyLock;

use glam::{Vec2, Vec4};
use trove_model::{ColorSpace, Texture};
use trove_trace::between;

use crate::lookups::LOOKUPS;

/// A texture and its smaller copies, 8 bits a channel as they came.
pub(crate) struct MipMap {
    size: [u32; 2],
    firsts: Vec<u32>,
    texels: Vec<[u8; 4]>,
    color_space: ColorSpace,
}

/// One of the copies.
pub(super) struct Level {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) texels: Vec<[u8; 4]>,
}

impl MipMap {
    /// Averages 2×2 texels in linear light, down to one.
    pub(crate) fn new(texture: &Texture) -> Self {
        let mut levels = vec![Level { width: texture.width, height: texture.height, texels: texture.rgba.clone() }];
        while let Some(level) = levels.last().filter(|l| l.width > 1 || l.height > 1) {
            levels.push(level.halved(texture.color_space));
        }
        Self::of(&levels, texture.color_space)
    }

    /// Of copies, each half as large as the one before, rounded up.
    pub(super) fn of(levels: &[Level], color_space: ColorSpace) -> Self {
        let mut texels = Vec::with_capacity(levels.iter().map(|level| level.texels.len()).sum());
        let append = |level: &Level| {
            let first = texels.len() as u32;
            texels.extend_from_slice(&level.texels);
            first
        };
        let firsts = levels.iter().map(append).collect();
        Self { size: [levels[0].width, levels[0].height], firsts, texels, color_space }
    }

    /// As it is looked up.
    pub(crate) fn texture(&self) -> trove_trace::Texture<'_> {
        let is_srgb = self.color_space == ColorSpace::Srgb;
        trove_trace::Texture { size: self.size, firsts: &self.firsts, texels: &self.texels, is_srgb }
    }

    /// The colour at `uv` as sharp as it is; alpha is the fourth.
    #[cfg(test)]
    pub(crate) fn at(&self, uv: Vec2) -> Vec4 {
        self.texture().sample(&LOOKUPS, uv, Vec2::ZERO, 0.0)
    }

    /// The mean of all texels.
    pub(crate) fn mean(&self) -> Vec4 {
        self.texture().mean(&LOOKUPS)
    }

    /// Alpha at `uv` in full resolution.
    pub(super) fn alpha(&self, uv: Vec2) -> f32 {
        self.texture().alpha(uv)
    }

    /// The least and the greatest alpha that can be at points from `low` to `high`.
    pub(super) fn alphas(&self, low: Vec2, high: Vec2) -> [f32; 2] {
        let [width, height] = self.size;
        let columns = texels([low.x, high.x], width);
        let rows = texels([1.0 - high.y, 1.0 - low.y], height);
        let of_row = |y: usize| columns.clone().map(move |x| (x % width as usize, y % height as usize));
        let alphas = rows.flat_map(of_row).map(|(x, y)| self.texels[y * width as usize + x][3]);
        let [least, most] = alphas.fold([u8::MAX, 0], |[least, most], alpha| [least.min(alpha), most.max(alpha)]);
        [least, most].map(|alpha| f32::from(alpha) / 255.0)
    }
}

/// The texels of `n` repeating ones that are looked at from one coordinate to another, counted on where they repeat.
fn texels([from, to]: [f32; 2], n: u32) -> Range<usize> {
    let ((first, ..), (_, last, _)) = (between(from, n), between(to, n));
    if (to - from) * n as f32 + 2.0 > n as f32 {
        return 0..n as usize;
    }
    first as usize..(last + 1 + if last < first { n } else { 0 }) as usize
}

impl Level {
    fn halved(&self, color_space: ColorSpace) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let is_srgb = color_space == ColorSpace::Srgb;
        let at = |x: u32, y: u32| {
            let (x, y) = (x.min(self.width - 1), y.min(self.height - 1));
            LOOKUPS.decode(self.texels[y as usize * self.width as usize + x as usize], is_srgb)
        };
        let mut texels = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            for x in 0..width {
                let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| at(2 * x + dx, 2 * y + dy));
                // Colours count by their coverage: what cannot be seen must not bleed into what can.
                let alpha: f32 = four.iter().map(|t| t.w).sum();
                let weight = |t: &Vec4| if alpha > 0.0 { t.w / alpha } else { 0.25 };
                let mean: Vec4 = four.iter().map(|t| *t * weight(t)).sum();
                texels.push(encode(mean.truncate().extend(alpha / 4.0), color_space));
            }
        }
        Self { width, height, texels }
    }
}

/// Linear light to sRGB bytes, in steps of which every byte has at least one.
static SRGB: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let byte = |i: u32| {
        let c = i as f32 / SRGB_STEPS;
        let s = if c <= 0.003_130_8 { c * 12.92 } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
        (s * 255.0).round() as u8
    };
    (0..=SRGB_STEPS as u32).map(byte).collect()
});

const SRGB_STEPS: f32 = 8192.0;

pub(super) fn encode(value: Vec4, color_space: ColorSpace) -> [u8; 4] {
    let value = value.clamp(Vec4::ZERO, Vec4::ONE);
    let byte = |c: f32| (c * 255.0 + 0.5) as u8;
    let color = |c: f32| match color_space {
        ColorSpace::Linear => byte(c),
        ColorSpace::Srgb => SRGB[(c * SRGB_STEPS + 0.5) as usize],
    };
    [color(value.x), color(value.y), color(value.z), byte(value.w)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(width: u32, height: u32, f: impl Fn(u32, u32) -> [u8; 4]) -> Texture {
        let rgba = (0..width * height).map(|i| f(i % width, i / width)).collect();
        Texture { name: "test".into(), width, height, rgba, color_space: ColorSpace::Srgb }
    }

    #[test]
    fn a_texel_is_read_at_its_centre_and_v_runs_up() {
        let map = MipMap::new(&texture(5, 3, |x, y| [0, 0, 0, (10 * y + x) as u8]));
        for (x, y) in [(0, 0), (4, 0), (2, 1), (4, 2)] {
            let uv = Vec2::new((x as f32 + 0.5) / 5.0, 1.0 - (y as f32 + 0.5) / 3.0);
            for turn in [-2.0, 0.0, 1.0] {
                assert!((map.alpha(uv + turn) * 255.0 - (10 * y + x) as f32).abs() < 1e-2);
            }
        }
    }

    #[test]
    fn the_smallest_copy_is_the_mean_of_the_light() {
        let map = MipMap::new(&texture(8, 8, |x, y| [if (x + y) % 2 == 0 { 255 } else { 0 }; 4]));
        let far = map.texture().sample(&LOOKUPS, Vec2::new(0.3, 0.7), Vec2::ONE, 0.5);
        assert!((far.w - 0.5).abs() < 0.01, "{far}"); // alpha
        let opaque = MipMap::new(&texture(8, 8, |x, y| if (x + y) % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] }));
        assert!((opaque.texture().sample(&LOOKUPS, Vec2::ZERO, Vec2::ONE, 0.5).x - 0.5).abs() < 0.01);
    }

    #[test]
    fn colours_survive_being_decoded_and_encoded() {
        for byte in 0..=255u8 {
            assert_eq!(encode(LOOKUPS.decode([byte; 4], true), ColorSpace::Srgb), [byte; 4]);
        }
    }
}

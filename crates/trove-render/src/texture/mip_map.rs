//! A texture and ever smaller copies of it, looked up bilinearly.

use std::ops::Range;
use std::sync::LazyLock;

use glam::{Vec2, Vec4};
use trove_model::{ColorSpace, Texture};

/// A texture and its smaller copies, 8 bits a channel as they came.
pub(crate) struct MipMap {
    pub(super) levels: Vec<Level>,
    pub color_space: ColorSpace,
}

pub(super) struct Level {
    pub width: u32,
    pub height: u32,
    pub texels: Vec<[u8; 4]>,
}

/// sRGB bytes to linear light.
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|i| {
        let s = i as f32 / 255.0;
        if s <= 0.04045 { s / 12.92 } else { ((s + 0.055) / 1.055).powf(2.4) }
    })
});

/// Plain bytes to numbers.
pub(super) static PLAIN: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|i| i as f32 / 255.0));

impl MipMap {
    /// Averages 2×2 texels in linear light, down to one.
    pub(crate) fn new(texture: &Texture) -> Self {
        let mut levels = vec![Level { width: texture.width, height: texture.height, texels: texture.rgba.clone() }];
        while let Some(level) = levels.last().filter(|l| l.width > 1 || l.height > 1) {
            levels.push(level.halved(texture.color_space));
        }
        Self { levels, color_space: texture.color_space }
    }

    /// The colour at `uv` averaged over about `footprint` (in units of uv); alpha is the fourth.
    ///
    /// Between two sizes `dither`, uniform in [0, 1), chooses: the mean over many look-ups is their blend, at half the
    /// cost.
    pub(crate) fn sample(&self, uv: Vec2, footprint: Vec2, dither: f32) -> Vec4 {
        let texels = footprint * self.size();
        // Both directions alike: the geometric mean of the two sides.
        let lod = 0.5 * (texels.x * texels.y).max(1.0).log2();
        let level = ((lod + dither) as usize).min(self.levels.len() - 1);
        self.levels[level].bilinear(uv, table(self.color_space))
    }

    /// Texels of the largest copy.
    pub(crate) fn size(&self) -> Vec2 {
        Vec2::new(self.levels[0].width as f32, self.levels[0].height as f32)
    }

    /// The mean of all texels.
    pub(crate) fn mean(&self) -> Vec4 {
        self.levels.last().map_or(Vec4::ZERO, |last| last.bilinear(Vec2::ZERO, table(self.color_space)))
    }

    /// Alpha at `uv` in full resolution.
    pub(super) fn alpha(&self, uv: Vec2) -> f32 {
        self.levels[0].bilinear_alpha(uv)
    }

    /// The least and the greatest alpha that can be at points from `low` to `high`.
    pub(super) fn alphas(&self, low: Vec2, high: Vec2) -> [f32; 2] {
        let level = &self.levels[0];
        let columns = texels([low.x, high.x], level.width);
        let rows = texels([1.0 - high.y, 1.0 - low.y], level.height);
        let of_row = |y: usize| columns.clone().map(move |x| (x % level.width as usize, y % level.height as usize));
        let alphas = rows.flat_map(of_row).map(|(x, y)| level.texels[y * level.width as usize + x][3]);
        let [least, most] = alphas.fold([u8::MAX, 0], |[least, most], alpha| [least.min(alpha), most.max(alpha)]);
        [least, most].map(|alpha| f32::from(alpha) / 255.0)
    }
}

/// The texels of `n` repeating ones that are looked at from one coordinate to another, counted on where they repeat.
fn texels([from, to]: [f32; 2], n: u32) -> Range<usize> {
    let ((first, ..), (_, last, _)) = (between(from, n), between(to, n));
    let n = n as usize;
    if (to - from) * n as f32 + 2.0 > n as f32 {
        return 0..n;
    }
    first..last + 1 + if last < first { n } else { 0 }
}

fn table(color_space: ColorSpace) -> &'static [f32; 256] {
    match color_space {
        ColorSpace::Srgb => &LINEAR,
        ColorSpace::Linear => &PLAIN,
    }
}

/// The two of `n` repeating texels around a coordinate whose period is 1, and the position between their centres.
fn between(coordinate: f32, n: u32) -> (usize, usize, f32) {
    // Divisions and calls to `floor` would cost more than the rest of a look-up.
    let whole = coordinate as i32 as f32;
    let fraction = coordinate - whole;
    let fraction = if fraction < 0.0 { fraction + 1.0 } else { fraction };
    let position = fraction * n as f32 + 0.5;
    let above = position as usize;
    let (last, next) = (n as usize - 1, above.min(n as usize));
    (
        if next == 0 { last } else { next - 1 },
        if next > last { 0 } else { next },
        (position - above as f32).clamp(0.0, 1.0),
    )
}

impl Level {
    /// The four texels around `uv` and the position between them; v runs up, rows run down.
    pub(super) fn corners(&self, uv: Vec2) -> ([[u8; 4]; 4], f32, f32) {
        let ((x0, x1, fx), (y0, y1, fy)) = (between(uv.x, self.width), between(1.0 - uv.y, self.height));
        let (upper, lower) = (y0 * self.width as usize, y1 * self.width as usize);
        let at = |i: usize| self.texels[i];
        ([at(upper + x0), at(upper + x1), at(lower + x0), at(lower + x1)], fx, fy)
    }

    pub(super) fn bilinear(&self, uv: Vec2, table: &[f32; 256]) -> Vec4 {
        let (corners, fx, fy) = self.corners(uv);
        let [a, b, c, d] = corners.map(|t| decode(t, table));
        a.lerp(b, fx).lerp(c.lerp(d, fx), fy)
    }

    pub(super) fn bilinear_alpha(&self, uv: Vec2) -> f32 {
        let (corners, fx, fy) = self.corners(uv);
        let [a, b, c, d] = corners.map(|t| f32::from(t[3]));
        let (top, bottom) = (a + (b - a) * fx, c + (d - c) * fx);
        (top + (bottom - top) * fy) / 255.0
    }

    pub(super) fn halved(&self, color_space: ColorSpace) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let table = table(color_space);
        let at = |x: u32, y: u32| {
            let (x, y) = (x.min(self.width - 1), y.min(self.height - 1));
            decode(self.texels[y as usize * self.width as usize + x as usize], table)
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

pub(super) fn decode(t: [u8; 4], table: &[f32; 256]) -> Vec4 {
    let [r, g, b, a] = t.map(usize::from);
    Vec4::new(table[r], table[g], table[b], a as f32 / 255.0)
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
        let far = map.sample(Vec2::new(0.3, 0.7), Vec2::ONE, 0.5);
        assert!((far.w - 0.5).abs() < 0.01, "{far}"); // alpha
        let opaque = MipMap::new(&texture(8, 8, |x, y| if (x + y) % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] }));
        assert!((opaque.sample(Vec2::ZERO, Vec2::ONE, 0.5).x - 0.5).abs() < 0.01);
    }

    #[test]
    fn colours_survive_being_decoded_and_encoded() {
        for byte in 0..=255u8 {
            assert_eq!(encode(decode([byte; 4], &LINEAR), ColorSpace::Srgb), [byte; 4]);
        }
    }
}

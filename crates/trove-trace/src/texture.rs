//! A texture and ever smaller copies of it, looked up bilinearly.

use glam::{Vec2, Vec4};

use crate::flat::Table;
use crate::lookups::Lookups;
use crate::math::log2;

/// Copies of a texture, each half as large as the one before, down to one texel.
#[derive(Clone, Copy)]
pub struct Texture<'a> {
    /// Texels of the first copy.
    pub size: [u32; 2],
    /// Where the rows of each copy begin.
    pub firsts: &'a [u32],
    /// All copies' texels, row by row from the top.
    pub texels: &'a [[u8; 4]],
    /// Whether bytes of colour are sRGB; else they are plain numbers.
    pub is_srgb: bool,
}

/// Something that may hold a texture.
pub trait Map {
    /// The texture, if there is one.
    fn texture(&self) -> Option<Texture<'_>>;
}

/// A texture in the memory of whoever reads it; without texels there is none.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FlatTexture {
    firsts: Table<u32>,
    texels: Table<[u8; 4]>,
    size: [u32; 2],
    is_srgb: bool,
}

impl FlatTexture {
    /// # Safety
    /// Both tables have to be as in [`Texture`] and stay as they are.
    pub unsafe fn new(size: [u32; 2], firsts: Table<u32>, texels: Table<[u8; 4]>, is_srgb: bool) -> Self {
        Self { firsts, texels, size, is_srgb }
    }
}

impl Map for FlatTexture {
    #[inline(always)]
    fn texture(&self) -> Option<Texture<'_>> {
        // SAFETY: whoever made it vouches for both.
        let (firsts, texels) = unsafe { (self.firsts.values(), self.texels.values()) };
        (!texels.is_empty()).then_some(Texture { size: self.size, firsts, texels, is_srgb: self.is_srgb })
    }
}

impl Texture<'_> {
    /// The colour at `uv` averaged over about `footprint` (in units of uv); alpha is the fourth.
    ///
    /// Between two sizes `dither`, uniform in [0, 1), chooses: the mean over many look-ups is their blend, at half the
    /// cost.
    #[inline]
    pub fn sample(&self, lookups: &Lookups, uv: Vec2, footprint: Vec2, dither: f32) -> Vec4 {
        let texels = footprint * self.sides();
        // Both directions alike: the geometric mean of the two sides.
        let lod = 0.5 * log2((texels.x * texels.y).clamp(1.0, f32::MAX));
        self.bilinear(lookups, ((lod + dither) as usize).min(self.firsts.len() - 1), uv)
    }

    /// The colour at `uv` in full resolution.
    #[inline]
    pub fn sharp(&self, lookups: &Lookups, uv: Vec2) -> Vec4 {
        self.bilinear(lookups, 0, uv)
    }

    /// The mean of all texels.
    pub fn mean(&self, lookups: &Lookups) -> Vec4 {
        self.bilinear(lookups, self.firsts.len() - 1, Vec2::ZERO)
    }

    /// Texels of the first copy.
    #[inline]
    pub fn sides(&self) -> Vec2 {
        Vec2::new(self.size[0] as f32, self.size[1] as f32)
    }

    /// Alpha at `uv` in full resolution.
    pub fn alpha(&self, uv: Vec2) -> f32 {
        let (corners, fx, fy) = self.corners(0, uv);
        let [a, b, c, d] = corners.map(|t| f32::from(t[3]));
        let (top, bottom) = (a + (b - a) * fx, c + (d - c) * fx);
        (top + (bottom - top) * fy) / 255.0
    }

    #[inline(always)]
    fn bilinear(&self, lookups: &Lookups, level: usize, uv: Vec2) -> Vec4 {
        let (corners, fx, fy) = self.corners(level, uv);
        let [a, b, c, d] = corners.map(|texel| lookups.decode(texel, self.is_srgb));
        a.lerp(b, fx).lerp(c.lerp(d, fx), fy)
    }

    /// The four texels around `uv` and the position between them; v runs up, rows run down.
    #[inline(always)]
    fn corners(&self, level: usize, uv: Vec2) -> ([[u8; 4]; 4], f32, f32) {
        let [width, height] = self.size.map(|side| ((side - 1) >> level) + 1);
        let ((x0, x1, fx), (y0, y1, fy)) = (between(uv.x, width), between(1.0 - uv.y, height));
        let row = |y: u32| self.firsts[level] + y * width;
        let at = |i: u32| self.texels[i as usize];
        ([at(row(y0) + x0), at(row(y0) + x1), at(row(y1) + x0), at(row(y1) + x1)], fx, fy)
    }
}

/// The two of `n` repeating texels around a coordinate whose period is 1, and the position between their centres.
#[inline(always)]
pub fn between(coordinate: f32, n: u32) -> (u32, u32, f32) {
    // Divisions and calls to `floor` would cost more than the rest of a look-up.
    let whole = coordinate as i32 as f32;
    let fraction = coordinate - whole;
    let fraction = if fraction < 0.0 { fraction + 1.0 } else { fraction };
    let position = fraction * n as f32 + 0.5;
    let above = position as u32;
    let (last, next) = (n - 1, above.min(n));
    (
        if next == 0 { last } else { next - 1 },
        if next > last { 0 } else { next },
        (position - above as f32).clamp(0.0, 1.0),
    )
}

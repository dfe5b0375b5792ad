//! What is looked up, since computing it would take longer.

use glam::{Vec2, Vec4};

use crate::bsdf::Lobes;
use crate::fog::Scattering;
use crate::math::floor2;

/// Cells of the noise along each side.
pub const NOISE_SIDE: usize = 256;

/// Tables that all materials share.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Lookups {
    /// What lobes reflect.
    pub lobes: Lobes,
    /// As [`Scattering::broad`] gives it.
    pub broad: Scattering,
    /// sRGB bytes as linear light.
    linear: [f32; 256],
    /// Plain bytes as numbers.
    plain: [f32; 256],
    noise: [u8; NOISE_SIDE * NOISE_SIDE],
}

impl Lookups {
    /// With sRGB bytes as linear light, and with a repeating field, row by row, of bytes as evenly spread as can be.
    pub fn new(linear: [f32; 256], noise: [u8; NOISE_SIDE * NOISE_SIDE]) -> Self {
        let plain = core::array::from_fn(|i| i as f32 / 255.0);
        Self { lobes: Lobes::new(), broad: Scattering::broad(), linear, plain, noise }
    }

    /// A texel as light or as numbers; alpha is the fourth.
    #[inline(always)]
    pub fn decode(&self, [r, g, b, a]: [u8; 4], is_srgb: bool) -> Vec4 {
        let table = if is_srgb { &self.linear } else { &self.plain };
        let [r, g, b] = [r, g, b].map(|byte| table[usize::from(byte)]);
        Vec4::new(r, g, b, f32::from(a) / 255.0)
    }

    /// The noise at a point, from 0 to 1, of any area as much above 1 − s as the share s of it; it has period 1, and
    /// features are a sixteenth of that and finer.
    #[inline]
    pub fn noise(&self, p: Vec2) -> f32 {
        let p = p * NOISE_SIDE as f32;
        let low = floor2(p);
        let t = p - low;
        let mask = NOISE_SIDE as i32 - 1;
        let (x, y) = (low.x as i32 & mask, low.y as i32 & mask);
        let (x1, y1) = ((x + 1) & mask, (y + 1) & mask);
        let at = |x: i32, y: i32| f32::from(self.noise[y as usize * NOISE_SIDE + x as usize]);
        let (top, bottom) = (at(x, y) + (at(x1, y) - at(x, y)) * t.x, at(x, y1) + (at(x1, y1) - at(x, y1)) * t.x);
        (top + (bottom - top) * t.y) / 255.0
    }
}

//! Light that enters a surface and comes out again on the same side: a rough layer of grains, a deep cloudy body, or a
//! mixture of both.

use core::f32::consts::PI;

use glam::Vec3;

/// The share that a rough layer returns of what it gets, single reflections only, for roughness 1: 1 and this slope.
const C1: f32 = 0.5 - 2.0 / (3.0 * PI);
const C2: f32 = 2.0 / 3.0 - 28.0 / (15.0 * PI);
/// Hapke's approximation of Chandrasekhar's function is up to 4 % too large: a white body would glow.
const DEEP: f32 = 0.975;

/// A diffuse lobe for one outgoing direction.
#[derive(Clone, Copy)]
#[repr(C)]
pub(super) struct Diffuse {
    /// Reflected once, and more often, between grains: energy-preserving Oren–Nayar (Portsmouth, Kutz, Hill 2025).
    single: Vec3,
    multiple: Vec3,
    roughness: f32,
    /// Scattered isotropically in a half-space (Chandrasekhar 1960, Hapke 1981): flatter towards the edges than a rough
    /// layer, and brighter when the light grazes it.
    deep: Vec3,
    gamma: Vec3,
    cos_o: f32,
}

impl Diffuse {
    /// Of a colour, `share` of the light getting there; `roughness` is Oren and Nayar's relative to its largest, and
    /// `subsurface` the deep part, each 0 to 1.
    pub(super) fn new(color: Vec3, share: f32, roughness: f32, subsurface: f32, cos_o: f32) -> Self {
        let a = 1.0 / (1.0 + C1 * roughness);
        let mean = a * (1.0 + C2 * roughness);
        // The grains' own colour, for the whole to be as bright as `color`: light between grains is reflected again.
        let grains = color / (mean + color * (1.0 - mean)).max(Vec3::splat(1e-6)) * (share * (1.0 - subsurface));
        let lost = if roughness > 0.0 { (1.0 - once(cos_o, roughness)) / (1.0 - mean) } else { 0.0 };
        let (mut deep, mut gamma) = (Vec3::ZERO, Vec3::ONE);
        if subsurface > 0.0 {
            // Whose reflectance in all is the colour (Hapke's bihemispherical reflectance, inverted to first order).
            let color = color * (Vec3::ONE + (Vec3::ONE - color) / 6.0);
            gamma = (Vec3::ONE - color) / (Vec3::ONE + color);
            deep = (Vec3::ONE - gamma * gamma) * chandrasekhar(cos_o, gamma) * (share * subsurface * DEEP / 4.0);
        }
        Self { single: grains * a, multiple: grains * color * lost, roughness, deep, gamma, cos_o }
    }

    /// BSDF · π for a direction on the same side with cosine `cos_i`; `cos_between` is that of both directions.
    pub(super) fn eval(&self, cos_i: f32, cos_between: f32) -> Vec3 {
        if self.roughness == 0.0 && self.deep == Vec3::ZERO {
            return self.single;
        }
        let s = cos_between - self.cos_o * cos_i;
        let retro = if s > 0.0 { s / self.cos_o.max(cos_i) } else { s };
        let mut f = self.single * (1.0 + self.roughness * retro) + self.multiple * (1.0 - once(cos_i, self.roughness));
        if self.deep != Vec3::ZERO {
            f += self.deep * chandrasekhar(cos_i, self.gamma) / (self.cos_o + cos_i);
        }
        f
    }
}

/// The share that a white rough layer returns by single reflections (the paper's polynomial fit).
fn once(cos: f32, roughness: f32) -> f32 {
    let m = 1.0 - cos;
    let fit = m * (0.057_108_53 + m * (0.491_881_87 + m * (-0.332_181_44 + m * 0.071_442_99)));
    (1.0 + roughness * fit) / (1.0 + C1 * roughness)
}

fn chandrasekhar(cos: f32, gamma: Vec3) -> Vec3 {
    (1.0 + 2.0 * cos) / (Vec3::ONE + 2.0 * cos * gamma)
}

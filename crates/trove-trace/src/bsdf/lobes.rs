//! How much light a lobe reflects in all, tabulated once.

use glam::{Vec2, Vec3};

use super::{ggx, sheen};
use crate::math::{sqrt, unit};

const SIDE: usize = 32;

/// What lobes reflect, by cos θo and, of facets, √α.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Lobes {
    /// The share for F = 1 split as Schlick's `f0 · x + y` (Karis 2013), a row for each α.
    facets: [[Vec2; SIDE]; SIDE],
    fibres: [f32; SIDE],
}

impl Lobes {
    /// Adds them up, which takes some milliseconds.
    pub fn new() -> Self {
        let share = |i: usize| i as f32 / (SIDE - 1) as f32;
        let row = |a: usize| {
            let alpha = (share(a) * share(a)).max(ggx::ALPHA_MIN);
            core::array::from_fn(|c| integrate(share(c).max(1e-3), alpha))
        };
        Self {
            facets: core::array::from_fn(row),
            fibres: core::array::from_fn(|c| sheen::reflected(share(c).max(1e-3))),
        }
    }

    /// The share of light from a direction with cosine `cos` that facets reflect, as (x, y) of `f0 · x + y` where a surface
    /// reflects all along it.
    #[inline]
    pub fn split(&self, cos: f32, alpha: f32) -> Vec2 {
        let ((c, fc), (a, fa)) = (cell(cos), cell(sqrt(alpha)));
        let row = |a: usize| self.facets[a][c].lerp(self.facets[a][c + 1], fc);
        row(a).lerp(row(a + 1), fa)
    }

    /// The share of light from a direction with cosine `cos` that fibres reflect.
    #[inline]
    pub(super) fn of_fibres(&self, cos: f32) -> f32 {
        let (c, fc) = cell(cos);
        self.fibres[c] + (self.fibres[c + 1] - self.fibres[c]) * fc
    }
}

impl Default for Lobes {
    fn default() -> Self {
        Self::new()
    }
}

/// Where between two entries a share from 0 to 1 lies.
#[inline(always)]
fn cell(share: f32) -> (usize, f32) {
    let x = share.clamp(0.0, 1.0) * (SIDE - 1) as f32;
    let i = (x as usize).min(SIDE - 2);
    (i, x - i as f32)
}

/// Means over a 32×32 grid of the sampler's numbers.
fn integrate(cos: f32, alpha: f32) -> Vec2 {
    const GRID: usize = 32;
    let wo = Vec3::new(sqrt((1.0 - cos * cos).max(0.0)), 0.0, cos);
    let mut sum = Vec2::ZERO;
    for k in 0..GRID * GRID {
        let u = [k % GRID, k / GRID].map(|i| (i as f32 + 0.5) / GRID as f32);
        let wi = ggx::sample(wo, alpha, u);
        if wi.z <= 0.0 {
            continue;
        }
        let h = unit(wo + wi);
        let (f_cos, pdf) = ggx::eval(wo.z, wi.z, ggx::Facet::new(h, Vec3::Z), alpha);
        let m = (1.0 - wo.dot(h)).clamp(0.0, 1.0);
        let m2 = m * m;
        let m5 = m2 * m2 * m;
        sum += f_cos / pdf * Vec2::new(1.0 - m5, m5);
    }
    sum / (GRID * GRID) as f32
}

/// Reflected share of light for normal reflectance `f0` and a [`Lobes::split`].
#[inline]
pub fn reflected(f0: Vec3, split: Vec2) -> Vec3 {
    f0 * split.x + ggx::grazing(f0) * split.y
}

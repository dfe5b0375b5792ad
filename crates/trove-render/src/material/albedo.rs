//! How much light a GGX surface reflects in all, tabulated once.

use std::sync::LazyLock;

use glam::{Vec2, Vec3};

use super::ggx;

const SIDE: usize = 32;

/// For (cos θo, √α): the reflected share for F = 1 split as Schlick's `f0 · x + y` (Karis 2013).
static TABLE: LazyLock<Vec<Vec2>> = LazyLock::new(|| {
    let cell = |i: usize| (i % SIDE, i / SIDE);
    (0..SIDE * SIDE).map(cell).map(|(c, a)| integrate(cos_of(c), alpha_of(a))).collect()
});

fn cos_of(i: usize) -> f32 {
    (i as f32 / (SIDE - 1) as f32).max(1e-3)
}

fn alpha_of(i: usize) -> f32 {
    let root = i as f32 / (SIDE - 1) as f32;
    (root * root).max(ggx::ALPHA_MIN)
}

/// Means over a 32×32 grid of the sampler's numbers.
fn integrate(cos: f32, alpha: f32) -> Vec2 {
    const GRID: usize = 32;
    let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let mut sum = Vec2::ZERO;
    for k in 0..GRID * GRID {
        let u = [k % GRID, k / GRID].map(|i| (i as f32 + 0.5) / GRID as f32);
        let wi = ggx::sample(wo, alpha, u);
        if wi.z <= 0.0 {
            continue;
        }
        let h = (wo + wi).normalize();
        let (f_cos, pdf) = ggx::eval(wo.z, wi.z, ggx::Facet::new(h, Vec3::Z), alpha);
        let m = (1.0 - wo.dot(h)).clamp(0.0, 1.0).powi(5);
        sum += f_cos / pdf * Vec2::new(1.0 - m, m);
    }
    sum / (GRID * GRID) as f32
}

/// Reflected share of light for normal reflectance `f0` and a [`split`].
pub(crate) fn reflected(f0: Vec3, split: Vec2) -> Vec3 {
    f0 * split.x + ggx::grazing(f0) * split.y
}

/// Reflected share of light from a direction with cosine `cos`, as (x, y) of `f0 · x + y` where a surface reflects all along it.
pub(crate) fn split(cos: f32, alpha: f32) -> Vec2 {
    let at = |x: f32| {
        let x = x.clamp(0.0, 1.0) * (SIDE - 1) as f32;
        let i = (x as usize).min(SIDE - 2);
        (i, x - i as f32)
    };
    let ((c, fc), (a, fa)) = (at(cos), at(alpha.sqrt()));
    let row = |a: usize| TABLE[a * SIDE + c].lerp(TABLE[a * SIDE + c + 1], fc);
    row(a).lerp(row(a + 1), fa)
}

//! Fibres that stand off a cloth (Estevez, Kulla 2017), with the visibility of Neubelt and Pettineo (2013).

use std::f32::consts::TAU;
use std::sync::LazyLock;

use super::ggx::Facet;

const SIDE: usize = 32;

/// The reflected share by cos θo.
static TABLE: LazyLock<[f32; SIDE]> =
    LazyLock::new(|| std::array::from_fn(|i| integrate(i as f32 / (SIDE - 1) as f32)));

/// The lobe times cos θi. Roughness is fixed at α = ½, where the distribution of fibres is plain 4·sin²θh / 2π.
pub(super) fn eval(cos_o: f32, cos_i: f32, facet: Facet) -> f32 {
    let distribution = 4.0 * facet.sin2 / TAU;
    distribution * cos_i / (4.0 * (cos_o + cos_i - cos_o * cos_i))
}

/// The share of light from a direction with cosine `cos` that it reflects.
pub(super) fn albedo(cos: f32) -> f32 {
    let x = cos.clamp(0.0, 1.0) * (SIDE - 1) as f32;
    let i = (x as usize).min(SIDE - 2);
    TABLE[i] + (TABLE[i + 1] - TABLE[i]) * (x - i as f32)
}

fn integrate(cos_o: f32) -> f32 {
    const GRID: usize = 64;
    let cos_o = cos_o.max(1e-3);
    let sin_o = (1.0 - cos_o * cos_o).sqrt();
    let wo = glam::Vec3::new(sin_o, 0.0, cos_o);
    let cell = |k: usize| {
        let (cos_i, turn) = (((k / GRID) as f32 + 0.5) / GRID as f32, ((k % GRID) as f32 + 0.5) / GRID as f32 * TAU);
        let sin_i = (1.0 - cos_i * cos_i).sqrt();
        let wi = glam::Vec3::new(sin_i * turn.cos(), sin_i * turn.sin(), cos_i);
        eval(cos_o, cos_i, Facet::new((wo + wi).normalize(), glam::Vec3::Z))
    };
    (0..GRID * GRID).map(cell).sum::<f32>() * TAU / (GRID * GRID) as f32
}

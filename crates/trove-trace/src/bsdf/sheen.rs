//! Fibres that stand off a cloth (Estevez, Kulla 2017), with the visibility of Neubelt and Pettineo (2013).

use core::f32::consts::TAU;

use glam::Vec3;

use super::ggx::Facet;
use crate::math::{sqrt, turn, unit};

/// The lobe times cos θi. Roughness is fixed at α = ½, where the distribution of fibres is plain 4·sin²θh / 2π.
pub(super) fn eval(cos_o: f32, cos_i: f32, facet: Facet) -> f32 {
    let distribution = 4.0 * facet.sin2 / TAU;
    distribution * cos_i / (4.0 * (cos_o + cos_i - cos_o * cos_i))
}

/// The share of light from a direction with cosine `cos_o` that it reflects, added up.
pub(super) fn reflected(cos_o: f32) -> f32 {
    const GRID: usize = 64;
    let cos_o = cos_o.max(1e-3);
    let sin_o = sqrt(1.0 - cos_o * cos_o);
    let wo = Vec3::new(sin_o, 0.0, cos_o);
    let cell = |k: usize| {
        let (cos_i, (sin, cos)) =
            (((k / GRID) as f32 + 0.5) / GRID as f32, turn(((k % GRID) as f32 + 0.5) / GRID as f32));
        let sin_i = sqrt(1.0 - cos_i * cos_i);
        let wi = Vec3::new(sin_i * cos, sin_i * sin, cos_i);
        eval(cos_o, cos_i, Facet::new(unit(wo + wi), Vec3::Z))
    };
    (0..GRID * GRID).map(cell).sum::<f32>() * TAU / (GRID * GRID) as f32
}

//! The GGX distribution of facets (Walter et al. 2007).

use core::f32::consts::PI;

use glam::Vec3;

use crate::math::{sqrt, turn, unit};

/// Smallest α: below it highlights are narrower than single precision resolves, and than the sun.
pub const ALPHA_MIN: f32 = 1e-3;

/// The normal of the facets that mirror one direction into another, as seen from the surface's own normal.
#[derive(Clone, Copy)]
pub struct Facet {
    /// Cosine of the angle between both normals.
    pub cos: f32,
    /// Squared sine: near the normal, 1 − cos² would be rounding.
    pub sin2: f32,
}

impl Facet {
    /// Of unit vectors.
    pub fn new(h: Vec3, normal: Vec3) -> Self {
        Self { cos: h.dot(normal), sin2: h.cross(normal).length_squared() }
    }
}

/// Density of facets with such a normal.
fn distribution(facet: Facet, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let d = facet.sin2 + a2 * facet.cos * facet.cos;
    a2 / (PI * d * d)
}

/// Share of facets visible from a direction with cosine `cos` (Smith).
fn visible(cos: f32, alpha: f32) -> f32 {
    2.0 * cos / (cos + sqrt(alpha * alpha + (1.0 - alpha * alpha) * cos * cos))
}

/// Reflected light without the Fresnel term, times cos θi, and the density with which [`sample`] draws `wi`.
pub fn eval(cos_o: f32, cos_i: f32, facet: Facet, alpha: f32) -> (f32, f32) {
    let d = distribution(facet, alpha);
    let a2 = alpha * alpha;
    // Masking and shadowing at correlated heights (Heitz 2014).
    let lambda = |a: f32, b: f32| a * sqrt(a2 + (1.0 - a2) * b * b);
    let g2 = 2.0 * cos_o * cos_i / (lambda(cos_o, cos_i) + lambda(cos_i, cos_o));
    (d * g2 / (4.0 * cos_o), d * visible(cos_o, alpha) / (4.0 * cos_o))
}

/// A direction reflected by a facet that is drawn among those visible from `wo` (Dupuy, Benyoub 2023); it may lie
/// below the surface. Coordinates whose z is the surface's normal.
pub fn sample(wo: Vec3, alpha: f32, u: [f32; 2]) -> Vec3 {
    let w = unit(Vec3::new(wo.x * alpha, wo.y * alpha, wo.z));
    let (sin_phi, cos_phi) = turn(u[0]);
    let z = (1.0 - u[1]) * (1.0 + w.z) - w.z;
    let sin = sqrt((1.0 - z * z).clamp(0.0, 1.0));
    let h = Vec3::new(sin * cos_phi, sin * sin_phi, z) + w;
    let h = unit(Vec3::new(h.x * alpha, h.y * alpha, h.z));
    2.0 * wo.dot(h) * h - wo
}

/// Fresnel reflectance by Schlick's approximation (1994) for normal reflectance `f0`.
pub fn schlick(f0: Vec3, cos: f32) -> Vec3 {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    let m2 = m * m;
    f0 + (Vec3::splat(grazing(f0)) - f0) * (m2 * m2 * m)
}

/// Reflectance along the surface: all of the light, but none where the body's index is that of the air around it, so that
/// there is no surface. In between it falls below an index of 1.33, water's, which is the least that solids have.
pub fn grazing(f0: Vec3) -> f32 {
    (50.0 / 3.0 * f0.element_sum()).min(1.0)
}

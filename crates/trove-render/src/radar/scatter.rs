//! What of a radar's waves a surface sends where.
//!
//! Surfaces are so much larger than the waves that these are followed as rays; what is smaller than the model shows is in a
//! lobe of facets, whose width is the surface's `spread`. So a sphere of metal has its πr² and a plate of area A at normal
//! incidence A/α², where an ideal one as smooth as its waves are long would have 4πA²/λ².

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use trove_model::RadarSurface;
use trove_trace::ggx;

/// A point on a surface, with unit vectors in World.
pub(super) struct Scatterer<'a> {
    pub(super) surface: &'a RadarSurface,
    /// Towards where the waves come from.
    pub(super) towards: DVec3,
    /// On that side.
    pub(super) normal: DVec3,
}

impl Scatterer<'_> {
    /// Share of the power that comes back at the angle of incidence (Schlick 1994).
    fn reflected(&self) -> f64 {
        let f0 = self.surface.reflectance;
        f0 + (1.0 - f0) * (1.0 - self.cos()).powi(5)
    }

    fn cos(&self) -> f64 {
        self.towards.dot(self.normal).clamp(0.0, 1.0)
    }

    /// Share of the power that leaves in a direction, per steradian.
    pub(super) fn towards(&self, leaves: DVec3) -> f64 {
        let (cos_i, cos_o) = (self.cos(), leaves.dot(self.normal));
        if cos_i <= 0.0 || cos_o <= 0.0 {
            return 0.0;
        }
        let half = (self.towards + leaves).normalize_or(self.normal);
        let facet = ggx::Facet::new(single(half), single(self.normal));
        let (lobe, _) = ggx::eval(cos_i as f32, cos_o as f32, facet, self.surface.spread as f32);
        let diffuse = self.surface.diffuse;
        self.reflected() * ((1.0 - diffuse) * f64::from(lobe) + diffuse * cos_o / PI)
    }

    /// Share of the power that goes on as by a mirror: what is rough for the wave's length and slant does not mirror it
    /// (Rayleigh).
    pub(super) fn mirrored(&self, wavelength_m: f64) -> f64 {
        let phase = 4.0 * PI * self.surface.height_m * self.cos() / wavelength_m;
        self.reflected() * (1.0 - self.surface.diffuse) * (-phase * phase).exp()
    }

    /// Where a mirror sends them.
    pub(super) fn mirror(&self) -> DVec3 {
        2.0 * self.towards.dot(self.normal) * self.normal - self.towards
    }
}

fn single(v: DVec3) -> Vec3 {
    v.as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a body, dσ = 4π · share per steradian · cos of incidence · dA.
    fn of_sphere(surface: &RadarSurface) -> f64 {
        let steps = 20_000;
        let ring = |i: usize| {
            let angle = PI / 2.0 * (i as f64 + 0.5) / steps as f64;
            let normal = DVec3::new(angle.sin(), 0.0, angle.cos());
            let share = Scatterer { surface, towards: DVec3::Z, normal }.towards(DVec3::Z);
            4.0 * PI * share * angle.cos() * 2.0 * PI * angle.sin() * (PI / 2.0 / steps as f64)
        };
        (0..steps).map(ring).sum()
    }

    #[test]
    fn spheres_have_the_sections_of_their_closed_forms() {
        // Of radius 1: πr² of a mirror, 8/3 πr² of a matt sphere.
        let metal = RadarSurface { reflectance: 1.0, spread: 0.02, ..RadarSurface::default() };
        assert!((of_sphere(&metal) / PI - 1.0).abs() < 0.01, "{}", of_sphere(&metal) / PI);
        let matt = RadarSurface { reflectance: 1.0, diffuse: 1.0, spread: 0.5, ..RadarSurface::default() };
        assert!((of_sphere(&matt) / PI - 8.0 / 3.0).abs() < 1e-3);
    }

    #[test]
    fn asphalt_mirrors_at_a_slant_alone() {
        let asphalt = RadarSurface { reflectance: 0.1, spread: 0.3, height_m: 0.8e-3, ..RadarSurface::default() };
        let at = |degrees: f64| {
            let towards = DVec3::new(degrees.to_radians().cos(), 0.0, degrees.to_radians().sin());
            Scatterer { surface: &asphalt, towards, normal: DVec3::Z }.mirrored(3.9e-3)
        };
        assert!(at(3.0) > 0.7 && at(30.0) < 0.05, "{} {}", at(3.0), at(30.0));
    }
}

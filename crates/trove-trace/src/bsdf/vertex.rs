//! A vertex of a path as plain numbers, and how light scatters there.

use glam::Vec3;

use super::{Bsdf, Lobes, Parameters};

/// A point of a surface that a path has arrived at, what light is asked for, and what draws the way on.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub struct Vertex {
    /// As for [`Bsdf::new`].
    pub wo: Vec3,
    /// As for [`Bsdf::new`].
    pub geometric: Vec3,
    /// As for [`Bsdf::new`].
    pub normal: Vec3,
    /// Where light would come from, unit.
    pub to_light: Vec3,
    /// Random numbers, as for [`Bsdf::sample`].
    pub u: [f32; 3],
    /// What the surface is made of.
    pub parameters: Parameters,
}

/// How light scatters at a [`Vertex`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub struct Scattered {
    /// BSDF · cos for the light asked for.
    pub light: Vec3,
    /// Density of drawing its direction.
    pub light_pdf: f32,
    /// The way on, unit; zero where there is none.
    pub wi: Vec3,
    /// Density of that, 0 straight through.
    pub pdf: f32,
    /// BSDF · cos / density of it.
    pub weight: Vec3,
    /// The cone of directions it stands for, radians.
    pub spread_rad: f32,
    /// All that the surface reflects of white light.
    pub albedo: Vec3,
}

impl Vertex {
    /// All of it at once.
    #[inline(always)]
    pub fn scatter(&self, lobes: &Lobes) -> Scattered {
        let bsdf = Bsdf::new(lobes, self.wo, self.geometric, self.normal, &self.parameters);
        let (light, light_pdf) = bsdf.eval(self.to_light);
        let (mut wi, mut pdf, mut weight, mut spread_rad) = (Vec3::ZERO, 0.0, Vec3::ZERO, 0.0);
        if let Some(on) = bsdf.sample(self.u) {
            (wi, pdf, weight, spread_rad) = (on.wi, on.pdf.unwrap_or(0.0), on.weight, on.spread_rad);
        }
        Scattered { light, light_pdf, wi, pdf, weight, spread_rad, albedo: bsdf.albedo }
    }
}

//! A vertex of a path as plain numbers, and how light scatters there.

use glam::Vec3;

use crate::bsdf::Bsdf;
use crate::flat::Table;
use crate::lookups::Lookups;
use crate::material::Material;
use crate::surface::Surface;
use crate::texture::{FlatTexture, Map};

/// A point of a surface that a path has arrived at, what light is asked for, and what draws the way on.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub struct Vertex {
    /// Where it is.
    pub surface: Surface,
    /// Where light would come from, unit.
    pub to_light: Vec3,
    /// As for [`Material::parameters`].
    pub width_m: f32,
    /// Random numbers, as for [`Bsdf::sample`].
    pub u: [f32; 3],
    /// As for [`Material::parameters`].
    pub dither: f32,
    /// Index of its material.
    pub material: u32,
}

/// How light scatters at a [`Vertex`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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
    pub fn scatter<T: Map>(&self, lookups: &Lookups, material: &Material<T>) -> Scattered {
        let Self { surface, to_light, width_m, u, dither, .. } = self;
        let (parameters, normal) = material.parameters(lookups, surface, *width_m, *dither);
        let bsdf = Bsdf::new(&lookups.lobes, surface.wo, surface.geometric, normal, &parameters);
        let (light, light_pdf) = bsdf.eval(*to_light);
        let (mut wi, mut pdf, mut weight, mut spread_rad) = (Vec3::ZERO, 0.0, Vec3::ZERO, 0.0);
        if let Some(on) = bsdf.sample(*u) {
            (wi, pdf, weight, spread_rad) = (on.wi, on.pdf.unwrap_or(0.0), on.weight, on.spread_rad);
        }
        Scattered { light, light_pdf, wi, pdf, weight, spread_rad, albedo: bsdf.albedo }
    }
}

/// What surfaces are made of, in the memory of whoever reads it.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FlatMaterials {
    /// One.
    pub lookups: Table<Lookups>,
    /// By index.
    pub materials: Table<Material<FlatTexture>>,
}

impl FlatMaterials {
    /// As [`Vertex::scatter`].
    ///
    /// # Safety
    /// Both tables have to be there, and the vertex's material has to be in them.
    #[inline(always)]
    pub unsafe fn scatter(&self, vertex: &Vertex) -> Scattered {
        // SAFETY: the caller vouches for both.
        let (lookups, materials) = unsafe { (self.lookups.values(), self.materials.values()) };
        vertex.scatter(&lookups[0], &materials[vertex.material as usize])
    }
}

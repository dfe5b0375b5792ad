//! How surfaces look.

use std::sync::Arc;

use glam::{Vec2, Vec3};

/// What a texture's numbers mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorSpace {
    /// Colours, sRGB-encoded; alpha is linear.
    Srgb,
    /// Plain numbers: normals, roughness, masks.
    Linear,
}

/// An 8-bit RGBA image that repeats in both directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// For people and for files (`asphalt-worn.color`); the same name means the same image.
    pub name: String,
    /// Columns.
    pub width: u32,
    /// Rows; row 0 is the top (v = 1).
    pub height: u32,
    /// `width * height` texels.
    pub rgba: Vec<[u8; 4]>,
    /// What the numbers mean.
    pub color_space: ColorSpace,
}

/// A principled surface; colours are linear Rec. 709.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// For people and for files.
    pub name: String,
    /// Base colour (reflectance of a dielectric, F0 of a metal); multiplies the map.
    pub base_color: Vec3,
    /// Base colour and, in alpha, coverage.
    pub base_color_map: Option<Arc<Texture>>,
    /// Alpha below which a surface is not there (cut-out); 0: alpha is not looked at.
    pub alpha_cutoff: f32,
    /// Perceptual roughness (GGX α is its square); multiplies the map's green.
    pub roughness: f32,
    /// 0 dielectric, 1 metal; multiplies the map's blue.
    pub metalness: f32,
    /// glTF's order: occlusion, roughness, metalness.
    pub orm_map: Option<Arc<Texture>>,
    /// Tangent-space normals, OpenGL's way (green up).
    pub normal_map: Option<Arc<Texture>>,
    /// Index of refraction of the dielectric.
    pub ior: f32,
    /// 0 to 1: a clear lacquer over everything else (car paint).
    pub coat: f32,
    /// 0 to 1: share of light that goes straight through a thin pane (glass).
    pub transmission: f32,
    /// 0 to 1: share of diffuse light that comes out on the other side (leaves).
    pub translucency: f32,
    /// Emitted radiance, W·m⁻²·sr⁻¹ in the renderer's scale (a clear midday sky is about 0.1, see the light's docs).
    pub emission: Vec3,
    /// Texture coordinates are multiplied by it (1 / the texture's size where a mesh's uvs are metres).
    pub uv_scale: Vec2,
}

impl Default for Material {
    /// Grey, rough, opaque.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec3::splat(0.5),
            base_color_map: None,
            alpha_cutoff: 0.0,
            roughness: 0.8,
            metalness: 0.0,
            orm_map: None,
            normal_map: None,
            ior: 1.5,
            coat: 0.0,
            transmission: 0.0,
            translucency: 0.0,
            emission: Vec3::ZERO,
            uv_scale: Vec2::ONE,
        }
    }
}

impl Material {
    /// A plain colour.
    pub fn plain(name: &str, base_color: Vec3, roughness: f32) -> Self {
        Self { name: name.into(), base_color, roughness, ..Self::default() }
    }

    /// Whether it emits light.
    pub fn is_emitter(&self) -> bool {
        self.emission.max_element() > 0.0
    }

    /// The images that it uses.
    pub fn textures(&self) -> impl Iterator<Item = &Arc<Texture>> {
        [&self.base_color_map, &self.orm_map, &self.normal_map].into_iter().flatten()
    }
}

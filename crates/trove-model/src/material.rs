//! How surfaces look.

use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4};

use crate::srgb::decoded;
use crate::{Beam, Role};

/// What a texture's numbers mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ColorSpace {
    /// Colours, sRGB-encoded; alpha is linear.
    Srgb,
    /// Plain numbers: normals, roughness, masks.
    Linear,
}

/// An 8-bit RGBA image that repeats in both directions.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Texture {
    /// For people and for files (`asphalt-worn.color`); the same name means the same image.
    pub name: String,
    /// Columns.
    pub width: u32,
    /// Rows; row 0 is the top (v = 1).
    pub height: u32,
    /// `width * height` texels.
    #[cfg_attr(feature = "serde", serde(with = "crate::flat"))]
    pub rgba: Vec<[u8; 4]>,
    /// What the numbers mean.
    pub color_space: ColorSpace,
}

impl Texture {
    /// What a texel means: linear colour, or plain numbers, and alpha, 0 to 1.
    pub fn decoded(&self, texel: [u8; 4]) -> Vec4 {
        let numbers = Vec4::from(texel.map(|value| f32::from(value) / 255.0));
        match self.color_space {
            ColorSpace::Linear => numbers,
            ColorSpace::Srgb => numbers.truncate().map(decoded).extend(numbers.w),
        }
    }

    /// The mean of the texels whose alpha is at least `cutoff`, decoded, and how many of all they are; without any it is
    /// white, and all.
    pub fn mean(&self, cutoff: f32) -> (Vec4, f32) {
        let mut counts = [[0.0f32; 4]; 256];
        let mut there = 0.0;
        for texel in self.rgba.iter().filter(|texel| f32::from(texel[3]) >= 255.0 * cutoff) {
            there += 1.0;
            texel.iter().enumerate().for_each(|(channel, value)| counts[usize::from(*value)][channel] += 1.0);
        }
        if there == 0.0 {
            return (Vec4::ONE, 1.0);
        }
        let sum: Vec4 = (0..=255).zip(counts).map(|(value, count)| self.decoded([value; 4]) * Vec4::from(count)).sum();
        (sum / there, there / self.rgba.len() as f32)
    }
}

/// How texture coordinates come about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Mapping {
    /// The mesh's own.
    #[default]
    Uv,
    /// The mesh's positions in metres, seen along whichever of its axes the surface faces most; next to an edge both
    /// are mixed. For meshes without useful texture coordinates.
    Triplanar,
}

/// How a texture goes on beyond its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Tiling {
    /// It repeats.
    #[default]
    Repeat,
    /// Every cell of a hexagonal lattice shows another part of it, so that no repetition is seen (after Heitz and
    /// Neyret 2018). For what has no larger structure: asphalt, grass, plaster.
    Stochastic,
}

/// A principled surface; colours are linear Rec. 709.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
    /// Heights in the first channel, 0 to 1; where there is a normal map too, that is the same relief and wins.
    pub height_map: Option<Arc<Texture>>,
    /// Height of 1 in the height map above its 0, metres.
    pub height_m: f32,
    /// Index of refraction of the dielectric.
    pub ior: f32,
    /// 0 to 1: a clear lacquer over everything else (car paint).
    pub coat: f32,
    /// 0 to 1: metal flakes in the paint under the lacquer.
    pub flakes: f32,
    /// 0 to 1: fibres that stand off the surface and shine at grazing angles (cloth).
    pub sheen: f32,
    /// 0 to 1: share of diffuse light that wanders about below the surface before it leaves (skin, wax).
    pub subsurface: f32,
    /// 0 to 1: share of light that goes straight through a thin pane (glass).
    pub transmission: f32,
    /// 0 to 1: share of diffuse light that comes out on the other side (leaves).
    pub translucency: f32,
    /// 0 to 1: how much of light that comes from a sensor goes straight back to it (sheeting of signs, plates, glass beads in
    /// paint); 1 is new sheeting. LiDARs alone see it: pictures have no light beside the camera.
    pub retroreflection: f32,
    /// Radiance emitted to the side from which a triangle's corners run counter-clockwise, W·m⁻²·sr⁻¹ in the renderer's
    /// scale (a clear midday sky is about 0.1, see the light's docs).
    pub emission: Vec3,
    /// What the emission is multiplied by where: its colour. Looked up by texture coordinates; without them its mean counts.
    pub emission_map: Option<Arc<Texture>>,
    /// What the emission is multiplied by into each direction; `None`: the same everywhere on that side.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub beam: Option<Arc<Beam>>,
    /// 0 to 1: what weather, feet and wheels leave: streaks on walls, stains on level ground, dust near the foot.
    pub dirt: f32,
    /// 0 to 1: rain that lies on it. Level places are filmed with water and, from about a half, hold puddles; slopes
    /// are damp.
    pub wetness: f32,
    /// Texture coordinates are multiplied by it (1 / the texture's size where a mesh's uvs are metres).
    pub uv_scale: Vec2,
    /// Where texture coordinates come from.
    pub mapping: Mapping,
    /// What is beyond a texture's edges.
    pub tiling: Tiling,
    /// What it does in the scene, if more than it looks.
    pub role: Option<Role>,
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
            height_map: None,
            height_m: 0.0,
            ior: 1.5,
            coat: 0.0,
            flakes: 0.0,
            sheen: 0.0,
            subsurface: 0.0,
            transmission: 0.0,
            translucency: 0.0,
            retroreflection: 0.0,
            emission: Vec3::ZERO,
            emission_map: None,
            beam: None,
            dirt: 0.0,
            wetness: 0.0,
            uv_scale: Vec2::ONE,
            mapping: Mapping::Uv,
            tiling: Tiling::Repeat,
            role: None,
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
        // Taken apart whole: a new map does not compile until it is one of them.
        let Self {
            base_color_map,
            orm_map,
            normal_map,
            height_map,
            emission_map,
            name: _,
            base_color: _,
            alpha_cutoff: _,
            roughness: _,
            metalness: _,
            height_m: _,
            ior: _,
            coat: _,
            flakes: _,
            sheen: _,
            subsurface: _,
            transmission: _,
            translucency: _,
            retroreflection: _,
            emission: _,
            beam: _,
            dirt: _,
            wetness: _,
            uv_scale: _,
            mapping: _,
            tiling: _,
            role: _,
        } = self;
        [base_color_map, orm_map, normal_map, height_map, emission_map].into_iter().flatten()
    }

    /// The images that it uses, to be replaced.
    pub fn textures_mut(&mut self) -> impl Iterator<Item = &mut Arc<Texture>> {
        let Self { base_color_map, orm_map, normal_map, height_map, emission_map, .. } = self;
        [base_color_map, orm_map, normal_map, height_map, emission_map].into_iter().flatten()
    }
}

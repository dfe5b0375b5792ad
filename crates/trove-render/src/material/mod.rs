//! How light leaves a surface.

mod albedo;
mod bsdf;
mod ggx;

use std::sync::Arc;

use glam::{Vec2, Vec3};
use trove_model::{Material, Texture};

use crate::cache::Cache;
use crate::prepare::Surface;
use crate::texture::MipMap;

pub(crate) use bsdf::Bsdf;

/// A material with its textures filtered.
pub(crate) struct PreparedMaterial {
    base_color: Vec3,
    base_color_map: Option<Arc<MipMap>>,
    alpha_cutoff: f32,
    roughness: f32,
    metalness: f32,
    orm_map: Option<Arc<MipMap>>,
    normal_map: Option<Arc<MipMap>>,
    /// Normal reflectance of the dielectric.
    f0: f32,
    coat: f32,
    transmission: f32,
    translucency: f32,
    pub(crate) emission: Vec3,
    uv_scale: Vec2,
}

impl PreparedMaterial {
    /// Numbers outside their range are brought into it.
    pub(crate) fn new(material: &Material, textures: &Cache<Texture, MipMap>) -> Self {
        let map = |texture: &Option<Arc<Texture>>| texture.as_ref().map(|t| textures.get(t, MipMap::new));
        let ior = material.ior.max(1.0);
        Self {
            base_color: material.base_color.clamp(Vec3::ZERO, Vec3::ONE),
            base_color_map: map(&material.base_color_map),
            alpha_cutoff: material.alpha_cutoff,
            roughness: material.roughness.clamp(0.0, 1.0),
            metalness: material.metalness.clamp(0.0, 1.0),
            orm_map: map(&material.orm_map),
            normal_map: map(&material.normal_map),
            f0: ((ior - 1.0) / (ior + 1.0)).powi(2),
            coat: material.coat.clamp(0.0, 1.0),
            transmission: material.transmission.clamp(0.0, 1.0),
            translucency: material.translucency.clamp(0.0, 1.0),
            emission: material.emission.max(Vec3::ZERO),
            uv_scale: material.uv_scale,
        }
    }

    /// Whether rays must ask at every hit if they go on.
    pub(crate) fn lets_light_pass(&self) -> bool {
        self.has_cutout() || self.transmission > 0.0
    }

    /// Whether it has holes.
    pub(crate) fn has_cutout(&self) -> bool {
        self.alpha_cutoff > 0.0 && self.base_color_map.is_some()
    }

    /// Whether the surface is there, at texture coordinates before scaling.
    pub(crate) fn covers(&self, uv: Vec2) -> bool {
        self.base_color_map.as_ref().is_none_or(|map| map.alpha(uv * self.uv_scale) >= self.alpha_cutoff)
    }

    /// The share of light that goes straight through a pane at an angle with cosine `cos` to its normal.
    pub(crate) fn straight_through(&self, cos: f32) -> Vec3 {
        if self.transmission <= 0.0 {
            return Vec3::ZERO;
        }
        let split = albedo::split(cos.abs(), self.alpha(self.roughness));
        let reflected = self.pane_f0() * split.x + split.y;
        self.base_color * ((1.0 - reflected) * self.transmission * (1.0 - self.metalness))
    }

    /// How it scatters light at a point; `width_m` is the width of what one sample covers there,
    /// `dither` a random number in [0, 1).
    pub(crate) fn shade(&self, surface: &Surface, width_m: f32, dither: f32) -> Bsdf {
        let uv = surface.uv * self.uv_scale;
        let footprint = surface.uv_axes.map_or(Vec2::ZERO, |[along_u, along_v]| {
            width_m * self.uv_scale.abs() / Vec2::new(along_u.length(), along_v.length()).max(Vec2::splat(1e-9))
        });
        let color = self.base_color_map.as_ref().map_or(Vec3::ONE, |map| map.sample(uv, footprint, dither).truncate());
        let orm = self.orm_map.as_ref().map_or(Vec3::ONE, |map| map.sample(uv, footprint, dither).truncate());
        let normal = match (&self.normal_map, surface.uv_axes) {
            (Some(map), Some(axes)) => bumped(surface, axes, map.sample(uv, footprint, dither).truncate() * 2.0 - 1.0),
            _ => surface.shading,
        };
        Bsdf::new(
            surface,
            normal,
            &bsdf::Parameters {
                base_color: self.base_color * color,
                alpha: self.alpha(self.roughness * orm.y),
                metalness: self.metalness * orm.z,
                f0: self.pane_f0(),
                coat: self.coat,
                translucency: self.translucency,
                transmission: self.transmission,
                tint: self.base_color,
            },
        )
    }

    fn alpha(&self, roughness: f32) -> f32 {
        (roughness * roughness).max(ggx::ALPHA_MIN)
    }

    /// Normal reflectance; a pane reflects at both of its faces, back and forth (the sum of that series).
    fn pane_f0(&self) -> f32 {
        self.f0 + self.transmission * (2.0 * self.f0 / (1.0 + self.f0) - self.f0)
    }
}

/// The shading normal turned by a normal map's `texel`.
fn bumped(surface: &Surface, [along_u, along_v]: [Vec3; 2], texel: Vec3) -> Vec3 {
    let side = if surface.is_front { 1.0 } else { -1.0 };
    let normal = surface.shading * side;
    let tangent = (along_u - normal * normal.dot(along_u)).normalize_or_zero();
    let bitangent = normal.cross(tangent);
    let bitangent = if bitangent.dot(along_v) < 0.0 { -bitangent } else { bitangent };
    let turned = tangent * texel.x + bitangent * texel.y + normal * texel.z.max(1e-3);
    turned.normalize_or(normal) * side
}

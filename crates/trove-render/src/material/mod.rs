//! How light leaves a surface.

mod albedo;
mod bsdf;
mod diffuse;
mod ggx;
mod sheen;
mod texturing;
mod weather;

use std::sync::Arc;

use glam::{Vec2, Vec3};
use trove_model::Material;

use crate::prepare::Surface;
use crate::texture::{MipMap, OpacityMask, Textures};
use bsdf::{Coat, Parameters};
use texturing::{Spot, Texturing};
use weather::Weather;

pub(crate) use bsdf::Bsdf;

/// Roughness α and normal reflectance of lacquer.
const LACQUER_ALPHA: f32 = 0.003;
const LACQUER_F0: f32 = 0.04;
/// Oren and Nayar's roughness of a surface of perceptual roughness 1: slopes of about 30°, as of asphalt.
const DIFFUSE_ROUGHNESS: f32 = 0.45;
/// Width of metal flakes, metres, and the standard deviation of their slopes.
const FLAKE_M: f32 = 0.0005;
const FLAKE_SLOPE: f32 = 0.17;
/// How metallic paint full of flakes is: pigment lies between them.
const FLAKES_METALNESS: f32 = 0.6;

/// The relief that a material shows.
enum Relief {
    None,
    Normals(Arc<MipMap>),
    /// With the height of its range.
    Heights(Arc<MipMap>, f32),
}

/// A material with its textures filtered.
pub(crate) struct PreparedMaterial {
    base_color: Vec3,
    base_color_map: Option<Arc<MipMap>>,
    /// Where it has holes.
    cutout: Option<Arc<OpacityMask>>,
    roughness: f32,
    metalness: f32,
    orm_map: Option<Arc<MipMap>>,
    relief: Relief,
    /// Normal reflectance of the dielectric.
    f0: f32,
    coat: f32,
    flakes: f32,
    sheen: f32,
    subsurface: f32,
    transmission: f32,
    translucency: f32,
    pub(crate) emission: Vec3,
    texturing: Texturing,
    weather: Weather,
}

impl PreparedMaterial {
    /// Numbers outside their range are brought into it.
    pub(crate) fn new(material: &Material, textures: &Textures) -> Self {
        let ior = material.ior.max(1.0);
        let share = |x: f32| x.clamp(0.0, 1.0);
        let color_map = material.base_color_map.as_ref();
        Self {
            base_color: material.base_color.clamp(Vec3::ZERO, Vec3::ONE),
            base_color_map: color_map.map(|t| textures.map(t)),
            cutout: color_map.filter(|_| material.alpha_cutoff > 0.0).map(|t| textures.mask(t, material.alpha_cutoff)),
            roughness: share(material.roughness),
            metalness: share(material.metalness),
            orm_map: material.orm_map.as_ref().map(|t| textures.map(t)),
            relief: match (&material.normal_map, &material.height_map) {
                (Some(normals), _) => Relief::Normals(textures.normals(normals)),
                (None, Some(heights)) => Relief::Heights(textures.heights(heights), material.height_m),
                (None, None) => Relief::None,
            },
            f0: ((ior - 1.0) / (ior + 1.0)).powi(2),
            coat: share(material.coat),
            flakes: share(material.flakes),
            sheen: share(material.sheen),
            subsurface: share(material.subsurface),
            transmission: share(material.transmission),
            translucency: share(material.translucency),
            emission: material.emission.max(Vec3::ZERO),
            texturing: Texturing { scale: material.uv_scale, mapping: material.mapping, tiling: material.tiling },
            weather: Weather { dirt: share(material.dirt), wetness: share(material.wetness) },
        }
    }

    /// Whether some light goes straight through it.
    pub(crate) fn is_pane(&self) -> bool {
        self.transmission > 0.0
    }

    /// Whether light that comes from behind is scattered to the front.
    pub(crate) fn is_translucent(&self) -> bool {
        self.translucency > 0.0
    }

    /// Whether it has holes.
    pub(crate) fn has_cutout(&self) -> bool {
        self.cutout.is_some()
    }

    /// Whether the surface is there, at texture coordinates before scaling.
    pub(crate) fn covers(&self, uv: Vec2) -> bool {
        self.cutout.as_ref().is_none_or(|mask| mask.covers(uv * self.texturing.scale))
    }

    /// The share of light that goes straight through a pane at an angle with cosine `cos` to its normal.
    pub(crate) fn straight_through(&self, cos: f32) -> Vec3 {
        let split = albedo::split(cos.abs(), alpha(self.roughness));
        let reflected = self.pane_f0() * split.x + split.y;
        self.base_color * ((1.0 - reflected) * self.transmission * (1.0 - self.metalness))
    }

    /// How it scatters light at a point; `width_m` is the width of what one sample covers there,
    /// `dither` a random number in [0, 1).
    pub(crate) fn shade(&self, surface: &Surface, width_m: f32, dither: f32) -> Bsdf {
        let spot = self.texturing.spot(surface, width_m, dither);
        let look_up = |map: &Arc<MipMap>| map.sample(spot.uv, spot.footprint, spot.dither);
        let color = self.base_color_map.as_ref().map_or(Vec3::ONE, |map| look_up(map).truncate());
        let orm = self.orm_map.as_ref().map_or(Vec3::ONE, |map| look_up(map).truncate());
        let (normal, variance) = self.bumped(surface, &spot);

        let base_color = (self.base_color * color * surface.tint).clamp(Vec3::ZERO, Vec3::ONE);
        let roughness = self.roughness * orm.y;
        let mut p = Parameters {
            base_color,
            alpha: rougher(alpha(roughness), variance),
            diffuse_roughness: DIFFUSE_ROUGHNESS * roughness * roughness,
            metalness: self.metalness * orm.z,
            f0: self.pane_f0(),
            coat: Coat { normal: surface.shading, share: self.coat, alpha: LACQUER_ALPHA, f0: LACQUER_F0 },
            // Fibres are thin enough to be paler than the cloth.
            sheen: self.sheen * (0.5 + 0.5 * base_color),
            subsurface: self.subsurface,
            translucency: self.translucency,
            transmission: self.transmission,
            tint: self.base_color,
        };
        let mut normal = normal;
        if self.flakes > 0.0 {
            normal = self.flaked(surface, width_m, normal, &mut p);
        }
        if !self.weather.is_none() {
            normal = self.weather.wear(surface, width_m, normal, &mut p);
        }
        Bsdf::new(surface, normal, &p)
    }

    /// The shading normal turned by the relief, and the variance of the slopes that are too small to be seen.
    fn bumped(&self, surface: &Surface, spot: &Spot) -> (Vec3, f32) {
        let Some(axes) = spot.axes else { return (surface.shading, 0.0) };
        match &self.relief {
            Relief::None => (surface.shading, 0.0),
            Relief::Normals(map) => {
                let texel = map.sample(spot.uv, spot.footprint, spot.dither);
                // A mean of unit vectors is shorter than 1 by the mean of both slopes' variances.
                (turned(surface, axes, texel.truncate() * 2.0 - 1.0), texel.w * texel.w)
            }
            Relief::Heights(map, range_m) => {
                let texel = map.sample(spot.uv, spot.footprint, spot.dither);
                let gain = *range_m * map.size() / spot.metres;
                let slope = (texel.truncate().truncate() * 2.0 - 1.0) * gain;
                (turned(surface, axes, (-slope).extend(1.0)), (texel.w * gain).length_squared() / 2.0)
            }
        }
    }

    /// The normal of one flake where a sample is small enough to see one; the others become roughness.
    fn flaked(&self, surface: &Surface, width_m: f32, normal: Vec3, p: &mut Parameters) -> Vec3 {
        p.metalness += (FLAKES_METALNESS - p.metalness).max(0.0) * self.flakes;
        let seen = FLAKE_M / (FLAKE_M + width_m);
        p.alpha = rougher(p.alpha, self.flakes * FLAKE_SLOPE * FLAKE_SLOPE * (1.0 - seen * seen));
        // Uniform in a cube of standard deviation 1.
        let cell = (surface.point_mesh / FLAKE_M).floor().as_ivec3();
        let tilt = (texturing::random3(cell) - 0.5) * 12f32.sqrt();
        (normal + tilt * (self.flakes.sqrt() * FLAKE_SLOPE * seen)).normalize_or(normal)
    }

    /// Normal reflectance; a pane reflects at both of its faces, back and forth (the sum of that series).
    fn pane_f0(&self) -> f32 {
        self.f0 + self.transmission * (2.0 * self.f0 / (1.0 + self.f0) - self.f0)
    }
}

/// GGX α of a perceptual roughness.
fn alpha(roughness: f32) -> f32 {
    (roughness * roughness).max(ggx::ALPHA_MIN)
}

/// GGX α of facets on slopes that vary themselves (variances add up; α² is twice that of each slope).
fn rougher(alpha: f32, variance: f32) -> f32 {
    (alpha * alpha + 2.0 * variance).sqrt().min(1.0)
}

/// The shading normal turned by a tangent-space normal.
fn turned(surface: &Surface, [along_u, along_v]: [Vec3; 2], texel: Vec3) -> Vec3 {
    let side = if surface.is_front { 1.0 } else { -1.0 };
    let normal = surface.shading * side;
    let tangent = (along_u - normal * normal.dot(along_u)).normalize_or_zero();
    let bitangent = normal.cross(tangent);
    let bitangent = if bitangent.dot(along_v) < 0.0 { -bitangent } else { bitangent };
    let turned = tangent * texel.x + bitangent * texel.y + normal * texel.z.max(1e-3);
    turned.normalize_or(normal) * side
}

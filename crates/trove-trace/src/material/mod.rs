//! What a surface is made of at a point.

mod parallax;
mod snow;
mod texturing;
mod water;
mod weather;

use glam::{Vec2, Vec3, Vec4};

use crate::bsdf::{Bsdf, Coat, Lobes, Parameters, ggx, reflected};
use crate::light::Beams;
use crate::lookups::Lookups;
use crate::math::{floor, sqrt, unit_or};
use crate::ray::NONE;
use crate::surface::Surface;
use crate::texture::{Map, Texture};
use texturing::{Spot, Tiling};

pub use snow::holds as holds_snow;
#[cfg(test)]
pub(crate) use texturing::random3;

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

/// A material with its maps, which may be missing; shares are from 0 to 1.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Material<T> {
    /// Colour, times that of the map.
    pub base_color: Vec3,
    /// Perceptual roughness, times the second channel of `orm_map`.
    pub roughness: f32,
    /// Share of the surface that is bare metal, times the third channel of `orm_map`.
    pub metalness: f32,
    /// Normal reflectance of the dielectric.
    pub f0: f32,
    /// Share of lacquer.
    pub coat: f32,
    /// Share of paint that is full of metal flakes.
    pub flakes: f32,
    /// Fibres that stand off a cloth.
    pub sheen: f32,
    /// Share of what scatters that does so deep inside.
    pub subsurface: f32,
    /// Share of what enters that goes straight through.
    pub transmission: f32,
    /// Share of what scatters that comes out on the other side.
    pub translucency: f32,
    /// How dirty it is.
    pub dirt: f32,
    /// How wet rain has made it.
    pub wetness: f32,
    /// The height of white above black in the map of heights, metres.
    pub height_m: f32,
    /// How far the mesh lies below white, as a share of that.
    pub height_of_mesh: f32,
    /// Radiance of its front, where the map of emission is white and its beam brightest.
    pub emission: Vec3,
    /// Index of the beam by which that differs between directions; [`NONE`] for none.
    pub beam: u32,
    /// What texture coordinates are multiplied by.
    pub scale: Vec2,
    /// Colours.
    pub base_color_map: T,
    /// Roughness in the second channel, metalness in the third.
    pub orm_map: T,
    /// Tangent-space normals, x, y, z from 0 to 1, and √(1 − length) of the mean that they stand for.
    pub normal_map: T,
    /// Slopes along u and v from 0 to 1 for −1 to 1 of the heights' range per texel, the height from 0 to 1, and the root of
    /// the slopes' variance. Without `normal_map` they tell where a surface faces.
    pub height_map: T,
    /// What the emission is multiplied by where.
    pub emission_map: T,
    /// Whether textures are laid along World's axes instead of by the mesh's coordinates.
    pub is_triplanar: bool,
    /// Whether they are laid in patches, so that nobody sees them repeat.
    pub is_stochastic: bool,
}

impl<T> Material<T> {
    /// The same with other maps.
    ///
    /// # Errors
    /// Those of making a map.
    pub fn with_maps<U, E>(&self, mut map: impl FnMut(&T) -> Result<U, E>) -> Result<Material<U>, E> {
        Ok(Material {
            base_color: self.base_color,
            roughness: self.roughness,
            metalness: self.metalness,
            f0: self.f0,
            coat: self.coat,
            flakes: self.flakes,
            sheen: self.sheen,
            subsurface: self.subsurface,
            transmission: self.transmission,
            translucency: self.translucency,
            dirt: self.dirt,
            wetness: self.wetness,
            height_m: self.height_m,
            height_of_mesh: self.height_of_mesh,
            emission: self.emission,
            beam: self.beam,
            scale: self.scale,
            base_color_map: map(&self.base_color_map)?,
            orm_map: map(&self.orm_map)?,
            normal_map: map(&self.normal_map)?,
            height_map: map(&self.height_map)?,
            emission_map: map(&self.emission_map)?,
            is_triplanar: self.is_triplanar,
            is_stochastic: self.is_stochastic,
        })
    }
}

impl<T: Map> Material<T> {
    /// What its lobes are made from at a point, and the shading normal; `width_m` is the width of what one sample covers
    /// there, `dither` a random number in [0, 1).
    #[inline]
    pub fn parameters(&self, lookups: &Lookups, surface: &Surface, width_m: f32, dither: f32) -> (Parameters, Vec3) {
        let spot = self.spot(lookups, surface, width_m, dither);
        let orm = look_up(&self.orm_map, lookups, &spot).map_or(Vec3::ONE, Vec4::truncate);
        let (normal, variance) = self.bumped(lookups, surface, &spot);

        let base_color = self.colored(lookups, surface, &spot);
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
        if self.dirt > 0.0 {
            weather::soil(lookups, surface, self.dirt, width_m, &mut p);
        }
        // What is sheltered has dried.
        if self.wetness > 0.0 && surface.exposure.is_open {
            normal = weather::rain(lookups, surface, self.wetness, width_m, normal, &mut p);
        }
        if surface.exposure.snow > 0.0 {
            normal = snow::lie(lookups, surface, width_m, normal, &mut p);
        }
        (p, normal)
    }

    /// Radiance that it emits from its front at a texture coordinate into a direction of the mesh.
    #[inline]
    pub fn emitted(
        &self,
        lookups: &Lookups,
        beams: &Beams<'_>,
        uv: Vec2,
        direction_mesh: impl FnOnce() -> Vec3,
    ) -> Vec3 {
        if self.emission == Vec3::ZERO {
            return Vec3::ZERO;
        }
        let here = self.emission_map.texture().map_or(Vec3::ONE, |map| map.sharp(lookups, uv * self.scale).truncate());
        let share = if self.beam == NONE { 1.0 } else { beams.share(self.beam, direction_mesh()) };
        self.emission * here * share
    }

    /// How it scatters light at a point, as for [`Self::parameters`].
    #[inline]
    pub fn shade(&self, lookups: &Lookups, surface: &Surface, width_m: f32, dither: f32) -> Bsdf {
        let (p, normal) = self.parameters(lookups, surface, width_m, dither);
        Bsdf::new(&lookups.lobes, surface.wo, surface.geometric, normal, &p)
    }

    /// Base colour at a point as sharp as its texture has it, before weather; where patches or directions are mixed, of one
    /// of them.
    pub fn base_color(&self, lookups: &Lookups, surface: &Surface) -> Vec3 {
        self.colored(lookups, surface, &self.spot(lookups, surface, 0.0, 0.5))
    }

    /// Share of light that goes straight through, at an angle with cosine `cos` to the normal, where it is a pane.
    #[inline]
    pub fn straight_through(&self, lobes: &Lobes, cos: f32) -> Vec3 {
        let split = lobes.split(cos.abs(), alpha(self.roughness));
        let reflected = reflected(Vec3::splat(self.pane_f0()), split).x;
        self.base_color * ((1.0 - reflected) * self.transmission * (1.0 - self.metalness))
    }

    /// Normal reflectance; a pane reflects at both of its faces, back and forth (the sum of that series).
    #[inline]
    pub fn pane_f0(&self) -> f32 {
        self.f0 + self.transmission * (2.0 * self.f0 / (1.0 + self.f0) - self.f0)
    }

    fn tiling(&self) -> Tiling {
        Tiling { scale: self.scale, is_triplanar: self.is_triplanar, is_stochastic: self.is_stochastic }
    }

    /// Where on its textures lies what is seen at a point.
    #[inline(always)]
    fn spot(&self, lookups: &Lookups, surface: &Surface, width_m: f32, dither: f32) -> Spot {
        let spot = texturing::laid(self.tiling(), surface, width_m, dither);
        match self.height_map.texture() {
            Some(heights) => Spot { uv: spot.uv + self.shift(lookups, heights, surface, &spot, width_m), ..spot },
            None => spot,
        }
    }

    #[inline(always)]
    fn colored(&self, lookups: &Lookups, surface: &Surface, spot: &Spot) -> Vec3 {
        let color = look_up(&self.base_color_map, lookups, spot).map_or(Vec3::ONE, Vec4::truncate);
        (self.base_color * color * surface.tint).clamp(Vec3::ZERO, Vec3::ONE)
    }

    /// The shading normal turned by the relief, and the variance of the slopes that are too small to be seen.
    #[inline(always)]
    fn bumped(&self, lookups: &Lookups, surface: &Surface, spot: &Spot) -> (Vec3, f32) {
        let Some(axes) = spot.axes else { return (surface.shading, 0.0) };
        if let Some(texel) = look_up(&self.normal_map, lookups, spot) {
            // A mean of unit vectors is shorter than 1 by the mean of both slopes' variances.
            (turned(surface, axes, texel.truncate() * 2.0 - 1.0), texel.w * texel.w)
        } else if let Some(map) = self.height_map.texture() {
            let texel = map.sample(lookups, spot.uv, spot.footprint, spot.dither);
            let gain = self.height_m * map.sides() / spot.metres;
            let slope = (texel.truncate().truncate() * 2.0 - 1.0) * gain;
            (turned(surface, axes, (-slope).extend(1.0)), (texel.w * gain).length_squared() / 2.0)
        } else {
            (surface.shading, 0.0)
        }
    }

    /// The normal of one flake where a sample is small enough to see one; the others become roughness.
    #[inline(always)]
    fn flaked(&self, surface: &Surface, width_m: f32, normal: Vec3, p: &mut Parameters) -> Vec3 {
        /// Of numbers spread uniformly from 0 to 1, one over their standard deviation.
        const ROOT_12: f32 = 3.464_101_6;
        p.metalness += (FLAKES_METALNESS - p.metalness).max(0.0) * self.flakes;
        let seen = FLAKE_M / (FLAKE_M + width_m);
        p.alpha = rougher(p.alpha, self.flakes * FLAKE_SLOPE * FLAKE_SLOPE * (1.0 - seen * seen));
        // Uniform in a cube of standard deviation 1.
        let cell = (surface.point_mesh / FLAKE_M).map(floor).as_ivec3();
        let tilt = (texturing::random3(cell) - 0.5) * ROOT_12;
        unit_or(normal + tilt * (sqrt(self.flakes) * FLAKE_SLOPE * seen), normal)
    }
}

#[inline(always)]
fn look_up(map: &impl Map, lookups: &Lookups, spot: &Spot) -> Option<Vec4> {
    let sample = |texture: Texture<'_>| texture.sample(lookups, spot.uv, spot.footprint, spot.dither);
    map.texture().map(sample)
}

/// GGX α of a perceptual roughness.
#[inline]
pub fn alpha(roughness: f32) -> f32 {
    (roughness * roughness).max(ggx::ALPHA_MIN)
}

/// GGX α of facets on slopes that vary themselves (variances add up; α² is twice that of each slope).
#[inline(always)]
fn rougher(alpha: f32, variance: f32) -> f32 {
    sqrt(alpha * alpha + 2.0 * variance).min(1.0)
}

/// The shading normal turned by a tangent-space normal.
#[inline(always)]
fn turned(surface: &Surface, [along_u, along_v]: [Vec3; 2], texel: Vec3) -> Vec3 {
    let side = if surface.is_front { 1.0 } else { -1.0 };
    let normal = surface.shading * side;
    let tangent = unit_or(along_u - normal * normal.dot(along_u), Vec3::ZERO);
    let bitangent = normal.cross(tangent);
    let bitangent = if bitangent.dot(along_v) < 0.0 { -bitangent } else { bitangent };
    let turned = tangent * texel.x + bitangent * texel.y + normal * texel.z.max(1e-3);
    unit_or(turned, normal) * side
}

//! How light leaves a surface.

mod field;
mod opacity;
mod parallax;
mod snow;
mod texturing;
mod water;
mod weather;

use std::sync::{Arc, LazyLock};

use glam::{Vec2, Vec3};
use trove_model::{Beam, Mapping, Material};
use trove_trace::{Bsdf, Coat, Lobes, Parameters, Vertex, ggx};

use crate::surface::Surface;
use crate::texture::{Glow, MipMap, Textures};
use opacity::Pane;
use parallax::Heights;
use texturing::{Spot, Texturing};
use weather::Weather;

pub(crate) use opacity::Opacity;
pub(crate) use snow::holds as holds_snow;

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

/// What lobes reflect in all.
pub(crate) static LOBES: LazyLock<Lobes> = LazyLock::new(Lobes::new);

/// A material with its textures filtered.
pub(crate) struct PreparedMaterial {
    base_color: Vec3,
    base_color_map: Option<Arc<MipMap>>,
    roughness: f32,
    metalness: f32,
    orm_map: Option<Arc<MipMap>>,
    /// Without it the heights tell where a surface faces.
    normal_map: Option<Arc<MipMap>>,
    heights: Option<Heights>,
    /// Normal reflectance of the dielectric.
    f0: f32,
    coat: f32,
    flakes: f32,
    sheen: f32,
    subsurface: f32,
    transmission: f32,
    translucency: f32,
    retroreflection: f32,
    emission: Vec3,
    /// What it is multiplied by where.
    glow: Option<Glow>,
    beam: Option<Arc<Beam>>,
    texturing: Texturing,
    weather: Weather,
}

impl PreparedMaterial {
    /// What of it scatters light and what of it lets rays pass; numbers outside their range are brought into it.
    ///
    /// Takes the material apart whole: a new field does not compile until something is made of it.
    pub(crate) fn new(material: &Material, textures: &Textures) -> (Self, Opacity) {
        let Material {
            // For people.
            name: _,
            base_color,
            base_color_map,
            alpha_cutoff,
            roughness,
            metalness,
            orm_map,
            normal_map,
            height_map,
            height_m,
            ior,
            coat,
            flakes,
            sheen,
            subsurface,
            transmission,
            translucency,
            retroreflection,
            emission,
            emission_map,
            beam,
            dirt,
            wetness,
            uv_scale,
            mapping,
            tiling,
            // For whoever builds scenes.
            role: _,
        } = material;
        let ior = ior.max(1.0);
        let share = |x: &f32| x.clamp(0.0, 1.0);
        let glow = emission_map.as_ref().map(|t| Glow::new(textures.map(t), *uv_scale));
        // Light is drawn from triangles by where it is on them, which directions in the World do not tell.
        let (glow, evenly) = match mapping {
            Mapping::Uv => (glow, Vec3::ONE),
            Mapping::Triplanar => (None, glow.map_or(Vec3::ONE, |glow| glow.mean())),
        };
        let prepared = Self {
            base_color: base_color.clamp(Vec3::ZERO, Vec3::ONE),
            base_color_map: base_color_map.as_ref().map(|t| textures.map(t)),
            roughness: share(roughness),
            metalness: share(metalness),
            orm_map: orm_map.as_ref().map(|t| textures.map(t)),
            normal_map: normal_map.as_ref().map(|t| textures.normals(t)),
            heights: height_map.as_ref().map(|t| Heights::new(textures.heights(t), *height_m)),
            f0: ((ior - 1.0) / (ior + 1.0)).powi(2),
            coat: share(coat),
            flakes: share(flakes),
            sheen: share(sheen),
            subsurface: share(subsurface),
            transmission: share(transmission),
            translucency: share(translucency),
            retroreflection: share(retroreflection),
            emission: emission.max(Vec3::ZERO) * evenly,
            glow,
            beam: beam.clone(),
            texturing: Texturing { scale: *uv_scale, mapping: *mapping, tiling: *tiling },
            weather: Weather { dirt: share(dirt), wetness: share(wetness) },
        };
        let cut_out = base_color_map.as_ref().filter(|_| *alpha_cutoff > 0.0);
        let opacity = Opacity {
            holes: cut_out.map(|t| (textures.mask(t, *alpha_cutoff), *uv_scale)),
            pane: (prepared.transmission > 0.0).then(|| Pane {
                tint: prepared.base_color,
                transmission: prepared.transmission,
                metalness: prepared.metalness,
                f0: prepared.pane_f0(),
                alpha: alpha(prepared.roughness),
            }),
        };
        (prepared, opacity)
    }

    /// Whether light that comes from behind is scattered to the front.
    pub(crate) fn is_translucent(&self) -> bool {
        self.translucency > 0.0
    }

    /// Radiance that it emits from its front at a texture coordinate into a direction of the mesh.
    pub(crate) fn emitted(&self, uv: Vec2, direction_mesh: impl FnOnce() -> Vec3) -> Vec3 {
        if self.emission == Vec3::ZERO {
            return Vec3::ZERO;
        }
        let here = self.glow.as_ref().map_or(Vec3::ONE, |glow| glow.at(uv));
        self.emission * here * self.beam.as_ref().map_or(1.0, |beam| beam.share(direction_mesh()))
    }

    /// Its emission where that is the same everywhere, and what it is multiplied by where.
    pub(crate) fn emission(&self) -> (Vec3, Option<Glow>) {
        (self.emission, self.glow.clone())
    }

    /// Whether rain may have wetted it.
    pub(crate) fn is_wet(&self) -> bool {
        self.weather.wetness > 0.0
    }

    /// How much of a sensor's own light goes straight back to it, 0 to 1.
    pub(crate) fn retroreflection(&self) -> f32 {
        self.retroreflection
    }

    /// Whether it is more metal than not at a point: bare, or below paint full of flakes.
    pub(crate) fn is_metal(&self, surface: &Surface) -> bool {
        self.parameters(surface, 0.0, 0.5).0.metalness > 0.5
    }

    /// How it scatters light at a point; `width_m` is the width of what one sample covers there,
    /// `dither` a random number in [0, 1).
    pub(crate) fn shade(&self, surface: &Surface, width_m: f32, dither: f32) -> Bsdf {
        let (p, normal) = self.parameters(surface, width_m, dither);
        Bsdf::new(&LOBES, surface.wo, surface.geometric, normal, &p)
    }

    /// The same as plain numbers, with what a path asks there.
    pub(crate) fn vertex(&self, surface: &Surface, width_m: f32, to_light: Vec3, u: [f32; 3]) -> Vertex {
        let (parameters, normal) = self.parameters(surface, width_m, 0.5);
        Vertex { wo: surface.wo, geometric: surface.geometric, normal, to_light, u, parameters }
    }

    /// The share of light that it scatters diffusely, and its perceptual roughness, at a point: as sharp as its textures
    /// have it, dirt and water included.
    pub(crate) fn look(&self, surface: &Surface) -> (Vec3, f32) {
        let (p, _) = self.parameters(surface, 0.0, 0.5);
        (p.base_color * ((1.0 - p.metalness) * (1.0 - p.transmission)), p.alpha.sqrt())
    }

    /// What its lobes are made from at a point, and the shading normal.
    fn parameters(&self, surface: &Surface, width_m: f32, dither: f32) -> (Parameters, Vec3) {
        let spot = self.spot(surface, width_m, dither);
        let look_up = |map: &Arc<MipMap>| map.sample(spot.uv, spot.footprint, spot.dither);
        let orm = self.orm_map.as_ref().map_or(Vec3::ONE, |map| look_up(map).truncate());
        let (normal, variance) = self.bumped(surface, &spot);

        let base_color = self.colored(surface, &spot);
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
        if surface.exposure.snow > 0.0 {
            normal = snow::lie(surface, width_m, normal, &mut p);
        }
        (p, normal)
    }

    /// Base colour at a point as sharp as its texture has it, before weather; where patches or directions are mixed, of one
    /// of them.
    pub(crate) fn base_color(&self, surface: &Surface) -> Vec3 {
        self.colored(surface, &self.spot(surface, 0.0, 0.5))
    }

    /// Where on its textures lies what is seen at a point.
    fn spot(&self, surface: &Surface, width_m: f32, dither: f32) -> Spot {
        let spot = self.texturing.spot(surface, width_m, dither);
        let shift = self.heights.as_ref().map_or(Vec2::ZERO, |heights| heights.shift(surface, &spot, width_m));
        Spot { uv: spot.uv + shift, ..spot }
    }

    fn colored(&self, surface: &Surface, spot: &Spot) -> Vec3 {
        let texel = |map: &Arc<MipMap>| map.sample(spot.uv, spot.footprint, spot.dither).truncate();
        let color = self.base_color_map.as_ref().map_or(Vec3::ONE, texel);
        (self.base_color * color * surface.tint).clamp(Vec3::ZERO, Vec3::ONE)
    }

    /// The shading normal turned by the relief, and the variance of the slopes that are too small to be seen.
    fn bumped(&self, surface: &Surface, spot: &Spot) -> (Vec3, f32) {
        let Some(axes) = spot.axes else { return (surface.shading, 0.0) };
        if let Some(map) = &self.normal_map {
            let texel = map.sample(spot.uv, spot.footprint, spot.dither);
            // A mean of unit vectors is shorter than 1 by the mean of both slopes' variances.
            (turned(surface, axes, texel.truncate() * 2.0 - 1.0), texel.w * texel.w)
        } else if let Some(Heights { map, range_m, .. }) = &self.heights {
            let texel = map.sample(spot.uv, spot.footprint, spot.dither);
            let gain = *range_m * map.size() / spot.metres;
            let slope = (texel.truncate().truncate() * 2.0 - 1.0) * gain;
            (turned(surface, axes, (-slope).extend(1.0)), (texel.w * gain).length_squared() / 2.0)
        } else {
            (surface.shading, 0.0)
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

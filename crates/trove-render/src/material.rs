//! How light leaves a surface: materials of scenes with their textures filtered.

mod opacity;

use glam::Vec3;
use trove_model::{Mapping, Material, Role, Tiling};
use trove_trace::{Bsdf, NONE, Parameters, Surface, alpha};

use crate::light::{Beams, Shines};
use crate::lookups::LOOKUPS;
use crate::texture::{Glow, MapOf, Textures};
use opacity::Pane;

pub(crate) use opacity::Opacity;

/// A material with its textures filtered.
pub(crate) struct PreparedMaterial {
    pub(crate) scatters: trove_trace::Material<MapOf>,
    retroreflection: f32,
    /// What it is for.
    pub(crate) role: Option<Role>,
}

impl PreparedMaterial {
    /// What of it scatters light and what of it lets rays pass; numbers outside their range are brought into it.
    ///
    /// Takes the material apart whole: a new field does not compile until something is made of it.
    pub(crate) fn new(material: &Material, textures: &Textures, beams: &mut Beams) -> (Self, Opacity) {
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
            role,
        } = material;
        let ior = ior.max(1.0);
        let share = |x: &f32| x.clamp(0.0, 1.0);
        let glow = emission_map.as_ref().map(|t| Glow { map: textures.map(t), scale: *uv_scale });
        // Light is drawn from triangles by where it is on them, which directions in the World do not tell.
        let (glow, evenly) = match mapping {
            Mapping::Uv => (glow, Vec3::ONE),
            Mapping::Triplanar => (None, glow.map_or(Vec3::ONE, |glow| glow.mean())),
        };
        let heights = height_map.as_ref().map(|t| textures.heights(t));
        let scatters = trove_trace::Material {
            base_color: base_color.clamp(Vec3::ZERO, Vec3::ONE),
            roughness: share(roughness),
            metalness: share(metalness),
            f0: ((ior - 1.0) / (ior + 1.0)).powi(2),
            coat: share(coat),
            flakes: share(flakes),
            sheen: share(sheen),
            subsurface: share(subsurface),
            transmission: share(transmission),
            translucency: share(translucency),
            dirt: share(dirt),
            wetness: share(wetness),
            height_m: *height_m,
            height_of_mesh: heights.as_ref().map_or(0.0, |map| 1.0 - map.mean().z),
            emission: emission.max(Vec3::ZERO) * evenly,
            beam: beam.as_ref().map_or(NONE, |beam| beams.index(beam)),
            scale: *uv_scale,
            base_color_map: MapOf(base_color_map.as_ref().map(|t| textures.map(t))),
            orm_map: MapOf(orm_map.as_ref().map(|t| textures.map(t))),
            normal_map: MapOf(normal_map.as_ref().map(|t| textures.normals(t))),
            height_map: MapOf(heights),
            emission_map: MapOf(glow.map(|glow| glow.map)),
            is_triplanar: *mapping == Mapping::Triplanar,
            is_stochastic: *tiling == Tiling::Stochastic,
        };
        let cut_out = base_color_map.as_ref().filter(|_| *alpha_cutoff > 0.0);
        let opacity = Opacity {
            holes: cut_out.map(|t| (textures.mask(t, *alpha_cutoff), *uv_scale)),
            pane: (scatters.transmission > 0.0).then(|| Pane {
                tint: scatters.base_color,
                transmission: scatters.transmission,
                metalness: scatters.metalness,
                f0: scatters.pane_f0(),
                alpha: alpha(scatters.roughness),
            }),
        };
        (Self { scatters, retroreflection: share(retroreflection), role: *role }, opacity)
    }

    /// Whether light that comes from behind is scattered to the front.
    pub(crate) fn is_translucent(&self) -> bool {
        self.scatters.translucency > 0.0
    }

    /// How it shines.
    pub(crate) fn shines(&self) -> Shines {
        let trove_trace::Material { emission, beam, scale, emission_map, .. } = &self.scatters;
        let glow = emission_map.0.as_ref().map(|map| Glow { map: map.clone(), scale: *scale });
        Shines { radiance: *emission, glow, beam: *beam }
    }

    /// Whether rain may have wetted it.
    pub(crate) fn is_wet(&self) -> bool {
        self.scatters.wetness > 0.0
    }

    /// How much of a sensor's own light goes straight back to it, 0 to 1.
    pub(crate) fn retroreflection(&self) -> f32 {
        self.retroreflection
    }

    /// Whether it is more metal than not at a point: bare, or below paint full of flakes.
    pub(crate) fn is_metal(&self, surface: &Surface) -> bool {
        self.sharp(surface).metalness > 0.5
    }

    /// How it scatters light at a point; `width_m` is the width of what one sample covers there,
    /// `dither` a random number in [0, 1).
    pub(crate) fn shade(&self, surface: &Surface, width_m: f32, dither: f32) -> Bsdf {
        self.scatters.shade(&LOOKUPS, surface, width_m, dither)
    }

    /// The share of light that it scatters diffusely, and its perceptual roughness, at a point: as sharp as its textures
    /// have it, dirt and water included.
    pub(crate) fn look(&self, surface: &Surface) -> (Vec3, f32) {
        let p = self.sharp(surface);
        (p.base_color * ((1.0 - p.metalness) * (1.0 - p.transmission)), p.alpha.sqrt())
    }

    /// Base colour at a point as sharp as its texture has it, before weather; where patches or directions are mixed, of one
    /// of them.
    pub(crate) fn base_color(&self, surface: &Surface) -> Vec3 {
        self.scatters.base_color(&LOOKUPS, surface)
    }

    fn sharp(&self, surface: &Surface) -> Parameters {
        self.scatters.parameters(&LOOKUPS, surface, 0.0, 0.5).0
    }
}

//! All lights of a scene: the sun, and the rest of them, which are the sky and the emitters.
//!
//! The sun is sampled for itself, since it casts the edges that noise shows on. The rest shares one sample, drawn with a
//! probability that is fixed for a scene.

use core::cell::OnceCell;

use glam::Vec3;

use super::beam::Beams;
use super::emitters::{EmitterPoint, Emitters};
use super::haze::Haze;
use super::sky::Sky;
use super::sun::Sun;
use super::tree::Cut;
use crate::lookups::Lookups;
use crate::math::{sqrt, unit};
use crate::surface::gap_m;
use crate::texture::Map;

/// Samples that are compared where lamps give most of the light: most of them fall on what gives little there.
const CANDIDATES: u32 = 4;

/// Light that would bring less than this share of what a white surface has in the open is asked for by chance: under a sky,
/// and where lamps give most of the light. The noise that it adds is as much as the time that it saves, or less.
const FAINT: f32 = 0.02;
const FAINT_OF_LAMPS: f32 = 0.1;

/// Haze has the colour of the sky so far above the horizon at least (sine), where the picture has no ground.
const ABOVE_GROUND: f32 = 0.02;

/// One way for light to reach a point.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct LightSample {
    /// Unit vector from the point to the light, World.
    pub wi: Vec3,
    /// Metres; infinite for the sky.
    pub distance: f32,
    /// Radiance that arrives if nothing is in the way.
    pub radiance: Vec3,
    /// Density over solid angle with which this direction is drawn, among the lights that were asked for.
    pub pdf: f32,
}

impl LightSample {
    /// How far a ray from a place goes towards it that must not meet the light itself, metres: both the ray's start and the
    /// light may be off.
    #[inline]
    pub fn reach(&self, from: Vec3) -> f32 {
        (self.distance * (1.0 - 1e-4) - 2.0 * gap_m(from)).max(0.0)
    }
}

/// The sun, and the rest.
pub struct Lights<'a, T> {
    /// What emitters with maps are looked up with.
    pub lookups: &'a Lookups,
    /// `None` where no sun shines.
    pub sun: Option<Sun>,
    /// `None` where nothing is known of the air.
    pub haze: Option<Haze>,
    /// Without the sun's disk.
    pub sky: Sky<'a>,
    /// Into which directions lamps shine.
    pub beams: Beams<'a>,
    /// `None` where nothing shines.
    pub emitters: Option<Emitters<'a, T>>,
    /// Probability that a sample of the rest is one of an emitter.
    pub emitter_share: f32,
    /// Radiance of a white level surface in the open, roughly: what is dark and what is bright in this light.
    pub scale: f32,
}

impl<T: Map> Lights<'_, T> {
    /// A direction to the sun's disk; `None` where no sun shines.
    #[inline]
    pub fn sample_sun(&self, u: [f32; 2]) -> Option<LightSample> {
        let sun = self.sun.as_ref()?;
        let wi = sun.draw(u);
        let pdf = sun.pdf(wi);
        (pdf > 0.0).then(|| LightSample { wi, distance: f32::INFINITY, radiance: sun.radiance(wi), pdf })
    }

    /// Density over solid angle with which [`Self::sample_sun`] draws a direction.
    #[inline]
    pub fn sun_pdf(&self, direction: Vec3) -> f32 {
        self.sun.as_ref().map_or(0.0, |sun| sun.pdf(direction))
    }

    /// Radiance of the sun's disk; 0 beside it.
    #[inline]
    pub fn sun_radiance(&self, direction: Vec3) -> Vec3 {
        self.sun.as_ref().map_or(Vec3::ZERO, |sun| sun.radiance(direction))
    }

    /// The sky and the emitters, to draw from for a surface at `point` that is lit from the side of `normal`; from both
    /// sides if it is 0.
    #[inline]
    pub fn rest(&self, point: Vec3, normal: Vec3) -> Rest<'_, T> {
        Rest { lights: self, point, normal, cut: OnceCell::new() }
    }

    /// How many samples of the rest are compared before one of them is asked for: one by day, since the sky is drawn well.
    #[inline]
    pub fn candidates(&self) -> u32 {
        if self.are_mostly_lamps() { CANDIDATES } else { 1 }
    }

    /// Share of [`Self::scale`] below which light is asked for by chance.
    #[inline]
    pub fn faint(&self) -> f32 {
        if self.are_mostly_lamps() { FAINT_OF_LAMPS } else { FAINT }
    }

    #[inline(always)]
    fn are_mostly_lamps(&self) -> bool {
        self.emitter_share > 0.5
    }

    /// Density over solid angle with which [`Rest::draw`], given that normal, draws a direction of the sky.
    #[inline]
    pub fn pdf_rest(&self, normal: Vec3, direction: Vec3) -> f32 {
        (1.0 - self.emitter_share) * self.sky.cells.pdf(normal, direction)
    }

    /// Density over solid angle with which [`Rest::draw`], given that point and normal, draws the point `on_light` of an
    /// emitting triangle of an instance; 0 where the triangle is never drawn.
    #[inline]
    pub fn pdf_rest_emitter(&self, key: [u32; 2], point: Vec3, normal: Vec3, on_light: Vec3) -> f32 {
        let pdf = self.emitters.as_ref().map_or(0.0, |e| e.pdf(key, point, normal, on_light));
        self.emitter_share * pdf
    }

    /// What haze leaves of light that comes `distance_m` metres against a direction, and the light that it sends besides;
    /// `None` where nothing is known of the air.
    #[inline]
    pub fn haze(&self, direction: Vec3, distance_m: f32) -> Option<(Vec3, Vec3)> {
        let passes = self.haze?.transmittance(distance_m);
        let sky = self.sky.radiance(unit(direction.with_z(direction.z.max(ABOVE_GROUND))), 0.0);
        Some((passes, sky * (1.0 - passes)))
    }
}

/// The sky and the emitters, as they shine on a surface.
pub struct Rest<'a, T> {
    lights: &'a Lights<'a, T>,
    point: Vec3,
    normal: Vec3,
    cut: OnceCell<Cut>,
}

impl<T: Map> Rest<'_, T> {
    /// Where they are drawn for.
    #[inline]
    pub fn point(&self) -> Vec3 {
        self.point
    }

    /// Draws the sky or an emitter (first number) and a direction to it (the other two).
    #[inline]
    pub fn draw(&self, u: [f32; 3]) -> Option<LightSample> {
        let Lights { lookups, emitters, emitter_share: share, sky, .. } = self.lights;
        if let Some(emitters) = emitters.as_ref().filter(|_| u[0] < *share) {
            let cut = self.cut.get_or_init(|| emitters.tree.cut(self.point, self.normal));
            return self.toward(emitters.draw(lookups, cut, self.point, self.normal, [u[0] / share, u[1], u[2]])?);
        }
        let (wi, radiance, pdf) = sky.cells.draw(self.normal, [u[1], u[2]])?;
        let pdf = pdf * (1.0 - share);
        (pdf > 0.0).then_some(LightSample { wi, distance: f32::INFINITY, radiance, pdf })
    }

    #[inline(always)]
    fn toward(&self, drawn: EmitterPoint) -> Option<LightSample> {
        let to_light = drawn.point - self.point;
        let distance = sqrt(to_light.length_squared());
        let pdf = self.lights.emitter_share * drawn.pdf;
        // Seen edge-on, or from the point itself, it gives nothing.
        (distance > 0.0 && pdf.is_finite() && pdf > 0.0).then(|| LightSample {
            wi: to_light / distance,
            distance,
            radiance: drawn.radiance,
            pdf,
        })
    }
}

//! Where light comes from: sky, sun, environment map, emitters.
//!
//! One light sample chooses between the sun, the rest of the environment, and the emitters, with probabilities that are
//! fixed for a scene (see [`Shares`]). Directions to sun and environment share one density, so that a direction on the
//! sun's disk counts both; a point on an emitter has its own.

mod cdf;
mod clouds;
mod dome;
mod emitters;
mod noise;
mod sky;
mod sun;

use glam::Vec3;
use trove_model::{Environment, Scene};

use dome::Dome;
use emitters::Emitters;
use sun::Sun;

/// One way for light to reach a point.
pub(crate) struct LightSample {
    /// Unit vector from the point to the light, World.
    pub(crate) wi: Vec3,
    /// Metres; infinite for the sky.
    pub(crate) distance: f32,
    /// Radiance that arrives if nothing is in the way.
    pub(crate) radiance: Vec3,
    /// Density over solid angle with which this direction is drawn, over all lights.
    pub(crate) pdf: f32,
}

/// Probabilities of choosing each sort of light; they add up to 1.
struct Shares {
    sun: f32,
    dome: f32,
    emitters: f32,
}

impl Shares {
    /// The sun casts the edges that noise shows on, and gives most of the light: half. By day lamps add little, and by
    /// night nearly everything.
    fn new(sun: bool, emitters: bool) -> Self {
        let (sun, dome, emitters) = match (sun, emitters) {
            (true, false) => (0.5, 0.5, 0.0),
            (true, true) => (0.45, 0.4, 0.15),
            (false, true) => (0.0, 0.4, 0.6),
            (false, false) => (0.0, 1.0, 0.0),
        };
        Self { sun, dome, emitters }
    }
}

/// All lights of a scene.
pub(crate) struct Lights {
    dome: Dome,
    sun: Option<Sun>,
    emitters: Option<Emitters>,
    shares: Shares,
}

impl Lights {
    pub(crate) fn new(scene: &Scene) -> Self {
        let (dome, sun) = match &scene.light.environment {
            Environment::Map(map) => (Dome::new(map.as_ref().clone(), 1, 1.0), None),
            Environment::Sky(parameters) => {
                let baked = sky::bake(parameters);
                (Dome::new(baked.map, sky::CELL, sky::SHARE_BELOW), Sun::new(baked.to_sun, baked.sun_irradiance))
            }
        };
        let emitters = Emitters::new(scene);
        let shares = Shares::new(sun.is_some(), emitters.is_some());
        Self { dome, sun, emitters, shares }
    }

    /// Draws a light (first number) and a direction to it (the other two).
    pub(crate) fn sample(&self, point: Vec3, u: [f32; 3]) -> Option<LightSample> {
        let within = [u[1], u[2]];
        let wi = match (&self.sun, &self.emitters) {
            (Some(sun), _) if u[0] < self.shares.sun => sun.draw(within),
            (_, Some(emitters)) if u[0] >= self.shares.sun + self.shares.dome => {
                return self.sample_emitter(emitters, point, within);
            }
            _ => self.dome.draw(within),
        };
        let pdf = self.pdf(wi);
        (pdf > 0.0).then(|| LightSample { wi, distance: f32::INFINITY, radiance: self.radiance(wi), pdf })
    }

    fn sample_emitter(&self, emitters: &Emitters, point: Vec3, u: [f32; 2]) -> Option<LightSample> {
        let drawn = emitters.draw(u);
        let to_light = drawn.point - point;
        let distance = to_light.length();
        let pdf = self.shares.emitters * emitters.pdf(&drawn, point);
        // Seen edge-on, or from the point itself, it gives nothing.
        (distance > 0.0 && pdf.is_finite() && pdf > 0.0).then(|| LightSample {
            wi: to_light / distance,
            distance,
            radiance: drawn.radiance,
            pdf,
        })
    }

    /// Radiance of the environment with the sun's disk in it.
    pub(crate) fn radiance(&self, direction: Vec3) -> Vec3 {
        self.dome.radiance(direction) + self.sun.as_ref().map_or(Vec3::ZERO, |sun| sun.radiance(direction))
    }

    /// Density over solid angle with which [`Self::sample`] draws a direction of the environment.
    pub(crate) fn pdf(&self, direction: Vec3) -> f32 {
        let sun = self.sun.as_ref().map_or(0.0, |sun| sun.pdf(direction));
        self.shares.sun * sun + self.shares.dome * self.dome.pdf(direction)
    }

    /// Density over solid angle, seen from `point`, with which [`Self::sample`] draws the point `on_light` of an
    /// emitting triangle; 0 where the triangle is never drawn.
    pub(crate) fn emitter_pdf(&self, instance: u32, triangle: u32, point: Vec3, on_light: Vec3) -> f32 {
        let pdf = self.emitters.as_ref().map_or(0.0, |e| e.pdf_of(instance, triangle, point, on_light));
        self.shares.emitters * pdf
    }
}

/// Brightness of a colour (Rec. 709).
fn luminance(rgb: Vec3) -> f32 {
    rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

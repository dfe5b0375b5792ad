//! Where light comes from: sky, sun, environment map, emitters.

use glam::Vec3;
use trove_model::Scene;

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

/// All lights of a scene.
pub(crate) struct Lights;

impl Lights {
    pub(crate) fn new(_scene: &Scene) -> Self {
        Self
    }

    /// Draws a light (first number) and a direction to it (the other two).
    pub(crate) fn sample(&self, _point: Vec3, u: [f32; 3]) -> Option<LightSample> {
        let z = 1.0 - 2.0 * u[1];
        let (sin, cos) = (std::f32::consts::TAU * u[2]).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        let wi = Vec3::new(r * cos, r * sin, z);
        Some(LightSample { wi, distance: f32::INFINITY, radiance: self.radiance(wi), pdf: self.pdf(wi) })
    }

    /// Radiance of the environment with the sun's disk in it.
    pub(crate) fn radiance(&self, direction: Vec3) -> Vec3 {
        Vec3::splat(0.3 + 0.2 * direction.z)
    }

    /// Density over solid angle with which [`Self::sample`] draws a direction of the environment.
    pub(crate) fn pdf(&self, _direction: Vec3) -> f32 {
        1.0 / (4.0 * std::f32::consts::PI)
    }

    /// Density over solid angle, seen from `point`, with which [`Self::sample`] draws the point `on_light` of an
    /// emitting triangle; 0 where the triangle is never drawn.
    pub(crate) fn emitter_pdf(&self, _instance: u32, _triangle: u32, _point: Vec3, _on_light: Vec3) -> f32 {
        0.0
    }
}

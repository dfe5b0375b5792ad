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

use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec3;
use trove_model::{Environment, Scene};

use dome::Dome;
use emitters::Emitters;
use sun::Sun;

/// From this width on a cone is many times as wide as a cell of the sky.
pub(crate) const WIDE_RAD: f32 = 0.1;

/// One way for light to reach a point.
pub(crate) struct LightSample {
    /// Unit vector from the point to the light, World.
    pub(crate) wi: Vec3,
    /// Metres; infinite for the sky.
    pub(crate) distance: f32,
    /// Radiance that arrives if nothing is in the way; `None`: [`Lights::radiance`] of that direction, which is worth
    /// asking for only when nothing is in the way.
    pub(crate) radiance: Option<Vec3>,
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

/// Everything infinitely far away.
struct Surroundings {
    dome: Dome,
    sun: Option<Sun>,
}

impl Surroundings {
    fn new(environment: &Environment) -> Self {
        match environment {
            Environment::Map(map) => Self { dome: Dome::new(map.as_ref().clone(), 1, 1.0), sun: None },
            Environment::Sky(parameters) => {
                let sky = sky::bake(parameters);
                let dome = Dome::new(sky.map, sky::CELL, sky::SHARE_BELOW);
                Self { dome, sun: Sun::new(sky.to_sun, sky.sun_irradiance) }
            }
        }
    }
}

/// The last scene's surroundings, which the next keyframe mostly shares.
#[derive(Default)]
pub(crate) struct LastSurroundings {
    last: Mutex<Option<(Environment, Arc<Surroundings>)>>,
}

impl LastSurroundings {
    fn get(&self, environment: &Environment) -> Arc<Surroundings> {
        let lock = || self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, made)) = lock().as_ref().filter(|(of, _)| is_same(of, environment)) {
            return made.clone();
        }
        // Not under the lock: threads of the pool that help with it may come here too.
        let made = Arc::new(Surroundings::new(environment));
        *lock() = Some((environment.clone(), made.clone()));
        made
    }
}

fn is_same(a: &Environment, b: &Environment) -> bool {
    match (a, b) {
        (Environment::Sky(a), Environment::Sky(b)) => a == b,
        (Environment::Map(a), Environment::Map(b)) => Arc::ptr_eq(a, b),
        _ => false,
    }
}

/// All lights of a scene.
pub(crate) struct Lights {
    around: Arc<Surroundings>,
    emitters: Option<Emitters>,
    shares: Shares,
}

impl Lights {
    pub(crate) fn new(scene: &Scene, last: &LastSurroundings) -> Self {
        let around = last.get(&scene.light.environment);
        let emitters = Emitters::new(scene);
        let shares = Shares::new(around.sun.is_some(), emitters.is_some());
        Self { around, emitters, shares }
    }

    /// Draws a light (first number) and a direction to it (the other two).
    pub(crate) fn sample(&self, point: Vec3, u: [f32; 3]) -> Option<LightSample> {
        let within = [u[1], u[2]];
        let wi = match (&self.around.sun, &self.emitters) {
            (Some(sun), _) if u[0] < self.shares.sun => sun.draw(within),
            (_, Some(emitters)) if u[0] >= self.shares.sun + self.shares.dome => {
                return self.sample_emitter(emitters, point, within);
            }
            _ => self.around.dome.draw(within),
        };
        let pdf = self.pdf(wi);
        (pdf > 0.0).then_some(LightSample { wi, distance: f32::INFINITY, radiance: None, pdf })
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
            radiance: Some(drawn.radiance),
            pdf,
        })
    }

    /// Radiance of the environment with the sun's disk in it, for a ray that stands for a cone of `spread_rad`: a wide
    /// one does not need the sky's details, whose look-up waits for memory.
    pub(crate) fn radiance(&self, direction: Vec3, spread_rad: f32) -> Vec3 {
        let dome = &self.around.dome;
        let sky = if spread_rad < WIDE_RAD { dome.radiance(direction) } else { dome.radiance_coarse(direction) };
        sky + self.around.sun.as_ref().map_or(Vec3::ZERO, |sun| sun.radiance(direction))
    }

    /// Density over solid angle with which [`Self::sample`] draws a direction of the environment.
    pub(crate) fn pdf(&self, direction: Vec3) -> f32 {
        let sun = self.around.sun.as_ref().map_or(0.0, |sun| sun.pdf(direction));
        self.shares.sun * sun + self.shares.dome * self.around.dome.pdf(direction)
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

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use glam::{DAffine3, DVec3};
    use trove_model::{Class, Instance, InstanceId, Light, Material, Mesh, PhysicalSky, Seed};

    use super::*;

    /// A lamp of two triangles above the origin, under a sky.
    fn scene() -> Scene {
        let sky = PhysicalSky {
            to_sun: DVec3::new(0.3, -0.4, 0.8),
            turbidity: 3.0,
            ground_albedo: 0.2,
            cloud_cover: 0.0,
            cloud_seed: 4,
        };
        let lamp = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 2.0, 0.0), Vec3::new(0.0, 2.0, 0.0)],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        let at = DAffine3::from_translation(DVec3::new(0.5, 0.0, 1.5));
        let instance = Instance {
            id: InstanceId(0),
            class: Class::TrafficSign,
            mesh: 0,
            materials: vec![0],
            world_from_mesh: at,
            world_from_mesh_previous: Some(at),
            world_from_mesh_next: Some(at),
            object: None,
        };
        Scene {
            meshes: vec![Arc::new(lamp)],
            materials: vec![Material { emission: Vec3::splat(3.0), ..Material::default() }],
            instances: vec![instance],
            light: Light { environment: Environment::Sky(sky) },
            provenance: Vec::new(),
        }
    }

    #[test]
    fn light_samples_add_up_to_the_light_and_say_their_own_density() {
        let scene = scene();
        let lights = Lights::new(&scene, &LastSurroundings::default());
        let mut random = Seed(9).random();
        let mut unit = || random.unit() as f32;
        let (draws, mut from_far, mut from_lamp) = (60_000, 0.0, 0.0);
        for _ in 0..draws {
            let Some(sample) = lights.sample(Vec3::ZERO, [unit(), unit(), unit()]) else { continue };
            assert!(sample.wi.is_normalized());
            let radiance = sample.radiance.unwrap_or_else(|| lights.radiance(sample.wi, 0.0));
            let part = luminance(radiance) * sample.wi.z.max(0.0) / sample.pdf;
            if sample.distance.is_finite() {
                from_lamp += part;
                // Both triangles have the same area and power, and lie in one plane.
                let point = sample.wi * sample.distance;
                let pdf = lights.emitter_pdf(0, 1, Vec3::ZERO, point);
                assert!((point.z - 1.5).abs() < 1e-4 && (pdf / sample.pdf - 1.0).abs() < 1e-3);
            } else {
                from_far += part;
                assert!((lights.pdf(sample.wi) / sample.pdf - 1.0).abs() < 1e-6);
            }
        }
        // The same by a grid over the hemisphere for the sky, by the sun's own irradiance, and by a grid over the lamp.
        let Surroundings { dome, sun } = &*lights.around;
        let (mut sky, grid) = (0.0, 400);
        for i in 0..grid * grid {
            let (z, azimuth) = (((i / grid) as f32 + 0.5) / grid as f32, (i % grid) as f32 / grid as f32 * 2.0 * PI);
            let r = (1.0 - z * z).sqrt();
            sky += luminance(dome.radiance(Vec3::new(r * azimuth.cos(), r * azimuth.sin(), z))) * z * 2.0 * PI;
        }
        let sky = sky / (grid * grid) as f32;
        let to_sun = Vec3::new(0.3, -0.4, 0.8).normalize();
        let sun = luminance(sun.as_ref().unwrap().radiance(to_sun)) * 0.8 * PI * sun::RADIUS_RAD.powi(2) * to_sun.z;
        let far = from_far / draws as f32;
        assert!((far / (sky + sun) - 1.0).abs() < 0.02, "{far} instead of {sky} + {sun}");
        let mut lamp = 0.0;
        for i in 0..grid * grid {
            let (x, y) = (((i / grid) as f32 + 0.5) / grid as f32, ((i % grid) as f32 + 0.5) / grid as f32 * 2.0);
            let to = Vec3::new(0.5 + x, y, 1.5);
            lamp += 3.0 * to.z.powi(2) / to.length_squared().powi(2) * 2.0;
        }
        let (lamp, drawn) = (lamp / (grid * grid) as f32, from_lamp / draws as f32);
        assert!((drawn / lamp - 1.0).abs() < 0.03, "{drawn} instead of {lamp}");
    }

    #[test]
    fn a_scene_with_the_same_sky_does_not_bake_it_again() {
        let last = LastSurroundings::default();
        let mut scene = scene();
        let first = Lights::new(&scene, &last).around;
        assert!(Arc::ptr_eq(&first, &Lights::new(&scene, &last).around));
        if let Environment::Sky(sky) = &mut scene.light.environment {
            sky.cloud_seed += 1;
        }
        assert!(!Arc::ptr_eq(&first, &Lights::new(&scene, &last).around));
    }
}

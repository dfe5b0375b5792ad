//! Where light comes from: sky, sun, environment map, emitters.
//!
//! The sun is sampled for itself, since it casts the edges that noise shows on. The rest, which is the sky and the
//! emitters, shares one sample, drawn with a probability that is fixed for a scene.

mod cdf;
mod cells;
mod clouds;
mod dome;
mod emitters;
mod haze;
mod patches;
mod sky;
mod sun;
mod sun_in_map;
mod tree;

use std::cell::OnceCell;
use std::f32::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec3;
use trove_model::{Environment, Scene, luminance};
use trove_trace::gap_m;

use dome::{Dome, LookUp};
pub(crate) use emitters::{Emission, GetsAway, PROBES};
use emitters::{EmitterPoint, Emitters, Near};
use haze::Haze;
pub use sky::{BakedSky, bake_sky};
pub use sun::RADIUS_RAD as SUN_RADIUS_RAD;
use sun::Sun;
use sun_in_map::take_sun;

/// Cells on a side of a hemisphere's square: fine enough for clouds, and for the windows and lamps of a photograph.
const SKY_CELLS: usize = 64;
const MAP_CELLS: usize = 256;

/// Samples that are compared where lamps give most of the light: most of them fall on what gives little there.
const CANDIDATES: u32 = 4;

/// Light that would bring less than this share of what a white surface has in the open is asked for by chance: under a sky,
/// and where lamps give most of the light. The noise that it adds is as much as the time that it saves, or less.
const FAINT: f32 = 0.02;
const FAINT_OF_LAMPS: f32 = 0.1;

/// Haze has the colour of the sky so far above the horizon at least (sine), where the picture has no ground.
const ABOVE_GROUND: f32 = 0.02;

/// Draws of directions below the horizon, as a share of what their brightness asks for: the ground hides most of them.
const SHARE_BELOW: f64 = 0.05;

/// One way for light to reach a point.
pub(crate) struct LightSample {
    /// Unit vector from the point to the light, World.
    pub(crate) wi: Vec3,
    /// Metres; infinite for the sky.
    pub(crate) distance: f32,
    /// Radiance that arrives if nothing is in the way.
    pub(crate) radiance: Vec3,
    /// Density over solid angle with which this direction is drawn, among the lights that were asked for.
    pub(crate) pdf: f32,
}

impl LightSample {
    /// How far a ray from a place goes towards it that must not meet the light itself, metres: both the ray's start and the
    /// light may be off.
    pub(crate) fn reach(&self, from: Vec3) -> f32 {
        (self.distance * (1.0 - 1e-4) - 2.0 * gap_m(from)).max(0.0)
    }
}

/// Everything infinitely far away.
pub(crate) struct Surroundings {
    dome: Dome,
    sun: Option<Sun>,
    /// A photographed sky may end at houses, so it tells nothing of the air.
    haze: Option<Haze>,
}

impl Surroundings {
    fn new(environment: &Environment) -> Self {
        match environment {
            Environment::Map(map) => {
                let mut map = map.as_ref().clone();
                let sun = take_sun(&mut map).and_then(|sun| Sun::new(sun.to_sun, sun.irradiance));
                Self { dome: Dome::new(map, LookUp::Linear, MAP_CELLS, SHARE_BELOW), sun, haze: None }
            }
            Environment::Sky(parameters) => {
                let sky = sky::bake_sky(parameters);
                let dome = Dome::new(sky.map, LookUp::Smooth, SKY_CELLS, SHARE_BELOW);
                let sun = Sun::new(sky.to_sun, sky.sun_irradiance);
                Self { dome, sun, haze: Some(Haze::new(parameters.turbidity)) }
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
    pub(crate) fn get(&self, environment: &Environment) -> Arc<Surroundings> {
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

/// All lights of a scene: the sun, and the rest of them, which are the sky and the emitters.
pub(crate) struct Lights {
    around: Arc<Surroundings>,
    emitters: Option<Emitters>,
    /// Probability that a sample of the rest is one of an emitter.
    emitter_share: f32,
    scale: f32,
}

impl Lights {
    pub(crate) fn new(
        scene: &Scene,
        emission: &Emission<'_>,
        around: Arc<Surroundings>,
        gets_away: &GetsAway<'_>,
    ) -> Self {
        let emitters = Emitters::new(scene, emission, gets_away);
        let from_sky = luminance(around.dome.irradiance());
        let from_sun = around.sun.as_ref().map_or(0.0, |sun| luminance(sun.level_irradiance()));
        let from_emitters = emitters.as_ref().map_or(0.0, Emitters::typical_irradiance);
        // By day lamps add little, and by night nearly everything; neither is ever left out.
        let even = from_emitters / (from_emitters + from_sky).max(f32::MIN_POSITIVE);
        let emitter_share = if emitters.is_some() { even.clamp(0.1, 0.9) } else { 0.0 };
        let scale = (from_sky + from_sun + from_emitters) / PI;
        Self { around, emitters, emitter_share, scale: scale.max(f32::MIN_POSITIVE) }
    }

    /// Radiance of a white level surface in the open, roughly: what is dark and what is bright in this light.
    pub(crate) fn scale(&self) -> f32 {
        self.scale
    }

    /// A direction to the sun's disk; `None` where no sun shines.
    pub(crate) fn sample_sun(&self, u: [f32; 2]) -> Option<LightSample> {
        let sun = self.around.sun.as_ref()?;
        let wi = sun.draw(u);
        let pdf = sun.pdf(wi);
        (pdf > 0.0).then(|| LightSample { wi, distance: f32::INFINITY, radiance: sun.radiance(wi), pdf })
    }

    /// Density over solid angle with which [`Self::sample_sun`] draws a direction.
    pub(crate) fn sun_pdf(&self, direction: Vec3) -> f32 {
        self.around.sun.as_ref().map_or(0.0, |sun| sun.pdf(direction))
    }

    /// Radiance of the sun's disk; 0 beside it.
    pub(crate) fn sun_radiance(&self, direction: Vec3) -> Vec3 {
        self.around.sun.as_ref().map_or(Vec3::ZERO, |sun| sun.radiance(direction))
    }

    /// The sky and the emitters, to draw from for a surface at `point` that is lit from the side of `normal`; from both
    /// sides if it is 0.
    pub(crate) fn rest(&self, point: Vec3, normal: Vec3) -> Rest<'_> {
        Rest { lights: self, point, normal, near: OnceCell::new() }
    }

    /// How many samples of the rest are compared before one of them is asked for: one by day, since the sky is drawn well.
    pub(crate) fn candidates(&self) -> u32 {
        if self.are_mostly_lamps() { CANDIDATES } else { 1 }
    }

    /// Share of [`Self::scale`] below which light is asked for by chance.
    pub(crate) fn faint(&self) -> f32 {
        if self.are_mostly_lamps() { FAINT_OF_LAMPS } else { FAINT }
    }

    fn are_mostly_lamps(&self) -> bool {
        self.emitter_share > 0.5
    }

    /// Density over solid angle with which [`Rest::draw`], given that normal, draws a direction of the sky.
    pub(crate) fn pdf_rest(&self, normal: Vec3, direction: Vec3) -> f32 {
        (1.0 - self.emitter_share) * self.around.dome.pdf(normal, direction)
    }

    /// Density over solid angle with which [`Rest::draw`], given that point and normal, draws the point `on_light`
    /// of an emitting triangle; 0 where the triangle is never drawn.
    pub(crate) fn pdf_rest_emitter(
        &self,
        instance: u32,
        triangle: u32,
        point: Vec3,
        normal: Vec3,
        on_light: Vec3,
    ) -> f32 {
        let pdf = self.emitters.as_ref().map_or(0.0, |e| e.pdf((instance, triangle), point, normal, on_light));
        self.emitter_share * pdf
    }

    /// What haze leaves of light that comes `distance_m` metres against a direction, and the light that it sends besides;
    /// `None` where nothing is known of the air.
    pub(crate) fn haze(&self, direction: Vec3, distance_m: f32) -> Option<(Vec3, Vec3)> {
        let passes = self.around.haze?.transmittance(distance_m);
        let sky = self.around.dome.radiance(direction.with_z(direction.z.max(ABOVE_GROUND)).normalize(), 0.0);
        Some((passes, sky * (1.0 - passes)))
    }

    /// Radiance of the sky without the sun's disk, for a ray that stands for a cone of `spread_rad`.
    pub(crate) fn sky_radiance(&self, direction: Vec3, spread_rad: f32) -> Vec3 {
        self.around.dome.radiance(direction, spread_rad)
    }
}

/// The sky and the emitters, as they shine on a surface.
pub(crate) struct Rest<'a> {
    lights: &'a Lights,
    point: Vec3,
    normal: Vec3,
    near: OnceCell<Near<'a>>,
}

impl Rest<'_> {
    /// Where they are drawn for.
    pub(crate) fn point(&self) -> Vec3 {
        self.point
    }

    /// Draws the sky or an emitter (first number) and a direction to it (the other two).
    pub(crate) fn draw(&self, u: [f32; 3]) -> Option<LightSample> {
        let share = self.lights.emitter_share;
        if let Some(emitters) = self.lights.emitters.as_ref().filter(|_| u[0] < share) {
            let near = self.near.get_or_init(|| emitters.near(self.point, self.normal));
            return self.toward(near.draw([u[0] / share, u[1], u[2]])?);
        }
        let (wi, radiance, pdf) = self.lights.around.dome.draw(self.normal, [u[1], u[2]])?;
        let pdf = pdf * (1.0 - share);
        (pdf > 0.0).then_some(LightSample { wi, distance: f32::INFINITY, radiance, pdf })
    }

    fn toward(&self, drawn: EmitterPoint) -> Option<LightSample> {
        let to_light = drawn.point - self.point;
        let distance = to_light.length();
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

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DVec3, Vec2};
    use trove_model::{Class, ColorSpace, Instance, InstanceId, Light, Material, Mesh, PhysicalSky, Seed, Texture};

    use super::*;
    use crate::texture::{Glow, Textures};

    /// A lamp of two triangles above the origin, under a sky.
    fn scene() -> Scene {
        let sky = PhysicalSky {
            to_sun: DVec3::new(0.3, -0.4, 0.8),
            moon: None,
            turbidity: 3.0,
            ground_albedo: 0.2,
            cloud_cover: 0.0,
            cloud_seed: 4,
        };
        let lamp = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 2.0, 0.0), Vec3::new(0.0, 2.0, 0.0)],
            triangles: vec![[0, 2, 1], [0, 3, 2]],
            ..Mesh::default()
        };
        let at = DAffine3::from_translation(DVec3::new(0.5, 0.0, 1.5));
        let instance = Instance {
            id: InstanceId(0),
            class: Class::TrafficSign,
            mesh: 0,
            materials: vec![0],
            world_from_mesh: at,
            previous: None,
            next: None,
            object: None,
        };
        Scene {
            meshes: vec![Arc::new(lamp)],
            materials: vec![Material { emission: Vec3::splat(3.0), ..Material::default() }],
            instances: vec![instance],
            others: Default::default(),
            keyframes_apart_s: [0.5; 2],
            light: Light::clear(Environment::Sky(sky)),
            provenance: Vec::new(),
        }
    }

    fn lights(scene: &Scene) -> Lights {
        let (around, textures) = (LastSurroundings::default().get(&scene.light.environment), Textures::default());
        let emission = |index: usize| {
            let Material { emission, emission_map, .. } = &scene.materials[index];
            (*emission, emission_map.as_ref().map(|map| Glow::new(textures.map(map), Vec2::ONE)))
        };
        Lights::new(scene, &emission, around, &|_, _| [true; PROBES])
    }

    #[test]
    fn light_samples_add_up_to_the_light_and_say_their_own_density() {
        let scene = scene();
        let lights = lights(&scene);
        let mut random = Seed(9).random();
        let mut unit = || random.unit() as f32;
        let (draws, mut from_far, mut from_lamp) = (60_000, 0.0, 0.0);
        for _ in 0..draws {
            let rest = lights.rest(Vec3::ZERO, Vec3::Z).draw([unit(), unit(), unit()]);
            let sun = lights.sample_sun([unit(), unit()]);
            if let Some(sun) = &sun {
                assert!((lights.sun_pdf(sun.wi) / sun.pdf - 1.0).abs() < 1e-6);
            }
            for sample in rest.iter().chain(&sun) {
                assert!(sample.wi.is_normalized());
                let part = luminance(sample.radiance) * sample.wi.z.max(0.0) / sample.pdf;
                *if sample.distance.is_finite() { &mut from_lamp } else { &mut from_far } += part;
            }
            let Some(sample) = rest.filter(|rest| rest.distance.is_finite()) else { continue };
            // Both triangles have the same area and power, and lie in one plane.
            let point = sample.wi * sample.distance;
            let pdfs = [0, 1].map(|triangle| lights.pdf_rest_emitter(0, triangle, Vec3::ZERO, Vec3::Z, point));
            assert!((point.z - 1.5).abs() < 1e-4 && pdfs.iter().any(|pdf| (pdf / sample.pdf - 1.0).abs() < 1e-3));
        }
        // The same by a grid over the hemisphere for the sky, by the sun's own irradiance, and by a grid over the lamp.
        let Surroundings { dome, sun, .. } = &*lights.around;
        let (mut sky, grid) = (0.0, 400);
        for i in 0..grid * grid {
            let (z, azimuth) = (((i / grid) as f32 + 0.5) / grid as f32, (i % grid) as f32 / grid as f32 * 2.0 * PI);
            let r = (1.0 - z * z).sqrt();
            sky += luminance(dome.radiance(Vec3::new(r * azimuth.cos(), r * azimuth.sin(), z), 0.0)) * z * 2.0 * PI;
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
        let first = last.get(&scene.light.environment);
        assert!(Arc::ptr_eq(&first, &last.get(&scene.light.environment)));
        if let Environment::Sky(sky) = &mut scene.light.environment {
            sky.cloud_seed += 1;
        }
        assert!(!Arc::ptr_eq(&first, &last.get(&scene.light.environment)));
    }

    #[test]
    fn a_lamp_with_a_map_shines_from_where_the_map_is_bright() {
        let mut scene = scene();
        let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from_array);
        scene.meshes[0] = Arc::new(Mesh { uvs: uvs.to_vec(), ..Mesh::clone(&scene.meshes[0]) });
        // The lamp's half beyond x = 1 shines, in green.
        let (dark, green) = ([0, 0, 0, 255], [0, 255, 0, 255]);
        let rgba = (0..64).map(|i| if i < 32 { dark } else { green }).collect();
        let map = Texture { name: "half".into(), width: 64, height: 1, rgba, color_space: ColorSpace::Srgb };
        scene.materials[0].emission_map = Some(Arc::new(map));
        let lights = lights(&scene);
        let mut random = Seed(5).random();
        let mut unit = || random.unit() as f32;
        let (draws, mut found) = (60_000, Vec3::ZERO);
        for _ in 0..draws {
            let Some(sample) = lights.rest(Vec3::ZERO, Vec3::Z).draw([unit(), unit(), unit()]) else { continue };
            if sample.distance.is_finite() {
                let x = sample.wi.x * sample.distance;
                // Between texels it fades, also across the edge.
                assert!(!(0.52..=0.98).contains(&x) || sample.radiance == Vec3::ZERO, "{x}");
                found += sample.radiance * sample.wi.z.max(0.0) / sample.pdf;
            }
        }
        let (mut expected, grid) = (0.0, 200);
        for i in 0..grid * grid {
            let [along, across] = [i / grid, i % grid].map(|k| (k as f32 + 0.5) / grid as f32);
            let to_lamp = Vec3::new(1.0 + 0.5 * along, 2.0 * across, 1.5);
            expected += 3.0 * 1.5 * 1.5 / to_lamp.length_squared().powi(2) / (grid * grid) as f32;
        }
        let found = found / draws as f32;
        assert!((found.y / expected - 1.0).abs() < 0.05 && found.x == 0.0 && found.z == 0.0, "{found} {expected}");
    }
}

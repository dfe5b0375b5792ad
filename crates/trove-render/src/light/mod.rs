//! Where light comes from, made ready: sky, sun, environment map, emitters.

mod beams;
mod cdf;
mod cells;
mod clouds;
mod dome;
mod emitters;
mod haze;
mod sky;
mod sun;
mod sun_in_map;
mod tree;

use std::f32::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec3;
use trove_model::{Environment, Scene, luminance};
use trove_trace::light::{Haze, Sun};

use crate::lookups::LOOKUPS;
use crate::texture::MapOf;
pub(crate) use beams::Beams;
use dome::Dome;
use emitters::Emitters;
pub(crate) use emitters::{Emission, GetsAway, PROBES, Shines};
use haze::haze;
pub use sky::{BakedSky, bake_sky};
use sun_in_map::take_sun;
pub use trove_trace::light::SUN_RADIUS_RAD;

/// Cells on a side of a hemisphere's square: fine enough for clouds, and for the windows and lamps of a photograph.
const SKY_CELLS: usize = 64;
const MAP_CELLS: usize = 256;

/// Draws of directions below the horizon, as a share of what their brightness asks for: the ground hides most of them.
const SHARE_BELOW: f64 = 0.05;

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
                let sun = take_sun(&mut map).and_then(|sun| shining(sun.to_sun, sun.irradiance));
                Self { dome: Dome::new(map, false, MAP_CELLS, SHARE_BELOW), sun, haze: None }
            }
            Environment::Sky(parameters) => {
                let sky = sky::bake_sky(parameters);
                let dome = Dome::new(sky.map, true, SKY_CELLS, SHARE_BELOW);
                let sun = shining(sky.to_sun, sky.sun_irradiance);
                Self { dome, sun, haze: Some(haze(parameters.turbidity)) }
            }
        }
    }
}

/// `None` where it gives nothing.
fn shining(to_sun: Vec3, irradiance: Vec3) -> Option<Sun> {
    (irradiance.max_element() > 0.0).then(|| Sun::new(to_sun, irradiance))
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

/// What [`light::Lights`](trove_trace::light::Lights) looks up.
pub(crate) struct Lights {
    around: Arc<Surroundings>,
    beams: Beams,
    emitters: Option<Emitters>,
    emitter_share: f32,
    scale: f32,
}

impl Lights {
    pub(crate) fn new(
        scene: &Scene,
        emission: &Emission<'_>,
        beams: Beams,
        around: Arc<Surroundings>,
        gets_away: &GetsAway<'_>,
    ) -> Self {
        let emitters = Emitters::new(scene, emission, gets_away);
        let from_sky = luminance(around.dome.irradiance());
        let from_sun = around.sun.as_ref().map_or(0.0, |sun| luminance(sun.level_irradiance()));
        let from_emitters = emitters.as_ref().map_or(0.0, |emitters| emitters.typical_irradiance);
        // By day lamps add little, and by night nearly everything; neither is ever left out.
        let even = from_emitters / (from_emitters + from_sky).max(f32::MIN_POSITIVE);
        let emitter_share = if emitters.is_some() { even.clamp(0.1, 0.9) } else { 0.0 };
        let scale = (from_sky + from_sun + from_emitters) / PI;
        Self { around, beams, emitters, emitter_share, scale: scale.max(f32::MIN_POSITIVE) }
    }

    /// To be looked up.
    pub(crate) fn view(&self) -> LightsOf<'_> {
        let Surroundings { dome, sun, haze } = &*self.around;
        LightsOf {
            lookups: &LOOKUPS,
            sun: *sun,
            haze: *haze,
            sky: dome.view(),
            beams: self.beams.view(),
            emitters: self.emitters.as_ref().map(|emitters| emitters.view(self.beams.view())),
            emitter_share: self.emitter_share,
            scale: self.scale,
        }
    }
}

/// Lights of a scene in the processor's memory.
pub(crate) type LightsOf<'a> = trove_trace::light::Lights<'a, MapOf>;

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
            let glow = emission_map.as_ref().map(|map| Glow { map: textures.map(map), scale: Vec2::ONE });
            Shines { radiance: *emission, glow, beam: trove_trace::NONE }
        };
        Lights::new(scene, &emission, Beams::default(), around, &|_, _| [true; PROBES])
    }

    #[test]
    fn light_samples_add_up_to_the_light_and_say_their_own_density() {
        let scene = scene();
        let made = lights(&scene);
        let lights = made.view();
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
            let pdfs = [0, 1].map(|triangle| lights.pdf_rest_emitter([0, triangle], Vec3::ZERO, Vec3::Z, point));
            assert!((point.z - 1.5).abs() < 1e-4 && pdfs.iter().any(|pdf| (pdf / sample.pdf - 1.0).abs() < 1e-3));
        }
        // The same by a grid over the hemisphere for the sky, by the sun's own irradiance, and by a grid over the lamp.
        let Surroundings { dome, sun, .. } = &*made.around;
        let (mut sky, grid) = (0.0, 400);
        for i in 0..grid * grid {
            let (z, azimuth) = (((i / grid) as f32 + 0.5) / grid as f32, (i % grid) as f32 / grid as f32 * 2.0 * PI);
            let r = (1.0 - z * z).sqrt();
            sky +=
                luminance(dome.view().radiance(Vec3::new(r * azimuth.cos(), r * azimuth.sin(), z), 0.0)) * z * 2.0 * PI;
        }
        let sky = sky / (grid * grid) as f32;
        let to_sun = Vec3::new(0.3, -0.4, 0.8).normalize();
        let sun = luminance(sun.as_ref().unwrap().radiance(to_sun)) * 0.8 * PI * SUN_RADIUS_RAD.powi(2) * to_sun.z;
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
        let made = lights(&scene);
        let lights = made.view();
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

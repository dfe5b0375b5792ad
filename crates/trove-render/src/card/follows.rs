//! What a card runs, run here, against the renderer.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, Vec3, vec2};
use trove_model::{
    Beam, Capture, Class, ColorSpace, Distortion, Environment, Fog, Form, Instance, InstanceId, Lens, Light, Mapping,
    Material, Mesh, PhysicalSky, Placement, Pose, Precipitation, Puff, Random, Raster, Scene, Seed, Shot, Snow,
    SnowLeft, Texture, Tiling,
};
use trove_trace::field::LightField;
use trove_trace::path::{Cone, Path, Sample, Start, World, advance};
use trove_trace::{Exposure, Sampler};

use super::follow::follow_here;
use super::world::world;
use super::{Emulated, Machine};
use crate::accel::{Coherence, Flat, Here, asked};
use crate::path::{Seen, followed};
use crate::ray::Ray;
use crate::remote::{RemoteScene, RemoteWave};
use crate::{Denoising, KernelChoice, PreparedScene, Renderer, RendererOptions};

fn texture(name: &str, color_space: ColorSpace, texel: impl Fn(u32, u32) -> [u8; 4]) -> Option<Arc<Texture>> {
    let side = 32;
    let rgba = (0..side * side).map(|i| texel(i % side, i / side)).collect();
    Some(Arc::new(Texture { name: name.into(), width: side, height: side, rgba, color_space }))
}

/// A square of a size in the plane of x and y, with normals that lean and colours at its corners.
fn square(size: f32) -> Arc<Mesh> {
    let corners = [vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, 1.0)];
    Arc::new(Mesh {
        positions: corners.map(|c| (c * size).extend(0.0)).into(),
        normals: corners.map(|c| (c * 0.1).extend(1.0)).into(),
        uvs: corners.map(|c| c * size * 0.5).into(),
        tints: corners.map(|c| Vec3::splat(0.8 + 0.2 * c.x)).into(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        slots: vec![0, 1],
    })
}

/// What changes a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sort {
    Day,
    Night,
    Fog,
    Rain,
    Snow,
}

const SORTS: [Sort; 5] = [Sort::Day, Sort::Night, Sort::Fog, Sort::Rain, Sort::Snow];

fn light(sort: Sort, sky: PhysicalSky) -> Light {
    let clear = Light::clear(Environment::Sky(sky));
    let puff = |x: f64| Puff { centre: DVec3::new(x, 2.0, 1.5), radius_m: [1.5, 1.0], extinction_per_m: 0.3 };
    match sort {
        Sort::Day | Sort::Night => clear,
        Sort::Fog => Light { fog: Some(Fog { visibility_m: 60.0, height_m: 30.0, ground_z_m: 0.0 }), ..clear },
        Sort::Rain => Light {
            falling: Some(Precipitation { form: Form::Rain, rate_mm_h: 10.0 }),
            spray: vec![vec![puff(0.0), puff(1.0)], vec![puff(-4.0)]],
            moment_s: 2.5,
            ..clear
        },
        Sort::Snow => {
            let shares = Raster::from_fn(40, 40, |x, y| (x * 5 + y) as u8);
            let left = SnowLeft { origin: DVec2::splat(-10.0), cell_m: 0.5, shares };
            Light { snow: Some(Snow { cover: 0.8, left: Some(Arc::new(left)) }), ..clear }
        }
    }
}

/// Squares of all sorts of materials, some of which move, above ground.
fn scene(sort: Sort) -> Scene {
    let wetness = if sort == Sort::Rain { 0.8 } else { 0.0 };
    let noise = |x: u32, y: u32| ((x * 37 + y * 91) % 200) as u8 + 40;
    let colors = texture("colors", ColorSpace::Srgb, |x, y| [noise(x, y), noise(y, x), 120, 255]);
    let holes =
        texture("holes", ColorSpace::Srgb, |x, y| [90, 120, 60, if (x / 8 + y / 8) % 2 == 0 { 255 } else { 0 }]);
    let orm = texture("orm", ColorSpace::Linear, |x, y| [255, noise(x, y), 30, 255]);
    let normals = texture("normals", ColorSpace::Linear, |x, y| [noise(x, y) / 4 + 96, noise(y, x) / 4 + 96, 240, 255]);
    let heights = texture("heights", ColorSpace::Linear, |x, y| [noise(x / 4, y / 4), 0, 0, 255]);
    let plain = || Material { base_color: Vec3::new(0.6, 0.5, 0.4), roughness: 0.6, wetness, ..Material::default() };
    let beam =
        Beam::new(vec![-60.0, 0.0, 60.0], vec![-40.0, 0.0, 40.0], vec![0.1, 0.4, 0.2, 0.3, 1.0, 0.5, 0.0, 0.6, 0.1]);
    let materials = vec![
        Material {
            base_color_map: colors.clone(),
            orm_map: orm,
            normal_map: normals,
            dirt: 0.7,
            tiling: Tiling::Stochastic,
            ..plain()
        },
        Material { base_color_map: colors.clone(), height_map: heights, height_m: 0.05, dirt: 0.3, ..plain() },
        Material {
            mapping: Mapping::Triplanar,
            base_color_map: colors.clone(),
            sheen: 0.8,
            subsurface: 0.4,
            ..plain()
        },
        Material { coat: 1.0, flakes: 0.8, metalness: 0.3, ..plain() },
        Material { transmission: 0.9, roughness: 0.0, ior: 1.5, ..plain() },
        Material { base_color_map: holes, alpha_cutoff: 0.5, translucency: 0.5, ..plain() },
        Material { emission: Vec3::new(5.0, 4.0, 3.0), emission_map: colors, ..plain() },
        Material { emission: Vec3::new(30.0, 25.0, 20.0), beam: beam.map(Arc::new), ..plain() },
    ];
    let mut random = Seed(7).random();
    let unit = |random: &mut Random| DVec3::from_array(std::array::from_fn(|_| random.range(-1.0, 1.0)));
    let instances = (0..60usize).map(|i| {
        let at = |random: &mut Random| unit(random) * DVec3::new(7.0, 7.0, 2.0) + DVec3::Z * 2.5;
        let turn = DQuat::from_scaled_axis(unit(&mut random) * 3.0);
        let here = DAffine3::from_rotation_translation(turn, at(&mut random));
        let pose = |world_from_mesh| Placement { mesh: 1, world_from_mesh };
        let moves = i.is_multiple_of(4);
        let step = DAffine3::from_translation(unit(&mut random));
        let then =
            |pose: Placement| if moves { Some(pose) } else { Some(Placement { mesh: 1, world_from_mesh: here }) };
        Instance {
            id: InstanceId(0),
            // Trees keep no rain off, and people bear no snow.
            class: [Class::Barrier, Class::Tree, Class::Human][i % 3],
            mesh: 1,
            materials: vec![i % 8, (i + 3) % 8],
            world_from_mesh: here,
            previous: then(pose(step.inverse() * here)),
            next: then(pose(step * here)),
            object: None,
        }
    });
    let ground = Instance {
        id: InstanceId(0),
        class: Class::Ground,
        mesh: 0,
        materials: vec![0, 1],
        world_from_mesh: DAffine3::IDENTITY,
        previous: None,
        next: None,
        object: None,
    };
    let sky = PhysicalSky {
        to_sun: DVec3::new(0.3, -0.5, if sort == Sort::Night { -0.4 } else { 0.6 }).normalize(),
        moon: None,
        turbidity: 3.0,
        ground_albedo: 0.2,
        cloud_cover: 0.3,
        cloud_seed: 4,
    };
    Scene {
        meshes: vec![square(40.0), square(1.0)],
        materials,
        instances: instances.chain([ground]).collect(),
        others: Default::default(),
        keyframes_apart_s: [0.5; 2],
        light: light(sort, sky),
        provenance: Vec::new(),
    }
}

/// Where paths from an eye in the middle of all begin, at all times.
fn starts(count: u32) -> Vec<Start> {
    let mut random = Seed(3).random();
    let mut unit = move || random.range(-1.0, 1.0) as f32;
    let start = |i: u32| {
        let direction = Vec3::new(unit(), unit(), unit()).normalize();
        let time = if i.is_multiple_of(2) { 0.5 } else { 0.5 + 0.5 * unit() };
        let ray = Ray { time, ..Ray::new(Vec3::new(0.0, 0.0, 2.0), direction) }.plain();
        Start { ray, past: 0, cone: Cone { width_m: 0.0, spread_rad: 0.001 }, sampler: Sampler::new(5, [i, 3], 0, 0) }
    };
    (0..count).map(start).collect()
}

fn renderer() -> Renderer {
    let (kernel, denoise) = (KernelChoice::Obvhs, Denoising::None);
    Renderer::new(&RendererOptions { kernel, denoise, threads: 2, ..Default::default() }).unwrap()
}

#[test]
fn paths_go_the_same_way_through_tables_as_through_the_scene() {
    for sort in SORTS {
        let scene = scene(sort);
        let renderer = renderer();
        let prepared = renderer.prepare(&scene).unwrap();
        let shapes = Flat::new(&prepared.shapes).unwrap();
        let mut memory = Here::default();
        let Ok(flat) = world(&prepared, &shapes, &mut memory);
        // SAFETY: the tables are as `world` makes them, and the memory lives on.
        let (here, seen) = (unsafe { flat.readable() }, Seen::new(&prepared, None));
        let (mut wet, mut snowy) = (0, 0);
        let starts = starts(20_000);
        let mut ours: Vec<Path> = starts.iter().map(|start| Path::new(*start)).collect();
        let (mut others, mut met, mut lit) = (ours.clone(), 0, 0);
        let bits =
            |sample: Sample| [sample.radiance, sample.albedo, sample.normal].map(|v| v.to_array().map(f32::to_bits));
        while !ours.is_empty() {
            let mut on = Vec::new();
            for (path, other) in ours.iter_mut().zip(&mut others) {
                let ray = Ray::from(&*path);
                let mut hits = [None];
                prepared.closest(&[ray], Coherence::Incoherent, &mut hits);
                // SAFETY: as above.
                assert_eq!(unsafe { flat.scene.closest(&asked(&ray)) }, hits[0]);
                met += usize::from(hits[0].is_some());
                let exposure = hits[0].map_or(Exposure::BARE, |hit| here.exposure(&hit, &other.ray));
                wet += usize::from(exposure.rain_mm_h > 0.0);
                snowy += usize::from(exposure.snow * exposure.left > 0.0);
                // SAFETY: as above.
                let there = unsafe { flat.readable() }.under(exposure);
                let (turn, of_tables) = (advance(&seen, path, hits[0]), advance(&there, other, hits[0]));
                let shadows = [
                    (turn.shadows.to_rest, of_tables.shadows.to_rest),
                    (turn.shadows.to_sun, of_tables.shadows.to_sun),
                ];
                for (shadow, of_tables) in shadows {
                    assert_eq!(shadow.is_some(), of_tables.is_some());
                    let (Some(shadow), Some(of_tables)) = (shadow, of_tables) else { continue };
                    let mut light = [shadow.light];
                    prepared.any(&[shadow.ray.into()], Coherence::Incoherent, &mut light);
                    let there = here.let_through(&of_tables.ray, of_tables.light);
                    assert!((there - light[0]).length() <= 1e-5 * light[0].length(), "{there} instead of {}", light[0]);
                    lit += usize::from(light[0] != Vec3::ZERO);
                    path.gather(light[0], shadow.bounce, seen.lights().scale);
                    other.gather(light[0], of_tables.bounce, here.lights().scale);
                }
                assert_eq!(bits(path.sample()), bits(other.sample()));
                assert_eq!(turn.goes_on, of_tables.goes_on);
                if turn.goes_on {
                    on.push((*path, *other));
                }
            }
            (ours, others) = on.into_iter().unzip();
        }
        assert!(met > 20_000 && lit > 5_000, "{met} {lit}");
        assert_eq!([wet > 1000, snowy > 1000], [sort == Sort::Rain, sort == Sort::Snow], "{wet} {snowy}");

        // In waves, as on a card.
        // SAFETY: as above.
        let (samples, _) = unsafe { follow_here(&flat, &starts) };
        let mut sum = [0.0, 0.0];
        for (sample, expected) in samples.iter().zip(followed(&prepared, starts.clone())) {
            assert_eq!((sample.albedo, sample.normal), (expected.albedo, expected.normal));
            // Panes in another order round otherwise.
            let apart = (sample.radiance - expected.radiance).length();
            assert!(apart <= 1e-4 * expected.radiance.length(), "{} instead of {}", sample.radiance, expected.radiance);
            sum = [sum[0] + sample.radiance.y, sum[1] + expected.radiance.y];
        }
        assert!(sum[0] > 0.0 && (sum[0] / sum[1] - 1.0).abs() < 1e-5, "{sum:?}");
    }
}

/// A card that does not hold out.
#[derive(Clone, Copy)]
struct Failing {
    is_full: bool,
    /// Is lost after it has followed so many waves of a picture.
    lost_after: usize,
}

/// A scene that it has taken.
struct Taken {
    emulated: Box<dyn RemoteScene>,
    lost_after: usize,
}

struct Followed<'a> {
    emulated: Box<dyn RemoteWave + 'a>,
    more: usize,
}

impl Machine for Failing {
    fn name(&self) -> &str {
        "failing"
    }

    fn take(&self, scene: &PreparedScene) -> Result<Box<dyn RemoteScene>, String> {
        let emulated = Emulated.take(scene)?;
        if self.is_full { Err("full".into()) } else { Ok(Box::new(Taken { emulated, lost_after: self.lost_after })) }
    }
}

impl RemoteScene for Taken {
    fn wave<'a>(&'a self, field: Option<LightField<'a>>, most: usize) -> Result<Box<dyn RemoteWave + 'a>, String> {
        Ok(Box::new(Followed { emulated: self.emulated.wave(field, most)?, more: self.lost_after }))
    }
}

impl RemoteWave for Followed<'_> {
    fn follow(&mut self, starts: &[Start], samples: &mut [Sample]) -> Result<u64, String> {
        self.more = self.more.checked_sub(1).ok_or("lost")?;
        self.emulated.follow(starts, samples)
    }
}

/// A picture from the middle of all.
fn shot(noise: f32) -> Shot {
    let lens = Lens {
        width_px: 70,
        height_px: 40,
        fx_px: 40.0,
        fy_px: 40.0,
        cx_px: 35.0,
        cy_px: 20.0,
        distortion: Distortion::None,
    };
    let north = DQuat::from_mat3(&DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y));
    Shot { spp: 24, noise, cache: true, ..Shot::new("front", lens, Pose::new(north, DVec3::new(0.0, -3.0, 2.0))) }
}

fn taken(renderer: &Renderer, scene: &Scene, noise: f32) -> Capture {
    renderer.render(&renderer.prepare(scene).unwrap(), &shot(noise), true, &|_| false).unwrap()
}

fn radiance(capture: &Capture) -> &[[f32; 3]] {
    &capture.color.as_ref().unwrap().radiance.data
}

#[test]
fn a_picture_through_tables_is_the_processor_s() {
    for sort in SORTS {
        let (scene, noise) = (scene(sort), if sort == Sort::Night { 0.2 } else { 0.0 });
        let ours = taken(&renderer(), &scene, noise);
        let theirs = taken(&renderer().with(Box::new(Emulated)), &scene, noise);
        assert_eq!(theirs.stats, ours.stats);
        assert_eq!(theirs.labels.depth_m.data, ours.labels.depth_m.data);
        let mut lit = 0;
        for (there, here) in radiance(&theirs).iter().zip(radiance(&ours)) {
            let [there, here] = [there, here].map(|rgb| Vec3::from(*rgb));
            // Panes in another order round otherwise.
            assert!((there - here).length() <= 1e-4 * here.length(), "{there} instead of {here}");
            lit += usize::from(here != Vec3::ZERO);
        }
        assert!(lit > 2000, "{lit}");
    }
}

#[test]
fn the_processor_goes_on_where_a_card_cannot() {
    let scene = scene(Sort::Day);
    let ours = taken(&renderer(), &scene, 0.0);
    let full = Failing { is_full: true, lost_after: 0 };
    let lost = Failing { is_full: false, lost_after: 3 };
    for (machine, why) in [(full, "full"), (lost, "lost")] {
        let theirs = taken(&renderer().with(Box::new(machine)), &scene, 0.0);
        assert_eq!(theirs.stats.refused.as_deref(), Some(why));
        assert_eq!(radiance(&theirs), radiance(&ours));
    }
}

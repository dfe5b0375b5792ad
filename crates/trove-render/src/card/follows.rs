//! What a card runs, run here, against the renderer.

use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3, Vec3, vec2};
use trove_model::{
    Beam, Class, ColorSpace, Environment, Fog, Instance, InstanceId, Light, Mapping, Material, Mesh, PhysicalSky,
    Placement, Random, Scene, Seed, Texture, Tiling,
};
use trove_trace::Sampler;
use trove_trace::path::{Cone, Path, Start, World, advance};

use super::follow::{self, follow};
use super::world::world;
use crate::accel::{Coherence, Flat, Here, asked};
use crate::path::{Seen, followed};
use crate::ray::Ray;
use crate::{Denoising, KernelChoice, Renderer, RendererOptions};

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

/// Squares of all sorts of materials, some of which move, above ground, by day or by night, in clear air or in fog.
fn scene(is_night: bool, fog: Option<Fog>) -> Scene {
    let noise = |x: u32, y: u32| ((x * 37 + y * 91) % 200) as u8 + 40;
    let colors = texture("colors", ColorSpace::Srgb, |x, y| [noise(x, y), noise(y, x), 120, 255]);
    let holes =
        texture("holes", ColorSpace::Srgb, |x, y| [90, 120, 60, if (x / 8 + y / 8) % 2 == 0 { 255 } else { 0 }]);
    let orm = texture("orm", ColorSpace::Linear, |x, y| [255, noise(x, y), 30, 255]);
    let normals = texture("normals", ColorSpace::Linear, |x, y| [noise(x, y) / 4 + 96, noise(y, x) / 4 + 96, 240, 255]);
    let heights = texture("heights", ColorSpace::Linear, |x, y| [noise(x / 4, y / 4), 0, 0, 255]);
    let plain = || Material { base_color: Vec3::new(0.6, 0.5, 0.4), roughness: 0.6, ..Material::default() };
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
            class: Class::Barrier,
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
        to_sun: DVec3::new(0.3, -0.5, if is_night { -0.4 } else { 0.6 }).normalize(),
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
        light: Light { fog, ..Light::clear(Environment::Sky(sky)) },
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

#[test]
fn paths_go_the_same_way_through_tables_as_through_the_scene() {
    let fog = Fog { visibility_m: 60.0, height_m: 30.0, ground_z_m: 0.0 };
    for (is_night, fog) in [(false, None), (true, None), (false, Some(fog))] {
        let scene = scene(is_night, fog);
        let options =
            RendererOptions { kernel: KernelChoice::Obvhs, denoise: Denoising::None, threads: 1, search: Vec::new() };
        let renderer = Renderer::new(&options).unwrap();
        let prepared = renderer.prepare(&scene).unwrap();
        let shapes = Flat::new(&prepared.shapes).unwrap();
        let mut memory = Here::default();
        let Ok(flat) = world(&prepared, &shapes, None, &mut memory);
        // SAFETY: the tables are as `world` makes them, and the memory lives on.
        let (here, seen) = (unsafe { flat.readable() }, Seen::new(&prepared, None));
        let starts = starts(20_000);
        let mut ours: Vec<Path> = starts.iter().map(|start| Path::new(*start)).collect();
        let (mut others, mut met, mut lit) = (ours.clone(), 0, 0);
        let bits = |sample: trove_trace::path::Sample| {
            [sample.radiance, sample.albedo, sample.normal].map(|v| v.to_array().map(f32::to_bits))
        };
        while !ours.is_empty() {
            let mut on = Vec::new();
            for (path, other) in ours.iter_mut().zip(&mut others) {
                let ray = Ray::from(&*path);
                let mut hits = [None];
                prepared.closest(&[ray], Coherence::Incoherent, &mut hits);
                // SAFETY: as above.
                assert_eq!(unsafe { flat.scene.closest(&asked(&ray)) }, hits[0]);
                met += usize::from(hits[0].is_some());
                let (turn, of_tables) = (advance(&seen, path, hits[0]), advance(&here, other, hits[0]));
                let shadows = [(turn.to_rest, of_tables.to_rest), (turn.to_sun, of_tables.to_sun)];
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

        // In waves, as on a card.
        // SAFETY: as above.
        let mut wave = unsafe { follow::Here::new(&flat, &starts) };
        follow(&mut wave, starts.len()).unwrap();
        let mut sum = [0.0, 0.0];
        for (sample, expected) in wave.samples().iter().zip(followed(&prepared, starts.clone())) {
            assert_eq!((sample.albedo, sample.normal), (expected.albedo, expected.normal));
            // Panes in another order round otherwise.
            let apart = (sample.radiance - expected.radiance).length();
            assert!(apart <= 1e-4 * expected.radiance.length(), "{} instead of {}", sample.radiance, expected.radiance);
            sum = [sum[0] + sample.radiance.y, sum[1] + expected.radiance.y];
        }
        assert!(sum[0] > 0.0 && (sum[0] / sum[1] - 1.0).abs() < 1e-5, "{sum:?}");
    }
}

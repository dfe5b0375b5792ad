//! Photographed skies, from their files to what they light.

#![allow(clippy::unwrap_used)] // all of this is tests

use std::f32::consts::{PI, TAU};
use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3, vec3};
use trove_model::{
    Class, Distortion, Environment, EnvironmentMap, Instance, InstanceId, Lens, Light, Material, Mesh, Pose, Scene,
    Seed, Shot,
};
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_skies_light_a_white_surface_with_all_that_they_have() {
    let data = std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA");
    let options =
        RendererOptions { kernel: KernelChoice::Obvhs, denoise: Denoising::None, threads: 2, ..Default::default() };
    let renderer = Renderer::new(&options).unwrap();
    for name in ["venice_sunset_1k.hdr", "kiara_1_dawn_1k.hdr"] {
        let path = Path::new(&data).join("hdri").join(name);
        let map = Arc::new(trove_read::environment::read(&path).unwrap());
        for normal in [DVec3::Z, DVec3::X, DVec3::NEG_Y] {
            let expected = irradiance(&map, normal.as_vec3()) / PI;
            let found = radiance(&renderer, &map, normal);
            let off = ((found - expected) / expected).abs().max_element();
            assert!(off < 0.02, "{name}, {normal}: {found} instead of {expected}");
        }
    }
}

/// The sum over all texels, each with its solid angle.
fn irradiance(map: &EnvironmentMap, normal: Vec3) -> Vec3 {
    let (width, height) = (map.width as usize, map.height as usize);
    let texel = |i: usize| {
        let from_zenith = PI * ((i / width) as f32 + 0.5) / height as f32;
        let azimuth = PI - TAU * ((i % width) as f32 + 0.5) / width as f32;
        let (r, z) = from_zenith.sin_cos();
        let direction = vec3(r * azimuth.cos(), r * azimuth.sin(), z);
        let solid_angle = TAU / width as f32 * 2.0 * (0.5 * PI / height as f32).sin() * r;
        Vec3::from(map.rgb[i]).as_dvec3() * f64::from(direction.dot(normal).max(0.0) * solid_angle)
    };
    (0..width * height).map(texel).sum::<DVec3>().as_vec3()
}

/// Mean radiance of a white square that faces `normal`, seen straight on, where its surface mirrors nothing.
fn radiance(renderer: &Renderer, map: &Arc<EnvironmentMap>, normal: DVec3) -> Vec3 {
    let (across, up) = normal.any_orthonormal_pair();
    let corner = |x: f64, y: f64| (across * x + up * y).as_vec3();
    let square = Mesh {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let scene = Scene {
        meshes: vec![Arc::new(square)],
        materials: vec![Material { ior: 1.0, ..Material::plain("white", Vec3::ONE, 0.0) }],
        instances: vec![Instance {
            id: InstanceId(0),
            class: Class::Road,
            mesh: 0,
            materials: vec![0],
            world_from_mesh: DAffine3::IDENTITY,
            previous: None,
            next: None,
            object: None,
        }],
        others: Default::default(),
        keyframes_apart_s: [0.5; 2],
        light: Light::clear(Environment::Map(map.clone())),
        provenance: Vec::new(),
    };
    let (width_px, height_px, f) = (32, 32, 800.0);
    let lens = Lens { width_px, height_px, fx_px: f, fy_px: f, cx_px: 16.0, cy_px: 16.0, distortion: Distortion::None };
    let facing = DQuat::from_mat3(&DMat3::from_cols(across, -up, -normal));
    let shot = Shot { spp: 64, seed: Seed(1), ..Shot::new("test", lens, Pose::new(facing, normal * 2.0)) };
    let prepared = renderer.prepare(&scene).unwrap();
    let picture = renderer.render(&prepared, &shot, true, &|_| false).unwrap().color.unwrap().radiance;
    picture.data.iter().map(|&rgb| Vec3::from(rgb)).sum::<Vec3>() / (width_px * height_px) as f32
}

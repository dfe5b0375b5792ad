//! Pictures whose radiance is known in closed form, and pictures that must be equal.

#![allow(clippy::unwrap_used)] // its helpers are tests too

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec2, Vec3, vec2, vec3};
use trove_model::{
    Camera, Class, ColorSpace, Distortion, Environment, EnvironmentMap, Film, Instance, InstanceId, Lens, Light,
    Material, Mesh, Pose, Raster, Scene, Seed, Shot, Shutter, Texture, World,
};
use trove_render::{KernelChoice, RenderError, Renderer, RendererOptions};

#[test]
fn a_white_ball_in_a_white_world_cannot_be_seen() {
    for (ior, tolerance) in [(1.0, 1e-3), (1.5, 0.01)] {
        let white = Material { ior, ..Material::plain("white", Vec3::ONE, 1.0) };
        let picture = look(&renderer(KernelChoice::Obvhs, 2), &scene(ball(), white), 64, 0.8);
        let mean = mean(&picture);
        assert!((mean - 1.0).abs() < tolerance, "ior {ior}: {mean}");
    }
}

#[test]
fn a_grey_ball_in_a_white_world_is_as_bright_as_its_albedo() {
    let grey = Material { ior: 1.0, ..Material::plain("grey", Vec3::splat(0.5), 1.0) };
    let picture = look(&renderer(KernelChoice::Obvhs, 2), &scene(ball(), grey), 16, 0.2);
    // Seen from the front a rough ball is a little darker than from all sides.
    assert!((mean(&picture) - 0.5).abs() < 0.01, "{}", mean(&picture));
}

#[test]
fn a_glowing_room_is_as_bright_as_its_bounces_add_up() {
    let glow = Material { emission: Vec3::splat(0.25), ior: 1.0, ..Material::plain("glow", Vec3::splat(0.5), 1.0) };
    let mut room = cube(2.0);
    room.positions.iter_mut().for_each(|p| *p += vec3(0.0, -4.0, 0.0)); // around the camera
    let picture = look(&renderer(KernelChoice::Obvhs, 2), &scene(room, glow), 64, 0.8);
    // Light that left after 0, 1, … 6 bounces: 0.25 · (1 + ½ + … + ½⁶).
    let expected = 0.25 * (2.0 - 0.5f32.powi(6));
    assert!((mean(&picture) - expected).abs() < 0.01, "{} instead of {expected}", mean(&picture));
}

#[test]
fn a_clear_pane_in_a_white_world_cannot_be_seen() {
    let glass = Material { transmission: 1.0, ..Material::plain("glass", Vec3::ONE, 0.0) };
    let picture = look(&renderer(KernelChoice::Obvhs, 2), &scene(wall(), glass), 16, 0.2);
    assert!((mean(&picture) - 1.0).abs() < 0.01, "{}", mean(&picture));
}

#[test]
fn light_falls_through_holes_and_not_beside_them() {
    let mut chequered =
        Texture { name: "chequered".into(), width: 64, height: 64, rgba: Vec::new(), color_space: ColorSpace::Srgb };
    // Left half open, right half closed.
    chequered.rgba = (0..64 * 64).map(|i| [0, 0, 0, if i % 64 < 32 { 0 } else { 255 }]).collect();
    let leaf = Material {
        base_color_map: Some(Arc::new(chequered)),
        alpha_cutoff: 0.5,
        ior: 1.0,
        ..Material::plain("leaf", Vec3::ONE, 1.0)
    };
    for kernel in kernels() {
        let picture = look(&renderer(kernel, 1), &scene(wall(), leaf.clone()), 4, 0.2);
        let (left, right) = (picture.at(2, 8)[0], picture.at(13, 8)[0]);
        assert!((left - 1.0).abs() < 1e-3 && right < 1e-3, "{kernel:?}: {left}, {right}");
    }
}

#[test]
fn one_thread_and_two_give_the_same_bytes() {
    for kernel in kernels() {
        let [one, two] = [1, 2].map(|threads| look(&renderer(kernel, threads), &crowd(), 4, 0.6));
        assert!(one == two, "{kernel:?}");
    }
}

#[test]
fn all_kernels_see_the_same() {
    let pictures: Vec<_> = kernels().map(|kernel| look(&renderer(kernel, 2), &crowd(), 16, 0.6)).collect();
    for other in &pictures[1..] {
        let pairs = pictures[0].data.iter().flatten().zip(other.data.iter().flatten());
        let difference: f32 = pairs.map(|(a, b)| (a - b).abs()).sum::<f32>() / other.data.len() as f32;
        assert!(difference < 0.01, "{difference}");
    }
}

#[test]
fn the_carrier_is_not_seen_by_its_camera() {
    let mut shot = shot(4, 0.2);
    let scene = scene(wall(), Material::plain("black", Vec3::ZERO, 1.0));
    let renderer = renderer(KernelChoice::Obvhs, 1);
    let prepared = renderer.prepare(&scene).unwrap();
    shot.carrier = Some(InstanceId(1));
    let seen = renderer.render(&prepared, &shot, true, &|_| false).unwrap().color.unwrap().radiance;
    assert!((mean(&seen) - 1.0).abs() < 1e-3);
}

#[test]
fn a_mesh_with_nan_is_refused_by_name() {
    let mut mesh = ball();
    mesh.positions[3].x = f32::NAN;
    let refused = renderer(KernelChoice::Obvhs, 1).prepare(&scene(mesh, Material::default()));
    let Err(RenderError::Scene { place, .. }) = refused else { panic!("accepted") };
    assert_eq!(place, "mesh 0");
}

#[test]
fn an_empty_scene_and_an_empty_mesh_are_no_trouble() {
    for kernel in kernels() {
        let renderer = renderer(kernel, 1);
        let mut nothing = scene(Mesh::default(), Material::default());
        assert!((mean(&look(&renderer, &nothing, 1, 0.2)) - 1.0).abs() < 1e-3);
        nothing.instances.clear();
        assert!((mean(&look(&renderer, &nothing, 1, 0.2)) - 1.0).abs() < 1e-3);
    }
}

#[test]
fn a_stopped_picture_is_none() {
    let renderer = renderer(KernelChoice::Obvhs, 1);
    let prepared = renderer.prepare(&crowd()).unwrap();
    assert!(renderer.render(&prepared, &shot(1, 0.6), true, &|_| true).is_none());
}

/// The built-in kernel, and Embree where this machine has it.
fn kernels() -> impl Iterator<Item = KernelChoice> {
    let embree = Renderer::new(&options(KernelChoice::Embree, 1)).is_ok();
    if !embree {
        eprintln!("Embree is not tested: set TROVE_EMBREE to its library or to Python's site-packages");
    }
    [KernelChoice::Obvhs, KernelChoice::Embree].into_iter().take(1 + usize::from(embree))
}

fn options(kernel: KernelChoice, threads: usize) -> RendererOptions {
    let search = std::env::var_os("TROVE_EMBREE").map(Into::into).into_iter().collect();
    RendererOptions { kernel, denoise: false, threads, search }
}

fn renderer(kernel: KernelChoice, threads: usize) -> Renderer {
    Renderer::new(&options(kernel, threads)).unwrap()
}

/// 16×16 pixels from (0, −4, 0) to the north; `half_width` is half of what is seen at the origin, in metres.
fn shot(spp: u32, half_width: f64) -> Shot {
    let f = 8.0 * 4.0 / half_width;
    let north = DQuat::from_mat3(&DMat3::from_cols(DVec3::X, -DVec3::Z, DVec3::Y));
    Shot {
        view: "test".into(),
        lens: Lens {
            width_px: 16,
            height_px: 16,
            fx_px: f,
            fy_px: f,
            cx_px: 8.0,
            cy_px: 8.0,
            distortion: Distortion::None,
        },
        world_from_camera: Pose::<World, Camera>::new(north, DVec3::new(0.0, -4.0, 0.0)),
        world_from_camera_previous: None,
        world_from_camera_next: None,
        time_ns: 0,
        shutter: Shutter::INSTANT,
        spp,
        noise: 0.0,
        film: Film::default(),
        seed: Seed(1),
        carrier: None,
    }
}

fn look(renderer: &Renderer, scene: &Scene, spp: u32, half_width: f64) -> Raster<[f32; 3]> {
    let prepared = renderer.prepare(scene).unwrap();
    renderer.render(&prepared, &shot(spp, half_width), true, &|_| false).unwrap().color.unwrap().radiance
}

fn mean(picture: &Raster<[f32; 3]>) -> f32 {
    picture.data.iter().flatten().sum::<f32>() / (3 * picture.data.len()) as f32
}

/// One thing at the origin in a world that is white all around.
fn scene(mesh: Mesh, material: Material) -> Scene {
    let white = EnvironmentMap { name: "white".into(), width: 8, height: 4, rgb: vec![[1.0; 3]; 32] };
    Scene {
        meshes: vec![Arc::new(mesh)],
        materials: vec![material],
        instances: vec![instance(1, DAffine3::IDENTITY)],
        light: Light { environment: Environment::Map(Arc::new(white)) },
        provenance: Vec::new(),
    }
}

fn instance(id: u32, world_from_mesh: DAffine3) -> Instance {
    Instance {
        id: InstanceId(id),
        class: Class::Void,
        mesh: 0,
        materials: vec![0],
        world_from_mesh,
        world_from_mesh_previous: Some(world_from_mesh),
        world_from_mesh_next: Some(world_from_mesh),
        object: None,
    }
}

/// Turned, mirrored and stretched balls.
fn crowd() -> Scene {
    let mut scene = scene(ball(), Material { coat: 1.0, ..Material::plain("paint", vec3(0.6, 0.1, 0.1), 0.4) });
    for i in 1..6u32 {
        let turn = DQuat::from_rotation_y(f64::from(i));
        let size = DVec3::new(0.2, 0.3, if i % 2 == 0 { 0.2 } else { -0.4 });
        let place = DVec3::new(0.2 * f64::from(i) - 0.6, -0.5, 0.3);
        scene.instances.push(instance(i + 1, DAffine3::from_scale_rotation_translation(size, turn, place)));
    }
    scene
}

/// Radius 1.
fn ball() -> Mesh {
    let (rings, sides) = (24u32, 48u32);
    let mut mesh = Mesh::default();
    for ring in 0..=rings {
        for side in 0..=sides {
            let (sin, cos) = (ring as f32 / rings as f32 * std::f32::consts::PI).sin_cos();
            let (y, x) = (side as f32 / sides as f32 * std::f32::consts::TAU).sin_cos();
            mesh.positions.push(vec3(sin * x, sin * y, -cos));
        }
    }
    for ring in 0..rings {
        for side in 0..sides {
            let a = ring * (sides + 1) + side;
            let b = a + sides + 1;
            mesh.triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
        }
    }
    mesh
}

/// The square |x|, |z| ≤ 1 in the plane y = 0.
fn wall() -> Mesh {
    Mesh {
        positions: vec![vec3(-1.0, 0.0, -1.0), vec3(1.0, 0.0, -1.0), vec3(1.0, 0.0, 1.0), vec3(-1.0, 0.0, 1.0)],
        uvs: vec![Vec2::ZERO, vec2(1.0, 0.0), Vec2::ONE, vec2(0.0, 1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// The cube |x|, |y|, |z| ≤ `half`.
fn cube(half: f32) -> Mesh {
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        for side in [-half, half] {
            let base = mesh.positions.len() as u32;
            for (u, v) in [(-half, -half), (half, -half), (half, half), (-half, half)] {
                let mut p = Vec3::ZERO;
                p[axis] = side;
                p[(axis + 1) % 3] = u;
                p[(axis + 2) % 3] = v;
                mesh.positions.push(p);
            }
            mesh.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
        }
    }
    mesh
}

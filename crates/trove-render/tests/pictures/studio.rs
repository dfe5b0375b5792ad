//! What the tests take pictures with and of: renderers, cameras, shapes.

use std::sync::{Arc, LazyLock};

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec2, Vec3, vec2, vec3};
use trove_model::{
    Camera, Class, Distortion, Environment, EnvironmentMap, Instance, InstanceId, Lens, Light, Material, Mesh, Pose,
    Raster, Scene, Seed, Shot, World,
};
use trove_render::{Denoising, DeviceChoice, KernelChoice, Renderer, RendererOptions};

/// Linear radiance.
pub(crate) type Picture = Raster<[f32; 3]>;

/// The built-in kernel, and Embree where `TROVE_EMBREE` says that there is one.
pub(crate) fn kernels() -> impl Iterator<Item = KernelChoice> {
    let embree = std::env::var_os("TROVE_EMBREE").map(|_| KernelChoice::Embree);
    [KernelChoice::Obvhs].into_iter().chain(embree)
}

pub(crate) fn renderer(kernel: KernelChoice, threads: usize) -> Renderer {
    Renderer::new(&options(kernel, threads)).unwrap()
}

fn options(kernel: KernelChoice, threads: usize) -> RendererOptions {
    let search = std::env::var_os("TROVE_EMBREE").map(Into::into).into_iter().collect();
    RendererOptions { kernel, denoise: Denoising::None, threads, search, ..Default::default() }
}

/// 16×16 pixels from `eye` towards `target`, `half_width_m` of which are seen to each side there.
pub(crate) fn shot(eye: DVec3, target: DVec3, half_width_m: f64) -> Shot {
    let forward = (target - eye).normalize();
    let right = forward.cross(if forward.z.abs() < 0.99 { DVec3::Z } else { DVec3::Y }).normalize();
    let rotation = DQuat::from_mat3(&DMat3::from_cols(right, forward.cross(right), forward));
    let f = 8.0 * eye.distance(target) / half_width_m;
    let lens =
        Lens { width_px: 16, height_px: 16, fx_px: f, fy_px: f, cx_px: 8.0, cy_px: 8.0, distortion: Distortion::None };
    Shot { seed: Seed(1), ..Shot::new("test", lens, Pose::<World, Camera>::new(rotation, eye)) }
}

/// The built-in kernel, and what a card runs.
static BOTH: LazyLock<[Renderer; 2]> = LazyLock::new(|| [renderer(KernelChoice::Obvhs, 2), emulated()]);

/// What a card runs, run by the processor.
pub(crate) fn emulated() -> Renderer {
    let options = RendererOptions { device: DeviceChoice::Emulated, ..options(KernelChoice::Obvhs, 2) };
    Renderer::new(&options).unwrap()
}

/// A picture; by the way some samples of it show that a card would see the same.
pub(crate) fn take(renderer: &Renderer, scene: &Scene, shot: &Shot) -> Picture {
    let few = Shot { spp: shot.spp.min(2), noise: 0.0, ..shot.clone() };
    let captures = BOTH.each_ref().map(|r| r.render(&r.prepare(scene).unwrap(), &few, true, &|_| false).unwrap());
    let beyond = captures[1].stats.refused.is_some();
    let [ours, theirs] = captures.map(|capture| capture.color.unwrap().radiance);
    for (here, there) in ours.data.iter().zip(&theirs.data) {
        let [here, there] = [here, there].map(|rgb| Vec3::from(*rgb));
        // Panes in another order round otherwise.
        assert!((there - here).length() <= 1e-4 * here.length(), "{there} instead of {here}");
    }
    let is_empty = scene.meshes.iter().all(|mesh| mesh.triangles.is_empty());
    assert_eq!(beyond, is_empty);

    let prepared = renderer.prepare(scene).unwrap();
    renderer.render(&prepared, shot, true, &|_| false).unwrap().color.unwrap().radiance
}

pub(crate) fn mean(picture: &Picture) -> f32 {
    picture.data.iter().flatten().sum::<f32>() / (3 * picture.data.len()) as f32
}

/// A scene without anything in it.
pub(crate) fn empty(environment: EnvironmentMap) -> Scene {
    Scene {
        meshes: Vec::new(),
        materials: Vec::new(),
        instances: Vec::new(),
        others: Default::default(),
        keyframes_apart_s: [0.5; 2],
        light: Light::clear(Environment::Map(Arc::new(environment))),
        provenance: Vec::new(),
    }
}

/// Puts one more thing into a scene.
pub(crate) fn put(scene: &mut Scene, mesh: Mesh, material: Material, world_from_mesh: DAffine3) {
    let instance = Instance {
        id: InstanceId(scene.instances.len() as u32 + 1),
        class: Class::Void,
        mesh: scene.meshes.len(),
        materials: vec![scene.materials.len()],
        world_from_mesh,
        previous: None,
        next: None,
        object: None,
    };
    scene.instances.push(instance.at_rest());
    scene.meshes.push(Arc::new(mesh));
    scene.materials.push(material);
}

/// Surroundings of the same radiance all around.
pub(crate) fn uniform(radiance: f32) -> EnvironmentMap {
    EnvironmentMap { name: "uniform".into(), width: 8, height: 4, rgb: vec![[radiance; 3]; 32] }
}

/// Radius 1.
pub(crate) fn ball() -> Mesh {
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

/// The square |x|, |z| ≤ 1 in the plane y = 0, its front to the south.
pub(crate) fn wall() -> Mesh {
    Mesh {
        positions: vec![vec3(-1.0, 0.0, -1.0), vec3(1.0, 0.0, -1.0), vec3(1.0, 0.0, 1.0), vec3(-1.0, 0.0, 1.0)],
        uvs: vec![Vec2::ZERO, vec2(1.0, 0.0), Vec2::ONE, vec2(0.0, 1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// The cube |x|, |y|, |z| ≤ 1, its front outside.
pub(crate) fn cube() -> Mesh {
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let base = mesh.positions.len() as u32;
            for (u, v) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                let mut p = Vec3::ZERO;
                p[axis] = side;
                p[(axis + 1) % 3] = u * side;
                p[(axis + 2) % 3] = v;
                mesh.positions.push(p);
            }
            mesh.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
        }
    }
    mesh
}

/// The same shape with its front inside.
pub(crate) fn inside_out(mut mesh: Mesh) -> Mesh {
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    mesh
}

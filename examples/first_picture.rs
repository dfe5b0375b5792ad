//! A box of a car's size on a field: a scene, a camera, a picture and its labels, without a dataset.
//!
//! ```sh
//! cargo run --release -p trove --example first_picture -- first_picture.png
//! ```

use std::path::PathBuf;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use trove_model::{
    Class, Distortion, Environment, Instance, InstanceId, Lens, Light, Material, Mesh, PhysicalSky, Pose, Scene, Shot,
};
use trove_render::{Renderer, RendererOptions};

const CAR: InstanceId = InstanceId(1);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let out = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("first_picture.png"), PathBuf::from);

    // World is in metres, x east, y north, z up. The box stands at the origin and points east.
    let scene = Scene {
        meshes: vec![Arc::new(ground(200.0)), Arc::new(cuboid(Vec3::new(4.5, 1.8, 1.5)))],
        materials: vec![
            Material::plain("dry grass", Vec3::new(0.24, 0.22, 0.1), 0.95),
            Material { coat: 1.0, flakes: 0.4, ..Material::plain("red paint", Vec3::new(0.5, 0.02, 0.02), 0.4) },
        ],
        instances: vec![standing(InstanceId(0), Class::Ground, 0), standing(CAR, Class::Car, 1)],
        others: Default::default(),
        keyframes_apart_s: [f64::INFINITY; 2],
        light: Light::clear(Environment::Sky(PhysicalSky {
            to_sun: DVec3::new(-0.5, -0.6, 0.6).normalize(),
            moon: None,
            turbidity: 3.0,
            ground_albedo: 0.2,
            cloud_cover: 0.2,
            cloud_seed: 7,
        })),
        provenance: Vec::new(),
    };

    let lens = Lens {
        width_px: 480,
        height_px: 270,
        fx_px: 400.0,
        fy_px: 400.0,
        cx_px: 240.0,
        cy_px: 135.0,
        distortion: Distortion::None,
    };
    let camera = looking_at(DVec3::new(-7.0, -5.0, 1.7), DVec3::new(0.0, 0.0, 0.75));
    let shot = Shot { spp: 64, ..Shot::new("front", lens, camera) };

    // Embree and Open Image Denoise are used where the system has them.
    let renderer = Renderer::new(&RendererOptions::default())?;
    let prepared = renderer.prepare(&scene)?;
    let capture = renderer.render(&prepared, &shot, true, &|_share| false).ok_or("the rendering was stopped")?;
    let color = capture.color.ok_or("no light was asked for")?;
    trove_write::write_picture(&out, &color.srgb)?;

    let labels = &capture.labels;
    let of_car = || (0..labels.instance.data.len()).filter(|&i| labels.instance.data[i] == CAR.0);
    let nearest_m = of_car().map(|i| labels.depth_m.data[i]).fold(f32::INFINITY, f32::min);
    println!("{}: {} pixels show the box, the nearest {nearest_m:.2} m away", out.display(), of_car().count());
    Ok(())
}

/// A mesh that stands where it was modelled, at all times.
fn standing(id: InstanceId, class: Class, index: usize) -> Instance {
    Instance {
        id,
        class,
        mesh: index,
        materials: vec![index],
        world_from_mesh: DAffine3::IDENTITY,
        previous: None,
        next: None,
        object: None,
    }
    .at_rest()
}

/// A level square around the origin.
fn ground(side_m: f32) -> Mesh {
    let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0) * side_m / 2.0;
    Mesh {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// A box on the ground; corner `i` is at the far side of an axis where that axis's bit of `i` is set.
fn cuboid(size_m: Vec3) -> Mesh {
    let side = |i: u8, bit: u8| f32::from(i >> bit & 1);
    let corner = |i: u8| (Vec3::new(side(i, 0), side(i, 1), side(i, 2)) - Vec3::new(0.5, 0.5, 0.0)) * size_m;
    // Counter-clockwise seen from outside: bottom, top, south, north, west, east.
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Mesh {
        positions: (0..8).map(corner).collect(),
        triangles: faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..Mesh::default()
    }
}

/// A camera (x right, y down, z forward) that holds its horizon level.
fn looking_at(position: DVec3, target: DVec3) -> Pose<trove_model::World, trove_model::Camera> {
    let forward = (target - position).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let axes = DMat3::from_cols(right, forward.cross(right), forward);
    Pose::new(DQuat::from_mat3(&axes), position)
}

//! What moves while the shutter is open, and what does not.

#![allow(clippy::unwrap_used)] // clippy knows the tests in here, not what they call

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use trove_model::{
    Class, Distortion, Environment, EnvironmentMap, Instance, InstanceId, Lens, Light, Material, Mesh, Placement, Pose,
    Scene, Seed, Shot, Shutter,
};
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};

const LENS: Lens = Lens {
    width_px: 80,
    height_px: 60,
    fx_px: 60.0,
    fy_px: 60.0,
    cx_px: 40.0,
    cy_px: 30.0,
    distortion: Distortion::None,
};

/// Far from the origin, where single precision has coarse steps.
const PLACE: DVec3 = DVec3::new(812.3, -1033.7, 14.0);
const AWAY_M: f64 = 10.0;

#[test]
fn a_passing_edge_is_blurred_as_wide_as_it_moves_while_it_is_exposed() {
    // 20 m/s for 0.1 s are 2 m: 12 px at 10 m.
    let passing = passing(DVec3::X * 20.0);
    for kernel in kernels() {
        let width = |exposure_s: f64| {
            let light = lights(&passing, &shot(Shutter { exposure_s, ..Shutter::INSTANT }), kernel);
            let column = |x: usize| (15..45).map(|y| light[y][x]).sum::<f64>();
            // Twice the distance between the quarters of the rise; an even blur is a straight rise.
            let share = |x: usize| (column(x) - column(26)) / (column(56) - column(26));
            let crossing = |level: f64| {
                let x = (26..56).find(|&x| share(x + 1) >= level).unwrap();
                x as f64 + (level - share(x)) / (share(x + 1) - share(x))
            };
            (2.0 * (crossing(0.75) - crossing(0.25)), crossing(0.5))
        };
        let ((sharp, at), (blurred, blurred_at)) = (width(0.0), width(0.1));
        assert!(sharp < 2.0 && (blurred - 12.0).abs() < 0.8, "{kernel:?}: {sharp} px, then {blurred} px instead of 12");
        assert!((at - blurred_at).abs() < 0.3, "{kernel:?}: the middle stays: {at}, {blurred_at}");
    }
}

#[test]
fn a_passing_edge_is_sheared_by_a_rolling_shutter() {
    let passing = passing(DVec3::X * 20.0);
    for kernel in kernels() {
        let light = lights(&passing, &shot(Shutter { readout_s: 0.1, ..Shutter::INSTANT }), kernel);
        // The dark square is at the left: the later a row, the more of it is dark.
        let edge = |y: usize| (20..60).map(|x| 1.0 - light[y][x].min(1.0)).sum::<f64>();
        let sheared = edge(50) - edge(10);
        assert!((sheared - 12.0 * 40.0 / 60.0).abs() < 0.5, "{kernel:?}: {sheared} px instead of 8");
    }
}

#[test]
fn what_turns_is_blurred_at_its_ends_alike_by_all_kernels() {
    let plate = |angle: f64| {
        let size = DVec3::new(6.0, 1.0, 0.5);
        DAffine3::from_scale_rotation_translation(size, DQuat::from_rotation_y(angle), PLACE + DVec3::Y * AWAY_M)
    };
    let scene = scene(plate(0.0), [Some(plate(-1.0)), Some(plate(1.0))]);
    let picture =
        |exposure_s: f64, kernel| lights(&scene, &shot(Shutter { exposure_s, ..Shutter::INSTANT }), kernel).concat();
    let sum_of_differences = |a: &[f64], b: &[f64], columns: std::ops::Range<usize>| -> f64 {
        (0..a.len()).filter(|i| columns.contains(&(i % 80))).map(|i| (a[i] - b[i]).abs()).sum()
    };
    let built_in = picture(0.1, KernelChoice::Obvhs);
    for kernel in kernels() {
        let (still, blurred) = (picture(0.0, kernel), picture(0.1, kernel));
        let [axis, ends] = [38..42, 52..56].map(|columns| sum_of_differences(&still, &blurred, columns));
        assert!(ends > 2.0 && axis < 0.3 * ends, "{kernel:?}: {axis} near the axis, {ends} at an end");
        let apart = sum_of_differences(&built_in, &blurred, 0..80);
        assert!(apart < 1.0, "{kernel:?}: {apart} from the built-in one");
    }
}

#[test]
fn labels_know_nothing_of_the_shutter() {
    let passing = passing(DVec3::new(20.0, 3.0, 1.0));
    for kernel in kernels() {
        let labels = |shutter: Shutter, scene: &Scene| {
            let renderer = renderer(kernel, 2);
            let prepared = renderer.prepare(scene).unwrap();
            renderer.render(&prepared, &shot(shutter), false, &|_| false).unwrap().labels
        };
        let open = Shutter { exposure_s: 0.05, readout_s: 0.05 };
        let [instant, exposed] = [Shutter::INSTANT, open].map(|shutter| labels(shutter, &passing));
        assert_eq!(format!("{instant:?}"), format!("{exposed:?}"));
        let mut standing = passing.clone();
        standing.keyframes_apart_s = [f64::INFINITY; 2];
        let standing = labels(Shutter::INSTANT, &standing);
        assert_eq!(format!("{:?}", standing.depth_m), format!("{:?}", exposed.depth_m));
        assert_eq!(format!("{:?}", standing.normal), format!("{:?}", exposed.normal));
    }
}

#[test]
fn where_nothing_moves_the_shutter_changes_no_byte() {
    let open = Shutter { exposure_s: 0.03, readout_s: 0.05 };
    for kernel in kernels() {
        let [instant, exposed] =
            [Shutter::INSTANT, open].map(|shutter| lights(&passing(DVec3::ZERO), &shot(shutter), kernel));
        assert!(instant == exposed, "{kernel:?}");
    }
}

#[test]
fn one_thread_and_two_blur_alike() {
    let scene = passing(DVec3::new(9.0, -4.0, 2.0));
    let shot = shot(Shutter { exposure_s: 0.05, readout_s: 0.03 });
    for kernel in kernels() {
        let [one, two] = [1, 2].map(|threads| radiance(&scene, &shot, &renderer(kernel, threads)));
        assert!(one == two, "{kernel:?}");
    }
}

/// A dark square of 20 m whose right edge passes the middle of the view.
fn passing(velocity_mps: DVec3) -> Scene {
    let at = |time_s: f64| {
        let place = PLACE + DVec3::new(-10.0, AWAY_M, 0.0) + velocity_mps * time_s;
        DAffine3::from_scale_rotation_translation(DVec3::new(20.0, 1.0, 20.0), DQuat::IDENTITY, place)
    };
    scene(at(0.0), [Some(at(-0.5)), Some(at(0.5))])
}

/// One thing, a square of side 1 in its x and z, under a white sky.
fn scene(world_from_mesh: DAffine3, [previous, next]: [Option<DAffine3>; 2]) -> Scene {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let square = Mesh {
        positions: corners.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let sky = EnvironmentMap { name: "white".into(), width: 2, height: 1, rgb: vec![[1.0; 3]; 2] };
    let placed = |world_from_mesh| Placement { mesh: 0, world_from_mesh };
    Scene {
        meshes: vec![Arc::new(square)],
        materials: vec![Material::plain("dark", Vec3::ZERO, 1.0)],
        instances: vec![Instance {
            id: InstanceId(0),
            class: Class::Car,
            mesh: 0,
            materials: vec![0],
            world_from_mesh,
            previous: previous.map(placed),
            next: next.map(placed),
            object: None,
        }],
        others: Default::default(),
        keyframes_apart_s: [0.5; 2],
        light: Light::clear(Environment::Map(Arc::new(sky))),
        provenance: Vec::new(),
    }
}

/// A camera that stands and looks north.
fn shot(shutter: Shutter) -> Shot {
    let rotation = DQuat::from_mat3(&DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y));
    let world_from_camera = Pose::new(rotation, PLACE);
    Shot {
        world_from_camera_previous: Some(world_from_camera),
        world_from_camera_next: Some(world_from_camera),
        shutter,
        spp: 16,
        seed: Seed(1),
        ..Shot::new("test", LENS, world_from_camera)
    }
}

/// The built-in one, and Embree where `TROVE_EMBREE` says that there is one.
fn kernels() -> Vec<KernelChoice> {
    let embree = std::env::var_os("TROVE_EMBREE").map(|_| KernelChoice::Embree);
    [KernelChoice::Obvhs].into_iter().chain(embree).collect()
}

fn options(kernel: KernelChoice, threads: usize) -> RendererOptions {
    let search = std::env::var_os("TROVE_EMBREE").into_iter().map(Into::into).collect();
    RendererOptions { kernel, denoise: Denoising::None, threads, search, ..Default::default() }
}

fn renderer(kernel: KernelChoice, threads: usize) -> Renderer {
    Renderer::new(&options(kernel, threads)).unwrap()
}

fn radiance(scene: &Scene, shot: &Shot, renderer: &Renderer) -> Vec<[f32; 3]> {
    let prepared = renderer.prepare(scene).unwrap();
    renderer.render(&prepared, shot, true, &|_| false).unwrap().color.unwrap().radiance.data
}

/// Green, row by row.
fn lights(scene: &Scene, shot: &Shot, kernel: KernelChoice) -> Vec<Vec<f64>> {
    let radiance = radiance(scene, shot, &renderer(kernel, 2));
    radiance.chunks(LENS.width_px as usize).map(|row| row.iter().map(|p| f64::from(p[1])).collect()).collect()
}

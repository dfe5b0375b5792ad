//! Where points go between keyframes: each against its own projection.

#![allow(clippy::unwrap_used)] // clippy knows the tests in here, not what they call

mod solids;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, Vec3};
use solids::{ball, cube};
use trove_model::{
    Camera, Class, Distortion, Environment, EnvironmentMap, Instance, InstanceId, Lens, Light, Material, Mesh,
    Occlusion, Placement, Pose, Scene, Shot, World,
};
use trove_render::{Denoising, KernelChoice, RenderError, Renderer, RendererOptions};

const LENS: Lens = Lens {
    width_px: 96,
    height_px: 64,
    fx_px: 70.0,
    fy_px: 70.0,
    cx_px: 47.3,
    cy_px: 32.6,
    distortion: Distortion::None,
};

/// Far from the origin, where single precision has coarse steps.
const PLACE: DVec3 = DVec3::new(812.3, -1033.7, 14.0);

/// Indices of the test meshes.
const CUBE: usize = 0;
const BODY: usize = 1;
const BODY_THEN: usize = 2;

#[test]
fn each_point_of_a_body_that_takes_another_posture_flows_to_where_it_is_then() {
    let now = DAffine3::from_rotation_translation(DQuat::from_rotation_z(0.4), PLACE + DVec3::Y * 5.0);
    let then = DAffine3::from_rotation_translation(DQuat::from_rotation_z(0.7), PLACE + DVec3::new(0.6, 5.4, 0.05));
    let body = Instance {
        next: Some(Placement { mesh: BODY_THEN, world_from_mesh: then }),
        previous: Some(Placement { mesh: BODY_THEN, world_from_mesh: then }),
        ..thing(1, BODY, now)
    };
    let scene = scene(vec![body]);
    let at_eye = camera(PLACE);
    let beside = camera(PLACE + DVec3::new(0.3, 0.1, 0.0));
    let middle = |mesh: usize, triangle: usize, world_from_mesh: DAffine3| {
        let corner = |i: u32| scene.meshes[mesh].positions[i as usize].as_dvec3();
        let [a, b, c] = scene.meshes[mesh].triangles[triangle].map(corner);
        world_from_mesh.transform_point3(a * 0.2 + b * 0.5 + c * 0.3)
    };
    let mut seen = 0;
    for renderer in renderers() {
        let prepared = renderer.prepare(&scene).unwrap();
        for triangle in 0..scene.meshes[BODY].triangles.len() {
            let point = middle(BODY, triangle, now);
            // A picture of one pixel, whose centre shows the point.
            let to = LENS.project(at_eye.inverse().point(point)).unwrap();
            let lens = Lens {
                width_px: 1,
                height_px: 1,
                cx_px: LENS.cx_px + 0.5 - to.x,
                cy_px: LENS.cy_px + 0.5 - to.y,
                ..LENS
            };
            let shot = Shot {
                world_from_camera_next: Some(beside),
                world_from_camera_previous: Some(beside),
                ..Shot::new("test", lens, at_eye)
            };
            let labels = renderer.render(&prepared, &shot, false, &|_| false).unwrap().labels;
            if (f64::from(labels.depth_m.data[0]) - at_eye.inverse().point(point).z).abs() > 1e-3 {
                continue; // another side of the body hides it
            }
            seen += 1;
            let expected = lens.project(beside.inverse().point(middle(BODY_THEN, triangle, then))).unwrap() - 0.5;
            for flow in [labels.flow_forward.data[0], labels.flow_backward.data[0]] {
                let off = DVec2::from_array(flow.map(f64::from)) - expected;
                assert!(off.length() < 1e-3, "triangle {triangle}: {flow:?} instead of {expected}");
            }
        }
    }
    assert!(seen > 60, "{seen} points");
}

#[test]
fn a_posture_with_other_triangles_is_refused() {
    let now = DAffine3::from_translation(PLACE);
    let next = Some(Placement { mesh: CUBE, world_from_mesh: now });
    let error = renderers()[0].prepare(&scene(vec![Instance { next, ..thing(1, BODY, now) }])).err().unwrap();
    assert!(matches!(error, RenderError::Scene { expected, .. } if expected.contains("triangles")), "{error}");
}

/// A box that stands along the axes: its id, its middle now and then, and its size.
#[derive(Clone, Copy)]
struct Block {
    id: u32,
    now: Option<DVec3>,
    then: Option<DVec3>,
    size: DVec3,
}

#[test]
fn what_is_behind_something_else_then_or_out_of_the_picture_is_hidden() {
    let there = |id, x: f64, y: f64, size: DVec3| {
        let middle = Some(PLACE + DVec3::new(x, y, 0.0));
        Block { id, now: middle, then: middle, size }
    };
    let wall = there(1, 0.0, 20.0, DVec3::new(60.0, 0.5, 40.0));
    let still = there(2, 0.5, 8.0, DVec3::splat(2.0));
    let moved = |to: Option<DVec3>| Block { then: to.map(|to| PLACE + to), ..still };
    let carrier = there(9, 0.0, 0.0, DVec3::new(2.0, 3.0, 1.0));
    let cases: [(&str, Vec<Block>); 6] = [
        ("the camera alone moves", vec![wall, still]),
        ("the box moves aside", vec![wall, moved(Some(DVec3::new(-3.0, 7.0, 1.0)))]),
        ("the box leaves", vec![wall, moved(None)]),
        ("the box comes", vec![wall, Block { now: None, ..still }]),
        (
            "the box comes nearer, the wall goes back",
            vec![Block { then: wall.now.map(|p| p + DVec3::Y * 5.0), ..wall }, moved(Some(DVec3::new(0.0, 4.0, 0.0)))],
        ),
        (
            "the carrier, in which the camera is, is looked through",
            vec![wall, still, Block { then: carrier.now.map(|p| p + DVec3::X * 1.5), ..carrier }],
        ),
    ];
    for (case, blocks) in cases {
        let counts = hidden_and_seen(case, &blocks);
        assert!(counts[0] > 200 && counts[1] > 2000, "{case}: {counts:?}");
    }
}

/// Renders blocks and compares their occlusion, forward and backward, with that of the boxes themselves; returns how many
/// pixels are hidden and seen.
fn hidden_and_seen(case: &str, blocks: &[Block]) -> [usize; 2] {
    let (eye, eye_then) = (camera(PLACE), camera(PLACE + DVec3::X * 1.5));
    let at =
        |block: &Block, middle: DVec3| DAffine3::from_scale_rotation_translation(block.size, DQuat::IDENTITY, middle);
    let placed = |block: &Block| Some(Placement { mesh: CUBE, world_from_mesh: at(block, block.then?) });
    let now = blocks.iter().filter_map(|block| {
        let then = placed(block);
        Some(Instance { previous: then, next: then, ..thing(block.id, CUBE, at(block, block.now?)) })
    });
    let only_then = blocks.iter().filter(|block| block.now.is_none());
    let others: Vec<Instance> = only_then.filter_map(|b| Some(thing(b.id, CUBE, at(b, b.then?)))).collect();
    let scene = Scene { others: [others.clone(), others], ..scene(now.collect()) };
    let shot = Shot {
        world_from_camera_next: Some(eye_then),
        world_from_camera_previous: Some(eye_then),
        carrier: Some(InstanceId(9)),
        ..Shot::new("test", LENS, eye)
    };
    let mut counts = [0; 2];
    for renderer in renderers() {
        let prepared = renderer.prepare(&scene).unwrap();
        let labels = renderer.render(&prepared, &shot, false, &|_| false).unwrap().labels;
        assert_eq!(labels.occluded_forward, labels.occluded_backward, "{case}");
        for i in 0..labels.depth_m.data.len() as u32 {
            let (x, y) = (i % LENS.width_px, i / LENS.width_px);
            let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let found = *labels.occluded_forward.at(x, y);
            let id = *labels.instance.at(x, y);
            let direction = LENS.unproject(pixel).unwrap();
            let Some(block) = blocks.iter().find(|block| block.id == id) else {
                // Sky: the first camera's direction, seen from the second.
                let ways = blocks
                    .iter()
                    .filter(|b| b.id != 9)
                    .map(|b| entry(b, eye_then.translation, eye.vector(direction) * 1e6));
                let blocked = ways.flatten().count() > 0;
                assert_eq!(found == Occlusion::Hidden, blocked, "{case}: sky at ({x}, {y})");
                continue;
            };
            let Some(then) = block.then else {
                assert_eq!(found, Occlusion::Undefined, "{case}: ({x}, {y})");
                continue;
            };
            let point = eye.point(direction / direction.z * f64::from(*labels.depth_m.at(x, y)));
            let way = point + then - block.now.unwrap() - eye_then.translation;
            let to = LENS.project(eye_then.inverse().vector(way)).unwrap();
            let is_inside =
                to.cmpge(DVec2::ZERO).all() && to.x < f64::from(LENS.width_px) && to.y < f64::from(LENS.height_px);
            let entries = blocks.iter().filter(|b| b.id != 9).filter_map(|b| entry(b, eye_then.translation, way));
            let first = entries.fold(1.0, f64::min);
            let expected = match first {
                _ if !is_inside => Occlusion::Hidden,
                0.999.. => Occlusion::Seen,
                ..0.8 => Occlusion::Hidden,
                // Within a pixel's extent.
                _ => continue,
            };
            assert_eq!(found, expected, "{case}: ({x}, {y}) of {id}, {first}");
            counts[usize::from(found == Occlusion::Seen)] += 1;
        }
    }
    counts
}

/// After which share of its way a ray enters a block then; `None` where it does not.
fn entry(block: &Block, eye: DVec3, way: DVec3) -> Option<f64> {
    let (low, high) = (block.then? - block.size / 2.0 - eye, block.then? + block.size / 2.0 - eye);
    let (a, b) = (low / way, high / way);
    let (enters, leaves) = (a.min(b).max_element(), a.max(b).min_element());
    (enters < leaves && enters > 0.0 && enters < 1.0).then_some(enters)
}

/// The built-in kernel, and Embree where `TROVE_EMBREE` says that there is one.
fn renderers() -> Vec<Renderer> {
    let embree = std::env::var_os("TROVE_EMBREE").map(|_| KernelChoice::Embree);
    let made = |kernel| {
        let search = std::env::var_os("TROVE_EMBREE").map(Into::into).into_iter().collect();
        Renderer::new(&RendererOptions { kernel, denoise: Denoising::None, threads: 2, search, ..Default::default() })
            .unwrap()
    };
    [KernelChoice::Obvhs].into_iter().chain(embree).map(made).collect()
}

/// A camera that looks north.
fn camera(position: DVec3) -> Pose<World, Camera> {
    Pose::new(DQuat::from_mat3(&DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y)), position)
}

/// What stands still.
fn thing(id: u32, mesh: usize, world_from_mesh: DAffine3) -> Instance {
    let thing = Instance {
        id: InstanceId(id),
        class: Class::Human,
        mesh,
        materials: vec![0],
        world_from_mesh,
        previous: None,
        next: None,
        object: None,
    };
    thing.at_rest()
}

fn scene(instances: Vec<Instance>) -> Scene {
    let sky = EnvironmentMap { name: "white".into(), width: 2, height: 1, rgb: vec![[1.0; 3]; 2] };
    // A limb that bends, swells and turns about itself, facet by facet.
    let body = ball(8);
    let moved = |p: &Vec3| {
        let (sin, cos) = (0.9 * p.z).sin_cos();
        Vec3::new(cos * p.x - sin * p.y + 0.3 * p.z * p.z, sin * p.x + cos * p.y, p.z * (1.0 - 0.2 * p.x))
    };
    let then = Mesh { positions: body.positions.iter().map(moved).collect(), ..body.clone() };
    Scene {
        meshes: [cube(), body, then].map(Arc::new).to_vec(),
        materials: vec![Material::default()],
        instances,
        others: Default::default(),
        keyframes_apart_s: [0.5; 2],
        light: Light::clear(Environment::Map(Arc::new(sky))),
        provenance: Vec::new(),
    }
}

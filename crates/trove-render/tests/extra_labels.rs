//! Labels that are made where they are asked for, against closed forms.

#![allow(clippy::unwrap_used)] // clippy knows the tests in here, not what they call

mod solids;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, Vec3};
use solids::{ball, cube};
use trove_model::{
    Body, Camera, Class, Cuboid, Distortion, Environment, EnvironmentMap, ExtraLabel, ExtraLabels, GlassLabels,
    Instance, InstanceId, Kind, LabelSettings, Labels, Lens, Light, Material, Mesh, Occlusion, Origin, Placement, Pose,
    Raster, Role, Scene, SceneObject, Shot, World,
};
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};

const LENS: Lens = Lens {
    width_px: 96,
    height_px: 64,
    fx_px: 70.0,
    fy_px: 71.0,
    cx_px: 47.3,
    cy_px: 30.6,
    distortion: Distortion::None,
};

/// Far from the origin, where single precision has coarse steps.
const PLACE: DVec3 = DVec3::new(812.3, -1033.7, 14.0);

/// Indices of the test meshes.
const GROUND: usize = 0;
const BALL: usize = 1;
const CUBE: usize = 2;
const SHEET: usize = 3;

/// Indices of the test materials.
const BRICK: usize = 0;
const PANE: usize = 1;
const METAL: usize = 2;
const WET: usize = 3;

#[test]
fn range_is_along_the_ray_and_world_normals_are_turned_camera_normals() {
    let ground = stuff(GROUND, PLACE - DVec3::Z * 1.6);
    let middle = PLACE + DVec3::new(0.2, 6.0, 0.1);
    let wanted = [ExtraLabel::Range, ExtraLabel::NormalWorld];
    for labels in by_all_kernels(&scene(vec![ground, stuff(BALL, middle)]), &shot(&wanted)) {
        let (range, normal) = (labels.extra.range_m.unwrap(), labels.extra.normal_world.unwrap());
        let eye = camera(PLACE);
        let (mut on_ground, mut on_ball) = (0, 0);
        for (x, y, centre) in centres() {
            let direction_camera = LENS.unproject(centre).unwrap();
            let direction = eye.vector(direction_camera);
            let (range_m, depth_m) = (f64::from(*range.at(x, y)), f64::from(*labels.depth_m.at(x, y)));
            let normal_world = Vec3::from(*normal.at(x, y)).as_dvec3();
            if depth_m.is_infinite() {
                assert_eq!((range_m, normal_world), (f64::INFINITY, DVec3::ZERO));
                continue;
            }
            assert!((range_m * direction_camera.z / depth_m - 1.0).abs() < 1e-6, "({x}, {y})");
            let turned = eye.vector(Vec3::from(*labels.normal.at(x, y)).as_dvec3());
            assert!((turned - normal_world).length() < 1e-6, "({x}, {y}): {turned} {normal_world}");
            if normal_world.z > 0.999_99 {
                on_ground += 1;
                assert!((range_m / (-1.6 / direction.z) - 1.0).abs() < 1e-6, "({x}, {y})");
                assert!((normal_world - DVec3::Z).length() < 1e-6);
            }
            // |direction · t − to_middle| = 1
            let b = direction.dot(middle - PLACE);
            let root = b * b - (middle - PLACE).length_squared() + 1.0;
            if root > 0.3 {
                on_ball += 1;
                let t = b - root.sqrt();
                assert!((range_m - t).abs() < 1e-4, "{range_m} instead of {t}");
                assert!(normal_world.dot(PLACE + direction * t - middle) > 0.9999);
            }
        }
        assert!(on_ground > 1000 && on_ball > 200, "{on_ground} {on_ball}");
    }
}

/// A box, its placement, and where it is at the next keyframe.
fn moving_box() -> (Instance, Cuboid, DAffine3, DAffine3) {
    let size_m = DVec3::new(4.0, 1.8, 1.5);
    let world_from_body = Pose::<World, Body>::from_yaw(0.6, PLACE + DVec3::new(0.3, 8.0, -0.2));
    let turn = DQuat::from_rotation_z(0.9) * DQuat::from_rotation_y(0.05);
    let to = PLACE + DVec3::new(1.4, 9.0, 0.1);
    let now = DAffine3::from_scale_rotation_translation(size_m, world_from_body.rotation, world_from_body.translation);
    let then = DAffine3::from_scale_rotation_translation(size_m, turn, to);
    let cuboid = Cuboid { world_from_body, size_m };
    let instance = Instance {
        world_from_mesh: now,
        previous: None,
        next: Some(Placement { mesh: CUBE, world_from_mesh: then }),
        ..object(5, CUBE, cuboid)
    };
    (instance, cuboid, now, then)
}

#[test]
fn object_coordinates_go_from_0_to_1_along_the_axes_of_the_box() {
    let (thing, cuboid, ..) = moving_box();
    let wanted = [ExtraLabel::ObjectCoordinates, ExtraLabel::Range];
    for labels in by_all_kernels(&scene(vec![thing, stuff(GROUND, PLACE - DVec3::Z * 1.6)]), &shot(&wanted)) {
        let (points, range) = (labels.extra.object_coordinates.unwrap(), labels.extra.range_m.unwrap());
        let mut on_faces = [0; 6];
        for (x, y, centre) in centres() {
            let found = Vec3::from(*points.at(x, y)).as_dvec3();
            if *labels.instance.at(x, y) != 5 {
                assert!(found.is_nan_mask().all(), "({x}, {y}): {found}");
                continue;
            }
            // The corner at the back, right and bottom is 0, that at the front, left and top 1.
            let corners = cuboid.corners_world();
            let (origin, ends) = (corners[2], [corners[3], corners[1], corners[6]]);
            let point = PLACE + camera(PLACE).vector(LENS.unproject(centre).unwrap()) * f64::from(*range.at(x, y));
            for (axis, end) in ends.into_iter().enumerate() {
                let edge = end - origin;
                let expected = (point - origin).dot(edge) / edge.length_squared();
                assert!((found[axis] - expected).abs() < 1e-5, "({x}, {y}): {found} instead of {expected}");
                for (side, value) in [0.0, 1.0].into_iter().enumerate() {
                    on_faces[2 * axis + side] += usize::from((found[axis] - value).abs() < 1e-5);
                }
            }
            assert!(found.cmpge(DVec3::splat(-1e-5)).all() && found.cmple(DVec3::splat(1.0 + 1e-5)).all());
        }
        // The camera sees the box from the back and the right, at its own height.
        assert!(on_faces[0] > 50 && on_faces[2] > 50 && on_faces[1] < 50 && on_faces[3] < 50, "{on_faces:?}");
    }
}

#[test]
fn scene_flow_is_the_way_of_the_point_in_world() {
    let (thing, _, now, then) = moving_box();
    let things = vec![thing, stuff(GROUND, PLACE - DVec3::Z * 1.6)];
    let wanted = [ExtraLabel::SceneFlowForward, ExtraLabel::SceneFlowBackward, ExtraLabel::Range];
    // No camera at the neighbouring keyframes is needed.
    for labels in by_all_kernels(&scene(things.clone()), &shot(&wanted)) {
        let (forward, backward) = (labels.extra.scene_flow_forward.unwrap(), labels.extra.scene_flow_backward.unwrap());
        let range = labels.extra.range_m.unwrap();
        let (mut moving, mut longest) = (0, 0.0f64);
        for (x, y, centre) in centres() {
            let [there, back] = [&forward, &backward].map(|flow| Vec3::from(*flow.at(x, y)).as_dvec3());
            match (*labels.class.at(x, y), *labels.instance.at(x, y)) {
                (Class::Sky, _) => assert!(there.is_nan_mask().all() && back.is_nan_mask().all()),
                (_, 0) => assert_eq!([there, back], [DVec3::ZERO; 2], "the ground stands"),
                _ => {
                    moving += 1;
                    assert!(back.is_nan_mask().all(), "it was not there");
                    let way = camera(PLACE).vector(LENS.unproject(centre).unwrap()) * f64::from(*range.at(x, y));
                    let expected = (then * now.inverse()).transform_point3(PLACE + way) - PLACE - way;
                    longest = longest.max(there.length());
                    assert!((there - expected).length() < 1e-5, "({x}, {y}): {there} instead of {expected}");
                }
            }
        }
        assert!(moving > 300 && longest > 1.0, "{moving} {longest}");
    }
    let last = Scene { keyframes_apart_s: [0.5, f64::INFINITY], ..scene(things) };
    let labels = look(&last, &shot(&wanted));
    assert!(labels.extra.scene_flow_forward.unwrap().data.iter().all(|way| way[0].is_nan()), "no keyframe follows");
    assert!(labels.extra.scene_flow_backward.unwrap().data.contains(&[0.0; 3]));
}

#[test]
fn coverage_is_the_area_of_the_pixel_on_the_near_side_of_an_edge() {
    for turn in [0.0, 0.1, 0.5, std::f64::consts::FRAC_PI_4, 1.3, 1.571, 2.6, -0.9] {
        // A sheet across the axis, 10 m away, of which one edge runs through the picture.
        let rotation = DQuat::from_rotation_y(turn);
        let edge = DVec3::new(0.13, 10.0, -0.07);
        let sheet = DAffine3::from_scale_rotation_translation(DVec3::splat(60.0), rotation, PLACE + edge);
        let sheet = Instance { world_from_mesh: sheet, ..stuff(SHEET, PLACE) }.at_rest();
        let on_image = |point: DVec3| LENS.project(camera(PLACE).inverse().point(point)).unwrap();
        let [a, b] = [0.0, 1.0].map(|along| on_image(PLACE + edge + rotation * DVec3::Z * along));
        // More than 0 on the sheet's side.
        let inward = on_image(PLACE + edge + rotation * DVec3::X) - a;
        let side = |p: DVec2| (b - a).perp_dot(p - a) * (b - a).perp_dot(inward).signum();
        for labels in by_all_kernels(&scene(vec![sheet.clone()]), &shot(&[ExtraLabel::Coverage])) {
            let coverage = labels.extra.coverage.unwrap();
            let (mut cut, mut off) = (0, 0.0);
            for (x, y, centre) in centres() {
                let is_sheet = *labels.class.at(x, y) == Class::Road;
                assert_eq!(is_sheet, side(centre) > 0.0, "({x}, {y})");
                let area = area_above(DVec2::new(f64::from(x), f64::from(y)), &side);
                let (expected, found) =
                    (if is_sheet { area } else { 1.0 - area }, f64::from(*coverage.at(x, y)) / 255.0);
                assert!((found - expected).abs() < 0.11, "({x}, {y}) at {turn}: {found} instead of {expected}");
                if area > 0.0 && area < 1.0 {
                    cut += 1;
                    off += found - expected;
                } else {
                    assert_eq!(found, 1.0);
                }
            }
            // Along a pixel's side, 16 rays tell 16ths.
            assert!(cut > 50 && (off / f64::from(cut)).abs() < 0.035, "{cut} pixels, off by {off} at {turn}");
        }
    }
}

/// The area of a pixel, by its corner, where a linear function is more than 0.
fn area_above(corner: DVec2, side: &impl Fn(DVec2) -> f64) -> f64 {
    let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].map(|c| corner + c);
    let mut kept = Vec::new();
    for (i, &b) in square.iter().enumerate() {
        let a = square[(i + 3) % 4];
        if (side(a) > 0.0) != (side(b) > 0.0) {
            kept.push(a.lerp(b, side(a) / (side(a) - side(b))));
        }
        if side(b) > 0.0 {
            kept.push(b);
        }
    }
    let twice = |i: usize| (kept[i] - corner).perp_dot(kept[(i + 1) % kept.len()] - corner);
    (0..kept.len()).map(twice).sum::<f64>().abs() * 0.5
}

#[test]
fn albedo_roughness_and_parts_are_the_materials() {
    let cubes = [BRICK, METAL, WET].into_iter().zip([-2.0, 0.0, 2.0]).map(|(material, x)| {
        let world_from_mesh = DAffine3::from_translation(PLACE + DVec3::new(x, 5.0, 0.0));
        Instance {
            id: InstanceId(material as u32 + 1),
            materials: vec![material],
            world_from_mesh,
            ..stuff(CUBE, PLACE)
        }
        .at_rest()
    });
    let scene = scene(cubes.collect());
    for labels in by_all_kernels(&scene, &shot(&[ExtraLabel::Albedo, ExtraLabel::Roughness, ExtraLabel::Part])) {
        let (albedo, roughness) = (labels.extra.albedo.unwrap(), labels.extra.roughness.unwrap());
        let part = labels.extra.part.unwrap();
        let mut seen = [0; 5];
        for i in 0..albedo.data.len() {
            let (color, roughness, id) = (Vec3::from(albedo.data[i]), roughness.data[i], labels.instance.data[i]);
            seen[id as usize] += 1;
            assert_eq!(part.data[i], (id == 3).then_some(Role::ShopSign), "the metal's");
            match id {
                0 => assert!(color.is_nan_mask().all() && roughness.is_nan(), "sky"),
                1 => assert!(
                    color.abs_diff_eq(scene.materials[BRICK].base_color, 1e-6) && (roughness - 0.8).abs() < 1e-6
                ),
                3 => assert!(color == Vec3::ZERO && (roughness - 0.3).abs() < 1e-6, "metal scatters nothing diffusely"),
                // Water darkens what is porous, and smooths it.
                _ => assert!(color.cmplt(scene.materials[BRICK].base_color).all() && roughness < 0.8),
            }
        }
        assert!([0, 1, 3, 4].iter().all(|id| seen[*id] > 50), "{seen:?}");
    }
}

#[test]
fn glass_is_a_pane_or_what_is_behind_it() {
    let size_m = DVec3::splat(1.5);
    let of = |id, place| {
        let cuboid = Cuboid { world_from_body: Pose::from_yaw(0.0, place), size_m };
        let world_from_mesh = DAffine3::from_scale_rotation_translation(size_m, DQuat::IDENTITY, place);
        Instance { world_from_mesh, ..object(id, CUBE, cuboid) }.at_rest()
    };
    let pane = Instance { materials: vec![PANE], ..of(1, PLACE + DVec3::Y * 4.0) };
    let thing = of(2, PLACE + DVec3::Y * 8.0);
    let scene = scene(vec![pane, thing.clone()]);
    let bare = Scene { instances: vec![thing], ..scene.clone() };
    let next = Some(camera(PLACE + DVec3::X * 0.2));
    let asked = |glass| {
        let labels = LabelSettings { glass, extra: [ExtraLabel::Coverage].into() };
        Shot { labels, world_from_camera_next: next, ..shot(&[]) }
    };
    let kernels = by_all_kernels(&scene, &asked(GlassLabels::Glass)).into_iter();
    let behind = by_all_kernels(&scene, &asked(GlassLabels::Behind));
    let alone = by_all_kernels(&bare, &asked(GlassLabels::Glass));
    for ((glass, behind), alone) in kernels.zip(behind).zip(alone) {
        let ids = |labels: &Labels| labels.objects.iter().map(|o| (o.id.0, o.visible_px)).collect::<Vec<_>>();
        assert!(!glass.instance.data.contains(&2) && ids(&glass)[1].1 == 0, "hidden behind the pane");
        assert_eq!(glass.objects[1].amodal_px, alone.objects[0].visible_px);
        // As if the pane were not there, in all that labels tell.
        assert_eq!(format!("{behind:?}"), format!("{alone:?}"));
        assert!(behind.occluded_forward.data.contains(&Occlusion::Seen));
    }
}

#[test]
fn what_is_not_asked_for_is_not_made_and_threads_change_nothing() {
    let (thing, ..) = moving_box();
    let scene = scene(vec![thing, stuff(GROUND, PLACE - DVec3::Z * 1.6), stuff(BALL, PLACE + DVec3::Y * 5.0)]);
    let plain = look(&scene, &shot(&[]));
    assert_eq!(format!("{:?}", plain.extra).matches("None").count(), ALL.len());
    let [one, three] = [1, 3].map(|threads| by(KernelChoice::Obvhs, &scene, &shot(&ALL), threads));
    assert!(one.extra.part.is_some());
    // Pixels without a part have none.
    let others = ExtraLabels { part: None, ..one.extra.clone() };
    assert_eq!(format!("{others:?}").matches("None").count(), 1);
    assert!(format!("{one:?}") == format!("{three:?}"));
    // Nor do they change the others.
    assert!(format!("{plain:?}") == format!("{:?}", Labels { extra: Default::default(), ..one }));
}

#[test]
fn outside_the_image_circle_nothing_is_defined() {
    let distortion = Distortion::kannala_brandt(&[-0.12]).unwrap();
    let lens = Lens { fx_px: 24.0, fy_px: 24.0, distortion, ..LENS };
    let scene = scene(vec![stuff(GROUND, PLACE - DVec3::Z * 1.6)]);
    let labels = look(&scene, &Shot { lens, ..shot(&ALL) });
    let void: Vec<usize> = (0..labels.class.data.len()).filter(|&i| labels.class.data[i] == Class::Void).collect();
    assert!(void.len() > 500 && void.len() < 5000, "{}", void.len());
    let extra = &labels.extra;
    let of = |vectors: &Option<Raster<[f32; 3]>>, i: usize| vectors.as_ref().unwrap().data[i];
    for i in void {
        assert_eq!(extra.range_m.as_ref().unwrap().data[i], f32::INFINITY);
        assert_eq!(of(&extra.normal_world, i), [0.0; 3]);
        let vectors = [&extra.albedo, &extra.scene_flow_forward, &extra.scene_flow_backward, &extra.object_coordinates];
        assert!(vectors.into_iter().all(|vectors| of(vectors, i).iter().all(|v| v.is_nan())));
        assert!(extra.roughness.as_ref().unwrap().data[i].is_nan());
    }
    // Along the rim, pixels are partly outside.
    let coverage = &extra.coverage.as_ref().unwrap().data;
    assert!((0..coverage.len()).any(|i| labels.class.data[i] == Class::Road && coverage[i] < 200));
}

const ALL: [ExtraLabel; 9] = [
    ExtraLabel::Range,
    ExtraLabel::NormalWorld,
    ExtraLabel::Albedo,
    ExtraLabel::Roughness,
    ExtraLabel::SceneFlowForward,
    ExtraLabel::SceneFlowBackward,
    ExtraLabel::ObjectCoordinates,
    ExtraLabel::Coverage,
    ExtraLabel::Part,
];

fn look(scene: &Scene, shot: &Shot) -> Labels {
    by(KernelChoice::Obvhs, scene, shot, 2)
}

/// With the built-in kernel, and with Embree where `TROVE_EMBREE` says that there is one.
fn by_all_kernels(scene: &Scene, shot: &Shot) -> Vec<Labels> {
    let embree = std::env::var_os("TROVE_EMBREE").map(|_| KernelChoice::Embree);
    [KernelChoice::Obvhs].into_iter().chain(embree).map(|kernel| by(kernel, scene, shot, 2)).collect()
}

fn by(kernel: KernelChoice, scene: &Scene, shot: &Shot, threads: usize) -> Labels {
    let search = std::env::var_os("TROVE_EMBREE").map(Into::into).into_iter().collect();
    let renderer =
        Renderer::new(&RendererOptions { kernel, denoise: Denoising::None, threads, search, ..Default::default() })
            .unwrap();
    let prepared = renderer.prepare(scene).unwrap();
    renderer.render(&prepared, shot, false, &|_| false).unwrap().labels
}

fn centres() -> impl Iterator<Item = (u32, u32, DVec2)> {
    let row = |y: u32| (0..LENS.width_px).map(move |x| (x, y, DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)));
    (0..LENS.height_px).flat_map(row)
}

/// A camera that looks north.
fn camera(position: DVec3) -> Pose<World, Camera> {
    Pose::new(DQuat::from_mat3(&DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y)), position)
}

fn shot(wanted: &[ExtraLabel]) -> Shot {
    let labels = LabelSettings { extra: wanted.iter().copied().collect(), ..LabelSettings::default() };
    Shot { labels, ..Shot::new("test", LENS, camera(PLACE)) }
}

fn stuff(mesh: usize, place: DVec3) -> Instance {
    Instance {
        id: InstanceId(0),
        class: Class::Road,
        mesh,
        materials: vec![BRICK],
        world_from_mesh: DAffine3::from_translation(place),
        previous: None,
        next: None,
        object: None,
    }
    .at_rest()
}

/// A recorded thing in a box.
fn object(id: u32, mesh: usize, cuboid: Cuboid) -> Instance {
    let origin =
        Origin::Recorded { track_token: "t".into(), annotation_token: "a".into(), category: "vehicle.car".into() };
    let object = SceneObject {
        kind: Kind::Car,
        origin,
        asset: None,
        cuboid,
        velocity_mps: None,
        yaw_rate_radps: None,
        states: Vec::new(),
        paint: None,
        keypoints_world: None,
    };
    Instance { id: InstanceId(id), class: Class::Car, object: Some(Arc::new(object)), ..stuff(mesh, PLACE) }
}

fn scene(instances: Vec<Instance>) -> Scene {
    let sky = EnvironmentMap { name: "white".into(), width: 2, height: 1, rgb: vec![[1.0; 3]; 2] };
    let square = |corners: [[f32; 3]; 4]| Mesh {
        positions: corners.map(Vec3::from).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let ground = square([[-500.0, -500.0, 0.0], [500.0, -500.0, 0.0], [500.0, 500.0, 0.0], [-500.0, 500.0, 0.0]]);
    // In the plane of x and z, with an edge along z.
    let sheet = square([[0.0, 0.0, -1.0], [2.0, 0.0, -1.0], [2.0, 0.0, 1.0], [0.0, 0.0, 1.0]]);
    let brick = Material::plain("brick", Vec3::new(0.4, 0.15, 0.1), 0.8);
    Scene {
        meshes: [ground, ball(400), cube(), sheet].map(Arc::new).to_vec(),
        materials: vec![
            brick.clone(),
            Material { transmission: 1.0, roughness: 0.0, ..Material::default() },
            Material { metalness: 1.0, roughness: 0.3, role: Some(Role::ShopSign), ..brick.clone() },
            Material { wetness: 1.0, ..brick },
        ],
        instances,
        others: Default::default(),
        keyframes_apart_s: [0.5; 2],
        light: Light::clear(Environment::Map(Arc::new(sky))),
        provenance: Vec::new(),
    }
}

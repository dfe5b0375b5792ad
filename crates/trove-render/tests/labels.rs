//! Labels whose values are known in closed form.

#![allow(clippy::unwrap_used)] // clippy knows the tests in here, not what they call

mod solids;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, Vec3};
use solids::{ball, cube};
use trove_model::{
    Body, Camera, CameraBeside, Class, Cuboid, Distortion, Environment, EnvironmentMap, ExtraLabel, Instance,
    InstanceId, KEYPOINTS, Kind, LabelSettings, Labels, Lens, Light, Material, Mesh, ObjectLabel, Origin, PixelBox,
    Placement, Pose, Raster, Scene, SceneObject, Seed, Shot, Shutter, World,
};
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};

const LENS: Lens = Lens {
    width_px: 80,
    height_px: 60,
    fx_px: 60.0,
    fy_px: 62.0,
    cx_px: 41.3,
    cy_px: 28.6,
    distortion: Distortion::None,
};

/// Far from the origin, where single precision has coarse steps.
const PLACE: DVec3 = DVec3::new(812.3, -1033.7, 14.0);

#[test]
fn the_ground_has_the_depth_normal_and_flow_of_a_plane() {
    let mut shot = shot(PLACE + DVec3::Z * 1.6);
    let next = Pose::new(shot.world_from_camera.rotation, PLACE + DVec3::new(0.4, 2.5, 1.6));
    shot.world_from_camera_next = Some(next);
    for labels in by_all_kernels(&scene(vec![stuff(GROUND, PLACE)]), &shot) {
        let (mut seen, mut worst_depth, mut worst_flow) = (0, 0.0f64, 0.0f64);
        for (x, y, centre) in centres() {
            let direction = shot.world_from_camera.vector(at_depth_one(centre));
            let depth = -1.6 / direction.z;
            if direction.z >= 0.0 || depth > 100.0 {
                continue;
            }
            seen += 1;
            worst_depth = worst_depth.max((f64::from(*labels.depth_m.at(x, y)) - depth).abs() / depth.max(1.0));
            let normal = Vec3::from(*labels.normal.at(x, y));
            assert!((normal - Vec3::NEG_Y).length() < 1e-5 && normal.is_normalized(), "{normal}");
            let point = shot.world_from_camera.translation + direction * depth;
            let then = LENS.project(next.inverse().point(point));
            let flow = DVec2::from_array(labels.flow_forward.at(x, y).map(f64::from));
            match then {
                Some(then) => worst_flow = worst_flow.max((flow - (then - centre)).length() / (then - centre).length()),
                None => assert!(flow.is_nan()),
            }
            assert!(labels.flow_backward.at(x, y)[0].is_nan());
            assert_eq!(*labels.class.at(x, y), Class::Road);
        }
        assert!(seen > 2000 && worst_depth < 1e-6 && worst_flow < 1e-6, "{seen} pixels, {worst_depth}, {worst_flow}");
    }
}

#[test]
fn a_ball_has_the_depth_normals_and_flow_of_a_ball() {
    let centre = PLACE + DVec3::new(0.2, 6.0, 0.1);
    let mut shot = shot(PLACE);
    let next = Pose::new(shot.world_from_camera.rotation, PLACE + DVec3::new(0.4, 0.5, -0.1));
    shot.world_from_camera_next = Some(next);
    for labels in by_all_kernels(&scene(vec![stuff(BALL, centre)]), &shot) {
        let mut seen = 0;
        for (x, y, pixel) in centres() {
            let direction = shot.world_from_camera.vector(at_depth_one(pixel));
            // |direction · t − to_centre| = 1
            let (a, b, to_centre) = (direction.length_squared(), direction.dot(centre - PLACE), centre - PLACE);
            let root = b * b - a * (to_centre.length_squared() - 1.0);
            if root < 0.3 {
                continue; // past it, or so near its rim that the facets show
            }
            seen += 1;
            let t = (b - root.sqrt()) / a;
            assert!((f64::from(*labels.depth_m.at(x, y)) - t).abs() < 1e-4, "{}", *labels.depth_m.at(x, y));
            let normal = shot.world_from_camera.inverse().vector(direction * t - to_centre).as_vec3();
            assert!(normal.dot(Vec3::from(*labels.normal.at(x, y))) > 0.9999);
            let flow = DVec2::from_array(labels.flow_forward.at(x, y).map(f64::from));
            let expected = LENS.project(next.inverse().point(PLACE + direction * t)).unwrap() - pixel;
            assert!((flow - expected).length() < 1e-4 * expected.length(), "{flow} instead of {expected}");
        }
        assert!(seen > 200, "{seen}");
    }
}

#[test]
fn a_change_is_where_what_is_met_first_looks_or_stands_otherwise_and_not_where_light_is() {
    let things = || vec![stuff(GROUND, PLACE - DVec3::Z * 1.6), object(1, PLACE + DVec3::Y * 8.0, 1.0)];
    let before = scene(things());
    let shot = shot(PLACE);
    let options =
        RendererOptions { kernel: KernelChoice::Obvhs, denoise: Denoising::None, threads: 2, ..Default::default() };
    let renderer = Renderer::new(&options).unwrap();
    let prepared = renderer.prepare(&before).unwrap();
    let changes = |after: &Scene| {
        let changed = renderer.changes((&before, &prepared), (after, &renderer.prepare(after).unwrap()), &shot);
        (0..changed.data.len()).filter(|&i| changed.data[i]).collect::<Vec<usize>>()
    };
    assert!(changes(&scene(things())).is_empty());
    let labels = look(&before, &shot);
    let of_object: Vec<usize> = (0..labels.instance.data.len()).filter(|&i| labels.instance.data[i] == 1).collect();

    // Paint alone: its pixels, and not its shadow's.
    let mut painted = scene(things());
    let paint = Material { base_color: Vec3::X, ..painted.materials[painted.instances[1].materials[0]].clone() };
    painted.materials.push(paint);
    painted.instances[1].materials.fill(painted.materials.len() - 1);
    assert!(of_object.len() > 30);
    assert_eq!(changes(&painted), of_object);

    let mut shining = scene(things());
    shining.materials.iter_mut().for_each(|m| m.emission = Vec3::ONE);
    assert!(changes(&shining).is_empty(), "light alone");

    // Gone: where it was, and nowhere else.
    let mut without = scene(things());
    without.instances.pop();
    assert_eq!(changes(&without), of_object);
}

#[test]
fn a_moving_box_flows_with_its_tracks_and_the_sky_with_the_cameras_turn() {
    let mut shot = shot(PLACE);
    let turned = shot.world_from_camera * Pose::<Camera, Camera>::new(DQuat::from_rotation_y(0.05), DVec3::ZERO);
    shot.world_from_camera_next = Some(Pose::new(turned.rotation, PLACE + DVec3::Y));
    shot.world_from_camera_previous = Some(Pose::new(shot.world_from_camera.rotation, PLACE - DVec3::Y));
    let now = DAffine3::from_translation(PLACE + DVec3::Y * 8.0);
    let next = DAffine3::from_rotation_translation(DQuat::from_rotation_z(0.3), PLACE + DVec3::new(1.0, 9.0, 0.0));
    let mut moving = object(1, PLACE + DVec3::Y * 8.0, 1.0);
    (moving.next, moving.previous) = (Some(Placement { mesh: CUBE, world_from_mesh: next }), None);
    let labels = look(&scene(vec![moving]), &shot);
    for (x, y, centre) in centres() {
        let flow = DVec2::from_array(labels.flow_forward.at(x, y).map(f64::from));
        let direction = shot.world_from_camera.vector(at_depth_one(centre));
        let next_from_world = shot.world_from_camera_next.unwrap().inverse();
        let then = if *labels.instance.at(x, y) == 1 {
            assert!(labels.flow_backward.at(x, y)[0].is_nan(), "it was not there");
            let point = PLACE + direction * f64::from(*labels.depth_m.at(x, y));
            next_from_world.point((next * now.inverse()).transform_point3(point))
        } else {
            assert_eq!(*labels.class.at(x, y), Class::Sky);
            assert_eq!((*labels.depth_m.at(x, y), *labels.normal.at(x, y)), (f32::INFINITY, [0.0; 3]));
            let back = DVec2::from_array(labels.flow_backward.at(x, y).map(f64::from));
            assert!(back.length() < 1e-6, "a camera that does not turn sees the sky stand");
            next_from_world.vector(direction)
        };
        let expected = LENS.project(then).unwrap() - centre;
        assert!((flow - expected).length() < 1e-3, "({x}, {y}): {flow} instead of {expected}");
    }
    assert!(labels.instance.data.contains(&1));
}

#[test]
fn a_box_behind_another_is_hidden_and_keeps_its_amodal_extent() {
    let (front, behind) = (object(7, PLACE + DVec3::Y * 6.0, 3.0), object(3, PLACE + DVec3::Y * 12.0, 1.0));
    let both = objects(vec![front.clone(), behind.clone()]);
    assert_eq!(both.iter().map(|o| o.id.0).collect::<Vec<_>>(), [3, 7]);
    let [hidden, shown] = [&both[0], &both[1]];
    assert_eq!((hidden.visible_px, hidden.visible_box, hidden.occlusion), (0, None, 1.0));
    assert_eq!((shown.occlusion, shown.truncation), (0.0, 0.0));
    assert_eq!((shown.visible_px, shown.visible_box), (shown.amodal_px, shown.amodal_box));
    let alone = &objects(vec![behind])[0];
    assert_eq!((hidden.amodal_px, hidden.amodal_box), (alone.visible_px, alone.visible_box));
    assert!((hidden.range_m - 12.0).abs() < 1e-4);
    // The near face of the front box, 4.5 m away and 3 m wide, is 40 × 41.3 pixels around the principal point.
    assert_eq!(shown.amodal_box, Some(PixelBox { min: [21, 8], max: [60, 48] }));
}

#[test]
fn a_box_half_behind_a_wall_is_half_hidden_and_its_amodal_mask_is_its_projection() {
    // The near face of a cube of 2 m is 9 m away; a wall 5 m away ends at the middle of the picture.
    let cube = object(3, PLACE + DVec3::Y * 10.0, 2.0);
    let wall = object(7, PLACE + DVec3::new(-2.0, 7.0, 0.0), 4.0);
    let wanted = LabelSettings { extra: [ExtraLabel::AmodalMasks].into(), ..LabelSettings::default() };
    let shot = Shot { labels: wanted, ..shot(PLACE) };
    for labels in by_all_kernels(&scene(vec![cube.clone(), wall.clone()]), &shot) {
        let [cube, wall] = &labels.objects[..] else { panic!("{:?}", labels.objects) };
        let half_px = LENS.fx_px / 9.0;
        let face = |x: u32, y: u32| {
            let off = DVec2::new(f64::from(x) + 0.5 - LENS.cx_px, f64::from(y) + 0.5 - LENS.cy_px).abs();
            off.x < half_px && off.y < LENS.fy_px / 9.0
        };
        let mask = cube.amodal_mask.as_ref().unwrap();
        let mut expected = (0, 0);
        for (x, y, centre) in centres() {
            let [column, row] = [x.wrapping_sub(mask.min[0]), y.wrapping_sub(mask.min[1])];
            let is_in = column < mask.pixels.width && row < mask.pixels.height && *mask.pixels.at(column, row);
            assert_eq!(is_in, face(x, y), "({x}, {y})");
            assert_eq!(*labels.instance.at(x, y) == 3, face(x, y) && centre.x > LENS.cx_px);
            expected.0 += u32::from(face(x, y));
            expected.1 += u32::from(face(x, y) && centre.x > LENS.cx_px);
        }
        assert_eq!((cube.amodal_px, cube.visible_px), expected);
        assert!((cube.occlusion - 0.5).abs() < 0.05, "{}", cube.occlusion);
        let seen = wall.amodal_mask.as_ref().unwrap().pixels.data.iter().filter(|is_in| **is_in).count();
        assert_eq!((seen as u32, wall.occlusion), (wall.visible_px, 0.0));
    }
    assert!(objects(vec![cube, wall]).iter().all(|object| object.amodal_mask.is_none()), "nobody asked");
}

#[test]
fn points_of_a_person_are_where_they_project_to_and_hidden_by_all_but_skin_and_clothes() {
    // The near face of a person as large as a box is 7.5 m away; a post stands before its right half.
    let mut person = object(7, PLACE + DVec3::Y * 8.0, 1.0);
    let mut points = [PLACE + DVec3::Y * -5.0; KEYPOINTS.len()];
    let face_and_joints = [
        ("nose", DVec3::new(-0.2, 7.51, 0.3), Some(true)),
        ("left_eye", DVec3::new(-0.3, 7.6, 0.3), Some(false)),
        ("left_hip", DVec3::new(-0.3, 7.6, -0.1), Some(true)),
        ("right_hip", DVec3::new(-0.1, 8.4, -0.1), Some(false)),
        ("right_knee", DVec3::new(0.2, 7.51, -0.4), Some(false)),
        ("left_ankle", DVec3::new(-30.0, 7.5, 0.0), None),
        ("right_ankle", DVec3::new(0.0, -1.0, 0.0), None),
    ];
    let number = |name: &str| KEYPOINTS.iter().position(|n| *n == name).unwrap();
    face_and_joints.iter().for_each(|(name, at, _)| points[number(name)] = PLACE + *at);
    let shown = SceneObject { keypoints_world: Some(points), ..(**person.object.as_ref().unwrap()).clone() };
    person.object = Some(Arc::new(shown));
    let post = object(9, PLACE + DVec3::new(0.55, 4.0, 0.0), 1.0);
    let both = objects(vec![person, post]);
    let seen = both[0].keypoints.unwrap();
    for (name, at, is_visible) in face_and_joints {
        assert_eq!(seen[number(name)].map(|point| point.is_visible), is_visible, "{name}");
        if let Some(point) = seen[number(name)] {
            let [u, v] = [LENS.cx_px + LENS.fx_px * at.x / at.y, LENS.cy_px - LENS.fy_px * at.z / at.y];
            assert!(point.pixel.distance(DVec2::new(u, v)) < 1e-9, "{name}: {}", point.pixel);
        }
    }
    assert_eq!(both[1].keypoints, None);
}

#[test]
fn scenery_is_listed_where_it_is_seen_and_the_carrier_is_not() {
    let mut tree = object(3, PLACE + DVec3::Y * 12.0, 1.0);
    let mut place = (**tree.object.as_ref().unwrap()).clone();
    place.origin = Origin::Scenery;
    tree.object = Some(Arc::new(place));
    assert_eq!(objects(vec![object(7, PLACE + DVec3::Y * 6.0, 3.0), tree.clone()]).len(), 1);
    assert_eq!(objects(vec![tree.clone()])[0].occlusion, 0.0);
    // The camera stands in the box that carries it, and sees out.
    let carried = scene(vec![object(1, PLACE, 2.0), tree]);
    let labels = look(&carried, &Shot { carrier: Some(InstanceId(1)), ..shot(PLACE) });
    assert_eq!(labels.objects.iter().map(|o| o.id.0).collect::<Vec<_>>(), [3]);
    assert!(!labels.instance.data.contains(&1));
}

#[test]
fn a_box_across_the_border_is_truncated_and_one_outside_is_not_listed() {
    let half = &objects(vec![object(1, PLACE + DVec3::new(-5.0, 7.5, 0.0), 3.0)])[0];
    assert!((0.3..0.7).contains(&half.truncation), "{}", half.truncation);
    assert_eq!(half.amodal_box.unwrap().min[0], 0);
    assert!(objects(vec![object(1, PLACE + DVec3::new(-30.0, 7.5, 0.0), 3.0)]).is_empty());
    assert!(objects(vec![object(1, PLACE - DVec3::Y * 7.5, 3.0)]).is_empty());
}

#[test]
fn a_fisheye_sees_beside_itself_and_nothing_outside_its_image_circle() {
    // Equidistant, 190° in a circle of radius 29.5 px: θ (1 − θ² / (3 θ_max²)) grows until θ_max.
    let most = 95f64.to_radians();
    let distortion = Distortion::kannala_brandt(&[-1.0 / (3.0 * most * most)]).unwrap();
    let f = 29.5 / (most * 2.0 / 3.0);
    let lens = Lens { fx_px: f, fy_px: f, cx_px: 40.0, cy_px: 30.0, distortion, ..LENS };
    let beside = [PLACE - DVec3::X * 4.0, PLACE + DVec3::X * 4.0];
    let scene = scene(vec![object(1, beside[0], 3.0), object(2, beside[1], 3.0)]);
    let labels = look(&scene, &Shot { lens, ..shot(PLACE) });
    let (mut outside, mut seen) = (0, 0);
    for (x, y, centre) in centres() {
        let Some(direction) = lens.unproject(centre) else {
            outside += 1;
            assert!(centre.distance(DVec2::new(40.0, 30.0)) > 29.4);
            assert_eq!((*labels.class.at(x, y), *labels.instance.at(x, y)), (Class::Void, 0));
            assert_eq!((*labels.depth_m.at(x, y), *labels.normal.at(x, y)), (f32::INFINITY, [0.0; 3]));
            assert!(labels.flow_forward.at(x, y)[0].is_nan());
            continue;
        };
        if *labels.instance.at(x, y) == 1 {
            seen += 1;
            // The cube's near face lies 2.5 m to the left; behind the camera its depth is negative.
            let expected = direction.z * -2.5 / direction.x;
            assert!((f64::from(*labels.depth_m.at(x, y)) - expected).abs() < 1e-3);
        }
    }
    assert!(outside > 1900 && seen > 20, "{outside} {seen}");
    assert_eq!(labels.objects.iter().map(|o| o.id.0).collect::<Vec<_>>(), [1, 2]);
    for object in &labels.objects {
        assert_eq!((object.visible_px, object.visible_box), (object.amodal_px, object.amodal_box));
    }
}

#[test]
fn colour_is_sheared_by_a_rolling_shutter_and_labels_are_not() {
    // A pole far ahead, the camera turning left: each row sees it where the camera looks by then.
    let mut pole = object(1, PLACE + DVec3::Y * 20.0, 1.0);
    let size = DVec3::new(1.0, 1.0, 60.0);
    pole.world_from_mesh = DAffine3::from_scale_rotation_translation(size, DQuat::IDENTITY, PLACE + DVec3::Y * 20.0);
    let mut scene = scene(vec![pole.at_rest()]);
    scene.materials[0].base_color = Vec3::ZERO;
    let (yaw_rate, readout_s) = (0.8, 0.2);
    let turned = |angle: f64| {
        let now = shot(PLACE).world_from_camera;
        Pose::new(DQuat::from_rotation_z(angle) * now.rotation, now.translation)
    };
    let shutter = Shutter { readout_s, ..Shutter::INSTANT };
    let rolling =
        Shot { beside: [-0.5, 0.5].map(|s| Some(beside(turned(s * yaw_rate)))), shutter, spp: 16, ..shot(PLACE) };
    // Where the dark pole's middle is in each row.
    let column = |shot: &Shot, y: u32| {
        let radiance = colour(&scene, shot);
        let dark = |x: u32| f64::from((1.0 - radiance.at(x, y)[1]).max(0.0));
        let whole: f64 = (0..80).map(dark).sum();
        (0..80).map(|x| (f64::from(x) + 0.5) * dark(x)).sum::<f64>() / whole
    };
    let sheared = column(&rolling, 59) - column(&rolling, 0);
    // From the first row's centre to the last one's; turning left moves the picture to the right.
    let angle = |y: f64| yaw_rate * readout_s * (y / 60.0 - 0.5);
    let expected = LENS.fx_px * (angle(59.5).tan() - angle(0.5).tan());
    assert!((sheared - expected).abs() < 0.35, "{sheared} px instead of {expected}");
    let still = Shot { shutter: Shutter::INSTANT, ..rolling.clone() };
    assert_eq!(format!("{:?}", look(&scene, &rolling)), format!("{:?}", look(&scene, &still)));
}

#[test]
fn an_edge_is_blurred_as_wide_as_the_camera_turns_while_it_is_exposed() {
    // The left half of the view is dark.
    let mut wall = object(1, PLACE + DVec3::new(-50.0, 20.0, 0.0), 1.0);
    let size = DVec3::new(100.0, 0.1, 80.0);
    wall.world_from_mesh =
        DAffine3::from_scale_rotation_translation(size, DQuat::IDENTITY, PLACE + DVec3::new(-50.0, 20.0, 0.0));
    (wall.previous, wall.next) = (None, None);
    let mut scene = scene(vec![wall]);
    scene.materials[0].base_color = Vec3::ZERO;
    let now = shot(PLACE).world_from_camera;
    let turned = Pose::new(DQuat::from_rotation_z(0.5) * now.rotation, now.translation);
    let exposed = |exposure_s: f64| Shot {
        beside: [None, Some(beside(turned))],
        shutter: Shutter { exposure_s, ..Shutter::INSTANT },
        spp: 16,
        ..shot(PLACE)
    };
    // Twice the distance between the quarters of the rise from dark to bright; an even blur is a straight rise.
    let width = |exposure_s: f64| {
        let radiance = colour(&scene, &exposed(exposure_s));
        let light = |x: u32| (0..60).map(|y| f64::from(radiance.at(x, y)[1])).sum::<f64>();
        let share = |x: u32| (light(x) - light(28)) / (light(56) - light(28));
        let crossing = |level: f64| {
            let x = (28..56u32).find(|&x| share(x + 1) >= level).unwrap();
            f64::from(x) + (level - share(x)) / (share(x + 1) - share(x))
        };
        2.0 * (crossing(0.75) - crossing(0.25))
    };
    // 1 rad/s for 0.2 s is 12 px at the middle.
    let (sharp, blurred) = (width(0.0), width(0.2));
    assert!(sharp < 2.0 && (blurred - 12.0).abs() < 0.8, "{sharp} px, then {blurred} px instead of 12");
    assert_eq!(format!("{:?}", look(&scene, &exposed(0.2))), format!("{:?}", look(&scene, &exposed(0.0))));
}

#[test]
fn a_cropped_cameras_labels_are_the_middle_of_the_whole_pictures() {
    let bent = Distortion::brown_conrady(&[-0.25, 0.05, 1e-3, -5e-4]).unwrap();
    let scene = scene(vec![
        stuff(GROUND, PLACE - DVec3::Z * 1.5),
        object(1, PLACE + DVec3::new(0.4, 6.0, 0.2), 1.5),
        object(2, PLACE + DVec3::new(-4.2, 9.0, 0.0), 3.0),
    ]);
    for (lens, scale) in [(LENS, 1.0), (LENS, 0.5), (Lens { distortion: bent, ..LENS }, 1.0)] {
        let taken = |lens: Lens| {
            let mut shot = Shot { lens, ..shot(PLACE) };
            shot.world_from_camera_next = Some(Pose::new(shot.world_from_camera.rotation, PLACE + DVec3::Y));
            look(&scene, &shot)
        };
        // Half as wide as the recording and as high.
        let whole = taken(lens.scaled(scale));
        let (width, height) = (whole.class.width / 2, whole.class.height);
        let cropped = lens.cropped(width, height);
        let part = taken(cropped);
        assert_eq!((part.class.width, part.class.height), (width, height));
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let from = x + width / 2;
            assert_eq!(part.class.at(x, y), whole.class.at(from, y));
            assert_eq!(part.instance.at(x, y), whole.instance.at(from, y));
            let (depth, there) = (part.depth_m.at(x, y), whole.depth_m.at(from, y));
            assert!(depth == there || (depth / there - 1.0).abs() < 1e-5, "({x}, {y}): {depth} instead of {there}");
            let flow = [part.flow_forward.at(x, y), whole.flow_forward.at(from, y)].map(|f| glam::Vec2::from_array(*f));
            let apart = (flow[0] - flow[1]).length();
            assert!(apart < 1e-3 || flow.iter().all(|f| f.is_nan()), "({x}, {y}): {flow:?}");
        }
        let near = part.objects.iter().find(|o| o.id.0 == 1).unwrap();
        let seen = (0..width * height).filter(|i| part.instance.data[*i as usize] == 1).map(|i| [i % width, i / width]);
        let around = seen
            .map(|p| (p, p))
            .reduce(|(a, b), (p, _)| ([a[0].min(p[0]), a[1].min(p[1])], [b[0].max(p[0]), b[1].max(p[1])]));
        assert_eq!(near.visible_box.map(|b| (b.min, b.max)), around);
        let middle = cropped.project(DVec3::new(0.4, -0.2, 6.0)).unwrap();
        assert_eq!(*part.instance.at(middle.x as u32, middle.y as u32), 1);
        assert!(part.objects.iter().any(|o| o.id.0 == 2 && o.truncation > 0.1), "the left one is cut");
    }
}

#[test]
fn one_thread_and_two_give_the_same_labels() {
    let boxes = (1..20).map(|i| {
        let angle = f64::from(i) * 2.4;
        object(i, PLACE + DVec3::new(angle.sin() * 3.0, 5.0 + f64::from(i), angle.cos()), 1.5)
    });
    let scene = scene(boxes.collect());
    let [one, two] = [1, 2].map(|threads| format!("{:?}", labels(&scene, &shot(PLACE), threads)));
    assert!(one == two);
}

fn look(scene: &Scene, shot: &Shot) -> Labels {
    labels(scene, shot, 2)
}

fn labels(scene: &Scene, shot: &Shot, threads: usize) -> Labels {
    by(KernelChoice::Obvhs, scene, shot, threads)
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

fn colour(scene: &Scene, shot: &Shot) -> Raster<[f32; 3]> {
    let options =
        RendererOptions { kernel: KernelChoice::Obvhs, denoise: Denoising::None, threads: 2, ..Default::default() };
    let renderer = Renderer::new(&options).unwrap();
    let prepared = renderer.prepare(scene).unwrap();
    renderer.render(&prepared, shot, true, &|_| false).unwrap().color.unwrap().radiance
}

fn objects(instances: Vec<Instance>) -> Vec<ObjectLabel> {
    look(&scene(instances), &shot(PLACE)).objects
}

/// The point in Camera with z = 1 that a pixel shows.
fn at_depth_one(pixel: DVec2) -> DVec3 {
    let direction = LENS.unproject(pixel).unwrap();
    direction / direction.z
}

fn centres() -> impl Iterator<Item = (u32, u32, DVec2)> {
    let row = |y: u32| (0..LENS.width_px).map(move |x| (x, y, DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)));
    (0..LENS.height_px).flat_map(row)
}

/// A camera's pose half a second away.
fn beside(world_from_camera: Pose<World, Camera>) -> CameraBeside {
    CameraBeside { apart_s: 0.5, world_from_camera }
}

/// A camera that looks north.
fn shot(position: DVec3) -> Shot {
    let rotation = DQuat::from_mat3(&DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y));
    Shot { seed: Seed(1), ..Shot::new("test", LENS, Pose::<World, Camera>::new(rotation, position)) }
}

/// Indices of the test meshes.
const GROUND: usize = 0;
const BALL: usize = 1;
const CUBE: usize = 2;

fn scene(instances: Vec<Instance>) -> Scene {
    let sky = EnvironmentMap { name: "white".into(), width: 2, height: 1, rgb: vec![[1.0; 3]; 2] };
    Scene {
        meshes: [ground(), ball(400), cube()].map(Arc::new).to_vec(),
        materials: vec![Material::default()],
        instances,
        others: Default::default(),
        keyframes_apart_s: [0.5; 2],
        light: Light::clear(Environment::Map(Arc::new(sky))),
        provenance: Vec::new(),
    }
}

fn stuff(mesh: usize, place: DVec3) -> Instance {
    let world_from_mesh = DAffine3::from_translation(place);
    Instance {
        id: InstanceId(0),
        class: Class::Road,
        mesh,
        materials: vec![0],
        world_from_mesh,
        previous: None,
        next: None,
        object: None,
    }
    .at_rest()
}

/// A recorded cube.
fn object(id: u32, place: DVec3, side_m: f64) -> Instance {
    let world_from_mesh = DAffine3::from_scale_rotation_translation(DVec3::splat(side_m), DQuat::IDENTITY, place);
    let object = SceneObject {
        kind: Kind::Car,
        origin: Origin::Recorded {
            track_token: "track".into(),
            annotation_token: "annotation".into(),
            category: "vehicle.car".into(),
        },
        asset: Some("cube".into()),
        cuboid: Cuboid { world_from_body: Pose::<World, Body>::from_yaw(0.0, place), size_m: DVec3::splat(side_m) },
        velocity_mps: None,
        yaw_rate_radps: None,
        states: Vec::new(),
        paint: None,
        keypoints_world: None,
    };
    let cube = Instance { id: InstanceId(id), class: Class::Car, world_from_mesh, ..stuff(CUBE, place) };
    Instance { object: Some(Arc::new(object)), ..cube.at_rest() }
}

/// A square kilometre at z = 0 in four triangles.
fn ground() -> Mesh {
    Mesh {
        positions: [[-500.0, -500.0], [500.0, -500.0], [500.0, 500.0], [-500.0, 500.0], [3.0, 7.0]]
            .map(|[x, y]| Vec3::new(x, y, 0.0))
            .to_vec(),
        triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
        ..Mesh::default()
    }
}

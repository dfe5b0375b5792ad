//! What a sensor's rays bring back: against closed forms, and against the labels of a camera.

#![allow(clippy::unwrap_used)] // clippy knows the tests in here, not what they call

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec2, Vec3};
use trove_model::{
    Camera, Class, ColorSpace, Distortion, Environment, EnvironmentMap, Instance, InstanceId, Lens, Light, Material,
    Mesh, Placement, Points, Pose, Return, Scan, Scene, Sensor, SensorRay, Shot, Texture, World,
};
use trove_render::{Denoising, KernelChoice, PreparedScene, Renderer, RendererOptions};

/// Far from the origin, where single precision has coarse steps.
const PLACE: DVec3 = DVec3::new(812.3, -1033.7, 14.0);

const LENS: Lens = Lens {
    width_px: 90,
    height_px: 60,
    fx_px: 60.0,
    fy_px: 62.0,
    cx_px: 44.3,
    cy_px: 28.6,
    distortion: Distortion::None,
};

#[test]
fn a_ground_plane_is_met_at_its_range_and_the_sky_is_not_met() {
    let scene = scene(vec![instance(0, Class::Road, GROUND, 0, DAffine3::from_translation(PLACE - DVec3::Z * 1.8))]);
    // Three turns of a scanner, some rays above the horizon.
    let rays: Vec<SensorRay> = (0..900)
        .map(|i| {
            let (azimuth, elevation) = (f64::from(i) * 0.021, -0.6 + 0.8 * f64::from(i % 37) / 36.0);
            let direction = DVec3::new(azimuth.cos(), azimuth.sin(), elevation.tan());
            SensorRay::new(PLACE, direction, 0.0).unwrap()
        })
        .collect();
    by_all_kernels(&scene, |renderer, prepared, kernel| {
        let points = renderer.scan(prepared, &Scan { rays: rays.clone(), carrier: None });
        assert_eq!(points.returns.len(), rays.len());
        let mut met = 0;
        for (ray, back) in rays.iter().zip(&points.returns) {
            let range_m = -1.8 / ray.direction.z;
            if ray.direction.z >= 0.0 {
                assert_eq!(*back, None, "{kernel:?}: {ray:?}");
            } else if range_m < 300.0 {
                met += 1;
                let back = back.unwrap();
                assert!((back.range_m / range_m - 1.0).abs() < 1e-7, "{kernel:?}: {} of {range_m}", back.range_m);
                assert!((back.normal - DVec3::Z).length() < 1e-6);
                assert_eq!((back.class, back.instance), (Class::Road, InstanceId(0)));
            }
        }
        assert!(met > 500, "{met}");
    });
}

#[test]
fn a_turned_box_is_met_where_its_slabs_are() {
    let (size, turn) = (DVec3::new(4.0, 1.8, 1.5), DQuat::from_rotation_z(0.7));
    let centre = PLACE + DVec3::new(9.0, 3.0, 0.4);
    let world_from_mesh = DAffine3::from_scale_rotation_translation(size, turn, centre);
    let scene = scene(vec![instance(7, Class::Car, CUBE, 0, world_from_mesh)]);
    let rays: Vec<SensorRay> = (0..2000)
        .map(|i| {
            let aim = DVec3::new(0.0, f64::from(i % 50) / 49.0 - 0.5, f64::from(i / 50) / 39.0 - 0.5) * 4.5;
            SensorRay::new(PLACE, centre + aim - PLACE, 0.0).unwrap()
        })
        .collect();
    by_all_kernels(&scene, |renderer, prepared, kernel| {
        let points = renderer.scan(prepared, &Scan { rays: rays.clone(), carrier: None });
        let (mut met, mut missed) = (0, 0);
        for (ray, back) in rays.iter().zip(&points.returns) {
            // In the box's own axes, between its three pairs of faces (Kay, Kajiya 1986).
            let (from, way) = (turn.inverse() * (ray.origin - centre), turn.inverse() * ray.direction);
            let (low, high) = ((-size / 2.0 - from) / way, (size / 2.0 - from) / way);
            let (enters, leaves) = (low.min(high).max_element(), low.max(high).min_element());
            if enters < leaves - 1e-3 {
                met += 1;
                let back = back.unwrap();
                assert!((back.range_m - enters).abs() < 1e-5, "{kernel:?}: {} of {enters}", back.range_m);
                assert_eq!((back.class, back.instance), (Class::Car, InstanceId(7)));
                assert!(back.normal.dot(ray.direction) < 0.0, "a normal looks at the sensor");
            } else if enters > leaves + 1e-3 {
                missed += 1;
                assert_eq!(*back, None, "{kernel:?}");
            }
        }
        assert!(met > 400 && missed > 400, "{met}, {missed}");
    });
}

#[test]
fn rays_through_pixels_bring_back_what_the_labels_show() {
    let at = |x: f64, y: f64, z: f64, size: f64| {
        let turn = DQuat::from_rotation_z(x);
        DAffine3::from_scale_rotation_translation(DVec3::splat(size), turn, PLACE + DVec3::new(x, y, z))
    };
    let carrier = DAffine3::from_scale_rotation_translation(DVec3::new(1.9, 4.5, 1.6), DQuat::IDENTITY, PLACE);
    let scene = scene(vec![
        instance(0, Class::Road, GROUND, 0, DAffine3::from_translation(PLACE - DVec3::Z * 1.5)),
        instance(3, Class::Car, CUBE, 0, at(-2.0, 12.0, -0.5, 2.0)),
        instance(4, Class::Truck, CUBE, 0, at(-9.0, 20.0, 0.0, 3.0)),
        instance(5, Class::Tree, CUBE, LEAVES, at(0.6, 7.0, 0.2, 2.5)),
        instance(6, Class::Building, CUBE, PANE, at(4.0, 9.0, 0.0, 2.0)),
        instance(9, Class::Van, CUBE, 0, carrier),
    ]);
    let rotation = DQuat::from_mat3(&DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y));
    let pose = Pose::<World, Camera>::new(rotation, PLACE + DVec3::new(0.1, 0.3, 0.2));
    let fisheye =
        Lens { fx_px: 40.0, fy_px: 40.0, distortion: Distortion::kannala_brandt(&[-0.02, -0.002]).unwrap(), ..LENS };
    for lens in [LENS, fisheye] {
        let shot = Shot { carrier: Some(InstanceId(9)), ..Shot::new("ego.CAM", lens, pose) };
        by_all_kernels(&scene, |renderer, prepared, kernel| {
            let labels = renderer.render(prepared, &shot, false, &|_| false).unwrap().labels;
            let points = renderer.scan(prepared, &shot);
            // What a scanner with the same rays brings back is the same.
            let rays: Vec<SensorRay> = (0..shot.ray_count()).filter_map(|i| shot.ray(i)).collect();
            if rays.len() == shot.ray_count() {
                assert_eq!(points, renderer.scan(prepared, &Scan { rays, carrier: shot.carrier }), "{kernel:?}");
            }
            let mut classes = [0; 20];
            for (i, back) in points.returns.iter().enumerate() {
                let (class, depth_m) = (labels.class.data[i], labels.depth_m.data[i]);
                classes[usize::from(class.id())] += 1;
                let Some(back) = back else {
                    assert!(depth_m == f32::INFINITY && matches!(class, Class::Sky | Class::Void), "{kernel:?}");
                    continue;
                };
                assert_eq!((back.class, back.instance.0), (class, labels.instance.data[i]), "{kernel:?}");
                let camera_from_world = shot.world_from_camera.inverse();
                let depth = back.range_m * camera_from_world.vector(shot.ray(i).unwrap().direction).z;
                assert!((depth - f64::from(depth_m)).abs() <= 1e-6 * depth, "{kernel:?}: {depth} and {depth_m}");
                let normal = camera_from_world.vector(back.normal).as_vec3();
                assert!((normal - Vec3::from(labels.normal.data[i])).length() < 1e-6);
            }
            let seen = [Class::Road, Class::Car, Class::Truck, Class::Tree, Class::Building, Class::Sky];
            assert!(seen.iter().all(|class| classes[usize::from(class.id())] > 20), "{classes:?}");
            assert_eq!(classes[usize::from(Class::Van.id())], 0, "the carrier is looked through");
        });
    }
}

#[test]
fn what_moves_is_met_where_it_is_at_the_rays_time() {
    let speed_mps = 20.0;
    let at = |time_s: f64| DAffine3::from_translation(PLACE + DVec3::Y * (10.0 + speed_mps * time_s));
    let car = Instance {
        previous: Some(Placement { mesh: CUBE, world_from_mesh: at(-0.5) }),
        next: Some(Placement { mesh: CUBE, world_from_mesh: at(0.5) }),
        ..instance(2, Class::Car, CUBE, 0, at(0.0))
    };
    let times_s = [-0.05, -0.02, 0.0, 0.013, 0.05, 0.4];
    let rays = times_s.map(|time_s| SensorRay::new(PLACE, DVec3::Y, time_s).unwrap()).to_vec();
    by_all_kernels(&scene(vec![car]), |renderer, prepared, kernel| {
        let points = renderer.scan(prepared, &Scan { rays: rays.clone(), carrier: None });
        for (time_s, back) in times_s.iter().zip(&points.returns) {
            // Motion is known for 0.05 s.
            let range_m = 9.5 + speed_mps * time_s.min(0.05);
            let found = back.unwrap().range_m;
            assert!((found - range_m).abs() < 1e-6, "{kernel:?} at {time_s} s: {found} instead of {range_m}");
        }
    });
}

#[test]
fn a_scanner_sees_past_what_carries_it_and_nothing_else_does() {
    let around = DAffine3::from_scale_rotation_translation(DVec3::new(1.9, 4.5, 1.6), DQuat::IDENTITY, PLACE);
    let wall = DAffine3::from_translation(PLACE + DVec3::Y * 30.0);
    let scene = scene(vec![instance(9, Class::Car, CUBE, 0, around), instance(1, Class::Building, CUBE, 0, wall)]);
    let ray = SensorRay::new(PLACE, DVec3::Y, 0.0).unwrap();
    by_all_kernels(&scene, |renderer, prepared, kernel| {
        let met = |ray: SensorRay, carrier: Option<u32>| {
            let Points { returns } =
                renderer.scan(prepared, &Scan { rays: vec![ray], carrier: carrier.map(InstanceId) });
            returns[0].map(|Return { instance, range_m, .. }| (instance.0, (range_m * 1e4).round() / 1e4))
        };
        assert_eq!(met(ray, Some(9)), Some((1, 29.5)), "{kernel:?}");
        assert_eq!(met(ray, None), Some((9, 2.25)), "{kernel:?}: from within");
        // From above it, as most scanners stand.
        let above = SensorRay::new(PLACE + DVec3::Z * 3.0, DVec3::new(0.0, 30.0, -3.0), 0.0).unwrap();
        let down = SensorRay { direction: DVec3::NEG_Z, ..above };
        assert_eq!(met(down, None), Some((9, 2.2)), "{kernel:?}");
        assert_eq!(met(down, Some(9)), None, "{kernel:?}");
        assert_eq!(met(above, Some(9)).map(|(id, _)| id), Some(1), "{kernel:?}");
    });
}

#[test]
fn the_base_colours_luminance_is_the_textures() {
    // A white and a black half, of which the material takes half the light.
    let texture = Texture {
        name: "halves".into(),
        width: 2,
        height: 1,
        rgba: vec![[255; 4], [0, 0, 0, 255]],
        color_space: ColorSpace::Srgb,
    };
    let mut scene = scene(vec![instance(1, Class::Car, CARD, 0, DAffine3::from_translation(PLACE + DVec3::Y * 5.0))]);
    scene.materials[0] = Material {
        base_color: Vec3::new(0.5, 0.5, 0.0),
        base_color_map: Some(Arc::new(texture)),
        wetness: 1.0,
        ..Material::default()
    };
    let rays = [-0.25, 0.25].map(|x| SensorRay::new(PLACE + DVec3::X * x, DVec3::Y, 0.0).unwrap()).to_vec();
    by_all_kernels(&scene, |renderer, prepared, _| {
        let points = renderer.scan(prepared, &Scan { rays: rays.clone(), carrier: None });
        let luminance: Vec<f32> = points.returns.iter().map(|back| back.unwrap().base_color_luminance).collect();
        assert!((luminance[0] - 0.5 * (0.2126 + 0.7152)).abs() < 1e-4 && luminance[1] < 1e-6, "{luminance:?}");
    });
}

/// With the built-in kernel, and with Embree where `TROVE_EMBREE` says that there is one.
fn by_all_kernels(scene: &Scene, check: impl Fn(&Renderer, &PreparedScene, KernelChoice)) {
    let embree = std::env::var_os("TROVE_EMBREE");
    for kernel in [KernelChoice::Obvhs].into_iter().chain(embree.as_ref().map(|_| KernelChoice::Embree)) {
        let search = embree.iter().map(Into::into).collect();
        let options = RendererOptions { kernel, denoise: Denoising::None, threads: 2, search, ..Default::default() };
        let renderer = Renderer::new(&options).unwrap();
        check(&renderer, &renderer.prepare(scene).unwrap(), kernel);
    }
}

/// Indices of the meshes and of the materials beside the plain one.
const GROUND: usize = 0;
const CUBE: usize = 1;
const CARD: usize = 2;
const LEAVES: usize = 1;
const PANE: usize = 2;

fn scene(instances: Vec<Instance>) -> Scene {
    let sky = EnvironmentMap { name: "white".into(), width: 2, height: 1, rgb: vec![[1.0; 3]; 2] };
    let dots = Texture {
        name: "dots".into(),
        width: 16,
        height: 16,
        rgba: (0..256u32).map(|i| [0, 99, 0, if (i / 4 + i / 64) % 2 == 0 { 255 } else { 0 }]).collect(),
        color_space: ColorSpace::Srgb,
    };
    let leaves = Material { base_color_map: Some(Arc::new(dots)), alpha_cutoff: 0.5, ..Material::default() };
    let pane = Material { transmission: 0.9, ..Material::default() };
    Scene {
        meshes: vec![Arc::new(square(600.0, DVec3::Y)), Arc::new(cube()), Arc::new(square(0.5, DVec3::Z))],
        materials: vec![Material::default(), leaves, pane],
        instances,
        others: Default::default(),
        keyframes_apart_s: [0.5; 2],
        light: Light::clear(Environment::Map(Arc::new(sky))),
        provenance: Vec::new(),
    }
}

fn instance(id: u32, class: Class, mesh: usize, material: usize, world_from_mesh: DAffine3) -> Instance {
    Instance {
        id: InstanceId(id),
        class,
        mesh,
        materials: vec![material],
        world_from_mesh,
        previous: None,
        next: None,
        object: None,
    }
    .at_rest()
}

/// Half as wide as said, along x and a second axis.
fn square(half: f32, along: DVec3) -> Mesh {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    Mesh {
        positions: corners.map(|(u, v)| (Vec3::X * u + along.as_vec3() * v) * half).to_vec(),
        uvs: corners.map(|(u, v)| Vec2::new(u + 1.0, v + 1.0) / 2.0).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// Side 1 around the origin.
fn cube() -> Mesh {
    let mut mesh = Mesh::default();
    for (axis, side) in (0..3).flat_map(|axis| [(axis, -0.5), (axis, 0.5)]) {
        let base = mesh.positions.len() as u32;
        for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            let mut p = Vec3::ZERO;
            p[axis] = side;
            p[(axis + 1) % 3] = u - 0.5;
            p[(axis + 2) % 3] = v - 0.5;
            mesh.positions.push(p);
            mesh.uvs.push(Vec2::new(u, v));
        }
        mesh.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
    }
    mesh
}

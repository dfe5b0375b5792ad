//! A radar's cycle against closed forms: range, azimuth, radial speed, radar cross-section and ghosts.

#![allow(clippy::unwrap_used)] // clippy knows the tests in here, not what they call

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3, Vec3};
use trove_model::{
    Class, Environment, EnvironmentMap, Instance, InstanceId, Light, Material, Mesh, Placement, Pose, Radar,
    RadarDetection, RadarDirection, RadarScan, RadarShot, RadarSurface, RadarSurfaces, Scene, Seed,
};
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};

/// Far from the origin, where single precision has coarse steps.
const PLACE: DVec3 = DVec3::new(412.3, -633.7, 14.0);

#[test]
fn a_plate_that_drives_away_is_where_it_is_and_as_fast_as_it_is() {
    // 20 m ahead and 10° to the left, away at 5 m/s, while the sensor drives after it by 3 m/s.
    let (sin, cos) = 10_f64.to_radians().sin_cos();
    let at = |time_s: f64| PLACE + DVec3::new(20.0 * cos + 5.0 * time_s, 20.0 * sin, 0.0);
    let turned = DQuat::from_rotation_z(10_f64.to_radians()) * facing();
    let then = |time_s: f64| DAffine3::from_scale_rotation_translation(DVec3::splat(0.3), turned, at(time_s));
    let mut plate = plate(7, Class::Car);
    plate.world_from_mesh = then(0.0);
    (plate.previous, plate.next) = [-0.5, 0.5].map(|t| Some(Placement { mesh: 0, world_from_mesh: then(t) })).into();
    let mut shot = shot();
    shot.velocity_mps = DVec3::X * 3.0;
    let found = detections(&scene(vec![plate]), &shot, 2);
    assert_eq!(found.len(), 1, "{found:?}");
    let RadarDetection { range_m, azimuth_rad, radial_mps, ground_mps, class, instance, surfaces, .. } = found[0];
    assert!((range_m - 20.0).abs() < 0.02, "{range_m}");
    assert!((azimuth_rad.to_degrees() - 10.0).abs() < 0.1, "{}", azimuth_rad.to_degrees());
    assert!((radial_mps - 2.0 * cos).abs() < 0.02 && (ground_mps - 5.0 * cos).abs() < 0.02, "{radial_mps}");
    assert_eq!((class, instance, surfaces), (Class::Car, InstanceId(7), 1));
}

#[test]
fn what_stands_still_is_still_over_ground() {
    let mut standing = plate(7, Class::Car);
    standing.world_from_mesh = placed(DVec3::new(30.0, -8.0, 0.0), 0.5);
    let mut shot = shot();
    shot.velocity_mps = DVec3::new(14.0, 1.0, 0.0);
    let found = detections(&scene(vec![standing.at_rest()]), &shot, 1);
    assert!(!found.is_empty());
    assert!(found.iter().all(|told| told.ground_mps.abs() < 0.1 && told.radial_mps < -12.0), "{found:?}");
}

#[test]
fn sections_are_those_of_closed_forms_on_average() {
    // A plate of 0.36 m² at normal incidence: A / α². A sphere of radius 0.5 m: πr². A matt one: 8/3 πr².
    let square = 0.36 / 0.2_f64.powi(2);
    let round = PI * 0.25;
    for (mesh, size, kind, expect) in
        [(0, 0.3, METAL, square), (1, 0.5, METAL, round), (1, 0.5, MATT, 8.0 / 3.0 * round)]
    {
        let mut target = plate(7, Class::Car);
        target.mesh = mesh;
        target.world_from_mesh = placed(DVec3::X * 15.0, size);
        let scene = scene(vec![target.at_rest()]);
        let mut shot = shot();
        shot.radar.surfaces = surfaces(kind);
        let told: Vec<f64> = (0..60)
            .filter_map(|i| {
                let found = detections(&scene, &RadarShot { seed: Seed(i), ..shot.clone() }, 2);
                // The whole of it is in one cell.
                found.iter().map(|told| 10_f64.powf(told.rcs_dbsm / 10.0)).reduce(f64::max)
            })
            .collect();
        let mean = told.iter().sum::<f64>() / told.len() as f64;
        // 60 draws of a variate with mean 1 and variance 1/2 are within 0.27 of it for three deviations, and what is not in the
        // middle of its cells is up to 2 dB weaker.
        assert_eq!(told.len(), 60);
        assert!(mean / expect > 0.55 && mean / expect < 1.3, "{mean} {expect}");
    }
}

#[test]
fn half_of_the_looks_find_ten_square_metres_at_the_reach() {
    let share = |range_m: f64| {
        let mut target = plate(7, Class::Car);
        // A/α² = 10 m².
        target.world_from_mesh = placed(DVec3::X * range_m, (10.0 * 0.04_f64).sqrt() / 2.0);
        let scene = scene(vec![target.at_rest()]);
        let shot = shot();
        let told = (0..40).filter(|i| {
            let found = detections(&scene, &RadarShot { seed: Seed(*i), ..shot.clone() }, 2);
            found.iter().any(|told| told.instance.0 == 7)
        });
        told.count() as f64 / 40.0
    };
    let [near, at, far] = [50.0, 100.0, 170.0].map(share);
    assert!(near > 0.9 && (0.15..0.75).contains(&at) && far < 0.1, "{near} {at} {far}");
}

#[test]
fn a_rail_makes_a_ghost_behind_it() {
    // A long wall of metal beside the way, 6 m to the left, and a ball 20 m ahead: its image is 12 m to the left.
    let mut wall = plate(1, Class::Barrier);
    wall.world_from_mesh = DAffine3::from_scale_rotation_translation(
        DVec3::new(60.0, 60.0, 1.0),
        DQuat::from_rotation_x(PI / 2.0),
        PLACE + DVec3::Y * 6.0,
    );
    let mut ball = plate(7, Class::Car);
    ball.mesh = 1;
    ball.world_from_mesh = placed(DVec3::X * 20.0, 0.8);
    let mut shot = shot();
    shot.radar.surfaces.of_class[usize::from(Class::Barrier.id())] =
        RadarSurface { reflectance: 1.0, spread: 0.02, ..RadarSurface::default() };
    let found = detections(&scene(vec![wall.at_rest(), ball.at_rest()]), &shot, 2);
    let ghost = found.iter().find(|told| told.instance.0 == 7 && told.surfaces == 2 && told.azimuth_rad > 0.3);
    let ghost = ghost.unwrap_or_else(|| panic!("{found:?}"));
    // The ball's nearest point, seen in the mirror: from (20, 12) its radius towards the sensor.
    let expect_m = 20_f64.hypot(12.0) - 0.8;
    assert!((ghost.range_m - expect_m).abs() < 0.3, "{ghost:?} {expect_m}");
    assert!((ghost.azimuth_rad - (12_f64 / 20.0).atan()).abs() < 0.03, "{ghost:?}");
    let direct = found.iter().find(|told| told.instance.0 == 7 && told.surfaces == 1).unwrap();
    assert!((direct.range_m - 19.2).abs() < 0.1, "{direct:?}");
}

#[test]
fn a_road_lets_the_radar_see_below_what_is_before_it() {
    // A board hides a ball but for a gap of 0.3 m above the road.
    let mut road = plate(0, Class::Road);
    road.world_from_mesh =
        DAffine3::from_scale_rotation_translation(DVec3::new(80.0, 80.0, 1.0), DQuat::IDENTITY, PLACE - DVec3::Z * 0.5);
    let mut board = plate(1, Class::Truck);
    board.world_from_mesh = DAffine3::from_scale_rotation_translation(
        DVec3::new(1.5, 1.5, 1.0),
        facing(),
        PLACE + DVec3::new(12.0, 0.0, 1.3),
    );
    let mut hidden = plate(7, Class::Car);
    hidden.mesh = 1;
    hidden.world_from_mesh = placed(DVec3::new(24.0, 0.0, 0.1), 0.55);
    let scene = scene(vec![road.at_rest(), board.at_rest(), hidden.at_rest()]);
    let mut shot = shot();
    let seen = |shot: &RadarShot| {
        (0..10).any(|i| {
            let found = detections(&scene, &RadarShot { seed: Seed(i), ..shot.clone() }, 2);
            found.iter().any(|told| told.instance.0 == 7 && told.surfaces > 1)
        })
    };
    shot.radar.surfaces.of_class[usize::from(Class::Road.id())] =
        RadarSurface { reflectance: 0.1, diffuse: 0.3, spread: 0.3, height_m: 0.8e-3, passes: 0.0 };
    assert!(seen(&shot));
    shot.radar.surfaces.of_class[usize::from(Class::Road.id())].height_m = 0.05;
    assert!(!seen(&shot), "a road as rough as that mirrors nothing");
}

#[test]
fn what_is_fainter_than_the_radar_tells_is_not_told_and_false_alarms_are_as_many_as_it_has() {
    let mut near = plate(7, Class::Car);
    near.world_from_mesh = placed(DVec3::X * 8.0, 0.3);
    let scene = scene(vec![near.at_rest()]);
    let mut shot = shot();
    (shot.radar.faintest_dbsm, shot.radar.false_alarms) = (25.0, 0.0);
    assert_eq!(detections(&scene, &shot, 1), [], "9 m² are 9.5 dBsm");
    (shot.radar.faintest_dbsm, shot.radar.false_alarms) = (-5.0, 2.0);
    let cycles = 100;
    let told = (0..cycles).flat_map(|i| detections(&scene, &RadarShot { seed: Seed(i), ..shot.clone() }, 2));
    let alarms: Vec<RadarDetection> = told.filter(|told| told.surfaces == 0).collect();
    // Poisson's 200, by four deviations.
    assert!(alarms.len().abs_diff(200) < 57, "{}", alarms.len());
    assert!(alarms.iter().all(|told| told.rcs_dbsm >= -5.0 && told.instance.0 == 0 && told.class == Class::Void));
}

#[test]
fn any_number_of_threads_makes_the_same_cycle() {
    let mut near = plate(7, Class::Car);
    near.world_from_mesh = placed(DVec3::new(18.0, 3.0, 0.0), 0.7);
    let scene = scene(vec![near.at_rest()]);
    let mut shot = shot();
    shot.radar.false_alarms = 5.0;
    let one = detections(&scene, &shot, 1);
    assert!(one.len() > 1 && one == detections(&scene, &shot, 4));
    assert_ne!(one, detections(&scene, &RadarShot { seed: Seed(8), ..shot }, 1));
}

const METAL: RadarSurface = RadarSurface { reflectance: 1.0, diffuse: 0.0, spread: 0.2, height_m: 1.0, passes: 0.0 };
const MATT: RadarSurface = RadarSurface { diffuse: 1.0, ..METAL };

fn surfaces(kind: RadarSurface) -> RadarSurfaces {
    RadarSurfaces { of_class: [kind; Class::ALL.len()], metal: kind, pane: kind }
}

fn detections(scene: &Scene, shot: &RadarShot, threads: usize) -> Vec<RadarDetection> {
    let options =
        RendererOptions { kernel: KernelChoice::Obvhs, denoise: Denoising::None, threads, ..Default::default() };
    let renderer = Renderer::new(&options).unwrap();
    renderer.detections(&renderer.prepare(scene).unwrap(), shot)
}

/// A radar without errors of its own that looks along x from `PLACE`.
fn shot() -> RadarShot {
    let direction = |deg: f64, reach_m| RadarDirection { azimuth_rad: deg.to_radians(), reach_m, error_rad: 0.0 };
    let scan = RadarScan {
        name: "near".into(),
        nearest_m: 0.2,
        farthest_m: 200.0,
        elevation_rad: 20_f64.to_radians(),
        range_resolution_m: 0.4,
        azimuth_resolution_rad: 3.2_f64.to_radians(),
        speed_resolution_mps: 0.12,
        range_error_m: 0.0,
        speed_error_mps: 0.0,
        directions: vec![direction(0.0, 100.0), direction(50.0, 100.0)],
    };
    RadarShot {
        view: "ego.RADAR_FRONT".into(),
        radar: Radar {
            name: "test".into(),
            wavelength_m: 3.9e-3,
            cycle_s: 0.072,
            most: 250,
            false_alarms: 0.0,
            faintest_dbsm: -30.0,
            stands_mps: 0.4,
            approach_mps: 100.0,
            departure_mps: 50.0,
            scans: vec![scan],
            surfaces: surfaces(METAL),
        },
        time_ns: 0,
        world_from_radar: Pose::from_yaw(0.0, PLACE),
        world_from_ego: Pose::IDENTITY,
        velocity_mps: DVec3::ZERO,
        seed: Seed(7),
        carrier: None,
    }
}

/// Turns a card that lies in x and y to face along x.
fn facing() -> DQuat {
    DQuat::from_rotation_y(PI / 2.0)
}

/// A card of so many metres from its middle to its sides, across the x axis, or a ball of that radius.
fn placed(at: DVec3, half_m: f64) -> DAffine3 {
    DAffine3::from_scale_rotation_translation(DVec3::splat(half_m), facing(), PLACE + at)
}

fn plate(id: u32, class: Class) -> Instance {
    Instance {
        id: InstanceId(id),
        class,
        mesh: 0,
        materials: vec![0],
        world_from_mesh: DAffine3::IDENTITY,
        previous: None,
        next: None,
        object: None,
    }
}

/// A ball of radius 1 with smooth normals.
fn ball() -> Mesh {
    const RINGS: u32 = 48;
    const SECTORS: u32 = 96;
    let corner = |ring: u32, sector: u32| {
        let (along, up) = (f64::from(ring) / f64::from(RINGS) * PI).sin_cos();
        let (y, x) = (f64::from(sector) / f64::from(SECTORS) * 2.0 * PI).sin_cos();
        DVec3::new(along * x, along * y, up).as_vec3()
    };
    let positions: Vec<Vec3> = (0..=RINGS)
        .flat_map(|ring| (0..SECTORS).map(move |sector| (ring, sector)))
        .map(|(r, s)| corner(r, s))
        .collect();
    let at = |ring: u32, sector: u32| ring * SECTORS + sector % SECTORS;
    let quad =
        |r: u32, s: u32| [[at(r, s), at(r + 1, s), at(r + 1, s + 1)], [at(r, s), at(r + 1, s + 1), at(r, s + 1)]];
    let mut triangles: Vec<[u32; 3]> = (0..RINGS).flat_map(|r| (0..SECTORS).flat_map(move |s| quad(r, s))).collect();
    triangles.retain(|corners| {
        let [a, b, c] = corners.map(|i| positions[i as usize]);
        (b - a).cross(c - a).length() > 1e-9
    });
    Mesh { normals: positions.clone(), positions, triangles, ..Mesh::default() }
}

fn scene(instances: Vec<Instance>) -> Scene {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let card = Mesh {
        positions: corners.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let sky = EnvironmentMap { name: "white".into(), width: 2, height: 1, rgb: vec![[1.0; 3]; 2] };
    Scene {
        meshes: vec![Arc::new(card), Arc::new(ball())],
        materials: vec![Material::default()],
        instances,
        others: Default::default(),
        keyframes_apart_s: [0.5; 2],
        light: Light::clear(Environment::Map(Arc::new(sky))),
        provenance: Vec::new(),
    }
}

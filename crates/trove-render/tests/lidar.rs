//! A LiDAR's sweep against closed forms: where beams go, when, what comes back of them and how much.

#![allow(clippy::unwrap_used)] // clippy knows the tests in here, not what they call

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3, Vec3};
use trove_model::{
    Class, Environment, EnvironmentMap, Fog, Form, Instance, InstanceId, LidarPoint, LidarShot, Light, Material, Mesh,
    Placement, Pose, Precipitation, Puff, Scanner, Scene, Seed, SensorFrame, SweepPhase, ToldReturns, World,
};
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};

/// Far from the origin, where single precision has coarse steps.
const PLACE: DVec3 = DVec3::new(412.3, -633.7, 14.0);

#[test]
fn beams_go_where_the_maker_says_and_meet_a_wall_at_its_range() {
    // A wall all around would be a cylinder: one 20 m ahead, 80 m wide, is met by the beams that look at it.
    let scene = scene(vec![wall(1, Class::Building, 20.0, 40.0, 0)]);
    let mut shot = shot(still(), 0.05);
    shot.scanner.reach_m = 1000.0;
    shot.scanner.elevations_rad = [-0.3, -0.1, 0.0, 0.05, 0.2].to_vec();
    shot.scanner.columns = 360;
    let points = sweep(&scene, &shot, 2);
    for point in &points {
        let (p, column) = (point.position_m, column_of(&shot, point));
        let step_rad = TAU / 360.0;
        let azimuth = (PI - step_rad * column as f64).rem_euclid(TAU);
        let off = |a: f64, b: f64| ((a - b + PI).rem_euclid(TAU) - PI).abs().to_degrees();
        assert!(off(p.y.atan2(p.x), azimuth) < 1e-3, "{p} {column}");
        let elevation = shot.scanner.elevations_rad[usize::from(point.ring)];
        assert!(off((p.z / p.length()).asin(), elevation) < 1e-3, "{p}");
        assert!((p.x - 20.0).abs() < 1e-3, "{p}");
        assert_eq!((point.class, point.instance, point.number), (Class::Building, InstanceId(1), 0));
    }
    // Two times 63.4° of 360, and less where beams pass above or below its 80 m.
    let level = points.iter().filter(|point| point.ring == 2).count();
    assert_eq!(level, 2 * 63 + 1);
}

#[test]
fn ranges_scatter_as_the_data_sheet_says() {
    let scene = scene(vec![wall(1, Class::Building, 20.0, 40.0, 0)]);
    let mut shot = shot(still(), 0.05);
    (shot.scanner.noise_m, shot.scanner.columns, shot.scanner.reach_m) = (0.02, 20_000, 1000.0);
    shot.scanner.elevations_rad = vec![0.0];
    let points = sweep(&scene, &shot, 2);
    let errors: Vec<f64> =
        points.iter().map(|p| p.position_m.length() - 20.0 / (p.position_m.x / p.position_m.length())).collect();
    let n = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / n;
    let deviation = (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / n).sqrt();
    assert!(n > 6000.0 && mean.abs() < 1e-3 && (deviation - 0.02).abs() < 6e-4, "{n} {mean} {deviation}");
}

#[test]
fn each_beam_meets_what_moves_where_it_is_then_and_from_where_the_sensor_is_then() {
    // A wall comes nearer by 20 m/s while the sensor drives towards it by 10 m/s.
    let at = |time_s: f64| DAffine3::from_translation(PLACE + DVec3::X * (30.0 - 20.0 * time_s));
    let mut nearing = wall(1, Class::Truck, 30.0, 40.0, 0);
    let then = |t: f64| Some(Placement { mesh: 0, world_from_mesh: at(t) * DAffine3::from_quat(facing()) });
    (nearing.previous, nearing.next) = [-0.5, 0.5].map(then).into();
    nearing.world_from_mesh = at(0.0) * DAffine3::from_quat(facing());
    let scene = scene(vec![nearing]);
    let pose = |time_s: f64| Pose::<World, SensorFrame>::from_yaw(0.0, PLACE + DVec3::X * 10.0 * time_s);
    let mut shot = shot(vec![pose(-0.05), pose(0.0)], 0.05);
    (shot.phase.over, shot.world_from_lidar, shot.scanner.reach_m) = (1.0, pose(0.0), 1000.0);
    shot.scanner.elevations_rad = vec![0.0];
    let points = sweep(&scene, &shot, 2);
    assert!(points.len() > 100);
    for point in points {
        // Brought to the sensor's place at the sweep's end, where the wall has stayed behind.
        let expect = 30.0 - 20.0 * point.time_s;
        assert!((point.position_m.x - expect).abs() < 1e-3, "{point:?}: {expect}");
        assert!((-0.05..=0.0).contains(&point.time_s));
    }
}

#[test]
fn a_beam_that_is_half_on_an_edge_has_two_returns() {
    // The wall's right edge cuts the beam that looks straight ahead; another wall stands 5 m behind it.
    let near = Instance {
        world_from_mesh: DAffine3::from_translation(DVec3::new(0.0, 40.001, 0.0)) * placed(20.0, 40.0).world_from_mesh,
        ..wall(1, Class::Car, 20.0, 40.0, 0)
    };
    let scene = scene(vec![near.at_rest(), wall(2, Class::Building, 25.0, 40.0, 0)]);
    let mut shot = straight_ahead();
    for (told, expect) in [
        (ToldReturns::Dual, vec![(2, 25), (1, 20)]),
        (ToldReturns::Strongest, vec![(2, 25)]),
        (ToldReturns::Last, vec![(2, 25)]),
    ] {
        shot.scanner.told = told;
        let points = sweep(&scene, &shot, 1);
        let found: Vec<(u32, i64)> =
            points.iter().map(|p| (p.instance.0, p.position_m.length().round() as i64)).collect();
        assert_eq!(found, expect, "{told:?}");
        let numbers: Vec<u8> = points.iter().map(|p| p.number).collect();
        assert_eq!(numbers, (0..expect.len() as u8).collect::<Vec<_>>());
    }
    // A slanted wall is one surface, however far its near and far parts of a beam are apart.
    let slanted = Instance {
        world_from_mesh: DAffine3::from_translation(PLACE + DVec3::X * 40.0)
            * DAffine3::from_quat(DQuat::from_rotation_z(1.54) * facing()),
        ..wall(3, Class::Building, 40.0, 40.0, 0)
    };
    shot.scanner.told = ToldReturns::Dual;
    shot.scanner.divergence_rad = 0.02;
    let points = sweep(&self::scene(vec![slanted.at_rest()]), &shot, 1);
    assert_eq!(points.len(), 1, "{points:?}");
    assert!((points[0].position_m.x - 40.0).abs() < 1e-3);
}

#[test]
fn brightness_follows_lamberts_cosine_and_stays_with_range() {
    let mut shot = straight_ahead();
    shot.scanner.reach_m = 1000.0;
    for (range_m, turn_rad, reflectance) in [(5.0, 0.0, 0.5), (40.0, 0.0, 0.5), (10.0, 1.0, 0.5), (10.0, 0.5, 0.9)] {
        let mut wall = wall(1, Class::Building, range_m, 40.0, 0);
        wall.world_from_mesh = DAffine3::from_translation(PLACE + DVec3::X * range_m)
            * DAffine3::from_quat(DQuat::from_rotation_z(turn_rad) * facing());
        let mut scene = scene(vec![wall.at_rest()]);
        // As smooth as a body without a surface of its own can be.
        scene.materials[0] = Material { ior: 1.0, ..Material::plain("matt", Vec3::splat(reflectance), 0.0) };
        let points = sweep(&scene, &shot, 1);
        let expect = 100.0 * f64::from(reflectance) * turn_rad.cos();
        assert!((f64::from(points[0].intensity) - expect).abs() <= 1.0, "{} {expect}", points[0].intensity);
    }
}

#[test]
fn half_of_the_pulses_come_back_from_the_reach_and_fewer_from_farther() {
    let mut shot = straight_ahead();
    (shot.scanner.columns, shot.scanner.width_rad, shot.scanner.reach_m) = (4000, 1e-4, 50.0);
    let share = |range_m: f64| {
        let mut scene = scene(vec![wall(1, Class::Building, range_m, 40.0, 0)]);
        scene.materials[0] = Material { ior: 1.0, ..Material::plain("matt", Vec3::splat(0.1), 0.0) };
        sweep(&scene, &shot, 2).len() as f64 / 4000.0
    };
    let [near, at, far] = [40.0, 50.0, 65.0].map(share);
    assert!(near > 0.99 && (at - 0.5).abs() < 0.03 && far < 0.06, "{near} {at} {far}");
}

#[test]
fn glass_lets_the_beam_pass_and_sheeting_shines() {
    let mut shot = straight_ahead();
    shot.scanner.told = ToldReturns::Dual;
    let scene = scene(vec![wall(1, Class::Car, 10.0, 2.0, PANE), wall(2, Class::Building, 14.0, 40.0, 0)]);
    let behind = sweep(&scene, &shot, 1).into_iter().find(|point| point.instance.0 == 2).unwrap();
    assert!((behind.position_m.x - 14.0).abs() < 1e-3);
    let clear = sweep(&self::scene(vec![wall(2, Class::Building, 14.0, 40.0, 0)]), &shot, 1)[0];
    assert!(behind.intensity < clear.intensity, "{} {}", behind.intensity, clear.intensity);
    let sign = sweep(&self::scene(vec![wall(3, Class::TrafficSign, 80.0, 2.0, SHEETING)]), &shot, 1)[0];
    assert!(sign.intensity > 200, "{}", sign.intensity);
}

#[test]
fn fog_takes_from_echoes_on_both_ways_and_sends_some_of_its_own() {
    let fog = Fog { visibility_m: 60.0, height_m: 1e6, ground_z_m: PLACE.z };
    let walled = |fog: Option<Fog>, ahead_m: f64| {
        let mut scene = scene(vec![wall(1, Class::Building, ahead_m, 40.0, 0)]);
        scene.light.fog = fog;
        scene
    };
    let mut shot = straight_ahead();
    // What is near is not told, so that the wall's echo is the strongest.
    (shot.scanner.nearest_m, shot.scanner.reach_m) = (9.0, 1000.0);
    let clear = f64::from(sweep(&walled(None, 10.0), &shot, 1)[0].intensity);
    let dim = f64::from(sweep(&walled(Some(fog), 10.0), &shot, 1)[0].intensity);
    assert!((dim - clear * 0.05f64.powf(2.0 * 10.0 / 60.0)).abs() < 1.0, "{clear} {dim}");

    // Beams into the open: droplets near the sensor, fewer the farther away, and none in clear air.
    let mut open = self::shot(still(), 0.05);
    (open.scanner.reach_m, open.scanner.columns) = (100.0, 2000);
    let nothing = |fog| {
        let mut scene = scene(vec![wall(1, Class::Building, 190.0, 0.1, 0)]);
        scene.light.fog = fog;
        sweep(&scene, &open, 2)
    };
    let of_droplets = nothing(Some(fog));
    assert!(of_droplets.len() > 1000 && of_droplets.iter().all(|point| point.class == Class::Void));
    let within = |from_m: f64, to_m: f64| {
        of_droplets.iter().filter(|point| (from_m..to_m).contains(&point.position_m.length())).count()
    };
    assert!(within(1.0, 2.0) > 2 * within(2.0, 4.0) && within(20.0, 200.0) == 0, "{}", within(2.0, 4.0));
    assert!(nothing(None).iter().all(|point| point.class != Class::Void));
    // A wall that is in sight in clear air, and is not 60 m into fog.
    let seen = |fog| sweep(&walled(fog, 58.0), &open, 2).iter().filter(|point| point.instance.0 == 1).count();
    assert!(seen(None) > 100 && seen(Some(fog)) == 0, "{} {}", seen(None), seen(Some(fog)));
}

#[test]
fn rain_takes_from_echoes_on_both_ways_and_a_beam_meets_few_of_its_drops() {
    let heavy = Precipitation { form: Form::Rain, rate_mm_h: 100.0 };
    let walled = |rain: Option<Precipitation>, ahead_m: f64| {
        let mut scene = scene(vec![wall(1, Class::Building, ahead_m, 40.0, 0)]);
        scene.light.falling = rain;
        scene
    };
    let mut shot = straight_ahead();
    (shot.scanner.nearest_m, shot.scanner.reach_m) = (49.0, 1000.0);
    let clear = f64::from(sweep(&walled(None, 50.0), &shot, 1)[0].intensity);
    let dim = f64::from(sweep(&walled(Some(heavy), 50.0), &shot, 1)[0].intensity);
    assert!((dim - clear * (-2.0 * 50.0 * heavy.extinction_per_m()).exp()).abs() < 1.5, "{clear} {dim}");

    let mut open = self::shot(still(), 0.05);
    (open.scanner.reach_m, open.scanner.columns) = (100.0, 2000);
    let drops = |rain| {
        let points = sweep(&walled(rain, 40.0), &open, 2);
        points.iter().filter(|point| point.class == Class::Void).count()
    };
    let [none, some, many] = [None, Some(Precipitation { form: Form::Rain, rate_mm_h: 5.0 }), Some(heavy)].map(drops);
    let beams = open.scanner.columns * open.scanner.elevations_rad.len();
    assert!(none == 0 && some > 0 && 2 * some < many && many < beams / 5, "{none} {some} {many} of {beams}");
}

#[test]
fn spray_takes_from_echoes_on_both_ways_and_sends_some_of_its_own_from_where_it_is() {
    let puff = Puff { centre: PLACE + DVec3::X * 8.0, radius_m: [1.5, 1.0], extinction_per_m: 0.5 };
    let depth = puff.optical_depth(PLACE, DVec3::X, 30.0);
    let mut scene = scene(vec![wall(1, Class::Building, 20.0, 40.0, 0)]);
    let mut shot = straight_ahead();
    (shot.scanner.nearest_m, shot.scanner.reach_m) = (19.0, 1000.0);
    let clear = f64::from(sweep(&scene, &shot, 1)[0].intensity);
    scene.light.spray = vec![vec![puff]];
    let dim = f64::from(sweep(&scene, &shot, 1)[0].intensity);
    assert!((dim - clear * (-2.0 * depth).exp()).abs() < 1.0, "{clear} {dim} {depth}");

    let mut all = self::shot(still(), 0.05);
    (all.scanner.reach_m, all.scanner.columns) = (100.0, 2000);
    let of_spray: Vec<_> = sweep(&scene, &all, 2).into_iter().filter(|point| point.class == Class::Void).collect();
    let off_m = |point: &LidarPoint| (point.position_m - DVec3::X * 8.0).length();
    assert!(of_spray.len() > 20 && of_spray.iter().all(|point| off_m(point) < 1.5), "{}", of_spray.len());
}

#[test]
fn any_number_of_threads_makes_the_same_sweep() {
    let scene = scene(vec![wall(1, Class::Building, 45.0, 40.0, 0), wall(2, Class::Car, 12.0, 1.0, 0)]);
    let mut shot = shot(still(), 0.05);
    (shot.scanner.noise_m, shot.scanner.reach_m) = (0.02, 45.0);
    let one = sweep(&scene, &shot, 1);
    assert!(one.len() > 100 && one == sweep(&scene, &shot, 4));
    assert_ne!(one, sweep(&scene, &LidarShot { seed: Seed(8), ..shot }, 1), "noise and drop-out are the seed's");
}

const PANE: usize = 1;
const SHEETING: usize = 2;

fn sweep(scene: &Scene, shot: &LidarShot, threads: usize) -> Vec<LidarPoint> {
    let options =
        RendererOptions { kernel: KernelChoice::Obvhs, denoise: Denoising::None, threads, ..Default::default() };
    let renderer = Renderer::new(&options).unwrap();
    renderer.sweep(&renderer.prepare(scene).unwrap(), shot).points
}

fn still() -> Vec<Pose<World, SensorFrame>> {
    vec![Pose::from_yaw(0.0, PLACE); 2]
}

/// The number of a point's column, by its time.
fn column_of(shot: &LidarShot, point: &LidarPoint) -> usize {
    let share = point.time_s / shot.scanner.sweep_s + shot.phase.over;
    (share * shot.scanner.columns as f64).round() as usize
}

fn shot(way: Vec<Pose<World, SensorFrame>>, sweep_s: f64) -> LidarShot {
    LidarShot {
        view: "ego.LIDAR".into(),
        scanner: Scanner {
            name: "test".into(),
            elevations_rad: vec![-0.1, 0.0, 0.1],
            width_rad: TAU,
            columns: 720,
            sweep_s,
            divergence_rad: 0.002,
            nearest_m: 1.0,
            farthest_m: 200.0,
            reach_m: 100.0,
            noise_m: 0.0,
            pulse_m: 0.8,
            intensity_exponent: 1.0,
            told: ToldReturns::Strongest,
        },
        phase: SweepPhase { begins_at_rad: PI, over: 0.5 },
        time_ns: 0,
        world_from_lidar: way[0],
        world_from_ego: Pose::IDENTITY,
        way,
        seed: Seed(7),
        carrier: None,
    }
}

/// One beam along x.
fn straight_ahead() -> LidarShot {
    let mut shot = shot(still(), 0.05);
    (shot.scanner.columns, shot.scanner.width_rad) = (1, 1e-6);
    shot.scanner.elevations_rad = vec![0.0];
    shot
}

/// Turns a card that lies in x and y to face along x.
fn facing() -> DQuat {
    DQuat::from_rotation_y(PI / 2.0)
}

fn placed(ahead_m: f64, half_m: f64) -> Instance {
    wall(1, Class::Car, ahead_m, half_m, 0)
}

/// A square across the x axis.
fn wall(id: u32, class: Class, ahead_m: f64, half_m: f64, material: usize) -> Instance {
    let scale = DVec3::splat(half_m / 40.0);
    let place = PLACE + DVec3::X * ahead_m;
    let world_from_mesh = DAffine3::from_scale_rotation_translation(scale, facing(), place);
    Instance {
        id: InstanceId(id),
        class,
        mesh: 0,
        materials: vec![material],
        world_from_mesh,
        previous: None,
        next: None,
        object: None,
    }
    .at_rest()
}

fn scene(instances: Vec<Instance>) -> Scene {
    let corners = [(-40.0, -40.0), (40.0, -40.0), (40.0, 40.0), (-40.0, 40.0)];
    let card = Mesh {
        positions: corners.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let sky = EnvironmentMap { name: "white".into(), width: 2, height: 1, rgb: vec![[1.0; 3]; 2] };
    let pane = Material { transmission: 0.9, ..Material::plain("pane", Vec3::ONE, 0.0) };
    let sheeting = Material { retroreflection: 1.0, ..Material::default() };
    Scene {
        meshes: vec![Arc::new(card)],
        materials: vec![Material::default(), pane, sheeting],
        instances,
        others: Default::default(),
        keyframes_apart_s: [0.5; 2],
        light: Light::clear(Environment::Map(Arc::new(sky))),
        provenance: Vec::new(),
    }
}

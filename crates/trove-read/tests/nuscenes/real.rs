//! The two real scenes in `TROVE_TEST_DATA`, against numbers that nuscenes-devkit 1.2.0 gives for them.

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::{DVec2, DVec3};
use trove_model::{Drive, Report};
use trove_read::nuscenes::NuScenes;

fn drive(scene: &str) -> (Drive, Report) {
    let data = std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA");
    let report = Report::default();
    let root = PathBuf::from(data).join("nuscenes");
    let drive = NuScenes::open(&root, "v1.0-mini", None, &report).unwrap().drive(scene, &report).unwrap();
    (drive, report)
}

fn boxes_by_category(drive: &Drive) -> Vec<(&str, usize)> {
    let mut counts = BTreeMap::new();
    drive.keyframes.iter().flat_map(|k| &k.boxes).for_each(|b| *counts.entry(b.category.as_str()).or_default() += 1);
    counts.into_iter().collect()
}

/// How many boxes have no velocity, and the sum of the others' speeds (the devkit rounds times to a quarter of a
/// microsecond, which shows in the fifth decimal).
fn speeds(drive: &Drive) -> (usize, f64) {
    let boxes = || drive.keyframes.iter().flat_map(|k| &k.boxes);
    let known: Vec<f64> = boxes().filter_map(|b| b.velocity_mps.map(DVec3::length)).collect();
    (boxes().count() - known.len(), known.iter().sum())
}

/// Where the centre of a box of the first keyframe falls in the front camera.
fn centre_px(drive: &Drive, annotation: &str) -> DVec2 {
    let keyframe = &drive.keyframes[0];
    let object = keyframe.boxes.iter().find(|b| b.token == annotation).unwrap();
    let front = keyframe.exposures.iter().find(|e| drive.rig[e.camera].name == "CAM_FRONT").unwrap();
    let centre_camera = front.world_from_camera().inverse().point(object.cuboid.world_from_body.translation);
    front.lens.project(centre_camera).unwrap()
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_scene_0061_is_what_the_devkit_says() {
    let (drive, report) = drive("scene-0061");
    assert_eq!((drive.keyframes.len(), drive.rig.len(), drive.tracks.len()), (39, 6, 225));
    assert!(drive.keyframes.iter().all(|k| k.exposures.len() == 6));
    let expected = [
        ("human.pedestrian.adult", 1229),
        ("human.pedestrian.construction_worker", 164),
        ("movable_object.barrier", 1540),
        ("movable_object.trafficcone", 1003),
        ("vehicle.bicycle", 68),
        ("vehicle.bus.rigid", 32),
        ("vehicle.car", 348),
        ("vehicle.construction", 64),
        ("vehicle.motorcycle", 59),
        ("vehicle.truck", 157),
    ];
    assert_eq!(boxes_by_category(&drive), expected);
    let (unknown, sum_mps) = speeds(&drive);
    assert!(unknown == 15 && (sum_mps - 2111.473188).abs() < 1e-3, "{unknown} {sum_mps}");
    let front = drive.keyframes[0].exposures.iter().find(|e| drive.rig[e.camera].name == "CAM_FRONT").unwrap();
    let expected = DVec3::new(411.41997584800345 - 411.0, 1181.197177405937 - 1181.0, 8.711842003350512e-08);
    // Levelling turns the picture's pose about the keyframe's by a fraction of a degree.
    assert!(front.world_from_ego.translation.distance(expected) < 2e-3);
    assert_eq!(front.time_ns, 1_532_402_927_612_460_000);
    let centre = centre_px(&drive, "62467e5dae9200295b0f718ffba4d529");
    assert!(centre.distance(DVec2::new(1508.19116648, 580.7217097)) < 1e-5, "{centre}");
    let sweeps: Vec<_> = drive.keyframes.iter().filter_map(|k| k.lidar.as_ref()).collect();
    assert!(sweeps.len() == 1 && sweeps[0].points_world.len() == 34_688);
    assert!(drive.keyframes[0].exposures.iter().all(|e| e.file.is_some()));
    assert!(report.entries().iter().all(|e| !e.what.contains("annotation")), "{:?}", report.entries());
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_a_barrier_of_scene_0061_holds_the_lidar_points_that_its_annotation_counts() {
    let (drive, _) = drive("scene-0061");
    let sweep = drive.keyframes[0].lidar.as_ref().unwrap();
    let counted = |b: &trove_model::ObjectBox| {
        sweep.points_world.iter().filter(|p| b.cuboid.contains(p.as_dvec3())).count() as f64
    };
    let known: Vec<_> = drive.keyframes[0].boxes.iter().filter(|b| b.lidar_points.is_some()).collect();
    assert!(known.len() > 50);
    let expected: f64 = known.iter().filter_map(|b| b.lidar_points).map(f64::from).sum();
    let found: f64 = known.iter().map(|b| counted(b)).sum();
    assert!((found / expected - 1.0).abs() < 0.02, "{found} of {expected}");
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_scene_0103_is_what_the_devkit_says() {
    let (drive, _) = drive("scene-0103");
    assert_eq!((drive.keyframes.len(), drive.rig.len(), drive.tracks.len()), (40, 6, 123));
    let expected = [
        ("human.pedestrian.adult", 885),
        ("human.pedestrian.child", 46),
        ("movable_object.pushable_pullable", 19),
        ("movable_object.trafficcone", 39),
        ("static_object.bicycle_rack", 36),
        ("vehicle.bicycle", 30),
        ("vehicle.car", 970),
        ("vehicle.motorcycle", 27),
        ("vehicle.truck", 38),
    ];
    assert_eq!(boxes_by_category(&drive), expected);
    let (unknown, sum_mps) = speeds(&drive);
    assert!(unknown == 8 && (sum_mps - 1955.083824).abs() < 1e-3, "{unknown} {sum_mps}");
    let centre = centre_px(&drive, "e689fcb4d3182994ef2a940a0494abf5");
    assert!(centre.distance(DVec2::new(1389.67867683, 521.15808278)) < 1e-5, "{centre}");
    assert!(drive.keyframes.iter().all(|k| k.lidar.is_none()));
    // The driven path lies on the map's drivable area.
    let map = drive.lane_map.as_ref().unwrap();
    let on_road = |k: &&trove_model::Keyframe| {
        let position = k.world_from_ego.translation.truncate();
        map.drivable.iter().any(|p| p.contains(position))
    };
    assert_eq!(drive.keyframes.iter().filter(on_road).count(), 40);
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_the_lanes_of_scene_0103_run_the_way_that_the_ego_drives() {
    let (drive, _) = drive("scene-0103");
    let map = drive.lane_map.as_ref().unwrap();
    let lanes: Vec<_> = map.lanes.iter().filter(|l| l.centreline.len() >= 2).collect();
    let (mut along, mut judged) = (0, 0);
    for keyframe in &drive.keyframes {
        let position = keyframe.world_from_ego.translation.truncate();
        let heading = keyframe.world_from_ego.vector(DVec3::X).truncate();
        for lane in lanes.iter().filter(|l| l.polygon.contains(position)) {
            let nearest = lane.centreline.windows(2).min_by(|a, b| {
                a[0].midpoint(a[1]).distance(position).total_cmp(&b[0].midpoint(b[1]).distance(position))
            });
            let [a, b] = nearest.unwrap() else { continue };
            judged += 1;
            along += usize::from((*b - *a).normalize().dot(heading) > 0.9);
        }
    }
    assert!(lanes.len() * 10 >= map.lanes.len() * 8, "{} of {} lanes have a line", lanes.len(), map.lanes.len());
    assert!(judged >= 20 && along * 10 >= judged * 9, "{along} of {judged}");
}

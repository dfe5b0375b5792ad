//! The real log in `TROVE_TEST_DATA`, against its own numbers and OSM's roads.

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::{DVec2, DVec3};
use serde_json::Value;
use trove_model::{Bounds, Drive, DrivingSide, Report};
use trove_read::argoverse2::Argoverse2;
use trove_read::osm::{self, GeoJsonFrame};

use super::utm::{PITTSBURGH_UTM_M, utm};

const LOG: &str = "7fab2350-7eaf-3b7e-a39d-6937a4c1bede";

fn data() -> PathBuf {
    PathBuf::from(std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA")).join("argoverse2")
}

fn drive() -> (Drive, Report) {
    let report = Report::default();
    let drive = Argoverse2::open(&data(), &report).unwrap().drive(LOG, &report).unwrap();
    (drive, report)
}

fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_log_is_what_its_tables_hold() {
    let (drive, report) = drive();
    assert_eq!((drive.keyframes.len(), drive.rig.len(), drive.place.as_str()), (156, 9, "PIT"));
    let mut counts = BTreeMap::<&str, usize>::new();
    drive.keyframes.iter().flat_map(|k| &k.boxes).for_each(|b| *counts.entry(&b.category).or_default() += 1);
    let expected = [
        ("BICYCLE", 749),
        ("BOLLARD", 676),
        ("BOX_TRUCK", 156),
        ("CONSTRUCTION_CONE", 118),
        ("MOTORCYCLE", 394),
        ("PEDESTRIAN", 2073),
        ("REGULAR_VEHICLE", 6766),
        ("STROLLER", 122),
        ("TRUCK_CAB", 155),
        ("VEHICULAR_TRAILER", 155),
    ];
    assert_eq!(counts.into_iter().collect::<Vec<_>>(), expected);
    assert_eq!(drive.path.moments().len(), 2706);
    for keyframe in &drive.keyframes {
        let on_path = drive.path.at(keyframe.time_ns).unwrap();
        assert!(on_path.translation.distance(keyframe.world_from_ego.translation) < 1e-9);
    }
    let sweeps: Vec<_> = drive.keyframes.iter().filter_map(|k| Some(k.lidar.as_ref()?.points_world.len())).collect();
    assert_eq!((sweeps.len(), sweeps[0]), (2, 99_229));
    let map = drive.lane_map.as_ref().unwrap();
    // 183 segments of which 20 are for bicycles.
    assert_eq!((map.lanes.len(), map.drivable.len(), map.crossings.len()), (163, 13, 11));
    let dropped: Vec<_> = report.entries().into_iter().filter(|e| e.outcome.name() == "dropped").collect();
    assert!(dropped.iter().all(|e| e.what.contains("bicycle lane") && e.count == 20), "{dropped:?}");
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_wheels_and_boxes_stand_on_the_dataset_s_ground() {
    let (drive, _) = drive();
    let ground = &drive.lane_map.as_ref().unwrap().ground;
    let above_m = |point: DVec3| {
        let nearest = ground.iter().min_by(|a, b| {
            let apart = |p: &DVec3| p.truncate().distance_squared(point.truncate());
            apart(a).total_cmp(&apart(b))
        });
        point.z - nearest.unwrap().z
    };
    let wheels = sorted(drive.keyframes.iter().map(|k| above_m(k.world_from_ego.translation)).collect());
    assert!(
        wheels[78].abs() < 0.03 && wheels[8] > -0.1 && wheels[148] < 0.1,
        "{} {} {}",
        wheels[8],
        wheels[78],
        wheels[148]
    );
    let objects = drive.keyframes.iter().step_by(30).flat_map(|k| &k.boxes).filter(|b| b.lidar_points > Some(20));
    let bottoms =
        objects.map(|b| above_m(b.cuboid.world_from_body.point(DVec3::new(0.0, 0.0, -b.cuboid.size_m.z / 2.0))));
    let bottoms = sorted(bottoms.map(f64::abs).collect());
    let (median, p90) = (bottoms[bottoms.len() / 2], bottoms[bottoms.len() * 9 / 10]);
    println!("wheels {:.3} m, bottoms {median:.3} m (median), {p90:.3} m (p90)", wheels[78]);
    assert!(median < 0.04 && p90 < 0.15, "{median} {p90}");
}

/// Of the points around a box (within half a metre of it in its plane, above its bottom by more than 0.2 m and not above its
/// top by more than 0.5 m), the share that lies inside it or within 0.3 m of it.
#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_lidar_points_around_boxes_lie_in_them_or_near_their_surface() {
    let (drive, _) = drive();
    let (mut near, mut all) = (0usize, 0usize);
    for keyframe in &drive.keyframes {
        let Some(sweep) = &keyframe.lidar else { continue };
        for object in &keyframe.boxes {
            let (body_from_world, half) = (object.cuboid.world_from_body.inverse(), object.cuboid.size_m / 2.0);
            for point in &sweep.points_world {
                let p = body_from_world.point(point.as_dvec3());
                let off = (p.abs() - half).max(DVec3::ZERO);
                if off.x <= 0.5 && off.y <= 0.5 && p.z > 0.2 - half.z && p.z < half.z + 0.5 {
                    all += 1;
                    near += usize::from(off.length() <= 0.3);
                }
            }
        }
    }
    let share = near as f64 / all as f64;
    println!("{near} of {all} points: {:.2} %", 100.0 * share);
    assert!(all > 10_000 && share >= 0.9, "{near} of {all}");
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_roads_in_the_city_s_plane_lie_in_world_where_they_lie_on_earth() {
    let (drive, _) = drive();
    let path = data().join("osm_roads_PIT_cityframe.geojson");
    let area = Bounds::square(DVec2::ZERO, 2000.0);
    let report = Report::default();
    let map = osm::read_in(GeoJsonFrame::Dataset, &path, &drive.projection, area, DrivingSide::Right, &report).unwrap();
    assert!(map.roads.len() > 50, "{}", map.roads.len());
    let text = std::fs::read(&path).unwrap();
    let roads: Value = serde_json::from_slice(&text).unwrap();
    let mut in_city: Vec<DVec2> = Vec::new();
    for feature in roads["features"].as_array().unwrap() {
        in_city.extend(
            serde_json::from_value::<Vec<DVec2>>(feature["geometry"]["coordinates"].clone()).unwrap_or_default(),
        );
    }
    // Through degrees and another program's UTM, of what lies within the kilometre that the plane is true for.
    for world in map.roads.iter().flat_map(|road| &road.centreline).filter(|p| p.length() < 500.0) {
        let (lat_deg, lon_deg) = drive.projection.geo_from_world(*world);
        let city = utm(17, lat_deg, lon_deg) - PITTSBURGH_UTM_M;
        let off_m = in_city.iter().map(|p| p.distance(city)).fold(f64::INFINITY, f64::min);
        assert!(off_m < 0.05, "{world}: {off_m}");
    }
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_path_runs_on_osm_s_roads() {
    let (drive, _) = drive();
    let text = std::fs::read(data().join("osm_roads_PIT_cityframe.geojson")).unwrap();
    let roads: Value = serde_json::from_slice(&text).unwrap();
    let mut edges = Vec::new();
    for feature in roads["features"].as_array().unwrap() {
        let line: Vec<DVec2> = serde_json::from_value(feature["geometry"]["coordinates"].clone()).unwrap_or_default();
        edges.extend(line.windows(2).map(|w| (w[0], w[1])));
    }
    assert!(edges.len() > 3000);
    let distance_m = |world: DVec2| {
        let (lat_deg, lon_deg) = drive.projection.geo_from_world(world);
        let city = utm(17, lat_deg, lon_deg) - PITTSBURGH_UTM_M;
        let to = |(a, b): &(DVec2, DVec2)| {
            let t = ((city - *a).dot(*b - *a) / (*b - *a).length_squared().max(1e-9)).clamp(0.0, 1.0);
            a.lerp(*b, t).distance(city)
        };
        edges.iter().map(to).fold(f64::INFINITY, f64::min)
    };
    let path = sorted(drive.keyframes.iter().map(|k| distance_m(k.world_from_ego.translation.truncate())).collect());
    println!("path to OSM's road lines: {:.2} m (median), {:.2} m (p90)", path[78], path[140]);
    assert!(path[78] < 3.0 && path[140] < 5.0, "{} {}", path[78], path[140]);
}

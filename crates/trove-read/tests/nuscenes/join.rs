//! The join, in numbers that can be worked out by hand.

use glam::{DVec2, DVec3};
use serde_json::json;
use trove_model::{Drive, Kind, LidarClass, Outcome, Report};

use super::fixture::{Dataset, START_US, load, notes, put};

fn drive(dataset: &Dataset) -> Drive {
    load(dataset.write().path(), &Report::default()).unwrap()
}

#[test]
fn every_camera_has_its_own_time_and_pose_and_world_begins_at_the_anchor() {
    let drive = drive(&Dataset::small());
    assert_eq!(drive.projection.anchor_m, DVec2::new(100.0, 201.0));
    assert_eq!(drive.rig.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["CAM_BACK", "CAM_FRONT"]);
    assert_eq!(
        drive.keyframes.iter().map(|k| k.time_ns).collect::<Vec<_>>(),
        [0, 500, 1000].map(|ms| START_US * 1000 + ms * 1_000_000)
    );
    let keyframe = &drive.keyframes[1];
    assert!(keyframe.world_from_ego.translation.distance(DVec3::new(5.4, -0.4, 0.25)) < 1e-9);
    // CAM_FRONT fires 20 ms before the LiDAR and CAM_BACK 20 ms after, at 10 m/s.
    let x_m: Vec<f64> = keyframe.exposures.iter().map(|e| e.world_from_ego.translation.x).collect();
    assert!((x_m[0] - 5.6).abs() < 1e-6 && (x_m[1] - 5.2).abs() < 1e-6, "{x_m:?}");
    let front = &keyframe.exposures[1];
    assert_eq!(front.time_ns, keyframe.time_ns - 20_000_000);
    // The front camera looks along the ego's x axis, 1 m before and 1.5 m above its origin.
    let ahead_camera = front.world_from_camera().inverse().point(DVec3::new(16.2, -0.4, 1.75));
    assert!(ahead_camera.distance(DVec3::new(0.0, 0.0, 10.0)) < 1e-6, "{ahead_camera}");
    assert_eq!(front.file, None);
}

#[test]
fn boxes_are_length_width_height_with_the_devkits_velocity() {
    let drive = drive(&Dataset::small());
    let [car, bicycle] = drive.keyframes[0].boxes.as_slice() else { panic!("two boxes") };
    assert_eq!(car.cuboid.size_m, DVec3::new(4.5, 2.0, 1.5));
    assert_eq!(car.cuboid.world_from_body.translation, DVec3::new(20.0, -1.0, 0.75));
    assert!(car.velocity_mps.unwrap().distance(DVec3::new(5.0, 0.0, 0.0)) < 1e-9);
    assert_eq!((car.visibility, car.lidar_points), (Some(0.5), Some(7)));
    assert_eq!((bicycle.visibility, bicycle.lidar_points), (None, None));
    assert_eq!((car.kind, bicycle.kind), (Kind::Car, Kind::BicycleWithRider));
    assert_eq!(drive.tracks.iter().map(|t| t.boxes.len()).collect::<Vec<_>>(), [3, 3]);
}

#[test]
fn neighbours_too_far_apart_in_time_tell_no_velocity() {
    let slow = Dataset::small()
        .with("sample", |rows| rows[1]["timestamp"] = json!(START_US + 1_600_000))
        .with("sample", |rows| rows[2]["timestamp"] = json!(START_US + 2_900_000));
    let speeds: Vec<_> = drive(&slow).keyframes.iter().map(|k| k.boxes[0].velocity_mps.map(|v| v.x)).collect();
    assert_eq!(speeds[0], None); // 1.6 s to the next, and none before
    assert!((speeds[1].unwrap() - 5.0 / 2.9).abs() < 1e-9); // 2.9 s between both neighbours
    assert!(speeds[2].is_some()); // 1.3 s
}

#[test]
fn lidar_points_come_through_the_sensors_own_pose_with_their_labels() {
    let numbered = |row: &mut serde_json::Value, index: u8| row["index"] = json!(index);
    let dataset = Dataset::small()
        .with("lidarseg", |rows| {
            rows.push(json!({"token": "q", "sample_data_token": "d-LIDAR_TOP-0", "filename": "lidarseg/q.bin"}));
        })
        .with("category", |rows| {
            rows.push(json!({"token": "g2", "name": "static.vegetation", "description": ""}));
            rows.iter_mut().zip([17, 14, 30]).for_each(|(row, index)| numbered(row, index));
        });
    let root = dataset.write();
    let floats = [[2.0f32, 1.0, -0.5, 9.0, 0.0], [f32::NAN, 0.0, 0.0, 0.0, 0.0], [0.0, 3.0, 0.0, 0.0, 0.0]];
    let bytes: Vec<u8> = floats.iter().flatten().flat_map(|f| f.to_le_bytes()).collect();
    put(root.path(), "samples/LIDAR_TOP/0.bin", &bytes);
    put(root.path(), "samples/LIDAR_TOP/1.bin", &bytes[..50]);
    put(root.path(), "lidarseg/q.bin", &[30, 30, 17]);

    let report = Report::default();
    let drive = load(root.path(), &report).unwrap();
    let sweep = drive.keyframes[0].lidar.as_ref().unwrap();
    // The sensor's x axis is the ego's y axis; the ego is at (0.4, −0.4, 0.25), the sensor at (1, 0, 1.5) on it.
    assert!(sweep.points_world[0].distance(glam::Vec3::new(0.4, 1.6, 1.25)) < 1e-6, "{:?}", sweep.points_world);
    assert_eq!(sweep.classes, [LidarClass::Vegetation, LidarClass::Other]);
    assert_eq!(drive.keyframes.iter().filter(|k| k.lidar.is_some()).count(), 1);
    let said = notes(&report);
    assert!(said.contains(&(Outcome::Dropped, "truncated LiDAR sweep".to_owned(), 1)), "{said:?}");
    assert!(said.contains(&(Outcome::Dropped, "LiDAR point that is not a number".to_owned(), 1)), "{said:?}");
}

#[test]
fn the_map_around_the_drive_is_read_and_what_lies_far_is_not() {
    let square = |name: &str, x: f64, y: f64| {
        let corners = [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0), (10.0, 0.0)];
        let node =
            |(i, (dx, dy)): (usize, &(f64, f64))| json!({"token": format!("{name}{i}"), "x": x + dx, "y": y + dy});
        corners.iter().enumerate().map(node).collect::<Vec<_>>()
    };
    let ring = |name: &str| (0..4).map(|i| format!("{name}{i}")).collect::<Vec<_>>();
    let nodes = [square("n", 110.0, 190.0), square("f", 900.0, 190.0)].concat();
    let map = json!({
        "node": nodes,
        "polygon": [{"token": "near", "exterior_node_tokens": ring("n"), "holes": []},
            {"token": "far", "exterior_node_tokens": ring("f"), "holes": []},
            {"token": "torn", "exterior_node_tokens": ["n0", "n1", "missing"], "holes": []}],
        "line": [{"token": "line", "node_tokens": ["n0", "n1"]}],
        "drivable_area": [{"token": "d", "polygon_tokens": ["near", "far", "torn"]}],
        "lane": [{"token": "lane", "polygon_token": "near"}],
        "road_divider": [{"token": "r", "line_token": "line"}],
        "arcline_path_3": {"lane": [{"start_pose": [110.0, 195.0, 0.0], "end_pose": [120.0, 195.0, 0.0],
            "shape": "LSR", "radius": 50.0, "segment_length": [0.0, 10.0, 0.0]}]},
    });
    let root = Dataset::small().write();
    put(root.path(), "maps/expansion/boston-seaport.json", map.to_string().as_bytes());
    let report = Report::default();
    let map = load(root.path(), &report).unwrap().lane_map.unwrap();
    assert_eq!(map.drivable.len(), 1);
    assert_eq!(map.drivable[0].bounds().unwrap().min, DVec2::new(10.0, -11.0));
    assert!(map.drivable[0].area_m2() == 100.0 && map.drivable == vec![map.lanes[0].polygon.clone()]);
    assert_eq!(map.lanes[0].centreline, [DVec2::new(10.0, -6.0), DVec2::new(20.0, -6.0)]);
    assert_eq!(map.road_dividers.len(), 1);
    let torn = "nuScenes map drivable_area: its outline has unknown or too few nodes".to_owned();
    assert_eq!(notes(&report), [(Outcome::Dropped, torn, 1)]);
}

#[test]
fn a_made_up_place_says_where_it_lies() {
    let of = |change: &dyn Fn(&mut serde_json::Value)| {
        let (report, dataset) = (Report::default(), Dataset::small().with("log", |rows| change(&mut rows[0])));
        let drive = load(dataset.write().path(), &report).unwrap();
        let is_warned = notes(&report).iter().any(|(_, what, _)| what.contains("unknown origin"));
        assert_eq!(drive.is_georeferenced, !is_warned);
        (drive.projection.origin_lat_deg, is_warned, drive.licence)
    };
    assert_eq!(of(&|_| ()).0, 42.336849169438615);
    let (lat_deg, is_warned, _) = of(&|log| log["location"] = json!("atlantis"));
    assert!(lat_deg == 0.0 && is_warned);
    let made_up = of(&|log| {
        log["location"] = json!("atlantis");
        log["trove_origin_lat_deg"] = json!(48.5);
        log["trove_origin_lon_deg"] = json!(9.0);
        log["trove_licence"] = json!("CC0");
    });
    assert_eq!(made_up, (48.5, false, "CC0".to_owned()));
}

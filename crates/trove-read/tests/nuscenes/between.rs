//! What was recorded between the keyframes: LiDAR sweeps with their poses, and the CAN bus.

use glam::DVec3;
use serde_json::{Value, json};
use trove_model::{Drive, Report};

use super::fixture::{Dataset, START_US, load, notes, put};

const CAN_BUS: &str = "can_bus/scene-0001_pose.json";

/// The drive and what is said of it, but that there is no map.
fn read(root: &std::path::Path) -> (Drive, Vec<String>) {
    let report = Report::default();
    let drive = load(root, &report).unwrap();
    let said = notes(&report).into_iter().map(|(_, what, _)| what);
    (drive, said.filter(|what| !what.contains("map expansion")).collect())
}

/// Milliseconds from the start, and metres from the first keyframe's vehicle, of each pose of the path.
fn path(drive: &Drive) -> Vec<(i64, f64)> {
    let start = drive.keyframes[0].world_from_ego.translation;
    let place = |(time_ns, pose): &(i64, trove_model::Pose<_, _>)| {
        ((time_ns / 1000 - START_US) / 1000, (pose.translation.x - start.x).round())
    };
    drive.path.moments().iter().map(place).collect()
}

fn sweep(root: &std::path::Path, file: &str) {
    let points: Vec<u8> =
        (0..10u8).flat_map(|i| [f32::from(i), 4.0, -1.8, 0.5, 7.0]).flat_map(f32::to_le_bytes).collect();
    put(root, file, &points);
}

/// Messages every 20 ms from the first keyframe to the last, of the vehicle as the tables have it.
fn messages() -> Vec<Value> {
    let message = |i: i64| {
        json!({"accel": [0.0, 0.0, 9.8], "orientation": [1.0, 0.0, 0.0, 0.0], "rotation_rate": [0.0, 0.0, 0.0],
            "pos": [100.4 + 0.2 * i as f64, 200.6, 0.25], "vel": [10.0, 0.0, 0.0], "utime": START_US + i * 20_000})
    };
    (0..=50).map(message).collect()
}

/// A dataset with these messages, and what is said of it.
fn with_can_bus(messages: &[Value]) -> (Drive, Vec<String>) {
    let root = Dataset::small().write();
    put(root.path(), CAN_BUS, json!(messages).to_string().replace("\"NaN\"", "NaN").as_bytes());
    read(root.path())
}

#[test]
fn the_path_goes_through_the_lidars_poses_between_the_keyframes() {
    let (drive, said) = read(Dataset::small().write().path());
    assert_eq!(path(&drive), [(0, 0.0), (250, 3.0), (500, 5.0), (750, 8.0), (1000, 10.0), (1250, 13.0)]);
    assert_eq!((drive.sweeps.len(), said.len()), (0, 0), "{said:?}");
    for keyframe in &drive.keyframes {
        assert_eq!(drive.path.at(keyframe.time_ns), Some(keyframe.world_from_ego));
    }
    let keyframes_alone = Dataset::small().with("sample_data", |rows| rows.retain(|row| row["is_key_frame"] == true));
    let (drive, _) = read(keyframes_alone.write().path());
    assert_eq!(path(&drive), [], "no more is known than the keyframes");
}

#[test]
fn a_broken_record_between_keyframes_is_left_out_and_reported() {
    let sweep = |i: usize| format!("d-LIDAR_TOP-{i}-sweep");
    let check = |table: &'static str, change: &dyn Fn(&mut Value), expect: &str| {
        let change = |rows: &mut Vec<Value>| change(rows.iter_mut().find(|row| row["token"] == sweep(1)).unwrap());
        let (drive, said) = read(Dataset::small().with(table, change).write().path());
        assert_eq!(path(&drive).len(), 5, "{expect}");
        assert!(drive.keyframes.len() == 3 && said.iter().any(|what| what.contains(expect)), "{expect}: {said:?}");
    };
    check("ego_pose", &|row| row["translation"][0] = json!("NaN"), "ego_pose record that cannot be read");
    check("ego_pose", &|row| row["rotation"] = json!([0, 0, 0, 0]), "ego_pose without a valid pose");
    check("ego_pose", &|row| row["token"] = json!("?"), "sample_data: unknown ego_pose");
    check("sample_data", &|row| row["timestamp"] = json!("late"), "sample_data record that cannot be read");
    check("sample_data", &|row| row["timestamp"] = json!(START_US), "of a time that another has");
    check("sample_data", &|row| row["sample_token"] = json!("?"), "of an unknown sample");
    check("sample_data", &|row| row["token"] = json!(sweep(0)), "duplicate token");
}

#[test]
fn records_in_any_order_give_the_same_path() {
    let (drive, _) = read(Dataset::small().write().path());
    let (backwards, said) = read(Dataset::small().with("sample_data", |rows| rows.reverse()).write().path());
    assert_eq!((backwards.path, said.len()), (drive.path, 0));
}

#[test]
fn sweeps_are_read_where_the_vehicle_has_moved_on() {
    let root = Dataset::small().with("sample_data", |rows| {
        // One more 10 ms after another, where the vehicle has hardly moved.
        let mut again = rows.iter().find(|row| row["token"] == "d-LIDAR_TOP-1-sweep").unwrap().clone();
        (again["token"], again["timestamp"]) = (json!("again"), json!(START_US + 760_000));
        rows.push(again);
    });
    let root = root.write();
    for file in ["samples/LIDAR_TOP/1.bin", "sweeps/LIDAR_TOP/1.bin", "sweeps/LIDAR_TOP/2.bin"] {
        sweep(root.path(), file);
    }
    let (drive, said) = read(root.path());
    let times_ms: Vec<_> = drive.sweeps.iter().map(|s| (s.time_ns / 1000 - START_US) / 1000).collect();
    assert_eq!((times_ms, said.len()), (vec![750, 1250], 0), "{said:?}");
    // The LiDAR's x axis is the ego's y axis; it sits 1 m before and 1.5 m above Ego, which has driven 7.5 m.
    let seen = &drive.sweeps[0].lidar;
    assert!(seen.origin_world.distance(DVec3::new(8.9, -0.4, 1.75)) < 1e-6, "{}", seen.origin_world);
    assert!(seen.points_world[2].as_dvec3().distance(DVec3::new(4.9, 1.6, -0.05)) < 1e-5, "{}", seen.points_world[2]);
    put(root.path(), "sweeps/LIDAR_TOP/1.bin", &[0; 50]);
    let (drive, said) = read(root.path());
    assert_eq!((drive.sweeps.len(), said), (1, vec!["truncated LiDAR sweep".to_owned()]));
}

#[test]
fn the_can_bus_has_the_path_more_densely() {
    let (drive, said) = with_can_bus(&messages());
    assert_eq!(said, [""; 0]);
    // 51 messages, and the LiDAR's last pose after them.
    assert_eq!((drive.path.moments().len(), path(&drive)[51]), (52, (1250, 13.0)));
    let at = |ms: i64| drive.path.at((START_US + ms * 1000) * 1000).unwrap().translation;
    assert!(at(30).distance(DVec3::new(0.7, -0.4, 0.25)) < 1e-6, "{}", at(30));
}

#[test]
fn a_can_bus_that_cannot_be_trusted_is_reported_and_left_out() {
    let check = |change: &dyn Fn(&mut Vec<Value>), poses: usize, expect: &str| {
        let mut messages = messages();
        change(&mut messages);
        let (drive, said) = with_can_bus(&messages);
        assert_eq!(path(&drive).len(), poses, "{expect}: {said:?}");
        assert!(said.iter().any(|what| what.contains(expect)), "{expect}: {said:?}");
    };
    check(&|m| m.iter_mut().for_each(|m| m["pos"][1] = json!(201.2)), 6, "disagree with the ego poses");
    check(&|m| m[25]["pos"][0] = json!(0.0), 6, "disagree with the ego poses");
    let turned = json!([0.99, 0.0, 0.0, 0.14]);
    check(&|m| m.iter_mut().for_each(|m| m["orientation"] = turned.clone()), 6, "disagree with the ego poses");
    let seconds = |m: &mut Value| m["utime"] = json!(m["utime"].as_i64().unwrap() / 1_000_000);
    check(&|m| m.iter_mut().for_each(seconds), 6, "at none of the scene's times");
    check(&Vec::clear, 6, "at none of the scene's times");
    check(&|m| m[7]["pos"][0] = json!("NaN"), 51, "message that cannot be used");
    check(&|m| m[7]["orientation"] = json!([0, 0, 0, 0]), 51, "message that cannot be used");
    check(&|m| m[7]["pos"] = json!(7), 51, "message that cannot be used");
    check(&|m| m.swap(7, 9), 52, "go back in time");
    check(&|m| m[7]["utime"] = m[6]["utime"].clone(), 51, "of a time that one before them has");
}

#[test]
fn a_can_bus_file_that_is_cut_is_used_as_far_as_it_goes() {
    let (root, text) = (Dataset::small().write(), json!(messages()).to_string());
    put(root.path(), CAN_BUS, &text.as_bytes()[..text.len() / 2]);
    let (drive, said) = read(root.path());
    assert!((25..35).contains(&path(&drive).len()), "{}", path(&drive).len());
    assert_eq!(said, ["CAN bus file that cannot be read to its end"]);
    for bytes in [&b""[..], b"{}", b"[", b"\xff"] {
        put(root.path(), CAN_BUS, bytes);
        assert_eq!(path(&read(root.path()).0).len(), 6, "{bytes:?}");
    }
}

#[test]
fn a_hundred_times_the_sweeps_and_messages_take_a_moment() {
    let text = json!(messages()).to_string();
    let many = Dataset::small().with("sample_data", |rows| {
        let sweep = rows.iter().find(|row| row["token"] == "d-LIDAR_TOP-1-sweep").unwrap().clone();
        for i in 0..6000 {
            let mut row = sweep.clone();
            (row["token"], row["timestamp"]) = (json!(format!("more-{i}")), json!(START_US + 500_100 + i * 40));
            (row["ego_pose_token"], row["filename"]) = (json!("d-LIDAR_TOP-1"), json!("sweeps/0.bin"));
            rows.push(row);
        }
    });
    let root = many.write();
    put(root.path(), CAN_BUS, format!("[{}]", vec![&text[1..text.len() - 1]; 100].join(",")).as_bytes());
    let start = std::time::Instant::now();
    let (drive, _) = read(root.path());
    assert!(start.elapsed().as_secs_f64() < 120.0, "{:?}", start.elapsed());
    assert!(!drive.path.moments().is_empty());
}

#[test]
fn the_files_of_the_path_and_its_sweeps_are_named_as_the_recording_s() {
    let root = Dataset::small().write();
    for file in ["samples/LIDAR_TOP/1.bin", "sweeps/LIDAR_TOP/1.bin"] {
        sweep(root.path(), file);
    }
    put(root.path(), CAN_BUS, json!(messages()).to_string().as_bytes());
    let dataset = trove_read::DATASETS.iter().find(|dataset| dataset.name == "nuscenes").unwrap();
    let source = (dataset.configure)(toml::Table::new()).unwrap()(root.path(), None, &Report::default()).unwrap();
    let recorded = source.recording(super::fixture::SCENE).unwrap();
    let expected = [CAN_BUS, "samples/LIDAR_TOP/1.bin", "sweeps/LIDAR_TOP/1.bin"].map(|file| root.path().join(file));
    assert_eq!(recorded, expected);
    let described = source.describe(super::fixture::SCENE, &Report::default()).unwrap();
    assert_eq!((described.path_poses, described.sweeps_between), (52, 1));
    assert!((described.path_hz - 51.0 / 1.25).abs() < 1e-9, "{}", described.path_hz);
}

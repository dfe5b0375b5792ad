//! LiDAR files and pictures beside a `drive.json`.

use std::path::PathBuf;

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use serde_json::{Value, json};
use trove_model::{Drive, LidarClass, Report};

use super::documentation::example;
use super::{notes, open, put, read};

const POINTS: [[f32; 3]; 2] = [[2.0, 1.0, -0.5], [f32::NAN, 0.0, 0.0]];

fn bin() -> Vec<u8> {
    POINTS.iter().flat_map(|p| [p[0], p[1], p[2], 7.0]).flat_map(f32::to_le_bytes).collect()
}

/// One point at (14, 6, 0.5).
fn las() -> Vec<u8> {
    let mut las = vec![0; 227];
    las[..4].copy_from_slice(b"LASF");
    (las[24], las[25]) = (1, 2);
    las[96..100].copy_from_slice(&227u32.to_le_bytes());
    las[105..107].copy_from_slice(&20u16.to_le_bytes());
    las[107..111].copy_from_slice(&1u32.to_le_bytes());
    (0..3).for_each(|i| las[131 + 8 * i..139 + 8 * i].copy_from_slice(&0.5f64.to_le_bytes()));
    las.extend([28i32, 12, 1].into_iter().flat_map(i32::to_le_bytes).chain([0; 8]));
    las
}

/// The same point, packed: 12 bytes as they are.
fn pcd() -> Vec<u8> {
    let header =
        "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA binary_compressed\n";
    let point = [14f32, 6.0, 0.5].map(f32::to_le_bytes).concat();
    [header.as_bytes(), &13u32.to_le_bytes(), &12u32.to_le_bytes(), &[11], &point].concat()
}

fn with_lidar(lidar: &Value, files: &[(&str, &[u8])]) -> (Drive, Report) {
    let mut drive: Value = serde_json::from_str(&example()).unwrap();
    drive["keyframes"][0]["lidar"] = lidar.clone();
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    put(root.path(), "drive.json", drive.to_string());
    files.iter().for_each(|(file, bytes)| put(root.path(), file, bytes));
    (read(root.path(), &report).unwrap(), report)
}

#[test]
fn points_come_through_the_sensor_s_mounting_with_their_labels() {
    let mounting = json!({"translation_m": [1.0, 0.0, 1.8], "yaw_rad": std::f64::consts::FRAC_PI_2});
    let lidar = json!({"file": "a/0.bin", "labels": "a/0.labels", "ego_from_lidar": mounting});
    let (drive, report) = with_lidar(&lidar, &[("a/0.bin", &bin()), ("a/0.labels", &[4, 1])]);
    let (ego, sweep) = (drive.keyframes[0].world_from_ego, drive.keyframes[0].lidar.as_ref().unwrap());
    let expected = ego.point(DVec3::new(0.0, 2.0, 1.3));
    assert!(sweep.points_world[0].distance(expected.as_vec3()) < 1e-5, "{:?}", sweep.points_world);
    assert_eq!((sweep.points_world.len(), &sweep.classes[..]), (1, &[LidarClass::Vegetation][..]));
    assert!(sweep.origin_world.distance(ego.point(DVec3::new(1.0, 0.0, 1.8))) < 1e-9);
    assert!(notes(&report).contains(&("LiDAR point that is not a number".to_owned(), 1)), "{:?}", notes(&report));
}

#[test]
fn points_in_world_keep_their_place_and_every_form_of_file_is_read() {
    // The example's World begins at (12, 5, 0).
    let pcd = b"FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n14 6 0.5\n";
    let (drive, _) = with_lidar(&json!({"file": "p.pcd", "is_in_world": true}), &[("p.pcd", pcd)]);
    let sweep = drive.keyframes[0].lidar.as_ref().unwrap();
    assert_eq!(sweep.points_world, [Vec3::new(2.0, 1.0, 0.5)]);
    for (file, bytes) in [("p.las", las()), ("q.pcd", self::pcd())] {
        let (drive, _) = with_lidar(&json!({"file": file, "is_in_world": true}), &[(file, &bytes)]);
        assert_eq!(drive.keyframes[0].lidar.as_ref().unwrap().points_world, [Vec3::new(2.0, 1.0, 0.5)], "{file}");
    }
}

#[test]
fn a_file_that_cannot_be_used_is_reported_and_the_rest_stands() {
    let check = |lidar: Value, files: &[(&str, &[u8])], has_sweep: bool, expect: &str| {
        let (drive, report) = with_lidar(&lidar, files);
        assert_eq!((drive.keyframes[0].lidar.is_some(), drive.tracks.len()), (has_sweep, 1));
        let said: Vec<_> = report.entries().iter().map(|e| format!("{}: {}", e.what, e.examples.join(" "))).collect();
        assert!(said.iter().any(|said| said.contains(expect)), "expected '{expect}' in {said:?}");
    };
    check(json!({"file": "0.bin"}), &[], false, "LiDAR file that cannot be used: 0.bin: No such file");
    check(json!({"file": "0.bin"}), &[("0.bin", &bin()[..20])], false, "found 20 bytes");
    check(json!({"file": "0.bin"}), &[("0.bin", b"")], false, "found 0 bytes");
    check(json!({"file": "0.xyz"}), &[("0.xyz", b"1 2 3")], false, "ends in .bin, .pcd, .las");
    check(json!({"file": "0.pcd"}), &[("0.pcd", b"1 2 3")], false, "line DATA");
    let labelled = json!({"file": "0.bin", "labels": "0.labels"});
    check(labelled.clone(), &[("0.bin", &bin())], true, "LiDAR labels: 0.labels: No such file");
    check(labelled.clone(), &[("0.bin", &bin()), ("0.labels", &[1])], true, "expected 2 bytes");
    check(labelled, &[("0.bin", &bin()), ("0.labels", &[1, 9])], true, "LiDAR labels above 5");
}

#[test]
fn pictures_are_named_from_the_root_and_what_was_recorded_is_told() {
    let mut drive: Value = serde_json::from_str(&example()).unwrap();
    drive["keyframes"][0]["pictures"] = json!({"front": {"file": "front/0.jpg"}});
    drive["keyframes"][0]["lidar"] = json!({"file": "0.bin"});
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    put(root.path(), "b/drive.json", drive.to_string());
    put(root.path(), "b/0.bin", bin());
    let without = read(root.path(), &report).unwrap();
    assert_eq!(without.keyframes[0].exposures[0].file, None);
    assert!(notes(&report).contains(&("picture that is not there".to_owned(), 1)));
    put(root.path(), "b/front/0.jpg", "x");
    let exposure = read(root.path(), &report).unwrap().keyframes.remove(0).exposures.remove(0);
    assert_eq!((exposure.file.as_deref(), exposure.token.as_deref()), (Some("b/front/0.jpg"), Some("front/0.jpg")));
    let recorded = open("trove", "", root.path(), &report).unwrap().recording("b").unwrap();
    let expected: Vec<PathBuf> = ["b/drive.json", "b/0.bin"].map(|file| root.path().join(file)).into();
    assert_eq!(recorded, expected);
}

#[test]
fn a_camera_that_fires_beside_the_keyframe_sees_from_between_the_poses() {
    let mut drive: Value = serde_json::from_str(&example()).unwrap();
    let mut second = drive["keyframes"][0].clone();
    second["time_ns"] = json!(1_600_000_000_500_000_000_i64);
    second["world_from_ego"]["translation_m"] = json!([16.0, 5.0, 0.0]);
    second["pictures"] = json!({"front": {"time_ns": 1_600_000_000_375_000_000_i64}});
    drive["keyframes"].as_array_mut().unwrap().push(second);
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    put(root.path(), "drive.json", drive.to_string());
    let drive = read(root.path(), &report).unwrap();
    let exposure = &drive.keyframes[1].exposures[0];
    assert!(exposure.world_from_ego.translation.distance(DVec3::new(3.0, 0.0, 0.0)) < 1e-9, "{exposure:?}");
    // The car keeps its distance, so it is as fast as the vehicle.
    let speed = drive.keyframes[0].boxes[0].velocity_mps.unwrap();
    assert!(speed.distance(DVec3::new(8.0, 0.0, 0.0)) < 1e-9, "{speed}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]
    #[test]
    fn damaged_points_never_panic(is_las in any::<bool>(), at in 0.0..1.0f64, byte in any::<u8>(), cut in 0.0..2.0f64) {
        let (file, mut bytes) = if is_las { ("p.las", las()) } else { ("p.pcd", pcd()) };
        let at = (at * bytes.len() as f64) as usize;
        bytes[at] = byte;
        bytes.truncate((cut * bytes.len() as f64) as usize);
        let (drive, report) = with_lidar(&json!({"file": file}), &[(file, &bytes)]);
        prop_assert!(drive.keyframes[0].lidar.is_some() || notes(&report).iter().any(|(what, _)| what.contains("LiDAR")));
    }
}

//! What is wrong is told in full, with its places; never a panic.

use proptest::prelude::*;
use serde_json::{Value, json};
use trove_model::Report;

use super::documentation::example;
use super::{notes, open, put, read};

fn moments(count: usize) -> Value {
    let mut drive: Value = serde_json::from_str(&example()).unwrap();
    let first = drive["keyframes"][0].clone();
    let moment = |k: usize| {
        let mut moment = first.clone();
        moment["time_ns"] = json!(1_600_000_000_000_000_000_i64 + k as i64 * 500_000_000);
        moment["world_from_ego"]["translation_m"][0] = json!(12.0 + 4.0 * k as f64);
        moment
    };
    drive["keyframes"] = (0..count).map(moment).collect();
    drive
}

fn error_of(text: &str, file: &str) -> String {
    let root = tempfile::tempdir().unwrap();
    put(root.path(), file, text);
    read(root.path(), &Report::default()).expect_err(text).to_string()
}

/// A change to a drive of three keyframes is an error in these words.
fn check(change: impl FnOnce(&mut Value), expect: &str) {
    let mut drive = moments(3);
    change(&mut drive);
    let error = error_of(&drive.to_string(), "drive.json");
    assert!(error.contains(expect), "expected '{expect}' in {error}");
}

#[test]
fn every_fault_is_told_with_its_place() {
    let mut drive = moments(3);
    drive["keyframes"][1]["boxes"][0]["sise_m"] = drive["keyframes"][1]["boxes"][0]["size_m"].take();
    drive["keyframes"][1]["boxes"][0].as_object_mut().unwrap().remove("size_m");
    drive["keyframes"][2]["boxes"][0]["kind"] = json!("caar");
    drive["cameras"]["front"]["width_px"] = json!(0);
    let text = serde_json::to_string_pretty(&drive).unwrap();
    let error = error_of(&text, "drive.json");
    let line = |of: &str| text.lines().position(|line| line.contains(of)).unwrap() + 1;
    for expect in [
        "drive.json: expected a drive in the plain form (docs/plain-drive.md), found 3 faults",
        &format!("line {}, ", line("sise_m")),
        "keyframes[1].boxes[0]: unknown field `sise_m`",
        "did you mean `size_m`?",
        &format!("line {}, ", line("caar")),
        "keyframes[2].boxes[0]: expected a kind, found \"caar\"; did you mean \"car\"?",
        "cameras.front: expected a picture of 1 to 65535 pixels a side, found 0 × 900",
    ] {
        assert!(error.contains(expect), "expected '{expect}' in {error}");
    }
}

#[test]
fn what_cannot_be_between_keyframes_is_told() {
    let at = |ms: i64, x: f64| json!({"time_ns": 1_600_000_000_000_000_000 + ms * 1_000_000, "world_from_ego": {"translation_m": [x, 5, 0]}});
    let path = |change: fn(&mut Value), expect: &str| {
        let mut path = json!([at(0, 12.0), at(50, 12.4), at(100, 12.8)]);
        change(&mut path);
        check(|d| d["path"] = path, expect);
    };
    path(|p| p[2]["time_ns"] = p[1]["time_ns"].clone(), "path[2]: time_ns: expected more than");
    path(|p| p[1]["time_ns"] = json!(5), "path[1]: time_ns: expected more than");
    path(|p| p[2]["time_ns"] = json!(i64::MAX), "path[2]: time_ns: expected nanoseconds since 1970");
    path(|p| p[1]["world_from_ego"]["translation_m"][0] = json!(1e7), "path[1]: the vehicle: expected it near");
    path(|p| p[1]["world_from_ego"]["rotation_wxyz"] = json!([0, 0, 0, 0]), "path[1]: world_from_ego.rotation_wxyz");
    path(|p| drop(p[1].as_object_mut().unwrap().remove("world_from_ego")), "path[1]: expected world_from_ego");
    path(|p| p[1]["world_from_ego"]["translation_m"] = json!([null, 2, 3]), "invalid type: null");
    path(|p| p[1]["lidar"] = json!({}), "unknown field `lidar`");
    check(|d| d["path"] = json!({}), "invalid type: map");
    let sweep =
        |ms: i64, file: &str| json!({"time_ns": 1_600_000_000_000_000_000 + ms * 1_000_000, "lidar": {"file": file}});
    check(|d| d["sweeps"] = json!([sweep(50, "a.bin"), sweep(50, "b.bin")]), "sweeps[1]: time_ns: expected more than");
    check(|d| d["sweeps"] = json!([sweep(50, "/dev/zero")]), "sweeps[0]: lidar.file: expected a path");
    check(|d| d["sweeps"] = json!([{"time_ns": 7}]), "missing field `lidar`");
}

#[test]
fn pictures_without_a_pose_lie_on_the_path_and_a_sweep_that_is_missing_is_reported() {
    let mut drive = moments(3);
    // Between the keyframes the vehicle swerves.
    let start = 1_600_000_000_000_000_000_i64;
    let at =
        |ms: i64, y: f64| json!({"time_ns": start + ms * 1_000_000, "world_from_ego": {"translation_m": [14, y, 0]}});
    drive["path"] = json!([at(200, 6.0), at(300, 7.0)]);
    drive["sweeps"] = json!([{"time_ns": start + 250_000_000, "lidar": {"file": "lost.bin"}}]);
    drive["keyframes"][0]["pictures"]["front"] = json!({"time_ns": start + 250_000_000});
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    put(root.path(), "drive.json", drive.to_string());
    let found = read(root.path(), &report).unwrap();
    let offset = found.keyframes[0].world_from_ego.translation - glam::DVec3::new(12.0, 5.0, 0.0);
    let exposure = found.keyframes[0].exposures[0].world_from_ego.translation - offset;
    assert!(exposure.distance(glam::DVec3::new(14.0, 6.5, 0.0)) < 1e-9, "{exposure}");
    assert!(found.sweeps.is_empty() && notes(&report).iter().any(|(what, _)| what.contains("LiDAR file that cannot")));
}

#[test]
fn what_cannot_be_is_told() {
    check(|d| d["trove_drive"] = json!(2), "trove_drive: expected 1, found 2");
    check(|d| drop(d.as_object_mut().unwrap().remove("trove_drive")), "missing field `trove_drive`");
    check(|d| d["keyframes"] = json!([]), "keyframes: expected at least one");
    check(|d| d["keyframes"] = json!(7), "invalid type: integer `7`");
    check(
        |d| d["keyframes"][1]["time_ns"] = d["keyframes"][0]["time_ns"].clone(),
        "keyframes[1]: time_ns: expected more than",
    );
    check(|d| d["keyframes"][1]["time_ns"] = json!(5), "keyframes[1]: time_ns: expected more than");
    check(|d| d["keyframes"][2]["time_ns"] = json!(i64::MAX), "time_ns: expected nanoseconds since 1970");
    check(
        |d| d["keyframes"][0]["pictures"]["front"] = json!({"time_ns": 1.6e15 as i64}),
        "within a minute of the keyframe's",
    );
    check(|d| d["keyframes"][1]["time_ns"] = json!(1.5), "invalid type: floating point");
    check(|d| d["keyframes"][1]["world_from_ego"]["rotation_wxyz"] = json!([0, 0, 0, 0]), "found both");
    check(
        |d| d["keyframes"][1]["world_from_ego"] = json!({"translation_m": [0, 0, 0], "rotation_wxyz": [0, 0, 0, 0]}),
        "keyframes[1]: world_from_ego.rotation_wxyz: expected a unit quaternion",
    );
    check(|d| d["keyframes"][1]["world_from_ego"]["translation_m"] = json!([1, 2]), "invalid length 2");
    check(|d| d["keyframes"][1]["world_from_ego"]["translation_m"] = json!([1e7, 2, 3]), "found it 10000 km away");
    check(|d| d["keyframes"][1]["world_from_ego"]["translation_m"] = json!([null, 2, 3]), "invalid type: null");
    check(|d| drop(d["keyframes"][1].as_object_mut().unwrap().remove("world_from_ego")), "expected world_from_ego");
    check(|d| d["keyframes"][2]["boxes"][0]["size_m"] = json!([4.0, 0.0, 1.5]), "size_m: expected more than 0");
    check(|d| d["keyframes"][2]["boxes"][0]["size_m"] = json!([400.0, 2.0, 1.5]), "size_m: expected more than 0");
    check(
        |d| d["keyframes"][2]["boxes"][0]["world_from_body"] = json!({"translation_m": [0, 0, 0]}),
        "expected world_from_body or ego_from_body, found both",
    );
    check(
        |d| drop(d["keyframes"][2]["boxes"][0].as_object_mut().unwrap().remove("ego_from_body")),
        "expected world_from_body or ego_from_body, found neither",
    );
    check(
        |d| {
            let twice = d["keyframes"][2]["boxes"][0].clone();
            d["keyframes"][2]["boxes"].as_array_mut().unwrap().push(twice);
        },
        "keyframes[2].boxes[1]: expected one box of track \"7\", found a second",
    );
    check(
        |d| (d["keyframes"][0]["token"], d["keyframes"][2]["token"]) = (json!("a"), json!("a")),
        "token: expected another than an earlier keyframe's",
    );
    check(|d| d["keyframes"][0]["pictures"]["fromt"] = json!({}), "did you mean \"front\"?");
    check(|d| d["keyframes"][0]["pictures"]["front"] = json!({"file": "../secret.jpg"}), "to a file below it");
    check(|d| d["keyframes"][0]["lidar"] = json!({"file": "/dev/zero"}), "to a file below it");
    check(|d| d["cameras"]["front"]["fx_px"] = json!(-1.0), "expected focal lengths above 0");
    check(|d| d["cameras"]["front"]["distortion"] = json!([0.1]), "at most 0 finite numbers");
    check(|d| d["cameras"]["../front"] = d["cameras"]["front"].clone(), "the name \"../front\"");
    check(|d| d["georeference"] = json!({"local": {"origin_lat_deg": 91, "origin_lon_deg": 0}}), "expected a latitude");
    check(|d| d["georeference"] = json!({"utm": {"zone": 61}}), "zone: expected 1 to 60, found 61");
    check(|d| d["georeference"] = json!("wgs48"), "did you mean `wgs84`?");
    check(|d| d["georeference"] = json!("wgs84"), "expected geo_from_ego");
    check(|d| d["georeference"]["local"]["metres_per_rad"] = json!([1, 1]), "metres_per_rad: expected about");
    check(|d| d["ego_body"] = json!({"centre_m": [0, 0, 0], "size_m": [0, 0, 0]}), "ego_body: expected length");
    check(
        |d| d["lane_map"] = json!({"drivable": [{"outline": [[0, 0], [1, 1]]}]}),
        "lane_map.drivable: expected lines",
    );
    check(|d| d["name"] = json!("../x"), "the name \"../x\"");
}

#[test]
fn text_that_is_cut_short_or_no_json_is_told_with_its_line() {
    let text = serde_json::to_string_pretty(&moments(3)).unwrap();
    for (damaged, expect) in [
        (text[..text.len() / 2].to_owned(), "EOF while parsing"),
        (String::new(), "EOF while parsing"),
        (text.replace("12.0", "NaN"), "expected value"),
        ("[1, 2]".to_owned(), "invalid type"),
        (text.replace("\"trove_drive\": 1", "\"trove_drive\": 1, \"trove_drive\": 1"), "duplicate field `trove_drive`"),
    ] {
        let error = error_of(&damaged, "drive.json");
        assert!(error.contains(expect) && error.contains("line "), "{error}");
    }
    let lines = |drive: &Value| {
        let mut header = drive.clone();
        let keyframes = header.as_object_mut().unwrap().remove("keyframes").unwrap();
        let keyframes: Vec<String> = keyframes.as_array().unwrap().iter().map(Value::to_string).collect();
        format!("{header}\n{}\n", keyframes.join("\n"))
    };
    let text = lines(&moments(3));
    let error = error_of(&text[..text.len() - 20], "drive.jsonl");
    assert!(error.contains("line 4, ") && error.contains("keyframes[2]: EOF"), "{error}");
    let error = error_of(&text.replace("\"yaw_rad\"", "\"yaw\""), "drive.jsonl");
    assert!(error.contains("found 3 faults") && error.contains("did you mean `yaw_rad`?"), "{error}");
}

#[test]
fn of_many_faults_twenty_are_told() {
    let mut drive = moments(100);
    drive["keyframes"].as_array_mut().unwrap().iter_mut().for_each(|k| k["boxes"][0]["kind"] = json!("x"));
    let error = error_of(&drive.to_string(), "drive.json");
    assert!(error.contains("found 100 faults") && error.contains("and 80 more"), "{error}");
}

#[test]
fn a_hundred_times_the_size_is_read_within_seconds() {
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    put(root.path(), "drive.json", moments(20_000).to_string());
    let started = std::time::Instant::now();
    let drive = read(root.path(), &report).unwrap();
    assert_eq!((drive.keyframes.len(), drive.tracks.len(), drive.tracks[0].boxes.len()), (20_000, 1, 20_000));
    assert!(started.elapsed().as_secs() < 240, "{:?}", started.elapsed());
}

#[test]
fn a_hundred_cameras_on_bare_keyframes_are_refused_before_they_fill_the_memory() {
    let mut drive = moments(1);
    for i in 0..99 {
        drive["cameras"][format!("c{i}")] = drive["cameras"]["front"].clone();
    }
    let header = drive.as_object_mut().unwrap();
    header.remove("keyframes");
    let keyframe = |k: usize| format!("\n{{\"time_ns\":{k},\"world_from_ego\":{{\"translation_m\":[0,0,0]}}}}");
    let keyframes: String = (0..40_000).map(keyframe).collect();
    let error = error_of(&format!("{drive}{keyframes}"), "drive.jsonl");
    assert!(error.contains("unpacks to at most"), "{error}");
    drive["cameras"]["one-more"] = drive["cameras"]["front"].clone();
    assert!(error_of(&drive.to_string(), "drive.json").contains("at most 100, found 101"));
}

#[test]
fn drives_of_a_root_are_found_by_their_names() {
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    let mut named = moments(2);
    named["name"] = json!("B");
    put(root.path(), "b/drive.json", named.to_string());
    put(root.path(), "a/drive.json", moments(1).to_string());
    put(root.path(), "c/drive.json", named.to_string());
    put(root.path(), "notes.txt", "x");
    let source = open("trove", "", root.path(), &report).unwrap();
    let drives: Vec<_> = source.drives().into_iter().map(|d| (d.name, d.keyframes)).collect();
    assert_eq!(drives, [("B".to_owned(), 2), ("a".to_owned(), 1)]);
    assert_eq!(notes(&report), [("drive with the name of another".to_owned(), 1)]);
    let error = source.read("c", &report).unwrap_err().to_string();
    assert!(error.contains("a drive named 'c'") && error.contains("nearest name is"), "{error}");
    let empty = tempfile::tempdir().unwrap();
    let error = open("trove", "", empty.path(), &report).err().unwrap().to_string();
    assert!(error.contains("drive.json or drive.jsonl"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]
    #[test]
    fn damaged_drives_never_panic(
        at in 0.0..1.0f64,
        insert in prop::sample::select(&["{", "}", "[", "]", "\"", ",", "-", "1e999", "9e15", "\\", "\0", "é", "null", "\n"][..]),
        remove in 0usize..40,
        is_lines in any::<bool>(),
    ) {
        let drive = moments(2);
        let text = if is_lines {
            let mut header = drive.clone();
            header.as_object_mut().unwrap().remove("keyframes");
            format!("{header}\n{}\n{}", drive["keyframes"][0], drive["keyframes"][1])
        } else {
            drive.to_string()
        };
        let at = (at * text.len() as f64) as usize;
        let damaged = format!("{}{insert}{}", &text[..at], &text[(at + remove).min(text.len())..]);
        let root = tempfile::tempdir().unwrap();
        put(root.path(), if is_lines { "drive.jsonl" } else { "drive.json" }, damaged);
        if let Ok(drive) = read(root.path(), &Report::default()) {
            prop_assert!(!drive.keyframes.is_empty());
        }
    }
}

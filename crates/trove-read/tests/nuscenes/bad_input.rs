//! What is broken is an error that says where, or is left out and reported; never a panic.

use proptest::prelude::*;
use serde_json::{Value, json};
use trove_model::{Outcome, Report};
use trove_read::nuscenes::NuScenes;

use super::fixture::{Dataset, SCENE, VERSION, load, notes, put};

/// A change to one table leaves a drive with so many keyframes and boxes, and this in the report.
fn check(table: &'static str, change: impl FnOnce(&mut Vec<Value>), keyframes_boxes: (usize, usize), expect: &str) {
    let (root, report) = (Dataset::small().with(table, change).write(), Report::default());
    let drive = load(root.path(), &report).unwrap();
    let boxes = drive.keyframes.iter().map(|k| k.boxes.len()).sum::<usize>();
    assert_eq!((drive.keyframes.len(), boxes), keyframes_boxes, "{expect}");
    let said = notes(&report);
    assert!(said.iter().any(|(_, what, _)| what.contains(expect)), "expected '{expect}' in {said:?}");
}

fn row<'a>(rows: &'a mut [Value], token: &str) -> &'a mut Value {
    rows.iter_mut().find(|row| row["token"] == token).unwrap()
}

#[test]
fn a_broken_record_is_left_out_and_reported() {
    check(
        "ego_pose",
        |t| row(t, "d-CAM_BACK-0")["translation"][0] = json!("NaN"),
        (3, 6),
        "ego_pose record that cannot be read",
    );
    check(
        "ego_pose",
        |t| row(t, "d-CAM_BACK-0")["rotation"] = json!([0, 0, 0, 0]),
        (3, 6),
        "ego_pose without a valid pose",
    );
    check("ego_pose", |t| t.retain(|p| p["token"] != "d-CAM_BACK-0"), (3, 6), "sample_data: unknown ego_pose");
    check("ego_pose", |t| t.retain(|p| p["token"] != "d-LIDAR_TOP-1"), (3, 6), "ego pose from its cameras'");
    check(
        "ego_pose",
        |t| t.retain(|p| !p["token"].as_str().unwrap().ends_with("-1")),
        (2, 4),
        "sample without a usable ego pose",
    );
    check("sample_data", |t| row(t, "d-CAM_FRONT-1")["width"] = json!(0), (3, 6), "sample_data: image of no size");
    check("sample_data", |t| row(t, "d-CAM_FRONT-1")["sample_token"] = json!("?"), (3, 6), "of an unknown sample");
    check(
        "sample_data",
        |t| row(t, "d-CAM_FRONT-1")["filename"] = json!("../x.jpg"),
        (3, 6),
        "outside the dataset's folder",
    );
    check("calibrated_sensor", |t| t[1]["camera_intrinsic"] = json!([]), (3, 6), "camera without usable intrinsics");
    check("calibrated_sensor", |t| drop(t.remove(2)), (3, 6), "sample_data: unknown calibrated_sensor");
    check("sample_annotation", |t| t[0]["size"] = json!([2.0, 0.0, 1.5]), (3, 5), "box of zero or negative size");
    check("sample_annotation", |t| t[0]["size"] = json!([2.0, -4.0, 1.5]), (3, 5), "box of zero or negative size");
    check("sample_annotation", |t| t[0]["translation"] = json!([1e300, 0, 0]), (3, 5), "box without a valid pose");
    check("sample_annotation", |t| t[0]["instance_token"] = json!("?"), (3, 5), "annotation: unknown instance");
    check("sample_annotation", |t| t[0]["next"] = json!("?"), (3, 6), "neighbour in time missing");
    check("sample_annotation", |t| t[0]["visibility_token"] = json!("9"), (3, 6), "unknown visibility");
    check("sample_annotation", |t| t[1] = t[0].clone(), (3, 5), "sample_annotation record with a duplicate token");
    check("sample_annotation", |t| t[1]["sample_token"] = json!("k0"), (3, 5), "second of its instance in a sample");
    check("category", |t| t[1]["name"] = json!("vehicle.hovercraft"), (3, 3), "unknown category 'vehicle.hovercraft'");
    check("sample", |t| t[0]["next"] = json!("k2"), (3, 6), "broken nuScenes keyframe chain");
    check("sample", |t| t[2]["next"] = json!("k0"), (3, 6), "keyframe chain that continues");
    check("sample", |t| t[1] = t[0].clone(), (2, 4), "sample record with a duplicate token");
    check("sample", |t| drop(t.remove(1)), (2, 4), "wrong number of samples");
    check("scene", |t| t[0]["first_sample_token"] = json!(""), (3, 6), "broken nuScenes keyframe chain");
    check("log", Vec::clear, (3, 6), "scene of an unknown log");
    check("attribute", Vec::clear, (3, 6), "rider of a cycle without attributes");
}

#[test]
fn names_that_choose_where_files_go_are_refused() {
    for name in ["../../x", "/x", "", ".trove", "a/b", "x\u{1b}[2J"] {
        let (root, report) =
            (Dataset::small().with("scene", |t| t[0]["name"] = json!(name)).write(), Report::default());
        let dataset = NuScenes::open(root.path(), VERSION, None, &report).unwrap();
        assert_eq!(dataset.scenes(), [], "{name:?}");
        assert!(notes(&report).iter().any(|(_, what, _)| what.contains("whose name is no folder's")), "{name:?}");
    }
    check(
        "sensor",
        |t| t.iter_mut().find(|s| s["channel"] == "CAM_BACK").unwrap()["channel"] = json!("../CAM_BACK"),
        (3, 6),
        "sensor whose channel is no folder's name",
    );
}

#[test]
fn of_two_scenes_with_one_name_the_second_is_left_out_and_reported() {
    let twice = |t: &mut Vec<Value>| {
        let mut second = t[0].clone();
        second["token"] = json!("another");
        second["name"] = json!(SCENE.to_uppercase());
        t.push(second);
    };
    check("scene", twice, (3, 6), "scene with the name of another");
}

#[test]
fn an_error_names_the_file_the_place_and_what_to_do() {
    let message = |dataset: &Dataset, damage: &dyn Fn(&std::path::Path)| {
        let root = dataset.write();
        damage(&root.path().join(VERSION));
        load(root.path(), &Report::default()).unwrap_err().to_string()
    };
    let small = Dataset::small();
    let truncated = message(&small, &|tables| {
        let path = tables.join("ego_pose.json");
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, &text[..text.len() / 2]).unwrap();
    });
    let missing = message(&small, &|tables| std::fs::remove_file(tables.join("sample_data.json")).unwrap());
    let damaged = message(&small, &|tables| std::fs::write(tables.join("scene.json"), "[\n{},\n} ]").unwrap());
    let empty = message(&small.clone().with("ego_pose", Vec::clear), &|_| ());
    for (message, parts) in [
        (truncated, ["ego_pose.json", "line ", "cut short"]),
        (missing, ["sample_data.json", "found no file", "unpack"]),
        (damaged, ["scene.json", "line 3 (byte 6)", "copy or unpack it again"]),
        (empty, ["sample.json", SCENE, "choose another scene"]),
    ] {
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
}

#[test]
fn a_wrong_name_is_answered_with_the_nearest() {
    let (root, report) = (Dataset::small().write(), Report::default());
    let dataset = NuScenes::open(root.path(), VERSION, None, &report).unwrap();
    let message = dataset.drive("scene-0010", &report).unwrap_err().to_string();
    assert!(message.contains("scene-0001"), "{message}");
    let message = NuScenes::open(root.path(), "v1.0-trainval", None, &report).err().unwrap().to_string();
    assert!(message.contains(VERSION), "{message}");
    assert_eq!(NuScenes::versions(root.path()), [VERSION]);
}

#[test]
fn a_map_that_cannot_be_read_is_reported_and_the_drive_stands() {
    for (text, outcome) in [(&b"{\"node\": [{"[..], Outcome::Dropped), (b"{\"lane\": 7}", Outcome::Dropped)] {
        let (root, report) = (Dataset::small().write(), Report::default());
        put(root.path(), "maps/expansion/boston-seaport.json", text);
        assert!(load(root.path(), &report).unwrap().lane_map.is_none());
        assert_eq!(notes(&report)[0].0, outcome);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]
    #[test]
    fn damaged_tables_never_panic(
        table in 0usize..13,
        at in 0.0..1.0f64,
        damage in prop_oneof![
            (0u8..8).prop_map(Damage::Flip),
            Just(Damage::Truncate),
            prop::sample::select(&["{", "}", "[", "]", "\"", ",", "-", "1e999", "NaN", "\\", "\0", "é", "null"][..]).prop_map(Damage::Insert),
            (1usize..60).prop_map(Damage::Remove),
        ],
    ) {
        let root = Dataset::small().write();
        let files: Vec<_> = std::fs::read_dir(root.path().join(VERSION)).unwrap().map(|f| f.unwrap().path()).collect();
        let path = &files[table % files.len()];
        let mut bytes = std::fs::read(path).unwrap();
        let at = (at * bytes.len() as f64) as usize;
        match damage {
            Damage::Flip(bit) => bytes[at] ^= 1 << bit,
            Damage::Truncate => bytes.truncate(at),
            Damage::Insert(text) => drop(bytes.splice(at..at, text.bytes())),
            Damage::Remove(n) => drop(bytes.drain(at..(at + n).min(bytes.len()))),
        }
        std::fs::write(path, bytes).unwrap();
        if let Ok(drive) = load(root.path(), &Report::default()) {
            prop_assert!(!drive.keyframes.is_empty());
        }
    }
}

#[derive(Clone, Copy, Debug)]
enum Damage {
    Flip(u8),
    Truncate,
    Insert(&'static str),
    Remove(usize),
}

//! What is broken is an error that says where, or is left out and reported; never a panic.

use std::sync::Arc;
use std::time::{Duration, Instant};

use arrow_array::{ArrayRef, Float32Array, RecordBatch};
use arrow_ipc::CompressionType;
use arrow_ipc::writer::{FileWriter, IpcWriteOptions};
use proptest::prelude::*;
use serde_json::{Value, json};
use trove_model::Report;

use super::fixture::{
    ANNOTATIONS, Column, HEIGHT, INTRINSICS, LOG, Log, MAP, MOUNTS, POSES, SIMILARITY, START_NS, SWEEP, Table, column,
    feather, load, npy, put, words,
};

fn said(report: &Report) -> Vec<String> {
    report.entries().iter().map(|e| format!("{}: {}", e.what, e.examples.join(", "))).collect()
}

/// A change to one table leaves a drive with so many keyframes and boxes, and this in the report.
fn check(table: &'static str, change: impl FnOnce(&mut Table), keyframes_boxes: (usize, usize), expect: &str) {
    let (root, report) = (Log::small().with(table, change).write(), Report::default());
    let drive = load(root.path(), &report).unwrap();
    let boxes = drive.keyframes.iter().map(|k| k.boxes.len()).sum::<usize>();
    assert_eq!((drive.keyframes.len(), boxes), keyframes_boxes, "{expect}");
    assert!(said(&report).iter().any(|line| line.contains(expect)), "expected '{expect}' in {:?}", said(&report));
}

#[test]
fn a_broken_row_is_left_out_and_reported() {
    let float = |name: &'static str, row: usize, value: f64| move |t: &mut Table| column(t, name).floats()[row] = value;
    let text = |name: &'static str, row: usize, value: &'static str| {
        move |t: &mut Table| column(t, name).texts()[row] = value.to_owned()
    };
    check(POSES, float("tx_m", 1, f64::NAN), (3, 6), "ego pose without a time or a valid pose");
    check(
        POSES,
        |t| (0..9).for_each(|i| column(t, "qw").floats()[i] *= f64::from(i < 4)),
        (1, 2),
        "without a vehicle pose",
    );
    check(POSES, |t| column(t, "timestamp_ns").ints().swap(0, 5), (3, 6), "go back in time");
    check(POSES, |t| column(t, "timestamp_ns").ints()[1] = START_NS, (3, 6), "of a time that one before them has");
    check(ANNOTATIONS, float("length_m", 2, f64::NAN), (3, 5), "box of no size");
    check(ANNOTATIONS, float("width_m", 2, 0.0), (3, 5), "box of no size");
    check(ANNOTATIONS, float("height_m", 2, 1e300), (3, 5), "longer than 200 m");
    check(ANNOTATIONS, float("ty_m", 2, f64::INFINITY), (3, 5), "box without a valid pose");
    check(ANNOTATIONS, float("qw", 2, 0.0), (3, 5), "box without a valid pose: row 2");
    check(ANNOTATIONS, text("category", 2, "HOVERCRAFT"), (3, 5), "unknown category: 'HOVERCRAFT'");
    check(ANNOTATIONS, text("track_uuid", 3, "car"), (3, 5), "second of its track");
    check(ANNOTATIONS, |t| column(t, "timestamp_ns").ints()[0] = i64::MIN, (3, 5), "without a vehicle pose");
    check(ANNOTATIONS, |t| column(t, "num_interior_pts").ints()[0] = -4, (3, 6), "hides them");
    check(INTRINSICS, float("fx_px", 0, -1.0), (3, 6), "no usable intrinsics: ring_front_center");
    check(INTRINSICS, |t| *column(t, "width_px") = Column::Short(vec![0, 9]), (3, 6), "image of no size");
    check(INTRINSICS, text("sensor_name", 0, "../x"), (3, 6), "name that is no folder's");
    check(INTRINSICS, text("sensor_name", 0, "ring_rear_left"), (3, 6), "second of its name");
    check(MOUNTS, float("qw", 1, f64::NAN), (3, 6), "sensor: without a valid pose: ring_rear_left");
    check(MOUNTS, text("sensor_name", 2, "up_lidar?"), (3, 6), "place of an Argoverse 2 log's LiDAR");
    check(MOUNTS, text("sensor_name", 1, "up_lidar"), (3, 6), "camera: no valid pose in");
    check(SWEEP, |t| *column(t, "x") = Column::Single(vec![f32::NAN; 40]), (3, 6), "LiDAR point that is not a number");
    check(
        SWEEP,
        |t| *column(t, "x") = Column::Byte(vec![0; 40]),
        (3, 6),
        "expected a column of decimal numbers, found one of UInt8",
    );
}

type MapChange<'a> = &'a dyn Fn(&mut Value);
/// Lanes, drivable areas, crossings and marks.
type LayerCounts = (usize, usize, usize, usize);

#[test]
fn a_broken_map_row_is_left_out_and_reported() {
    let damaged = |change: &dyn Fn(&mut Value)| {
        let mut log = Log::small();
        change(&mut log.map);
        let report = Report::default();
        let map = load(log.write().path(), &report).unwrap().lane_map.unwrap();
        ((map.lanes.len(), map.drivable.len(), map.crossings.len(), map.marks.len()), said(&report).join("\n"))
    };
    let cases: [(MapChange<'_>, LayerCounts, &str); 7] = [
        (&|m| m["lane_segments"]["2"] = json!(7), (1, 1, 1, 3), "map lane segment: 2: invalid type"),
        (&|m| m["lane_segments"]["1"]["left_lane_boundary"][0]["x"] = json!("5"), (1, 1, 1, 3), "map lane segment: 1"),
        (&|m| m["lane_segments"]["1"]["left_lane_boundary"][0]["x"] = json!(1e300), (1, 1, 1, 3), "absurd points"),
        (&|m| m["lane_segments"]["1"]["left_lane_boundary"] = json!([]), (1, 1, 1, 3), "too few"),
        (&|m| m["lane_segments"]["1"]["left_lane_mark_type"] = json!("WAVY"), (2, 1, 1, 2), "unknown type 'WAVY'"),
        (
            &|m| m["drivable_areas"]["7"]["area_boundary"] = json!([{"x": 5000, "y": 2400}]),
            (2, 0, 1, 3),
            "drivable area: 7",
        ),
        (
            &|m| m["pedestrian_crossings"]["8"]["edge2"] = m["pedestrian_crossings"]["8"]["edge1"].clone(),
            (2, 1, 0, 3),
            "encloses nothing",
        ),
    ];
    for (change, counts, expect) in cases {
        let (found, report) = damaged(change);
        assert!(found == counts && report.contains(expect), "{found:?}, expected '{expect}' in {report}");
    }
}

#[test]
fn a_map_or_ground_that_cannot_be_read_is_reported_and_the_drive_stands() {
    let cases: [(&str, &[u8], &str); 7] = [
        (MAP, b"", "map that cannot be read"),
        (MAP, b"{\"lane_segments\": [1]}", "map that cannot be read"),
        (MAP, b"{\"lane_segments\": {\"1\": NaN}}", "map that cannot be read"),
        (HEIGHT, b"\x93NUMPY", "expected a NumPy array of version 1, 2 or 3"),
        (HEIGHT, &npy(60, &[1.0; 120])[..300], "expected 2 × 60 values of 4 bytes"),
        (SIMILARITY, b"{\"R\": [1, 1, 1, 1], \"t\": [0, 0], \"s\": 1}", "expected a rotation and a scale"),
        (SIMILARITY, b"{}", "ground height that cannot be read"),
    ];
    for (file, bytes, expect) in cases {
        let (root, report) = (Log::small().write(), Report::default());
        put(root.path(), file, bytes);
        let drive = load(root.path(), &report).unwrap();
        assert!(drive.lane_map.is_none() == (file == MAP) && drive.is_georeferenced);
        assert!(said(&report).iter().any(|line| line.contains(expect)), "expected '{expect}' in {:?}", said(&report));
    }
    let (root, report) = (Log::small().write(), Report::default());
    std::fs::remove_dir_all(root.path().join(LOG).join("map")).unwrap();
    assert!(!load(root.path(), &report).unwrap().is_georeferenced);
    assert!(said(&report).iter().any(|line| line.contains("unknown origin")));
}

#[test]
fn an_error_names_the_file_the_place_and_what_to_do() {
    let message = |damage: &dyn Fn(&std::path::Path)| {
        let root = Log::small().write();
        damage(&root.path().join(LOG));
        load(root.path(), &Report::default()).unwrap_err().to_string()
    };
    let cut = |name: &'static str, share: f64| {
        move |log: &std::path::Path| {
            let bytes = std::fs::read(log.join(name)).unwrap();
            std::fs::write(log.join(name), &bytes[..(bytes.len() as f64 * share) as usize]).unwrap();
        }
    };
    let table = |name: &'static str, change: &'static dyn Fn(&mut Table)| {
        move |log: &std::path::Path| {
            let mut table = Log::small().tables[name].clone();
            change(&mut table);
            std::fs::write(log.join(name), feather(&table, CompressionType::ZSTD)).unwrap();
        }
    };
    let cases: [(String, [&str; 3]); 8] = [
        (message(&cut(POSES, 0.5)), [POSES, "found its beginning alone", "download it again"]),
        (message(&cut(ANNOTATIONS, 0.0)), [ANNOTATIONS, "expected a Feather file", "download it again"]),
        (
            message(&|log| std::fs::remove_file(log.join(MOUNTS)).unwrap()),
            ["SE3_sensor", "found no file", "download the whole log"],
        ),
        (
            message(&|log| std::fs::remove_file(log.join(INTRINSICS)).unwrap()),
            ["intrinsics", "found no file", "whole log"],
        ),
        (
            message(&table(POSES, &|t| t.retain(|(name, _)| *name != "qx"))),
            ["schema", "expected a column 'qx', found timestamp_ns, qw, qy", "download"],
        ),
        (
            message(&table(ANNOTATIONS, &|t| *column(t, "category") = Column::Int(vec![0; 6]))),
            ["column 'category'", "expected a column of text, found one of Int64", "download"],
        ),
        (
            message(&table(ANNOTATIONS, &|t| *column(t, "timestamp_ns") = words(["0"; 6]))),
            ["column 'timestamp_ns'", "expected a column of whole numbers, found one of Utf8", "download"],
        ),
        (
            message(&table(POSES, &|t| column(t, "timestamp_ns").ints().iter_mut().for_each(|t| *t = 5))),
            [ANNOTATIONS, "at least one annotated moment", "choose another log"],
        ),
    ];
    for (message, parts) in cases {
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
}

/// A table of three columns with so many zeros each, which are packed to a few kilobytes.
fn zeros(rows: usize) -> Vec<u8> {
    let column: ArrayRef = Arc::new(Float32Array::from(vec![0.0; rows]));
    let batch = RecordBatch::try_from_iter(["x", "y", "z"].map(|name| (name, Arc::clone(&column)))).unwrap();
    let options = IpcWriteOptions::default().try_with_compression(Some(CompressionType::ZSTD)).unwrap();
    let mut writer = FileWriter::try_new_with_options(Vec::new(), &batch.schema(), options).unwrap();
    writer.write(&batch).unwrap();
    writer.into_inner().unwrap()
}

#[test]
fn a_small_file_that_unpacks_to_gigabytes_is_refused() {
    let (root, report) = (Log::small().write(), Report::default());
    let bytes = zeros(30_000_000);
    assert!(bytes.len() < 100_000);
    put(root.path(), SWEEP, &bytes);
    let drive = load(root.path(), &report).unwrap();
    assert!(drive.keyframes[0].lidar.is_none());
    assert!(said(&report).iter().any(|line| line.contains("content that unpacks to at most 2")), "{:?}", said(&report));
}

#[test]
fn a_log_a_hundred_times_as_large_is_read_in_seconds() {
    let rows = 100 * 6;
    let log = Log::small().with(ANNOTATIONS, |t| {
        for (name, column) in t {
            match column {
                Column::Float(values) => *values = values.repeat(100),
                Column::Int(values) => *values = values.repeat(100),
                Column::Text(values) if *name == "track_uuid" => {
                    *values = (0..rows).map(|i| format!("t{}", i / 6 * 2 + i % 2)).collect()
                }
                Column::Text(values) => *values = values.iter().cycle().take(rows).cloned().collect(),
                _ => {}
            }
        }
    });
    let started = Instant::now();
    let root = log.write();
    put(root.path(), HEIGHT, &npy(600, &[69.675; 600 * 400]));
    let drive = load(root.path(), &Report::default()).unwrap();
    assert_eq!((drive.keyframes.len(), drive.tracks.len()), (3, 200));
    assert!(started.elapsed() < Duration::from_secs(120), "{:?}", started.elapsed());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]
    #[test]
    fn damaged_files_never_panic(
        file in 0usize..8,
        changes in prop::collection::vec((0.0..1.0f64, prop::sample::select(&[0u8, 1, 4, 8, 0x7f, 0x80, 0xff][..]), 1usize..9), 1..4),
        is_cut in any::<bool>(),
    ) {
        let log = Log::small();
        let root = log.write();
        let (name, mut bytes) = log.files().swap_remove(file);
        for (at, byte, count) in changes {
            let at = (at * bytes.len() as f64) as usize;
            let to = (at + count).min(bytes.len());
            bytes[at..to].fill(byte);
            if is_cut {
                bytes.drain(at..to);
            }
        }
        put(root.path(), name, &bytes);
        if let Ok(drive) = load(root.path(), &Report::default()) {
            prop_assert!(!drive.keyframes.is_empty());
            let boxes = drive.keyframes.iter().flat_map(|k| &k.boxes);
            prop_assert!(boxes.clone().all(|b| b.cuboid.world_from_body.is_finite() && b.track < drive.tracks.len()));
        }
    }
}

//! A small dataset that is valid: one scene of three samples, two cameras and the LiDAR, a car and a bicycle.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Value, json};
use tempfile::TempDir;
use trove_model::{Drive, Outcome, Report};
use trove_read::ReadError;
use trove_read::nuscenes::NuScenes;

pub(crate) const VERSION: &str = "v1.0-mini";
pub(crate) const SCENE: &str = "scene-0001";
pub(crate) const START_US: i64 = 1_500_000_000_000_000;

/// The tables as values, to be changed before they are written.
#[derive(Clone)]
pub(crate) struct Dataset {
    pub(crate) tables: BTreeMap<&'static str, Vec<Value>>,
}

impl Dataset {
    /// The ego drives east from (100.4, 200.6) at 10 m/s; the car drives before it at 5 m/s; the bicycle stands.
    pub(crate) fn small() -> Self {
        let mut tables = BTreeMap::new();
        tables.insert(
            "scene",
            vec![json!({"token": "s", "log_token": "l", "nbr_samples": 3,
            "first_sample_token": "k0", "last_sample_token": "k2", "name": SCENE, "description": "A \"test\" {"})],
        );
        tables.insert(
            "log",
            vec![json!({"token": "l", "logfile": "x", "vehicle": "x", "date_captured": "2020-01-02",
            "location": "boston-seaport"})],
        );
        let sample = |i: i64| {
            json!({"token": format!("k{i}"), "timestamp": START_US + i * 500_000, "scene_token": "s",
                "prev": if i > 0 { format!("k{}", i - 1) } else { String::new() },
                "next": if i < 2 { format!("k{}", i + 1) } else { String::new() }})
        };
        tables.insert("sample", (0..3).map(sample).collect());
        let sensor =
            |channel: &str, modality: &str| json!({"token": channel, "channel": channel, "modality": modality});
        tables.insert(
            "sensor",
            vec![
                sensor("LIDAR_TOP", "lidar"),
                sensor("CAM_FRONT", "camera"),
                sensor("CAM_BACK", "camera"),
                sensor("RADAR_FRONT", "radar"),
            ],
        );
        let calibration = |channel: &str, rotation: [f64; 4]| {
            let is_camera = channel.starts_with("CAM");
            json!({"token": format!("c-{channel}"), "sensor_token": channel, "translation": [1.0, 0.0, 1.5],
                "rotation": rotation, "camera_intrinsic": if is_camera {
                    json!([[100.0, 0.0, 80.0], [0.0, 100.0, 45.0], [0.0, 0.0, 1.0]]) } else { json!([]) }})
        };
        tables.insert(
            "calibrated_sensor",
            vec![
                calibration("LIDAR_TOP", [0.5f64.sqrt(), 0.0, 0.0, 0.5f64.sqrt()]),
                calibration("CAM_FRONT", [0.5, -0.5, 0.5, -0.5]),
                calibration("CAM_BACK", [0.5, -0.5, -0.5, 0.5]),
                calibration("RADAR_FRONT", [1.0, 0.0, 0.0, 0.0]),
            ],
        );
        let (mut data, mut poses) = (Vec::new(), Vec::new());
        for i in 0..3 {
            for (c, channel) in ["RADAR_FRONT", "CAM_FRONT", "LIDAR_TOP", "CAM_BACK"].iter().enumerate() {
                for is_key_frame in [true, false] {
                    let token = format!("d-{channel}-{i}{}", if is_key_frame { "" } else { "-sweep" });
                    let offset_us = if is_key_frame { (c as i64 - 2) * 20_000 } else { 250_000 };
                    let time_us = START_US + i * 500_000 + offset_us;
                    let (height, width) = if channel.starts_with("CAM") { (90, 160) } else { (0, 0) };
                    data.push(json!({"token": token, "sample_token": format!("k{i}"), "ego_pose_token": token,
                        "calibrated_sensor_token": format!("c-{channel}"), "timestamp": time_us, "fileformat": "x",
                        "is_key_frame": is_key_frame, "height": height, "width": width, "prev": "", "next": "",
                        "filename": format!("{}/{channel}/{i}.bin", if is_key_frame { "samples" } else { "sweeps" })}));
                    poses.push(json!({"token": token, "timestamp": time_us, "rotation": [1.0, 0.0, 0.0, 0.0],
                        "translation": [100.4 + (time_us - START_US) as f64 * 1e-5, 200.6, 0.25]}));
                }
            }
        }
        tables.insert("sample_data", data);
        tables.insert("ego_pose", poses);
        tables.insert(
            "category",
            vec![
                json!({"token": "g0", "name": "vehicle.car", "description": ""}),
                json!({"token": "g1", "name": "vehicle.bicycle", "description": ""}),
            ],
        );
        tables.insert(
            "attribute",
            vec![
                json!({"token": "a0", "name": "vehicle.moving", "description": ""}),
                json!({"token": "a1", "name": "cycle.with_rider", "description": ""}),
            ],
        );
        tables.insert("visibility", vec![json!({"token": "2", "level": "v40-60", "description": ""})]);
        let instance = |i: i64| {
            json!({"token": format!("i{i}"), "category_token": format!("g{i}"), "nbr_annotations": 3,
            "first_annotation_token": format!("b{i}0"), "last_annotation_token": format!("b{i}2")})
        };
        tables.insert("instance", vec![instance(0), instance(1)]);
        let mut annotations = Vec::new();
        for (i, speed_mps) in [(0, 5.0), (1, 0.0)] {
            for k in 0..3 {
                annotations.push(json!({"token": format!("b{i}{k}"), "sample_token": format!("k{k}"),
                    "instance_token": format!("i{i}"), "visibility_token": if i == 0 { "2" } else { "" },
                    "attribute_tokens": [format!("a{i}")], "size": [2.0, 4.5, 1.5],
                    "translation": [120.0 + speed_mps * 0.5 * f64::from(k), 200.0 + 4.0 * f64::from(i), 0.75],
                    "rotation": [1.0, 0.0, 0.0, 0.0], "num_lidar_pts": if i == 0 { 7 } else { -1 }, "num_radar_pts": 0,
                    "prev": if k > 0 { format!("b{i}{}", k - 1) } else { String::new() },
                    "next": if k < 2 { format!("b{i}{}", k + 1) } else { String::new() }}));
            }
        }
        tables.insert("sample_annotation", annotations);
        Self { tables }
    }

    /// Changes a table.
    pub(crate) fn with(mut self, table: &'static str, change: impl FnOnce(&mut Vec<Value>)) -> Self {
        change(self.tables.entry(table).or_default());
        self
    }

    /// Writes the dataset into a folder of its own.
    pub(crate) fn write(&self) -> TempDir {
        let root = tempfile::tempdir().unwrap();
        for (name, rows) in &self.tables {
            // A string "NaN" stands for the word that Python writes and JSON does not have.
            let text = serde_json::to_string_pretty(rows).unwrap().replace("\"NaN\"", "NaN");
            put(root.path(), &format!("{VERSION}/{name}.json"), text.as_bytes());
        }
        root
    }
}

/// Writes a file below the root.
pub(crate) fn put(root: &Path, file: &str, bytes: &[u8]) {
    std::fs::create_dir_all(root.join(file).parent().unwrap()).unwrap();
    std::fs::write(root.join(file), bytes).unwrap();
}

/// Opens a dataset and loads its scene.
pub(crate) fn load(root: &Path, report: &Report) -> Result<Drive, ReadError> {
    NuScenes::open(root, VERSION, None, report)?.drive(SCENE, report)
}

/// What was noted, without the outcomes' examples.
pub(crate) fn notes(report: &Report) -> Vec<(Outcome, String, u64)> {
    report.entries().into_iter().map(|e| (e.outcome, e.what, e.count)).collect()
}

//! Datasets with nuScenes' schema: Lyft Level 5, which is read, and nuImages, which cannot be.

use serde_json::{Value, json};
use tempfile::TempDir;
use trove_model::{Drive, Kind, Report};
use trove_read::ReadError;
use trove_read::nuscenes::NuScenes;

use super::fixture::{Dataset, SCENE, VERSION, notes, put};

/// The small dataset in Lyft's words: its categories, times with fractions, no counts of points, no judged visibility, LiDARs
/// on the bumper, and no size of what is no picture.
fn lyft() -> Dataset {
    Dataset::small()
        .with("category", |rows| {
            rows.iter_mut().zip(["car", "bicycle"]).for_each(|(row, name)| row["name"] = json!(name));
        })
        .with("log", |rows| rows[0]["location"] = json!("Palo Alto"))
        .with("sample", |rows| rows.iter_mut().for_each(fractional))
        .with("sample_data", |rows| {
            rows.retain(|row| row["is_key_frame"] == true);
            for row in rows.iter_mut() {
                fractional(row);
                let file = row["filename"].as_str().unwrap().replace("samples", "lidar");
                row["filename"] = json!(file);
                if row["width"] == 0 {
                    (row["width"], row["height"]) = (Value::Null, Value::Null);
                }
            }
        })
        .with("sample_annotation", |rows| {
            for (i, row) in rows.iter_mut().enumerate() {
                (row["num_lidar_pts"], row["num_radar_pts"]) = (Value::Null, Value::Null);
                row["visibility_token"] = if i == 0 { Value::Null } else { json!("") };
                row.as_object_mut().unwrap().remove(if i == 1 { "visibility_token" } else { "num_radar_pts" });
            }
        })
        .with("attribute", Vec::clear)
        .with("sample_annotation", |rows| rows.iter_mut().for_each(|row| row["attribute_tokens"] = json!([])))
        .with("sensor", |rows| {
            let front = json!({"token": "f", "channel": "LIDAR_FRONT_LEFT", "modality": "lidar"});
            rows.push(front);
        })
}

fn fractional(row: &mut Value) {
    row["timestamp"] = json!(row["timestamp"].as_i64().unwrap() as f64 + 0.25);
}

/// The dataset with its tables in another folder.
fn moved(dataset: &Dataset, version: &str) -> TempDir {
    let root = dataset.write();
    std::fs::rename(root.path().join(VERSION), root.path().join(version)).unwrap();
    root
}

fn read(root: &TempDir, version: &str, report: &Report) -> Result<Drive, ReadError> {
    NuScenes::open(root.path(), version, None, report)?.drive(SCENE, report)
}

#[test]
fn lyft_is_read_from_any_folder_of_tables() {
    let sweep: Vec<u8> = [3.0f32, 0.0, -1.8, 9.0, 0.0].iter().flat_map(|f| f.to_le_bytes()).collect();
    for (version, folder) in [("train_data", "train_lidar"), ("data", "lidar"), ("v1.02-train", "lidar")] {
        let (root, report) = (moved(&lyft(), version), Report::default());
        put(root.path(), &format!("{folder}/LIDAR_TOP/0.bin"), &sweep);
        // One of the public release is cut.
        put(root.path(), &format!("{folder}/LIDAR_TOP/1.bin"), &sweep[..18]);
        assert_eq!(NuScenes::versions(root.path()), [version]);
        let drive = read(&root, version, &report).unwrap();
        let said = notes(&report);
        let is_said = |expect: &str| said.iter().any(|(_, what, _)| what.contains(expect));
        assert_eq!((drive.dataset.as_str(), drive.place.as_str()), ("lyft", "Palo Alto"));
        assert!(drive.licence.contains("CC BY-NC-SA 4.0, Lyft"), "{}", drive.licence);
        assert_eq!((drive.keyframes.len(), drive.tracks.len(), drive.rig.len()), (3, 2, 2));
        assert!(!drive.is_georeferenced && (drive.projection.origin_lat_deg - 37.44).abs() < 0.1);
        assert_eq!(drive.keyframes.iter().map(|k| k.lidar.is_some()).collect::<Vec<_>>(), [true, false, false]);
        let boxes = &drive.keyframes[0].boxes;
        assert_eq!((boxes[0].kind, boxes[1].kind), (Kind::Car, Kind::Bicycle));
        assert!(boxes.iter().all(|b| b.lidar_points.is_none() && b.visibility.is_none()));
        assert!(is_said("truncated LiDAR sweep") && is_said("LiDAR other than LIDAR_TOP"), "{said:?}");
        assert!(is_said("rider of a cycle without attributes"), "a bicycle that stands has none: {said:?}");
        assert!(said.len() == 4 && is_said("map expansion"), "{said:?}");
    }
}

#[test]
fn heights_that_were_recorded_are_not_levelled() {
    // It drives up a slope of 5 %, and boxes stand on it.
    let slope = |rows: &mut Vec<Value>| {
        for row in rows.iter_mut() {
            row["translation"][2] = json!(row["translation"][0].as_f64().unwrap() * 0.05);
        }
    };
    let root = lyft().with("ego_pose", slope).with("sample_annotation", slope).write();
    let drive = read(&root, VERSION, &Report::default()).unwrap();
    let heights: Vec<_> = drive.keyframes.iter().map(|k| k.world_from_ego.translation.z).collect();
    assert!((heights[1] - heights[0] - 0.25).abs() < 1e-9 && (heights[2] - heights[0] - 0.5).abs() < 1e-9);
}

#[test]
fn nuimages_is_refused_with_a_reason() {
    let root = tempfile::tempdir().unwrap();
    for table in ["object_ann", "surface_ann", "sample", "sample_data", "ego_pose", "log", "category"] {
        put(root.path(), &format!("v1.0-mini/{table}.json"), b"[]");
    }
    assert_eq!(NuScenes::versions(root.path()), ["v1.0-mini"], "it is recognised");
    let message = NuScenes::open(root.path(), "v1.0-mini", None, &Report::default()).err().unwrap().to_string();
    for part in ["v1.0-mini", "3D boxes", "nuImages", "object_ann.json", "use nuScenes"] {
        assert!(message.contains(part), "'{part}' in {message}");
    }
}

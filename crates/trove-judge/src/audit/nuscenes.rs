//! Roots of nuScenes' form: the tables of every version, and the LiDAR files that they name.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use trove_files::{LARGEST_FILE, OutputRoot, read_text};

use super::finding::{Audit, Check, Notes};
use super::tracks::jump;
use crate::pictures::dimensions;
use crate::{JudgeError, OnProgress};

/// Bytes of a LiDAR point: x, y, z, intensity and ring as floats.
const POINT_BYTES: u64 = 20;

#[derive(Deserialize)]
struct Sample {
    token: String,
    timestamp: i64,
    prev: String,
    next: String,
}

#[derive(Deserialize)]
struct Annotation {
    token: String,
    sample_token: String,
    instance_token: String,
    translation: [f64; 3],
    size: [f64; 3],
    rotation: [f64; 4],
    prev: String,
    next: String,
}

#[derive(Deserialize)]
struct Token {
    token: String,
}

#[derive(Deserialize)]
struct EgoPose {
    token: String,
    rotation: [f64; 4],
    translation: [f64; 3],
}

#[derive(Deserialize)]
struct SampleData {
    token: String,
    sample_token: String,
    ego_pose_token: String,
    calibrated_sensor_token: String,
    filename: String,
    #[serde(default)]
    width: u32,
    #[serde(default)]
    height: u32,
    is_key_frame: bool,
}

#[derive(Deserialize)]
struct Lidarseg {
    sample_data_token: String,
    filename: String,
}

/// Looks at every version below a folder.
pub(super) fn audit(root: &Path, progress: OnProgress) -> Result<Audit, JudgeError> {
    let entries = fs::read_dir(root).map_err(JudgeError::io(root))?;
    let mut versions: Vec<PathBuf> = entries.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect();
    versions.retain(|path| path.join("sample_annotation.json").is_file());
    versions.sort();
    if versions.is_empty() {
        let remedy = "give the folder with v1.0-mini or the like in it";
        return Err(JudgeError::unexpected(root, "nuScenes' tables", "none", remedy));
    }
    let mut audit = Audit::default();
    for (done, version) in versions.iter().enumerate() {
        if !progress(done + 1, versions.len()) {
            return Err(JudgeError::Ended);
        }
        let place = version.strip_prefix(root).unwrap_or(version).to_string_lossy().into_owned();
        let mut notes = Notes::of(place, None);
        notes.look(Check::Files);
        match look(root, version, &mut notes) {
            Ok(samples) => audit.frames += samples,
            Err(damage) => notes.wrong(Check::Files, damage),
        }
        audit.add(notes);
    }
    Ok(audit.finish())
}

fn table<T: DeserializeOwned>(version: &Path, name: &str) -> Result<Vec<T>, String> {
    let path = version.join(format!("{name}.json"));
    let text = read_text(&path, LARGEST_FILE).map_err(|e| format!("{name}.json: expected a table, found \"{e}\""))?;
    serde_json::from_str(&text).map_err(|e| format!("{name}.json: expected nuScenes' rows, found: {e}"))
}

fn look(root: &Path, version: &Path, notes: &mut Notes) -> Result<usize, String> {
    let samples: Vec<Sample> = table(version, "sample")?;
    let at: BTreeMap<&str, &Sample> = samples.iter().map(|sample| (sample.token.as_str(), sample)).collect();
    notes.look(Check::Ids);
    for sample in &samples {
        for (name, token, comes_after) in [("prev", &sample.prev, false), ("next", &sample.next, true)] {
            let Some(other) = at.get(token.as_str()) else {
                if !token.is_empty() {
                    notes.wrong(Check::Ids, format!("sample {}: {name} {token} is not listed", sample.token));
                }
                continue;
            };
            if (other.timestamp > sample.timestamp) != comes_after {
                notes.wrong(Check::Ids, format!("sample {}: {name} is not in the order of time", sample.token));
            }
        }
    }
    poses(version, notes)?;
    boxes(version, &at, notes)?;
    files(root, version, &at, notes)?;
    Ok(samples.len())
}

fn poses(version: &Path, notes: &mut Notes) -> Result<(), String> {
    notes.look(Check::Camera);
    for pose in table::<EgoPose>(version, "ego_pose")? {
        if !is_unit(pose.rotation) || pose.translation.iter().any(|part| !part.is_finite()) {
            notes.wrong(Check::Camera, format!("ego_pose {}: expected a unit quaternion and a place", pose.token));
        }
    }
    Ok(())
}

/// Quaternions are rounded in the tables.
fn is_unit([w, x, y, z]: [f64; 4]) -> bool {
    (DQuat::from_xyzw(x, y, z, w).length() - 1.0).abs() < 1e-3
}

fn boxes(version: &Path, samples: &BTreeMap<&str, &Sample>, notes: &mut Notes) -> Result<(), String> {
    let annotations: Vec<Annotation> = table(version, "sample_annotation")?;
    let instances: BTreeSet<String> = table::<Token>(version, "instance")?.into_iter().map(|row| row.token).collect();
    let known: BTreeMap<&str, &Annotation> = annotations.iter().map(|row| (row.token.as_str(), row)).collect();
    let mut tracks = BTreeMap::<&str, Vec<(i64, DVec3)>>::new();
    notes.look(Check::Boxes);
    notes.look(Check::Tracks);
    for row in &annotations {
        let told = format!("sample_annotation {}", row.token);
        if !is_unit(row.rotation) || row.size.iter().any(|size| !(0.02..60.0).contains(size)) {
            notes.wrong(Check::Boxes, format!("{told}: expected a unit quaternion and a size, found others"));
        }
        if !instances.contains(&row.instance_token) {
            notes.wrong(Check::Ids, format!("{told}: instance {} is not listed", row.instance_token));
        }
        for (name, token) in
            [("prev", &row.prev), ("next", &row.next)].into_iter().filter(|(_, token)| !token.is_empty())
        {
            let is_same = known.get(token.as_str()).is_some_and(|other| other.instance_token == row.instance_token);
            if !is_same {
                notes.wrong(Check::Ids, format!("{told}: {name} is not a box of the same instance"));
            }
        }
        match samples.get(row.sample_token.as_str()) {
            Some(sample) => {
                let at = (sample.timestamp.saturating_mul(1000), DVec3::from_array(row.translation));
                tracks.entry(&row.instance_token).or_default().push(at);
            }
            None => notes.wrong(Check::Ids, format!("{told}: sample {} is not listed", row.sample_token)),
        }
    }
    for (instance, mut at) in tracks {
        at.sort_by_key(|(time, _)| *time);
        for end in 2..=at.len() {
            if let Some(what) = jump(&at[..end]) {
                notes.wrong(Check::Tracks, format!("instance {instance}: {what}"));
            }
        }
    }
    Ok(())
}

fn files(root: &Path, version: &Path, samples: &BTreeMap<&str, &Sample>, notes: &mut Notes) -> Result<(), String> {
    let data: Vec<SampleData> = table(version, "sample_data")?;
    let tokens = |name: &str| -> Result<BTreeSet<String>, String> {
        Ok(table::<Token>(version, name)?.into_iter().map(|row| row.token).collect())
    };
    let (poses, sensors) = (tokens("ego_pose")?, tokens("calibrated_sensor")?);
    let (below, mut files) = (OutputRoot::new(root), BTreeMap::new());
    for row in &data {
        let told = format!("sample_data {}", row.token);
        if !samples.contains_key(row.sample_token.as_str()) {
            notes.wrong(Check::Ids, format!("{told}: sample {} is not listed", row.sample_token));
        }
        if !poses.contains(&row.ego_pose_token) || !sensors.contains(&row.calibrated_sensor_token) {
            notes.wrong(Check::Ids, format!("{told}: its pose or sensor is not listed"));
        }
        let Ok(path) = below.at(&row.filename) else {
            notes.wrong(Check::Files, format!("{told}: expected a file of the dataset, found {:?}", row.filename));
            continue;
        };
        // A copy of a dataset may be without its sweeps.
        if row.is_key_frame && path.is_file() {
            let size = dimensions(&path);
            if row.width > 0 && size != Some((row.width, row.height)) {
                let expected = format!("{}×{} pixels", row.width, row.height);
                notes.wrong(Check::Files, format!("{}: expected {expected}, found {size:?}", row.filename));
            }
            files.insert(row.token.as_str(), path);
        }
    }
    if !version.join("lidarseg.json").is_file() {
        return Ok(());
    }
    notes.look(Check::Lidar);
    let length = |path: &Path| fs::metadata(path).map(|file| file.len()).ok();
    for row in table::<Lidarseg>(version, "lidarseg")? {
        let Some(points) = files.get(row.sample_data_token.as_str()).and_then(|path| length(path)) else { continue };
        let labels = below.at(&row.filename).ok().and_then(|path| length(&path));
        if labels != Some(points / POINT_BYTES) {
            let what = format!("{}: expected a label for each of {} points", row.filename, points / POINT_BYTES);
            notes.wrong(Check::Lidar, format!("{what}, found {labels:?}"));
        }
    }
    Ok(())
}

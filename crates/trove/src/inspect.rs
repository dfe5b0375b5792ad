//! `trove inspect`: what a dataset holds.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::Result;
use serde_json::json;
use trove_model::{Drive, Report};

use crate::recipe::{Dataset, DriveSection, Keyframes};
use crate::run::report_json;
use crate::sources::open_dataset;

/// Prints the drives of a dataset: place, keyframes, cameras, boxes by class, LiDAR, map.
pub(crate) fn run(root: &Path, dataset: Option<Dataset>, version: Option<String>, as_json: bool) -> Result<()> {
    let section = DriveSection {
        dataset: dataset.unwrap_or(Dataset::Nuscenes),
        root: root.to_owned(),
        version,
        scenes: None,
        keyframes: Keyframes::All,
    };
    let report = Report::default();
    let opened = open_dataset(&section, root, &report)?;
    let mut drives = Vec::new();
    for scene in opened.scenes() {
        match opened.drive(&scene.name, &report) {
            Ok(drive) if as_json => drives.push(describe(&drive)),
            Ok(drive) => print(&drive),
            Err(error) => eprintln!("{}: {error}", scene.name),
        }
    }
    let report = report_json(&report);
    if as_json {
        let printed = json!({ "root": root, "drives": drives, "report": report });
        println!("{}", serde_json::to_string_pretty(&printed)?);
    } else {
        for entry in report["entries"].as_array().into_iter().flatten() {
            println!("{} {}× {}, such as {}", entry["outcome"], entry["count"], entry["what"], entry["examples"][0]);
        }
    }
    Ok(())
}

fn boxes_by_class(drive: &Drive) -> BTreeMap<&'static str, usize> {
    let mut boxes = BTreeMap::new();
    for object in drive.keyframes.iter().flat_map(|keyframe| &keyframe.boxes) {
        *boxes.entry(object.kind.class().row().name).or_default() += 1;
    }
    boxes
}

fn describe(drive: &Drive) -> serde_json::Value {
    let (lat_deg, lon_deg) = drive.projection.geo_from_world(glam::DVec2::ZERO);
    json!({
        "scene": drive.id,
        "dataset": drive.dataset,
        "place": drive.place,
        "lat_deg": lat_deg,
        "lon_deg": lon_deg,
        "keyframes": drive.keyframes.len(),
        "duration_s": duration_s(drive),
        "path_m": path_m(drive),
        "cameras": drive.rig.iter().map(|camera| &camera.name).collect::<Vec<_>>(),
        "tracks": drive.tracks.len(),
        "boxes": boxes_by_class(drive),
        "lidar_keyframes": lidar_keyframes(drive),
        "lidar_labels": drive.keyframes.iter().filter_map(|k| k.lidar.as_ref()).any(|l| !l.classes.is_empty()),
        "lane_map": drive.lane_map.is_some(),
        "licence": drive.licence,
    })
}

fn print(drive: &Drive) {
    let (lat_deg, lon_deg) = drive.projection.geo_from_world(glam::DVec2::ZERO);
    println!("{} ({}, {lat_deg:.5}, {lon_deg:.5})", drive.id, drive.place);
    println!("  {} keyframes over {:.1} s and {:.0} m", drive.keyframes.len(), duration_s(drive), path_m(drive));
    let cameras: Vec<&str> = drive.rig.iter().map(|camera| camera.name.as_str()).collect();
    println!("  cameras: {}", cameras.join(", "));
    let boxes: Vec<String> = boxes_by_class(drive).iter().map(|(class, n)| format!("{class} {n}")).collect();
    println!("  {} tracks; boxes: {}", drive.tracks.len(), boxes.join(", "));
    println!(
        "  LiDAR at {} keyframes; own map: {}",
        lidar_keyframes(drive),
        if drive.lane_map.is_some() { "yes" } else { "no" }
    );
}

fn lidar_keyframes(drive: &Drive) -> usize {
    drive.keyframes.iter().filter(|keyframe| keyframe.lidar.is_some()).count()
}

fn duration_s(drive: &Drive) -> f64 {
    match (drive.keyframes.first(), drive.keyframes.last()) {
        (Some(first), Some(last)) => (last.time_ns - first.time_ns) as f64 * 1e-9,
        _ => 0.0,
    }
}

fn path_m(drive: &Drive) -> f64 {
    let position = |k: &trove_model::Keyframe| k.world_from_ego.translation;
    drive.keyframes.windows(2).map(|pair| position(&pair[0]).distance(position(&pair[1]))).sum()
}

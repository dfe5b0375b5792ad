//! `trove inspect`: what a dataset or a rig holds.

use std::path::Path;

use anyhow::{Context, Result, anyhow};
use glam::DVec3;
use serde::Serialize;
use trove_format::ReportTable;
use trove_model::{Report, RigCamera};
use trove_read::DATASETS;
use trove_read::drive_source::DriveDescription;
use trove_read::rig;

use crate::build::print_entries;
use crate::cache;
use crate::message::shown;
use crate::recipe::{DriveSection, Keyframes};

/// Prints the drives of a dataset: place, keyframes, cameras, boxes by class, LiDAR, map. Without a name the dataset is
/// the one whose root the folder looks like, and a `.toml` file or the name of a preset is a rig; `options` are the dataset's own keys as a recipe has them (`version=v1.0-mini`).
pub(crate) fn run(root: &Path, dataset: Option<String>, options: &[String], as_json: bool) -> Result<()> {
    if let Some(cameras) = own_rig(root).filter(|_| dataset.is_none()) {
        return print_rig(&cameras?, as_json);
    }
    let dataset = match dataset {
        Some(name) => name,
        None => recognised(root)?.to_owned(),
    };
    let options = options.iter().map(|option| {
        let (key, value) = option.split_once('=').context("--option: expected KEY=VALUE, as in a recipe's [drive]")?;
        Ok((key.trim().to_owned(), toml_value(value)))
    });
    let options = options.collect::<Result<_>>()?;
    let section = DriveSection { dataset, root: root.to_owned(), scenes: None, keyframes: Keyframes::All, options };
    let report = Report::default();
    let opened = section.opener()?(root, cache::folder().as_deref(), &report)?;
    let mut drives = Vec::new();
    for listing in opened.drives() {
        match opened.describe(&listing.name, &report) {
            Ok(drive) if as_json => drives.push(drive),
            Ok(drive) => print(&drive),
            Err(error) => eprintln!("{}: {}", listing.name, shown(&error.to_string())),
        }
    }
    let report = ReportTable::from(&report);
    if as_json {
        let printed = Inspected { root, drives, report };
        println!("{}", serde_json::to_string_pretty(&printed)?);
    } else {
        print_entries(&report, "");
    }
    Ok(())
}

/// What `trove inspect --json` prints.
#[derive(Serialize)]
struct Inspected<'a> {
    root: &'a Path,
    drives: Vec<DriveDescription>,
    report: ReportTable,
}

/// The cameras of a rig's file or of a preset that no folder has the name of.
fn own_rig(root: &Path) -> Option<Result<Vec<RigCamera>>> {
    if root.extension().is_some_and(|extension| extension == "toml") {
        return Some(rig::read(root).map_err(Into::into));
    }
    let preset = root.to_str().and_then(rig::preset).filter(|_| !root.exists());
    preset.map(Ok)
}

/// A camera as `trove inspect --json` prints it.
#[derive(Serialize)]
struct InspectedCamera<'a> {
    name: &'a str,
    size_px: [u32; 2],
    model: &'static str,
    focal_px: [f64; 2],
    position_m: [f64; 3],
    /// To the left of straight ahead.
    yaw_deg: f64,
    /// Up.
    pitch_deg: f64,
}

impl<'a> From<&'a RigCamera> for InspectedCamera<'a> {
    fn from(camera: &'a RigCamera) -> Self {
        let (lens, ahead_ego) = (&camera.lens, camera.ego_from_camera.vector(DVec3::Z));
        Self {
            name: &camera.name,
            size_px: [lens.width_px, lens.height_px],
            model: lens.distortion.name(),
            focal_px: [lens.fx_px, lens.fy_px],
            position_m: camera.ego_from_camera.translation.to_array(),
            yaw_deg: ahead_ego.y.atan2(ahead_ego.x).to_degrees(),
            pitch_deg: ahead_ego.z.clamp(-1.0, 1.0).asin().to_degrees(),
        }
    }
}

fn print_rig(cameras: &[RigCamera], as_json: bool) -> Result<()> {
    let cameras: Vec<InspectedCamera<'_>> = cameras.iter().map(Into::into).collect();
    if as_json {
        println!("{}", serde_json::to_string_pretty(&serde_json::json!({ "cameras": cameras }))?);
        return Ok(());
    }
    for camera in cameras {
        let InspectedCamera { name, size_px: [width, height], model, focal_px: [fx, _], .. } = camera;
        let [x, y, z] = camera.position_m;
        println!(
            "{name}: {width} × {height}, {model}, f = {fx:.1} px, at ({x:.2}, {y:.2}, {z:.2}) m, yaw {:.1}°, pitch {:.1}°",
            camera.yaw_deg, camera.pitch_deg
        );
    }
    Ok(())
}

/// The dataset whose root a folder looks like.
fn recognised(root: &Path) -> Result<&'static str> {
    let found = DATASETS.iter().find(|dataset| (dataset.is_at)(root));
    found.map(|dataset| dataset.name).ok_or_else(|| {
        let names: Vec<&str> = DATASETS.iter().map(|dataset| dataset.name).collect();
        let known = names.join(", ");
        let root = root.display();
        anyhow!(
            "{root}: expected the root of a dataset ({known}), found none; give the root, or name it with --dataset"
        )
    })
}

/// A number, a boolean or a list as TOML has it; anything else is text.
fn toml_value(text: &str) -> toml::Value {
    text.trim().parse().unwrap_or_else(|_| toml::Value::String(text.trim().to_owned()))
}

fn print(drive: &DriveDescription) {
    println!("{} ({}, {:.5}, {:.5})", drive.scene, shown(&drive.place), drive.lat_deg, drive.lon_deg);
    println!("  {} keyframes over {:.1} s and {:.0} m", drive.keyframes, drive.duration_s, drive.path_m);
    println!("  cameras: {}", drive.cameras.join(", "));
    let boxes: Vec<String> = drive.boxes.iter().map(|(class, n)| format!("{class} {n}")).collect();
    println!("  {} tracks; boxes: {}", drive.tracks, boxes.join(", "));
    let own_map = if drive.lane_map { "yes" } else { "no" };
    println!("  LiDAR at {} keyframes; own map: {own_map}", drive.lidar_keyframes);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rig_is_a_file_or_a_preset_and_a_folder_of_its_name_is_none() {
        assert_eq!(own_rig(Path::new("kitti")).unwrap().unwrap().len(), 4);
        assert!(own_rig(Path::new("no/my.toml")).unwrap().is_err());
        assert!(own_rig(Path::new("kitty")).is_none());
        let panorama = rig::preset("360").unwrap();
        let row = InspectedCamera::from(&panorama[0]);
        assert_eq!((row.model, row.size_px, row.yaw_deg.abs() < 1e-9), ("equirectangular", [2048, 1024], true));
    }

    #[test]
    fn a_folder_that_is_no_dataset_says_which_there_are() {
        let folder = tempfile::tempdir().unwrap();
        let message = format!("{:#}", run(folder.path(), None, &[], false).unwrap_err());
        assert!(message.contains("nuscenes") && message.contains("--dataset"), "{message}");
    }

    #[test]
    fn options_are_those_of_the_dataset() {
        let folder = tempfile::tempdir().unwrap();
        let message = |option: &str| {
            let named = Some("nuscenes".to_owned());
            format!("{:#}", run(folder.path(), named, &[option.to_owned()], false).unwrap_err())
        };
        assert!(message("version").contains("KEY=VALUE"));
        assert!(message("verison=v1.0-mini").contains("did you mean `version`?"));
        assert!(message("version=v1.0-mini").contains("v1.0-mini"));
    }
}

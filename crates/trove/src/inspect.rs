//! `trove inspect`: what a dataset holds.

use std::path::Path;

use anyhow::{Context, Result, anyhow};
use serde::Serialize;
use trove_format::ReportTable;
use trove_model::Report;
use trove_read::DATASETS;
use trove_read::drive_source::DriveDescription;

use crate::build::print_entries;
use crate::cache;
use crate::message::shown;
use crate::recipe::{DriveSection, Keyframes};

/// Prints the drives of a dataset: place, keyframes, cameras, boxes by class, LiDAR, map. Without a name the dataset is
/// the one whose root the folder looks like; `options` are the dataset's own keys as a recipe has them (`version=v1.0-mini`).
pub(crate) fn run(root: &Path, dataset: Option<String>, options: &[String], as_json: bool) -> Result<()> {
    let dataset = match dataset {
        Some(name) => name,
        None => recognised(root)?.to_owned(),
    };
    let options = options.iter().map(|option| {
        let (key, value) = option.split_once('=').context("--option: expected KEY=VALUE, as in a recipe's [drive]")?;
        Ok((key.trim().to_owned(), toml_value(value)))
    });
    let options = options.collect::<Result<_>>()?;
    let section =
        DriveSection { dataset, root: root.to_owned(), scenes: None, keyframes: Keyframes::All, at: None, options };
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

//! `trove inspect`: what a dataset holds.

use std::path::Path;

use anyhow::Result;
use serde::Serialize;
use trove_format::ReportTable;
use trove_model::Report;
use trove_read::drive_source::DriveDescription;

use crate::build::print_entries;
use crate::drives::DatasetChoice;
use crate::message::shown;
use crate::rigs::{own_rig, print_rig};

/// Prints the drives of a dataset: place, keyframes, cameras, boxes by class, LiDAR, map; or the cameras of a rig, where
/// the root is a `.toml` file or the name of a preset. The exit status is 1 where a drive cannot be read.
pub(crate) fn run(root: &Path, dataset: &DatasetChoice, as_json: bool) -> Result<i32> {
    if let Some(cameras) = own_rig(root).filter(|_| dataset.dataset.is_none()) {
        return print_rig(&cameras?, as_json).map(|()| 0);
    }
    let report = Report::default();
    let opened = dataset.open(root, &report)?;
    let (mut drives, mut faults) = (Vec::new(), Vec::new());
    for listing in opened.drives() {
        match opened.describe(&listing.name, &report) {
            Ok(drive) if as_json => drives.push(drive),
            Ok(drive) => print(&drive),
            Err(error) => {
                let error = shown(&error.to_string());
                eprintln!("{}: {error}", listing.name);
                faults.push(error);
            }
        }
    }
    let status = i32::from(!faults.is_empty());
    let report = ReportTable::from(&report);
    if as_json {
        let printed = Inspected { root, drives, faults, report };
        println!("{}", serde_json::to_string_pretty(&printed)?);
    } else {
        print_entries(&report, "");
    }
    Ok(status)
}

/// What `trove inspect --json` prints.
#[derive(Serialize)]
struct Inspected<'a> {
    root: &'a Path,
    drives: Vec<DriveDescription>,
    /// What is wrong with the drives that cannot be read.
    faults: Vec<String>,
    report: ReportTable,
}

fn print(drive: &DriveDescription) {
    println!("{} ({}, {:.5}, {:.5})", drive.scene, shown(&drive.place), drive.lat_deg, drive.lon_deg);
    println!("  {} keyframes over {:.1} s and {:.0} m", drive.keyframes, drive.duration_s, drive.path_m);
    if drive.path_poses > 0 || drive.sweeps_between > 0 {
        let (poses, hz, sweeps) = (drive.path_poses, drive.path_hz, drive.sweeps_between);
        println!("  between keyframes: path of {poses} poses ({hz:.1} a second), {sweeps} LiDAR sweeps");
    }
    println!("  cameras: {}", drive.cameras.join(", "));
    let boxes: Vec<String> = drive.boxes.iter().map(|(class, n)| format!("{class} {n}")).collect();
    println!("  {} tracks; boxes: {}", drive.tracks, boxes.join(", "));
    let own_map = if drive.lane_map { "yes" } else { "no" };
    println!("  LiDAR at {} keyframes; own map: {own_map}", drive.lidar_keyframes);
}

//! Calibration of the cameras and the upper LiDAR.

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec3;
use trove_files::PathComponent;
use trove_model::{Camera, Distortion, Lens, Outcome, Pose, Report, RigCamera, RigLidar, SensorFrame, SweepPhase};

use super::city::axle_from_ego;
use super::feather::Table;
use super::frames::Axle;
use super::poses::{POSE, poses};
use crate::ReadError;

/// The LiDAR whose place stands for both of a sweep's: the other hangs 12 cm below it.
const LIDAR: &str = "up_lidar";
/// Where the upper LiDAR is in the published logs; for a log that does not say.
const LIDAR_AXLE: DVec3 = DVec3::new(1.35, 0.0, 1.64);
/// No image has a longer side, pixels.
const LARGEST_IMAGE_PX: i64 = 65_535;

/// A log's sensors.
pub(super) struct Calibration {
    /// In the order of names.
    pub(super) rig: Vec<RigCamera>,
    /// The upper LiDAR in the dataset's vehicle frame.
    pub(super) lidar_axle: DVec3,
    /// The same with its axes, where the log says.
    pub(super) lidar: Option<RigLidar>,
}

/// A camera's name with its lens, or with what is wrong with it.
type NamedLens = (String, Result<Lens, &'static str>);

/// Reads a log's `calibration`; a camera that has no usable lens or place is left out and reported.
pub(super) fn read(folder: &Path, report: &Report) -> Result<Calibration, ReadError> {
    let mounts = mounts(&folder.join("egovehicle_SE3_sensor.feather"), report)?;
    let mut rig = BTreeMap::new();
    for (name, lens) in lenses(&folder.join("intrinsics.feather"))? {
        let dropped = |why: &str| report.note(Outcome::Dropped, &format!("Argoverse 2 camera: {why}"), &name);
        match (lens, mounts.get(&name)) {
            _ if PathComponent::new(&name).is_err() => dropped("name that is no folder's"),
            (Err(why), _) => dropped(why),
            (_, None) => dropped("no valid pose in egovehicle_SE3_sensor.feather"),
            _ if rig.contains_key(&name) => dropped("second of its name"),
            (Ok(lens), Some(axle_from_camera)) => {
                let ego_from_camera = axle_from_ego().inverse() * *axle_from_camera;
                rig.insert(name.clone(), RigCamera { name, lens, ego_from_camera });
            }
        }
    }
    let mount = mounts.get(LIDAR);
    if mount.is_none() {
        let what = "place of an Argoverse 2 log's LiDAR, which has no valid pose";
        report.note(Outcome::Guessed, what, folder.display());
    }
    let lidar = mount.map(|mount| RigLidar {
        name: LIDAR.to_owned(),
        ego_from_lidar: axle_from_ego().inverse() * Pose::new(mount.rotation, mount.translation),
        phase: SweepPhase::FORWARD,
    });
    let lidar_axle = mount.map_or(LIDAR_AXLE, |mount| mount.translation);
    Ok(Calibration { rig: rig.into_values().collect(), lidar_axle, lidar })
}

/// The sensors' poses by name; LiDARs are posed as cameras here, and only their places are used.
fn mounts(path: &Path, report: &Report) -> Result<BTreeMap<String, Pose<Axle, Camera>>, ReadError> {
    let table = Table::read(path, &[&["sensor_name"], &POSE[..]].concat())?;
    let mut mounts = BTreeMap::new();
    for (name, pose) in table.words("sensor_name")?.into_iter().zip(poses::<Axle, SensorFrame>(&table)?) {
        let name = name.unwrap_or_default();
        let dropped = |why: &str| report.note(Outcome::Dropped, &format!("Argoverse 2 sensor: {why}"), &name);
        match pose {
            None => dropped("without a valid pose"),
            Some(_) if mounts.contains_key(&name) => dropped("second of its name"),
            Some(pose) => drop(mounts.insert(name, Pose::new(pose.rotation, pose.translation))),
        }
    }
    Ok(mounts)
}

/// The cameras' lenses by name, in the order of the file.
///
/// The published pictures are without distortion (user guide, "Sensor Suite"), and the devkit projects onto them as onto a
/// pinhole's: k1 to k3 belong to the pictures before they were straightened.
fn lenses(path: &Path) -> Result<Vec<NamedLens>, ReadError> {
    const COLUMNS: [&str; 7] = ["sensor_name", "fx_px", "fy_px", "cx_px", "cy_px", "width_px", "height_px"];
    let table = Table::read(path, &COLUMNS)?;
    let (fx, fy) = (table.numbers("fx_px")?, table.numbers("fy_px")?);
    let (cx, cy) = (table.numbers("cx_px")?, table.numbers("cy_px")?);
    let (width, height) = (table.integers("width_px")?, table.integers("height_px")?);
    let lens = |i: usize| {
        let side = |px: Option<i64>| px.filter(|px| (1..=LARGEST_IMAGE_PX).contains(px)).map(|px| px as u32);
        let (Some(width_px), Some(height_px)) = (side(width[i]), side(height[i])) else {
            return Err("image of no size");
        };
        let is_focal = |f: f64| f > 0.0 && f < 1e6;
        if !(is_focal(fx[i]) && is_focal(fy[i]) && cx[i].abs() < 1e6 && cy[i].abs() < 1e6) {
            return Err("no usable intrinsics");
        }
        let (fx_px, fy_px, cx_px, cy_px) = (fx[i], fy[i], cx[i], cy[i]);
        Ok(Lens { width_px, height_px, fx_px, fy_px, cx_px, cy_px, distortion: Distortion::None })
    };
    let names = table.words("sensor_name")?;
    Ok(names.into_iter().enumerate().map(|(i, name)| (name.unwrap_or_default(), lens(i))).collect())
}

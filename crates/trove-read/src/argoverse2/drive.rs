//! One log, joined from its files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::DVec3;
use rayon::prelude::*;
use trove_model::{Drive, DriveOrigin, EgoBody, Keyframe, MapProjection, Outcome, Pose, Report, World};

use super::city::CityFrame;
use super::dataset::{ANNOTATIONS, Argoverse2, LICENCE, POSES, keyframe_times};
use super::exposures::{Pictures, files_by_time};
use super::frames::Axle;
use super::ground;
use super::{boxes, calibration, clock, lane_map, lidar, poses, riders};
use crate::ReadError;

/// Argoverse 2's recording cars are Ford Fusion Hybrids: published length, width without mirrors, and height without the
/// sensors on the roof. Wheelbase (2.85 m) and rear overhang put the car's centre about 1.37 m before the rear axle.
const EGO_BODY: EgoBody = EgoBody { centre_ego: DVec3::new(1.37, 0.0, 0.737), size_m: DVec3::new(4.872, 1.852, 1.473) };

impl Argoverse2 {
    /// Loads a log by its name.
    ///
    /// # Errors
    /// There is no such log, or its poses, calibration or annotations cannot be read or are not what the dataset's are.
    pub fn drive(&self, name: &str, report: &Report) -> Result<Drive, ReadError> {
        let log = self.folder(name)?;
        let poses = poses::path(&log.join(POSES), report)?;
        let calibration = calibration::read(&log.join("calibration"), report)?;
        let annotations = match log.join(ANNOTATIONS) {
            path if path.exists() => boxes::read(&path, report)?,
            _ => {
                report.note(Outcome::Warned, "Argoverse 2 log without annotations: keyframes are its sweeps", name);
                BTreeMap::new()
            }
        };
        let posed = |time_ns: i64| {
            let pose = poses.at(time_ns);
            if pose.is_none() {
                report.note(Outcome::Dropped, "Argoverse 2 keyframe without a vehicle pose", time_ns);
            }
            Some((time_ns, pose?))
        };
        let moments: Vec<_> = keyframe_times(annotations.keys().copied(), log).into_iter().filter_map(posed).collect();
        let Some((first_ns, first)) = moments.first() else { return Err(empty(log)) };
        let map = lane_map::file(log);
        let city = map.as_deref().and_then(lane_map::city);
        let frame = CityFrame::new(city.as_deref(), first.translation, report);
        let lon_deg = frame.projection.map_or(0.0, |projection| projection.origin_lon_deg);
        let shift_ns = clock::shift_ns(*first_ns, lon_deg, name, report);
        let pictures = Pictures::of(log, &calibration.rig, report);
        let mut keyframes: Vec<_> = moments
            .iter()
            .map(|(time_ns, pose)| Keyframe {
                time_ns: *time_ns,
                token: time_ns.to_string(),
                world_from_ego: frame.world_from_ego(pose),
                exposures: pictures.exposures(*time_ns, &self.root, &poses, &frame),
                boxes: Vec::new(),
                lidar: None,
            })
            .collect();
        let moments: Vec<_> = moments.iter().map(|(time_ns, pose)| (*time_ns, frame.world_from_axle(pose))).collect();
        let mut tracks = boxes::place(&annotations, &moments, &mut keyframes, report);
        riders::seat(&mut keyframes, &mut tracks, report);
        let tracks = riders::without_empty(&mut keyframes, tracks);
        boxes::set_velocities(&mut keyframes, &tracks);
        read_sweeps(log, &moments, &mut keyframes, calibration.lidar_axle, report);
        for keyframe in &mut keyframes {
            keyframe.time_ns = keyframe.time_ns.saturating_add(shift_ns);
            keyframe.exposures.iter_mut().for_each(|e| e.time_ns = e.time_ns.saturating_add(shift_ns));
        }
        let path: Vec<_> = keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
        let mut lane_map = lane_map::read(map.as_deref(), &frame, &path, report);
        if let Some(lane_map) = &mut lane_map {
            lane_map.ground = ground::read(log, &frame, &path, report);
        }
        Ok(Drive {
            id: name.to_owned(),
            dataset: "argoverse2".to_owned(),
            origin: DriveOrigin::Recorded,
            place: city.unwrap_or_default(),
            is_georeferenced: frame.projection.is_some(),
            projection: frame.projection.unwrap_or_else(|| MapProjection::ellipsoidal(0.0, 0.0, glam::DVec2::ZERO)),
            rig: calibration.rig,
            lidars: calibration.lidar.into_iter().collect(),
            ego_body: EGO_BODY,
            keyframes,
            path: poses.map(|_, pose| frame.world_from_ego(pose)).later(shift_ns),
            sweeps: Vec::new(),
            tracks,
            lane_map,
            licence: LICENCE.to_owned(),
        })
    }

    /// Every file of a log that is read but its pictures, sorted.
    pub(super) fn files(&self, name: &str) -> Result<Vec<PathBuf>, ReadError> {
        let log = self.folder(name)?;
        let fixed = [POSES, ANNOTATIONS, "calibration/intrinsics.feather", "calibration/egovehicle_SE3_sensor.feather"];
        let mut files: Vec<_> = fixed.iter().map(|file| log.join(file)).collect();
        files.extend(lane_map::file(log));
        files.extend(ground::files(log).into_iter().flatten());
        files.extend(files_by_time(&log.join("sensors/lidar"), &["feather"]).into_values());
        files.retain(|path| path.is_file());
        files.sort();
        Ok(files)
    }
}

fn read_sweeps(
    log: &Path,
    moments: &[(i64, Pose<World, Axle>)],
    keyframes: &mut [Keyframe],
    lidar_axle: DVec3,
    report: &Report,
) {
    let files = files_by_time(&log.join("sensors/lidar"), &["feather"]);
    keyframes.par_iter_mut().zip(moments).for_each(|(keyframe, (time_ns, world_from_axle))| {
        let file = files.get(time_ns);
        keyframe.lidar = file.and_then(|file| lidar::sweep(file, world_from_axle, lidar_axle, report));
    });
}

fn empty(log: &Path) -> ReadError {
    ReadError::Format {
        path: log.join(ANNOTATIONS),
        place: "all rows".to_owned(),
        expected: "at least one annotated moment, or sweep, with a vehicle pose".to_owned(),
        found: "none usable".to_owned(),
        remedy: "choose another log, or download this one again".to_owned(),
    }
}

//! A recording's parts → `Drive`.

use std::path::Path;

use trove_model::{
    Drive, DriveOrigin, Ego, Exposure, Keyframe, MapProjection, Pose, Report, RigCamera, RigLidar, SensorFrame,
    SweepPhase, Trajectory, World,
};

use super::boxes::{self, Annotation};
use super::facts::FACTS;
use super::sweeps;
use crate::levelling::{self, Trust};

/// Attitudes are the IMU's, to about 0.03°, and heights drift by up to 5 cm a second, against boxes that are placed to about
/// 5 cm.
const HEIGHTS: Trust = Trust { tilt: 10_000.0, change: 1.0, step_ns: 1_000_000_000 };

/// What was recorded, before it is joined.
pub(super) struct Recorded {
    pub(super) name: String,
    pub(super) licence: &'static str,
    pub(super) rig: Vec<RigCamera>,
    /// `None` where the recording has no poses.
    pub(super) projection: Option<MapProjection>,
    pub(super) moments: Vec<Moment>,
    /// The vehicle between the moments too; empty where no more is known.
    pub(super) path: Trajectory<World, Ego>,
    pub(super) annotations: Vec<Annotation>,
    pub(super) ego_from_velodyne: Pose<Ego, SensorFrame>,
}

/// A keyframe.
pub(super) struct Moment {
    /// Its number in the recording.
    pub(super) frame: usize,
    pub(super) time_ns: i64,
    pub(super) world_from_ego: Pose<World, Ego>,
    /// One for each camera of the rig, at most.
    pub(super) pictures: Vec<Picture>,
    /// The sweep's file below the root.
    pub(super) sweep: Option<String>,
}

/// A picture.
pub(super) struct Picture {
    /// Index into the rig.
    pub(super) camera: usize,
    pub(super) time_ns: i64,
    pub(super) world_from_ego: Pose<World, Ego>,
    /// Below the root.
    pub(super) file: String,
}

/// Joins a recording.
pub(super) fn join(root: &Path, recorded: Recorded, report: &Report) -> Drive {
    let Recorded { name, licence, rig, projection, moments, path, annotations, ego_from_velodyne } = recorded;
    let mut keyframes: Vec<Keyframe> = moments
        .iter()
        .map(|moment| Keyframe {
            time_ns: moment.time_ns,
            token: format!("{name}/{:06}", moment.frame),
            world_from_ego: moment.world_from_ego,
            exposures: moment.pictures.iter().map(|picture| exposure(root, &rig, picture)).collect(),
            boxes: Vec::new(),
            lidar: None,
        })
        .collect();
    let tracks = boxes::place(annotations, &mut keyframes, report);
    let sweep = |(i, moment): (usize, &Moment)| {
        let file = moment.sweep.clone().filter(|file| root.join(file).is_file())?;
        Some((i, file, moment.world_from_ego * ego_from_velodyne))
    };
    let sweeps: Vec<_> = moments.iter().enumerate().filter_map(sweep).collect();
    sweeps::read(root, &sweeps, &mut keyframes, report);
    let is_georeferenced = projection.is_some();
    let somewhere = || MapProjection::spherical(FACTS.lat_deg, FACTS.lon_deg, glam::DVec2::ZERO);
    let mut drive = Drive {
        id: name,
        dataset: "kitti".to_owned(),
        origin: DriveOrigin::Recorded,
        place: FACTS.place.clone(),
        projection: projection.unwrap_or_else(somewhere),
        is_georeferenced,
        rig,
        lidars: vec![RigLidar {
            name: "velodyne".to_owned(),
            ego_from_lidar: ego_from_velodyne,
            phase: SweepPhase::FORWARD,
        }],
        ego_body: FACTS.ego_body(),
        keyframes,
        path,
        sweeps: Vec::new(),
        tracks,
        lane_map: None,
        licence: licence.to_owned(),
    };
    levelling::level(&mut drive, &HEIGHTS, report);
    boxes::tell_velocities(&drive.tracks, &mut drive.keyframes);
    drive
}

fn exposure(root: &Path, rig: &[RigCamera], picture: &Picture) -> Exposure {
    let camera = &rig[picture.camera];
    Exposure {
        camera: picture.camera,
        time_ns: picture.time_ns,
        world_from_ego: picture.world_from_ego,
        lens: camera.lens,
        ego_from_camera: camera.ego_from_camera,
        token: Some(picture.file.clone()),
        file: root.join(&picture.file).is_file().then(|| picture.file.clone()),
    }
}

//! What the sensors took for each keyframe, with its own time and pose.

use std::collections::{BTreeMap, HashMap};
use std::path::{Component, Path};

use trove_model::{Camera, Ego, Exposure, Lens, Outcome, Pose, Report, RigCamera, SensorFrame, World};

use super::poses;
use super::records::{CalibratedSensorRecord, EgoPoseRecord, SampleDataRecord};
use super::tables::{ByToken, Tables};

/// The vehicle in the dataset's global frame, which is World but for the anchor.
pub(super) type GlobalFromEgo = Pose<World, Ego>;

/// What a camera took.
pub(super) struct Picture {
    pub(super) channel: String,
    pub(super) time_ns: i64,
    pub(super) global_from_ego: GlobalFromEgo,
    pub(super) lens: Lens,
    pub(super) ego_from_camera: Pose<Ego, Camera>,
    pub(super) token: String,
    pub(super) file: Option<String>,
}

/// What the top LiDAR took.
pub(super) struct Revolution {
    pub(super) global_from_ego: GlobalFromEgo,
    pub(super) ego_from_sensor: Pose<Ego, SensorFrame>,
    pub(super) token: String,
    pub(super) file: Option<String>,
}

/// One sample's sensor data.
#[derive(Default)]
pub(super) struct Taken {
    /// By the cameras' names.
    pub(super) pictures: BTreeMap<String, Picture>,
    pub(super) revolution: Option<Revolution>,
}

impl Taken {
    /// The vehicle at a keyframe's time: the LiDAR's pose, whose time that is; without one, between the pictures
    /// before and after. `None` where nothing was taken.
    pub(super) fn global_from_ego(&self, time_ns: i64, keyframe: &str, report: &Report) -> Option<GlobalFromEgo> {
        if let Some(revolution) = &self.revolution {
            return Some(revolution.global_from_ego);
        }
        let pictures = self.pictures.values();
        let before = pictures.clone().filter(|p| p.time_ns <= time_ns).max_by_key(|p| p.time_ns);
        let after = pictures.filter(|p| p.time_ns > time_ns).min_by_key(|p| p.time_ns);
        let pose = match (before, after) {
            (Some(a), Some(b)) => {
                let share = (time_ns - a.time_ns) as f64 / (b.time_ns - a.time_ns) as f64;
                a.global_from_ego.interpolate(&b.global_from_ego, share)
            }
            (one, other) => one.or(other)?.global_from_ego,
        };
        report.note(Outcome::Guessed, "nuScenes keyframe's ego pose from its cameras' (no LIDAR_TOP)", keyframe);
        Some(pose)
    }
}

/// Joins `sample_data` with poses and calibrations, by the sample's token; what does not join is reported.
pub(super) fn join(
    root: &Path,
    tables: &Tables,
    data: Vec<SampleDataRecord>,
    ego_poses: &ByToken<EgoPoseRecord>,
    report: &Report,
) -> HashMap<String, Taken> {
    let mut taken = HashMap::<String, Taken>::new();
    for record in data {
        let dropped = |why: &str| report.note(Outcome::Dropped, &format!("nuScenes sample_data: {why}"), &record.token);
        let Some(calibration) = tables.calibrated_sensors.get(&record.calibrated_sensor_token) else {
            dropped("unknown calibrated_sensor");
            continue;
        };
        let Some(sensor) = tables.sensors.get(&calibration.sensor_token) else {
            dropped("unknown sensor");
            continue;
        };
        let Some(pose) = ego_poses.get(&record.ego_pose_token) else {
            dropped("unknown ego_pose");
            continue;
        };
        let Some(global_from_ego) = poses::pose(pose.translation, pose.rotation) else {
            dropped("ego_pose without a valid pose");
            continue;
        };
        let of_sample = taken.entry(record.sample_token.clone()).or_default();
        let is_first = if sensor.modality == "camera" {
            match picture(root, &sensor.channel, &record, calibration, global_from_ego, report) {
                Ok(picture) => of_sample.pictures.insert(sensor.channel.clone(), picture).is_none(),
                Err(why) => {
                    dropped(why);
                    continue;
                }
            }
        } else {
            let Some(ego_from_sensor) = poses::pose(calibration.translation, calibration.rotation) else {
                dropped("calibration without a valid pose");
                continue;
            };
            let (token, file) = (record.token.clone(), existing(root, &record.filename, report));
            of_sample.revolution.replace(Revolution { global_from_ego, ego_from_sensor, token, file }).is_none()
        };
        if !is_first {
            dropped("replaced by a later one of the same sensor and sample");
        }
    }
    taken
}

fn picture(
    root: &Path,
    channel: &str,
    record: &SampleDataRecord,
    calibration: &CalibratedSensorRecord,
    global_from_ego: GlobalFromEgo,
    report: &Report,
) -> Result<Picture, &'static str> {
    Ok(Picture {
        channel: channel.to_owned(),
        time_ns: record.timestamp.saturating_mul(1000),
        global_from_ego,
        lens: poses::lens(record.width, record.height, &calibration.camera_intrinsic)?,
        ego_from_camera: poses::pose(calibration.translation, calibration.rotation)
            .ok_or("calibration without a valid pose")?,
        token: record.token.clone(),
        file: existing(root, &record.filename, report),
    })
}

/// A file's path below the root; `None` where it is not at hand. Paths that leave the root are not followed.
pub(super) fn existing(root: &Path, file: &str, report: &Report) -> Option<String> {
    let path = Path::new(file);
    if !path.components().all(|c| matches!(c, Component::Normal(_))) {
        report.note(Outcome::Dropped, "file name outside the dataset's folder", file);
        return None;
    }
    (!file.is_empty() && root.join(path).is_file()).then(|| file.to_owned())
}

/// The cameras by name, each as it was when it was first used.
pub(super) fn rig<'a>(taken: impl Iterator<Item = &'a Taken>) -> Vec<RigCamera> {
    let mut cameras = BTreeMap::new();
    for picture in taken.flat_map(|t| t.pictures.values()) {
        cameras.entry(&picture.channel).or_insert_with(|| RigCamera {
            name: picture.channel.clone(),
            lens: picture.lens,
            ego_from_camera: picture.ego_from_camera,
        });
    }
    cameras.into_values().collect()
}

/// A sample's pictures in the rig's order.
pub(super) fn exposures(
    taken: &Taken,
    rig: &[RigCamera],
    world_pose: impl Fn(GlobalFromEgo) -> Pose<World, Ego>,
) -> Vec<Exposure> {
    let exposure = |(camera, c): (usize, &RigCamera)| {
        let picture = taken.pictures.get(&c.name)?;
        Some(Exposure {
            camera,
            time_ns: picture.time_ns,
            world_from_ego: world_pose(picture.global_from_ego),
            lens: picture.lens,
            ego_from_camera: picture.ego_from_camera,
            token: Some(picture.token.clone()),
            file: picture.file.clone(),
        })
    };
    rig.iter().enumerate().filter_map(exposure).collect()
}

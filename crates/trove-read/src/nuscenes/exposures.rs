//! What the sensors took for each keyframe and between them, with its own time and pose.

use std::collections::{BTreeMap, HashMap};

use trove_model::{Camera, Ego, Exposure, Lens, Outcome, Pose, Report, RigCamera, SensorFrame, World};

use super::files::Files;
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
    pub(super) time_ns: i64,
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

/// What was taken.
#[derive(Default)]
pub(super) struct Joined {
    /// By the sample's token.
    pub(super) of_samples: HashMap<String, Taken>,
    /// The LiDAR's between the keyframes, in the order of the table.
    pub(super) between: Vec<Revolution>,
}

/// Joins `sample_data` with poses and calibrations; what does not join is reported.
pub(super) fn join(
    files: &Files,
    tables: &Tables,
    data: Vec<SampleDataRecord>,
    ego_poses: &ByToken<EgoPoseRecord>,
    report: &Report,
) -> Joined {
    let mut joined = Joined::default();
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
        let is_first = if sensor.modality == "camera" {
            match picture(files, &sensor.channel, &record, calibration, global_from_ego, report) {
                Ok(picture) => {
                    let of_sample = joined.of_samples.entry(record.sample_token.clone()).or_default();
                    of_sample.pictures.insert(sensor.channel.clone(), picture).is_none()
                }
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
            let revolution = Revolution {
                time_ns: record.timestamp.saturating_mul(1000),
                global_from_ego,
                ego_from_sensor,
                token: record.token.clone(),
                file: files.existing(&record.filename, report),
            };
            if !record.is_key_frame {
                joined.between.push(revolution);
                continue;
            }
            let of_sample = joined.of_samples.entry(record.sample_token.clone()).or_default();
            of_sample.revolution.replace(revolution).is_none()
        };
        if !is_first {
            dropped("replaced by a later one of the same sensor and sample");
        }
    }
    joined
}

fn picture(
    files: &Files,
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
        lens: poses::lens(record.width.unwrap_or(0), record.height.unwrap_or(0), &calibration.camera_intrinsic)?,
        ego_from_camera: poses::pose(calibration.translation, calibration.rotation)
            .ok_or("calibration without a valid pose")?,
        token: record.token.clone(),
        file: files.existing(&record.filename, report),
    })
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

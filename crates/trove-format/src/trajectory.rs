//! `trajectory.json`: the way of the recording vehicle through a scene.

use std::path::Path;

use serde::{Deserialize, Serialize};
use trove_model::{Drive, Ego, Pose, World};

use crate::{FormatError, Projection, file, rows};

/// The whole of `trajectory.json`. World is x east, y north, z up, metres; Ego x forward, y left, z up, with its origin below the
/// middle of the rear axle on the ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TrajectoryFile {
    /// The drive (`scene-0103`).
    pub scene: String,
    /// The dataset (`nuscenes`).
    pub dataset: String,
    /// From latitude and longitude to World.
    pub projection: Projection,
    /// Every moment of the drive in the order of time, rendered or not; `keyframe` of a frame counts them.
    pub moments: Vec<EgoMoment>,
    /// The recorded path in the order of time, at its own times; empty if nothing but the moments is known.
    pub path: Vec<EgoPose>,
}

/// The vehicle at a moment of its drive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct EgoMoment {
    /// Index of the moment in its drive, from 0.
    pub keyframe: u32,
    /// Index of the recorded keyframe that this is; null at moments between keyframes (`time.rate_hz`).
    pub recorded_keyframe: Option<u32>,
    /// Time and pose.
    #[serde(flatten)]
    pub pose: EgoPose,
    /// Velocity of Ego's origin in World, metres a second; null if the drive has no other moment.
    pub velocity_mps: Option<[f64; 3]>,
    /// How fast the heading turns about World's z, counter-clockwise, radians a second; null if the drive has no other moment.
    pub yaw_rate_radps: Option<f64>,
}

/// Where the vehicle is at a time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct EgoPose {
    /// Nanoseconds since 1970 UTC.
    pub time_ns: i64,
    /// The rotation from Ego to World as a unit quaternion, w first.
    pub world_from_ego_rotation_wxyz: [f64; 4],
    /// Ego's origin in World, metres.
    pub world_from_ego_translation_m: [f64; 3],
}

impl TrajectoryFile {
    /// The file's name.
    pub const NAME: &str = "trajectory.json";

    /// Of a drive whose keyframes are the moments; `recorded` tells which recorded keyframe a moment is.
    pub fn new(drive: &Drive, recorded: impl Fn(usize) -> Option<usize>) -> Self {
        let moment = |k: usize| {
            let (keyframe, motion) = (&drive.keyframes[k], drive.ego_motion(k));
            EgoMoment {
                keyframe: k as u32,
                recorded_keyframe: recorded(k).map(|k| k as u32),
                pose: EgoPose::new(keyframe.time_ns, &keyframe.world_from_ego),
                velocity_mps: motion.map(|motion| motion.velocity_mps.to_array()),
                yaw_rate_radps: motion.map(|motion| motion.yaw_rate_radps),
            }
        };
        Self {
            scene: drive.id.clone(),
            dataset: drive.dataset.clone(),
            projection: (&drive.projection).into(),
            moments: (0..drive.keyframes.len()).map(moment).collect(),
            path: drive.path.moments().iter().map(|(time_ns, pose)| EgoPose::new(*time_ns, pose)).collect(),
        }
    }

    /// Reads it from the folder of a variation.
    ///
    /// # Errors
    /// A file that cannot be read or is damaged.
    pub fn read(folder: &Path) -> Result<Self, FormatError> {
        let path = folder.join(Self::NAME);
        file::parsed(&path, &file::bytes(&path)?, "the way of a vehicle that trove generate wrote")
    }

    /// The file's bytes: one line a field and one line a pose.
    pub fn to_json(&self) -> Vec<u8> {
        rows::bytes(self)
    }
}

impl EgoPose {
    fn new(time_ns: i64, world_from_ego: &Pose<World, Ego>) -> Self {
        let q = world_from_ego.rotation;
        Self {
            time_ns,
            world_from_ego_rotation_wxyz: [q.w, q.x, q.y, q.z],
            world_from_ego_translation_m: world_from_ego.translation.to_array(),
        }
    }
}

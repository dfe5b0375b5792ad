//! `radar.json`: a radar's cycle and one row an object in it.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{FormatError, Matrix4, Projection, SweptObject, file, rows};

/// The whole of `radar.json`. World and Body are as in `frame.json`; Sensor is x ahead, y to the radar's left, z up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct RadarTable {
    /// The drive (`scene-0103`).
    pub scene: String,
    /// The dataset (`nuscenes`).
    pub dataset: String,
    /// The dataset's name of the place (`boston-seaport`); empty if unknown.
    pub place: String,
    /// Number of the variation, from 0.
    pub variation: u32,
    /// Index of the moment in its drive, from 0.
    pub keyframe: u32,
    /// The dataset's token of the keyframe; empty if there is none.
    pub keyframe_token: String,
    /// Time of the keyframe, nanoseconds since 1970 UTC.
    pub keyframe_time_ns: i64,
    /// Index of the recorded keyframe that this is; null at moments between keyframes (`time.rate_hz`).
    pub recorded_keyframe: Option<u32>,
    /// The radar on its vehicle (`ego.RADAR_FRONT`).
    pub view: String,
    /// When it looked, nanoseconds since 1970 UTC.
    pub time_ns: i64,
    /// How long a cycle takes, seconds.
    pub cycle_s: f64,
    /// The preset or the name of the radar's file.
    pub radar: String,
    /// Slower than this over ground a detection counts as stationary, metres a second.
    pub stands_mps: f64,
    /// How many there are in `detections.npy`.
    pub detections: u32,
    /// From Sensor to World, at `time_ns`.
    pub world_from_radar: Matrix4,
    /// From Ego to World, of the vehicle that carries the radar, at `time_ns`.
    pub world_from_ego: Matrix4,
    /// How the sensor moved, World, metres a second.
    pub velocity_mps: [f64; 3],
    /// Id of that vehicle, through which the waves pass.
    pub carrier: Option<u32>,
    /// From latitude and longitude to World.
    pub projection: Projection,
    /// The seed of its noise.
    pub seed: u64,
    /// Every object that has a detection, ordered by id; `points` counts them.
    pub objects: Vec<SweptObject>,
}

impl RadarTable {
    /// The file's name.
    pub const NAME: &str = "radar.json";

    /// The name of the detections' file beside it.
    pub const DETECTIONS: &str = "detections.npy";

    /// Reads it from a cycle's folder.
    ///
    /// # Errors
    /// A file that cannot be read or is damaged.
    pub fn read(folder: &Path) -> Result<Self, FormatError> {
        let path = folder.join(Self::NAME);
        file::parsed(&path, &file::bytes(&path)?, "a radar's cycle of trove generate")
    }

    /// The file's bytes: one line a field and one line an object.
    pub fn to_json(&self) -> Vec<u8> {
        rows::bytes(self)
    }
}

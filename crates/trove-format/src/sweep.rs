//! `sweep.json`: a LiDAR's sweep and one row an object in it.

use std::path::Path;

use serde::{Deserialize, Serialize};
use trove_model::{Class, Kind};

use crate::{FormatError, Matrix4, ObjectOrigin, Projection, file, names, rows};

/// The whole of `sweep.json`. World and Body are as in `frame.json`; Sensor is the LiDAR's own axes, as the recording has them
/// or x forward, y left, z up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SweepTable {
    /// The drive (`scene-0103`).
    pub scene: String,
    /// The dataset (`nuscenes`).
    pub dataset: String,
    /// The dataset's name of the place (`boston-seaport`); empty if unknown.
    #[serde(default)]
    pub place: String,
    /// Number of the variation, from 0.
    #[serde(default)]
    pub variation: u32,
    /// Index of the moment in its drive, from 0: of the keyframe, unless there are moments between keyframes
    /// (`time.rate_hz`).
    pub keyframe: u32,
    /// The dataset's token of the keyframe; empty if there is none.
    #[serde(default)]
    pub keyframe_token: String,
    /// Time of the keyframe, nanoseconds since 1970 UTC.
    pub keyframe_time_ns: i64,
    /// Index of the recorded keyframe that this is; null at moments between keyframes (`time.rate_hz`), and in folders
    /// written by earlier versions, which have keyframes alone.
    #[serde(default)]
    pub recorded_keyframe: Option<u32>,
    /// The LiDAR on its vehicle (`ego.LIDAR_TOP`).
    pub view: String,
    /// The time that stands for the sweep, nanoseconds since 1970 UTC.
    pub time_ns: i64,
    /// When its first column left, seconds after that time.
    pub begins_s: f64,
    /// How long it lasted, seconds.
    pub sweep_s: f64,
    /// The preset or the name of the LiDAR's file.
    pub lidar: String,
    /// Elevation of each ring, degrees.
    pub elevations_deg: Vec<f64>,
    /// Columns of beams.
    pub columns: u32,
    /// Which returns of a beam are told: `strongest`, `last` or `dual`.
    pub returns: String,
    /// How many there are in `points.npy`.
    pub points: u32,
    /// From Sensor to World, at `time_ns`, to which the points belong.
    pub world_from_lidar: Matrix4,
    /// From Ego to World, of the vehicle that carries the LiDAR, at `time_ns`; null if none does.
    pub world_from_ego: Option<Matrix4>,
    /// Id of that vehicle if beams pass through it, since the LiDAR is in or close to its model; null otherwise.
    pub carrier: Option<u32>,
    /// From latitude and longitude to World.
    pub projection: Projection,
    /// The seed of its noise.
    pub seed: u64,
    /// Every object that has a point, ordered by id.
    pub objects: Vec<SweptObject>,
}

/// An object that a LiDAR met.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SweptObject {
    /// Its value in `points.npy`, the same as in the `instance.png` of the scene's frames.
    pub id: u32,
    /// Its class, by name.
    #[serde(with = "names::class")]
    #[cfg_attr(test, schemars(schema_with = "names::class::schema"))]
    pub class: Class,
    /// What it is, more closely.
    #[serde(with = "names::kind")]
    #[cfg_attr(test, schemars(schema_with = "names::kind::schema"))]
    pub kind: Kind,
    /// How it comes to be in the scene.
    pub origin: ObjectOrigin,
    /// The dataset's token of the track; empty for what nobody recorded.
    #[serde(default)]
    pub track_token: String,
    /// From Body to World at the keyframe's time; Body's origin is the centre of the object's box.
    pub world_from_body: Matrix4,
    /// Length, width and height of its box, metres.
    pub size_m: [f64; 3],
    /// How many points lie on it.
    pub points: u32,
}

impl SweepTable {
    /// The file's name.
    pub const NAME: &str = "sweep.json";

    /// The name of the points' file beside it.
    pub const POINTS: &str = "points.npy";

    /// Reads it from a sweep's folder.
    ///
    /// # Errors
    /// A file that cannot be read or is damaged.
    pub fn read(folder: &Path) -> Result<Self, FormatError> {
        let path = folder.join(Self::NAME);
        file::parsed(&path, &file::bytes(&path)?, "a sweep of trove generate")
    }

    /// The file's bytes: one line a field and one line an object.
    pub fn to_json(&self) -> Vec<u8> {
        rows::bytes(self)
    }
}

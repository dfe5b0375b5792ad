//! `grid.json`: cells around the vehicle, what their numbers mean, and one row an object in them.

use std::path::Path;

use serde::{Deserialize, Serialize};
use trove_model::{Class, Kind};

use crate::{FormatError, Matrix4, ObjectOrigin, Projection, file, names, rows};

/// The whole of `grid.json`. World, Ego and Body are as in `frame.json`; Grid is the frame whose axes the cells follow.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct GridTable {
    /// The drive (`scene-0103`).
    pub scene: String,
    /// The dataset (`nuscenes`).
    pub dataset: String,
    /// The dataset's name of the place (`boston-seaport`); empty if unknown.
    pub place: String,
    /// Number of the variation, from 0.
    pub variation: u32,
    /// Index of the moment in its drive, from 0: of the keyframe, unless there are moments between keyframes
    /// (`time.rate_hz`).
    pub keyframe: u32,
    /// The dataset's token of the keyframe; empty if there is none.
    pub keyframe_token: String,
    /// Index of the recorded keyframe that this is; null at moments between keyframes (`time.rate_hz`).
    pub recorded_keyframe: Option<u32>,
    /// The grid on its vehicle (`ego.OCC3D`).
    pub view: String,
    /// The moment, nanoseconds since 1970 UTC.
    pub time_ns: i64,
    /// The preset or the name of the grid's file.
    pub preset: String,
    /// `dense` (`labels.npz`) or `sparse` (`occupancy.npy` and `masks.npz`).
    pub form: String,
    /// Whether the inside of objects is filled as well as their surface.
    pub solid: bool,
    /// The lowest corner of cell [0, 0, 0] in Grid, metres.
    pub low_m: [f64; 3],
    /// Side of a cell, metres.
    pub voxel_m: f64,
    /// Cells along Grid's x, y and z.
    pub cells: [u32; 3],
    /// From Grid to World.
    pub world_from_grid: Matrix4,
    /// From Ego to World.
    pub world_from_ego: Matrix4,
    /// Id of the recording vehicle, which fills no cell; null if it is none of the objects.
    pub carrier: Option<u32>,
    /// The views through which `mask_camera` looks (`ego.CAM_FRONT`).
    pub cameras: Vec<String>,
    /// The LiDARs through which `mask_lidar` looks (`ego.LIDAR_TOP`).
    pub lidars: Vec<String>,
    /// The number of free cells.
    pub free: u8,
    /// What numbers of cells mean.
    pub classes: Vec<GridClass>,
    /// What the bits of `map` mean, the lowest first.
    #[serde(default)]
    pub map_layers: Vec<String>,
    /// From latitude and longitude to World.
    pub projection: Projection,
    /// Every object that fills a cell, ordered by id.
    pub objects: Vec<GridObject>,
}

/// A number of cells.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct GridClass {
    /// The number.
    pub id: u8,
    /// The class.
    pub name: String,
    /// Whether it is countable.
    pub thing: bool,
    /// Colour in images, 8-bit sRGB.
    pub rgb: [u8; 3],
}

/// An object that fills cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct GridObject {
    /// Its value in `instance`, the same as in the `instance.png` of the scene's frames.
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
    pub track_token: String,
    /// From Body to World; Body's origin is the centre of the object's box.
    pub world_from_body: Matrix4,
    /// Length, width and height of its box, metres.
    pub size_m: [f64; 3],
    /// In World, metres a second; null if unknown.
    pub velocity_mps: Option<[f64; 3]>,
    /// How many cells it fills.
    pub cells: u32,
}

impl GridTable {
    /// The file's name.
    pub const NAME: &str = "grid.json";

    /// Reads it from a grid's folder.
    ///
    /// # Errors
    /// A file that cannot be read or is damaged.
    pub fn read(folder: &Path) -> Result<Self, FormatError> {
        let path = folder.join(Self::NAME);
        file::parsed(&path, &file::bytes(&path)?, "a grid of trove generate")
    }

    /// The file's bytes: one line a field and one line an object.
    pub fn to_json(&self) -> Vec<u8> {
        rows::bytes(self)
    }
}

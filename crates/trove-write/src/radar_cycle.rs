//! A radar's cycle as it is written and read back.

use std::path::{Path, PathBuf};

use trove_format::RadarTable;
use trove_model::{RadarDetection, RadarShot, Scene};

use crate::frame_table::{FrameMeta, matrix};
use crate::{WriteError, detections_file, npy, sweep};

/// A cycle: its table and what was told.
#[derive(Clone, Debug, PartialEq)]
pub struct RadarCycle {
    /// Its folder below the output folder (`scene-0103/v00/k005/ego.RADAR_FRONT`), with `/` between the parts.
    pub path: String,
    /// Radar and objects.
    pub table: RadarTable,
    /// What was told.
    pub detections: Vec<RadarDetection>,
}

impl RadarCycle {
    /// The cycle that a radar made of a scene.
    pub fn of(
        path: String,
        scene: &Scene,
        shot: &RadarShot,
        detections: Vec<RadarDetection>,
        meta: &FrameMeta,
    ) -> Self {
        let table = RadarTable {
            scene: meta.scene.clone(),
            dataset: meta.dataset.clone(),
            place: meta.place.clone(),
            variation: meta.variation,
            keyframe: meta.keyframe,
            keyframe_token: meta.keyframe_token.clone(),
            keyframe_time_ns: meta.keyframe_time_ns,
            recorded_keyframe: meta.recorded_keyframe,
            view: shot.view.clone(),
            time_ns: shot.time_ns,
            cycle_s: shot.radar.cycle_s,
            radar: shot.radar.name.clone(),
            stands_mps: shot.radar.stands_mps,
            detections: detections.len() as u32,
            world_from_radar: matrix(shot.world_from_radar.affine()),
            world_from_ego: matrix(shot.world_from_ego.affine()),
            velocity_mps: shot.velocity_mps.to_array(),
            carrier: shot.carrier.map(|id| id.0),
            projection: (&meta.projection).into(),
            seed: shot.seed.0,
            objects: sweep::objects(scene, detections.iter().map(|told| told.instance)),
        };
        Self { path, table, detections }
    }

    /// Names of the files in a finished cycle's folder.
    pub const FILES: [&'static str; 2] = [RadarTable::DETECTIONS, RadarTable::NAME];

    /// The files' bytes, in the order of their names.
    pub(crate) fn encoded(&self) -> [Vec<u8>; 2] {
        [detections_file::encode(&self.detections), self.table.to_json()]
    }
}

/// The folder of a finished cycle; its detections are read when they are asked for.
#[derive(Clone, Debug)]
pub struct StoredRadarCycle {
    /// The folder.
    pub folder: PathBuf,
    /// Radar and objects.
    pub table: RadarTable,
}

impl StoredRadarCycle {
    /// Opens a cycle's folder.
    ///
    /// # Errors
    /// A table that cannot be read or is damaged.
    pub fn open(folder: &Path) -> Result<Self, WriteError> {
        Ok(Self { folder: folder.to_owned(), table: RadarTable::read(folder)? })
    }

    /// What was told, the nearest first.
    ///
    /// # Errors
    /// A file that cannot be read, or that holds other records than are written.
    pub fn detections(&self) -> Result<Vec<RadarDetection>, WriteError> {
        npy::read(self.folder.join(RadarTable::DETECTIONS), detections_file::decode)
    }
}

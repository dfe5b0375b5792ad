//! A LiDAR's sweep as it is written and read back.

use std::path::{Path, PathBuf};

use trove_format::{SweepTable, SweptObject};
use trove_model::{InstanceId, LidarPoint, LidarShot, PointCloud, Scene};

use crate::counted::{Counted, counted};
use crate::frame_table::{FrameMeta, matrix};
use crate::{WriteError, npy, points_file};

/// A sweep: its table and its points.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Its folder below the output folder (`scene-0103/v00/k005/ego.LIDAR_TOP`), with `/` between the parts.
    pub path: String,
    /// LiDAR and objects.
    pub table: SweepTable,
    /// What was told.
    pub cloud: PointCloud,
}

impl Sweep {
    /// The sweep that a LiDAR made of a scene.
    pub fn of(path: String, scene: &Scene, shot: &LidarShot, cloud: PointCloud, meta: &FrameMeta) -> Self {
        let scanner = &shot.scanner;
        let table = SweepTable {
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
            begins_s: shot.time_s(0),
            sweep_s: scanner.sweep_s,
            lidar: scanner.name.clone(),
            elevations_deg: scanner.elevations_rad.iter().map(|rad| (rad.to_degrees() * 1e6).round() / 1e6).collect(),
            columns: scanner.columns as u32,
            returns: scanner.told.name().into(),
            points: cloud.points.len() as u32,
            world_from_lidar: matrix(shot.world_from_lidar.affine()),
            world_from_ego: Some(matrix(shot.world_from_ego.affine())),
            carrier: shot.carrier.map(|id| id.0),
            projection: (&meta.projection).into(),
            seed: shot.seed.0,
            objects: objects(scene, cloud.points.iter().map(|point| point.instance)),
        };
        Self { path, table, cloud }
    }

    /// Names of the files in a finished sweep's folder.
    pub const FILES: [&'static str; 2] = [SweepTable::POINTS, SweepTable::NAME];

    /// The files' bytes, in the order of their names.
    pub(crate) fn encoded(&self) -> [Vec<u8>; 2] {
        [points_file::encode(&self.cloud.points), self.table.to_json()]
    }
}

/// Rows of the objects that have points, of which these are the objects; 0 for none.
pub(crate) fn objects(scene: &Scene, points: impl Iterator<Item = InstanceId>) -> Vec<SweptObject> {
    let row = |found: Counted| SweptObject {
        id: found.id.0,
        class: found.class,
        kind: found.object.kind,
        origin: (&found.object.origin).into(),
        track_token: found.object.origin.track_token().unwrap_or_default().into(),
        world_from_body: matrix(found.object.cuboid.world_from_body.affine()),
        size_m: found.object.cuboid.size_m.to_array(),
        points: found.count,
    };
    counted(scene, points).map(row).collect()
}

/// The folder of a finished sweep; its points are read when they are asked for.
#[derive(Clone, Debug)]
pub struct StoredSweep {
    /// The folder.
    pub folder: PathBuf,
    /// LiDAR and objects.
    pub table: SweepTable,
}

impl StoredSweep {
    /// Opens a sweep's folder.
    ///
    /// # Errors
    /// A table that cannot be read or is damaged.
    pub fn open(folder: &Path) -> Result<Self, WriteError> {
        Ok(Self { folder: folder.to_owned(), table: SweepTable::read(folder)? })
    }

    /// Its points, in the sensor's axes.
    ///
    /// # Errors
    /// A file that cannot be read, or that holds other records than are written.
    pub fn points(&self) -> Result<Vec<LidarPoint>, WriteError> {
        npy::read(self.folder.join(SweepTable::POINTS), points_file::decode)
    }
}

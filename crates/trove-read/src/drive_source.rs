//! Datasets of recorded drives behind one seam: which there are, and what a program asks of each.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::path::{Path, PathBuf};

use glam::DVec2;
use serde::Serialize;
use trove_model::{Drive, Report};

use crate::ReadError;

/// A dataset that can be read.
#[derive(Clone, Copy, Debug)]
pub struct Dataset {
    /// Its name in recipes and on the command line (`nuscenes`).
    pub name: &'static str,
    /// Whether a folder looks like its root.
    pub is_at: fn(&Path) -> bool,
    /// Takes the dataset's own options, those keys of a recipe's `[drive]` that are not every dataset's.
    ///
    /// # Errors
    /// An option that the dataset does not have, or one that is not of its type.
    pub configure: fn(toml::Table) -> Result<Opener, toml::de::Error>,
}

/// Opens a dataset that has its options: its root folder, where an index may be kept, and what takes notes.
pub type Opener = Box<dyn Fn(&Path, Option<&Path>, &Report) -> Result<Box<dyn DriveSource>, ReadError>>;

/// An opened dataset of recorded drives.
pub trait DriveSource: Send + Sync {
    /// The drives, sorted by name.
    fn drives(&self) -> Vec<DriveListing>;

    /// Reads a drive by its name.
    ///
    /// # Errors
    /// No drive of that name, or a file that is missing or damaged.
    fn read(&self, name: &str, report: &Report) -> Result<Drive, ReadError>;

    /// The files that all drives are read from, such as the dataset's tables.
    fn tables(&self) -> Vec<PathBuf>;

    /// The files that a drive is read from besides [`DriveSource::tables`], such as its LiDAR sweeps and map, in an order
    /// that does not change.
    ///
    /// # Errors
    /// As [`DriveSource::read`].
    fn recording(&self, name: &str) -> Result<Vec<PathBuf>, ReadError>;

    /// Hands out what the dataset's labels of a drive's pictures are, one by one, where they lie inside its files.
    ///
    /// # Errors
    /// As [`DriveSource::read`].
    fn labels(&self, name: &str, report: &Report, each: &mut dyn FnMut(LabelPicture)) -> Result<(), ReadError> {
        let _ = (name, report, each);
        Ok(())
    }

    /// What a drive holds.
    ///
    /// # Errors
    /// As [`DriveSource::read`].
    fn describe(&self, name: &str, report: &Report) -> Result<DriveDescription, ReadError> {
        Ok(DriveDescription::of(&self.read(name, report)?))
    }
}

/// A picture of a dataset's own labels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LabelPicture {
    /// Time of its keyframe, nanoseconds since 1970 UTC.
    pub time_ns: i64,
    /// The rig's name of the camera.
    pub camera: String,
    /// The name of the class map that its numbers are of.
    pub classes: &'static str,
    /// A pixel is the class's number times this, plus the object's.
    pub instance_divisor: NonZero<u16>,
    /// The picture as the dataset has it, a PNG of 16 bits.
    pub png: Vec<u8>,
}

/// A drive in a dataset's list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DriveListing {
    /// `scene-0103`.
    pub name: String,
    /// How many annotated moments it has.
    pub keyframes: usize,
}

/// What a drive holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DriveDescription {
    /// The dataset's name of it (`scene-0103`).
    pub scene: String,
    /// The dataset (`nuscenes`).
    pub dataset: String,
    /// The dataset's name of the place; empty where unknown.
    pub place: String,
    /// Latitude of the drive's anchor.
    pub lat_deg: f64,
    /// Longitude of the drive's anchor.
    pub lon_deg: f64,
    /// How many annotated moments it has.
    pub keyframes: usize,
    /// From the first keyframe to the last.
    pub duration_s: f64,
    /// Length of the driven path.
    pub path_m: f64,
    /// Names of the cameras.
    pub cameras: Vec<String>,
    /// How many objects are followed over time.
    pub tracks: usize,
    /// How many boxes there are in all keyframes, by the names of their classes.
    pub boxes: BTreeMap<&'static str, usize>,
    /// How many poses of the vehicle there are with those between the keyframes; 0 where no more is known than there.
    pub path_poses: usize,
    /// How many of these a second, from the first to the last; 0 without them.
    pub path_hz: f64,
    /// How many LiDAR sweeps between the keyframes are read.
    pub sweeps_between: usize,
    /// How many keyframes have a LiDAR sweep.
    pub lidar_keyframes: usize,
    /// Whether LiDAR returns have classes.
    pub lidar_labels: bool,
    /// Whether the dataset has a map of its own there.
    pub lane_map: bool,
    /// Licence of the recording.
    pub licence: String,
}

impl DriveDescription {
    fn of(drive: &Drive) -> Self {
        let (lat_deg, lon_deg) = drive.projection.geo_from_world(DVec2::ZERO);
        let keyframes = &drive.keyframes;
        let sweeps = || keyframes.iter().filter_map(|k| k.lidar.as_ref());
        let duration_ns =
            keyframes.first().zip(keyframes.last()).map_or(0, |(first, last)| last.time_ns - first.time_ns);
        let path = drive.path.moments();
        let path_ns = path.first().zip(path.last()).map_or(0, |(first, last)| last.0.saturating_sub(first.0));
        let position = |i: usize| keyframes[i].world_from_ego.translation;
        let mut boxes = BTreeMap::new();
        for object in keyframes.iter().flat_map(|k| &k.boxes) {
            *boxes.entry(object.kind.class().row().name).or_default() += 1;
        }
        Self {
            scene: drive.id.clone(),
            dataset: drive.dataset.clone(),
            place: drive.place.clone(),
            lat_deg,
            lon_deg,
            keyframes: keyframes.len(),
            duration_s: duration_ns as f64 * 1e-9,
            // A sum of nothing is −0.
            path_m: (1..keyframes.len()).map(|i| position(i - 1).distance(position(i))).fold(0.0, |a, b| a + b),
            cameras: drive.rig.iter().map(|camera| camera.name.clone()).collect(),
            tracks: drive.tracks.len(),
            boxes,
            path_poses: path.len(),
            path_hz: if path_ns > 0 { (path.len() - 1) as f64 / (path_ns as f64 * 1e-9) } else { 0.0 },
            sweeps_between: drive.sweeps.len(),
            lidar_keyframes: sweeps().count(),
            lidar_labels: sweeps().any(|sweep| !sweep.classes.is_empty()),
            lane_map: drive.lane_map.is_some(),
            licence: drive.licence.clone(),
        }
    }
}

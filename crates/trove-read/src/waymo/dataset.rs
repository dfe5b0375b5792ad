//! An opened dataset: which segments it has.

use std::path::{Path, PathBuf};

use trove_model::{Drive, Outcome, Report};

use super::{components, drive, panoptic, v1};
use crate::ReadError;
use crate::drive_source::{DriveListing, LabelPicture};

/// An opened folder of segments.
pub struct Waymo {
    root: PathBuf,
    form: Form,
    lidar_every: usize,
    segments: Vec<Listed>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    /// A TFRecord file a segment.
    V1,
    /// A folder a component, with a Parquet file a segment.
    V2,
}

/// A segment that can be read.
struct Listed {
    name: String,
    frames: usize,
    file: PathBuf,
}

impl Waymo {
    /// Opens a folder: v2 where it has a folder `vehicle_pose`, else v1 where it or a folder in it has TFRecord files. The
    /// LiDAR is read of every `lidar_every`-th frame (0 counts as 1).
    ///
    /// # Errors
    /// A folder without segments, or none that can be read.
    pub fn open(root: &Path, lidar_every: usize, report: &Report) -> Result<Self, ReadError> {
        let (form, files) = segment_files(root).ok_or_else(|| no_segments(root))?;
        let (mut segments, mut first_error) = (Vec::<Listed>::new(), None);
        for file in files {
            let listed = match form {
                Form::V1 => v1::list(&file),
                Form::V2 => {
                    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                    components::frames(&file).map(|frames| (name, frames))
                }
            };
            match listed {
                Ok((name, frames)) => segments.push(Listed { name, frames, file }),
                Err(error) => {
                    report.note(Outcome::Dropped, "Waymo segment that cannot be read", &error);
                    first_error.get_or_insert(error);
                }
            }
        }
        segments.sort_by(|a, b| (&a.name, &a.file).cmp(&(&b.name, &b.file)));
        segments.dedup_by(|second, first| {
            let is_same = second.name == first.name;
            if is_same {
                report.note(Outcome::Dropped, "Waymo segment: second of its name", second.file.display());
            }
            is_same
        });
        match first_error {
            Some(error) if segments.is_empty() => Err(error),
            _ => Ok(Self { root: root.to_owned(), form, lidar_every: lidar_every.max(1), segments }),
        }
    }

    /// Whether a folder has segments.
    pub(super) fn is_at(root: &Path) -> bool {
        segment_files(root).is_some()
    }

    /// The segments, sorted by name.
    pub fn segments(&self) -> Vec<DriveListing> {
        let listing = |listed: &Listed| DriveListing { name: listed.name.clone(), keyframes: listed.frames };
        self.segments.iter().map(listing).collect()
    }

    /// Reads a segment by its name.
    ///
    /// # Errors
    /// There is no such segment, or its files cannot be read or are not what the dataset's are.
    pub fn drive(&self, name: &str, report: &Report) -> Result<Drive, ReadError> {
        let listed = self.find(name)?;
        let segment = match self.form {
            Form::V1 => v1::read(&listed.file, self.lidar_every, report)?,
            Form::V2 => components::read(&self.root, name, self.lidar_every, report)?,
        };
        drive::drive(&listed.file, segment, report)
    }

    /// The files that a segment is read from.
    pub(super) fn recorded_files(&self, name: &str) -> Result<Vec<PathBuf>, ReadError> {
        let listed = self.find(name)?;
        Ok(match self.form {
            Form::V1 => vec![listed.file.clone()],
            Form::V2 => components::files(&self.root, name),
        })
    }

    /// Hands out the panoptic labels of a segment's pictures, where it has any.
    ///
    /// # Errors
    /// As [`Waymo::drive`].
    pub fn labels(&self, name: &str, report: &Report, each: &mut dyn FnMut(LabelPicture)) -> Result<(), ReadError> {
        let listed = self.find(name)?;
        if self.form == Form::V1 {
            return panoptic::of_records(&listed.file, report, each);
        }
        let file = components::path(&self.root, panoptic::COMPONENT, name);
        if file.is_file() { panoptic::of_component(&file, report, each) } else { Ok(()) }
    }

    fn find(&self, name: &str) -> Result<&Listed, ReadError> {
        self.segments.iter().find(|listed| listed.name == name).ok_or_else(|| {
            let mut names: Vec<_> = self.segments.iter().map(|listed| listed.name.as_str()).collect();
            names.sort_by_key(|other| (strsim::damerau_levenshtein(other, name), *other));
            names.truncate(3);
            ReadError::Missing {
                path: self.root.clone(),
                expected: format!("a segment named '{name}'"),
                found: format!("{} others", self.segments.len()),
                remedy: format!("the nearest names are {}", names.join(", ")),
            }
        })
    }
}

/// The form of a folder's segments and a file of each, sorted; `None` where there are none.
fn segment_files(root: &Path) -> Option<(Form, Vec<PathBuf>)> {
    let poses = files_in(&root.join(components::POSES), "parquet");
    if !poses.is_empty() {
        return Some((Form::V2, poses));
    }
    let mut files = files_in(root, "tfrecord");
    let folders = std::fs::read_dir(root).into_iter().flatten().flatten().map(|entry| entry.path());
    files.extend(folders.filter(|path| path.is_dir()).flat_map(|folder| files_in(&folder, "tfrecord")));
    files.sort();
    (!files.is_empty()).then_some((Form::V1, files))
}

fn files_in(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let paths = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<_> =
        paths.filter(|path| path.extension().is_some_and(|e| e == ending) && path.is_file()).collect();
    files.sort();
    files
}

fn no_segments(root: &Path) -> ReadError {
    ReadError::Missing {
        path: root.to_owned(),
        expected: "Waymo segments: *.tfrecord (v1), or a folder vehicle_pose of *.parquet (v2)".to_owned(),
        found: "none".to_owned(),
        remedy: "give the folder of the segments (v1) or of the components (v2), such as training".to_owned(),
    }
}

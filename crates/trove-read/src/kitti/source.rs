//! KITTI as a source of drives, with the options that are its own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use trove_files::PathComponent;
use trove_model::{Drive, Report};

use super::layout::{self, Form, Recording};
use super::{benchmark, drive, raw};
use crate::ReadError;
use crate::drive_source::{Dataset, DriveListing, DriveSource, Opener};

/// Licence of the dataset, with whom to name.
pub const LICENCE: &str = "CC BY-NC-SA 3.0, KITTI © Andreas Geiger, Philip Lenz, Christoph Stiller, Raquel Urtasun";

pub(crate) const DATASET: Dataset = Dataset { name: "kitti", is_at, configure };

fn is_at(root: &Path) -> bool {
    layout::has_step(root) || !layout::find(root, None).is_empty()
}

/// The keys of a recipe's `[drive]` that only KITTI has.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Options {
    /// The benchmark's folder, `training` or `testing`; without it the first of them that is there.
    split: Option<String>,
}

fn configure(options: toml::Table) -> Result<Opener, toml::de::Error> {
    let Options { split } = options.try_into()?;
    Ok(Box::new(move |root, _cache, _report| Ok(Box::new(Kitti::open(root, split.as_deref())?))))
}

/// An opened dataset: its root folder, and what is below.
pub struct Kitti {
    root: PathBuf,
    recordings: BTreeMap<String, Recording>,
}

impl Kitti {
    /// Opens the raw recordings, tracking sequences and object frames below a root: the benchmarks' of a split (`training`),
    /// without one the first that is there.
    ///
    /// # Errors
    /// A folder without any, or a split that is no folder's name.
    pub fn open(root: &Path, split: Option<&str>) -> Result<Self, ReadError> {
        let missing = |expected: &str, found: &str, remedy: &str| ReadError::Missing {
            path: root.to_owned(),
            expected: expected.into(),
            found: found.into(),
            remedy: remedy.into(),
        };
        if let Some(Err(error)) = split.map(PathComponent::new) {
            return Err(missing("a split such as training", &error.to_string(), "name the benchmark's folder"));
        }
        let recordings = layout::find(root, split);
        if !recordings.is_empty() {
            return Ok(Self { root: root.to_owned(), recordings });
        }
        Err(if layout::has_step(root) {
            let remedy = "unpack data_tracking_calib.zip, data_tracking_oxts.zip and data_tracking_label_2.zip here (its \
                          sequences are the same); the panoptic maps are for trove evaluate";
            missing("calibrations and poses beside KITTI-STEP's pictures", "only pictures and labels", remedy)
        } else {
            let remedy = "give the folder that contains 2011_09_26, training or testing as the root";
            missing("KITTI's raw drives, or a benchmark's training/calib", "neither", remedy)
        })
    }

    fn recording_of(&self, name: &str) -> Result<&Recording, ReadError> {
        self.recordings.get(name).ok_or_else(|| {
            let nearest = self.recordings.keys().min_by_key(|known| strsim::damerau_levenshtein(known, name));
            ReadError::Missing {
                path: self.root.clone(),
                expected: format!("a drive, sequence or frame named '{name}'"),
                found: format!("{} others", self.recordings.len()),
                remedy: format!("the nearest name is {}", nearest.map_or("none", String::as_str)),
            }
        })
    }

    fn keyframes(&self, recording: &Recording) -> usize {
        match recording.form {
            Form::Synced | Form::Extracted => raw::keyframes(&self.root, recording),
            Form::Tracking | Form::Object => benchmark::keyframes(&self.root, recording),
        }
    }
}

impl DriveSource for Kitti {
    fn drives(&self) -> Vec<DriveListing> {
        let listing = |(name, recording): (&String, &Recording)| DriveListing {
            name: name.clone(),
            keyframes: self.keyframes(recording),
        };
        self.recordings.iter().map(listing).collect()
    }

    fn read(&self, name: &str, report: &Report) -> Result<Drive, ReadError> {
        let recording = self.recording_of(name)?;
        let recorded = match recording.form {
            Form::Synced | Form::Extracted => raw::read(&self.root, recording, LICENCE, report),
            Form::Tracking | Form::Object => benchmark::read(&self.root, recording, LICENCE, report),
        };
        Ok(drive::join(&self.root, recorded?, report))
    }

    fn tables(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    fn recording(&self, name: &str) -> Result<Vec<PathBuf>, ReadError> {
        let recording = self.recording_of(name)?;
        let mut files = match recording.form {
            Form::Synced | Form::Extracted => raw::files(&self.root, recording),
            Form::Tracking | Form::Object => benchmark::files(&self.root, recording, self.keyframes(recording)),
        };
        files.retain(|path| path.is_file());
        Ok(files)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(root: &Path, split: Option<&str>) -> String {
        Kitti::open(root, split).err().map(|error| error.to_string()).unwrap_or_default()
    }

    #[test]
    fn a_folder_without_drives_says_what_to_give() {
        let root = tempfile::tempdir().unwrap();
        assert!(!is_at(root.path()) && refused(root.path(), None).contains("contains 2011_09_26, training or testing"));
        assert!(refused(root.path(), Some("../training")).contains("begins with a dot"));
        std::fs::create_dir_all(root.path().join("panoptic_maps/train")).unwrap();
        assert!(is_at(root.path()) && refused(root.path(), None).contains("data_tracking_calib.zip"));
    }

    #[test]
    fn an_option_of_another_dataset_is_refused() {
        let refused = |text: &str| configure(text.parse().unwrap()).err().map(|error| error.message().to_owned());
        assert_eq!(refused("split = 'testing'"), None);
        assert!(refused("version = 'v1.0-mini'").unwrap().contains("`split`"));
    }
}

//! The plain form as a source of drives.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use trove_files::{PathComponent, read_text};
use trove_format::PlainDrive;
use trove_model::{Drive, Outcome, Report};

use super::drive;
use super::exposures::Place;
use super::parts;
use crate::ReadError;
use crate::drive_source::{Dataset, DriveListing, DriveSource, Opener};

/// Larger files are refused: an hour at 10 Hz with a hundred boxes each has a third of it, bytes.
const LARGEST: u64 = 2 << 30;

pub(crate) const DATASET: Dataset = Dataset { name: "trove", is_at: |root| !files(root).is_empty(), configure };

/// The plain form has no keys of its own in a recipe's `[drive]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Options {}

fn configure(options: toml::Table) -> Result<Opener, toml::de::Error> {
    let Options {} = options.try_into()?;
    Ok(Box::new(|root, _, report| Ok(Box::new(PlainDrives::open(root, report)?))))
}

/// A folder with a drive, or with folders of drives.
struct PlainDrives {
    root: PathBuf,
    /// In the order of names.
    drives: Vec<Listed>,
}

struct Listed {
    name: String,
    keyframes: usize,
    path: PathBuf,
    /// The drive's folder below the root, with a `/` at the end; empty for the root itself.
    below: String,
}

impl PlainDrives {
    fn open(root: &Path, report: &Report) -> Result<Self, ReadError> {
        let mut drives = Vec::<Listed>::new();
        for (path, below) in files(root) {
            let text = read_text(&path, LARGEST).map_err(|source| ReadError::io(&path, source))?;
            let is_lines = path.extension().is_some_and(|e| e == "jsonl");
            let folder = path.parent().and_then(|folder| fs::canonicalize(folder).ok());
            let folder = folder.as_deref().and_then(Path::file_name).and_then(|name| name.to_str());
            let folder = folder.filter(|name| PathComponent::new(name).is_ok()).unwrap_or("drive");
            let name = parts::name(&text, is_lines).unwrap_or_else(|| folder.to_owned());
            if let Err(unsafe_name) = PathComponent::new(&name) {
                return Err(ReadError::Format {
                    path,
                    place: "name".into(),
                    expected: "a name that a folder can have".into(),
                    found: unsafe_name.to_string(),
                    remedy: "give the drive another name".into(),
                });
            }
            if drives.iter().any(|d| d.name.eq_ignore_ascii_case(&name)) {
                report.note(Outcome::Dropped, "drive with the name of another", path.display());
                continue;
            }
            drives.push(Listed { name, keyframes: parts::keyframes(&text, is_lines), path, below });
        }
        if drives.is_empty() {
            return Err(ReadError::Missing {
                path: root.to_owned(),
                expected: format!("{} or {}, or folders with one", PlainDrive::NAME, PlainDrive::LINES_NAME),
                found: "none".into(),
                remedy: "give the folder of a drive, or one with such folders, as the root".into(),
            });
        }
        drives.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(Self { root: root.to_owned(), drives })
    }

    fn listed(&self, name: &str) -> Result<&Listed, ReadError> {
        let nearest = || self.drives.iter().min_by_key(|d| strsim::damerau_levenshtein(&d.name, name));
        self.drives.iter().find(|d| d.name == name).ok_or_else(|| ReadError::Missing {
            path: self.root.clone(),
            expected: format!("a drive named '{name}'"),
            found: format!("{} others", self.drives.len()),
            remedy: nearest().map_or_else(String::new, |d| format!("the nearest name is {}", d.name)),
        })
    }
}

/// The files of drives in a root, with their folders below it: the root's own, else those of its folders, sorted.
fn files(root: &Path) -> Vec<(PathBuf, String)> {
    let file = |folder: &Path| {
        let names = [PlainDrive::NAME, PlainDrive::LINES_NAME];
        names.map(|name| folder.join(name)).into_iter().find(|path| path.is_file())
    };
    if let Some(path) = file(root) {
        return vec![(path, String::new())];
    }
    let folders = fs::read_dir(root).into_iter().flatten().flatten();
    let found = folders.filter_map(|entry| Some((file(&entry.path())?, format!("{}/", entry.file_name().to_str()?))));
    let mut found: Vec<_> = found.collect();
    found.sort();
    found
}

impl DriveSource for PlainDrives {
    fn drives(&self) -> Vec<DriveListing> {
        self.drives.iter().map(|d| DriveListing { name: d.name.clone(), keyframes: d.keyframes }).collect()
    }

    fn read(&self, name: &str, report: &Report) -> Result<Drive, ReadError> {
        let listed = self.listed(name)?;
        let text = read_text(&listed.path, LARGEST).map_err(|source| ReadError::io(&listed.path, source))?;
        drive::read(&text, &listed.path, name, &Place { root: &self.root, below: &listed.below }, report)
    }

    fn tables(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    fn recording(&self, name: &str) -> Result<Vec<PathBuf>, ReadError> {
        let listed = self.listed(name)?;
        let text = read_text(&listed.path, LARGEST).map_err(|source| ReadError::io(&listed.path, source))?;
        let place = Place { root: &self.root, below: &listed.below };
        let mut files = vec![listed.path.clone()];
        for file in parts::lidar_files(&text, &listed.path) {
            let Ok(file) = place.file("file", &file) else { continue }; // said when the drive is read
            files.push(self.root.join(file));
        }
        files.retain(|path| path.is_file());
        Ok(files)
    }
}

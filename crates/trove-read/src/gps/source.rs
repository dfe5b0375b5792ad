//! Traces as a source of drives.

use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use serde::Deserialize;
use trove_files::{LARGEST_TEXT, PathComponent, open_regular, read_text};
use trove_model::{Drive, Outcome, Report};

use super::drive::{self, Apart};
use super::fix::Fault;
use super::{csv, gpx};
use crate::ReadError;
use crate::drive_source::{Dataset, DriveListing, DriveSource, Opener};
use crate::rig;

/// A line of names is shorter, bytes.
const LONGEST_NAMES: u64 = 1 << 14;
/// From one keyframe to the next where nothing else is asked for, metres.
const SPACING_M: f64 = 10.0;
/// The preset of cameras that a trace is seen by; recipes name others in `views.rig`.
const RIG: &str = "dashcam";

pub(crate) const DATASET: Dataset = Dataset { name: "gps", is_at: |root| !files(root).is_empty(), configure };

/// The keys of a recipe's `[drive]` that only traces have.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Options {
    /// Metres from one keyframe to the next …
    spacing_m: Option<f64>,
    /// … or seconds.
    interval_s: Option<f64>,
    /// Licence of the trace.
    licence: Option<String>,
}

fn configure(options: toml::Table) -> Result<Opener, toml::de::Error> {
    use serde::de::Error;
    let Options { spacing_m, interval_s, licence } = options.try_into()?;
    let positive = |key: &str, value: f64| {
        let what = format!("{key}: expected more than 0, found {value}");
        if value > 0.0 && value < 1e6 { Ok(value) } else { Err(toml::de::Error::custom(what)) }
    };
    let apart = match (spacing_m, interval_s) {
        (Some(_), Some(_)) => return Err(toml::de::Error::custom("expected spacing_m or interval_s, found both")),
        (None, Some(seconds)) => Apart::Seconds(positive("interval_s", seconds)?),
        (metres, None) => Apart::Metres(positive("spacing_m", metres.unwrap_or(SPACING_M))?),
    };
    let licence = licence.unwrap_or_default();
    Ok(Box::new(move |root, _, report| {
        Ok(Box::new(Traces::open(root, Traces { files: vec![], apart, licence: licence.clone() }, report)?))
    }))
}

/// The traces of a folder, or one file.
struct Traces {
    /// Names and files, in the order of names.
    files: Vec<(String, PathBuf)>,
    apart: Apart,
    licence: String,
}

impl Traces {
    fn open(root: &Path, settings: Self, report: &Report) -> Result<Self, ReadError> {
        let mut named = Vec::<(String, PathBuf)>::new();
        for path in files(root) {
            let name = path.file_stem().and_then(|name| name.to_str()).unwrap_or_default().to_owned();
            let is_taken = named.iter().any(|(known, _)| known.eq_ignore_ascii_case(&name));
            if PathComponent::new(&name).is_err() || is_taken {
                report.note(Outcome::Dropped, "trace whose name is another's or no folder's", path.display());
                continue;
            }
            named.push((name, path));
        }
        if named.is_empty() {
            return Err(ReadError::Missing {
                path: root.to_owned(),
                expected: "a .gpx file, or a .csv file with columns time, lat and lon, or a folder with some".into(),
                found: "none".into(),
                remedy: "give the file or its folder as the root".into(),
            });
        }
        named.sort();
        Ok(Self { files: named, ..settings })
    }

    fn path(&self, name: &str) -> Result<&Path, ReadError> {
        let found = self.files.iter().find(|(known, _)| known == name);
        let names = || self.files.iter().map(|(name, _)| name.as_str()).take(5).collect::<Vec<_>>().join(", ");
        found.map(|(_, path)| path.as_path()).ok_or_else(|| ReadError::Missing {
            path: self.files.first().map(|(_, path)| path.clone()).unwrap_or_default(),
            expected: format!("a trace named '{name}'"),
            found: names(),
            remedy: "name one of these".into(),
        })
    }
}

/// The traces at a root, sorted.
fn files(root: &Path) -> Vec<PathBuf> {
    if root.is_file() {
        return if is_trace(root) { vec![root.to_owned()] } else { vec![] };
    }
    let entries = fs::read_dir(root).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut found: Vec<PathBuf> = entries.filter(|path| path.is_file() && is_trace(path)).collect();
    found.sort();
    found
}

fn is_gpx(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gpx"))
}

fn is_trace(path: &Path) -> bool {
    let is_csv = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv"));
    let begins_as_one = || -> io::Result<bool> {
        let mut names = Vec::new();
        open_regular(path)?.take(LONGEST_NAMES).read_to_end(&mut names)?;
        Ok(csv::is_trace(&String::from_utf8_lossy(&names)))
    };
    is_gpx(path) || (is_csv && begins_as_one().unwrap_or(false))
}

impl DriveSource for Traces {
    fn drives(&self) -> Vec<DriveListing> {
        // What is wrong with them is said when they are read.
        let keyframes = |name: &str| self.read(name, &Report::default()).map_or(0, |drive| drive.keyframes.len());
        self.files.iter().map(|(name, _)| DriveListing { name: name.clone(), keyframes: keyframes(name) }).collect()
    }

    fn read(&self, name: &str, report: &Report) -> Result<Drive, ReadError> {
        let path = self.path(name)?;
        let text = read_text(path, LARGEST_TEXT).map_err(|source| ReadError::io(path, source))?;
        let fixes = if is_gpx(path) { gpx::fixes(&text, report) } else { csv::fixes(&text, report) };
        let rig = rig::preset(RIG).expect("a preset, which a test reads");
        let drive = fixes.and_then(|fixes| drive::drive(name, &fixes, self.apart, &rig, &self.licence, report));
        drive.map_err(|Fault { place, expected, found }| ReadError::Format {
            path: path.to_owned(),
            place,
            expected,
            found,
            remedy: "see docs/plain-drive.md for what a trace looks like".into(),
        })
    }

    fn tables(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    fn recording(&self, name: &str) -> Result<Vec<PathBuf>, ReadError> {
        Ok(vec![self.path(name)?.to_owned()])
    }
}

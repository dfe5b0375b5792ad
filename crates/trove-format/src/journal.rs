//! What a run keeps in `.trove/` to go on from: its identity (`run.json`) and the journal of finished frames
//! (`frames.jsonl`).

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::ops::Range;
use std::path::Path;

use serde::{Deserialize, Serialize};
use trove_files::{OutputRoot, PathComponent, open_regular};

use crate::file::FORMAT;
use crate::{FormatError, file};

/// Everything that decides an output folder's bytes (`.trove/run.json`): a folder holds the frames of one identity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct RunIdentity {
    /// Version of the format of all the folder's files: 2.
    pub format: u32,
    /// The recipe, with its defaults filled in.
    pub recipe: serde_json::Value,
    /// Everything besides the recipe and the inputs that decides the bytes.
    pub versions: Versions,
    /// SHA-256 of each file that all scenes are made from, lower-case hexadecimal, by the recipe's key and the file's path
    /// there (`map.osm: boston.osm`).
    #[serde(default)]
    pub inputs: Inputs,
}

/// A longer line of a journal is no line of ours, bytes.
const LONGEST_LINE: u64 = 1 << 20;

/// SHA-256 of files by what they are.
pub type Inputs = BTreeMap<String, String>;

/// What a run was made with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Versions {
    /// The program's version.
    pub trove: String,
    /// SHA-256 of the sources that the program was built from, its first 16 digits; empty in folders written by earlier
    /// versions.
    #[serde(default)]
    pub build: String,
    /// A fingerprint of each asset library, in the recipe's order.
    pub assets: Vec<String>,
    /// Name and version of the ray-tracing kernel.
    pub kernel: String,
    /// Name and version of the denoiser; null without one.
    pub denoiser: Option<String>,
    /// The kind of processor whose instructions kernel and denoiser choose among (`x86-64-v3`), on which last digits depend;
    /// null where the bytes are the same on every machine.
    #[serde(default)]
    pub device: Option<String>,
    /// The graphics card that followed light, on which last digits depend; null where the processor did.
    #[serde(default)]
    pub card: Option<String>,
}

/// A file on disk.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct WrittenFile {
    /// Name relative to its folder.
    pub name: String,
    /// SHA-256 of its bytes, lower-case hexadecimal.
    pub sha256: String,
    /// Length, bytes.
    pub bytes: u64,
}

/// A line of the journal: a finished frame.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FrameLine {
    /// Its folder relative to the output folder, with `/` between the parts.
    pub frame: String,
    /// Its files.
    pub files: Vec<WrittenFile>,
}

/// A line of the journal: what a run or a part of one is going to make, as far as it is known; the last one counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PlanLine {
    /// Frames that it makes or finds finished.
    pub planned: u64,
    /// Frames of the whole recipe.
    pub of: u64,
    /// When it was started, seconds since 1970 UTC.
    pub started_unix_s: u64,
}

/// A line of the journal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum JournalLine {
    /// A finished frame.
    Frame(FrameLine),
    /// What is planned.
    Plan(PlanLine),
}

/// The files of finished frames, by the frame's path.
pub type Journal = BTreeMap<String, Vec<WrittenFile>>;

impl RunIdentity {
    /// The file's name.
    pub const NAME: &str = "run.json";

    /// The identity of a run by this version of the format.
    pub fn new(recipe: serde_json::Value, versions: Versions, inputs: Inputs) -> Self {
        Self { format: FORMAT, recipe, versions, inputs }
    }

    /// Reads it from a `.trove` folder; `None` where it is not there.
    ///
    /// # Errors
    /// A file that cannot be read, is damaged, or is of another version of the format.
    pub fn read(folder: &Path) -> Result<Option<Self>, FormatError> {
        let path = folder.join(Self::NAME);
        let bytes = file::bytes_if_there(&path)?;
        bytes.map(|bytes| file::of_this_format(&path, &bytes, "the identity of a run of trove generate")).transpose()
    }

    /// The file's bytes, a line a value.
    pub fn to_json(&self) -> Vec<u8> {
        file::pretty(self)
    }
}

impl JournalLine {
    /// The line's bytes, with the line break.
    #[allow(clippy::missing_panics_doc)] // serde_json refuses keys that are not strings, and nothing else
    pub fn to_json(&self) -> Vec<u8> {
        let mut line = serde_json::to_vec(self).expect("a line has keys that are strings");
        line.push(b'\n');
        line
    }
}

impl FrameLine {
    /// The journal's name.
    pub const JOURNAL: &str = "frames.jsonl";

    /// Reads the journal in a `.trove` folder, empty where there is none; of several lines of a frame the last one counts.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn journal(folder: &Path) -> Result<Journal, FormatError> {
        let mut journal = Journal::new();
        Self::each(&folder.join(Self::JOURNAL), |line, _| {
            if let JournalLine::Frame(line) = line {
                journal.insert(line.frame, line.files);
            }
        })?;
        Ok(journal)
    }

    /// Tells the lines of a journal one after another, none where it is not there, and where in the file they lie. A line
    /// that a killed run left torn is passed over: its frame is looked at on the disk instead.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn each(path: &Path, mut told: impl FnMut(JournalLine, Range<u64>)) -> Result<(), FormatError> {
        let unreadable = |source| FormatError::Unreadable { path: path.to_owned(), source };
        let mut lines = match open_regular(path) {
            Ok(file) => BufReader::new(file),
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            Err(error) => return Err(unreadable(error)),
        };
        let root = OutputRoot::new(path);
        let (mut line, mut start) = (Vec::new(), 0);
        loop {
            line.clear();
            let end =
                start + lines.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line).map_err(unreadable)? as u64;
            if end == start {
                return Ok(());
            }
            match serde_json::from_slice(&line) {
                // Whoever sends a folder does not choose which files are read elsewhere.
                Ok(JournalLine::Frame(line)) if !line.stays_below(&root) => {}
                Ok(line) => told(line, start..end),
                Err(_) => {}
            }
            start = end;
        }
    }

    fn stays_below(&self, root: &OutputRoot) -> bool {
        root.at(&self.frame).is_ok() && self.files.iter().all(|file| PathComponent::new(&file.name).is_ok())
    }
}

//! What a run keeps in `.trove/` to go on from: its identity (`run.json`) and the journal of finished frames
//! (`frames.jsonl`).

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use trove_files::{OutputRoot, PathComponent};

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

impl FrameLine {
    /// The journal's name.
    pub const JOURNAL: &str = "frames.jsonl";

    /// The line's bytes, with the line break.
    #[allow(clippy::missing_panics_doc)] // serde_json refuses keys that are not strings, and nothing else
    pub fn to_json(&self) -> Vec<u8> {
        let mut line = serde_json::to_vec(self).expect("a line has keys that are strings");
        line.push(b'\n');
        line
    }

    /// Reads the journal in a `.trove` folder, empty where there is none. A line that a killed run left torn is passed
    /// over: its frame is looked at on the disk instead.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn journal(folder: &Path) -> Result<Journal, FormatError> {
        let bytes = file::bytes_if_there(&folder.join(Self::JOURNAL))?.unwrap_or_default();
        let lines = bytes.split(|&b| b == b'\n').filter_map(|line| serde_json::from_slice::<Self>(line).ok());
        // Whoever sends a folder does not choose which files are read elsewhere.
        let root = OutputRoot::new(folder);
        let lines = lines.filter(|line| root.at(&line.frame).is_ok());
        let lines = lines.filter(|line| line.files.iter().all(|file| PathComponent::new(&file.name).is_ok()));
        Ok(lines.map(|line| (line.frame, line.files)).collect())
    }
}

//! `curated.json`: which frames `trove curate` kept.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{FormatError, file};

/// Frames by use, as paths relative to the dataset's folder (`scene-0103/v00/k005/ego.CAM_FRONT`).
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Curated {
    /// For training, most valuable first.
    pub train: Vec<String>,
    /// For validation, most valuable first.
    pub val: Vec<String>,
    /// Kept, but too close to places of both sides.
    #[serde(default)]
    pub gap: Vec<String>,
}

impl Curated {
    /// The file's name where no other is given.
    pub const NAME: &str = "curated.json";

    /// Reads a list.
    ///
    /// # Errors
    /// A file that cannot be read or is something else.
    pub fn read(path: &Path) -> Result<Self, FormatError> {
        file::parsed(path, &file::bytes(path)?, "a list of frames that trove curate wrote")
    }

    /// The file's bytes.
    pub fn to_json(&self) -> Vec<u8> {
        file::pretty(self)
    }
}

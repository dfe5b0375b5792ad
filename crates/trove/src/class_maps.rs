//! Class maps as the command line names them.

use std::path::PathBuf;

use anyhow::{Result, anyhow};
use trove_model::{ClassMap, Raster};
use trove_read::read_class_map;
use trove_write::StoredFrame;

use crate::recipe::nearest;

/// A class map by its name or its file.
#[derive(Clone, Debug)]
pub(crate) enum ClassMapChoice {
    /// One that comes with the program.
    BuiltIn(ClassMap),
    /// One of the user's own.
    File(PathBuf),
}

impl std::str::FromStr for ClassMapChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(map) = ClassMap::named(text) {
            return Ok(Self::BuiltIn(map));
        }
        let path = PathBuf::from(text);
        if path.extension().is_some_and(|ending| ending == "toml") {
            return Ok(Self::File(path));
        }
        let known = ClassMap::NAMES.join(", ");
        Err(format!("expected one of {known}, or a FILE.toml (docs/judge.md){}", nearest(text, &ClassMap::NAMES)))
    }
}

/// What each pixel of a frame shows, in the numbers of a class map, which is named or a file.
///
/// # Errors
/// A map that is not known or cannot be read, and a frame whose labels cannot.
pub fn mapped_labels(frame: &StoredFrame, classes: &str) -> Result<Raster<u8>> {
    let choice: ClassMapChoice = classes.parse().map_err(|error| anyhow!("classes: {error}"))?;
    Ok(frame.labels(&choice.read()?)?)
}

impl ClassMapChoice {
    /// The map itself.
    pub(crate) fn read(&self) -> Result<ClassMap> {
        Ok(match self {
            Self::BuiltIn(map) => map.clone(),
            Self::File(path) => read_class_map(path)?,
        })
    }
}

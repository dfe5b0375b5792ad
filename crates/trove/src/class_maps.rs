//! Class maps as the command line names them.

use std::path::PathBuf;

use anyhow::Result;
use trove_model::ClassMap;
use trove_read::read_class_map;

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

impl ClassMapChoice {
    /// The map itself.
    pub(crate) fn read(&self) -> Result<ClassMap> {
        Ok(match self {
            Self::BuiltIn(map) => map.clone(),
            Self::File(path) => read_class_map(path)?,
        })
    }
}

//! What is wrong with a file.

use std::io;
use std::path::Path;

use crate::ReadError;
use trove_files::Exceeded;

/// Why something in a file cannot be read.
#[derive(Debug)]
pub(super) enum Fault {
    Io(io::Error),
    Format { expected: String, found: String },
}

impl Fault {
    pub(super) fn new(expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self::Format { expected: expected.into(), found: found.into() }
    }

    /// The error in the file and at the place that it is in.
    pub(super) fn at(self, path: &Path, place: impl Into<String>) -> ReadError {
        match self {
            Self::Io(source) => ReadError::io(path, source),
            Self::Format { expected, found } => ReadError::Format {
                path: path.to_owned(),
                place: place.into(),
                expected,
                found,
                remedy: "the file is damaged or of another form: download it again".into(),
            },
        }
    }
}

impl From<Exceeded> for Fault {
    fn from(exceeded: Exceeded) -> Self {
        Self::new(exceeded.expected(), "more")
    }
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

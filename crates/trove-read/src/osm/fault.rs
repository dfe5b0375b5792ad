//! What is wrong with a file's bytes, before its path is known.

use std::io;

/// What is wrong with a file's bytes.
#[derive(Debug)]
pub(super) enum Fault {
    Io(io::Error),
    Content { byte: u64, expected: String, found: String, remedy: String },
}

impl Fault {
    pub(super) fn new(expected: impl Into<String>, found: impl Into<String>, remedy: &str) -> Self {
        Self::Content { byte: 0, expected: expected.into(), found: found.into(), remedy: remedy.into() }
    }

    /// The same with its place, where it has none yet.
    pub(super) fn at(self, place: u64) -> Self {
        match self {
            Self::Content { byte: 0, expected, found, remedy } => {
                Self::Content { byte: place, expected, found, remedy }
            }
            fault => fault,
        }
    }
}

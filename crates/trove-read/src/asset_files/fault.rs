//! What is wrong in a file, before its path is known.

use std::path::Path;

use crate::ReadError;

/// What a model's reader found wrong; whoever opened the file adds the path.
#[derive(Debug)]
pub(super) struct Fault {
    place: String,
    expected: String,
    found: String,
    remedy: String,
}

impl Fault {
    pub(super) fn new(
        place: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self { place: place.into(), expected: expected.into(), found: found.into(), remedy: remedy.into() }
    }

    /// The file ends or contradicts itself.
    pub(super) fn damaged(place: impl Into<String>, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self::new(place, expected, found, "export or download the model again")
    }

    pub(super) fn at(self, path: &Path) -> ReadError {
        let Self { place, expected, found, remedy } = self;
        ReadError::Format { path: path.to_owned(), place, expected, found, remedy }
    }
}

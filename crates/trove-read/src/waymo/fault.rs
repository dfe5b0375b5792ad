//! What is wrong with a file.

use std::path::Path;

use crate::ReadError;
use crate::protobuf::Malformed;
use trove_files::Exceeded;

/// A message that cannot be used.
#[derive(Debug)]
pub(super) enum Unusable {
    Malformed,
    TooMuch(Exceeded),
}

impl From<Malformed> for Unusable {
    fn from(_: Malformed) -> Self {
        Self::Malformed
    }
}

impl From<Exceeded> for Unusable {
    fn from(exceeded: Exceeded) -> Self {
        Self::TooMuch(exceeded)
    }
}

/// The error of a file that is damaged at a place.
pub(super) fn damaged(
    path: &Path,
    place: impl Into<String>,
    expected: impl Into<String>,
    found: impl Into<String>,
) -> ReadError {
    ReadError::Format {
        path: path.to_owned(),
        place: place.into(),
        expected: expected.into(),
        found: found.into(),
        remedy: "the file is damaged: download it again".into(),
    }
}

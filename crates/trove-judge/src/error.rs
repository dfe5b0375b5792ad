//! What can go wrong.

use std::path::{Path, PathBuf};

/// An error that names the file, what was expected there and what to do.
#[derive(Debug, thiserror::Error)]
pub enum JudgeError {
    /// A file or folder cannot be read or written.
    #[error("{}: expected an accessible file or folder, found \"{source}\"; check its name and permissions", path.display())]
    Io {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file is not what it should be.
    #[error("{}: expected {expected}, found {found}; {remedy}", path.display())]
    Unexpected {
        /// Which.
        path: PathBuf,
        /// What should be there.
        expected: String,
        /// What is there.
        found: String,
        /// What the user can do.
        remedy: String,
    },
    /// The caller asked for an end ([`OnProgress`](crate::OnProgress)).
    #[error("ended before all images were read")]
    Ended,
    /// A file of an output folder is damaged, or of another version.
    #[error(transparent)]
    Format(#[from] trove_format::FormatError),
}

impl JudgeError {
    pub(crate) fn io(path: &Path) -> impl FnOnce(std::io::Error) -> Self + '_ {
        |source| Self::Io { path: path.to_owned(), source }
    }

    pub(crate) fn unexpected(path: &Path, expected: impl Into<String>, found: impl Into<String>, remedy: &str) -> Self {
        Self::Unexpected {
            path: path.to_owned(),
            expected: expected.into(),
            found: found.into(),
            remedy: remedy.into(),
        }
    }
}

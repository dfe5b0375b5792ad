//! What can go wrong while reading.

use std::path::{Path, PathBuf};

use trove_files::UnsafeName;

/// Why a file of an output folder cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FormatError {
    /// The file system refuses.
    #[error("{}: expected a file that can be read, found \"{source}\"; check its path and permissions", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is cut off, was edited, or is something else.
    #[error(
        "{}:{line}:{column}: expected {expected}, found an error ({found}); delete it and rerun the command that wrote it",
        path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Line of the fault, from 1; 0 where the file is empty.
        line: usize,
        /// Column of the fault, from 1.
        column: usize,
        /// What the file should be.
        expected: &'static str,
        /// What is wrong, in serde_json's words.
        found: String,
    },
    /// The file names a folder that lies elsewhere.
    #[error("{}: {source}; delete it and rerun the command that wrote it", path.display())]
    Outside {
        /// The file.
        path: PathBuf,
        /// The name.
        source: UnsafeName,
    },
    /// The file is of another version of the format.
    #[error(
        "{}: expected format {expected}, found {}, which another version of trove writes; \
         generate the folder again, or use that version",
        path.display(),
        found.map_or("none".to_owned(), |found| format!("format {found}"))
    )]
    Version {
        /// The file.
        path: PathBuf,
        /// The version that this program reads and writes.
        expected: u32,
        /// The file's version; `None` where it names none.
        found: Option<u32>,
    },
}

impl FormatError {
    pub(crate) fn damaged(path: &Path, expected: &'static str, error: &serde_json::Error) -> Self {
        let (line, column) = (error.line(), error.column());
        let found = error.to_string();
        let place = format!(" at line {line} column {column}");
        let found = found.strip_suffix(&place).unwrap_or(&found).to_owned();
        Self::Damaged { path: path.to_owned(), line, column, expected, found }
    }
}

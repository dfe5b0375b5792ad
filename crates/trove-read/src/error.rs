//! What can go wrong while reading.

use std::path::{Path, PathBuf};

use crate::geo_extent::GeoExtent;

/// Why something could not be read, grouped by who must act.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The system refused; whoever runs the machine must act.
    #[error("{path}: expected a readable file, found: {source}; check the path and its permissions", path = .path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Something is not there; whoever gave the path or the name must act.
    #[error("{path}: expected {expected}, found {found}; {remedy}", path = .path.display())]
    Missing {
        /// The file or folder in which it was looked for.
        path: PathBuf,
        /// What was looked for.
        expected: String,
        /// What is there.
        found: String,
        /// What to do.
        remedy: String,
    },
    /// A street map is of another place; another extract of the same list may be the right one.
    #[error(
        "{path}: expected an extract that covers the place at {wanted}, found one of {extent}, {apart_km:.0} km away; \
         give the extract of the drive's own city",
        path = .path.display()
    )]
    Elsewhere {
        /// The extract.
        path: PathBuf,
        /// Where the wanted place is.
        wanted: GeoExtent,
        /// Where the extract's nodes are.
        extent: GeoExtent,
        /// Between the middles of both, kilometres.
        apart_km: f64,
    },
    /// The file's content is not what it should be; whoever supplied the file must act.
    #[error("{path}: {place}: expected {expected}, found {found}; {remedy}", path = .path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Where in it (`line 12`, `byte 4096`, `record 7`).
        place: String,
        /// What should stand there.
        expected: String,
        /// What stands there.
        found: String,
        /// What to do.
        remedy: String,
    },
    /// A file that people write has several faults; whoever wrote it must act.
    #[error("{path}: {}", told(.faults, *.more), path = .path.display())]
    Faults {
        /// The file.
        path: PathBuf,
        /// Each with its place.
        faults: Vec<String>,
        /// How many there are besides.
        more: usize,
    },
}

fn told(faults: &[String], more: usize) -> String {
    let count = faults.len() + more;
    let rest = if more > 0 { format!("\n  and {more} more") } else { String::new() };
    format!(
        "expected a drive in the plain form (docs/plain-drive.md), found {count} faults:\n  {}{rest}",
        faults.join("\n  ")
    )
}

impl ReadError {
    /// The system refused `path`.
    pub(crate) fn io(path: &Path, source: std::io::Error) -> Self {
        Self::Io { path: path.to_owned(), source }
    }
}

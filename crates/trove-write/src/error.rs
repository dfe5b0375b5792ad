//! What can go wrong while writing.

use std::io;
use std::path::{Path, PathBuf};

use trove_model::InstanceId;

/// Why something was not written; what had been written before it is untouched.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The file system refuses: the user makes room or chooses another folder.
    #[error("{}: expected to {action}, found \"{source}\"; {}", path.display(), remedy(source))]
    Storage {
        /// The file or folder.
        path: PathBuf,
        /// What was tried (`write the file`).
        action: &'static str,
        /// What the system says.
        source: io::Error,
    },
    /// The folder holds a finished frame, or something that is not ours.
    #[error("{}: expected no finished frame here, found {found}; move the folder away or choose another", path.display())]
    Occupied {
        /// The frame's folder.
        path: PathBuf,
        /// What lies in it.
        found: String,
    },
    /// A file of a finished frame cannot be read back: the user removes the frame's folder and lets it be made again.
    #[error("{}: expected a file that was written here, found {found}; remove its folder and run again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        found: String,
    },
    /// The labels do not fit the format: the user makes the scene smaller.
    #[error("expected at most 65535 objects in a scene (instance.png has 16 bits), found object {}; build a smaller area", .0.0)]
    TooManyObjects(InstanceId),
    /// The arguments contradict each other: the caller's mistake.
    #[error("expected a capture, a shot and a scene that belong together, found {0}")]
    Mismatch(String),
    /// A name cannot be a folder's: the reader of the dataset should have refused it.
    #[error(transparent)]
    Name(#[from] trove_files::UnsafeName),
    /// Something cannot be exported, or not to this place: the user does what the remedy says.
    #[error("{}: expected {expected}, found {found}; {remedy}", path.display())]
    Unfit {
        /// The folder or file.
        path: PathBuf,
        /// What was looked for.
        expected: String,
        /// What was there.
        found: String,
        /// What to do.
        remedy: String,
    },
    /// A JSON file of an output folder cannot be read back.
    #[error(transparent)]
    Format(#[from] trove_format::FormatError),
    /// A picture cannot be encoded.
    #[error("{name}: expected an image that can be encoded, found {found}")]
    Encoding {
        /// The file's name.
        name: String,
        /// What the encoder says.
        found: String,
    },
}

impl WriteError {
    /// Names the path and what was tried in an error of the system's.
    pub(crate) fn storage(path: &Path, action: &'static str) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Storage { path, action, source }
    }
}

fn remedy(source: &io::Error) -> &'static str {
    match source.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "free some space and run again, finished frames are kept"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "choose a writable folder, or change its permissions"
        }
        io::ErrorKind::WouldBlock => "another process writes to it; wait for it, or choose another folder",
        io::ErrorKind::NotFound => "check the path and run again",
        io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists | io::ErrorKind::IsADirectory => {
            "a file is where a folder is needed, or the other way round; move it away"
        }
        _ => "check the disk and run again, finished frames are kept",
    }
}

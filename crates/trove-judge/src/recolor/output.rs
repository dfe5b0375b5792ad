//! The folder that pictures are written to: of one source, one target and one method.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::path::{Path, PathBuf};

use serde::Serialize;
use trove_files::{LARGEST_TEXT, read_text};

use crate::JudgeError;

/// Holds what the pictures were made of, and the lock.
const PRIVATE: &str = ".trove";

/// Everything that decides the pictures.
#[derive(Serialize)]
pub(super) struct Identity {
    /// Pixels by class id, of the source and the target, for histograms.
    pub(super) classes: Option<[BTreeMap<u8, u64>; 2]>,
    /// How sharp the target is, where pictures become so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) detail: Option<String>,
    pub(super) method: String,
    /// Statistics of the whole source, where they count.
    pub(super) source: Option<String>,
    pub(super) space: String,
    pub(super) strength: f64,
    /// Statistics of the whole target.
    pub(super) target: String,
}

impl Identity {
    /// One line a value.
    pub(super) fn text(&self) -> String {
        serde_json::to_string_pretty(self).expect("keys are strings or numbers")
    }
}

/// An output folder that this process alone writes to.
pub(super) struct OutputFolder {
    root: PathBuf,
    _lock: File,
}

impl OutputFolder {
    /// Opens or makes it. `identity` is everything that decides the pictures: a folder that was begun with another one
    /// is refused, and so is one that holds something else, or that another process writes to.
    pub(super) fn open(root: &Path, identity: &str) -> Result<Self, JudgeError> {
        let refuse = |expected: &str, found: String| {
            Err(JudgeError::unexpected(root, expected, found, "choose another --out, or remove this folder"))
        };
        let private = root.join(PRIVATE);
        if root.exists() && !private.exists() && fs::read_dir(root).map_err(JudgeError::io(root))?.next().is_some() {
            return refuse("an empty folder or one of an earlier run", "other files".into());
        }
        fs::create_dir_all(&private).map_err(JudgeError::io(&private))?;
        let path = private.join("lock");
        let lock = OpenOptions::new().create(true).append(true).open(&path).map_err(JudgeError::io(&path))?;
        if let Err(TryLockError::WouldBlock) = lock.try_lock() {
            return refuse("a folder that no other run is writing to", "one that is".into());
        }
        let path = private.join("recolor.json");
        match read_text(&path, LARGEST_TEXT) {
            Ok(found) if found == identity => {}
            Ok(found) => {
                let differs = found.lines().zip(identity.lines()).find(|(was, is)| was != is);
                let (was, is) = differs.map_or(("", ""), |(was, is)| (was.trim(), is.trim()));
                return refuse(
                    "the settings and images that this folder was started with",
                    format!("others (it was {was} it is {is})"),
                );
            }
            Err(_) => write(&path, identity.as_bytes())?,
        }
        Ok(Self { root: root.to_owned(), _lock: lock })
    }

    /// Where a picture goes.
    pub(super) fn path(&self, below: &Path) -> PathBuf {
        self.root.join(below).with_extension("png")
    }

    /// Whether a picture is there and its source has not changed since.
    pub(super) fn finished(&self, below: &Path, source: &Path) -> bool {
        let time = |path: &Path| fs::metadata(path).and_then(|found| found.modified()).ok();
        matches!((time(&self.path(below)), time(source)), (Some(written), Some(source)) if written >= source)
    }

    /// Writes a picture's file: it is there whole or as it was.
    pub(super) fn write(&self, below: &Path, bytes: &[u8]) -> Result<(), JudgeError> {
        write(&self.path(below), bytes)
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), JudgeError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder).map_err(JudgeError::io(folder))?;
    trove_files::write_atomically(path, bytes).map_err(JudgeError::io(path))
}

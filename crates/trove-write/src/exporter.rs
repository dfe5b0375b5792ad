//! The forms in which frames are written, and the seam that each of them stands behind.

use std::collections::BTreeSet;
use std::path::Path;

use trove_format::{FrameFile, Manifest, RunReport, WrittenFile};

use crate::frame_folders::{FrameFolders, frame_files};
use crate::{Frame, WriteError};

/// Writes the frames of a run, one after another, in one form.
pub trait Exporter: Send {
    /// Writes a frame whole or not at all and says which files it has now. `pictures` are those that are wanted; a frame
    /// without light has none that show it, and one that was compared with none shows no change.
    ///
    /// # Errors
    /// A file system that refuses, or a frame that is there already or does not fit the form.
    fn frame(&mut self, frame: &Frame, pictures: &BTreeSet<FrameFile>) -> Result<Vec<WrittenFile>, WriteError>;

    /// Writes what sums all frames up, those of earlier runs too.
    ///
    /// # Errors
    /// A file system that refuses, or a finished frame that cannot be read back.
    fn finish(&mut self, manifest: &Manifest, report: &RunReport) -> Result<(), WriteError>;
}

/// A form in which frames are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExportFormat {
    /// A folder a frame, with `manifest.json` above them all (docs/output.md).
    #[default]
    Trove,
}

impl ExportFormat {
    /// An exporter that writes below `root`.
    pub fn exporter(self, root: &Path) -> Box<dyn Exporter> {
        match self {
            Self::Trove => Box::new(FrameFolders::new(root)),
        }
    }

    /// Names of the files that a finished frame with these pictures has in its folder.
    pub fn files(self, pictures: &BTreeSet<FrameFile>) -> Vec<&'static str> {
        match self {
            Self::Trove => frame_files(pictures),
        }
    }
}

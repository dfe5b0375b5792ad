//! The forms in which frames are written.

use std::collections::BTreeSet;
use std::path::Path;

use trove_format::FrameFile;

use crate::Exporter;
use crate::frame_folders::{FrameFolders, SUMMARIES, frame_files};

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

    /// Names below the output folder that no scene can have, because files with them sum the run up.
    pub fn reserved_names(self) -> &'static [&'static str] {
        match self {
            Self::Trove => &SUMMARIES,
        }
    }

    /// Names of the files that a finished frame with these pictures has in its folder.
    pub fn files(self, pictures: &BTreeSet<FrameFile>) -> Vec<&'static str> {
        match self {
            Self::Trove => frame_files(pictures),
        }
    }
}

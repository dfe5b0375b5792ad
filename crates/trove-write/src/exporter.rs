//! The seam that every form in which frames are written stands behind.

use std::collections::BTreeSet;

use trove_format::{FrameFile, Manifest, RunReport, WrittenFile};

use crate::{Frame, WriteError};

/// Writes the frames of a run in one form; several threads may write frames at once, in any order.
pub trait Exporter: Send + Sync {
    /// Writes a frame whole or not at all and says which files it has now. `pictures` are those that are wanted; a frame
    /// without light has none that show it, and one that was compared with none shows no change.
    ///
    /// # Errors
    /// A file system that refuses, or a frame that is there already or does not fit the form.
    fn frame(&self, frame: &Frame, pictures: &BTreeSet<FrameFile>) -> Result<Vec<WrittenFile>, WriteError>;

    /// Writes what sums all frames up, those of earlier runs too.
    ///
    /// # Errors
    /// A file system that refuses, or a finished frame that cannot be read back.
    fn finish(&self, manifest: &Manifest, report: &RunReport) -> Result<(), WriteError>;
}

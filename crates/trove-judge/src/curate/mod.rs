//! Which frames are worth training on, from labels alone.

mod frame;
mod hash;
mod report;
mod selection;
mod split;

use std::path::Path;

use trove_format::Manifest;
use trove_model::Seed;

use crate::JudgeError;
use crate::pictures::{OnProgress, each};
pub use frame::{CandidateFrame, SeenObject};
pub use hash::difference_hash;
pub use report::report;
pub use selection::{Rules, Selection, select};
pub use split::{Split, split};

/// What came out.
#[derive(Clone, Debug)]
pub struct Curation {
    /// Every frame of the dataset.
    pub frames: Vec<CandidateFrame>,
    /// What was kept and dropped.
    pub selection: Selection,
    /// What each of the kept frames serves for, in the order of [`Selection::kept`].
    pub splits: Vec<Split>,
    /// By what they were chosen.
    pub rules: Rules,
}

/// Looks at the finished frames below a folder of `trove generate`, with or without pictures, and chooses among them.
///
/// # Errors
/// A folder without frames or of another version of the format, or a frame that cannot be read.
pub fn curate(
    root: &Path,
    rules: Rules,
    val_share: f64,
    seed: Seed,
    progress: OnProgress,
) -> Result<Curation, JudgeError> {
    Manifest::read(root)?; // says so where the folder is of another version
    let folders = frame::folders(root)?;
    if folders.is_empty() {
        return Err(JudgeError::unexpected(root, "frames of trove generate", "none", "give the folder that it wrote"));
    }
    let frames = each(&folders, progress, |folder| CandidateFrame::read(root, folder))?;
    let selection = select(&frames, &rules);
    let kept: Vec<&CandidateFrame> = selection.kept.iter().map(|i| &frames[*i]).collect();
    let splits = split(&kept, val_share, seed.child("split"));
    Ok(Curation { frames, selection, splits, rules })
}

impl Curation {
    /// Share of all pixels by class, of all frames or of those kept.
    pub fn shares(&self, kept: bool) -> [f64; 20] {
        let mut sums = [0.0; 20];
        let all = 0..self.frames.len();
        let indices: Vec<usize> = if kept { self.selection.kept.clone() } else { all.collect() };
        for i in &indices {
            sums.iter_mut().zip(self.frames[*i].shares()).for_each(|(sum, share)| *sum += share);
        }
        sums.map(|sum| sum / indices.len().max(1) as f64)
    }
}

#[cfg(test)]
mod tests;

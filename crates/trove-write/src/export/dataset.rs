//! The seam behind which every form of a dataset stands.

use std::collections::BTreeMap;

use serde_json::value::RawValue;
use serde_json::{Value, json};
use trove_format::Manifest;

use super::folder::ExportFolder;
use super::plan::Plan;
use super::unit::Unit;
use crate::WriteError;

/// A form in which finished frames are written for other tools.
pub(crate) trait Dataset: Sync {
    /// Frames that are written together, by their places in the plan: a shard's, a sequence's. By default each is alone.
    fn units(&self, plan: &Plan) -> Vec<Vec<usize>> {
        (0..plan.frames.len()).map(|frame| vec![frame]).collect()
    }

    /// Writes the frames of a step; several threads do so at once.
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError>;

    /// Writes what sums all frames up, where the form has that.
    fn finish(&self, _: &Finished<'_>, _: &mut Unit<'_>) -> Result<(), WriteError> {
        Ok(())
    }
}

/// All steps of an export, finished.
pub(crate) struct Finished<'a> {
    /// The frames.
    pub plan: &'a Plan,
    /// What they were made from; without their rows, which the plan has.
    pub manifest: &'a Manifest,
    /// Frames of each step, in the plan's order.
    pub units: &'a [Vec<usize>],
    /// Name of each step in the journal.
    pub names: &'a [String],
    /// Where the steps were written down.
    pub folder: &'a ExportFolder,
}

/// Rows of one step, by table.
pub(crate) type Rows = BTreeMap<String, Vec<Box<RawValue>>>;

impl Finished<'_> {
    /// Every source of what the frames show, as COCO lists licences.
    pub(crate) fn licenses(&self) -> Value {
        let sources = self.manifest.licences.iter().enumerate();
        json!(sources.map(|(id, s)| json!({ "id": id, "name": s.licence, "url": s.source })).collect::<Vec<_>>())
    }

    /// The rows of each step of a split, or of all where none is given, one step in memory at once.
    pub(crate) fn rows<'s>(
        &'s self,
        split: Option<&'s str>,
    ) -> impl Iterator<Item = Result<(&'s [usize], Rows), WriteError>> + 's {
        let of_split = move |frames: &[usize]| split.is_none_or(|split| self.plan.frames[frames[0]].split == split);
        let steps = self.units.iter().zip(self.names).filter(move |(frames, _)| of_split(frames));
        steps.map(|(frames, name)| Ok((frames.as_slice(), self.folder.written(name)?.rows)))
    }
}

//! Forms of datasets, and how a folder tells its own.

use std::fs;
use std::path::Path;

use trove_format::Manifest;

use super::finding::Audit;
use super::moments::{FrameReader, frames};
use super::{camvid, cityscapes, coco, kitti, nuscenes};
use crate::pictures::{files, name};
use crate::{JudgeError, OnProgress};

/// A form in which labels are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabelForm {
    /// Output folders of `trove generate`.
    Trove,
    /// `gtFine/<split>/<city>/…`.
    Cityscapes,
    /// `training/label_02` (tracking) or `training/label_2` (object), with calibration and images.
    Kitti,
    /// `annotations/*.json`.
    Coco,
    /// `v1.0-*/*.json`.
    NuScenes,
    /// Images with labels in 32 colours.
    CamVid,
}

impl LabelForm {
    /// Its name (`cityscapes`).
    pub fn name(self) -> &'static str {
        match self {
            Self::Trove => "trove",
            Self::Cityscapes => "cityscapes",
            Self::Kitti => "kitti",
            Self::Coco => "coco",
            Self::NuScenes => "nuscenes",
            Self::CamVid => "camvid",
        }
    }
}

/// Looks at a dataset's labels, in a form that is given or found out.
///
/// # Errors
/// A folder whose form is not known or that has no labels of that form, files that cannot be listed, and an end that was
/// asked for.
pub fn audit(
    root: &Path,
    form: Option<LabelForm>,
    reader: &dyn FrameReader,
    progress: OnProgress,
) -> Result<(LabelForm, Audit), JudgeError> {
    let form = match form {
        Some(form) => form,
        None => found_out(root)?,
    };
    let audit = match form {
        LabelForm::Trove => frames(root, reader, progress)?,
        LabelForm::Cityscapes => cityscapes::audit(root, progress)?,
        LabelForm::Kitti => kitti::audit(root, progress)?,
        LabelForm::Coco => coco::audit(root, progress)?,
        LabelForm::NuScenes => nuscenes::audit(root, progress)?,
        LabelForm::CamVid => camvid::audit(root, progress)?,
    };
    Ok((form, audit))
}

/// The form that a folder's own files tell.
fn found_out(root: &Path) -> Result<LabelForm, JudgeError> {
    let versions = || fs::read_dir(root).into_iter().flatten().flatten();
    let has = |names: &[&str]| names.iter().any(|name| root.join(name).exists());
    let labels = || files(root, &["png"]).map(|all| all.iter().any(|path| name(path).ends_with("_labelIds.png")));
    if has(&[Manifest::NAME]) {
        Ok(LabelForm::Trove)
    } else if versions().any(|entry| entry.path().join("sample_annotation.json").is_file()) {
        Ok(LabelForm::NuScenes)
    } else if has(&["training/label_2", "training/label_02", "label_2", "label_02", "semantic", "training/semantic"]) {
        Ok(LabelForm::Kitti)
    } else if has(&["annotations"]) {
        Ok(LabelForm::Coco)
    } else if has(&["gtFine", "gtCoarse"]) || labels()? {
        Ok(LabelForm::Cityscapes)
    } else if has(&["labels", "LabeledApproved_full"]) {
        Ok(LabelForm::CamVid)
    } else if has(&[".trove"]) {
        // A run without a manifest is not finished; what is exported has such a folder too.
        Ok(LabelForm::Trove)
    } else {
        let remedy = "name the form with --form, or give the folder that has it";
        let expected = "frames of trove generate or a root of Cityscapes, KITTI, COCO, nuScenes or CamVid";
        Err(JudgeError::unexpected(root, expected, "none of them", remedy))
    }
}

//! Finished frames → the datasets that other tools read.
//!
//! Every form is one file here. A form says which frames are written together (a step), writes each step's files and
//! rows, and at the end sums the rows up; what is finished is kept in a journal, so that an export goes on where it ended,
//! in constant memory.

mod bop;
mod cityscapes;
mod cloud;
mod coco;
mod contours;
mod dataset;
mod folder;
mod format;
mod geometry;
mod hdf5;
mod json_file;
mod kinds;
mod kitti;
mod kitti_dense;
mod kitti_step;
mod label_pictures;
mod labels;
mod las;
mod mcap;
mod mcap_file;
mod nuimages;
mod nuscenes;
mod nuscenes_lidar;
mod nuscenes_radar;
mod nuscenes_rows;
mod openlabel;
mod openlane;
mod pcd;
mod plan;
mod point_clouds;
mod protobuf;
mod stereo;
mod tables;
mod unit;
mod video;
mod virtual_kitti;
mod web_dataset;
mod yolo;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use serde::Serialize;
use sha2::{Digest, Sha256};
use trove_format::{Curated, Source};
use trove_model::ClassMap;

use crate::{WriteError, files};
use dataset::Finished;
use folder::{ExportFolder, Identity};
pub use format::DatasetFormat;
use plan::Plan;
use unit::Unit;

/// The file that says what an exported dataset is: its form, sources, licences, and what had to be clipped.
const SUMMARY: &str = "trove.json";

/// How an export is watched: told how many steps of how many are done, it says whether to go on.
pub type Watch<'a> = &'a (dyn Fn(usize, usize) -> bool + Sync);

/// What a user may choose.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// The frames and their splits; without it all frames are for training.
    pub curated: Option<Curated>,
    /// The class map of labels; without it the form's own.
    pub classes: Option<ClassMap>,
}

/// What an export has written.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Exported {
    /// The form.
    pub format: String,
    /// Name of the class map that labels are numbered by; `None` for a form without such labels.
    pub classes: Option<String>,
    /// Version of the program.
    pub trove: String,
    /// Frames by split.
    pub frames: BTreeMap<String, usize>,
    /// Values that the form cannot hold, counted by what happened to them.
    pub clipped: BTreeMap<String, u64>,
    /// Every source of what the frames show, with its licence.
    pub licences: Vec<Source>,
    /// Whether it was asked to end before all was done.
    #[serde(skip)]
    pub interrupted: bool,
    /// Steps that this call has written; the others were finished already.
    #[serde(skip)]
    pub written: usize,
}

/// Writes a finished folder's frames as a dataset of another form; goes on where an earlier call ended.
///
/// # Errors
/// A source that is not finished or damaged, an output folder that holds something else, a frame that lacks a file that
/// the form needs, or a file system that refuses. What is finished stays.
pub fn export(
    source: &Path,
    out: &Path,
    format: DatasetFormat,
    choice: &Choice,
    watch: Watch,
) -> Result<Exported, WriteError> {
    let (plan, manifest) = Plan::new(source, choice.curated.as_ref())?;
    let map = choice.classes.clone().or_else(|| format.class_map());
    let classes = map.as_ref().map(|map| map.name.clone());
    let identity = Identity {
        format: format.name().to_owned(),
        trove: env!("CARGO_PKG_VERSION").to_owned(),
        classes: files::sha256(format!("{map:?}").as_bytes()),
    };
    let dataset = format.dataset(map).ok_or_else(|| WriteError::Unfit {
        path: out.to_owned(),
        expected: format!("no class map for {}, whose files have no such numbers", format.name()),
        found: classes.clone().unwrap_or_default(),
        remedy: "leave out --classes".into(),
    })?;
    let folder = ExportFolder::open(out, &identity)?;
    let units = dataset.units(&plan);
    let names: Vec<String> = units.iter().map(|frames| name(&plan, frames)).collect();
    let missing: Vec<usize> = (0..units.len()).filter(|i| !folder.is_finished(&names[*i])).collect();
    let (done, stopped) = (AtomicUsize::new(units.len() - missing.len()), AtomicUsize::new(0));
    missing.par_iter().try_for_each(|i| -> Result<(), WriteError> {
        if stopped.load(Ordering::Relaxed) > 0 {
            return Ok(());
        }
        let mut unit = Unit::new(folder.root());
        dataset.write(&plan, &units[*i], &mut unit)?;
        folder.record(&names[*i], unit.finish())?;
        if !watch(done.fetch_add(1, Ordering::Relaxed) + 1, units.len()) {
            stopped.store(1, Ordering::Relaxed);
        }
        Ok(())
    })?;
    let mut exported = Exported {
        format: identity.format,
        classes,
        trove: identity.trove,
        licences: manifest.licences.clone(),
        written: missing.len(),
        ..Exported::default()
    };
    if done.load(Ordering::Relaxed) < units.len() {
        return Ok(Exported { interrupted: true, ..exported });
    }
    for frame in &plan.frames {
        *exported.frames.entry(frame.split.clone()).or_default() += 1;
    }
    for name in &names {
        for (what, values) in folder.written(name)?.clipped {
            *exported.clipped.entry(what).or_default() += values;
        }
    }
    let finished = Finished { plan: &plan, manifest: &manifest, units: &units, names: &names, folder: &folder };
    let mut unit = Unit::new(folder.root());
    dataset.finish(&finished, &mut unit)?;
    let summary = serde_json::to_vec_pretty(&exported).map_err(|e| WriteError::Mismatch(e.to_string()))?;
    unit.write(SUMMARY, &summary)?;
    let summaries: BTreeSet<String> = unit.finish().files.into_keys().collect();
    folder.remove_stale(names.iter().map(String::as_str), &summaries)?;
    Ok(exported)
}

/// A step's name in the journal: it changes with the frames' bytes and with the numbers that stand in its files' names.
fn name(plan: &Plan, frames: &[usize]) -> String {
    let mut hasher = Sha256::new();
    for (number, frame) in frames.iter().map(|i| (i, &plan.frames[*i])) {
        hasher.update(frame.path.as_bytes());
        hasher.update(frame.split.as_bytes());
        hasher.update([*number as u32, frame.sequence, frame.index].map(u32::to_le_bytes).as_flattened());
        hasher.update(frame.content);
        plan.sweeps(frame).iter().chain(plan.radars(frame)).for_each(|sweep| hasher.update(sweep.content));
    }
    files::hexadecimal(&hasher.finalize()[..16])
}

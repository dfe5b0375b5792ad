//! Output folders of `trove generate`, moment by moment.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use trove_format::{FrameFile, FrameTable, SweepTable};

use super::finding::{Audit, Check, Notes};
use super::flow::{self, Looked, WAYS};
use super::frame::{LabelledFrame, LabelledSweep};
use super::tracks::Tracks;
use super::{extra, single, views};
use crate::{JudgeError, OnProgress};

/// Who can read frames and sweeps: the folder, and its name below the dataset's.
pub trait FrameReader: Sync {
    /// A frame; what cannot be read of it is among its damage.
    ///
    /// # Errors
    /// A table that cannot be read, told in a line.
    fn frame(&self, folder: &Path, place: &str) -> Result<LabelledFrame, String>;

    /// A sweep.
    ///
    /// # Errors
    /// A file that cannot be read, told in a line.
    fn sweep(&self, folder: &Path, place: &str) -> Result<LabelledSweep, String>;
}

/// The folders of a moment.
#[derive(Debug, Default)]
struct Moment {
    frames: Vec<PathBuf>,
    sweeps: Vec<PathBuf>,
}

/// Looks at every frame and sweep of an output folder.
///
/// # Errors
/// A folder that cannot be read or has no frames, and an end that was asked for.
pub(super) fn frames(root: &Path, reader: &dyn FrameReader, progress: OnProgress) -> Result<Audit, JudgeError> {
    let variations = variations(root)?;
    let total: usize = variations.values().flatten().map(|moment| moment.frames.len()).sum();
    if total == 0 {
        let remedy = "give an output folder of trove generate, or name the form of another dataset with --form";
        return Err(JudgeError::unexpected(root, "frames of trove generate", "none", remedy));
    }
    let mut audit = Audit::default();
    for moments in variations.values() {
        let (mut tracks, mut earlier) = (Tracks::default(), Vec::<LabelledFrame>::new());
        for moment in moments {
            let (frames, mut notes) = read(root, moment, reader);
            for frame in &frames {
                let mut note = note(frame);
                tracks.check(frame, &mut note);
                notes.push(note);
            }
            notes.extend(look(root, moment, &frames, &earlier, reader));
            notes.into_iter().for_each(|notes| audit.add(notes));
            for _ in &moment.frames {
                audit.frames += 1;
                if !progress(audit.frames, total) {
                    return Err(JudgeError::Ended);
                }
            }
            earlier = frames;
        }
    }
    Ok(audit.finish())
}

/// The moments of every variation in the order of time, from the folders' names.
fn variations(root: &Path) -> Result<BTreeMap<PathBuf, Vec<Moment>>, JudgeError> {
    let mut found = BTreeMap::<PathBuf, BTreeMap<(usize, PathBuf), Moment>>::new();
    let mut open = vec![root.to_owned()];
    while let Some(folder) = open.pop() {
        let (is_frame, is_sweep) = (folder.join(FrameTable::NAME).is_file(), folder.join(SweepTable::NAME).is_file());
        if let (true, Some(at), Some(variation)) =
            (is_frame || is_sweep, folder.parent(), folder.parent().and_then(Path::parent))
        {
            // k999 is before k1000.
            let key = (at.as_os_str().len(), at.to_owned());
            let moment = found.entry(variation.to_owned()).or_default().entry(key).or_default();
            let folders = if is_frame { &mut moment.frames } else { &mut moment.sweeps };
            folders.push(folder);
            continue;
        }
        for entry in fs::read_dir(&folder).map_err(JudgeError::io(&folder))? {
            let entry = entry.map_err(JudgeError::io(&folder))?;
            let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            if is_folder && !entry.file_name().to_string_lossy().starts_with('.') {
                open.push(entry.path());
            }
        }
    }
    for moment in found.values_mut().flat_map(BTreeMap::values_mut) {
        moment.frames.sort();
        moment.sweeps.sort();
    }
    Ok(found.into_iter().map(|(variation, moments)| (variation, moments.into_values().collect())).collect())
}

fn below(root: &Path, folder: &Path) -> String {
    folder.strip_prefix(root).unwrap_or(folder).to_string_lossy().replace('\\', "/")
}

fn note(frame: &LabelledFrame) -> Notes {
    let shown = if frame.rgb.is_some() { FrameFile::Rgb } else { FrameFile::Class };
    Notes::of(&frame.place, Some(format!("{}/{}", frame.place, shown.name())))
}

/// The frames of a moment, and what is said of those that cannot be read.
fn read(root: &Path, moment: &Moment, reader: &dyn FrameReader) -> (Vec<LabelledFrame>, Vec<Notes>) {
    let one = |folder: &PathBuf| reader.frame(folder, &below(root, folder)).map_err(|what| (below(root, folder), what));
    let read: Vec<_> = moment.frames.par_iter().map(one).collect();
    let (mut frames, mut notes) = (Vec::new(), Vec::new());
    for frame in read {
        match frame {
            Ok(frame) => frames.push(frame),
            Err((place, what)) => notes.push(unreadable(place, what)),
        }
    }
    (frames, notes)
}

fn unreadable(place: String, what: String) -> Notes {
    let mut notes = Notes::of(place, None);
    notes.wrong(Check::Files, what);
    notes
}

/// Everything that a moment's frames say of themselves, each other and the moment before.
fn look(
    root: &Path,
    moment: &Moment,
    frames: &[LabelledFrame],
    earlier: &[LabelledFrame],
    reader: &dyn FrameReader,
) -> Vec<Notes> {
    let now: Vec<Looked> = frames.iter().map(Looked::at).collect();
    let then: Vec<Looked> = earlier.iter().map(Looked::at).collect();
    let alone = now.par_iter().map(|looked| {
        let mut notes = note(looked.frame);
        notes.look(Check::Camera);
        if let Err(what) = looked.frame.eye() {
            notes.wrong(Check::Camera, what);
        }
        single::check(looked.frame, looked.eye.as_ref(), &mut notes);
        views::occlusion(looked, &mut notes);
        flow::of_still(looked, &mut notes);
        extra::check(looked, &mut notes);
        notes
    });
    let mut all: Vec<Notes> = alone.collect();
    // The same view, one moment apart.
    let pairs = now.par_iter().filter_map(|to| {
        let is_before = |from: &&Looked| {
            let (a, b) = (&from.frame.table, &to.frame.table);
            a.view == b.view && a.keyframe + 1 == b.keyframe
        };
        then.iter().find(is_before).map(|from| (from, to))
    });
    all.par_extend(pairs.flat_map_iter(|(from, to)| {
        WAYS.map(|way| {
            let (a, b) = if way == 0 { (from, to) } else { (to, from) };
            let mut notes = note(a.frame);
            flow::between(a, b, way, &mut notes);
            notes
        })
    }));
    let count = now.len();
    let pairs = (0..count * count).into_par_iter().map(|i| (&now[i / count.max(1)], &now[i % count.max(1)]));
    all.par_extend(pairs.filter(|(a, b)| a.frame.place != b.frame.place).map(|(a, b)| {
        let mut notes = note(a.frame);
        views::check(a, b, &mut notes);
        notes
    }));
    all.extend(moment.sweeps.iter().flat_map(|folder| sweep(root, folder, &now, reader)));
    all
}

fn sweep(root: &Path, folder: &Path, now: &[Looked], reader: &dyn FrameReader) -> Vec<Notes> {
    let sweep = match reader.sweep(folder, &below(root, folder)) {
        Ok(sweep) => sweep,
        Err(what) => return vec![unreadable(below(root, folder), what)],
    };
    let mut own = Notes::of(&sweep.place, None);
    views::sweep(&sweep, &mut own);
    let with = now.par_iter().map(|looked| {
        let mut notes = note(looked.frame);
        views::lidar(&sweep, looked, &mut notes);
        notes
    });
    let mut all: Vec<Notes> = with.collect();
    all.push(own);
    all
}

//! What a prediction is worth against the truth.

mod boundary;
mod confusion;
mod mean;
mod panoptic;
mod report;
mod sides;

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use trove_model::{ClassMap, Seed};

use crate::numbering::{INSTANCES, Judged, read_as, read_objects};
use crate::pictures::{BY_ID, BY_TRAIN_ID, OnProgress, by_key, each, label_files, name};
use crate::{JudgeError, Numbering};
pub use boundary::Boundary;
pub use confusion::Confusion;
use panoptic::Segment;
pub use panoptic::{Panoptic, Quality};
pub use report::report;
use sides::{Side, Sides};

/// Draws of pictures with replacement.
const DRAWS: u64 = 1000;
/// In Cityscapes' `…_instanceIds.png` smaller numbers are classes, of a crowd where the class is countable.
const CITYSCAPES_OBJECTS_FROM: u16 = 1000;
/// Share of the draws within the interval.
const WITHIN: f64 = 0.95;

/// What to compare.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The classes to judge in, and the numbers of a side that does not tell its own; without it, those that both sides
    /// are in, or the paper's 13 where they differ, are our own, or do not tell.
    pub classes: Option<ClassMap>,
    /// The numbers of the predictions, where their files are not to decide.
    pub predicted: Option<Numbering>,
    /// The same of the truth.
    pub truth: Option<Numbering>,
    /// Boundary IoU too.
    pub boundary: bool,
    /// Panoptic quality too: beside each `class.png` lies an `instance.png` (16-bit, 0 none), and beside Cityscapes'
    /// `…_labelIds.png` its `…_instanceIds.png`; panoptic maps of KITTI-STEP and Waymo have both themselves.
    pub panoptic: bool,
    /// Draws the bootstrap's pictures.
    pub seed: Seed,
}

/// A value and the interval in which it lies with 95 % of sets of pictures like these (percentile bootstrap over
/// pictures, Efron 1979).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Over all pictures.
    pub value: f64,
    /// Low and high end.
    pub interval: [f64; 2],
}

/// What is counted, of one picture or of many.
#[derive(Clone, Debug, PartialEq)]
pub struct Counts {
    /// Pixels by class and prediction.
    pub confusion: Confusion,
    /// Pixels along outlines; nothing where it was not asked for.
    pub boundary: Boundary,
    /// Segments; nothing where it was not asked for.
    pub panoptic: Panoptic,
}

impl Counts {
    fn none(classes: usize) -> Self {
        Self { confusion: Confusion::new(classes), boundary: Boundary::new(classes), panoptic: Panoptic::new(classes) }
    }

    fn add(&mut self, other: &Self) {
        self.confusion.add(&other.confusion);
        self.boundary.add(&other.boundary);
        self.panoptic.add(&other.panoptic);
    }
}

/// A picture with what its prediction alone is worth.
#[derive(Clone, Debug)]
pub struct JudgedPicture {
    /// Below the folder of the truth.
    pub name: String,
    /// Where its predicted labels are.
    pub predicted: PathBuf,
    /// Where its true labels are.
    pub truth: PathBuf,
    /// Mean IoU over the classes that are there or predicted; `None` where none is.
    pub miou: Option<f64>,
    /// Share of its pixels that are right; `None` where none counts.
    pub accuracy: Option<f64>,
}

/// What came out.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// The classes that were judged in.
    pub classes: ClassMap,
    /// The numbers of the predictions' pictures.
    pub predicted: Numbering,
    /// The numbers of the truth's.
    pub truth: Numbering,
    /// Pictures compared.
    pub pictures: usize,
    /// Predictions without a truth, which were left out.
    pub unused: usize,
    /// Over all pictures.
    pub counts: Counts,
    /// Mean IoU over the classes that are there or predicted.
    pub miou: Option<Estimate>,
    /// Share of pixels that are right.
    pub accuracy: Option<Estimate>,
    /// IoU by class.
    pub iou: Vec<Option<Estimate>>,
    /// Mean boundary IoU.
    pub boundary_miou: Option<Estimate>,
    /// Boundary IoU by class.
    pub boundary_iou: Vec<Option<Estimate>>,
    /// Mean panoptic quality.
    pub pq: Option<Estimate>,
    /// Panoptic quality by class.
    pub class_pq: Vec<Option<Estimate>>,
    /// Each picture alone, in the order of their names.
    pub singly: Vec<JudgedPicture>,
}

/// Compares the label pictures below two folders, or two files; every picture of the truth has to be predicted.
///
/// # Errors
/// A side of which it is not known in what numbers it is, or how they become those of the classes to judge in; a picture
/// that is missing, cannot be read, has another size than its counterpart, or holds a number that its map does not have.
pub fn evaluate(
    predicted: &Path,
    truth: &Path,
    settings: &Settings,
    progress: OnProgress,
) -> Result<Evaluation, JudgeError> {
    let (pairs, unused) = pairs(predicted, truth, settings.classes.as_ref())?;
    let given = [settings.predicted.as_ref(), settings.truth.as_ref()];
    let sides = sides::of(&pairs, [predicted, truth], settings.classes.as_ref(), given)?;
    let judged = each(&pairs, progress, |(p, t)| judge(p, t, &sides, settings))?;
    let classes = sides.classes.counted().count();
    let mut counts = Counts::none(classes);
    judged.iter().for_each(|picture| counts.add(picture));
    let draws = draws(&judged, classes, settings.seed);
    let estimate = |of: &dyn Fn(&Counts) -> Option<f64>| {
        let drawn: Vec<f64> = draws.iter().filter_map(of).collect();
        Some(Estimate { value: of(&counts)?, interval: interval(drawn)? })
    };
    let by_class = |of: fn(&Counts, usize) -> Option<f64>| -> Vec<Option<Estimate>> {
        (0..classes).map(|class| estimate(&|c: &Counts| of(c, class))).collect()
    };
    let alone = |((p, t), counts): (&(PathBuf, PathBuf), &Counts)| JudgedPicture {
        name: below(truth, t),
        predicted: p.clone(),
        truth: t.clone(),
        miou: counts.confusion.miou(),
        accuracy: counts.confusion.accuracy(),
    };
    Ok(Evaluation {
        pictures: judged.len(),
        unused,
        singly: pairs.iter().zip(&judged).map(alone).collect(),
        miou: estimate(&|c| c.confusion.miou()),
        accuracy: estimate(&|c| c.confusion.accuracy()),
        iou: by_class(|c, class| c.confusion.iou(class)),
        boundary_miou: estimate(&|c| c.boundary.miou()),
        boundary_iou: by_class(|c, class| c.boundary.iou(class)),
        pq: estimate(&|c| c.panoptic.mean()),
        class_pq: by_class(|c, class| Some(c.panoptic.quality(class)?.pq)),
        classes: sides.classes,
        predicted: sides.predicted.numbering,
        truth: sides.truth.numbering,
        counts,
    })
}

/// What a picture is called in its folder; its own name where it was named itself.
fn below(root: &Path, path: &Path) -> String {
    match path.strip_prefix(root) {
        Ok(below) if below != Path::new("") => below.to_string_lossy().replace('\\', "/"),
        _ => name(path),
    }
}

/// Pictures of both sides that belong together, in the order of their names, and how many predictions are left over.
fn pairs(
    predicted: &Path,
    truth: &Path,
    wanted: Option<&ClassMap>,
) -> Result<(Vec<(PathBuf, PathBuf)>, usize), JudgeError> {
    match (predicted.is_file(), truth.is_file()) {
        (true, true) => return Ok((vec![(predicted.to_owned(), truth.to_owned())], 0)),
        (true, false) if truth.is_dir() => {
            let remedy = "give two files or two folders";
            return Err(JudgeError::unexpected(truth, "a file, like the prediction", "a folder", remedy));
        }
        (false, true) if predicted.is_dir() => {
            let remedy = "give two files or two folders";
            return Err(JudgeError::unexpected(predicted, "a file, like the ground truth", "a folder", remedy));
        }
        _ => {}
    }
    let truths = by_key(truth, label_files(truth, wanted)?)?;
    let mut predictions = by_key(predicted, label_files(predicted, wanted)?)?;
    let pair = |(key, t): (String, PathBuf)| match predictions.remove(&key) {
        Some(p) => Ok((p, t)),
        None => Err(JudgeError::unexpected(
            predicted,
            format!("a prediction of {}", t.display()),
            "none of that name",
            "name predictions like the ground-truth files, relative to their folder",
        )),
    };
    let pairs = truths.into_iter().map(pair).collect::<Result<_, _>>()?;
    Ok((pairs, predictions.len()))
}

fn judge(predicted: &Path, truth: &Path, sides: &Sides, settings: &Settings) -> Result<Counts, JudgeError> {
    let map = &sides.classes;
    let read = |path: &Path, side: &Side| read_as(path, &side.numbering.map, map, &side.numbers);
    let (p, t) = (read(predicted, &sides.predicted)?, read(truth, &sides.truth)?);
    if (p.labels.width, p.labels.height) != (t.labels.width, t.labels.height) {
        return Err(JudgeError::unexpected(
            predicted,
            format!("{}×{} pixels as {}", t.labels.width, t.labels.height, truth.display()),
            format!("{}×{}", p.labels.width, p.labels.height),
            "scale it with nearest-neighbour sampling",
        ));
    }
    let (p_ids, t_ids) = (&p.labels.data, &t.labels.data);
    let mut counts = Counts { confusion: Confusion::of(map, p_ids, t_ids), ..Counts::none(map.counted().count()) };
    if settings.boundary {
        counts.boundary = Boundary::of(map, p_ids, t_ids, t.labels.width as usize);
    }
    if settings.panoptic {
        counts.panoptic = Panoptic::of(map, &segments(predicted, &p, map)?, &segments(truth, &t, map)?);
    }
    Ok(counts)
}

/// The segments of a picture, from its classes and the numbers of objects in it or beside it. Countable things without a
/// number are a crowd.
fn segments(path: &Path, picture: &Judged, map: &ClassMap) -> Result<Vec<Segment>, JudgeError> {
    let file = name(path);
    let cityscapes = file.ends_with(BY_ID) || file.ends_with(BY_TRAIN_ID);
    let beside;
    let objects = match &picture.objects {
        Some(objects) => objects,
        None => {
            beside = read_objects(
                &path.with_file_name(match cityscapes {
                    true => file.replace("_labelIds", "_instanceIds").replace("_labelTrainIds", "_instanceIds"),
                    false => INSTANCES.into(),
                }),
                &picture.labels,
                path,
            )?;
            &beside
        }
    };
    let (train_ids, things): (_, Vec<bool>) = (map.train_ids(), map.counted().map(|class| class.thing).collect());
    let segment = |(id, object): (&u8, &u16)| {
        let class = train_ids[usize::from(*id)]?;
        let countable = things[usize::from(class)] && (!cityscapes || *object >= CITYSCAPES_OBJECTS_FROM);
        Some(u32::from(class) << 16 | if countable { u32::from(*object) } else { 0 })
    };
    Ok(picture.labels.data.iter().zip(objects).map(segment).collect())
}

/// Counts of sets of as many pictures, drawn with replacement.
fn draws(judged: &[Counts], classes: usize, seed: Seed) -> Vec<Counts> {
    let draw = |i: u64| {
        let mut random = seed.child("bootstrap").nth(i).random();
        let mut drawn = Counts::none(classes);
        (0..judged.len()).for_each(|_| drawn.add(&judged[random.index(judged.len())]));
        drawn
    };
    (0..DRAWS).into_par_iter().map(draw).collect()
}

/// The middle 95 % of values; `None` without values.
fn interval(mut values: Vec<f64>) -> Option<[f64; 2]> {
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    let at = |share: f64| values[(share * last as f64).round() as usize];
    Some([at((1.0 - WITHIN) / 2.0), at((1.0 + WITHIN) / 2.0)])
}

#[cfg(test)]
mod numbering_tests;
#[cfg(test)]
mod tests;

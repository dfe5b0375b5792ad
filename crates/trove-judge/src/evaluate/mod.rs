//! What a prediction is worth against the truth.

mod boundary;
mod confusion;
mod mean;
mod panoptic;

use std::path::{Path, PathBuf};

use image::DynamicImage;
use rayon::prelude::*;
use trove_model::Seed;

use crate::pictures::{Labels, OnProgress, by_key, each, label_files, read, read_labels, read_step};
use crate::{JudgeError, LabelSet};
pub use boundary::Boundary;
pub use confusion::Confusion;
use panoptic::Segment;
pub use panoptic::{Panoptic, Quality};

/// Draws of pictures with replacement.
const DRAWS: u64 = 1000;
/// In Cityscapes' `…_instanceIds.png` smaller numbers are classes, of a crowd where the class is countable.
const CITYSCAPES_OBJECTS_FROM: u16 = 1000;
/// The numbering of KITTI-STEP's panoptic maps.
const STEP_SET: &str = "cityscapes-train";
/// Share of the draws within the interval.
const WITHIN: f64 = 0.95;

/// What to compare.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The numbering of both sides.
    pub set: LabelSet,
    /// Boundary IoU too.
    pub boundary: bool,
    /// Panoptic quality too: beside each `class.png` lies an `instance.png` (16-bit, 0 none), and beside Cityscapes'
    /// `…_labelIds.png` its `…_instanceIds.png`; a panoptic map of KITTI-STEP has both itself.
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

/// What came out.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// The numbering.
    pub set: LabelSet,
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
}

/// Compares the label pictures below two folders, or two files; every picture of the truth has to be predicted.
///
/// # Errors
/// A picture that is missing, cannot be read, is in colours, has another size than its counterpart, or holds a number
/// that the set does not know.
pub fn evaluate(
    predicted: &Path,
    truth: &Path,
    settings: &Settings,
    progress: OnProgress,
) -> Result<Evaluation, JudgeError> {
    let (pairs, unused) = pairs(predicted, truth, &settings.set)?;
    let judged = each(&pairs, progress, |(p, t)| judge(p, t, settings))?;
    let classes = settings.set.classes.len();
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
    Ok(Evaluation {
        pictures: judged.len(),
        unused,
        miou: estimate(&|c| c.confusion.miou()),
        accuracy: estimate(&|c| c.confusion.accuracy()),
        iou: by_class(|c, class| c.confusion.iou(class)),
        boundary_miou: estimate(&|c| c.boundary.miou()),
        boundary_iou: by_class(|c, class| c.boundary.iou(class)),
        pq: estimate(&|c| c.panoptic.mean()),
        class_pq: by_class(|c, class| Some(c.panoptic.quality(class)?.pq)),
        set: settings.set.clone(),
        counts,
    })
}

/// Pictures of both sides that belong together, in the order of their names, and how many predictions are left over.
fn pairs(predicted: &Path, truth: &Path, set: &LabelSet) -> Result<(Vec<(PathBuf, PathBuf)>, usize), JudgeError> {
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
    let truths = by_key(truth, label_files(truth, set)?)?;
    let mut predictions = by_key(predicted, label_files(predicted, set)?)?;
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

fn judge(predicted: &Path, truth: &Path, settings: &Settings) -> Result<Counts, JudgeError> {
    let set = &settings.set;
    let ((p, p_objects), (t, t_objects)) = (read_known(predicted, set)?, read_known(truth, set)?);
    if (p.width, p.height) != (t.width, t.height) {
        return Err(JudgeError::unexpected(
            predicted,
            format!("{}×{} pixels as {}", t.width, t.height, truth.display()),
            format!("{}×{}", p.width, p.height),
            "scale it with nearest-neighbour sampling",
        ));
    }
    let mut counts = Counts { confusion: Confusion::of(set, &p.ids, &t.ids), ..Counts::none(set.classes.len()) };
    if settings.boundary {
        counts.boundary = Boundary::of(set, &p.ids, &t.ids, t.width as usize);
    }
    if settings.panoptic {
        let segments = |path: &Path, labels: &Labels, objects: Option<Vec<u16>>| match objects {
            Some(objects) => Ok(step_segments(&labels.ids, &objects, set)),
            None => segments(path, &labels.ids, set),
        };
        counts.panoptic = Panoptic::of(set, &segments(predicted, &p, p_objects)?, &segments(truth, &t, t_objects)?);
    }
    Ok(counts)
}

/// Labels whose numbers the set knows, with the objects' numbers where the picture has them itself.
fn read_known(path: &Path, set: &LabelSet) -> Result<(Labels, Option<Vec<u16>>), JudgeError> {
    let step = if set.name == STEP_SET { read_step(path)? } else { None };
    let (labels, objects) = match step {
        Some((labels, objects)) => (labels, Some(objects)),
        None => (read_labels(path)?, None),
    };
    match set.unknown(&labels.ids) {
        None => Ok((labels, objects)),
        Some(i) => {
            let known: Vec<String> = set.classes.iter().map(|class| class.id.to_string()).collect();
            let ignored: Vec<String> = set.ignored.iter().map(u8::to_string).collect();
            let expected = format!("{}'s ids ({}, ignored {})", set.name, known.join(" "), ignored.join(" "));
            let (x, y) = (i as u32 % labels.width, i as u32 / labels.width);
            let found = format!("{} at x {x}, y {y}", labels.ids[i]);
            Err(JudgeError::unexpected(path, expected, found, "choose the label set with --classes"))
        }
    }
}

/// The segments of a picture, from its classes and the numbers of objects beside it.
fn segments(classes: &Path, ids: &[u8], set: &LabelSet) -> Result<Vec<Segment>, JudgeError> {
    let name = classes.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let cityscapes = name.contains("_labelIds") || name.contains("_labelTrainIds");
    let beside = classes.with_file_name(match cityscapes {
        true => name.replace("_labelIds", "_instanceIds").replace("_labelTrainIds", "_instanceIds"),
        false => "instance.png".into(),
    });
    let bad = |expected: String, found: String| {
        JudgeError::unexpected(&beside, expected, found, "write the file again, or omit --panoptic")
    };
    let wanted = || format!("16-bit greyscale ids of the objects in {name}");
    if !beside.is_file() {
        return Err(bad(wanted(), "no file".into()));
    }
    let objects: Vec<u16> = match read(&beside)? {
        DynamicImage::ImageLuma16(numbers) => numbers.into_raw(),
        DynamicImage::ImageLuma8(numbers) => numbers.into_raw().into_iter().map(u16::from).collect(),
        other => return Err(bad(wanted(), format!("{:?}", other.color()))),
    };
    if objects.len() != ids.len() {
        return Err(bad(format!("{} pixels, like {name}", ids.len()), objects.len().to_string()));
    }
    let index = set.index();
    let segment = |(id, object): (&u8, u16)| {
        let class = index[usize::from(*id)]?;
        let countable = set.classes[usize::from(class)].thing && (!cityscapes || object >= CITYSCAPES_OBJECTS_FROM);
        Some(u32::from(class) << 16 | if countable { u32::from(object) } else { 0 })
    };
    Ok(ids.iter().zip(objects).map(segment).collect())
}

/// The segments of a panoptic map of KITTI-STEP; countable things without a number are a crowd.
fn step_segments(ids: &[u8], objects: &[u16], set: &LabelSet) -> Vec<Segment> {
    let index = set.index();
    let segment = |(id, object): (&u8, &u16)| {
        let class = index[usize::from(*id)]?;
        let countable = set.classes[usize::from(class)].thing;
        Some(u32::from(class) << 16 | if countable { u32::from(*object) } else { 0 })
    };
    ids.iter().zip(objects).map(segment).collect()
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
mod tests;

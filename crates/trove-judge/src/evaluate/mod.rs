//! What a prediction is worth against the truth.

mod boundary;
mod confusion;
mod panoptic;

use std::path::{Path, PathBuf};

use image::DynamicImage;
use rayon::prelude::*;
use trove_model::Seed;

use crate::pictures::{pictures, read, read_labels};
use crate::{JudgeError, LabelSet};
pub use boundary::Boundary;
pub use confusion::Confusion;
pub use panoptic::Panoptic;
use panoptic::Segment;

/// Draws of pictures with replacement.
const DRAWS: u64 = 1000;
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
    /// `…_labelIds.png` its `…_instanceIds.png`.
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

/// What came out.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// The numbering.
    pub set: LabelSet,
    /// Pictures compared.
    pub pictures: usize,
    /// Over all pictures.
    pub confusion: Confusion,
    /// Mean IoU over the classes present.
    pub miou: Option<Estimate>,
    /// Share of pixels that are right.
    pub accuracy: Option<Estimate>,
    /// IoU by class.
    pub iou: Vec<Option<Estimate>>,
    /// Where it was asked for.
    pub boundary: Option<Boundary>,
    /// Where it was asked for.
    pub panoptic: Option<Panoptic>,
}

/// Compares the label pictures below two folders, or two files; every picture of the truth has to be predicted.
///
/// # Errors
/// A picture that is missing, cannot be read, is in colours, or has another size than its counterpart.
pub fn evaluate(predicted: &Path, truth: &Path, settings: &Settings) -> Result<Evaluation, JudgeError> {
    let pairs = pairs(predicted, truth)?;
    let judged: Vec<Judged> = pairs.par_iter().map(|(p, t)| judge(p, t, settings)).collect::<Result<_, _>>()?;
    let classes = settings.set.classes.len();
    let mut confusion = Confusion::new(classes);
    let (mut boundary, mut panoptic) = (Boundary::default(), Panoptic::default());
    for picture in &judged {
        confusion.add(&picture.confusion);
        boundary.add(&picture.boundary);
        panoptic.add(&picture.panoptic);
    }
    let draws = draws(&judged, classes, settings.seed);
    let estimate = |of: &dyn Fn(&Confusion) -> Option<f64>| {
        let drawn: Vec<f64> = draws.iter().filter_map(of).collect();
        Some(Estimate { value: of(&confusion)?, interval: interval(drawn)? })
    };
    Ok(Evaluation {
        pictures: judged.len(),
        miou: estimate(&Confusion::miou),
        accuracy: estimate(&Confusion::accuracy),
        iou: (0..classes).map(|class| estimate(&|c: &Confusion| c.iou(class))).collect(),
        boundary: settings.boundary.then_some(boundary),
        panoptic: settings.panoptic.then_some(panoptic),
        set: settings.set.clone(),
        confusion,
    })
}

/// Pictures of both sides that belong together, in the order of their names.
fn pairs(predicted: &Path, truth: &Path) -> Result<Vec<(PathBuf, PathBuf)>, JudgeError> {
    if truth.is_file() {
        return Ok(vec![(predicted.to_owned(), truth.to_owned())]);
    }
    // Of our own and of Cityscapes' files those with classes.
    let is_labels = |name: &str| {
        let others = ["rgb.png", "instance.png", "contact_sheet.png"];
        let cityscapes = ["_instanceIds.", "_color.", "_leftImg8bit.", "_labelTrainIds."];
        !others.contains(&name) && !cityscapes.iter().any(|part| name.contains(part))
    };
    let truths = pictures(truth, is_labels)?;
    // A prediction's file may be named after the photograph.
    let predictions = pictures(predicted, |name| !["rgb.png", "instance.png", "contact_sheet.png"].contains(&name))?;
    if truths.is_empty() {
        return Err(JudgeError::unexpected(truth, "label pictures (.png)", "none", "give the folder that holds them"));
    }
    let pair = |(key, t): (String, PathBuf)| match predictions.get(&key) {
        Some(p) => Ok((p.clone(), t)),
        None => Err(JudgeError::unexpected(
            predicted,
            format!("a prediction of {key}"),
            "none of that name",
            "name predictions as the truth's files below their folder",
        )),
    };
    truths.into_iter().map(pair).collect()
}

/// One picture's counts.
struct Judged {
    confusion: Confusion,
    boundary: Boundary,
    panoptic: Panoptic,
}

fn judge(predicted: &Path, truth: &Path, settings: &Settings) -> Result<Judged, JudgeError> {
    let (p, t) = (read_labels(predicted)?, read_labels(truth)?);
    if p.width != t.width || p.ids.len() != t.ids.len() {
        let size = |labels: &crate::pictures::Labels| {
            format!("{}×{}", labels.width, labels.ids.len() as u32 / labels.width.max(1))
        };
        return Err(JudgeError::unexpected(
            predicted,
            format!("{} pixels as {}", size(&t), truth.display()),
            size(&p),
            "scale it by nearest neighbours",
        ));
    }
    let set = &settings.set;
    let boundary =
        if settings.boundary { Boundary::of(set, &p.ids, &t.ids, t.width as usize) } else { Boundary::default() };
    let panoptic = if settings.panoptic {
        Panoptic::of(&segments(predicted, &p.ids, set)?, &segments(truth, &t.ids, set)?)
    } else {
        Panoptic::default()
    };
    Ok(Judged { confusion: Confusion::of(set, &p.ids, &t.ids), boundary, panoptic })
}

/// The segments of a picture, from its classes and the numbers of objects beside it.
fn segments(classes: &Path, ids: &[u8], set: &LabelSet) -> Result<Vec<Segment>, JudgeError> {
    let name = classes.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let beside = classes.with_file_name(match name.contains("_labelIds") {
        true => name.replace("_labelIds", "_instanceIds"),
        false => "instance.png".into(),
    });
    let objects: Vec<u16> = match read(&beside)? {
        DynamicImage::ImageLuma16(numbers) => numbers.into_raw(),
        DynamicImage::ImageLuma8(numbers) => numbers.into_raw().into_iter().map(u16::from).collect(),
        other => {
            let found = format!("{:?}", other.color());
            return Err(JudgeError::unexpected(
                &beside,
                "16-bit grey numbers of objects",
                found,
                "make the file again",
            ));
        }
    };
    if objects.len() != ids.len() {
        let (expected, found) = (format!("{} pixels as {name}", ids.len()), objects.len().to_string());
        return Err(JudgeError::unexpected(&beside, expected, found, "make the file again"));
    }
    let index = set.index();
    let segment = |(id, object): (&u8, u16)| Some(u32::from(index[usize::from(*id)]?) << 16 | u32::from(object));
    Ok(ids.iter().zip(objects).map(segment).collect())
}

/// Confusions of sets of as many pictures, drawn with replacement.
fn draws(judged: &[Judged], classes: usize, seed: Seed) -> Vec<Confusion> {
    let draw = |i: u64| {
        let mut random = seed.child("bootstrap").nth(i).random();
        let mut drawn = Confusion::new(classes);
        (0..judged.len()).for_each(|_| drawn.add(&judged[random.index(judged.len())].confusion));
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

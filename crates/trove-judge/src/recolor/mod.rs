//! Pictures in the colours of others: Reinhard, Ashikhmin, Gooch and Shirley 2001 (Color Transfer between Images), with
//! the paper's blend of both sides' means and deviations, or histograms matched class by class; also as sharp as others.

mod detail;
mod histogram;
mod output;
mod report;
mod space;
mod statistics;

use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, RgbImage};
use trove_model::{Class, ClassMap, Seed};

use crate::JudgeError;
use crate::pictures::{OnProgress, by_key, each, label_files, photographs, read, read_labels};
pub use detail::Detail;
use detail::sharpen;
pub use histogram::{Histograms, Matching};
use output::{Identity, OutputFolder};
pub use report::report;
pub use space::Space;
pub(crate) use space::linear;
pub use statistics::Statistics;

/// What is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Means and deviations, every picture's own towards the whole target's.
    PerPicture,
    /// Means and deviations, every picture's own towards those of one picture of the target, drawn by its path: as
    /// different as the target's pictures are.
    Paired,
    /// Means and deviations, those of the whole set: pictures stay as different as they were.
    PerSet,
    /// Histograms, class by class; both sides need labels.
    HistogramPerClass,
}

/// How to recolour.
#[derive(Clone, Debug)]
pub struct Settings {
    /// What is moved.
    pub method: Method,
    /// In which space; histograms are matched in L\*a\*b\*.
    pub space: Space,
    /// How far towards the target, 0 (not at all) to 1 (as in Reinhard et al.).
    pub strength: f32,
    /// Whether pictures also become as sharp as the target's.
    pub detail: bool,
    /// Label pictures of the target, for histograms, and their numbering.
    pub target_labels: Option<(PathBuf, ClassMap)>,
}

/// What was done.
#[derive(Clone, Debug)]
pub struct Recoloring {
    /// Pictures that are there now, with those that they come from.
    pub pictures: Vec<(PathBuf, PathBuf)>,
    /// How many of them were there before.
    pub kept: usize,
    /// Of the pictures before, those of the target, and of the pictures as they were written, in the space.
    pub measures: [Measures; 3],
}

/// What is measured of pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// Their colours.
    pub colors: Statistics,
    /// How sharp they are.
    pub detail: Detail,
}

impl Measures {
    /// Of a picture's pixels, row by row.
    fn of(pixels: &[[f32; 3]], width: u32) -> Self {
        Self { colors: Statistics::of(pixels), detail: Detail::of(pixels, width as usize) }
    }

    /// Of all of them together.
    fn joined<'a>(all: impl Iterator<Item = &'a Self>) -> Self {
        let mut sum = Self::default();
        for one in all {
            sum.colors.join(&one.colors);
            sum.detail.join(&one.detail);
        }
        sum
    }
}

/// Colours of 8-bit pictures: one value more than a code apart would be seen, so deviations of nothing are not divided by.
const LEAST_DEVIATION: f64 = 1e-3;

/// Recolours the pictures below `source` (of our own output the `rgb.png`s) towards those below `target` and writes them
/// below `out`, under the same paths, as PNG. What an earlier run of the same pictures and settings has finished stays.
///
/// # Errors
/// A folder without pictures, a picture that cannot be read or written, labels that are missing for histograms, an `out`
/// that lies within one of the other folders, or that holds something else.
pub fn recolor(
    source: &Path,
    target: &Path,
    out: &Path,
    settings: &Settings,
    progress: OnProgress,
) -> Result<Recoloring, JudgeError> {
    refuse_within(out, source)?;
    refuse_within(out, target)?;
    let (sources, targets) = (photographs(source)?, photographs(target)?);
    // Targets are read for their statistics, sources too unless each is its own measure, and every source to be moved.
    let passes = if matches!(settings.method, Method::PerPicture | Method::Paired) { 1 } else { 2 };
    let steps = targets.len() + passes * sources.len();
    let singly = measured(&targets, settings.space, &|done, _| progress(done, steps))?;
    let wanted = Measures::joined(singly.iter());
    let after_targets = |done: usize, _: usize| progress(targets.len() + done, steps);
    let whole = || Ok::<_, JudgeError>(Measures::joined(measured(&sources, settings.space, &after_targets)?.iter()));
    let (before, towards, counted) = match (settings.method, &settings.target_labels) {
        (Method::PerPicture, _) => (None, Towards::All(wanted), None),
        (Method::Paired, _) => (None, Towards::Drawn(singly), None),
        (Method::PerSet, _) => (Some(whole()?), Towards::All(wanted), None),
        (Method::HistogramPerClass, Some((folder, set))) => {
            let before = whole()?;
            let own = histograms(&with_own_labels(&sources)?, Some(set))?;
            let target = histograms(&with_labels(target, &targets, folder, set)?, None)?;
            (Some(before), Towards::Classes(own.towards(&target), set, wanted), Some([own.pixels(), target.pixels()]))
        }
        (Method::HistogramPerClass, None) => {
            return Err(JudgeError::unexpected(target, "labels for histograms by class", "none", "name their folder"));
        }
    };
    let identity = Identity {
        classes: counted,
        detail: settings.detail.then(|| format!("{:?}", wanted.detail)),
        method: format!("{:?}", settings.method),
        source: before.map(|s| format!("{:?}", s.colors)),
        space: format!("{:?}", settings.space),
        strength: settings.strength.into(),
        target: format!("{:?}", wanted.colors),
    };
    let output = OutputFolder::open(out, &identity.text())?;
    let recolored = |path: &PathBuf| {
        let below = path.strip_prefix(source).unwrap_or(path);
        let written = || read(&output.path(below)).map(|picture| picture.into_rgb8());
        let kept = output.finished(below, path);
        if kept && let Some(before) = before {
            return Ok((kept, before, measures(&written()?, settings.space)));
        }
        let picture = read(path)?.into_rgb8();
        let mut pixels = in_space(&picture, settings.space);
        let own = before.unwrap_or_else(|| Measures::of(&pixels, picture.width()));
        let after = if kept {
            written()?
        } else {
            towards.apply(&mut pixels, &own, settings, (path, below, &picture))?;
            let (width, height) = picture.dimensions();
            let codes = RgbImage::from_fn(width, height, |x, y| {
                image::Rgb(settings.space.to_srgb(pixels[(y * width + x) as usize]))
            });
            output.write(below, &encoded(path, &codes)?)?;
            codes
        };
        Ok((kept, own, measures(&after, settings.space)))
    };
    let last = |done: usize, _: usize| progress(steps - sources.len() + done, steps);
    let done: Vec<(bool, Measures, Measures)> = each(&sources, &last, recolored)?;
    let below = |path: &PathBuf| output.path(path.strip_prefix(source).unwrap_or(path));
    Ok(Recoloring {
        kept: done.iter().filter(|row| row.0).count(),
        measures: [
            before.unwrap_or_else(|| Measures::joined(done.iter().map(|row| &row.1))),
            wanted,
            Measures::joined(done.iter().map(|row| &row.2)),
        ],
        pictures: sources.iter().map(|path| (below(path), path.clone())).collect(),
    })
}

/// What pictures are moved towards.
enum Towards<'a> {
    /// The measures of all of the target.
    All(Measures),
    /// Those of one of its pictures.
    Drawn(Vec<Measures>),
    /// Histograms by class, in the numbers of a set; in detail the measures of all.
    Classes(Matching, &'a ClassMap, Measures),
}

impl Towards<'_> {
    /// Moves a picture's pixels, whose measures to move from are `own`; it lies at a path, and `below` the source.
    fn apply(
        &self,
        pixels: &mut [[f32; 3]],
        own: &Measures,
        settings: &Settings,
        (path, below, picture): (&Path, &Path, &RgbImage),
    ) -> Result<(), JudgeError> {
        let strength = settings.strength;
        let wanted = match self {
            Self::All(wanted) | Self::Classes(_, _, wanted) => wanted,
            Self::Drawn(singly) => &singly[drawn(below, singly.len())],
        };
        match self {
            Self::All(_) | Self::Drawn(_) => move_towards(pixels, &own.colors, &wanted.colors, strength),
            Self::Classes(matching, set, _) => {
                for (pixel, class) in pixels.iter_mut().zip(own_classes(path, picture, set)?) {
                    let matched = matching.apply(*pixel, class);
                    *pixel = std::array::from_fn(|c| pixel[c] + strength * (matched[c] - pixel[c]));
                }
            }
        }
        if settings.detail {
            sharpen(pixels, picture.width() as usize, &own.detail, &wanted.detail, strength);
        }
        Ok(())
    }
}

/// Which of the target's pictures one is moved towards that lies below the source.
fn drawn(below: &Path, targets: usize) -> usize {
    Seed(0).child(&below.to_string_lossy()).random().index(targets)
}

/// Pictures that lie among others would be taken for them by the next run.
fn refuse_within(out: &Path, folder: &Path) -> Result<(), JudgeError> {
    let absolute = |path: &Path| match path.canonicalize() {
        Ok(path) => Ok(path),
        Err(_) => std::path::absolute(path).map_err(JudgeError::io(path)),
    };
    match absolute(out)?.starts_with(absolute(folder)?) {
        true => {
            let expected = format!("a folder outside {}", folder.display());
            Err(JudgeError::unexpected(out, expected, "one within", "choose another --out"))
        }
        false => Ok(()),
    }
}

/// Moves colours so that their statistics become `strength` of the way from `from` to `to`: the paper's scaled blend.
pub fn move_towards(pixels: &mut [[f32; 3]], from: &Statistics, to: &Statistics, strength: f32) {
    let blend = |a: f64, b: f64| a + f64::from(strength) * (b - a);
    let (mean, deviation) = (from.mean(), from.deviation());
    let scale: [f64; 3] =
        std::array::from_fn(|c| blend(deviation[c], to.deviation()[c]) / deviation[c].max(LEAST_DEVIATION));
    let middle: [f64; 3] = std::array::from_fn(|c| blend(mean[c], to.mean()[c]));
    for pixel in pixels {
        *pixel = std::array::from_fn(|c| ((f64::from(pixel[c]) - mean[c]) * scale[c] + middle[c]) as f32);
    }
}

fn in_space(picture: &RgbImage, space: Space) -> Vec<[f32; 3]> {
    picture.pixels().map(|pixel| space.from_srgb(pixel.0)).collect()
}

fn measures(picture: &RgbImage, space: Space) -> Measures {
    Measures::of(&in_space(picture, space), picture.width())
}

/// Of every picture alone.
fn measured(paths: &[PathBuf], space: Space, progress: OnProgress) -> Result<Vec<Measures>, JudgeError> {
    each(paths, progress, |path| Ok(measures(&read(path)?.into_rgb8(), space)))
}

/// Histograms by class: of labels in our own classes as numbers of a set, of others as they are.
fn histograms(pairs: &[(PathBuf, PathBuf)], ours_in: Option<&ClassMap>) -> Result<Histograms, JudgeError> {
    let of = |(path, labels): &(PathBuf, PathBuf)| {
        let picture = read(path)?.into_rgb8();
        let classes = match ours_in {
            Some(set) => own_classes(path, &picture, set)?,
            None => ids(labels, &picture)?,
        };
        let mut counted = Histograms::default();
        counted.count(&in_space(&picture, Space::Lab), &classes);
        Ok(counted)
    };
    let mut all = Histograms::default();
    each(pairs, &|_, _| true, of)?.iter().for_each(|one| all.join(one));
    Ok(all)
}

/// Labels that fit a picture.
fn ids(labels: &Path, picture: &RgbImage) -> Result<Vec<u8>, JudgeError> {
    let found = read_labels(labels)?;
    let (width, height) = picture.dimensions();
    match (found.width, found.height) == (width, height) {
        true => Ok(found.data),
        false => {
            let (expected, size) = (format!("{width}×{height} pixels, like the image"), (found.width, found.height));
            let found = format!("{}×{}", size.0, size.1);
            Err(JudgeError::unexpected(labels, expected, found, "scale the labels with nearest-neighbour sampling"))
        }
    }
}

/// What lies beside one of our pictures.
fn own_labels(picture: &Path) -> PathBuf {
    picture.with_file_name("class.png")
}

/// The classes of one of our own pictures, in the numbers of a set, and [`Histograms::NONE`] where it has none.
fn own_classes(path: &Path, picture: &RgbImage, set: &ClassMap) -> Result<Vec<u8>, JudgeError> {
    let labels = own_labels(path);
    let counts = set.train_ids();
    let number = |id: u8| {
        let found = || JudgeError::unexpected(&labels, "ids of the 20 classes", id.to_string(), "write the file again");
        let number = set.id(Class::from_id(id).ok_or_else(found)?);
        Ok(counts[usize::from(number)].map_or(Histograms::NONE, |_| number))
    };
    ids(&labels, picture)?.into_iter().map(number).collect()
}

fn with_own_labels(pictures: &[PathBuf]) -> Result<Vec<(PathBuf, PathBuf)>, JudgeError> {
    let pair = |path: &PathBuf| {
        let labels = own_labels(path);
        match labels.is_file() {
            true => Ok((path.clone(), labels)),
            false => {
                let remedy = "histograms by class need a folder of trove generate";
                Err(JudgeError::unexpected(&labels, "the image's labels", "no file", remedy))
            }
        }
    };
    pictures.iter().map(pair).collect()
}

fn with_labels(
    target: &Path,
    photographs: &[PathBuf],
    folder: &Path,
    set: &ClassMap,
) -> Result<Vec<(PathBuf, PathBuf)>, JudgeError> {
    let mut labels = by_key(folder, label_files(folder, Some(set))?)?;
    let pair = |(key, path): (String, PathBuf)| match labels.remove(&key) {
        Some(labels) => Ok((path, labels)),
        None => {
            let expected = format!("labels of {}", path.display());
            Err(JudgeError::unexpected(
                folder,
                expected,
                "none of that name",
                "name labels like their images, relative to their folder",
            ))
        }
    };
    by_key(target, photographs.to_vec())?.into_iter().map(pair).collect()
}

fn encoded(path: &Path, picture: &RgbImage) -> Result<Vec<u8>, JudgeError> {
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive)
        .write_image(picture, picture.width(), picture.height(), ExtendedColorType::Rgb8)
        .map_err(|e| JudgeError::unexpected(path, "an image that can be encoded", e.to_string(), "report it"))?;
    Ok(bytes)
}

#[cfg(test)]
mod tests;

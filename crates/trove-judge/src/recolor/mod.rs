//! Pictures in the colours of others: Reinhard, Ashikhmin, Gooch and Shirley 2001 (Color Transfer between Images), with
//! the paper's blend of both sides' means and deviations, or histograms matched class by class.

mod histogram;
mod space;
mod statistics;

use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, RgbImage};
use rayon::prelude::*;

use crate::JudgeError;
use crate::pictures::{pictures, read, read_labels};
pub use histogram::{Histograms, Matching};
pub use space::Space;
pub use statistics::Statistics;

/// What is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Means and deviations, of every picture's own.
    PerPicture,
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
    /// Label pictures of the target, for histograms, in the numbering of the source's `class.png`.
    pub target_labels: Option<PathBuf>,
}

/// What was done.
#[derive(Clone, Debug)]
pub struct Recoloring {
    /// Pictures written, with those that they come from.
    pub pictures: Vec<(PathBuf, PathBuf)>,
    /// Of the pictures before, those of the target, and of the pictures after, in the space.
    pub statistics: [Statistics; 3],
}

/// Colours of 8-bit pictures: one value more than a code apart would be seen, so deviations of nothing are not divided by.
const LEAST_DEVIATION: f64 = 1e-3;

/// Recolours the pictures below `source` (of our own output the `rgb.png`s) towards those below `target` and writes them
/// below `out`, under the same paths, as PNG; what is there already is overwritten.
///
/// # Errors
/// A folder without pictures, a picture that cannot be read or written, labels that are missing for histograms.
pub fn recolor(source: &Path, target: &Path, out: &Path, settings: &Settings) -> Result<Recoloring, JudgeError> {
    let (sources, targets) = (photographs(source)?, photographs(target)?);
    let wanted = set_statistics(&targets, settings.space)?;
    let before = match settings.method {
        Method::PerPicture => None,
        Method::PerSet | Method::HistogramPerClass => Some(set_statistics(&sources, settings.space)?),
    };
    let matching = match (settings.method, &settings.target_labels) {
        (Method::HistogramPerClass, Some(labels)) => {
            Some(histograms(&with_own_labels(&sources)?)?.towards(&histograms(&with_labels(&targets, labels)?)?))
        }
        (Method::HistogramPerClass, None) => {
            return Err(JudgeError::unexpected(target, "labels for histograms by class", "none", "name their folder"));
        }
        _ => None,
    };
    let done: Vec<(PathBuf, PathBuf, Statistics, Statistics)> = sources
        .par_iter()
        .map(|path| {
            let picture = read(path)?.into_rgb8();
            let mut pixels = in_space(&picture, settings.space);
            let own = Statistics::of(&pixels);
            match &matching {
                Some(matching) => {
                    let labels = read_labels(&path.with_file_name("class.png"))?;
                    for (pixel, class) in pixels.iter_mut().zip(&labels.ids) {
                        let matched = matching.apply(*pixel, *class);
                        *pixel = std::array::from_fn(|c| pixel[c] + settings.strength * (matched[c] - pixel[c]));
                    }
                }
                None => move_towards(&mut pixels, before.as_ref().unwrap_or(&own), &wanted, settings.strength),
            }
            let after = Statistics::of(&pixels);
            let recolored = out.join(path.strip_prefix(source).unwrap_or(path)).with_extension("png");
            write(&recolored, picture.width(), &pixels, settings.space)?;
            Ok((recolored, path.clone(), own, after))
        })
        .collect::<Result<_, JudgeError>>()?;
    let joined = |of: fn(&(PathBuf, PathBuf, Statistics, Statistics)) -> &Statistics| {
        let mut all = Statistics::default();
        done.iter().for_each(|row| all.join(of(row)));
        all
    };
    let statistics = [joined(|row| &row.2), wanted, joined(|row| &row.3)];
    Ok(Recoloring { pictures: done.into_iter().map(|(out, from, _, _)| (out, from)).collect(), statistics })
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

/// The pictures of a folder that show something rather than label it.
fn photographs(folder: &Path) -> Result<Vec<PathBuf>, JudgeError> {
    let labels = ["class.png", "instance.png", "contact_sheet.png"];
    let found: Vec<PathBuf> = pictures(folder, |name| !labels.contains(&name))?.into_values().collect();
    match found.is_empty() {
        true => Err(JudgeError::unexpected(folder, "PNG or JPEG pictures", "none", "give the folder that holds them")),
        false => Ok(found),
    }
}

fn in_space(picture: &RgbImage, space: Space) -> Vec<[f32; 3]> {
    picture.pixels().map(|pixel| space.from_srgb(pixel.0)).collect()
}

fn set_statistics(paths: &[PathBuf], space: Space) -> Result<Statistics, JudgeError> {
    let each: Vec<Statistics> = paths
        .par_iter()
        .map(|path| Ok(Statistics::of(&in_space(&read(path)?.into_rgb8(), space))))
        .collect::<Result<_, JudgeError>>()?;
    let mut all = Statistics::default();
    each.iter().for_each(|one| all.join(one));
    Ok(all)
}

fn histograms(pairs: &[(PathBuf, PathBuf)]) -> Result<Histograms, JudgeError> {
    let each: Vec<Histograms> = pairs
        .par_iter()
        .map(|(picture, labels)| {
            let mut counted = Histograms::default();
            counted.count(&in_space(&read(picture)?.into_rgb8(), Space::Lab), &read_labels(labels)?.ids);
            Ok(counted)
        })
        .collect::<Result<_, JudgeError>>()?;
    let mut all = Histograms::default();
    each.iter().for_each(|one| all.join(one));
    Ok(all)
}

fn with_own_labels(pictures: &[PathBuf]) -> Result<Vec<(PathBuf, PathBuf)>, JudgeError> {
    Ok(pictures.iter().map(|path| (path.clone(), path.with_file_name("class.png"))).collect())
}

fn with_labels(photographs: &[PathBuf], folder: &Path) -> Result<Vec<(PathBuf, PathBuf)>, JudgeError> {
    let labels = pictures(folder, |_| true)?;
    let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let by_stem: std::collections::BTreeMap<String, &PathBuf> =
        labels.values().map(|path| (stem(path), path)).collect();
    let pair = |path: &PathBuf| match by_stem.get(&stem(path)) {
        Some(labels) => Ok((path.clone(), (*labels).clone())),
        None => {
            let expected = format!("labels named {}", stem(path));
            Err(JudgeError::unexpected(folder, expected, "none of that name", "name labels as their pictures"))
        }
    };
    photographs.iter().map(pair).collect()
}

fn write(path: &Path, width: u32, pixels: &[[f32; 3]], space: Space) -> Result<(), JudgeError> {
    let codes: Vec<u8> = pixels.iter().flat_map(|pixel| space.to_srgb(*pixel)).collect();
    let height = pixels.len() as u32 / width.max(1);
    let folder = path.parent().unwrap_or(Path::new(""));
    std::fs::create_dir_all(folder).map_err(JudgeError::io(folder))?;
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive)
        .write_image(&codes, width, height, ExtendedColorType::Rgb8)
        .map_err(|e| JudgeError::unexpected(path, "a picture that can be encoded", e.to_string(), "report it"))?;
    // Half a picture must not be taken for one.
    let partial = path.with_extension("png.partial");
    std::fs::write(&partial, bytes).map_err(JudgeError::io(&partial))?;
    std::fs::rename(&partial, path).map_err(JudgeError::io(path))
}

#[cfg(test)]
mod tests;

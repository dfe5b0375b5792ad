//! Roots of CamVid's form: images, and labels of the same names in CamVid's 32 colours or as 8-bit ids.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use ::image::DynamicImage;
use trove_model::{ClassMap, Raster};

use super::finding::{Audit, Check, Notes};
use super::label_image::{check_all, known};
use crate::pictures::{files, name, read, read_labels};
use crate::{JudgeError, OnProgress};

/// CamVid's 32 colours.
const COLORS: &str = include_str!("camvid32.tsv");

/// Looks at all labels below a folder.
pub(super) fn audit(root: &Path, progress: OnProgress) -> Result<Audit, JudgeError> {
    let all = files(root, &["png", "jpg", "jpeg"])?;
    let is_label = |path: &PathBuf| {
        let below = path.strip_prefix(root).unwrap_or(path);
        let in_folder =
            below.components().any(|part| part.as_os_str().to_string_lossy().to_lowercase().contains("label"));
        in_folder || name(path).ends_with("_L.png")
    };
    let (labels, images): (Vec<PathBuf>, Vec<PathBuf>) = all.into_iter().partition(is_label);
    if labels.is_empty() {
        let remedy = "give the folder with CamVid's images and labels in it";
        return Err(JudgeError::unexpected(root, "labels in a folder of that name, or …_L.png", "none", remedy));
    }
    let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().trim_end_matches("_L").to_owned();
    let images: BTreeMap<String, &PathBuf> = images.iter().map(|path| (stem(path), path)).collect();
    let colors: BTreeSet<[u8; 3]> = COLORS.lines().skip(1).filter_map(color).collect();
    let classes = ClassMap::named("camvid").expect("a built-in map");
    let image_of = |path: &Path| images.get(&stem(path)).map(|image| (*image).clone());
    let look = |path: &Path, notes: &mut Notes| look(path, &classes, &colors, notes);
    let labels: Vec<&PathBuf> = labels.iter().collect();
    let mut audit = Audit { frames: labels.len(), ..Audit::default() };
    check_all(root, &labels, image_of, look, progress)?.into_iter().for_each(|notes| audit.add(notes));
    Ok(audit.finish())
}

/// The colour of a line of the table: red, green, blue and a name.
fn color(line: &str) -> Option<[u8; 3]> {
    let mut numbers = line.split('\t').map(str::parse);
    Some([numbers.next()?.ok()?, numbers.next()?.ok()?, numbers.next()?.ok()?])
}

fn look(
    path: &Path,
    classes: &ClassMap,
    colors: &BTreeSet<[u8; 3]>,
    notes: &mut Notes,
) -> Result<Raster<u8>, JudgeError> {
    Ok(match read(path)? {
        DynamicImage::ImageRgb8(picture) => {
            notes.look(Check::Classes);
            // Colours of a table become numbers, in the order in which they are met.
            let mut met = BTreeMap::new();
            let mut strange = Vec::new();
            let mut ids = Vec::with_capacity(picture.as_raw().len() / 3);
            for (x, y, pixel) in picture.enumerate_pixels() {
                let next = met.len();
                let id = *met.entry(pixel.0).or_insert(next);
                if !colors.contains(&pixel.0) {
                    strange.push([x, y]);
                }
                ids.push(id.min(255) as u8);
            }
            if let Some([x, y]) = strange.first() {
                let (found, count) = (picture.get_pixel(*x, *y).0, strange.len());
                let what = format!("expected CamVid's colours, found {found:?} and the like on {count} pixels");
                notes.found(Check::Classes, 1.0, what, strange);
            }
            Raster { width: picture.width(), height: picture.height(), data: ids }
        }
        _ => {
            let labels = read_labels(path)?;
            known(&labels, classes, notes);
            labels
        }
    })
}

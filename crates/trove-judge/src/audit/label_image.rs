//! Label images in others' forms: what Cityscapes, CamVid and KITTI share.

use std::path::{Path, PathBuf};

use trove_model::{ClassMap, Raster};

use super::finding::{Check, Notes};
use super::frame::pixels;
use super::image;
use crate::pictures::{each, name, read};
use crate::{JudgeError, OnProgress};

/// Looks at label files, each with its image; `look` says what is wrong with the labels and gives them back.
pub(super) fn check_all(
    root: &Path,
    labels: &[&PathBuf],
    image_of: impl Fn(&Path) -> Option<PathBuf> + Sync,
    look: impl Fn(&Path, &mut Notes) -> Result<Raster<u8>, JudgeError> + Sync,
    progress: OnProgress,
) -> Result<Vec<Notes>, JudgeError> {
    let below = |path: &Path| path.strip_prefix(root).unwrap_or(path).to_string_lossy().into_owned();
    let one = |path: &&PathBuf| {
        let image = image_of(path);
        let mut notes = Notes::of(below(path), Some(below(image.as_deref().unwrap_or(path))));
        notes.look(Check::Files);
        let looked = look(path, &mut notes).and_then(|labels| match &image {
            Some(image) => shows(&labels, image, &mut notes),
            None => {
                notes.wrong(Check::Files, "expected the image of these labels, found none");
                Ok(())
            }
        });
        if let Err(damage) = looked {
            notes.wrong(Check::Files, damage.to_string());
        }
        Ok(notes)
    };
    each(labels, progress, one)
}

/// Every number is in the table of classes.
pub(super) fn known(labels: &Raster<u8>, classes: &ClassMap, notes: &mut Notes) {
    notes.look(Check::Classes);
    let mut is_known = [false; 256];
    for id in classes.classes.iter().map(|class| class.id).chain(classes.ignored()) {
        is_known[usize::from(id)] = true;
    }
    let strange: Vec<_> = pixels(labels).filter(|(_, id)| !is_known[usize::from(**id)]).collect();
    if let Some((_, first)) = strange.first() {
        let (count, map) = (strange.len(), &classes.name);
        let what = format!("expected ids of {map}, found {first} and the like on {count} pixels");
        notes.found(Check::Classes, 1.0, what, strange.into_iter().map(|(pixel, _)| pixel).collect());
    }
}

/// Another image of the same labels says the same of every pixel; `name` and `expected` are for the finding.
pub(super) fn agree<T>(
    labels: &Raster<u8>,
    others: &Raster<T>,
    is_right: impl Fn(u8, &T) -> bool,
    check: Check,
    [name, expected]: [&str; 2],
    notes: &mut Notes,
) {
    notes.look(check);
    if (others.width, others.height) != (labels.width, labels.height) {
        return notes.wrong(Check::Files, format!("{name}: expected the labels' size, found another"));
    }
    let wrong = pixels(labels).zip(&others.data).filter(|((_, id), other)| !is_right(**id, other));
    let wrong: Vec<_> = wrong.map(|((pixel, _), _)| pixel).collect();
    if !wrong.is_empty() {
        let what = format!("{name}: expected {expected}, found others on {} pixels", wrong.len());
        notes.found(check, 1.0, what, wrong);
    }
}

/// Reads ids of 16 bits.
pub(super) fn read_ids(path: &Path) -> Result<Raster<u16>, JudgeError> {
    let ids = read(path)?.into_luma16();
    Ok(Raster { width: ids.width(), height: ids.height(), data: ids.into_raw() })
}

/// An image is as large as its labels, and shows something.
fn shows(labels: &Raster<u8>, path: &Path, notes: &mut Notes) -> Result<(), JudgeError> {
    let picture = read(path)?.into_rgb8();
    let (width, height) = picture.dimensions();
    if (width, height) != (labels.width, labels.height) {
        let expected = format!("{}×{} pixels as in its labels", labels.width, labels.height);
        notes.wrong(Check::Files, format!("{}: expected {expected}, found {width}×{height}", name(path)));
        return Ok(());
    }
    let raster = Raster { width, height, data: picture.as_raw().as_chunks().0.to_vec() };
    image::check(&raster, Some(labels), notes);
    Ok(())
}

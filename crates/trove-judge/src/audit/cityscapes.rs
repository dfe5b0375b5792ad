//! Roots of Cityscapes' form: `…_labelIds.png`, `…_instanceIds.png`, `…_labelTrainIds.png`, `…_polygons.json` and images.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use trove_files::{Budget, LARGEST_TEXT, read_text};
use trove_model::{ClassMap, Raster};

use super::finding::{Audit, Check, Notes};
use super::image;
use super::polygons::paint_with_rim;
use crate::pictures::{Labels, each, files, name, read, read_labels};
use crate::{JudgeError, OnProgress};

const LABELS: &str = "_labelIds.png";
/// Polygons painted anew differ at their rims.
const PAINTED: f64 = 0.97;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Outlines {
    img_height: u32,
    img_width: u32,
    objects: Vec<Outline>,
}

#[derive(Deserialize)]
struct Outline {
    label: String,
    polygon: Vec<[f64; 2]>,
    #[serde(default)]
    deleted: u8,
}

/// Looks at all labels below a folder.
pub(super) fn audit(root: &Path, progress: OnProgress) -> Result<Audit, JudgeError> {
    let all = files(root, &["png", "jpg", "json"])?;
    let labels: Vec<&PathBuf> = all.iter().filter(|path| name(path).ends_with(LABELS)).collect();
    if labels.is_empty() {
        let remedy = "give the folder with gtFine and leftImg8bit in it";
        return Err(JudgeError::unexpected(root, "files …_labelIds.png", "none", remedy));
    }
    let images = all.iter().filter(|path| name(path).contains("_leftImg8bit.") || name(path).contains("_rgb_anon."));
    let key = |path: &Path| name(path).splitn(4, '_').take(3).collect::<Vec<_>>().join("_");
    let images: BTreeMap<String, &PathBuf> = images.map(|path| (key(path), path)).collect();
    let classes = ClassMap::named("cityscapes").expect("a built-in map");
    let one = |path: &&PathBuf| {
        let below = |path: &Path| path.strip_prefix(root).unwrap_or(path).to_string_lossy().into_owned();
        let image = images.get(&key(path)).copied();
        let shown = image.map_or_else(|| below(path), |image| below(image));
        let mut notes = Notes::of(below(path), Some(shown));
        if let Err(damage) = look(path, image, &classes, &mut notes) {
            notes.wrong(Check::Files, damage.to_string());
        }
        Ok(notes)
    };
    let mut audit = Audit { frames: labels.len(), ..Audit::default() };
    each(&labels, progress, one)?.into_iter().for_each(|notes| audit.add(notes));
    Ok(audit.finish())
}

fn look(path: &Path, image: Option<&PathBuf>, classes: &ClassMap, notes: &mut Notes) -> Result<(), JudgeError> {
    notes.look(Check::Files);
    let labels = read_labels(path)?;
    known(&labels, classes, notes);
    let beside = |ending: &str| path.with_file_name(name(path).replace(LABELS, ending));
    let instances = beside("_instanceIds.png");
    if instances.is_file() {
        agree(&labels, &read(&instances)?.into_luma16(), notes);
    }
    let training = beside("_labelTrainIds.png");
    if training.is_file() {
        trained(&labels, &read_labels(&training)?, classes, notes);
    }
    let outlines = beside("_polygons.json");
    if outlines.is_file() {
        let text = read_text(&outlines, LARGEST_TEXT).map_err(JudgeError::io(&outlines))?;
        match serde_json::from_str::<Outlines>(&text) {
            Ok(outlines) => painted(&labels, &outlines, classes, &Budget::of_file(text.len() as u64), notes),
            Err(e) => notes.wrong(Check::Files, format!("{}: {e}", name(&outlines))),
        }
    }
    match image {
        Some(image) => shows(&labels, image, notes)?,
        None => notes.wrong(Check::Files, "expected the image of these labels (…_leftImg8bit.png), found none"),
    }
    Ok(())
}

/// Every number is in the table of classes.
pub(super) fn known(labels: &Labels, classes: &ClassMap, notes: &mut Notes) {
    notes.look(Check::Classes);
    let mut is_known = [false; 256];
    classes
        .classes
        .iter()
        .map(|class| class.id)
        .chain(classes.ignored())
        .for_each(|id| is_known[usize::from(id)] = true);
    let pixels = |i: usize| [i as u32 % labels.width, i as u32 / labels.width];
    let strange: Vec<_> = (0..labels.ids.len()).filter(|i| !is_known[usize::from(labels.ids[*i])]).collect();
    if let Some(first) = strange.first() {
        let (count, id, map) = (strange.len(), labels.ids[*first], &classes.name);
        let what = format!("expected ids of {map}, found {id} and the like on {count} pixels");
        notes.found(Check::Classes, 1.0, what, strange.into_iter().map(pixels).collect());
    }
}

fn agree(labels: &Labels, instances: &::image::ImageBuffer<::image::Luma<u16>, Vec<u16>>, notes: &mut Notes) {
    notes.look(Check::Panoptic);
    if instances.dimensions() != (labels.width, labels.height) {
        return notes.wrong(Check::Files, "instanceIds: expected the labels' size, found another");
    }
    let class = |id: u16| if id < 1000 { id } else { id / 1000 };
    let wrong = (0..labels.ids.len()).filter(|i| class(instances.as_raw()[*i]) != u16::from(labels.ids[*i]));
    let wrong: Vec<_> = wrong.map(|i| [i as u32 % labels.width, i as u32 / labels.width]).collect();
    if !wrong.is_empty() {
        let what = format!("instanceIds: expected the classes of labelIds, found others on {} pixels", wrong.len());
        notes.found(Check::Panoptic, 1.0, what, wrong);
    }
}

fn trained(labels: &Labels, training: &Labels, classes: &ClassMap, notes: &mut Notes) {
    notes.look(Check::Classes);
    if (labels.width, labels.height) != (training.width, training.height) {
        return notes.wrong(Check::Files, "labelTrainIds: expected the labels' size, found another");
    }
    let train_ids = classes.train_ids();
    let right = |i: &usize| train_ids[usize::from(labels.ids[*i])].unwrap_or(255) == training.ids[*i];
    let wrong: Vec<_> = (0..labels.ids.len()).filter(|i| !right(i)).collect();
    if !wrong.is_empty() {
        let what = format!("labelTrainIds: expected those of labelIds, found others on {} pixels", wrong.len());
        let pixels = wrong.into_iter().map(|i| [i as u32 % labels.width, i as u32 / labels.width]).collect();
        notes.found(Check::Classes, 1.0, what, pixels);
    }
}

fn painted(labels: &Labels, outlines: &Outlines, classes: &ClassMap, steps: &Budget, notes: &mut Notes) {
    notes.look(Check::Outlines);
    let (width, height) = (labels.width, labels.height);
    if (outlines.img_width, outlines.img_height) != (width, height) {
        return notes.wrong(Check::Outlines, "polygons.json: expected the labels' size, found another");
    }
    let mut canvas = Raster::filled(width, height, 0u8);
    for outline in outlines.objects.iter().filter(|outline| outline.deleted == 0) {
        // A group of things is written with "group" behind.
        let label = outline.label.strip_suffix("group").unwrap_or(&outline.label);
        let Some(class) = classes.classes.iter().find(|class| class.name == label || class.name == outline.label)
        else {
            if label != "license plate" {
                notes.wrong(Check::Outlines, format!("polygons.json: expected a class of Cityscapes, found {label:?}"));
            }
            continue;
        };
        if paint_with_rim(&mut canvas, &outline.polygon, class.id, steps).is_err() {
            return notes
                .wrong(Check::Outlines, "polygons.json: expected fewer outlines, found more than can be painted");
        }
    }
    let wrong: Vec<_> = (0..labels.ids.len()).filter(|i| canvas.data[*i] != labels.ids[*i]).collect();
    let share = 1.0 - wrong.len() as f64 / labels.ids.len().max(1) as f64;
    if share < PAINTED {
        let what = format!("polygons.json: expected labelIds when painted, found them on {:.1} %", 100.0 * share);
        let pixels = wrong.into_iter().map(|i| [i as u32 % width, i as u32 / width]).collect();
        notes.found(Check::Outlines, 1.0 - share, what, pixels);
    }
}

/// An image is there, as large as its labels, and shows something.
pub(super) fn shows(labels: &Labels, path: &Path, notes: &mut Notes) -> Result<(), JudgeError> {
    let picture = read(path)?.into_rgb8();
    if picture.dimensions() != (labels.width, labels.height) {
        let (width, height) = picture.dimensions();
        let expected = format!("{}×{} pixels as in its labels", labels.width, labels.height);
        notes.wrong(Check::Files, format!("{}: expected {expected}, found {width}×{height}", name(path)));
        return Ok(());
    }
    let raster = Raster { width: labels.width, height: labels.height, data: picture.as_raw().as_chunks().0.to_vec() };
    let classes = Raster { width: labels.width, height: labels.height, data: labels.ids.clone() };
    image::check(&raster, Some(&classes), notes);
    Ok(())
}

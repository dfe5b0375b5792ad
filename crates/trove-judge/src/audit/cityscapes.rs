//! Roots of Cityscapes' form: `…_labelIds.png`, `…_instanceIds.png`, `…_labelTrainIds.png`, `…_polygons.json` and images.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use trove_files::{Budget, LARGEST_TEXT, read_text};
use trove_model::{ClassMap, Raster};

use super::finding::{Audit, Check, Notes};
use super::frame::pixels;
use super::label_image::{agree, check_all, known, read_ids};
use super::polygons::paint_with_rim;
use crate::pictures::{files, name, read_labels};
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
    let image_of = |path: &Path| images.get(&key(path)).map(|image| (*image).clone());
    let look = |path: &Path, notes: &mut Notes| look(path, &classes, notes);
    let mut audit = Audit { frames: labels.len(), ..Audit::default() };
    check_all(root, &labels, image_of, look, progress)?.into_iter().for_each(|notes| audit.add(notes));
    Ok(audit.finish())
}

fn look(path: &Path, classes: &ClassMap, notes: &mut Notes) -> Result<Raster<u8>, JudgeError> {
    let labels = read_labels(path)?;
    known(&labels, classes, notes);
    let beside = |ending: &str| path.with_file_name(name(path).replace(LABELS, ending));
    let instances = beside("_instanceIds.png");
    if instances.is_file() {
        let class = |instance: u16| if instance < 1000 { instance } else { instance / 1000 };
        let is_right = |id: u8, instance: &u16| class(*instance) == u16::from(id);
        let said = ["instanceIds", "the classes of labelIds"];
        agree(&labels, &read_ids(&instances)?, is_right, Check::Panoptic, said, notes);
    }
    let training = beside("_labelTrainIds.png");
    if training.is_file() {
        let train_ids = classes.train_ids();
        let is_right = |id: u8, train_id: &u8| train_ids[usize::from(id)].unwrap_or(255) == *train_id;
        let said = ["labelTrainIds", "those of labelIds"];
        agree(&labels, &read_labels(&training)?, is_right, Check::Classes, said, notes);
    }
    let outlines = beside("_polygons.json");
    if outlines.is_file() {
        let text = read_text(&outlines, LARGEST_TEXT).map_err(JudgeError::io(&outlines))?;
        match serde_json::from_str::<Outlines>(&text) {
            Ok(outlines) => painted(&labels, &outlines, classes, &Budget::of_file(text.len() as u64), notes),
            Err(e) => notes.wrong(Check::Files, format!("{}: {e}", name(&outlines))),
        }
    }
    Ok(labels)
}

fn painted(labels: &Raster<u8>, outlines: &Outlines, classes: &ClassMap, steps: &Budget, notes: &mut Notes) {
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
    let wrong = pixels(labels).zip(&canvas.data).filter(|((_, id), painted)| id != painted);
    let wrong: Vec<_> = wrong.map(|((pixel, _), _)| pixel).collect();
    let share = 1.0 - wrong.len() as f64 / labels.data.len().max(1) as f64;
    if share < PAINTED {
        let what = format!("polygons.json: expected labelIds when painted, found them on {:.1} %", 100.0 * share);
        notes.found(Check::Outlines, 1.0 - share, what, wrong);
    }
}

//! Roots of COCO's form: `annotations/*.json` with instances, keypoints or panoptic segments, and images.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::Deserialize;
use trove_files::{Budget, Exceeded, LARGEST_FILE, read_text};
use trove_model::Raster;

use super::finding::{Audit, Check, Notes};
use super::polygons::paint;
use super::rle::unpack;
use crate::pictures::{dimensions, files, name, read};
use crate::{JudgeError, OnProgress};

/// Boxes and areas of polygons are rounded; shares of the box's longer side and of the area.
const BOX: f64 = 0.05;
const AREA: f64 = 0.15;
/// Larger images than this are not painted, pixels.
const MOST_PIXELS: u64 = 1 << 26;

#[derive(Deserialize)]
struct Dataset {
    images: Vec<ImageRow>,
    annotations: Vec<Annotation>,
    categories: Vec<Category>,
}

#[derive(Deserialize)]
struct ImageRow {
    id: serde_json::Value,
    file_name: String,
    width: u32,
    height: u32,
}

#[derive(Deserialize)]
struct Category {
    id: u64,
}

#[derive(Deserialize)]
struct Annotation {
    #[serde(default)]
    id: Option<u64>,
    image_id: serde_json::Value,
    #[serde(default)]
    category_id: Option<u64>,
    #[serde(default)]
    bbox: Option<[f64; 4]>,
    #[serde(default)]
    area: Option<f64>,
    #[serde(default)]
    iscrowd: u8,
    #[serde(default)]
    segmentation: Option<Segmentation>,
    #[serde(default)]
    keypoints: Option<Vec<f64>>,
    #[serde(default)]
    num_keypoints: Option<usize>,
    #[serde(default)]
    file_name: Option<String>,
    #[serde(default)]
    segments_info: Option<Vec<Segment>>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Segmentation {
    Polygons(Vec<Vec<f64>>),
    Runs { size: [u32; 2], counts: Runs },
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Runs {
    Packed(String),
    Counts(Vec<u32>),
}

#[derive(Deserialize)]
struct Segment {
    id: u32,
    category_id: u64,
    #[serde(default)]
    area: Option<f64>,
    #[serde(default)]
    bbox: Option<[f64; 4]>,
}

/// Looks at all annotations below a folder.
pub(super) fn audit(root: &Path, progress: OnProgress) -> Result<Audit, JudgeError> {
    let all = files(root, &["json", "png", "jpg", "jpeg"])?;
    let (lists, pictures): (Vec<_>, Vec<_>) = all.into_iter().partition(|path| name(path).ends_with(".json"));
    let mut by_name = BTreeMap::<String, Vec<&PathBuf>>::new();
    for path in &pictures {
        by_name.entry(name(path)).or_default().push(path);
    }
    let mut audit = Audit::default();
    for path in &lists {
        let below = path.strip_prefix(root).unwrap_or(path).to_string_lossy().into_owned();
        let text = read_text(path, LARGEST_FILE).map_err(JudgeError::io(path))?;
        // Other JSON files lie about: captions, or what an export tells of itself.
        let is_list = text.contains("\"annotations\"") && text.contains("\"images\"");
        if !is_list {
            continue;
        }
        let mut notes = Notes::of(&below, None);
        notes.look(Check::Files);
        match serde_json::from_str::<Dataset>(&text) {
            Ok(dataset) => {
                audit.frames += dataset.images.len();
                let steps = Budget::of_file(text.len() as u64);
                look(root, &dataset, &by_name, &below, &steps, progress, &mut audit)?;
            }
            Err(e) => {
                notes.wrong(Check::Files, format!("expected COCO's images, annotations and categories, found: {e}"))
            }
        }
        audit.add(notes);
    }
    if audit.tallies.is_empty() {
        let remedy = "give the folder with annotations/*.json in it";
        return Err(JudgeError::unexpected(root, "COCO's annotations", "none", remedy));
    }
    Ok(audit.finish())
}

fn look(
    root: &Path,
    dataset: &Dataset,
    pictures: &BTreeMap<String, Vec<&PathBuf>>,
    list: &str,
    steps: &Budget,
    progress: OnProgress,
    audit: &mut Audit,
) -> Result<(), JudgeError> {
    let categories: BTreeSet<u64> = dataset.categories.iter().map(|category| category.id).collect();
    let mut of_image = BTreeMap::<String, Vec<&Annotation>>::new();
    for annotation in &dataset.annotations {
        of_image.entry(annotation.image_id.to_string()).or_default().push(annotation);
    }
    let mut ids = BTreeSet::new();
    let mut whole = Notes::of(list, None);
    whole.look(Check::Ids);
    for id in dataset.annotations.iter().filter_map(|annotation| annotation.id) {
        if !ids.insert(id) {
            whole.wrong(Check::Ids, format!("annotation {id}: expected each id once, found it again"));
        }
    }
    // The end of the path tells which of several pictures of one name is meant.
    let find = |file: &str| {
        let file_name = Path::new(file).file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let all = pictures.get(&file_name)?;
        all.iter().find(|path| path.ends_with(file)).or(all.first()).copied()
    };
    for (done, image) in dataset.images.iter().enumerate() {
        if !progress(done + 1, dataset.images.len()) {
            return Err(JudgeError::Ended);
        }
        let file = find(&image.file_name);
        let shown = file.map(|file| file.strip_prefix(root).unwrap_or(file).to_string_lossy().into_owned());
        let mut notes = Notes::of(format!("{list}: {}", image.file_name), shown);
        notes.look(Check::Files);
        let size = file.and_then(|file| dimensions(file));
        if size != Some((image.width, image.height)) {
            let expected = format!("an image of {}×{} pixels", image.width, image.height);
            notes.wrong(Check::Files, format!("expected {expected}, found {size:?}"));
        }
        let too_large = u64::from(image.width) * u64::from(image.height) > MOST_PIXELS;
        let annotations = of_image.remove(&image.id.to_string()).unwrap_or_default();
        for annotation in annotations.iter().filter(|_| !too_large) {
            if check(image, annotation, &categories, steps, &mut notes).is_err() {
                notes.wrong(Check::Masks, "expected fewer masks, found more than can be painted; the rest is left out");
                break;
            }
            if let (Some(segments), Some(name)) = (&annotation.segments_info, &annotation.file_name) {
                panoptic(image, segments, find(name), &categories, &mut notes);
            }
        }
        audit.add(notes);
    }
    for image in of_image.keys() {
        whole.wrong(Check::Ids, format!("annotations of image {image}, which is not listed"));
    }
    audit.add(whole);
    Ok(())
}

fn check(
    image: &ImageRow,
    annotation: &Annotation,
    categories: &BTreeSet<u64>,
    steps: &Budget,
    notes: &mut Notes,
) -> Result<(), Exceeded> {
    let told = annotation.id.map_or_else(|| "annotation".to_owned(), |id| format!("annotation {id}"));
    notes.look(Check::Classes);
    if annotation.category_id.is_some_and(|id| !categories.contains(&id)) {
        notes.wrong(Check::Classes, format!("{told}: category {:?} is not listed", annotation.category_id));
    }
    if let Some(points) = &annotation.keypoints {
        keypoints(image, annotation, points, &told, notes);
    }
    let (Some(segmentation), Some([x, y, width, height])) = (&annotation.segmentation, annotation.bbox) else {
        return Ok(());
    };
    notes.look(Check::Masks);
    steps.take(image.width as usize, image.height as usize)?;
    let mask = match mask(image, segmentation, steps)? {
        Ok(mask) => mask,
        Err(what) => {
            notes.wrong(Check::Masks, format!("{told}: {what}"));
            return Ok(());
        }
    };
    let Some(around) = around(&mask) else {
        // A polygon thinner than a pixel covers no centre.
        if annotation.area.is_some_and(|area| area > 4.0) {
            notes.wrong(Check::Masks, format!("{told}: expected a mask, found none"));
        }
        return Ok(());
    };
    let told_box = [x, y, x + width, y + height];
    let room = 1.5 + BOX * width.max(height);
    let apart = around.iter().zip(told_box).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if annotation.iscrowd == 0 && is_off(apart, room) {
        notes.wrong(Check::Masks, format!("{told}: bbox: expected {around:?} as the mask is, found {told_box:?}"));
    }
    let pixels = mask.data.iter().filter(|is_in| **is_in).count() as f64;
    let outline = 2.0 * (width + height);
    if annotation.area.is_some_and(|area| is_off((area - pixels).abs(), AREA * pixels + outline)) {
        let area = annotation.area.unwrap_or_default();
        notes.wrong(Check::Masks, format!("{told}: area: expected {pixels} as the mask has, found {area}"));
    }
    Ok(())
}

/// The pixels of a mask; what is wrong with it.
fn mask(
    image: &ImageRow,
    segmentation: &Segmentation,
    steps: &Budget,
) -> Result<Result<Raster<bool>, String>, Exceeded> {
    let mut mask = Raster::filled(image.width, image.height, false);
    let (size, counts) = match segmentation {
        Segmentation::Polygons(polygons) => {
            for polygon in polygons {
                paint(&mut mask, polygon.as_chunks::<2>().0, true, steps)?;
            }
            return Ok(Ok(mask));
        }
        Segmentation::Runs { size, counts } => (size, counts),
    };
    if *size != [image.height, image.width] {
        return Ok(Err(format!("expected a mask of the image's size, found {size:?}")));
    }
    let counts = match counts {
        Runs::Counts(counts) => Some(counts.clone()),
        Runs::Packed(text) => unpack(text),
    };
    let all = |counts: &Vec<u32>| counts.iter().map(|count| u64::from(*count)).sum::<u64>();
    let Some(counts) = counts.filter(|counts| all(counts) == mask.data.len() as u64) else {
        return Ok(Err("expected runs that fill the image, found others".into()));
    };
    let mut at = 0;
    for (i, count) in counts.iter().enumerate() {
        let end = at + *count as usize;
        // Columns first.
        for pixel in (at..end).filter(|_| i % 2 == 1) {
            *mask.at_mut((pixel / image.height as usize) as u32, (pixel % image.height as usize) as u32) = true;
        }
        at = end;
    }
    Ok(Ok(mask))
}

/// Whether a difference is too large, or none that can be told.
fn is_off(apart: f64, room: f64) -> bool {
    apart.is_nan() || apart > room
}

/// Left, top, right and bottom of what is true.
fn around(mask: &Raster<bool>) -> Option<[f64; 4]> {
    let mut around = None::<[u32; 4]>;
    for ([x, y], _) in super::frame::pixels(mask).filter(|(_, is_in)| **is_in) {
        let [x0, y0, x1, y1] = around.unwrap_or([x, y, x + 1, y + 1]);
        around = Some([x0.min(x), y0.min(y), x1.max(x + 1), y1.max(y + 1)]);
    }
    around.map(|around| around.map(f64::from))
}

fn keypoints(image: &ImageRow, annotation: &Annotation, points: &[f64], told: &str, notes: &mut Notes) {
    notes.look(Check::Keypoints);
    let (triples, rest) = points.as_chunks::<3>();
    let labelled = triples.iter().filter(|[_, _, seen]| *seen > 0.0);
    if !rest.is_empty() || annotation.num_keypoints.is_some_and(|count| count != labelled.clone().count()) {
        notes.wrong(Check::Keypoints, format!("{told}: expected num_keypoints to count those that are labelled"));
    }
    let (width, height) = (f64::from(image.width), f64::from(image.height));
    if labelled.clone().any(|[x, y, _]| !(0.0..=width).contains(x) || !(0.0..=height).contains(y)) {
        notes.wrong(Check::Keypoints, format!("{told}: expected keypoints in the image, found others"));
    }
    let Some([x, y, box_width, box_height]) = annotation.bbox else { return };
    let room = 0.25 * box_width.max(box_height) + 4.0;
    let is_near = |[px, py, seen]: &[f64; 3]| {
        *seen < 2.0
            || ((x - room..=x + box_width + room).contains(px) && (y - room..=y + box_height + room).contains(py))
    };
    if !labelled.clone().all(is_near) {
        notes.wrong(Check::Keypoints, format!("{told}: expected visible keypoints in the box, found others"));
    }
}

fn panoptic(
    image: &ImageRow,
    segments: &[Segment],
    file: Option<&PathBuf>,
    categories: &BTreeSet<u64>,
    notes: &mut Notes,
) {
    notes.look(Check::Panoptic);
    let Some(picture) = file.and_then(|file| read(file).ok()).map(|picture| picture.into_rgb8()) else {
        return notes.wrong(Check::Panoptic, "expected the PNG of these segments, found none");
    };
    if picture.dimensions() != (image.width, image.height) {
        return notes.wrong(Check::Panoptic, "expected segments of the image's size, found another");
    }
    let mut areas = BTreeMap::<u32, (f64, [u32; 4])>::new();
    for (x, y, pixel) in picture.enumerate_pixels() {
        let id = u32::from_le_bytes([pixel.0[0], pixel.0[1], pixel.0[2], 0]);
        let (area, [x0, y0, x1, y1]) = areas.entry(id).or_insert((0.0, [x, y, x + 1, y + 1]));
        *area += 1.0;
        (*x0, *y0, *x1, *y1) = ((*x0).min(x), (*y0).min(y), (*x1).max(x + 1), (*y1).max(y + 1));
    }
    areas.remove(&0);
    for segment in segments {
        let id = segment.id;
        if !categories.contains(&segment.category_id) {
            notes.wrong(Check::Classes, format!("segment {id}: category {} is not listed", segment.category_id));
        }
        let Some((area, [x0, y0, x1, y1])) = areas.remove(&id) else {
            notes.wrong(Check::Panoptic, format!("segment {id}: expected it in the PNG, found it nowhere"));
            continue;
        };
        if segment.area.is_some_and(|told| told != area) {
            notes.wrong(Check::Panoptic, format!("segment {id}: area: expected {area}, found {:?}", segment.area));
        }
        let expected = [x0, y0, x1 - x0, y1 - y0].map(f64::from);
        let differs = |told: [f64; 4]| told.iter().zip(expected).any(|(a, b)| is_off((a - b).abs(), 1.0));
        if segment.bbox.is_some_and(differs) {
            notes
                .wrong(Check::Panoptic, format!("segment {id}: bbox: expected {expected:?}, found {:?}", segment.bbox));
        }
    }
    if let Some(id) = areas.keys().next() {
        notes.wrong(Check::Panoptic, format!("segment {id} in the PNG is not listed"));
    }
}

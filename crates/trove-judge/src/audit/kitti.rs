//! Roots of KITTI's form: `label_2` or `label_02` with boxes, `calib`, images; `semantic` and `instance` where there are any.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::{DMat3, DVec3, DVec4};
use trove_files::{LARGEST_TEXT, read_text};
use trove_model::ClassMap;

use super::finding::{Audit, Check, Notes};
use super::label_image::{agree, check_all, known, read_ids};
use super::tracks::jump;
use crate::pictures::{each, files, name, read_labels};
use crate::{JudgeError, OnProgress};

/// KITTI's words for what it annotates.
const TYPES: [&str; 10] =
    ["Car", "Van", "Truck", "Pedestrian", "Person", "Person_sitting", "Cyclist", "Tram", "Misc", "DontCare"];
/// The observation angle is rotation minus bearing; annotators' angles are rounded, and some are a few degrees off, radians.
const ANGLE_RAD: f64 = 0.35;
/// Overlap of what was drawn with the projected 3D box, of whole objects that nothing hides.
const OVERLAP: f64 = 0.4;
/// KITTI's benchmark looks at nothing lower than this.
const EVALUATED_PX: f64 = 25.0;
/// Nanoseconds from frame to frame.
const FRAME_NS: i64 = 100_000_000;

/// A line of a label file, without the frame and the track that it begins with in sequences.
#[derive(Clone, Debug)]
struct Labelled {
    kind: String,
    truncation: f64,
    occlusion: f64,
    alpha: f64,
    around: [f64; 4],
    /// Height, width, length.
    size_m: [f64; 3],
    /// Middle of the bottom, in the rectified camera.
    bottom_m: DVec3,
    rotation_y: f64,
}

/// A file of boxes, and what is needed to project them.
struct Boxes {
    path: PathBuf,
    is_sequence: bool,
    calibration: Option<PathBuf>,
}

/// Looks at all labels below a folder.
pub(super) fn audit(root: &Path, progress: OnProgress) -> Result<Audit, JudgeError> {
    let all = files(root, &["txt", "png"])?;
    let folder = |path: &Path| path.parent().map(name).unwrap_or_default();
    let of = |names: &'static [&'static str]| all.iter().filter(move |path| names.contains(&folder(path).as_str()));
    let boxes = of(&["label_2", "label_02"]).map(|path| {
        let calibration = path.parent().and_then(Path::parent).map(|split| split.join("calib").join(name(path)));
        Boxes { path: path.clone(), is_sequence: folder(path) == "label_02", calibration }
    });
    let boxes: Vec<Boxes> = boxes.collect();
    let semantic: Vec<&PathBuf> = of(&["semantic"]).collect();
    if boxes.is_empty() && semantic.is_empty() {
        let remedy = "give the folder with training/label_2, training/label_02 or semantic in it";
        return Err(JudgeError::unexpected(root, "KITTI's labels", "none", remedy));
    }
    let below = |path: &Path| path.strip_prefix(root).unwrap_or(path).to_string_lossy().into_owned();
    let one = |boxes: &Boxes| {
        let mut notes = Notes::of(below(&boxes.path), None);
        if let Err(damage) = look(boxes, &mut notes) {
            notes.wrong(Check::Files, damage);
        }
        Ok(notes)
    };
    let classes = ClassMap::named("cityscapes").expect("a built-in map");
    let beside = |path: &Path, other: &str| {
        let beside = path.parent().and_then(Path::parent).map(|split| split.join(other).join(name(path)));
        beside.filter(|path| path.is_file())
    };
    let seen = |path: &Path, notes: &mut Notes| {
        let labels = read_labels(path)?;
        known(&labels, &classes, notes);
        if let Some(instance) = beside(path, "instance") {
            // Instances are class · 256 + number.
            let is_right = |id: u8, instance: &u16| u16::from(id) == *instance / 256;
            let said = ["instance", "semantic's classes"];
            agree(&labels, &read_ids(&instance)?, is_right, Check::Panoptic, said, notes);
        }
        Ok(labels)
    };
    let image_of = |path: &Path| beside(path, "image_2");
    let mut audit = Audit { frames: boxes.len() + semantic.len(), ..Audit::default() };
    each(&boxes, progress, one)?.into_iter().for_each(|notes| audit.add(notes));
    check_all(root, &semantic, image_of, seen, progress)?.into_iter().for_each(|notes| audit.add(notes));
    Ok(audit.finish())
}

fn look(boxes: &Boxes, notes: &mut Notes) -> Result<(), String> {
    notes.look(Check::Files);
    let text = read_text(&boxes.path, LARGEST_TEXT).map_err(|e| format!("expected a text file, found \"{e}\""))?;
    let calibration = boxes.calibration.as_ref().filter(|path| path.is_file());
    let camera = match calibration.map(|path| read_text(path, LARGEST_TEXT)) {
        Some(Ok(text)) => camera(&text),
        _ => None,
    };
    notes.look(Check::Camera);
    if camera.is_none() {
        notes.wrong(Check::Camera, "expected a calibration with P2 in calib, found none");
    }
    let mut tracks = BTreeMap::<i64, (String, Vec<(i64, DVec3)>)>::new();
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let (head, words) = words.split_at(if boxes.is_sequence { words.len().min(2) } else { 0 });
        let Some(labelled) = parsed(words) else {
            notes.wrong(Check::Files, format!("line {}: expected 15 words, found {line:?}", number + 1));
            continue;
        };
        check(&labelled, camera.as_ref(), number + 1, notes);
        if let [frame, track] = head
            && labelled.kind != "DontCare"
        {
            let (Ok(frame), Ok(track)) = (frame.parse::<i64>(), track.parse::<i64>()) else {
                notes.wrong(Check::Files, format!("line {}: expected frame and track, found {head:?}", number + 1));
                continue;
            };
            notes.look(Check::Tracks);
            let (kind, at) = tracks.entry(track).or_insert_with(|| (labelled.kind.clone(), Vec::new()));
            if *kind != labelled.kind {
                let what = format!("line {}: track {track}: expected {kind}, found {}", number + 1, labelled.kind);
                notes.wrong(Check::Tracks, what);
            }
            if at.last().is_some_and(|(time, _)| *time >= frame * FRAME_NS) {
                notes.wrong(Check::Tracks, format!("line {}: track {track}: expected one box a frame", number + 1));
                continue;
            }
            at.push((frame * FRAME_NS, labelled.bottom_m));
            if let Some(what) = jump(at) {
                notes.wrong(Check::Tracks, format!("line {}: track {track}: {what}", number + 1));
            }
        }
    }
    Ok(())
}

/// The rows of P2.
fn camera(text: &str) -> Option<[DVec4; 3]> {
    let line = text.lines().find_map(|line| line.strip_prefix("P2:"))?;
    let numbers: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let rows: Vec<DVec4> = numbers.as_chunks::<4>().0.iter().map(|row| DVec4::from_array(*row)).collect();
    rows.try_into().ok().filter(|rows: &[DVec4; 3]| rows[0].x > 0.0 && rows[1].y > 0.0)
}

fn parsed(words: &[&str]) -> Option<Labelled> {
    let [kind, numbers @ ..] = words else { return None };
    let numbers: Vec<f64> = numbers.iter().map(|word| word.parse().ok()).collect::<Option<_>>()?;
    let [truncation, occlusion, alpha, x0, y0, x1, y1, height, width, length, x, y, z, rotation_y, ..] = numbers[..]
    else {
        return None;
    };
    Some(Labelled {
        kind: (*kind).to_owned(),
        truncation,
        occlusion,
        alpha,
        around: [x0, y0, x1, y1],
        size_m: [height, width, length],
        bottom_m: DVec3::new(x, y, z),
        rotation_y,
    })
}

fn check(labelled: &Labelled, camera: Option<&[DVec4; 3]>, line: usize, notes: &mut Notes) {
    notes.look(Check::Classes);
    let Labelled { kind, around: [x0, y0, x1, y1], .. } = labelled;
    if !TYPES.contains(&kind.as_str()) {
        notes.wrong(Check::Classes, format!("line {line}: expected one of KITTI's types, found {kind:?}"));
    }
    notes.look(Check::Masks);
    if !(x0 <= x1 && y0 <= y1 && *x1 >= 0.0 && *y1 >= 0.0) {
        notes.wrong(Check::Masks, format!("line {line}: expected a box with left ≤ right and top ≤ bottom"));
    }
    if kind == "DontCare" {
        return;
    }
    if labelled.truncation > 2.0 || !(-1.0..=3.0).contains(&labelled.occlusion) {
        notes.wrong(Check::Masks, format!("line {line}: expected truncation and occlusion as KITTI counts them"));
    }
    notes.look(Check::Boxes);
    // What was drawn in the image alone has −1 or −1000 for the rest.
    if labelled.size_m.iter().any(|size| *size < 0.0) {
        return;
    }
    if labelled.size_m.iter().any(|size| !(0.05..30.0).contains(size)) {
        notes.wrong(Check::Boxes, format!("line {line}: expected a box of some size, found {:?} m", labelled.size_m));
        return;
    }
    let expected = labelled.rotation_y - labelled.bottom_m.x.atan2(labelled.bottom_m.z);
    let apart = (labelled.alpha - expected).rem_euclid(std::f64::consts::TAU);
    if apart.min(std::f64::consts::TAU - apart) > ANGLE_RAD {
        let what = format!("line {line}: alpha: expected {expected:.2}, found {:.2}", labelled.alpha);
        notes.wrong(Check::Boxes, what);
    }
    let is_whole = labelled.truncation == 0.0 && labelled.occlusion == 0.0 && y1 - y0 >= EVALUATED_PX;
    let Some(projected) = camera.filter(|_| is_whole).and_then(|camera| project(labelled, camera)) else { return };
    let overlap = overlap(projected, labelled.around);
    if overlap < OVERLAP {
        let what = format!("line {line}: {kind}: expected the 3D box in the 2D box, found an overlap of {overlap:.2}");
        notes.found(Check::Boxes, 1.0 - overlap, what, Vec::new());
    }
}

/// The box around a projected 3D box; `None` where a corner is behind the camera.
fn project(labelled: &Labelled, camera: &[DVec4; 3]) -> Option<[f64; 4]> {
    let [height, width, length] = labelled.size_m;
    let turn = DMat3::from_rotation_y(labelled.rotation_y);
    let mut around = [f64::MAX, f64::MAX, f64::MIN, f64::MIN];
    for corner in 0..8 {
        let side = |bit: u32| f64::from(corner >> bit & 1) - 0.5;
        let offset = DVec3::new(side(0) * length, (side(1) - 0.5) * height, side(2) * width);
        let point = (labelled.bottom_m + turn * offset).extend(1.0);
        let [u, v, w] = camera.map(|row| row.dot(point));
        if w < 0.5 {
            return None;
        }
        let (u, v) = (u / w, v / w);
        around = [around[0].min(u), around[1].min(v), around[2].max(u), around[3].max(v)];
    }
    Some(around)
}

/// Intersection over union.
fn overlap(a: [f64; 4], b: [f64; 4]) -> f64 {
    let area = |[x0, y0, x1, y1]: [f64; 4]| (x1 - x0).max(0.0) * (y1 - y0).max(0.0);
    let both = area([a[0].max(b[0]), a[1].max(b[1]), a[2].min(b[2]), a[3].min(b[3])]);
    both / (area(a) + area(b) - both).max(f64::MIN_POSITIVE)
}

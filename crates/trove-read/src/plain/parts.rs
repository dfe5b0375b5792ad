//! A file's text in parts that are read by themselves, so that a fault in one leaves the others to be looked at.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use serde_json::value::RawValue;
use trove_format::{PlainBox, PlainCamera, PlainDrive, PlainKeyframe, PlainPicture};

use super::faults::{Faults, Located, Part};

/// No rig has more.
const MOST_CAMERAS: usize = 100;

pub(super) type Moment<'a> = PlainKeyframe<Located<'a, PlainBox>, Located<'a, PlainPicture>>;

/// A drive with the places of its parts.
pub(super) struct Parts<'a> {
    /// What is said of the drive as a whole; its cameras and keyframes are taken out.
    pub(super) header: Located<'a, PlainDrive<(), ()>>,
    pub(super) cameras: BTreeMap<String, Located<'a, PlainCamera>>,
    pub(super) keyframes: Vec<Located<'a, Moment<'a>>>,
}

/// The parts of `drive.json`, or of `drive.jsonl` where the keyframes stand on lines of their own; `None` where nothing
/// can be read.
pub(super) fn read<'a>(text: &'a str, is_lines: bool, faults: &mut Faults<'a>) -> Option<Parts<'a>> {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let first = if is_lines { lines.next().unwrap_or_default() } else { text };
    let part = Part { text: first, path: String::new() };
    let drive: PlainDrive<&RawValue, &RawValue> = faults.read(&part)?;
    let PlainDrive {
        trove_drive,
        name,
        place,
        licence,
        georeference,
        ego_body,
        cameras,
        lane_map,
        path,
        sweeps,
        keyframes,
    } = drive;
    if trove_drive != PlainDrive::VERSION {
        faults.say(&part, &format!("trove_drive: expected {}, found {trove_drive}", PlainDrive::VERSION));
    }
    if cameras.len() > MOST_CAMERAS {
        faults.say(&part, &format!("cameras: expected at most {MOST_CAMERAS}, found {}", cameras.len()));
        return None;
    }
    if is_lines && !keyframes.is_empty() {
        faults.say(&part, "keyframes: expected one a line after this one, found them in it");
    }
    let mut read_cameras = BTreeMap::new();
    for (name, text) in cameras {
        if let Some(camera) = located(text, format!("cameras.{name}"), faults) {
            read_cameras.insert(name, camera);
        }
    }
    let texts: Vec<&str> = if is_lines { lines.collect() } else { keyframes.iter().map(|text| text.get()).collect() };
    if texts.is_empty() {
        faults.say(&part, "keyframes: expected at least one, found none");
    }
    let keyframes = texts.into_iter().enumerate();
    let keyframes = keyframes.filter_map(|(k, text)| moment(text, format!("keyframes[{k}]"), faults)).collect();
    let header = PlainDrive {
        trove_drive,
        name,
        place,
        licence,
        georeference,
        ego_body,
        cameras: BTreeMap::new(),
        lane_map,
        path,
        sweeps,
        keyframes: Vec::new(),
    };
    Some(Parts { header: Located { part, value: header }, cameras: read_cameras, keyframes })
}

fn moment<'a>(text: &'a str, path: String, faults: &mut Faults<'a>) -> Option<Located<'a, Moment<'a>>> {
    let part = Part { text, path };
    let moment: PlainKeyframe<&RawValue, &RawValue> = faults.read(&part)?;
    let PlainKeyframe { time_ns, token, world_from_ego, geo_from_ego, boxes, pictures, lidar } = moment;
    let boxes = boxes.into_iter().enumerate();
    let boxes = boxes.filter_map(|(i, text)| located(text, format!("{}.boxes[{i}]", part.path), faults)).collect();
    let pictures = pictures.map(|pictures| {
        let read = |(name, text): (String, &'a RawValue)| {
            let picture = located(text, format!("{}.pictures.{name}", part.path), faults)?;
            Some((name, picture))
        };
        pictures.into_iter().filter_map(read).collect()
    });
    let value = PlainKeyframe { time_ns, token, world_from_ego, geo_from_ego, boxes, pictures, lidar };
    Some(Located { part, value })
}

/// A part of a text that is read by itself; `None` where it cannot be.
fn located<'a, T: Deserialize<'a>>(
    text: &'a RawValue,
    path: String,
    faults: &mut Faults<'a>,
) -> Option<Located<'a, T>> {
    let part = Part { text: text.get(), path };
    let value = faults.read(&part)?;
    Some(Located { part, value })
}

/// How many keyframes a text has, without looking into them; 0 where it cannot be read.
pub(super) fn keyframes(text: &str, is_lines: bool) -> usize {
    if is_lines {
        return text.lines().filter(|line| !line.trim().is_empty()).count().saturating_sub(1);
    }
    let drive = serde_json::from_str::<PlainDrive<serde::de::IgnoredAny, serde::de::IgnoredAny>>(text);
    drive.map_or(0, |drive| drive.keyframes.len())
}

/// The name that a text gives its drive.
pub(super) fn name(text: &str, is_lines: bool) -> Option<String> {
    let first = if is_lines { text.lines().find(|line| !line.trim().is_empty())? } else { text };
    serde_json::from_str::<PlainDrive<serde::de::IgnoredAny, serde::de::IgnoredAny>>(first).ok()?.name
}

/// The LiDAR files and labels that a text names; those that can be read of it.
pub(super) fn lidar_files(text: &str, path: &Path) -> Vec<String> {
    let mut faults = Faults::of(text); // told when the drive is read
    let parts = read(text, path.extension().is_some_and(|e| e == "jsonl"), &mut faults);
    let lidars = parts.into_iter().flat_map(|Parts { header, keyframes, .. }| {
        let between = header.value.sweeps.into_iter().map(|sweep| sweep.lidar);
        keyframes.into_iter().filter_map(|k| k.value.lidar).chain(between)
    });
    lidars.flat_map(|lidar| [Some(lidar.file), lidar.labels]).flatten().collect()
}

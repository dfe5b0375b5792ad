//! `tracklet_labels.xml`: objects over time in the Velodyne's frame, as Boost serialises them.

use std::collections::BTreeMap;
use std::path::Path;

use glam::{DQuat, DVec3, EulerRot};
use quick_xml::Reader;
use quick_xml::events::Event;
use trove_files::{LARGEST_TEXT, read_text};
use trove_model::{Body, Outcome, Pose, Report, SensorFrame};

use super::text;
use crate::ReadError;

/// Boost's tree is four deep below its root; more is no list of tracklets.
const DEEPEST: usize = 16;
const LONGEST_BOX_M: f64 = 200.0;
const FARTHEST_M: f64 = 1000.0;
/// More poses than any drive has frames.
const MOST_FRAMES: usize = 1_000_000;

/// An object over time.
#[derive(Debug)]
pub(super) struct Tracklet {
    pub(super) category: String,
    pub(super) size_m: DVec3,
    pub(super) first_frame: usize,
    /// One a frame; `None` where it is none.
    pub(super) poses: Vec<Option<TrackletPose>>,
}

/// Where it was in a frame.
#[derive(Debug)]
pub(super) struct TrackletPose {
    pub(super) velodyne_from_body: Pose<SensorFrame, Body>,
    /// The numbers of truncation (0 in the picture, 1 truncated, 2 outside, 99 behind it) and occlusion.
    pub(super) truncation: String,
    pub(super) occlusion: String,
}

/// The words of an element's children by their names.
type Words = BTreeMap<String, String>;

/// Reads a file; an object that is damaged is left out and reported.
pub(super) fn read(path: &Path, report: &Report) -> Result<Vec<Tracklet>, ReadError> {
    let text = read_text(path, LARGEST_TEXT).map_err(|error| ReadError::io(path, error))?;
    let mut reader = Reader::from_str(&text);
    let damaged = |byte: u64, found: String| {
        text::damaged(path, &format!("byte {byte}"), "a whole list of tracklets (XML)", found)
    };
    let (mut open, mut tracklets) = (Vec::<String>::new(), Vec::new());
    let (mut object, mut pose, mut poses) = (Words::new(), Words::new(), Vec::new());
    loop {
        match reader.read_event() {
            Err(error) => return Err(damaged(reader.error_position(), error.to_string())),
            Ok(Event::Eof) => {
                let found = if open.is_empty() { "no element at all" } else { "the end of the file before its end" };
                return Err(damaged(reader.buffer_position(), found.to_owned()));
            }
            Ok(Event::Start(element)) => {
                open.push(element.name().as_ref().to_owned());
                if open.len() > DEEPEST {
                    return Err(damaged(reader.buffer_position(), "elements too deep in each other".to_owned()));
                }
            }
            Ok(Event::Text(words)) => {
                let words = || words.xml10_content().trim().to_owned();
                match below_tracklet(&open).as_slice() {
                    [name] => drop(object.insert((*name).to_owned(), words())),
                    ["poses", "item", name] => drop(pose.insert((*name).to_owned(), words())),
                    _ => {}
                }
            }
            Ok(Event::End(_)) => {
                match below_tracklet(&open).as_slice() {
                    [] if open.len() == 3 && open[2] == "item" => {
                        let name = format!("tracklet {}", tracklets.len());
                        let whole = tracklet(&std::mem::take(&mut object), std::mem::take(&mut poses), &name, report);
                        tracklets.push(whole);
                    }
                    ["poses", "item"] => poses.push(std::mem::take(&mut pose)),
                    _ => {}
                }
                open.pop();
                if open.is_empty() {
                    return Ok(tracklets.into_iter().flatten().collect());
                }
            }
            Ok(_) => {}
        }
    }
}

/// The names below a tracklet's own item; empty elsewhere.
fn below_tracklet(open: &[String]) -> Vec<&str> {
    match open {
        [_, list, item, below @ ..] if list == "tracklets" && item == "item" => {
            below.iter().map(String::as_str).collect()
        }
        _ => Vec::new(),
    }
}

fn tracklet(object: &Words, poses: Vec<Words>, name: &str, report: &Report) -> Option<Tracklet> {
    let dropped = |why: &str| {
        report.note(Outcome::Dropped, &format!("KITTI tracklet: {why}"), name);
    };
    let value = |key: &str| object.get(key).and_then(|words| text::number(words));
    let size_m = value("l").zip(value("w")).zip(value("h")).map(|((l, w), h)| DVec3::new(l, w, h));
    let Some(size_m) = size_m.filter(|size| size.min_element() > 0.0 && size.max_element() <= LONGEST_BOX_M) else {
        dropped("box without a valid size");
        return None;
    };
    let first_frame = object.get("first_frame").and_then(|words| words.parse().ok());
    let Some(first_frame) = first_frame.filter(|first: &usize| *first < MOST_FRAMES) else {
        dropped("no first frame");
        return None;
    };
    let mut read = Vec::with_capacity(poses.len());
    for words in poses {
        let pose = tracklet_pose(&words, size_m.z);
        if pose.is_none() {
            dropped("pose that cannot be read");
        }
        read.push(pose);
    }
    let category = object.get("objectType").cloned().unwrap_or_default();
    Some(Tracklet { category, size_m, first_frame, poses: read })
}

fn tracklet_pose(words: &Words, height_m: f64) -> Option<TrackletPose> {
    let value = |key: &str| words.get(key).and_then(|words| text::number(words));
    let bottom = DVec3::new(value("tx")?, value("ty")?, value("tz")?);
    let (roll, pitch, yaw) = (value("rx")?, value("ry")?, value("rz")?);
    if bottom.abs().max_element() > FARTHEST_M || roll.abs().max(pitch.abs()).max(yaw.abs()) > FARTHEST_M {
        return None;
    }
    let rotation = DQuat::from_euler(EulerRot::ZYX, yaw, pitch, roll);
    let word = |key: &str| words.get(key).cloned().unwrap_or_default();
    Some(TrackletPose {
        velodyne_from_body: Pose::new(rotation, bottom + rotation * DVec3::Z * height_m / 2.0),
        truncation: word("truncation"),
        occlusion: word("occlusion"),
    })
}

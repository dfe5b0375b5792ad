//! The tracking and object benchmarks: a file of labels a sequence, or a frame.

use std::path::{Path, PathBuf};

use trove_model::{Outcome, Pose, Report, Trajectory};

use super::boxes::Annotation;
use super::drive::{Moment, Picture, Recorded};
use super::labels::{self, Line};
use super::layout::{Form, Recording};
use super::mounting::Mounting;
use super::oxts::{Fix, Georeference, fix};
use super::{pictures, text, times};
use crate::ReadError;

const CAMERAS: [&str; 4] = ["image_00", "image_01", "image_02", "image_03"];

/// How many keyframes a recording has.
pub(super) fn keyframes(root: &Path, recording: &Recording) -> usize {
    match recording.form {
        Form::Object => 1,
        _ => text::read(&oxts_file(root, recording)).map_or(0, |text| text.lines().count()),
    }
}

/// The files of a recording but its pictures, as far as they are there: of those one of each camera, whose size is read.
pub(super) fn files(root: &Path, recording: &Recording, frames: usize) -> Vec<PathBuf> {
    let mut files = vec![calibration_file(root, recording), label_file(root, recording), oxts_file(root, recording)];
    files.extend((0..frames).map(|frame| root.join(sweep_file(recording, frame))));
    files.extend(CAMERAS.iter().filter_map(|camera| first_picture(root, recording, camera, frames)));
    files
}

/// Reads a recording.
pub(super) fn read(
    root: &Path,
    recording: &Recording,
    licence: &'static str,
    report: &Report,
) -> Result<Recorded, ReadError> {
    let fixes = match recording.form {
        Form::Object => None,
        _ => Some(fixes(root, recording, report)?),
    };
    let frames = fixes.as_ref().map_or(1, Vec::len);
    let own_size_px = |camera: &str| pictures::size_px(&first_picture(root, recording, camera, frames)?, report);
    // Rectified pictures of a day are all of one size.
    let size_px = |camera: &str| own_size_px(camera).or_else(|| CAMERAS.into_iter().find_map(own_size_px));
    let mounting = Mounting::of_benchmark(&calibration_file(root, recording), size_px, report)?;
    let (georeference, poses) = match &fixes {
        None => (None, vec![(0, Pose::IDENTITY)]),
        Some(fixes) => {
            let Some(first) = fixes.iter().flatten().next() else {
                let found = format!("none in {frames} lines");
                return Err(text::damaged(&oxts_file(root, recording), "all lines", "at least one fix", found));
            };
            let georeference = Georeference::at(first, mounting.ego_from_imu);
            let pose = |(frame, fix): (usize, &Option<Fix>)| {
                Some((frame, georeference.near_pose(fix.as_ref()?, &format!("frame {frame}"), report)?))
            };
            let poses = fixes.iter().enumerate().filter_map(pose).collect();
            (Some(georeference), poses)
        }
    };
    let moment = |&(frame, world_from_ego): &(usize, _)| {
        let time_ns = times::unknown_ns(frame);
        let picture = |(camera, c): (usize, &trove_model::RigCamera)| Picture {
            camera,
            time_ns,
            world_from_ego,
            file: picture_file(root, recording, &c.name, frame),
        };
        let pictures = mounting.rig.iter().enumerate().map(picture).collect();
        Moment { frame, time_ns, world_from_ego, pictures, sweep: Some(sweep_file(recording, frame)) }
    };
    let moments: Vec<Moment> = poses.iter().map(moment).collect();
    report.note(Outcome::Guessed, "time of a KITTI benchmark's frames, which have none", &recording.name);
    Ok(Recorded {
        path: Trajectory::default(),
        name: recording.name.clone(),
        licence,
        projection: georeference.map(|georeference| georeference.projection),
        annotations: annotations(root, recording, &moments, &mounting, report)?,
        moments,
        ego_from_velodyne: mounting.ego_from_velodyne,
        rig: mounting.rig,
    })
}

fn calibration_file(root: &Path, recording: &Recording) -> PathBuf {
    root.join(format!("{}calib/{}.txt", recording.below, recording.name))
}

fn oxts_file(root: &Path, recording: &Recording) -> PathBuf {
    root.join(format!("{}oxts/{}.txt", recording.below, recording.name))
}

fn label_file(root: &Path, recording: &Recording) -> PathBuf {
    let folder = if recording.form == Form::Object { "label_2" } else { "label_02" };
    root.join(format!("{}{folder}/{}.txt", recording.below, recording.name))
}

fn sweep_file(recording: &Recording, frame: usize) -> String {
    let Recording { name, form, below, .. } = recording;
    match form {
        Form::Object => format!("{below}velodyne/{name}.bin"),
        _ => format!("{below}velodyne/{name}/{frame:06}.bin"),
    }
}

/// A picture's path below the root; of tracking's left colour camera that of KITTI-STEP where only that is there.
fn picture_file(root: &Path, recording: &Recording, camera: &str, frame: usize) -> String {
    let Recording { name, form, below, base } = recording;
    if *form == Form::Object {
        return format!("{below}image_{}/{name}.png", camera.trim_start_matches("image_0"));
    }
    let own = format!("{below}{camera}/{name}/{frame:06}.png");
    let step = ["train", "val", "test"].map(|split| format!("{base}images/{split}/{name}/{frame:06}.png"));
    let stands_in = |file: &String| camera == "image_02" && root.join(file).is_file();
    if root.join(&own).is_file() { own } else { step.into_iter().find(stands_in).unwrap_or(own) }
}

fn first_picture(root: &Path, recording: &Recording, camera: &str, frames: usize) -> Option<PathBuf> {
    (0..frames).map(|frame| root.join(picture_file(root, recording, camera, frame))).find(|path| path.is_file())
}

/// A fix a frame; `None` where a line is none, which is reported.
fn fixes(root: &Path, recording: &Recording, report: &Report) -> Result<Vec<Option<Fix>>, ReadError> {
    let path = oxts_file(root, recording);
    if !path.is_file() {
        return Err(ReadError::Missing {
            path,
            expected: format!("poses of sequence {}", recording.name),
            found: "no such file".to_owned(),
            remedy: "unpack data_tracking_oxts.zip beside the calibrations".to_owned(),
        });
    }
    let one = |(frame, line): (usize, &str)| {
        let fix = fix(line);
        if fix.is_none() {
            let example = format!("{}, line {}: {}", path.display(), frame + 1, text::quoted(line));
            report.note(Outcome::Dropped, "KITTI frame: OXTS line that cannot be read", example);
        }
        fix
    };
    Ok(text::read(&path)?.lines().enumerate().map(one).collect())
}

fn annotations(
    root: &Path,
    recording: &Recording,
    moments: &[Moment],
    mounting: &Mounting,
    report: &Report,
) -> Result<Vec<Annotation>, ReadError> {
    let path = label_file(root, recording);
    if !path.is_file() {
        report.note(Outcome::Warned, "KITTI recording without labels", &recording.name);
        return Ok(Vec::new());
    }
    let mut found = Vec::new();
    for (i, line) in text::read(&path)?.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let token = format!("{}:{}", recording.name, i + 1);
        let dropped = |why: &str| report.note(Outcome::Dropped, &format!("KITTI label: {why}"), &token);
        let words: Vec<&str> = line.split_whitespace().collect();
        let (frame, instance, words) = match (recording.form, words.as_slice()) {
            (Form::Object, words) => (Some(0), i.to_string(), words),
            (_, [frame, track, words @ ..]) => (frame.parse().ok(), (*track).to_owned(), words),
            _ => (None, String::new(), &[][..]),
        };
        let label = match labels::line(words) {
            Ok(Line::Object(label)) => label,
            Ok(Line::DontCare) => {
                report.note(Outcome::Dropped, "KITTI DontCare region, which is no object", &token);
                continue;
            }
            Err(why) => {
                dropped(why);
                continue;
            }
        };
        let keyframe = frame.and_then(|frame: usize| moments.binary_search_by_key(&frame, |m| m.frame).ok());
        let Some(keyframe) = keyframe else {
            dropped("of no frame");
            continue;
        };
        found.push(Annotation {
            keyframe,
            instance,
            category: label.category,
            token,
            ego_from_body: mounting.ego_from_rectified * label.rectified_from_body,
            size_m: label.size_m,
            truncation: label.truncation,
            occlusion: label.occlusion,
        });
    }
    Ok(found)
}

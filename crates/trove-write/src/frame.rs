//! One frame's folder.

use std::collections::BTreeSet;
use std::path::Path;
use std::{fs, io};

use serde::{Deserialize, Serialize};
use trove_model::{Capture, Color, Ego, InstanceId, Labels, MapProjection, Pose, Scene, Shot, World};

use crate::files::FolderInTheMaking;
use crate::frame_table::frame_table;
use crate::{WriteError, WrittenFile, exr_file, jpeg, png_file};

/// Everything in `frame.json` that a shot, a scene and a capture do not hold.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameMeta {
    /// The drive (`scene-0103`).
    pub scene: String,
    /// The dataset (`nuscenes`).
    pub dataset: String,
    /// The dataset's name of the place (`boston-seaport`); empty where unknown.
    pub place: String,
    /// Which variation of the scene.
    pub variation: u32,
    /// Index of the keyframe in its drive.
    pub keyframe: u32,
    /// The dataset's name of the keyframe; empty where there is none.
    pub keyframe_token: String,
    /// Time of the keyframe, nanoseconds since 1970 UTC.
    pub keyframe_time_ns: i64,
    /// The dataset's name of the recorded picture that this view clones; empty where it clones none.
    pub source_token: String,
    /// That picture's path below the dataset's root; empty where it clones none.
    pub source_image: String,
    /// The vehicle that carries the camera, at the picture's time; `None` where the camera stands on its own.
    pub world_from_ego: Option<Pose<World, Ego>>,
    /// From latitude and longitude to World.
    pub projection: MapProjection,
}

/// A picture of a frame's folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)] // docs/output.md says what they hold
pub enum FrameFile {
    Radiance,
    Rgb,
    Class,
    Instance,
    Depth,
    Normal,
    FlowForward,
    FlowBackward,
    Change,
}

/// Camera and objects, which every frame's folder has.
const TABLE: &str = "frame.json";

impl FrameFile {
    /// All that there are.
    pub const ALL: [Self; 9] = [
        Self::Radiance,
        Self::Rgb,
        Self::Class,
        Self::Instance,
        Self::Depth,
        Self::Normal,
        Self::FlowForward,
        Self::FlowBackward,
        Self::Change,
    ];

    /// The file's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Radiance => "radiance.exr",
            Self::Rgb => "rgb.png",
            Self::Class => "class.png",
            Self::Instance => "instance.png",
            Self::Depth => "depth.exr",
            Self::Normal => "normal.exr",
            Self::FlowForward => "flow_forward.exr",
            Self::FlowBackward => "flow_backward.exr",
            Self::Change => "change.png",
        }
    }

    /// Whether light has to be followed for it.
    pub fn shows_light(self) -> bool {
        matches!(self, Self::Radiance | Self::Rgb)
    }
}

/// Names of the files in a finished frame's folder that holds these pictures.
pub fn frame_files(pictures: &BTreeSet<FrameFile>) -> Vec<&'static str> {
    pictures.iter().map(|file| file.name()).chain([TABLE]).collect()
}

/// Writes a frame's folder whole: under a hidden name beside it first, then renamed, so that `dir` is never there in
/// part. What an interrupted run left under the hidden name, and a `dir` without all its files, is replaced; a finished
/// frame is not. `pictures` are those that are wanted; a capture without light has none that show it, and one that was
/// compared with none shows no change.
pub fn write_frame(
    dir: &Path,
    scene: &Scene,
    shot: &Shot,
    capture: &Capture,
    meta: &FrameMeta,
    pictures: &BTreeSet<FrameFile>,
) -> Result<Vec<WrittenFile>, WriteError> {
    check_sizes(capture, shot.lens.width_px, shot.lens.height_px)?;
    let table = frame_table(scene, shot, capture, meta)?;
    narrowed(&capture.labels)?;
    let there = |file: &FrameFile| match file {
        FrameFile::Change => capture.change.is_some(),
        _ => capture.color.is_some() || !file.shows_light(),
    };
    let pictures: BTreeSet<FrameFile> = pictures.iter().copied().filter(there).collect();
    clear_unfinished(dir, &frame_files(&pictures))?;

    let mut folder = FolderInTheMaking::start(dir)?;
    for file in pictures {
        folder.add(file.name(), &encode(file, shot, capture)?)?;
    }
    folder.add(TABLE, &table)?;
    folder.finish()
}

/// A picture's bytes.
fn encode(file: FrameFile, shot: &Shot, capture: &Capture) -> Result<Vec<u8>, WriteError> {
    let (name, width, height) = (file.name(), shot.lens.width_px, shot.lens.height_px);
    let labels = &capture.labels;
    let color = || capture.color.as_ref().ok_or_else(|| WriteError::Mismatch(format!("{name} without light")));
    match file {
        FrameFile::Radiance => exr_file::encode(name, &color()?.radiance, ["R", "G", "B"]),
        FrameFile::Rgb => {
            let srgb = &color()?.srgb.data;
            match shot.film.sensor.and_then(|sensor| sensor.jpeg_quality) {
                Some(quality) => png_file::rgb(name, width, height, &jpeg::worn(name, width, height, srgb, quality)?),
                None => png_file::rgb(name, width, height, srgb),
            }
        }
        FrameFile::Class => png_file::grey(name, width, height, &labels.class.data),
        FrameFile::Instance => png_file::grey16(name, width, height, &narrowed(labels)?),
        FrameFile::Depth => exr_file::encode_scalar(name, &labels.depth_m),
        FrameFile::Normal => exr_file::encode(name, &labels.normal, ["R", "G", "B"]),
        FrameFile::FlowForward => exr_file::encode(name, &labels.flow_forward, ["R", "G"]),
        FrameFile::FlowBackward => exr_file::encode(name, &labels.flow_backward, ["R", "G"]),
        FrameFile::Change => {
            let change = capture.change.as_ref();
            let change = change.ok_or_else(|| WriteError::Mismatch(format!("{name} without another scene")))?;
            png_file::grey(name, width, height, &change.map(|&differs| if differs { u8::MAX } else { 0 }).data)
        }
    }
}

/// Every picture has the shot's size.
fn check_sizes(capture: &Capture, width: u32, height: u32) -> Result<(), WriteError> {
    let labels = &capture.labels;
    let mut found = vec![
        ("class", labels.class.width, labels.class.height, labels.class.data.len()),
        ("instance", labels.instance.width, labels.instance.height, labels.instance.data.len()),
        ("depth", labels.depth_m.width, labels.depth_m.height, labels.depth_m.data.len()),
        ("normal", labels.normal.width, labels.normal.height, labels.normal.data.len()),
        ("flow_forward", labels.flow_forward.width, labels.flow_forward.height, labels.flow_forward.data.len()),
        ("flow_backward", labels.flow_backward.width, labels.flow_backward.height, labels.flow_backward.data.len()),
    ];
    if let Some(Color { radiance, srgb, .. }) = &capture.color {
        found.push(("radiance", radiance.width, radiance.height, radiance.data.len()));
        found.push(("rgb", srgb.width, srgb.height, srgb.data.len()));
    }
    if let Some(change) = &capture.change {
        found.push(("change", change.width, change.height, change.data.len()));
    }
    match found.iter().find(|(_, w, h, len)| (*w, *h) != (width, height) || *len != width as usize * height as usize) {
        None if width > 0 && height > 0 => Ok(()),
        None => Err(WriteError::Mismatch(format!("a picture of {width}×{height} pixels"))),
        Some((what, w, h, len)) => {
            Err(WriteError::Mismatch(format!("{what} of {w}×{h} pixels ({len} values) in a shot of {width}×{height}")))
        }
    }
}

fn narrowed(labels: &Labels) -> Result<Vec<u16>, WriteError> {
    let narrow = |&id: &u32| u16::try_from(id).map_err(|_| WriteError::TooManyObjects(InstanceId(id)));
    labels.instance.data.iter().map(narrow).collect()
}

/// Removes what lies at `dir` where that is a frame without all its files, and refuses where it is anything else.
fn clear_unfinished(dir: &Path, expected: &[&str]) -> Result<(), WriteError> {
    let entries = match fs::read_dir(dir) {
        Ok(entries) => entries,
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(e) => return Err(WriteError::storage(dir, "look into the folder")(e)),
    };
    let occupied = |found: String| Err(WriteError::Occupied { path: dir.to_owned(), found });
    let mut present = Vec::new();
    for entry in entries {
        let name = entry.map_err(WriteError::storage(dir, "look into the folder"))?.file_name();
        match FrameFile::ALL.map(FrameFile::name).into_iter().chain([TABLE]).find(|file| name == *file) {
            Some(file) => present.push(file),
            None => return occupied(format!("{}, which is no file of a frame", name.to_string_lossy())),
        }
    }
    if expected.iter().all(|file| present.contains(file)) {
        return occupied("one".into());
    }
    fs::remove_dir_all(dir).map_err(WriteError::storage(dir, "remove an unfinished frame"))
}

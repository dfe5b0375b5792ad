//! One frame's folder.

use std::path::Path;
use std::{fs, io};

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

/// What a frame's folder holds beside its labels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pictures {
    /// Nothing.
    None,
    /// The picture.
    Developed,
    /// The picture and the radiance that it was made from.
    WithRadiance,
}

/// What a frame's folder can hold.
const FILES: [&str; 9] = [
    "radiance.exr",
    "rgb.png",
    "class.png",
    "instance.png",
    "depth.exr",
    "normal.exr",
    "flow_forward.exr",
    "flow_backward.exr",
    "frame.json",
];

/// Names of the files in a finished frame's folder.
pub fn frame_files(pictures: Pictures) -> &'static [&'static str] {
    match pictures {
        Pictures::WithRadiance => &FILES,
        Pictures::Developed => &FILES[1..],
        Pictures::None => &FILES[2..],
    }
}

/// Writes a frame's folder whole: under a hidden name beside it first, then renamed, so that `dir` is never there in
/// part. What an interrupted run left under the hidden name, and a `dir` without all its files, is replaced; a finished
/// frame is not. A capture without a picture is written without `pictures`.
pub fn write_frame(
    dir: &Path,
    scene: &Scene,
    shot: &Shot,
    capture: &Capture,
    meta: &FrameMeta,
    pictures: Pictures,
) -> Result<Vec<WrittenFile>, WriteError> {
    let (labels, width, height) = (&capture.labels, shot.lens.width_px, shot.lens.height_px);
    check_sizes(capture, width, height)?;
    let table = frame_table(scene, shot, capture, meta)?;
    let instances = narrowed(labels)?;
    let color = capture.color.as_ref().filter(|_| pictures != Pictures::None);
    clear_unfinished(dir, frame_files(if color.is_some() { pictures } else { Pictures::None }))?;

    let mut folder = FolderInTheMaking::start(dir)?;
    if let Some(color) = color {
        if pictures == Pictures::WithRadiance {
            folder.add("radiance.exr", &exr_file::encode("radiance.exr", &color.radiance, ["R", "G", "B"])?)?;
        }
        let worn = match shot.film.sensor.and_then(|sensor| sensor.jpeg_quality) {
            Some(quality) => &jpeg::worn("rgb.png", width, height, &color.srgb.data, quality)?,
            None => &color.srgb.data,
        };
        folder.add("rgb.png", &png_file::rgb("rgb.png", width, height, worn)?)?;
    }
    folder.add("class.png", &png_file::grey("class.png", width, height, &labels.class.data)?)?;
    folder.add("instance.png", &png_file::grey16("instance.png", width, height, &instances)?)?;
    folder.add("depth.exr", &exr_file::encode_scalar("depth.exr", &labels.depth_m)?)?;
    folder.add("normal.exr", &exr_file::encode("normal.exr", &labels.normal, ["R", "G", "B"])?)?;
    for (name, flow) in [("flow_forward.exr", &labels.flow_forward), ("flow_backward.exr", &labels.flow_backward)] {
        folder.add(name, &exr_file::encode(name, flow, ["R", "G"])?)?;
    }
    folder.add("frame.json", &table)?;
    folder.finish()
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
        match FILES.iter().find(|file| name == **file) {
            Some(file) => present.push(file),
            None => return occupied(format!("{}, which is no file of a frame", name.to_string_lossy())),
        }
    }
    if expected.iter().all(|file| present.contains(&file)) {
        return occupied("one".into());
    }
    fs::remove_dir_all(dir).map_err(WriteError::storage(dir, "remove an unfinished frame"))
}

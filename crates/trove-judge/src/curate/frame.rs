//! What is known of a frame from its labels.

use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec2;
use trove_format::{FrameFile, FrameTable, ObjectRow};
use trove_model::CLASSES;

use super::hash::{difference_hash, luma};
use crate::JudgeError;
use crate::pictures::read_labels;

/// Share of a picture's pixels from which a class counts as seen: 100 pixels of 480 × 360.
const SEEN: f64 = 6e-4;

/// An object in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenObject {
    /// Id of its class.
    pub class_id: u8,
    /// Pixels that show it.
    pub visible_px: u32,
    /// From the camera to the middle of its box, metres.
    pub range_m: f32,
}

/// A frame as far as its worth for training goes.
#[derive(Clone, Debug, PartialEq)]
pub struct CandidateFrame {
    /// Folder below the dataset's (`scene-0103/v00/k005/ego.CAM_FRONT`).
    pub path: String,
    /// Which variation of its scene.
    pub variation: u32,
    /// The recorded moment, which other views and variations show too: the drive, and the index of its keyframe.
    pub moment: (String, u32),
    /// Where its camera is in the plane of its dataset's place, metres, with the place's name.
    pub place: String,
    /// East and north of the place's origin, metres.
    pub position_m: DVec2,
    /// Pixels by class id.
    pub pixels: [u64; 20],
    /// Objects that are visible.
    pub objects: Vec<SeenObject>,
    /// Difference hash of its picture, or of its classes where there is no picture.
    pub hash: u64,
    /// Whether there is a picture.
    pub has_picture: bool,
}

impl CandidateFrame {
    /// Reads a frame's folder.
    pub(super) fn read(root: &Path, folder: &Path) -> Result<Self, JudgeError> {
        let frame = FrameTable::read(folder)?;
        let file = folder.join(FrameFile::Class.name());
        let labels = read_labels(&file)?;
        let mut counts = [0; 256];
        labels.data.iter().for_each(|id| counts[usize::from(*id)] += 1);
        let mut pixels = [0; 20];
        pixels.copy_from_slice(&counts[..20]);
        if let Some(id) = (20..256).find(|id| counts[*id] > 0) {
            let remedy = "remove the folder and run trove generate again";
            return Err(JudgeError::unexpected(&file, "ids of the 20 classes", id.to_string(), remedy));
        }
        let picture = folder.join(FrameFile::Rgb.name());
        let has_picture = picture.exists();
        let hash = if has_picture {
            difference_hash(&crate::pictures::read(&picture)?.into_luma8())
        } else {
            let grey = labels.data.iter().map(|id| luma(CLASSES[usize::from(*id)].rgb)).collect();
            image::GrayImage::from_raw(labels.width, labels.height, grey).map_or(0, |grey| difference_hash(&grey))
        };
        let [x, y, _] = frame.world_from_camera_translation_m;
        let place = if frame.place.is_empty() { frame.scene.clone() } else { frame.place };
        let moment = (frame.scene, frame.keyframe);
        let path = folder.strip_prefix(root).unwrap_or(folder).to_string_lossy().replace('\\', "/");
        let position_m = DVec2::from_array(frame.projection.anchor_m) + DVec2::new(x, y);
        let seen = |o: &ObjectRow| SeenObject { class_id: o.class_id, visible_px: o.visible_px, range_m: o.range_m };
        let objects = frame.objects.iter().filter(|o| o.visible_px > 0).map(seen).collect();
        Ok(Self { path, variation: frame.variation, moment, place, position_m, pixels, objects, hash, has_picture })
    }

    /// Share of its pixels by class.
    pub fn shares(&self) -> [f64; 20] {
        let all = self.pixels.iter().sum::<u64>().max(1) as f64;
        self.pixels.map(|n| n as f64 / all)
    }

    /// How many classes but void are seen.
    pub fn classes(&self) -> usize {
        seen(&self.shares()[1..])
    }

    /// Entropy of its classes, bits.
    pub fn entropy(&self) -> f64 {
        entropy(&self.shares())
    }
}

/// How many shares of a picture are large enough to be seen.
pub(super) fn seen(shares: &[f64]) -> usize {
    shares.iter().filter(|share| **share >= SEEN).count()
}

/// Entropy of shares, bits.
pub(super) fn entropy(shares: &[f64]) -> f64 {
    shares.iter().filter(|p| **p > 0.0).map(|p| -p * p.log2()).sum()
}

/// The folders of finished frames below a dataset's folder, in the order of their names.
pub(super) fn folders(root: &Path) -> Result<Vec<PathBuf>, JudgeError> {
    let (mut found, mut open) = (Vec::new(), vec![root.to_owned()]);
    while let Some(folder) = open.pop() {
        if folder.join(FrameTable::NAME).is_file() {
            found.push(folder);
            continue;
        }
        for entry in fs::read_dir(&folder).map_err(JudgeError::io(&folder))? {
            let path = entry.map_err(JudgeError::io(&folder))?.path();
            let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
            if path.is_dir() && !hidden {
                open.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

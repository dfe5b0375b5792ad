//! What the page knows of a run before anything else is loaded: scenes, moments and cameras.

use serde::Serialize;
use trove_format::{ClassEntry, FrameTable};
use trove_model::Shot;
use trove_read::asset_files::FileCamera;

use super::pictures::{NEAR_M, STEP};
use super::pose::{Pose, pose, pose_of_rows};

#[derive(Serialize)]
pub(super) struct Table {
    pub(super) about: String,
    /// Where scenes and frames lie that the page does not hold.
    pub(super) folder: String,
    classes: Vec<ClassEntry>,
    depth: Depth,
    layers: Vec<&'static str>,
    pub(super) scenes: Vec<SceneRow>,
}

/// Of the image of depth.
#[derive(Serialize)]
struct Depth {
    near_m: f64,
    step: f64,
}

/// A variation of a scene.
#[derive(Serialize)]
pub(super) struct SceneRow {
    pub(super) id: String,
    pub(super) name: String,
    pub(super) scene: String,
    pub(super) moments: Vec<MomentRow>,
}

#[derive(Serialize)]
pub(super) struct MomentRow {
    pub(super) keyframe: u32,
    pub(super) ego: Option<Pose>,
    pub(super) frames: Vec<Camera>,
}

#[derive(Serialize)]
pub(super) struct Camera {
    /// The frame's path; of a camera that has taken no picture it holds none.
    id: String,
    view: String,
    width: u32,
    height: u32,
    /// Focal lengths and the principal point, pixels.
    k: [f64; 4],
    pose: Pose,
    has_images: bool,
}

impl Table {
    pub(super) fn new(about: String, folder: String) -> Self {
        let depth = Depth { near_m: NEAR_M, step: STEP };
        Self { about, folder, classes: ClassEntry::all(), depth, layers: Vec::new(), scenes: Vec::new() }
    }

    /// Takes note of what frames can lay over their images.
    pub(super) fn add_layers(&mut self, layers: impl Iterator<Item = &'static str>) {
        for layer in layers {
            if !self.layers.contains(&layer) {
                self.layers.push(layer);
            }
        }
    }
}

impl SceneRow {
    pub(super) fn new(id: String, scene: String, name: String) -> Self {
        Self { id, name, scene, moments: Vec::new() }
    }

    /// The moment of a keyframe, made where it is not there.
    pub(super) fn moment(&mut self, keyframe: u32) -> &mut MomentRow {
        let at = match self.moments.iter().rposition(|moment| moment.keyframe == keyframe) {
            Some(at) => at,
            None => {
                self.moments.push(MomentRow { keyframe, ego: None, frames: Vec::new() });
                self.moments.len() - 1
            }
        };
        &mut self.moments[at]
    }
}

impl Camera {
    pub(super) fn of_frame(path: &str, table: &FrameTable) -> Self {
        let k = table.intrinsics;
        Self {
            id: path.to_owned(),
            view: table.view.clone(),
            width: table.width_px,
            height: table.height_px,
            k: [k[0][0], k[1][1], k[0][2], k[1][2]],
            pose: pose_of_rows(&table.world_from_camera),
            has_images: true,
        }
    }

    pub(super) fn of_shot(moment: &str, shot: &Shot) -> Self {
        let lens = &shot.lens;
        Self {
            id: format!("{moment}/{}", shot.view),
            view: shot.view.clone(),
            width: lens.width_px,
            height: lens.height_px,
            k: [lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px],
            pose: pose(&shot.world_from_camera.affine()),
            has_images: false,
        }
    }

    pub(super) fn of_file(moment: &str, camera: &FileCamera) -> Self {
        Self {
            id: format!("{moment}/{}", camera.name),
            view: camera.name.clone(),
            width: camera.size_px[0],
            height: camera.size_px[1],
            k: camera.intrinsics_px,
            pose: pose(&camera.world_from_camera),
            has_images: false,
        }
    }
}

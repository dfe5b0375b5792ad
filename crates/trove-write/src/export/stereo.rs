//! Pairs of cameras that see as two eyes do.

use glam::DVec3;
use trove_format::{FrameTable, LensModel};
use trove_model::Raster;

use super::geometry::{affine, camera_from_world};
use super::plan::Plan;
use crate::{StoredFrame, WriteError};

/// The right eye of a frame.
pub(crate) struct RightEye {
    /// Its frame.
    pub frame: StoredFrame,
    /// How far it is to the right, metres.
    pub baseline_m: f64,
}

/// How far two eyes may differ from standing side by side, as a share of their distance.
const CROOKED: f64 = 0.01;
/// How far their axes may turn from each other, radians: a tenth of a pixel of most cameras.
const TURNED: f64 = 1e-4;
/// The farthest that an eye is, metres.
const FARTHEST_M: f64 = 2.0;

/// The nearest camera to the right of a frame's that took its picture at the same time with the same lens in the same
/// direction; `None` where there is none.
pub(crate) fn right_eye(plan: &Plan, frame: usize, table: &FrameTable) -> Result<Option<RightEye>, WriteError> {
    if table.lens_model != LensModel::Pinhole {
        return Ok(None);
    }
    let mut nearest: Option<RightEye> = None;
    for other in plan.same_moment(frame) {
        let candidate = plan.open(&plan.frames[other])?;
        let Some(baseline_m) = baseline(table, &candidate.table) else { continue };
        if nearest.as_ref().is_none_or(|eye| baseline_m < eye.baseline_m) {
            nearest = Some(RightEye { frame: candidate, baseline_m });
        }
    }
    Ok(nearest)
}

fn baseline(left: &FrameTable, right: &FrameTable) -> Option<f64> {
    let same_lens = left.intrinsics == right.intrinsics
        && right.lens_model == LensModel::Pinhole
        && (left.width_px, left.height_px, left.time_ns) == (right.width_px, right.height_px, right.time_ns);
    let left_from_right = camera_from_world(left) * affine(&right.world_from_camera);
    let (_, rotation, place) = left_from_right.to_scale_rotation_translation();
    let aside = (place - DVec3::new(place.x, 0.0, 0.0)).length();
    let (_, turned) = rotation.to_axis_angle();
    let turned = turned.min(std::f64::consts::TAU - turned);
    let is_right = place.x > 0.0 && place.x < FARTHEST_M && aside < CROOKED * place.x && turned < TURNED;
    (same_lens && is_right).then_some(place.x)
}

impl RightEye {
    /// How far each pixel of the left picture lies further to the right than in the right one, pixels; 0 for the sky.
    pub(crate) fn disparity_px(&self, left: &StoredFrame) -> Result<Raster<f64>, WriteError> {
        let scale = left.table.intrinsics[0][0] * self.baseline_m;
        Ok(left.depth_m()?.map(|depth_m| scale / f64::from(*depth_m)))
    }
}

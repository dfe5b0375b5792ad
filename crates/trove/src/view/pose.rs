//! Poses as the page reads them.

use glam::{DAffine3, DQuat};
use trove_format::Matrix4;

/// The first three rows.
pub(super) type Pose = [f64; 12];

pub(super) fn pose(affine: &DAffine3) -> Pose {
    let (m, t) = (affine.matrix3, affine.translation);
    let rows = [m.row(0), m.row(1), m.row(2)];
    std::array::from_fn(|i| rounded(if i % 4 == 3 { t[i / 4] } else { rows[i / 4][i % 4] }))
}

pub(super) fn pose_of_rows(matrix: &Matrix4) -> Pose {
    std::array::from_fn(|i| rounded(matrix[i / 4][i % 4]))
}

pub(super) fn pose_of_parts([w, x, y, z]: [f64; 4], translation_m: [f64; 3]) -> Pose {
    let rotation = DQuat::from_xyzw(x, y, z, w).normalize();
    pose(&DAffine3::from_rotation_translation(rotation, translation_m.into()))
}

/// To a tenth of a millimetre, which is what a page needs.
fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

//! Matrices of frame tables as transforms.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use trove_format::{FrameTable, Matrix4, ObjectRow};

/// A table's matrix as a transform.
pub(crate) fn affine(matrix: &Matrix4) -> DAffine3 {
    let row = |i: usize| DVec3::new(matrix[i][0], matrix[i][1], matrix[i][2]);
    let rotation = DMat3::from_cols(row(0), row(1), row(2)).transpose();
    DAffine3::from_mat3_translation(rotation, DVec3::new(matrix[0][3], matrix[1][3], matrix[2][3]))
}

/// From World to a frame's Camera.
pub(crate) fn camera_from_world(table: &FrameTable) -> DAffine3 {
    affine(&table.world_from_camera).inverse()
}

/// From an object's Body to a frame's Camera.
pub(crate) fn camera_from_body(table: &FrameTable, object: &ObjectRow) -> DAffine3 {
    camera_from_world(table) * affine(&object.world_from_body)
}

/// The rotation of a transform as a unit quaternion, w first and not negative.
pub(crate) fn quaternion_wxyz(transform: &DAffine3) -> [f64; 4] {
    let q = DQuat::from_mat3(&transform.matrix3).normalize();
    let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
    [q.w, q.x, q.y, q.z].map(|part| sign * part)
}

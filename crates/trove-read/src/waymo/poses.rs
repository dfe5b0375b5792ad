//! Waymo's transforms, in ours.

use glam::{DMat3, DQuat, DVec3};
use trove_model::{Camera, Ego, Frame, Pose};

use super::records::Matrix;

/// Beyond this from the city's origin nothing is a position: 1000 km, metres.
pub(super) const FARTHEST_M: f64 = 1e6;
/// How far the axes of a rotation may be from perpendicular unit vectors.
const SKEW: f64 = 1e-3;

/// A pose from a 4 × 4 matrix, row by row; `None` where that is no rigid transform.
pub(super) fn pose<Dst: Frame, Src: Frame>(matrix: &Matrix) -> Option<Pose<Dst, Src>> {
    let m = |row: usize, column: usize| matrix[4 * row + column];
    let column = |c: usize| DVec3::new(m(0, c), m(1, c), m(2, c));
    let (rotation, translation) = (DMat3::from_cols(column(0), column(1), column(2)), column(3));
    let skew = (rotation.transpose() * rotation - DMat3::IDENTITY).to_cols_array();
    let is_rigid = skew.iter().all(|v| v.abs() < SKEW)
        && rotation.determinant() > 0.0
        && matrix[12..15].iter().all(|v| v.abs() < SKEW)
        && (matrix[15] - 1.0).abs() < SKEW
        && translation.abs().cmplt(DVec3::splat(FARTHEST_M)).all();
    is_rigid.then(|| Pose::new(DQuat::from_mat3(&rotation), translation))
}

/// Mounting of a camera whose axes are x forward, y left, z up.
pub(super) fn ego_from_camera(vehicle_from_camera: &Matrix) -> Option<Pose<Ego, Camera>> {
    let axes = DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X);
    let ours = Pose::<Camera, Camera>::new(DQuat::from_mat3(&axes), DVec3::ZERO);
    Some(pose::<Ego, Camera>(vehicle_from_camera)? * ours)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::World;

    #[test]
    fn a_matrix_is_read_row_by_row_and_what_is_no_rotation_is_none() {
        let quarter = [0.0, -1.0, 0.0, 5.0, 1.0, 0.0, 0.0, 6.0, 0.0, 0.0, 1.0, 7.0, 0.0, 0.0, 0.0, 1.0];
        let turned = pose::<World, Ego>(&quarter).unwrap();
        assert!((turned.yaw_rad() - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        assert_eq!(turned.translation, DVec3::new(5.0, 6.0, 7.0));
        for (at, value) in [(0, 0.5), (3, f64::NAN), (7, 1e9), (10, -1.0), (12, 1.0), (15, 0.0)] {
            let mut bad = quarter;
            bad[at] = value;
            assert_eq!(pose::<World, Ego>(&bad), None, "{at}");
        }
        assert_eq!(pose::<World, Ego>(&[0.0; 16]), None);
    }

    #[test]
    fn a_camera_looks_along_its_own_x() {
        let forward = [1.0, 0.0, 0.0, 1.5, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.1, 0.0, 0.0, 0.0, 1.0];
        let mounting = ego_from_camera(&forward).unwrap();
        assert!((mounting.vector(DVec3::Z) - DVec3::X).length() < 1e-12);
        assert!((mounting.vector(DVec3::X) + DVec3::Y).length() < 1e-12);
        assert!((mounting.vector(DVec3::Y) + DVec3::Z).length() < 1e-12);
    }
}

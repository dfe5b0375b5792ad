//! nuScenes' poses and lenses, in ours.

use glam::{DQuat, DVec3};
use trove_model::{Distortion, Frame, Lens, Pose};

/// Beyond this from a map's origin nothing is a position: 1000 km, metres.
pub(super) const FARTHEST_M: f64 = 1e6;
/// No image has a longer side, pixels.
const LARGEST_IMAGE_PX: i64 = 65_535;

/// A pose from a translation and a quaternion w, x, y, z; `None` where they are none (NaN, zero, absurd).
pub(super) fn pose<Dst: Frame, Src: Frame>(translation: [f64; 3], wxyz: [f64; 4]) -> Option<Pose<Dst, Src>> {
    let [w, x, y, z] = wxyz;
    let (rotation, translation) = (DQuat::from_xyzw(x, y, z, w), DVec3::from_array(translation));
    let is_unit_enough = (0.9..1.1).contains(&rotation.length());
    (is_unit_enough && translation.abs().cmplt(DVec3::splat(FARTHEST_M)).all())
        .then(|| Pose::new(rotation, translation))
}

/// A lens from an image's size and its 3 × 3 camera matrix; the error says what is wrong with them.
pub(super) fn lens(width: i64, height: i64, matrix: &[Vec<f64>]) -> Result<Lens, &'static str> {
    let side = |px: i64| (1..=LARGEST_IMAGE_PX).contains(&px).then_some(px as u32);
    let (Some(width_px), Some(height_px)) = (side(width), side(height)) else { return Err("image of no size") };
    let at = |row: usize, column: usize| matrix.get(row).and_then(|r| r.get(column)).copied().unwrap_or(f64::NAN);
    let (fx_px, fy_px, cx_px, cy_px) = (at(0, 0), at(1, 1), at(0, 2), at(1, 2));
    let is_focal = |f: f64| f > 0.0 && f < 1e6;
    if !(is_focal(fx_px) && is_focal(fy_px) && cx_px.abs() < 1e6 && cy_px.abs() < 1e6) {
        return Err("camera without usable intrinsics");
    }
    // As the devkit's `box_in_image`, this takes the image to span 0 to its width: pixel centres are at .5.
    Ok(Lens { width_px, height_px, fx_px, fy_px, cx_px, cy_px, distortion: Distortion::None })
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::{Ego, World};

    #[test]
    fn the_scalar_comes_first_in_the_dataset() {
        let turn = pose::<World, Ego>([1.0, 2.0, 3.0], [0.5f64.sqrt(), 0.0, 0.0, 0.5f64.sqrt()]).unwrap();
        assert!((turn.yaw_rad() - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        for (t, r) in
            [([f64::NAN, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]), ([0.0; 3], [0.0; 4]), ([1e300, 0.0, 0.0], [1.0; 4])]
        {
            assert_eq!(pose::<World, Ego>(t, r), None);
        }
    }

    #[test]
    fn an_image_of_no_size_has_no_lens() {
        let matrix = [vec![1266.4, 0.0, 816.2], vec![0.0, 1266.4, 491.5], vec![0.0, 0.0, 1.0]];
        assert!(lens(1600, 900, &matrix).is_ok());
        assert_eq!(lens(0, 900, &matrix), Err("image of no size"));
        assert_eq!(lens(1600, 900, &[]), Err("camera without usable intrinsics"));
    }
}

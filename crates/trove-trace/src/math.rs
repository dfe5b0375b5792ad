//! Roots and turns that a processor and a card answer alike, to the last bit.

use core::f32::consts::FRAC_PI_2;

use glam::Vec3;

/// Rounded as IEEE 754 asks.
#[inline(always)]
pub(crate) fn sqrt(x: f32) -> f32 {
    #[cfg(target_arch = "nvptx64")]
    return core::f32::math::sqrt(x);
    #[cfg(not(target_arch = "nvptx64"))]
    return x.sqrt();
}

/// A vector made as long as 1.
#[inline(always)]
pub(crate) fn unit(v: Vec3) -> Vec3 {
    v * (1.0 / sqrt(v.length_squared()))
}

/// The same; `otherwise` where it is too short for that.
#[inline(always)]
pub(crate) fn unit_or(v: Vec3, otherwise: Vec3) -> Vec3 {
    let scale = 1.0 / sqrt(v.length_squared());
    if scale.is_finite() && scale > 0.0 { v * scale } else { otherwise }
}

/// Sine and cosine of a share of a whole turn, 0 to 1.
#[inline(always)]
pub(crate) fn turn(share: f32) -> (f32, f32) {
    // Quarters come off without rounding.
    let quarters = 4.0 * share;
    let quarter = (quarters + 0.5) as u32;
    let (sin, cos) = eighth((quarters - quarter as f32) * FRAC_PI_2);
    match quarter % 4 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Sine and cosine of an angle between an eighth of a turn to either side, radians (polynomials of Moshier's Cephes).
#[inline(always)]
pub(crate) fn eighth(angle: f32) -> (f32, f32) {
    let x2 = angle * angle;
    let sin = angle + angle * x2 * (-1.666_665_5e-1 + x2 * (8.332_161e-3 - x2 * 1.951_529_6e-4));
    let cos = 1.0 - 0.5 * x2 + x2 * x2 * (4.166_664_6e-2 + x2 * (-1.388_731_6e-3 + x2 * 2.443_315_7e-5));
    (sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_those_of_the_standard_library() {
        for i in 0..=100_000u32 {
            let share = i as f32 / 100_000.0;
            let (sin, cos) = turn(share);
            let (s, c) = (f64::from(share) * core::f64::consts::TAU).sin_cos();
            assert!(
                (f64::from(sin) - s).abs() < 1.5e-7 && (f64::from(cos) - c).abs() < 1.5e-7,
                "{share}: {sin}, {cos}"
            );
        }
    }

    #[test]
    fn unit_vectors_are_glams() {
        for v in [Vec3::new(3.0, -4.0, 12.0), Vec3::splat(1e-9), Vec3::new(0.1, 1e8, 2.0)] {
            assert_eq!((unit(v), unit_or(v, Vec3::Z)), (v.normalize(), v.normalize_or(Vec3::Z)));
        }
        assert_eq!(unit_or(Vec3::ZERO, Vec3::Z), Vec3::Z);
    }
}

//! Roots, turns and powers that a processor and a card answer alike, to the last bit.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, LN_2, LOG2_E, PI, SQRT_2};

use glam::{Vec2, Vec3};

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

/// The whole number below; for numbers that 32 bits hold.
#[inline(always)]
pub(crate) fn floor(x: f32) -> f32 {
    let whole = x as i32 as f32;
    if whole > x { whole - 1.0 } else { whole }
}

/// The same of both coordinates.
#[inline(always)]
pub(crate) fn floor2(v: Vec2) -> Vec2 {
    Vec2::new(floor(v.x), floor(v.y))
}

/// e to the power of `x`; 0 or far too much where that is beyond single precision's normal numbers.
#[inline(always)]
pub(crate) fn exp(x: f32) -> f32 {
    let twos = (x * LOG2_E).clamp(-126.0, 127.0);
    let whole = floor(twos + 0.5);
    let r = (twos - whole) * LN_2;
    // Taylor's polynomial, up to half of ln 2 to either side.
    let r2 = r * r;
    let low = 1.0 + r + r2 * (1.0 / 2.0 + r * (1.0 / 6.0));
    let high = r2 * r2 * (1.0 / 24.0 + r * (1.0 / 120.0) + r2 * (1.0 / 720.0));
    let power = (low + high) * f32::from_bits(((whole as i32 + 127) as u32) << 23);
    if x < -87.0 { 0.0 } else { power }
}

/// The binary logarithm of a positive normal number.
#[inline(always)]
pub(crate) fn log2(x: f32) -> f32 {
    let bits = x.to_bits();
    let mut whole = (bits >> 23) as i32 - 127;
    let mut m = f32::from_bits((bits & 0x007f_ffff) | 0x3f80_0000);
    if m > SQRT_2 {
        (m, whole) = (0.5 * m, whole + 1);
    }
    // The series of the inverse hyperbolic tangent.
    let s = (m - 1.0) / (m + 1.0);
    let s2 = s * s;
    whole as f32 + 2.0 * LOG2_E * s * (1.0 + s2 * (1.0 / 3.0 + s2 * (1.0 / 5.0 + s2 * (1.0 / 7.0))))
}

/// (1 − e^(−x)) / x.
#[inline(always)]
pub(crate) fn less_exp(x: f32) -> f32 {
    // Near 0 the difference would be rounding.
    if x.abs() < SMALL {
        1.0 - x * (1.0 / 2.0 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0))))
    } else {
        (1.0 - exp(-x)) / x
    }
}

/// −ln(1 − x) / x for x below 1.
#[inline(always)]
pub(crate) fn log_less(x: f32) -> f32 {
    if x.abs() < SMALL {
        1.0 + x * (1.0 / 2.0 + x * (1.0 / 3.0 + x * (1.0 / 4.0 + x * (1.0 / 5.0 + x * (1.0 / 6.0)))))
    } else {
        -LN_2 * log2(1.0 - x) / x
    }
}

/// Up to here series are exact.
const SMALL: f32 = 0.06;

/// The angle of a point about the origin from the first axis on, between half a turn to either side, radians; 0 at the origin
/// (polynomial of Moshier's Cephes).
#[inline(always)]
pub(crate) fn atan2(y: f32, x: f32) -> f32 {
    /// The tangent of a sixteenth of a turn.
    const SIXTEENTH: f32 = 0.414_213_56;
    let (rise, run) = (y.abs().min(x.abs()), y.abs().max(x.abs()));
    if run == 0.0 {
        return 0.0;
    }
    let t = rise / run;
    let (t, more) = if t > SIXTEENTH { ((t - 1.0) / (t + 1.0), FRAC_PI_4) } else { (t, 0.0) };
    let t2 = t * t;
    let series = ((8.053_744_5e-2 * t2 - 1.387_768_6e-1) * t2 + 1.997_771_1e-1) * t2 - 3.333_295e-1;
    let angle = more + t + t * t2 * series;
    let angle = if y.abs() > x.abs() { FRAC_PI_2 - angle } else { angle };
    let angle = if x < 0.0 { PI - angle } else { angle };
    if y < 0.0 { -angle } else { angle }
}

/// How long a vector is.
#[inline(always)]
pub(crate) fn length(v: Vec2) -> f32 {
    sqrt(v.length_squared())
}

/// A vector made as long as 1; zero where it is too short for that.
#[inline(always)]
pub(crate) fn unit2(v: Vec2) -> Vec2 {
    let scale = 1.0 / length(v);
    if scale.is_finite() && scale > 0.0 { v * scale } else { Vec2::ZERO }
}

/// From 0 below `low` to 1 above `high`.
#[inline(always)]
pub(crate) fn step(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
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
    fn angles_are_those_of_the_standard_library() {
        for i in 0..100_000u32 {
            let angle = f64::from(i) * 1e-4;
            let (x, y) = ((angle.cos() * 3.0) as f32, (angle.sin() * 3.0) as f32);
            let of_std = f64::from(y).atan2(f64::from(x));
            assert!((f64::from(atan2(y, x)) - of_std).abs() < 4e-7, "{x}, {y}: {}", atan2(y, x));
        }
        assert_eq!((atan2(0.0, 0.0), atan2(0.0, 1.0), atan2(1.0, 0.0), atan2(0.0, -1.0)), (0.0, 0.0, FRAC_PI_2, PI));
    }

    #[test]
    fn powers_and_logarithms_are_those_of_the_standard_library() {
        for i in -100_000..=100_000 {
            let x = i as f32 * 8e-4;
            let (e, near) = (f64::from(x).exp(), f64::from(exp(x)));
            assert!((near / e - 1.0).abs() < 6e-7 * f64::from(x.abs().max(1.0)), "{x}: {near}");
            let twos = f64::from(log2(e as f32));
            assert!((twos - f64::from(e as f32).log2()).abs() < 4e-7 * twos.abs().max(1.0), "{e}: {twos}");
            assert_eq!(floor(x), x.floor());
        }
        assert_eq!((exp(-1000.0), exp(0.0), log2(1024.0), log2(1.0)), (0.0, 1.0, 10.0, 0.0));
    }

    #[test]
    fn small_differences_keep_their_digits() {
        for i in -200_000..200_000i32 {
            let x = i as f32 * 1e-5;
            if x == 0.0 {
                continue;
            }
            let wide = f64::from(x);
            assert!((f64::from(less_exp(x)) * wide / -(-wide).exp_m1() - 1.0).abs() < 3e-6, "{x}: {}", less_exp(x));
            if x < 1.0 {
                assert!((f64::from(log_less(x)) * wide / -(-wide).ln_1p() - 1.0).abs() < 3e-6, "{x}: {}", log_less(x));
            }
        }
        assert_eq!((less_exp(0.0), log_less(0.0), less_exp(1e30)), (1.0, 1.0, 1e-30));
    }

    #[test]
    fn unit_vectors_are_glams() {
        for v in [Vec3::new(3.0, -4.0, 12.0), Vec3::splat(1e-9), Vec3::new(0.1, 1e8, 2.0)] {
            assert_eq!((unit(v), unit_or(v, Vec3::Z)), (v.normalize(), v.normalize_or(Vec3::Z)));
        }
        assert_eq!(unit_or(Vec3::ZERO, Vec3::Z), Vec3::Z);
    }
}

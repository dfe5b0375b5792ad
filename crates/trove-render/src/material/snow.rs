//! Snow on what faces up: white as it fell, grey and uneven where wheels and feet have been, ragged where it ends.

use glam::{Vec2, Vec3, vec2};

use super::bsdf::Parameters;
use super::field::{TOO_WIDE_M, field, step};
use crate::surface::Surface;

/// Reflectance of snow a day old (Wiscombe and Warren 1980), and of slush full of grit.
const FRESH: Vec3 = Vec3::new(0.85, 0.87, 0.9);
const SLUSH: Vec3 = Vec3::new(0.36, 0.35, 0.33);
/// GGX α, and Oren and Nayar's roughness, of its grains.
const ALPHA: f32 = 0.6;
const DIFFUSE_ROUGHNESS: f32 = 0.3;
/// Share of the light through a leaf that snow on it keeps.
const OPAQUE: f32 = 0.8;
/// Cosines of slopes between which it begins to hold: 65° and 45°.
const HOLDS: [f32; 2] = [0.42, 0.7];
/// Widths of its waves as it fell and of what is left of it, metres, and their heights as shares of it.
const WAVES: [(f32, f32); 2] = [(0.3, 0.05), (0.09, 0.12)];
/// Samples that cover more than this see no waves, metres.
const WAVES_WIDE_M: f32 = 0.1;

/// Whether it may lie on a slope.
pub(crate) fn holds(outward_z: f32) -> bool {
    outward_z > HOLDS[0]
}

/// Lays snow on a point; returns its normal.
pub(super) fn lie(surface: &Surface, width_m: f32, normal: Vec3, p: &mut Parameters) -> Vec3 {
    let exposure = surface.exposure;
    let outward_z = surface.outward_z();
    let share = exposure.snow * exposure.left * step(HOLDS[0], HOLDS[1], outward_z);
    if share <= 0.0 {
        return normal;
    }
    let at = surface.point.truncate();
    let used = 1.0 - exposure.left;
    let covered = if width_m < TOO_WIDE_M {
        let low = 0.6 * field(at / 11.0) + 0.4 * field(vec2(at.y, -at.x) / 2.3);
        // All of it at 1, none at 0; what is pressed thins out softly.
        let soft = 0.1 + 0.4 * used;
        step(-soft, soft, (1.0 + 2.0 * soft) * below(share) - soft - low)
    } else {
        share
    };
    let grit = (used * (0.6 + 0.8 * field(vec2(at.y, at.x) / 5.0))).min(1.0);
    let keep = 1.0 - covered;
    p.base_color = p.base_color.lerp(FRESH.lerp(SLUSH, grit), covered);
    p.alpha += (ALPHA - p.alpha) * covered;
    p.diffuse_roughness += (DIFFUSE_ROUGHNESS - p.diffuse_roughness) * covered;
    p.translucency *= 1.0 - OPAQUE * covered;
    p.sheen *= keep;
    p.metalness *= keep;
    p.transmission *= keep;
    p.coat.share *= keep;
    let waves = if width_m < WAVES_WIDE_M { slope(at, used) } else { Vec2::ZERO };
    let side = if surface.is_front { 1.0 } else { -1.0 };
    let lying = (surface.shading - side * waves.extend(0.0)).normalize_or(surface.shading);
    normal.lerp(lying, covered).normalize_or(normal)
}

/// What the mixture of fields is below on this share of a plane, both being spread evenly.
fn below(share: f32) -> f32 {
    let near = |share: f32| (0.48 * share).sqrt();
    match share {
        s if s < 1.0 / 3.0 => near(s),
        s if s > 2.0 / 3.0 => 1.0 - near(1.0 - s),
        s => 0.4 + 0.6 * (s - 1.0 / 3.0),
    }
}

/// How steep its surface is against what it lies on, along x and y.
fn slope(at: Vec2, used: f32) -> Vec2 {
    let height_m = |p: Vec2| {
        let wave = |(width_m, share): (f32, f32)| width_m * share * field(p / (16.0 * width_m));
        wave(WAVES[0]) + used * wave(WAVES[1])
    };
    const STEP_M: f32 = 0.015;
    let here = height_m(at);
    vec2(height_m(at + Vec2::X * STEP_M) - here, height_m(at + Vec2::Y * STEP_M) - here) / STEP_M
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::bsdf::Coat;
    use crate::surface::Exposure;

    fn asphalt() -> Parameters {
        Parameters {
            base_color: Vec3::splat(0.1),
            alpha: 0.7,
            diffuse_roughness: 0.4,
            metalness: 0.0,
            f0: 0.04,
            coat: Coat { normal: Vec3::Z, share: 0.5, alpha: 0.003, f0: 0.02 },
            sheen: Vec3::ZERO,
            subsurface: 0.0,
            translucency: 0.0,
            transmission: 0.0,
            tint: Vec3::ONE,
        }
    }

    /// Mean reflectance of many places of a plane.
    fn reflectance(normal: Vec3, exposure: Exposure) -> f32 {
        let n = 4000;
        let place = |i: usize| {
            let point = Vec3::new(i as f32 * 1.37, i as f32 * 0.61, 0.0);
            let surface = Surface { exposure, ..Surface::plain(point, normal) };
            let mut p = asphalt();
            let shading = lie(&surface, 0.01, normal, &mut p);
            assert!(shading.is_normalized() && shading.dot(normal) > 0.5);
            p.base_color.y
        };
        (0..n).map(place).sum::<f32>() / n as f32
    }

    #[test]
    fn as_much_of_the_ground_is_white_as_snow_covers_and_none_of_a_wall() {
        let open = |snow: f32, left: f32| Exposure { snow, left, ..Exposure::BARE };
        let is = |found: f32, expected: f32| (found - expected).abs() < 1e-3;
        assert!(is(reflectance(Vec3::Z, open(0.0, 1.0)), 0.1));
        assert!(is(reflectance(Vec3::Z, open(1.0, 1.0)), FRESH.y));
        for snow in [0.25, 0.5, 0.75] {
            let share = (reflectance(Vec3::Z, open(snow, 1.0)) - 0.1) / (FRESH.y - 0.1);
            assert!((share - snow).abs() < 0.08, "{share} of {snow}");
        }
        assert!(reflectance(Vec3::Z, open(1.0, 0.5)) < 0.5);
        assert!(is(reflectance(Vec3::Y, open(1.0, 1.0)), 0.1));
        assert!(is(reflectance(Vec3::new(0.0, 0.5, 0.75f32.sqrt()), open(1.0, 1.0)), FRESH.y));
    }
}

//! What weather and use do to surfaces: streaks, stains and dust, damp and puddles. Procedural, so that it repeats
//! nowhere.

use glam::{Vec2, Vec3, vec2};

use super::water;
use crate::bsdf::{Coat, Parameters};
use crate::lookups::Lookups;
use crate::math::{exp, length, step, unit_or};
use crate::surface::Surface;

/// Samples that cover more than this see the mean of what weather does, metres.
pub(super) const TOO_WIDE_M: f32 = 3.0;

/// Dust of roads.
const DUST: Vec3 = Vec3::new(0.155, 0.14, 0.115);
/// Up to about this height wheels and rain throw it, metres.
const SPLASH_M: f32 = 0.7;
/// Normal reflectance of water.
pub(super) const WATER_F0: f32 = 0.02;
/// GGX α of water that stands, and of a film over something rough: of what rain has just begun to wet, and of what it runs
/// over.
const STILL: f32 = 0.004;
const FILM: [f32; 2] = [0.35, 0.06];

/// Streaks, stains and dust.
#[inline(always)]
pub(super) fn soil(lookups: &Lookups, surface: &Surface, dirt: f32, width_m: f32, p: &mut Parameters) {
    if width_m >= TOO_WIDE_M {
        return;
    }
    // Windows are washed.
    let left = dirt * step(0.01, 0.1, p.alpha);
    if surface.shading.z.abs() > 0.7 {
        stain(lookups, surface.point_mesh.truncate(), left, p);
    } else {
        streak(lookups, surface, left, p);
    }
    splash(lookups, surface, dirt, p);
}

/// Level ground: broad tones of wear and dust, blotches of oil.
#[inline(always)]
fn stain(lookups: &Lookups, at: Vec2, dirt: f32, p: &mut Parameters) {
    let (broad, fine) = (lookups.noise(at / 61.0), lookups.noise(vec2(at.y, -at.x) / 9.0));
    let tone = 0.45 * (broad - 0.5) + 0.3 * (fine - 0.5);
    let oil = step(0.84, 0.95, fine) * step(0.3, 0.7, broad);
    p.base_color *= (1.0 + dirt * tone) * (1.0 - 0.4 * dirt * oil);
    p.alpha *= 1.0 - 0.3 * dirt * oil;
}

/// Walls: water runs down and takes dirt along.
#[inline(always)]
fn streak(lookups: &Lookups, surface: &Surface, dirt: f32, p: &mut Parameters) {
    let at = surface.point_mesh;
    let n = surface.shading;
    let along = (at.y * n.x - at.x * n.y) / length(n.truncate()).max(1e-3);
    let (runs, broad) = (lookups.noise(vec2(along / 2.6, at.z / 37.0)), lookups.noise(vec2(along / 31.0, at.z / 23.0)));
    let dark = step(0.5, 1.0, runs) * (0.3 + 0.7 * broad) + 0.3 * (broad - 0.5);
    p.base_color *= 1.0 - 0.5 * dirt * dark;
}

/// Dust near the foot of everything.
#[inline(always)]
fn splash(lookups: &Lookups, surface: &Surface, dirt: f32, p: &mut Parameters) {
    let height = surface.above_foot_m / SPLASH_M;
    if surface.shading.z.abs() > 0.7 || height > 2.0 {
        return;
    }
    let at = surface.point_mesh;
    let ragged = lookups.noise(vec2(at.x + at.y, at.z) / 3.0);
    let share = 0.75 * dirt * exp(-height * height) * (0.5 + ragged);
    p.base_color = p.base_color.lerp(DUST, share.min(1.0));
    p.coat.share *= 1.0 - share.min(1.0);
    p.alpha += (0.5 - p.alpha).max(0.0) * share.min(1.0);
}

/// Rain darkens what is porous (Lagarde 2013, after Jensen et al. 1999), lies as a film on what is level, and stands
/// in its low places.
#[inline(always)]
pub(super) fn rain(
    lookups: &Lookups,
    surface: &Surface,
    wetness: f32,
    width_m: f32,
    normal: Vec3,
    p: &mut Parameters,
) -> Vec3 {
    let outward = surface.outward_z();
    let level = step(0.7, 0.97, outward);
    // Walls get what the wind drives.
    let damp = wetness * (0.3 * step(-0.3, 0.2, outward) + 0.7 * level);
    let full = (0.7 * (wetness - 0.4)).max(0.0) * level;
    let puddle = if full <= 0.0 {
        0.0
    } else if width_m < TOO_WIDE_M {
        let at = surface.point.truncate();
        let low = 0.75 * lookups.noise(at / 43.0) + 0.25 * lookups.noise(vec2(at.y, -at.x) / 11.0);
        step(1.0 - full, 1.08 - full, low + 0.1 * (lookups.noise(at / 2.7) - 0.5))
    } else {
        full
    };
    let soaked = damp.max(puddle);
    soak(soaked, p);
    let film = wetness * level * 0.8;
    let water = film.max(puddle);
    if p.coat.share > 0.0 || p.transmission > 0.0 {
        // Off lacquer and glass it beads.
        let tilt = water::bead(surface, 0.4 * damp);
        p.coat.normal = unit_or(p.coat.normal + tilt, p.coat.normal);
        return if p.transmission > 0.0 { unit_or(normal + tilt, normal) } else { normal };
    }
    // Cloth soaks it up.
    if water > 0.0 && p.sheen == Vec3::ZERO {
        let mut normal = unit_or(normal.lerp(surface.shading, (0.4 + 0.5 * wetness).max(puddle)), normal);
        if puddle > 0.0 {
            normal = unit_or(normal + water::rings(surface) * puddle, normal);
        }
        let film = FILM[0] + (FILM[1] - FILM[0]) * wetness;
        let alpha = film + (STILL - film) * puddle;
        p.coat = Coat { normal, share: water, alpha, f0: WATER_F0 };
    }
    unit_or(normal.lerp(surface.shading, puddle), normal)
}

/// Water in pores; returns the share of it that found any.
#[inline(always)]
pub(super) fn soak(soaked: f32, p: &mut Parameters) -> f32 {
    let held = soaked * step(0.2, 0.6, p.alpha) * (1.0 - p.metalness);
    p.base_color *= Vec3::ONE.lerp(0.45 + 0.35 * p.base_color, held);
    p.alpha *= 1.0 - 0.5 * soaked;
    p.diffuse_roughness *= 1.0 - soaked;
    held
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::LOOKUPS;

    fn asphalt() -> Parameters {
        Parameters {
            base_color: Vec3::splat(0.15),
            alpha: 0.7,
            diffuse_roughness: 0.4,
            metalness: 0.0,
            f0: 0.04,
            coat: Coat { normal: Vec3::Z, share: 0.0, alpha: 0.003, f0: 0.04 },
            sheen: Vec3::ZERO,
            subsurface: 0.0,
            translucency: 0.0,
            transmission: 0.0,
            tint: Vec3::ONE,
        }
    }

    #[test]
    fn the_more_it_rains_the_darker_and_smoother_is_the_road() {
        let mut last = (1.0, 1.0);
        for wetness in [0.0, 0.3, 0.6, 1.0] {
            let (mut reflectance, mut alpha) = (0.0, 0.0);
            for i in 0..400 {
                let mut p = asphalt();
                let at = Vec3::new(i as f32 * 1.7, i as f32 * 0.9, 0.0);
                if wetness > 0.0 {
                    rain(&LOOKUPS, &Surface::plain(at, Vec3::Z), wetness, 0.01, Vec3::Z, &mut p);
                }
                reflectance += p.base_color.x / 400.0;
                alpha += (p.alpha + (p.coat.alpha - p.alpha) * p.coat.share) / 400.0;
            }
            assert!(reflectance < last.0 && alpha < last.1, "{reflectance}, {alpha} at {wetness}");
            last = (reflectance, alpha);
        }
        assert!((0.06..0.11).contains(&last.0) && last.1 < 0.25, "{last:?}");
    }

    #[test]
    fn a_wall_has_no_puddles_and_is_dustier_at_its_foot() {
        let mut low = asphalt();
        let wall = |z: f32| Surface::plain(Vec3::new(3.0, 0.0, z), Vec3::Y);
        soil(&LOOKUPS, &wall(0.1), 1.0, 0.01, &mut low);
        rain(&LOOKUPS, &wall(0.1), 1.0, 0.01, Vec3::Y, &mut low);
        assert_eq!(low.coat.share, 0.0);
        let dust = |z: f32| {
            let mut p = Parameters { base_color: Vec3::X, ..asphalt() };
            soil(&LOOKUPS, &wall(z), 1.0, 0.01, &mut p);
            p.base_color.y
        };
        assert!(dust(0.1) > 0.03 && dust(3.0) == 0.0);
    }
}

//! Where on its textures a surface's point lies.

use glam::{IVec2, IVec3, Vec2, Vec3, vec2};

use crate::math::{floor2, sqrt};
use crate::surface::Surface;

/// Nodes of the lattice of patches for each repetition of the texture: patches are about two thirds of it wide.
const NODES: f32 = 1.5;

const ROOT_3: f32 = 1.732_050_8;

/// A place on textures, and the world around it.
#[derive(Clone, Copy)]
pub(super) struct Spot {
    /// Texture coordinates.
    pub(super) uv: Vec2,
    /// Width of what one sample covers, in texture coordinates.
    pub(super) footprint: Vec2,
    /// Directions in which u and v grow, not normalised; `None` where the mesh has no useful uvs.
    pub(super) axes: Option<[Vec3; 2]>,
    /// Metres in World for 1 of u and of v.
    pub(super) metres: Vec2,
    /// Uniform in [0, 1), and independent of everything above.
    pub(super) dither: f32,
}

/// How textures are laid.
#[derive(Clone, Copy)]
pub(super) struct Tiling {
    /// What texture coordinates are multiplied by.
    pub(super) scale: Vec2,
    /// Along World's axes instead of by the mesh's coordinates.
    pub(super) is_triplanar: bool,
    /// In patches, so that nobody sees them repeat.
    pub(super) is_stochastic: bool,
}

/// The spot of a point; `width_m` is the width of what a sample covers there.
///
/// Where patches or directions are mixed `dither` chooses one of them: the mean over many samples is the mixture,
/// and each takes one look-up.
#[inline(always)]
pub(super) fn laid(tiling: Tiling, surface: &Surface, width_m: f32, dither: f32) -> Spot {
    let mut dither = dither;
    let (uv, axes) = if tiling.is_triplanar {
        triplanar(surface, &mut dither)
    } else {
        (surface.uv, (surface.uv_axes != [Vec3::ZERO; 2]).then_some(surface.uv_axes))
    };
    let uv = uv * tiling.scale;
    let uv = if tiling.is_stochastic { uv + patch(uv * NODES, &mut dither) } else { uv };
    let scale = tiling.scale.abs().max(Vec2::splat(1e-9));
    let metres = axes.map_or(Vec2::INFINITY, |[u, v]| {
        vec2(sqrt(u.length_squared()), sqrt(v.length_squared())).max(Vec2::splat(1e-9)) / scale
    });
    Spot { uv, footprint: width_m / metres, axes, metres, dither }
}

/// Coordinates along one of the World's axes, the likelier the more the surface faces it.
fn triplanar(surface: &Surface, dither: &mut f32) -> (Vec2, Option<[Vec3; 2]>) {
    let facing = surface.shading * surface.shading;
    let p = surface.point;
    match choose(facing * facing, dither) {
        0 => (vec2(p.y, p.z), Some([Vec3::Y, Vec3::Z])),
        1 => (vec2(p.x, p.z), Some([Vec3::X, Vec3::Z])),
        _ => (vec2(p.x, p.y), Some([Vec3::X, Vec3::Y])),
    }
}

/// How far the texture is shifted in the patch around one of the three nodes of a triangular lattice that `p` lies
/// between, mostly the nearest.
fn patch(p: Vec2, dither: &mut f32) -> Vec2 {
    let skewed = vec2(p.x - p.y / ROOT_3, p.y * 2.0 / ROOT_3);
    let cell = floor2(skewed);
    let f = skewed - cell;
    let up = f.x + f.y < 1.0;
    let weights =
        if up { Vec3::new(1.0 - f.x - f.y, f.x, f.y) } else { Vec3::new(f.x + f.y - 1.0, 1.0 - f.x, 1.0 - f.y) };
    // A sharper mixture keeps contrast: few samples of a picture fall between patches.
    let sharp = weights * weights * weights;
    let node = match (choose(sharp * sharp, dither), up) {
        (0, true) => IVec2::ZERO,
        (1, true) | (2, false) => IVec2::X,
        (2, true) | (1, false) => IVec2::Y,
        _ => IVec2::ONE,
    };
    random(cell.as_ivec2() + node)
}

/// Draws one of three by their weights, and makes `dither` a fresh number.
fn choose(weights: Vec3, dither: &mut f32) -> usize {
    let at = *dither * weights.element_sum();
    let (mut which, mut from) = (0, 0.0);
    while which < 2 && at >= from + weights[which] {
        from += weights[which];
        which += 1;
    }
    *dither = ((at - from) / weights[which]).clamp(0.0, 1.0 - f32::EPSILON);
    which
}

/// Two random numbers in [0, 1) of a lattice point.
fn random(node: IVec2) -> Vec2 {
    let h = bits(node.extend(0));
    vec2((h & 0xffff) as f32, (h >> 16) as f32) / 65536.0
}

/// Three random numbers in [0, 1) of a lattice point.
pub(crate) fn random3(node: IVec3) -> Vec3 {
    let h = bits(node);
    Vec3::new((h & 0x3ff) as f32, (h >> 10 & 0x3ff) as f32, (h >> 20 & 0x3ff) as f32) / 1024.0
}

fn bits(node: IVec3) -> u32 {
    let [x, y, z] = node.to_array().map(|i| i as u32);
    let mut h = x.wrapping_mul(0x8da6_b343) ^ y.wrapping_mul(0xd816_3841) ^ z.wrapping_mul(0xcb1a_b31f);
    h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    h ^ (h >> 15)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(is_stochastic: bool, is_triplanar: bool, x: f32, y: f32, dither: f32) -> Spot {
        let up = Surface::plain(Vec3::new(x, y, 5.0), Vec3::Z);
        let surface = Surface { uv: vec2(x, y), uv_axes: [Vec3::X, Vec3::Y], ..up };
        laid(Tiling { scale: Vec2::splat(0.5), is_stochastic, is_triplanar }, &surface, 0.1, dither)
    }

    #[test]
    fn stochastic_tiling_hides_the_period() {
        // A texture of which no two places are alike: the autocorrelation of what is seen at one period's distance.
        let value = |spot: Spot| {
            let cell = (spot.uv.rem_euclid(Vec2::ONE) * 64.0).as_ivec2();
            random(cell + IVec2::splat(1000)).x - 0.5
        };
        let correlation = |is_stochastic| {
            let (mut sum, n) = (0.0, 20_000);
            for i in 0..n {
                let p = random(IVec2::new(i, 7)) * 60.0;
                let dither = random(IVec2::new(i, 8));
                let here = value(at(is_stochastic, false, p.x, p.y, dither.x));
                sum += here * value(at(is_stochastic, false, p.x + 2.0, p.y, dither.y)) * 12.0;
            }
            sum / n as f32
        };
        let (repeated, stochastic) = (correlation(false), correlation(true));
        assert!(repeated > 0.95 && stochastic < 0.1, "{repeated}, {stochastic}");
    }

    #[test]
    fn a_patch_is_wide_and_its_inside_is_untouched() {
        // Neighbouring points mostly show neighbouring texels.
        let n = 10_000;
        let apart = (0..n).filter(|&i| {
            let (p, dither) = (random(IVec2::new(i, 1)) * 50.0, random(IVec2::new(i, 2)).x);
            let spot = |x| at(true, false, x, p.y, dither).uv;
            (spot(p.x + 0.02) - spot(p.x) - vec2(0.01, 0.0)).length() > 1e-3
        });
        let apart = apart.count();
        assert!(apart * 20 < n as usize, "{apart} of {n}");
    }

    #[test]
    fn what_faces_up_is_seen_from_above_and_metres_are_metres() {
        let spot = at(false, true, 3.0, 4.0, 0.7);
        assert_eq!((spot.uv, spot.footprint, spot.metres), (vec2(1.5, 2.0), Vec2::splat(0.05), Vec2::splat(2.0)));
        assert!((0.0..1.0).contains(&spot.dither));
    }
}

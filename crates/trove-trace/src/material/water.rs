//! Water as it lies: beads on what sheds it, and rings where drops fall into puddles.

use glam::{IVec3, Vec2, Vec3, vec2};

use super::texturing::random3;
use crate::math::{exp, floor, floor2, length, turn, unit2};
use crate::surface::Surface;

/// Side of the squares with one bead each, and the radii of beads, metres.
const BEAD_CELL_M: f32 = 0.009;
const BEADS_M: [f32; 2] = [0.001, 0.0042];
/// Beads of all radii cover this share of their squares.
const BEADS_COVER: f32 = 0.295;
/// Slope at a bead's edge: on lacquer water stands at some 70°, and drops that run are flatter.
const BEAD_SLOPE: f32 = 1.2;

/// Layers of squares with one ring each, their side, and how far a ring gets, metres.
const LAYERS: i32 = 5;
/// A layer is turned by this share of a whole turn against the one before.
const TURN: f32 = 0.175;
const RING_CELL_M: f32 = 0.25;
const RING_M: f32 = 0.1;
/// Seconds that it takes: waves of capillarity and weight run at 0.23 m/s at least (Lamb, Hydrodynamics, § 267).
const RING_S: f32 = 0.4;
/// Its waves, which are about that slow: their length and how far they reach to both sides of its front, metres, and their
/// steepest slope at first.
const WAVE_M: f32 = 0.017;
const FRONT_M: f32 = 0.013;
const STEEPEST: f32 = 0.3;
/// Rain in which a square of a layer has a ring at nearly two thirds of all times, millimetres an hour.
const DENSE_MM_H: f32 = 6.0;

/// How the normal is tilted by a bead at a point of something wet, of which beads cover so large a share; 0 between them.
#[inline(always)]
pub(super) fn bead(surface: &Surface, share: f32) -> Vec3 {
    let normal = surface.shading;
    let at = surface.point_mesh;
    // In the plane that it faces most: beads stay where they are on a thing that moves.
    let facing = normal.abs();
    let (at, axes, side) = if facing.z >= facing.max_element() {
        (vec2(at.x, at.y), [Vec3::X, Vec3::Y], 0)
    } else if facing.x > facing.y {
        (vec2(at.y, at.z), [Vec3::Y, Vec3::Z], 1)
    } else {
        (vec2(at.x, at.z), [Vec3::X, Vec3::Z], 2)
    };
    let cell = floor2(at / BEAD_CELL_M);
    let random = |salt: i32| random3(IVec3::new(cell.x as i32, cell.y as i32, side + salt));
    if random(3).x >= share / BEADS_COVER {
        return Vec3::ZERO;
    }
    let place = random(0);
    let radius = BEADS_M[0] + (BEADS_M[1] - BEADS_M[0]) * place.z;
    let centre = (cell + 0.5) * BEAD_CELL_M + (place.truncate() - 0.5) * (BEAD_CELL_M - 2.0 * radius);
    let away = (at - centre) / radius;
    if away.length_squared() >= 1.0 {
        return Vec3::ZERO;
    }
    (axes[0] * away.x + axes[1] * away.y).reject_from_normalized(normal) * BEAD_SLOPE
}

/// How the normal of a puddle is tilted by the rings of drops.
#[inline(always)]
pub(super) fn rings(surface: &Surface) -> Vec3 {
    let exposure = surface.exposure;
    let share = 1.0 - exp(-exposure.rain_mm_h / DENSE_MM_H);
    if share <= 0.0 {
        return Vec3::ZERO;
    }
    let mut slope = Vec2::ZERO;
    for layer in 0..LAYERS {
        // Each layer is shifted and turned, so that no grid is seen.
        let (sin, cos) = turn(TURN * layer as f32);
        let turned = vec2(cos, sin);
        let at = turned.rotate(surface.point.truncate()) / RING_CELL_M + 0.37 * layer as f32;
        let cell = floor2(at);
        let random = |salt: i32| random3(IVec3::new(cell.x as i32, cell.y as i32, salt));
        // One ring after another.
        let time = exposure.moment_s / RING_S + random(layer).z;
        let drawn = random((1.0 + time) as i32 * LAYERS + layer);
        if drawn.z >= share {
            continue;
        }
        let (age, room) = (time - floor(time), 1.0 - 2.0 * (RING_M + FRONT_M) / RING_CELL_M);
        let centre = Vec2::splat(0.5) + (drawn.truncate() - 0.5) * room;
        let away = (at - cell - centre) * RING_CELL_M;
        let behind = length(away) - age * RING_M;
        let (fades, waves) = (behind / FRONT_M, behind / WAVE_M);
        let steep = STEEPEST * (1.0 - age) * exp(-fades * fades) * turn(waves - floor(waves)).1;
        slope += (turned * vec2(1.0, -1.0)).rotate(unit2(away)) * steep;
    }
    -slope.extend(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Exposure;

    const PLACES: usize = 20_000;

    /// Tilts at places all over some square metres of a puddle.
    fn tilts(rain_mm_h: f32, moment_s: f32) -> impl Iterator<Item = Vec3> {
        let exposure = Exposure { rain_mm_h, moment_s, ..Exposure::BARE };
        (0..PLACES).map(move |i| {
            let at = vec2((i % 200) as f32, (i / 200) as f32) * 0.0137;
            rings(&Surface { exposure, ..Surface::plain(at.extend(0.0), Vec3::Z) })
        })
    }

    #[test]
    fn rings_are_many_in_heavy_rain_few_in_drizzle_and_none_without() {
        let share =
            |rain_mm_h: f32| tilts(rain_mm_h, 3.0).filter(|tilt| tilt.length() > 0.01).count() as f32 / PLACES as f32;
        let [none, drizzle, heavy] = [0.0, 0.5, 20.0].map(share);
        assert!(none == 0.0 && (0.01..0.2).contains(&drizzle) && heavy > 0.35, "{none} {drizzle} {heavy}");
    }

    #[test]
    fn rings_spread_and_lean_nowhere() {
        let mean = tilts(10.0, 1.0).sum::<Vec3>() / PLACES as f32;
        let steepest = tilts(10.0, 1.0).map(Vec3::length).fold(0.0, f32::max);
        assert!(mean.length() < 0.003 && (0.1..1.0).contains(&steepest), "{mean} {steepest}");
        let moved = tilts(10.0, 1.0).zip(tilts(10.0, 1.1)).filter(|(a, b)| (*a - *b).length() > 0.01).count();
        assert!(moved > PLACES / 10, "{moved}");
    }

    #[test]
    fn beads_cover_the_share_that_is_asked_for_and_lean_nowhere() {
        let mut random = trove_model::Seed(2).random();
        for (normal, share) in [(Vec3::Z, 0.28), (Vec3::X, 0.15), (Vec3::new(0.0, 0.6, 0.8), 0.0)] {
            let (mut covered, mut mean) = (0.0, Vec3::ZERO);
            for _ in 0..PLACES {
                let point = Vec3::from_array(std::array::from_fn(|_| random.unit() as f32));
                let tilt = bead(&Surface::plain(point, normal), share);
                assert!(tilt.dot(normal).abs() < 1e-5 && tilt.length() <= BEAD_SLOPE * 1.001);
                covered += f32::from(u8::from(tilt != Vec3::ZERO)) / PLACES as f32;
                mean += tilt / PLACES as f32;
            }
            assert!((covered - share).abs() < 0.02 && mean.length() < 0.02, "{share}: {covered} {mean}");
        }
    }
}

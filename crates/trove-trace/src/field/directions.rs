//! Light by direction, in equal parts of the sphere.

use core::f32::consts::{FRAC_1_SQRT_2, FRAC_PI_4, PI};

use glam::{Vec2, Vec3};

use crate::math::{atan2, eighth, floor2, sqrt};

/// Parts along each side of a square onto which the sphere is unfolded.
const SIDE: usize = 8;
/// How many parts there are.
pub const PARTS: usize = SIDE * SIDE;
/// The solid angle of one.
pub const PART_SR: f32 = 4.0 * PI / PARTS as f32;

/// Light of each part.
pub type ByDirection = [Vec3; PARTS];

/// The direction at a place in the square from 0 to 1, which keeps areas (Clarberg 2008).
fn direction_at(place: Vec2) -> Vec3 {
    let Vec2 { x, y } = place * 2.0 - 1.0;
    let beyond = 1.0 - (x.abs() + y.abs());
    let r = 1.0 - beyond.abs();
    // From the diagonal of its quarter.
    let (s, c) = eighth(if r == 0.0 { 0.0 } else { FRAC_PI_4 * (y.abs() - x.abs()) / r });
    let (sin, cos) = ((c + s) * FRAC_1_SQRT_2, (c - s) * FRAC_1_SQRT_2);
    let across = r * sqrt(2.0 - r * r);
    Vec3::new((across * cos).copysign(x), (across * sin).copysign(y), (1.0 - r * r).copysign(beyond))
}

/// The inverse.
#[inline(always)]
fn place_of(direction: Vec3) -> Vec2 {
    let Vec3 { x, y, z } = direction;
    let r = sqrt((1.0 - z.abs()).max(0.0));
    let along = atan2(y.abs(), x.abs()) / FRAC_PI_4 * 0.5 * r;
    let place = Vec2::new(r - along, along);
    let place = if z >= 0.0 { place } else { Vec2::ONE - Vec2::new(place.y, place.x) };
    Vec2::new(place.x.copysign(x), place.y.copysign(y)) * 0.5 + 0.5
}

/// A direction in a part, by two numbers in [0, 1).
#[inline]
pub fn direction_in(part: usize, u: [f32; 2]) -> Vec3 {
    direction_at((Vec2::new((part % SIDE) as f32, (part / SIDE) as f32) + Vec2::from(u)) / SIDE as f32)
}

/// The part that a unit direction lies in.
#[inline]
pub fn part_of(direction: Vec3) -> usize {
    let at = (place_of(direction) * SIDE as f32).min(Vec2::splat(SIDE as f32 - 1.0)).max(Vec2::ZERO);
    at.y as usize * SIDE + at.x as usize
}

/// Parts around a direction and their weights.
#[inline]
pub fn parts_around(direction: Vec3) -> [(usize, f32); 4] {
    let at = place_of(direction) * SIDE as f32 - 0.5;
    let low = floor2(at);
    let share = at - low;
    let last = SIDE as i32 - 1;
    core::array::from_fn(|corner| {
        let (right, down) = ((corner & 1) as i32, (corner >> 1) as i32);
        let (mut x, mut y) = (low.x as i32 + right, low.y as i32 + down);
        // Across an edge the square's other half begins.
        if x < 0 || x > last {
            (x, y) = (x.clamp(0, last), last - y);
        }
        if y < 0 || y > last {
            (x, y) = (last - x, y.clamp(0, last));
        }
        let weight = |high: i32, share: f32| if high == 1 { share } else { 1.0 - share };
        (y as usize * SIDE + x as usize, weight(right, share.x) * weight(down, share.y))
    })
}

#[cfg(test)]
mod tests {
    use trove_model::Seed;

    use super::*;

    /// Directions evenly all around.
    fn all_around(n: u32) -> impl Iterator<Item = Vec3> {
        let mut random = Seed(2).random();
        let mut normal = move || random.normal() as f32;
        (0..n).map(move |_| Vec3::new(normal(), normal(), normal()).normalize())
    }

    #[test]
    fn parts_are_as_large_as_each_other_and_know_their_directions() {
        let mut found = [0u32; PARTS];
        for direction in all_around(64_000) {
            assert!((direction_at(place_of(direction)) - direction).length() < 1e-3, "{direction}");
            found[part_of(direction)] += 1;
        }
        // Five standard deviations of a thousand.
        assert!(found.iter().all(|&n| (840..1160).contains(&n)), "{found:?}");
        let within = |part| part_of(direction_in(part, [0.4, 0.7])) == part;
        assert!((0..PARTS).all(within));
    }

    #[test]
    fn what_lies_between_parts_changes_without_a_jump() {
        // The middles of the parts, which are 25° wide.
        let middles: [Vec3; PARTS] = std::array::from_fn(|part| direction_in(part, [0.5; 2]));
        let middle = |d| parts_around(d).iter().map(|&(part, weight)| middles[part] * weight).sum::<Vec3>();
        for direction in all_around(20_000) {
            let (found, beside) = (middle(direction), middle((direction + Vec3::splat(1e-4)).normalize()));
            assert!((found - direction).length() < 0.3, "{direction}: {found}");
            assert!((found - beside).length() < 2e-3, "{direction}: {found}, {beside}");
            assert!((parts_around(direction).iter().map(|(_, weight)| weight).sum::<f32>() - 1.0).abs() < 1e-5);
        }
    }
}

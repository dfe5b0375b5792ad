//! Light by direction, in equal parts of the sphere.

use std::f32::consts::{FRAC_PI_4, PI};

use glam::{Vec2, Vec3};

/// Parts along each side of a square onto which the sphere is unfolded.
const SIDE: usize = 8;
pub(crate) const PARTS: usize = SIDE * SIDE;
/// The solid angle of one.
pub(crate) const PART_SR: f32 = 4.0 * PI / PARTS as f32;
/// Directions across a part that kernels are measured with.
const ACROSS: usize = 3;

/// Light of each part.
pub(crate) type ByDirection = [Vec3; PARTS];

/// The direction at a place in the square from 0 to 1, which keeps areas (Clarberg 2008).
fn direction_at(place: Vec2) -> Vec3 {
    let Vec2 { x, y } = place * 2.0 - 1.0;
    let beyond = 1.0 - (x.abs() + y.abs());
    let r = 1.0 - beyond.abs();
    let angle = if r == 0.0 { 0.0 } else { FRAC_PI_4 * ((y.abs() - x.abs()) / r + 1.0) };
    let across = r * (2.0 - r * r).sqrt();
    let (sin, cos) = angle.sin_cos();
    Vec3::new((across * cos).copysign(x), (across * sin).copysign(y), (1.0 - r * r).copysign(beyond))
}

/// The inverse.
fn place_of(direction: Vec3) -> Vec2 {
    let Vec3 { x, y, z } = direction;
    let r = (1.0 - z.abs()).max(0.0).sqrt();
    let along = y.abs().atan2(x.abs()) / FRAC_PI_4 * 0.5 * r;
    let place = Vec2::new(r - along, along);
    let place = if z >= 0.0 { place } else { Vec2::ONE - Vec2::new(place.y, place.x) };
    Vec2::new(place.x.copysign(x), place.y.copysign(y)) * 0.5 + 0.5
}

/// A direction in a part, by two numbers in [0, 1).
pub(crate) fn direction_in(part: usize, u: [f32; 2]) -> Vec3 {
    direction_at((Vec2::new((part % SIDE) as f32, (part / SIDE) as f32) + Vec2::from(u)) / SIDE as f32)
}

/// The part that a unit direction lies in.
pub(crate) fn part_of(direction: Vec3) -> usize {
    let at = (place_of(direction) * SIDE as f32).min(Vec2::splat(SIDE as f32 - 1.0)).max(Vec2::ZERO);
    at.y as usize * SIDE + at.x as usize
}

/// Parts around a direction and their weights.
pub(crate) fn parts_around(direction: Vec3) -> [(usize, f32); 4] {
    let at = place_of(direction) * SIDE as f32 - 0.5;
    let low = at.floor();
    let share = at - low;
    let last = SIDE as i32 - 1;
    std::array::from_fn(|corner| {
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

/// What becomes of light from all parts: a row of weights for each part.
pub(crate) struct Kernel(Vec<[f32; PARTS]>);

impl Kernel {
    /// By a function of the cosine between the parts' directions; each row sums to `sum`.
    pub(crate) fn new(sum: f32, of: impl Fn(f32) -> f32) -> Self {
        let within = |part| {
            let share = |k: usize| (k as f32 + 0.5) / ACROSS as f32;
            (0..ACROSS * ACROSS).map(move |k| direction_in(part, [share(k % ACROSS), share(k / ACROSS)]))
        };
        let row = |to| {
            let mut row: [f32; PARTS] =
                std::array::from_fn(|from| within(to).map(|a| within(from).map(|b| of(a.dot(b))).sum::<f32>()).sum());
            let total: f32 = row.iter().sum();
            row.iter_mut().for_each(|weight| *weight *= sum / total);
            row
        };
        Self((0..PARTS).map(row).collect())
    }

    pub(crate) fn of(&self, light: &ByDirection) -> ByDirection {
        std::array::from_fn(|to| self.0[to].iter().zip(light).map(|(&weight, &light)| weight * light).sum())
    }
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

    #[test]
    fn light_lights_surfaces_as_its_closed_form_says() {
        let kernel = Kernel::new(PI, |cos| cos.max(0.0));
        assert!(kernel.of(&[Vec3::ONE; PARTS]).iter().all(|of| (of.x - PI).abs() < 1e-4));
        // Radiance 1 + z gives π + 2π/3 z (Ramamoorthi and Hanrahan 2001).
        let height = |part| direction_in(part, [0.5; 2]).z;
        let lit = kernel.of(&std::array::from_fn(|part| Vec3::splat(1.0 + height(part))));
        for (part, lit) in lit.iter().enumerate() {
            let expected = PI + 2.0 * PI / 3.0 * height(part);
            assert!((lit.x - expected).abs() < 0.15, "{part}: {lit} instead of {expected}");
        }
    }
}

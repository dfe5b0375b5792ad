//! Points that are evenly spread and yet in no pattern.

use glam::{DVec2, IVec2};
use trove_model::{Bounds, Seed};

/// Side of the tile, in least distances.
const SIDE: f64 = 40.0;
/// Cells of the tile's grid each way: a cell's diagonal is less than the least distance, so it holds one point.
const CELLS: i32 = 57;
/// Candidates around a point before it is given up.
const TRIES: usize = 24;

/// A tile of points at least 1 apart that repeats in both directions.
///
/// Robert Bridson, *Fast Poisson Disk Sampling in Arbitrary Dimensions* (SIGGRAPH 2007), on a torus.
pub(super) struct BlueNoise {
    points: Vec<DVec2>,
}

impl BlueNoise {
    pub(super) fn new(seed: Seed) -> Self {
        let mut random = seed.random();
        let mut grid: Vec<Option<DVec2>> = vec![None; (CELLS * CELLS) as usize];
        let cell = |p: DVec2| (p * f64::from(CELLS) / SIDE).as_ivec2().min(IVec2::splat(CELLS - 1));
        let slot = |c: IVec2| (c.y.rem_euclid(CELLS) * CELLS + c.x.rem_euclid(CELLS)) as usize;
        let first = DVec2::new(random.unit(), random.unit()) * SIDE;
        grid[slot(cell(first))] = Some(first);
        let (mut points, mut active) = (vec![first], vec![first]);
        while !active.is_empty() {
            let i = random.index(active.len());
            let found = (0..TRIES).find_map(|_| {
                let angle = random.range(0.0, std::f64::consts::TAU);
                // As many at every distance from 1 to 2 as there is room.
                let reach = random.range(1.0, 4.0).sqrt();
                let p = (active[i] + DVec2::from_angle(angle) * reach).rem_euclid(DVec2::splat(SIDE));
                let middle = cell(p);
                let near = (-2..=2).flat_map(|y| (-2..=2).map(move |x| IVec2::new(x, y)));
                let apart = near.filter_map(|d| grid[slot(middle + d)]).all(|q| distance(p, q) >= 1.0);
                apart.then_some(p)
            });
            match found {
                Some(p) => {
                    grid[slot(cell(p))] = Some(p);
                    points.push(p);
                    active.push(p);
                }
                None => {
                    active.swap_remove(i);
                }
            }
        }
        Self { points }
    }

    /// Points at least `least_m` apart over a rectangle, about 0.62 of them to a square of that side; `shift` tells several
    /// sets apart.
    pub(super) fn over(&self, bounds: Bounds, least_m: f64, shift: Seed) -> impl Iterator<Item = DVec2> + '_ {
        let mut random = shift.random();
        let origin = DVec2::new(random.unit(), random.unit()) * SIDE * least_m;
        let period_m = SIDE * least_m;
        let low = ((bounds.min - origin) / period_m).floor().as_i64vec2();
        let high = ((bounds.max - origin) / period_m).floor().as_i64vec2();
        let tiles = (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| DVec2::new(x as f64, y as f64)));
        tiles
            .flat_map(move |tile| self.points.iter().map(move |p| origin + (tile * SIDE + *p) * least_m))
            .filter(move |p| bounds.contains(*p))
    }
}

/// On the torus.
fn distance(p: DVec2, q: DVec2) -> f64 {
    let d = (p - q).abs();
    d.min(SIDE - d).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_points_are_too_near_and_there_is_no_room_for_another() {
        let bounds = Bounds::square(DVec2::new(30.0, -70.0), 260.0);
        let noise = BlueNoise::new(Seed(4));
        let points: Vec<DVec2> = noise.over(bounds, 3.0, Seed(1)).collect();
        for (i, p) in points.iter().enumerate() {
            assert!(bounds.contains(*p) && points[..i].iter().all(|q| q.distance(*p) > 2.999), "{p}");
        }
        let share = points.len() as f64 * 9.0 / 260f64.powi(2);
        assert!((0.58..0.8).contains(&share), "{share}");
        let mut random = Seed(2).random();
        for _ in 0..300 {
            let p = bounds.min + 6.0 + DVec2::new(random.unit(), random.unit()) * 248.0;
            let nearest = points.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
            assert!(nearest < 4.2, "{nearest} at {p}");
        }
        assert_ne!(points, noise.over(bounds, 3.0, Seed(3)).collect::<Vec<_>>());
    }
}

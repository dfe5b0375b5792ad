//! Random fields that repeat, for clouds.

use std::sync::OnceLock;

use glam::{Vec2, Vec3};
use rayon::prelude::*;
use trove_model::Seed;

/// A square field of numbers, interpolated, that repeats with period 1.
pub(crate) struct Plane {
    side: usize,
    values: Vec<f32>,
}

impl Plane {
    /// Octaves of value noise, the first with `cells` random numbers a side, each next one twice as fine and half as
    /// strong (by `persistence`); 0 to 1.
    pub(crate) fn fractal(seed: Seed, side: usize, cells: usize, octaves: usize, persistence: f32) -> Self {
        let layers: Vec<(f32, Self)> = (0..octaves)
            .map(|octave| {
                let cells = cells << octave;
                let mut random = seed.nth(octave as u64).random();
                let values = (0..cells * cells).map(|_| random.unit() as f32).collect();
                (persistence.powi(octave as i32), Self { side: cells, values })
            })
            .collect();
        let total: f32 = layers.iter().map(|(weight, _)| weight).sum();
        let values = (0..side * side)
            .into_par_iter()
            .map(|i| {
                let at = Vec2::new((i % side) as f32, (i / side) as f32) / side as f32;
                layers.iter().map(|(weight, layer)| weight * layer.smooth(at)).sum::<f32>() / total
            })
            .collect();
        Self { side, values }
    }

    /// The values that the given shares of the plane lie above.
    pub(crate) fn quantiles_from_above<const N: usize>(&self, shares: [f64; N]) -> [f32; N] {
        // A sixteenth of the values says it well enough.
        let mut sorted: Vec<f32> = self.values.iter().step_by(17).copied().collect();
        sorted.sort_by(|a, b| b.total_cmp(a));
        shares.map(|share| sorted[((share * sorted.len() as f64) as usize).min(sorted.len() - 1)])
    }

    /// The field at a point, linear between its values.
    pub(crate) fn at(&self, point: Vec2) -> f32 {
        self.blend(point, |t| t)
    }

    fn smooth(&self, point: Vec2) -> f32 {
        self.blend(point, |t| t * t * (3.0 - 2.0 * t))
    }

    fn blend(&self, point: Vec2, ease: impl Fn(f32) -> f32) -> f32 {
        let cell = (point - point.floor()) * self.side as f32;
        let (x, y) = (cell.x as usize % self.side, cell.y as usize % self.side);
        let (next_x, next_y) = ((x + 1) % self.side, (y + 1) % self.side);
        let (tx, ty) = (ease(cell.x.fract()), ease(cell.y.fract()));
        let value = |x: usize, y: usize| self.values[y * self.side + x];
        let upper = value(x, y) + (value(next_x, y) - value(x, y)) * tx;
        let lower = value(x, next_y) + (value(next_x, next_y) - value(x, next_y)) * tx;
        upper + (lower - upper) * ty
    }
}

/// Round puffs in space, each with smaller ones on it, that repeat with period 1; 0 in their middles, 1 between them.
pub(crate) struct Puffs {
    values: Vec<f32>,
}

impl Puffs {
    const SIDE: usize = 64;

    /// The same for all skies, which lay them elsewhere.
    pub(crate) fn shared() -> &'static Self {
        static SHARED: OnceLock<Puffs> = OnceLock::new();
        SHARED.get_or_init(|| Self::new(Seed(0x50ff)))
    }

    /// Three octaves of the distance to the nearest of some random points (Worley 1996).
    fn new(seed: Seed) -> Self {
        const OCTAVES: [(usize, f32); 3] = [(4, 0.5), (8, 0.3), (16, 0.2)];
        let layers = OCTAVES.map(|(cells, weight)| {
            let mut random = seed.nth(cells as u64).random();
            let mut unit = || random.unit() as f32;
            let points = (0..cells * cells * cells).map(|_| Vec3::new(unit(), unit(), unit())).collect();
            (cells, weight, points)
        });
        let nearest = |points: &Vec<Vec3>, cells: usize, at: Vec3| {
            let cell = at.floor();
            let mut least = f32::INFINITY;
            for i in 0..27 {
                let neighbour = cell + Vec3::new((i % 3) as f32, (i / 3 % 3) as f32, (i / 9) as f32) - 1.0;
                let [x, y, z] = neighbour.to_array().map(|c| (c as isize).rem_euclid(cells as isize) as usize);
                least = least.min((neighbour + points[(z * cells + y) * cells + x]).distance_squared(at));
            }
            least.sqrt().min(1.0)
        };
        let side = Self::SIDE;
        let values = (0..side * side * side)
            .into_par_iter()
            .map(|i| {
                let at = Vec3::new((i % side) as f32, (i / side % side) as f32, (i / (side * side)) as f32);
                let octave = |(cells, weight, points): &(usize, f32, Vec<Vec3>)| {
                    weight * nearest(points, *cells, at * (*cells as f32 / side as f32))
                };
                layers.iter().map(octave).sum()
            })
            .collect();
        Self { values }
    }

    /// The field at a point, linear between its values.
    pub(crate) fn at(&self, point: Vec3) -> f32 {
        let cell = (point - point.floor()) * Self::SIDE as f32;
        let wrapped = |i: usize| i & (Self::SIDE - 1);
        let [x, y, z] = cell.to_array().map(|c| wrapped(c as usize));
        let t = cell.fract();
        let row = |y: usize, z: usize| {
            let start = (z * Self::SIDE + y) * Self::SIDE;
            let (a, b) = (self.values[start + x], self.values[start + wrapped(x + 1)]);
            a + (b - a) * t.x
        };
        let slice = |z: usize| {
            let (a, b) = (row(y, z), row(wrapped(y + 1), z));
            a + (b - a) * t.y
        };
        let (a, b) = (slice(z), slice(wrapped(z + 1)));
        a + (b - a) * t.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_repeat_and_their_quantiles_hold() {
        let plane = Plane::fractal(Seed(2), 64, 4, 3, 0.5);
        let point = Vec2::new(0.3, 0.8);
        assert!((plane.at(point) - plane.at(point + Vec2::new(1.0, -2.0))).abs() < 1e-4);
        let [threshold] = plane.quantiles_from_above([0.3]);
        let above = plane.values.iter().filter(|&&v| v > threshold).count() as f64 / plane.values.len() as f64;
        assert!((above - 0.3).abs() < 0.03, "{above}");
        let puffs = Puffs::new(Seed(2));
        let point = Vec3::new(0.31, 0.82, 0.999);
        assert!((puffs.at(point) - puffs.at(point - 1.0)).abs() < 1e-4);
    }
}

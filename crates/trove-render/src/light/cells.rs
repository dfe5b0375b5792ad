//! The sphere of directions in a few thousand cells: what wide cones see of it, and how directions are drawn from it.

use glam::Vec3;
use rayon::prelude::*;

use super::cdf::Cdf;
use super::luminance::luminance;

/// Mean radiance by direction, with directions drawn in proportion to its brightness.
///
/// The upper and the lower hemisphere are squares of `side × side` cells, upper first: an octahedron's half flattened
/// and turned by 45° (Praun and Hoppe 2003), which needs no function but a division.
pub(super) struct Cells {
    side: usize,
    cells: Vec<Cell>,
    rows: Cdf,
    columns: Vec<Cdf>,
}

#[derive(Clone, Copy)]
struct Cell {
    radiance: Vec3,
    /// Density over the squares' area with which it is drawn.
    density: f32,
}

impl Cells {
    /// Means of `radiance` over cells, each by `across × across` directions; `share_below` scales how often directions
    /// below the horizon are drawn, which the ground mostly hides.
    pub(super) fn new(side: usize, across: usize, share_below: f64, radiance: impl Fn(Vec3) -> Vec3 + Sync) -> Self {
        // By solid angle: within a cell it changes a little.
        let measure = |i: usize| {
            let (column, row) = (i % side, i / side);
            let (mut sum, mut solid_angle) = (Vec3::ZERO, 0.0);
            for k in 0..across * across {
                let along = |cell: usize, k: usize| (cell as f32 + (k as f32 + 0.5) / across as f32) / side as f32;
                let direction = direction_at(row >= side, along(column, k % across), along(row % side, k / across));
                let share = solid_angle_of_area(direction) / ((across * side) as f32).powi(2);
                sum += radiance(direction) * share;
                solid_angle += share;
            }
            (sum / solid_angle, f64::from(solid_angle))
        };
        let measured: Vec<(Vec3, f64)> = (0..2 * side * side).into_par_iter().map(measure).collect();
        let weight = |(i, (radiance, solid_angle)): (usize, &(Vec3, f64))| {
            let share = if i >= side * side { share_below } else { 1.0 };
            f64::from(luminance(*radiance)) * solid_angle * share
        };
        let weights: Vec<f64> = measured.iter().enumerate().map(weight).collect();
        let rows = Cdf::new(&weights.chunks(side).map(|row| row.iter().sum()).collect::<Vec<f64>>());
        let columns: Vec<Cdf> = weights.chunks(side).map(Cdf::new).collect();
        let cell = |(i, (radiance, _)): (usize, &(Vec3, f64))| Cell {
            radiance: *radiance,
            density: rows.probability(i / side) * columns[i / side].probability(i % side) * (side * side) as f32,
        };
        let cells = measured.iter().enumerate().map(cell).collect();
        Self { side, cells, rows, columns }
    }

    /// A direction, its mean radiance, and the density over solid angle with which it is drawn.
    pub(super) fn draw(&self, u: [f32; 2]) -> (Vec3, Vec3, f32) {
        let (row, along_row) = self.rows.draw(u[0]);
        let (column, along_column) = self.columns[row].draw(u[1]);
        let cell = &self.cells[row * self.side + column];
        let share = |cell: usize, along: f32| (cell as f32 + along) / self.side as f32;
        let direction = direction_at(row >= self.side, share(column, along_column), share(row % self.side, along_row));
        (direction, cell.radiance, cell.density / solid_angle_of_area(direction))
    }

    /// Mean radiance around a direction.
    pub(super) fn radiance(&self, direction: Vec3) -> Vec3 {
        self.at(direction).radiance
    }

    /// Density over solid angle with which a direction is drawn.
    pub(super) fn pdf(&self, direction: Vec3) -> f32 {
        self.at(direction).density / solid_angle_of_area(direction)
    }

    /// Irradiance of a level surface that looks up.
    pub(super) fn irradiance(&self) -> Vec3 {
        let centre = |i: usize| (i as f32 + 0.5) / self.side as f32;
        let part = |i: usize| {
            let direction = direction_at(false, centre(i % self.side), centre(i / self.side));
            self.cells[i].radiance * direction.z * solid_angle_of_area(direction)
        };
        (0..self.side * self.side).map(part).sum::<Vec3>() / (self.side * self.side) as f32
    }

    fn at(&self, direction: Vec3) -> &Cell {
        let [x, y] = place_of(direction).map(|share| ((share * self.side as f32) as usize).min(self.side - 1));
        let below = if direction.z < 0.0 { self.side * self.side } else { 0 };
        &self.cells[below + y * self.side + x]
    }
}

/// Where a direction lies in its hemisphere's square, 0 to 1.
fn place_of(direction: Vec3) -> [f32; 2] {
    let scale = 0.5 / direction.abs().element_sum();
    [(direction.x + direction.y) * scale + 0.5, (direction.x - direction.y) * scale + 0.5]
}

/// The direction at a place in a hemisphere's square.
fn direction_at(below: bool, u: f32, v: f32) -> Vec3 {
    let (x, y) = (u + v - 1.0, u - v);
    let z = (1.0 - x.abs() - y.abs()).max(0.0);
    Vec3::new(x, y, if below { -z } else { z }).normalize()
}

/// Solid angle of a unit of a square's area around a direction.
fn solid_angle_of_area(direction: Vec3) -> f32 {
    2.0 * direction.abs().element_sum().powi(3)
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use trove_model::Seed;

    use super::*;
    use crate::light::dome::tests::even;

    fn spotted() -> Cells {
        let spot = Vec3::new(0.5, -0.7, 0.3).normalize();
        Cells::new(11, 3, 0.3, |d| Vec3::splat(if d.dot(spot) > 0.98 { 50.0 } else { 1.0 + d.x + 0.5 * d.z }))
    }

    #[test]
    fn a_place_and_its_direction_are_one() {
        for d in even(1000) {
            let [u, v] = place_of(d);
            assert!((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v));
            assert!((direction_at(d.z < 0.0, u, v) - d).length() < 1e-5, "{d}");
        }
    }

    #[test]
    fn the_density_integrates_to_one() {
        let cells = spotted();
        // A fine grid over both squares.
        let (n, mut sum) = (1100, 0.0);
        for i in 0..2 * n * n {
            let (u, v) = ((i % n) as f32 + 0.5, (i / n % n) as f32 + 0.5);
            let d = direction_at(i >= n * n, u / n as f32, v / n as f32);
            sum += f64::from(cells.pdf(d) * solid_angle_of_area(d)) / (n * n) as f64;
        }
        assert!((sum - 1.0).abs() < 1e-3, "{sum}");
        let n = 400_000;
        let lattice = even(n).map(|d| f64::from(cells.pdf(d))).sum::<f64>() * 4.0 * std::f64::consts::PI / f64::from(n);
        assert!((lattice - 1.0).abs() < 1e-3, "{lattice}");
    }

    #[test]
    fn directions_are_drawn_with_the_density_that_is_claimed() {
        let cells = spotted();
        let bin = |d: Vec3| {
            let [u, v] = place_of(d).map(|x| (x * 8.0).min(7.0) as usize);
            v * 8 + u + if d.z < 0.0 { 64 } else { 0 }
        };
        let (draws, lattice) = (100_000, 400_000);
        let mut expected = [0.0; 128];
        for d in even(lattice) {
            expected[bin(d)] +=
                f64::from(cells.pdf(d)) * 4.0 * std::f64::consts::PI / f64::from(lattice) * f64::from(draws);
        }
        let mut random = Seed(3).random();
        let mut drawn = [0.0; 128];
        for _ in 0..draws {
            let (d, radiance, pdf) = cells.draw([random.unit() as f32, random.unit() as f32]);
            drawn[bin(d)] += 1.0;
            // On a cell's edge rounding may find the neighbour.
            let same = (cells.pdf(d) / pdf - 1.0).abs() < 1e-3 && cells.radiance(d) == radiance;
            let at_edge = place_of(d).iter().any(|x| (x * 11.0 - (x * 11.0).round()).abs() < 1e-4);
            assert!(same || at_edge, "{d}");
        }
        let chi2: f64 = drawn.iter().zip(expected).map(|(n, e): (&f64, f64)| (n - e).powi(2) / e).sum();
        assert!(chi2 < 181.99, "χ² = {chi2}"); // 99.9 % of 127 degrees of freedom
    }

    #[test]
    fn a_uniform_sky_has_its_radiance_everywhere_and_pi_times_it_as_irradiance() {
        let cells = Cells::new(32, 2, 1.0, |_| Vec3::splat(2.0));
        for d in even(500) {
            assert!((cells.radiance(d) - 2.0).length() < 1e-4 && (cells.pdf(d) * 2.0 * TAU - 1.0).abs() < 0.2);
        }
        assert!((cells.irradiance().x / TAU - 1.0).abs() < 2e-3, "{}", cells.irradiance());
    }
}

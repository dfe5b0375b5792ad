//! The sphere of directions in a few thousand cells: what wide cones see of it, and how directions are drawn from it.

use glam::Vec3;
use rayon::prelude::*;
use trove_model::luminance;

use super::cdf::Cdf;
use super::patches::{ACROSS, BELOW, Patch, Patches};

/// Mean radiance by direction, with directions drawn in proportion to what comes from them to a surface, roughly: first a
/// patch by its light and the surface's normal, then one of the patch's cells by its brightness.
///
/// The upper and the lower hemisphere are squares of `side × side` cells, upper first: an octahedron's half flattened
/// and turned by 45° (Praun and Hoppe 2003), which needs no function but a division.
pub(super) struct Cells {
    side: usize,
    cells: Vec<Cell>,
    patches: Patches,
    within: Vec<Within>,
}

#[derive(Clone, Copy)]
struct Cell {
    radiance: Vec3,
    /// Density over the squares' area with which it is drawn from its patch.
    density: f32,
}

/// How cells of a patch, which is a square of them, are drawn.
struct Within {
    row: usize,
    column: usize,
    rows: Cdf,
    columns: Vec<Cdf>,
}

impl Cells {
    /// Means of `radiance` over cells, each by `across × across` directions; `side` is a multiple of [`ACROSS`], and
    /// `share_below` scales how often directions below the horizon are drawn, which the ground mostly hides.
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

        let block = side / ACROSS;
        let within: Vec<Within> = (0..=BELOW)
            .map(|patch| {
                let (row, column, size) = match patch {
                    BELOW => (side, 0, side),
                    _ => (patch / ACROSS * block, patch % ACROSS * block, block),
                };
                let row_of = |y: usize| &weights[(row + y) * side + column..][..size];
                let rows = Cdf::new(&(0..size).map(|y| row_of(y).iter().sum()).collect::<Vec<f64>>());
                Within { row, column, rows, columns: (0..size).map(|y| Cdf::new(row_of(y))).collect() }
            })
            .collect();
        let mut cells: Vec<Cell> = measured.iter().map(|&(radiance, _)| Cell { radiance, density: 0.0 }).collect();
        for Within { row, column, rows, columns } in &within {
            for (y, of_row) in columns.iter().enumerate() {
                let cells = &mut cells[(row + y) * side + column..][..columns.len()];
                for (x, cell) in cells.iter_mut().enumerate() {
                    cell.density = rows.probability(y) * of_row.probability(x) * (side * side) as f32;
                }
            }
        }

        let centre = |i: usize| {
            let share = |i: usize| (i as f32 + 0.5) / side as f32;
            direction_at(false, share(i % side), share(i / side))
        };
        let patch = |Within { row, column, .. }: &Within| {
            let places = || (0..block * block).map(|k| (row + k / block) * side + column + k % block);
            let light: f32 = places().map(|i| weights[i] as f32).sum();
            let middle = places().map(|i| centre(i) * weights[i] as f32).sum::<Vec3>() / light.max(f32::MIN_POSITIVE);
            let reach = places().map(|i| (centre(i) - middle).length()).fold(0.0, f32::max);
            Patch { light, middle, reach }
        };
        let above = std::array::from_fn(|i| patch(&within[i]));
        let below = weights[side * side..].iter().sum::<f64>() as f32;
        Self { side, cells, patches: Patches::new(&above, below), within }
    }

    /// For a surface that is lit from the side of `normal` (from both sides if it is 0), a direction, its mean radiance,
    /// and the density over solid angle with which it is drawn; `None` where all is dark.
    pub(super) fn draw(&self, normal: Vec3, u: [f32; 2]) -> Option<(Vec3, Vec3, f32)> {
        let (patch, probability, u) = self.patches.draw(normal, u)?;
        let within = &self.within[patch];
        let (row, along_row) = within.rows.draw(u[0]);
        let (column, along_column) = within.columns[row].draw(u[1]);
        let (row, column) = (within.row + row, within.column + column);
        let cell = &self.cells[row * self.side + column];
        let share = |cell: usize, along: f32| (cell as f32 + along) / self.side as f32;
        let direction = direction_at(row >= self.side, share(column, along_column), share(row % self.side, along_row));
        Some((direction, cell.radiance, probability * cell.density / solid_angle_of_area(direction)))
    }

    /// Mean radiance around a direction.
    pub(super) fn radiance(&self, direction: Vec3) -> Vec3 {
        self.cells[self.at(direction).0].radiance
    }

    /// Density over solid angle with which a direction is drawn for a surface.
    pub(super) fn pdf(&self, normal: Vec3, direction: Vec3) -> f32 {
        let (cell, patch) = self.at(direction);
        self.patches.probability(normal, patch) * self.cells[cell].density / solid_angle_of_area(direction)
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

    /// The cell and the patch of a direction.
    fn at(&self, direction: Vec3) -> (usize, usize) {
        let [x, y] = place_of(direction).map(|share| ((share * self.side as f32) as usize).min(self.side - 1));
        if direction.z < 0.0 {
            return ((self.side + y) * self.side + x, BELOW);
        }
        let block = self.side / ACROSS;
        (y * self.side + x, y / block * ACROSS + x / block)
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
        Cells::new(24, 3, 0.3, |d| Vec3::splat(if d.dot(spot) > 0.98 { 50.0 } else { 1.0 + d.x + 0.5 * d.z }))
    }

    /// A road, a wall, a slope, a ceiling, and a leaf that is lit from both sides.
    const NORMALS: [Vec3; 5] = [Vec3::Z, Vec3::X, Vec3::new(-0.48, 0.6, 0.64), Vec3::NEG_Z, Vec3::ZERO];

    #[test]
    fn a_place_and_its_direction_are_one() {
        for d in even(1000) {
            let [u, v] = place_of(d);
            assert!((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v));
            assert!((direction_at(d.z < 0.0, u, v) - d).length() < 1e-5, "{d}");
        }
    }

    #[test]
    fn the_density_integrates_to_one_for_every_surface() {
        let cells = spotted();
        for normal in NORMALS {
            // A fine grid over both squares.
            let (n, mut sum) = (960, 0.0);
            for i in 0..2 * n * n {
                let (u, v) = ((i % n) as f32 + 0.5, (i / n % n) as f32 + 0.5);
                let d = direction_at(i >= n * n, u / n as f32, v / n as f32);
                sum += f64::from(cells.pdf(normal, d) * solid_angle_of_area(d)) / (n * n) as f64;
            }
            assert!((sum - 1.0).abs() < 1e-3, "{normal}: {sum}");
            let (n, whole) = (400_000, 4.0 * std::f64::consts::PI);
            let lattice = even(n).map(|d| f64::from(cells.pdf(normal, d))).sum::<f64>() * whole / f64::from(n);
            assert!((lattice - 1.0).abs() < 1e-3, "{normal}: {lattice}");
        }
    }

    #[test]
    fn directions_are_drawn_with_the_density_that_is_claimed() {
        let cells = spotted();
        let bin = |d: Vec3| {
            let [u, v] = place_of(d).map(|x| (x * 8.0).min(7.0) as usize);
            v * 8 + u + if d.z < 0.0 { 64 } else { 0 }
        };
        let (draws, lattice) = (100_000, 400_000);
        let mut random = Seed(3).random();
        for normal in NORMALS {
            let mut expected = [0.0; 128];
            for d in even(lattice) {
                let share = 4.0 * std::f64::consts::PI / f64::from(lattice);
                expected[bin(d)] += f64::from(cells.pdf(normal, d)) * share * f64::from(draws);
            }
            let mut drawn = [0.0; 128];
            for _ in 0..draws {
                let (d, radiance, pdf) = cells.draw(normal, [random.unit() as f32, random.unit() as f32]).unwrap();
                drawn[bin(d)] += 1.0;
                // On a cell's edge rounding may find the neighbour.
                let same = (cells.pdf(normal, d) / pdf - 1.0).abs() < 1e-3 && cells.radiance(d) == radiance;
                let at_edge = place_of(d).iter().any(|x| (x * 24.0 - (x * 24.0).round()).abs() < 1e-4);
                assert!(same || at_edge, "{d}");
            }
            let chi2: f64 = drawn.iter().zip(expected).map(|(n, e): (&f64, f64)| (n - e).powi(2) / e).sum();
            assert!(chi2 < 181.99, "{normal}: χ² = {chi2}"); // 99.9 % of 127 degrees of freedom
        }
    }

    #[test]
    fn a_surface_draws_what_lights_it() {
        let sky = Cells::new(64, 2, 0.05, |d| Vec3::splat(if d.z < 0.0 { 0.2 } else { 1.5 - d.z }));
        for (normal, least) in [(Vec3::Z, 1.6), (Vec3::X, 5.0)] {
            // Variance relative to the square of the mean, for the surface and for one that is lit from both sides.
            let noise = |drawn_for: Vec3| {
                let n = 300;
                let part = |i: u32| {
                    let u = [((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32];
                    let (d, radiance, pdf) = sky.draw(drawn_for, u).unwrap();
                    // What lies below the horizon is hidden.
                    let cos = if d.z > 0.0 { d.dot(normal).max(0.0) } else { 0.0 };
                    f64::from(radiance.x * cos / pdf)
                };
                let parts: Vec<f64> = (0..n * n).map(part).collect();
                let mean = parts.iter().sum::<f64>() / f64::from(n * n);
                (parts.iter().map(|part| (part / mean - 1.0).powi(2)).sum::<f64>() / f64::from(n * n), mean)
            };
            let ((even, of_even), (aimed, of_aimed)) = (noise(Vec3::ZERO), noise(normal));
            assert!((of_aimed / of_even - 1.0).abs() < 5e-3, "{normal}: {of_aimed} instead of {of_even}");
            assert!(aimed * least < even, "{normal}: {aimed}, {even} without regard to the surface");
        }
    }

    #[test]
    fn nothing_is_drawn_from_darkness() {
        let dark = Cells::new(8, 2, 0.3, |_| Vec3::ZERO);
        assert!(dark.draw(Vec3::Z, [0.3, 0.7]).is_none() && dark.pdf(Vec3::Z, Vec3::X) == 0.0);
    }

    #[test]
    fn a_uniform_sky_has_its_radiance_everywhere_and_pi_times_it_as_irradiance() {
        let cells = Cells::new(32, 2, 1.0, |_| Vec3::splat(2.0));
        assert!(even(500).all(|d| (cells.radiance(d) - 2.0).length() < 1e-4));
        assert!((cells.irradiance().x / TAU - 1.0).abs() < 2e-3, "{}", cells.irradiance());
    }
}

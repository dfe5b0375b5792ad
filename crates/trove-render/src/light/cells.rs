//! The cells of a sky, made ready.

use glam::Vec3;
use rayon::prelude::*;
use trove_model::luminance;
use trove_trace::light::{ACROSS, BELOW, Cell, Cells, Patch, Patches, Within, direction_at, solid_angle_of_area};

use super::cdf::Lists;

/// What [`Cells`] looks up.
pub(super) struct SkyCells {
    side: usize,
    cells: Vec<Cell>,
    patches: Patches,
    within: Vec<Within>,
    lists: Lists,
}

impl SkyCells {
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

        let (block, mut lists) = (side / ACROSS, Lists::default());
        let within: Vec<Within> = (0..=BELOW)
            .map(|patch| {
                let (row, column, size) = match patch {
                    BELOW => (side, 0, side),
                    _ => (patch / ACROSS * block, patch % ACROSS * block, block),
                };
                let (guide, cumulative) = (lists.guide.len() as u32, lists.cumulative.len() as u32);
                let row_of = |y: usize| &weights[(row + y) * side + column..][..size];
                lists.append(&(0..size).map(|y| row_of(y).iter().sum()).collect::<Vec<f64>>());
                (0..size).for_each(|y| lists.append(row_of(y)));
                Within { row: row as u32, column: column as u32, size: size as u32, guide, cumulative }
            })
            .collect();
        let cells = measured.iter().map(|&(radiance, _)| Cell { radiance, density: 0.0 }).collect();

        let centre = |i: usize| {
            let share = |i: usize| (i as f32 + 0.5) / side as f32;
            direction_at(false, share(i % side), share(i / side))
        };
        let patch = |Within { row, column, .. }: &Within| {
            let places =
                || (0..block * block).map(|k| (*row as usize + k / block) * side + *column as usize + k % block);
            let light: f32 = places().map(|i| weights[i] as f32).sum();
            let middle = places().map(|i| centre(i) * weights[i] as f32).sum::<Vec3>() / light.max(f32::MIN_POSITIVE);
            let reach = places().map(|i| (centre(i) - middle).length()).fold(0.0, f32::max);
            Patch { light, middle, reach }
        };
        let above = std::array::from_fn(|i| patch(&within[i]));
        let below = weights[side * side..].iter().sum::<f64>() as f32;
        let mut made = Self { side, cells, patches: Patches::new(&above, below), within, lists };
        made.tell_densities();
        made
    }

    /// Over the squares' area, with which each cell is drawn from its patch.
    fn tell_densities(&mut self) {
        let area = (self.side * self.side) as f32;
        let of_patch = |within: &Within| -> Vec<(usize, f32)> {
            let (view, size) = (self.view(), within.size as usize);
            let rows = view.cdf(within, 0);
            let of_row = |y: usize| {
                let (first, columns) =
                    ((within.row as usize + y) * self.side + within.column as usize, view.cdf(within, 1 + y));
                let probability = rows.probability(y);
                (0..size).map(move |x| (first + x, probability * columns.probability(x) * area))
            };
            (0..size).flat_map(of_row).collect()
        };
        let densities: Vec<_> = self.within.iter().flat_map(of_patch).collect();
        densities.into_iter().for_each(|(cell, density)| self.cells[cell].density = density);
    }

    /// To be looked up.
    pub(super) fn view(&self) -> Cells<'_> {
        let Self { side, cells, patches, within, lists } = self;
        Cells { side: *side, cells, patches, within, cumulative: &lists.cumulative, guide: &lists.guide }
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
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use trove_model::Seed;

    use trove_trace::light::place_of;

    use super::*;
    use crate::light::dome::tests::even;

    fn spotted() -> SkyCells {
        let spot = Vec3::new(0.5, -0.7, 0.3).normalize();
        SkyCells::new(24, 3, 0.3, |d| Vec3::splat(if d.dot(spot) > 0.98 { 50.0 } else { 1.0 + d.x + 0.5 * d.z }))
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
                sum += f64::from(cells.view().pdf(normal, d) * solid_angle_of_area(d)) / (n * n) as f64;
            }
            assert!((sum - 1.0).abs() < 1e-3, "{normal}: {sum}");
            let (n, whole) = (400_000, 4.0 * std::f64::consts::PI);
            let lattice = even(n).map(|d| f64::from(cells.view().pdf(normal, d))).sum::<f64>() * whole / f64::from(n);
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
                expected[bin(d)] += f64::from(cells.view().pdf(normal, d)) * share * f64::from(draws);
            }
            let mut drawn = [0.0; 128];
            for _ in 0..draws {
                let (d, radiance, pdf) =
                    cells.view().draw(normal, [random.unit() as f32, random.unit() as f32]).unwrap();
                drawn[bin(d)] += 1.0;
                // On a cell's edge rounding may find the neighbour.
                let same =
                    (cells.view().pdf(normal, d) / pdf - 1.0).abs() < 1e-3 && cells.view().radiance(d) == radiance;
                let at_edge = place_of(d).iter().any(|x| (x * 24.0 - (x * 24.0).round()).abs() < 1e-4);
                assert!(same || at_edge, "{d}");
            }
            let chi2: f64 = drawn.iter().zip(expected).map(|(n, e): (&f64, f64)| (n - e).powi(2) / e).sum();
            assert!(chi2 < 181.99, "{normal}: χ² = {chi2}"); // 99.9 % of 127 degrees of freedom
        }
    }

    #[test]
    fn a_surface_draws_what_lights_it() {
        let sky = SkyCells::new(64, 2, 0.05, |d| Vec3::splat(if d.z < 0.0 { 0.2 } else { 1.5 - d.z }));
        for (normal, least) in [(Vec3::Z, 1.6), (Vec3::X, 5.0)] {
            // Variance relative to the square of the mean, for the surface and for one that is lit from both sides.
            let noise = |drawn_for: Vec3| {
                let n = 300;
                let part = |i: u32| {
                    let u = [((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32];
                    let (d, radiance, pdf) = sky.view().draw(drawn_for, u).unwrap();
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
        let dark = SkyCells::new(8, 2, 0.3, |_| Vec3::ZERO);
        assert!(dark.view().draw(Vec3::Z, [0.3, 0.7]).is_none() && dark.view().pdf(Vec3::Z, Vec3::X) == 0.0);
    }

    #[test]
    fn a_uniform_sky_has_its_radiance_everywhere_and_pi_times_it_as_irradiance() {
        let cells = SkyCells::new(32, 2, 1.0, |_| Vec3::splat(2.0));
        assert!(even(500).all(|d| (cells.view().radiance(d) - 2.0).length() < 1e-4));
        assert!((cells.irradiance().x / TAU - 1.0).abs() < 2e-3, "{}", cells.irradiance());
    }
}

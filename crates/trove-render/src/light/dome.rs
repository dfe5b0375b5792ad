//! A latitude-longitude picture of everything infinitely far away, and how directions are drawn from it.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use trove_model::EnvironmentMap;

use super::cdf::Cdf;
use super::luminance;

/// Radiance by direction, with directions drawn in proportion to brightness.
///
/// Rows and columns are those of [`EnvironmentMap`]. Drawing works on cells of `cell × cell` texels: a row of cells,
/// then a cell of the row, then a point in the cell, evenly over its solid angle.
pub(super) struct Dome {
    picture: Picture,
    /// The same with fewer texels, which stay in the processor's caches; `None`: the picture itself.
    coarse: Option<Picture>,
    /// Edges between columns of cells, as shares of the width.
    edges_u: Vec<f32>,
    /// z of the edges between rows of cells, from 1 down to −1.
    edges_z: Vec<f32>,
    cell: usize,
    rows: Cdf,
    cells: Vec<Cdf>,
}

/// Rows and columns of colours.
struct Picture {
    width: usize,
    height: usize,
    rgb: Vec<[f32; 3]>,
}

impl Picture {
    /// Interpolated between the four nearest texels; `u` and `v` are shares of width and height.
    fn at(&self, (u, v): (f32, f32)) -> Vec3 {
        let (x, y) = (u * self.width as f32 - 0.5, v * self.height as f32 - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let column = |i: f32| (i as isize).rem_euclid(self.width as isize) as usize;
        let row = |i: f32| (i.max(0.0) as usize).min(self.height - 1);
        let texel = |x: f32, y: f32| Vec3::from(self.rgb[row(y) * self.width + column(x)]);
        let upper = texel(left, top).lerp(texel(left + 1.0, top), x - left);
        let lower = texel(left, top + 1.0).lerp(texel(left + 1.0, top + 1.0), x - left);
        upper.lerp(lower, y - top)
    }

    /// Means of squares of `cell × cell` texels, into which the picture must divide.
    fn averaged(&self, cell: usize) -> Self {
        let (width, height) = (self.width / cell, self.height / cell);
        let mean = |x: usize, y: usize| {
            let square = (0..cell * cell).map(|i| (y * cell + i / cell) * self.width + x * cell + i % cell);
            (square.map(|i| Vec3::from(self.rgb[i])).sum::<Vec3>() / (cell * cell) as f32).to_array()
        };
        let rgb = (0..width * height).map(|i| mean(i % width, i / width)).collect();
        Self { width, height, rgb }
    }
}

impl Dome {
    /// From a picture; `share_below` scales how often directions below the horizon are drawn, which the ground mostly
    /// hides.
    pub(super) fn new(map: EnvironmentMap, cell: usize, share_below: f64) -> Self {
        let (width, height) = (map.width as usize, map.height as usize);
        let edges =
            |length: usize| (0..=length.div_ceil(cell)).map(move |i| (i * cell).min(length)).collect::<Vec<_>>();
        let (edges_x, edges_y) = (edges(width), edges(height));
        let edges_z: Vec<f32> = edges_y.iter().map(|&y| (PI * y as f32 / height as f32).cos()).collect();
        let brightness: Vec<f32> = map.rgb.iter().map(|&c| luminance(c.into())).collect();

        // A cell weighs its solid angle times the mean brightness of its texels and of their neighbours, into which
        // interpolation reaches.
        let mut row_weights = Vec::new();
        let mut cells = Vec::new();
        for (y, z) in edges_y.windows(2).zip(edges_z.windows(2)) {
            let ys = y[0].saturating_sub(1)..(y[1] + 1).min(height);
            let solid_angle = f64::from(z[0] - z[1]) * if z[0] <= 1e-6 { share_below } else { 1.0 };
            let weight = |x: &[usize]| {
                let xs = x[0] + width - 1..x[1] + width + 1;
                let row = |y: usize| xs.clone().map(|x| f64::from(brightness[y * width + x % width])).sum::<f64>();
                let mean = ys.clone().map(row).sum::<f64>() / (xs.len() * ys.len()) as f64;
                mean * (x[1] - x[0]) as f64 * solid_angle
            };
            let weights: Vec<f64> = edges_x.windows(2).map(weight).collect();
            row_weights.push(weights.iter().sum());
            cells.push(Cdf::new(&weights));
        }
        let edges_u = edges_x.iter().map(|&x| x as f32 / width as f32).collect();
        let picture = Picture { width, height, rgb: map.rgb };
        let divides = width.is_multiple_of(cell) && height.is_multiple_of(cell);
        let coarse = (cell > 1 && divides).then(|| picture.averaged(cell));
        Self { picture, coarse, edges_u, edges_z, cell, rows: Cdf::new(&row_weights), cells }
    }

    /// Radiance in all detail.
    pub(super) fn radiance(&self, direction: Vec3) -> Vec3 {
        self.picture.at(uv_of(direction))
    }

    /// Radiance for directions that stand for a cone wider than a cell.
    pub(super) fn radiance_coarse(&self, direction: Vec3) -> Vec3 {
        self.coarse.as_ref().unwrap_or(&self.picture).at(uv_of(direction))
    }

    /// A direction, in proportion to brightness.
    pub(super) fn draw(&self, u: [f32; 2]) -> Vec3 {
        let (row, along_row) = self.rows.draw(u[0]);
        let (column, along_column) = self.cells[row].draw(u[1]);
        let between = |edges: &[f32], t: f32| edges[0] + (edges[1] - edges[0]) * t;
        let z = between(&self.edges_z[row..=row + 1], along_row);
        let azimuth = PI - TAU * between(&self.edges_u[column..=column + 1], along_column);
        let (sin, cos) = azimuth.sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        Vec3::new(r * cos, r * sin, z)
    }

    /// Density over solid angle with which a direction is drawn.
    pub(super) fn pdf(&self, direction: Vec3) -> f32 {
        let (u, v) = uv_of(direction);
        let index =
            |share: f32, texels: usize, cells: usize| ((share * texels as f32) as usize / self.cell).min(cells - 1);
        let row = index(v, self.picture.height, self.cells.len());
        let column = index(u, self.picture.width, self.edges_u.len() - 1);
        let solid_angle =
            TAU * (self.edges_u[column + 1] - self.edges_u[column]) * (self.edges_z[row] - self.edges_z[row + 1]);
        self.rows.probability(row) * self.cells[row].probability(column) / solid_angle
    }
}

/// Where a direction lies in the picture, as shares of width and height.
fn uv_of(direction: Vec3) -> (f32, f32) {
    let azimuth = direction.y.atan2(direction.x);
    let from_zenith = direction.truncate().length().atan2(direction.z);
    ((0.5 - azimuth / TAU).clamp(0.0, 1.0), from_zenith / PI)
}

/// The direction at the centre of a texel of a `width × height` picture.
pub(super) fn direction_of(x: usize, y: usize, width: usize, height: usize) -> Vec3 {
    let azimuth = PI - TAU * (x as f32 + 0.5) / width as f32;
    let (sin_zenith, cos_zenith) = (PI * (y as f32 + 0.5) / height as f32).sin_cos();
    let (sin, cos) = azimuth.sin_cos();
    Vec3::new(sin_zenith * cos, sin_zenith * sin, cos_zenith)
}

#[cfg(test)]
mod tests {
    use trove_model::Seed;

    use super::*;

    fn map(width: u32, height: u32, f: impl Fn(usize, usize) -> f32) -> EnvironmentMap {
        let texel = |i: u32| [f((i % width) as usize, (i / width) as usize); 3];
        EnvironmentMap { name: String::new(), width, height, rgb: (0..width * height).map(texel).collect() }
    }

    /// Directions that cover the sphere evenly, `n` of them (Fibonacci lattice).
    fn even(n: u32) -> impl Iterator<Item = Vec3> {
        (0..n).map(move |i| {
            let z = 1.0 - 2.0 * (i as f32 + 0.5) / n as f32;
            let (sin, cos) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * cos as f32, r * sin as f32, z)
        })
    }

    fn spotted() -> Dome {
        Dome::new(map(22, 11, |x, y| if (x, y) == (5, 3) { 50.0 } else { (x + 2 * y) as f32 * 0.1 }), 2, 0.3)
    }

    #[test]
    fn the_density_integrates_to_one() {
        let dome = spotted();
        let n = 200_000;
        let integral: f32 = even(n).map(|d| dome.pdf(d)).sum::<f32>() * 2.0 * TAU / n as f32;
        assert!((integral - 1.0).abs() < 2e-3, "{integral}");
    }

    #[test]
    fn directions_are_drawn_with_the_density_that_is_claimed() {
        let dome = spotted();
        let bin = |d: Vec3| {
            let (u, v) = uv_of(d);
            (v * 8.0).min(7.0) as usize * 8 + (u * 8.0).min(7.0) as usize
        };
        let (draws, lattice) = (100_000, 400_000);
        let mut expected = [0.0; 64];
        for d in even(lattice) {
            expected[bin(d)] +=
                f64::from(dome.pdf(d)) * 4.0 * std::f64::consts::PI / f64::from(lattice) * f64::from(draws);
        }
        let mut random = Seed(3).random();
        let mut drawn = [0.0; 64];
        for _ in 0..draws {
            drawn[bin(dome.draw([random.unit() as f32, random.unit() as f32]))] += 1.0;
        }
        let chi2: f64 = drawn.iter().zip(expected).map(|(n, e): (&f64, f64)| (n - e).powi(2) / e).sum();
        assert!(chi2 < 103.4, "χ² = {chi2}"); // 99.9 % of 63 degrees of freedom
    }

    #[test]
    fn a_uniform_picture_is_drawn_uniformly_and_reads_the_same_everywhere() {
        let dome = Dome::new(map(16, 8, |_, _| 2.0), 1, 1.0);
        for d in even(500) {
            assert!((dome.pdf(d) * 2.0 * TAU - 1.0).abs() < 1e-3);
            assert!((dome.radiance(d) - 2.0).length() < 1e-5);
        }
    }

    #[test]
    fn the_left_edge_looks_west_and_columns_run_through_north() {
        let dome = Dome::new(map(8, 4, |x, y| (10 * y + x) as f32), 1, 1.0);
        for (x, y) in [(0, 1), (3, 2), (7, 0)] {
            assert!((dome.radiance(direction_of(x, y, 8, 4)).x - (10 * y + x) as f32).abs() < 1e-3);
        }
        assert!((uv_of(Vec3::Y).0 - 0.25).abs() < 1e-6);
        assert!((uv_of(Vec3::X).0 - 0.5).abs() < 1e-6);
        assert!(uv_of(Vec3::Z).1 < 1e-6);
    }
}

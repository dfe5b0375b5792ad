//! How far it is from anywhere to the nearest of some areas.

use glam::DVec2;
use trove_model::{Bounds, Polygon, Raster};

use crate::geometry::plane_raster::PlaneRaster;

/// Distance to the nearest covered cell, to about half a cell.
#[derive(Clone, Debug)]
pub(crate) struct DistanceField {
    origin: DVec2,
    cell_m: f64,
    /// Metres from each cell's centre.
    distance_m: Raster<f32>,
}

impl DistanceField {
    /// The distance to the union of some polygons; infinite where there are none.
    pub(crate) fn to(polygons: impl IntoIterator<Item = Polygon>, bounds: Bounds, cell_m: f64) -> Self {
        let mut covered = PlaneRaster::new(bounds, cell_m);
        for polygon in polygons {
            covered.fill(std::slice::from_ref(&polygon), 1);
        }
        Self::to_cells(bounds, cell_m, |p| covered.at(p) == 1)
    }

    /// The distance to the cells whose centres are covered.
    ///
    /// Felzenszwalb and Huttenlocher, *Distance Transforms of Sampled Functions* (2012): lower envelopes of parabolas,
    /// along the columns and then along the rows.
    pub(crate) fn to_cells(bounds: Bounds, cell_m: f64, covered: impl Fn(DVec2) -> bool) -> Self {
        let size = (bounds.size_m() / cell_m).ceil().max(DVec2::ONE).as_uvec2();
        let centre = |x: u32, y: u32| bounds.min + (DVec2::new(f64::from(x), f64::from(y)) + 0.5) * cell_m;
        let mut squared =
            Raster::from_fn(size.x, size.y, |x, y| if covered(centre(x, y)) { 0.0 } else { f32::INFINITY });
        let mut envelope = Envelope::default();
        for x in 0..size.x {
            let column: Vec<f32> = (0..size.y).map(|y| *squared.at(x, y)).collect();
            for (y, value) in envelope.transform(&column).iter().enumerate() {
                *squared.at_mut(x, y as u32) = *value;
            }
        }
        let width = size.x as usize;
        for row in squared.data.chunks_exact_mut(width) {
            let transformed = envelope.transform(row).to_vec();
            row.copy_from_slice(&transformed);
        }
        Self { origin: bounds.min, cell_m, distance_m: squared.map(|d| d.sqrt() * cell_m as f32) }
    }

    /// Metres from a point to the nearest covered cell; of the nearest cell for points outside the bounds.
    pub(crate) fn at(&self, p: DVec2) -> f64 {
        let limit = DVec2::new(f64::from(self.distance_m.width - 1), f64::from(self.distance_m.height - 1));
        let cell = ((p - self.origin) / self.cell_m).floor().clamp(DVec2::ZERO, limit);
        f64::from(*self.distance_m.at(cell.x as u32, cell.y as u32))
    }
}

/// Lower envelope of parabolas, with its memory kept between rows.
#[derive(Default)]
struct Envelope {
    sites: Vec<(usize, f32)>,
    from: Vec<f32>,
    transformed: Vec<f32>,
}

impl Envelope {
    fn transform(&mut self, values: &[f32]) -> &[f32] {
        self.sites.clear();
        self.from.clear();
        for (i, &value) in values.iter().enumerate().filter(|(_, v)| v.is_finite()) {
            let mut start = f32::NEG_INFINITY;
            while let Some(&(j, height)) = self.sites.last() {
                let (a, b) = (i as f32, j as f32);
                start = ((value + a * a) - (height + b * b)) / (2.0 * (a - b));
                if start > *self.from.last().unwrap_or(&f32::NEG_INFINITY) {
                    break;
                }
                self.sites.pop();
                self.from.pop();
                start = f32::NEG_INFINITY;
            }
            self.sites.push((i, value));
            self.from.push(start);
        }
        self.transformed.clear();
        let mut current = 0;
        for i in 0..values.len() {
            while current + 1 < self.sites.len() && self.from[current + 1] < i as f32 {
                current += 1;
            }
            let distance = self.sites.get(current).map_or(f32::INFINITY, |&(j, height)| {
                let step = i as f32 - j as f32;
                step * step + height
            });
            self.transformed.push(distance);
        }
        &self.transformed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Seed;

    #[test]
    fn every_cell_knows_its_nearest_covered_cell() {
        let bounds = Bounds::square(DVec2::ZERO, 20.0);
        let mut random = Seed(3).random();
        let mut covered: Vec<DVec2> = Vec::new();
        for _ in 0..12 {
            let cell = DVec2::new(random.index(20) as f64, random.index(20) as f64);
            covered.push(cell + 0.5 - 10.0);
        }
        let field = DistanceField::to_cells(bounds, 1.0, |p| covered.iter().any(|c| c.distance(p) < 0.1));
        for i in 0..400 {
            let p = DVec2::new(f64::from(i % 20), f64::from(i / 20)) + 0.5 - 10.0;
            let nearest = covered.iter().map(|c| c.distance(p)).fold(f64::INFINITY, f64::min);
            assert!((field.at(p) - nearest).abs() < 1e-4, "{p}");
        }
        let empty = DistanceField::to_cells(bounds, 1.0, |_| false);
        assert_eq!(empty.at(DVec2::ZERO), f64::INFINITY);
    }
}

//! A fast answer to what lies at a point.

use glam::{DVec2, IVec2, UVec2};
use trove_model::{Bounds, Polygon, Raster};

/// Values over World's plane in square cells; 0 outside.
#[derive(Clone, Debug)]
pub(crate) struct PlaneRaster {
    origin: DVec2,
    cell_m: f64,
    cells: Raster<u8>,
}

impl PlaneRaster {
    /// 0 everywhere.
    pub(crate) fn new(bounds: Bounds, cell_m: f64) -> Self {
        let size = (bounds.size_m() / cell_m).ceil().max(DVec2::ONE).as_uvec2();
        Self { origin: bounds.min, cell_m, cells: Raster::filled(size.x, size.y, 0) }
    }

    /// Sets the cells whose centres lie in an area.
    pub(crate) fn fill(&mut self, area: &[Polygon], value: u8) {
        self.change(area, |cells| cells.fill(value));
    }

    /// Sets some bits of the cells whose centres lie in an area.
    pub(crate) fn mark(&mut self, area: &[Polygon], bits: u8) {
        self.change(area, |cells| cells.iter_mut().for_each(|cell| *cell |= bits));
    }

    /// Sets some bits of a cell, counted from the south-west corner; none outside.
    pub(crate) fn mark_cell(&mut self, cell: IVec2, bits: u8) {
        let limit = UVec2::new(self.cells.width, self.cells.height);
        if cell.cmpge(IVec2::ZERO).all() && cell.as_uvec2().cmplt(limit).all() {
            *self.cells.at_mut(cell.x as u32, cell.y as u32) |= bits;
        }
    }

    /// What is made of every value, row by row from the south-west corner, which comes first.
    pub(crate) fn map(&self, of: impl Fn(u8) -> u8) -> (DVec2, Raster<u8>) {
        (self.origin, self.cells.map(|cell| of(*cell)))
    }

    fn change(&mut self, area: &[Polygon], change: impl Fn(&mut [u8])) {
        let cell = |p: DVec2| (p - self.origin) / self.cell_m - 0.5;
        let Some(bounds) = Bounds::around(area.iter().flat_map(Polygon::rings).flatten().map(|&p| cell(p))) else {
            return;
        };
        let height = self.cells.height as usize;
        // Rows whose middles lie between lowest and highest vertex.
        let row_of = |y: f64| (y.ceil().max(0.0) as usize).min(height);
        let first = row_of(bounds.min.y);
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); row_of(bounds.max.y) - first];
        for (a, b) in area.iter().flat_map(Polygon::edges) {
            let (a, b) = (cell(a), cell(b));
            let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
            for row in row_of(low.y)..row_of(high.y) {
                let x = low.x + (high.x - low.x) * (row as f64 - low.y) / (high.y - low.y);
                crossings[row - first].push(x);
            }
        }
        let width = self.cells.width as usize;
        for (i, xs) in crossings.iter_mut().enumerate() {
            let row = first + i;
            xs.sort_by(f64::total_cmp);
            for pair in xs.chunks_exact(2) {
                let (from, to) = (pair[0].ceil().max(0.0) as usize, pair[1].ceil().max(0.0) as usize);
                let (from, to) = (from.min(width), to.min(width));
                change(&mut self.cells.data[row * width + from..row * width + to]);
            }
        }
    }

    /// The value at a point.
    pub(crate) fn at(&self, p: DVec2) -> u8 {
        let cell = ((p - self.origin) / self.cell_m).floor();
        let limit = DVec2::new(f64::from(self.cells.width), f64::from(self.cells.height));
        let inside = cell.cmpge(DVec2::ZERO).all() && cell.cmplt(limit).all();
        if inside { *self.cells.at(cell.x as u32, cell.y as u32) } else { 0 }
    }
}

/// The square of a grid from the origin that a point lies in, for what is looked up by its place.
pub(crate) fn bucket(p: DVec2, side_m: f64) -> [i64; 2] {
    let cell = (p / side_m).floor();
    [cell.x as i64, cell.y as i64]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane;

    #[test]
    fn a_filled_ring_is_empty_in_its_hole_and_outside() {
        let hole = plane::rectangle(Bounds::square(DVec2::ZERO, 4.0)).exterior;
        let outer = plane::rectangle(Bounds::square(DVec2::ZERO, 10.0)).exterior;
        let ring = Polygon { exterior: outer, holes: vec![hole] };
        let mut raster = PlaneRaster::new(Bounds::square(DVec2::ZERO, 20.0), 0.25);
        raster.fill(std::slice::from_ref(&ring), 7);
        for i in 0..400 {
            let p = DVec2::new(f64::from(i % 20) - 9.6, f64::from(i / 20) - 9.6);
            assert_eq!(raster.at(p) == 7, ring.contains(p), "{p}");
        }
        assert_eq!(raster.at(DVec2::splat(11.0)), 0);
    }
}

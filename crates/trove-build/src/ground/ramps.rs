//! Where what lies beside the carriageway comes down to it.

use std::collections::HashMap;

use glam::{DVec2, IVec2};
use trove_model::{HeightField, Polygon};

/// A cell of the ground is so many parts wide where it has ramps.
pub(super) const PARTS: i32 = 4;
/// Length of a ramp: a kerb's height over this is about 1 in 10.
const RAMP_M: f64 = 1.2;
/// Nodes of a cell's parts along one side.
const NODES: usize = PARTS as usize + 1;

/// What heights above the carriageway are multiplied by: 1 nearly everywhere, less at dropped kerbs; a plane on each
/// triangle of the parts of a cell.
#[derive(Clone, Debug)]
pub(crate) struct Ramps {
    origin: DVec2,
    cell_m: f64,
    // Only ever looked up, so the order inside does not reach a result.
    cells: HashMap<IVec2, [[f32; NODES]; NODES]>,
}

impl Ramps {
    /// `low` within the polygons, rising to 1 around them.
    pub(crate) fn new(field: &HeightField, dropped: &[Polygon], low: f64) -> Self {
        let mut ramps = Self { origin: field.origin, cell_m: field.cell_m, cells: HashMap::new() };
        for polygon in dropped {
            let Some(bounds) = polygon.bounds() else { continue };
            let (first, last) = (ramps.cell(bounds.min - RAMP_M), ramps.cell(bounds.max + RAMP_M));
            for cell in (first.y..=last.y).flat_map(|y| (first.x..=last.x).map(move |x| IVec2::new(x, y))) {
                let corner = ramps.origin + cell.as_dvec2() * ramps.cell_m;
                let part_m = ramps.cell_m / f64::from(PARTS);
                let nodes = ramps.cells.entry(cell).or_insert([[1.0; NODES]; NODES]);
                for (y, row) in nodes.iter_mut().enumerate() {
                    for (x, node) in row.iter_mut().enumerate() {
                        let p = corner + DVec2::new(x as f64, y as f64) * part_m;
                        let distance_m = if polygon.contains(p) { 0.0 } else { polygon.edge_distance_m(p) };
                        let factor = low + (1.0 - low) * (distance_m / RAMP_M).min(1.0);
                        *node = node.min(factor as f32);
                    }
                }
            }
        }
        ramps
    }

    /// The factor at a point.
    pub(crate) fn at(&self, p: DVec2) -> f64 {
        let g = (p - self.origin) / self.cell_m;
        let Some(nodes) = self.cells.get(&g.floor().as_ivec2()) else { return 1.0 };
        let g = (g - g.floor()) * f64::from(PARTS);
        let part = g.floor().clamp(DVec2::ZERO, DVec2::splat(f64::from(PARTS - 1)));
        let f = g - part;
        let (x, y) = (part.x as usize, part.y as usize);
        let z = |dx: usize, dy: usize| f64::from(nodes[y + dy][x + dx]);
        // Cut along the same diagonal as the ground's cells.
        if f.x >= f.y {
            z(0, 0) + f.x * (z(1, 0) - z(0, 0)) + f.y * (z(1, 1) - z(1, 0))
        } else {
            z(0, 0) + f.y * (z(0, 1) - z(0, 0)) + f.x * (z(1, 1) - z(0, 1))
        }
    }

    /// Whether a cell of the ground has a ramp.
    pub(super) fn has(&self, cell: IVec2) -> bool {
        self.cells.contains_key(&cell)
    }

    /// Whether a segment passes a ramp.
    pub(super) fn touches(&self, a: DVec2, b: DVec2) -> bool {
        let (low, high) = (self.cell(a.min(b)), self.cell(a.max(b)));
        (low.y..=high.y).any(|y| (low.x..=high.x).any(|x| self.has(IVec2::new(x, y))))
    }

    fn cell(&self, p: DVec2) -> IVec2 {
        ((p - self.origin) / self.cell_m).floor().as_ivec2()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane;
    use trove_model::Bounds;

    #[test]
    fn a_ramp_is_low_within_its_polygon_and_rises_over_its_length_without_steps() {
        let field = HeightField { cell_m: 2.0, ..HeightField::flat(Bounds::square(DVec2::ZERO, 40.0), 0.0) };
        let dropped = [plane::rectangle(Bounds::square(DVec2::new(0.3, 0.7), 3.0))];
        let ramps = Ramps::new(&field, &dropped, 0.1);
        let mut before = 1.0;
        for i in 0..400 {
            let x = f64::from(i) * 0.02 - 4.0;
            let factor = ramps.at(DVec2::new(x, 0.7));
            assert!((factor - before).abs() < 0.03, "{x}: {before} {factor}");
            before = factor;
        }
        assert!((ramps.at(DVec2::new(0.3, 0.7)) - 0.1).abs() < 1e-6);
        assert_eq!(ramps.at(DVec2::new(9.0, 0.7)), 1.0);
    }
}

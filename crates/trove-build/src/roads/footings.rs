//! What lies under a point, exactly.

use std::collections::HashMap;

use glam::{DVec2, IVec2};
use trove_model::{Bounds, Polygon};

use crate::geometry::plane_raster::PlaneRaster;

const CELL_M: f64 = 0.5;
/// The bit of cells that edges pass.
const EDGES: u8 = 1 << 7;

/// What lies under a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Footing {
    /// Road, or the solid ramp of one that rises.
    Carriageway,
    /// Sidewalk with its kerb stones.
    Sidewalk,
    /// Neither.
    Land,
    /// Nothing stands here.
    Water,
}

/// Areas of a place that can be asked at any point; where areas overlap the first is meant.
#[derive(Clone, Debug)]
pub(super) struct Footings {
    origin: DVec2,
    areas: Vec<Footing>,
    /// One bit an area: the cells whose middle lies in it; and [`EDGES`].
    middles: PlaneRaster,
    /// Edges that pass a cell, with the bit of their area. Only ever looked up.
    edges: HashMap<IVec2, Vec<(DVec2, DVec2, u8)>>,
}

impl Footings {
    /// At most seven areas of polygons that do not overlap.
    pub(super) fn new(bounds: Bounds, areas: &[(Footing, &[Polygon])]) -> Self {
        let mut middles = PlaneRaster::new(bounds, CELL_M);
        let mut edges: HashMap<IVec2, Vec<(DVec2, DVec2, u8)>> = HashMap::new();
        for (i, (_, area)) in areas.iter().enumerate() {
            let bit = 1 << i;
            middles.mark(area, bit);
            for (a, b) in area.iter().flat_map(Polygon::edges) {
                for cell in cells_along((a - bounds.min) / CELL_M, (b - bounds.min) / CELL_M) {
                    edges.entry(cell).or_default().push((a, b, bit));
                    middles.mark_cell(cell, EDGES);
                }
            }
        }
        Self { origin: bounds.min, areas: areas.iter().map(|(footing, _)| *footing).collect(), middles, edges }
    }

    /// What lies at a point; land where no area does.
    pub(super) fn at(&self, p: DVec2) -> Footing {
        let cell = ((p - self.origin) / CELL_M).floor();
        let middle = self.origin + (cell + 0.5) * CELL_M;
        let marks = self.middles.at(middle);
        let mut bits = marks & !EDGES;
        let edges = (marks != bits).then(|| self.edges.get(&cell.as_ivec2())).flatten();
        // Every edge between the point and the cell's middle leads into its area or out of it.
        for &(a, b, bit) in edges.into_iter().flatten() {
            let side = |from: DVec2, to: DVec2, of: DVec2| (to - from).perp_dot(of - from) > 0.0;
            if side(p, middle, a) != side(p, middle, b) && side(a, b, p) != side(a, b, middle) {
                bits ^= bit;
            }
        }
        self.areas.get(bits.trailing_zeros() as usize).copied().unwrap_or(Footing::Land)
    }
}

/// Cells that a segment passes, and few others; coordinates are in cells.
fn cells_along(a: DVec2, b: DVec2) -> Vec<IVec2> {
    let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
    let slope = (high.x - low.x) / (high.y - low.y);
    let mut cells = Vec::new();
    for y in low.y.floor() as i32..=high.y.floor() as i32 {
        let x_at = |at: f64| if slope.is_finite() { low.x + (at.clamp(low.y, high.y) - low.y) * slope } else { low.x };
        let (mut from, mut to) = (x_at(f64::from(y)), x_at(f64::from(y + 1)));
        if !slope.is_finite() {
            (from, to) = (low.x, high.x);
        }
        // Rounding may put the crossing just beyond a cell's border.
        let (from, to) = (from.min(to) - 1e-6, from.max(to) + 1e-6);
        cells.extend((from.floor() as i32..=to.floor() as i32).map(|x| IVec2::new(x, y)));
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane;
    use trove_model::Seed;

    #[test]
    fn every_point_is_told_as_its_polygons_tell_it() {
        let bounds = Bounds::square(DVec2::ZERO, 40.0);
        let road = plane::grown(&plane::strip(&[DVec2::new(-15.0, -9.0), DVec2::new(13.3, 7.1)], 3.0), 1.0);
        let walk = plane::difference(&plane::grown(&road, 2.0), &road);
        let footings = Footings::new(bounds, &[(Footing::Carriageway, &road), (Footing::Sidewalk, &walk)]);
        let mut random = Seed(4).random();
        let within = |area: &[Polygon], p: DVec2| area.iter().any(|a| a.contains(p));
        for _ in 0..4000 {
            let p = DVec2::new(random.index(40_000) as f64, random.index(40_000) as f64) / 1000.0 - 20.0 + 0.00037;
            let expected = match () {
                () if within(&road, p) => Footing::Carriageway,
                () if within(&walk, p) => Footing::Sidewalk,
                () => Footing::Land,
            };
            assert_eq!(footings.at(p), expected, "{p}");
        }
    }
}

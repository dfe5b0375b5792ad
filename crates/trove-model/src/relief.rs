//! What an elevation model knows of the land's height.

use glam::DVec2;

use crate::{Bounds, Provenance, Raster};

/// Heights of the land above an elevation model's datum (sea level for most), at the nodes of a grid in World.
#[derive(Clone, Debug, PartialEq)]
pub struct Relief {
    /// World position of node (0, 0), metres; rows run north.
    pub origin: DVec2,
    /// Distance of neighbouring nodes east and north, metres.
    pub cell_m: DVec2,
    /// Height at each node, metres; NaN where it is not known.
    pub nodes: Raster<f32>,
    /// The files that it comes from, with their licences.
    pub sources: Vec<Provenance>,
}

impl Relief {
    /// What the grid spans, World, metres.
    pub fn bounds(&self) -> Bounds {
        let last = DVec2::new(f64::from(self.nodes.width), f64::from(self.nodes.height)) - 1.0;
        Bounds { min: self.origin, max: self.origin + last * self.cell_m }
    }

    /// Height at a position, metres; `None` beyond the grid and in a cell with a node that is not known.
    ///
    /// Bicubic (Catmull and Rom 1974), so that slopes do not break at the borders of cells, and planes are exact; a node
    /// that is not known beyond the cell is taken to lie on the line of its neighbours.
    pub fn height_m(&self, position: DVec2) -> Option<f64> {
        let g = (position - self.origin) / self.cell_m;
        let limit = DVec2::new(f64::from(self.nodes.width), f64::from(self.nodes.height)) - 1.0;
        if !(g.cmpge(DVec2::ZERO).all() && g.cmple(limit).all()) || limit.min_element() < 1.0 {
            return None;
        }
        let cell = g.floor().min(limit - 1.0);
        let (f, x, y) = (g - cell, cell.x as i64, cell.y as i64);
        let row = |dy: i64| cubic([-1, 0, 1, 2].map(|dx| self.node(x + dx, y + dy)), f.x);
        cubic([-1, 0, 1, 2].map(row), f.y)
    }

    /// A node that is known.
    fn node(&self, x: i64, y: i64) -> Option<f64> {
        let (x, y) = (u32::try_from(x).ok()?, u32::try_from(y).ok()?);
        let is_inside = x < self.nodes.width && y < self.nodes.height;
        is_inside.then(|| f64::from(*self.nodes.at(x, y))).filter(|height_m| height_m.is_finite())
    }
}

/// Between the middle two of four values.
fn cubic([before, from, to, after]: [Option<f64>; 4], t: f64) -> Option<f64> {
    let (from, to) = match (from, to) {
        (Some(from), Some(to)) => (from, to),
        // On a node nothing else counts.
        (Some(from), None) if t == 0.0 => return Some(from),
        (None, Some(to)) if t == 1.0 => return Some(to),
        _ => return None,
    };
    let (before, after) = (before.unwrap_or(2.0 * from - to), after.unwrap_or(2.0 * to - from));
    let (a, b) = (3.0 * (from - to) + after - before, 2.0 * before - 5.0 * from + 4.0 * to - after);
    Some(from + 0.5 * t * (to - before + t * (b + t * a)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn relief(height_m: impl Fn(DVec2) -> f64) -> Relief {
        let (origin, cell_m) = (DVec2::new(-300.0, -200.0), DVec2::new(60.0, 90.0));
        let node = |x, y| height_m(origin + DVec2::new(f64::from(x), f64::from(y)) * cell_m) as f32;
        Relief { origin, cell_m, nodes: Raster::from_fn(11, 8, node), sources: Vec::new() }
    }

    #[test]
    fn a_plane_is_exact_up_to_the_edge_and_nothing_is_known_beyond_it() {
        let plane = |p: DVec2| 120.0 + 0.25 * p.x - 0.5 * p.y;
        let relief = relief(plane);
        let Bounds { min, max } = relief.bounds();
        assert_eq!([min, max], [DVec2::new(-300.0, -200.0), DVec2::new(300.0, 430.0)]);
        for i in 0..=400 {
            let p = min + (max - min) * DVec2::new(f64::from(i), f64::from(i * 7 % 401)) / 400.0;
            assert!((relief.height_m(p).unwrap() - plane(p)).abs() < 1e-4, "{p}");
        }
        for p in [min - 0.01, max + 0.01, DVec2::new(0.0, 1e9), DVec2::splat(f64::NAN)] {
            assert_eq!(relief.height_m(p), None);
        }
    }

    #[test]
    fn slopes_do_not_break_at_the_borders_of_cells() {
        let relief = relief(|p| 30.0 * (p.x / 110.0).sin() + 20.0 * (p.y / 130.0).cos());
        let slope = |x: f64, dx: f64| {
            let h = |x| relief.height_m(DVec2::new(x, 37.0)).unwrap();
            (h(x + dx) - h(x)) / dx
        };
        for k in 1..10 {
            let x = -300.0 + 60.0 * f64::from(k);
            assert!((slope(x, 1e-3) - slope(x, -1e-3)).abs() < 1e-3, "{x}");
        }
    }

    #[test]
    fn around_a_node_that_is_not_known_there_is_no_height_but_beside_that_there_is() {
        let mut relief = relief(|p| 0.1 * p.x);
        *relief.nodes.at_mut(5, 4) = f32::NAN;
        let at = |x: f64, y: f64| relief.height_m(relief.origin + DVec2::new(x, y) * relief.cell_m);
        assert_eq!(at(5.5, 4.5), None);
        assert!((at(6.5, 4.5).unwrap() - 0.1 * (6.5 * 60.0 - 300.0)).abs() < 1e-5);
    }
}

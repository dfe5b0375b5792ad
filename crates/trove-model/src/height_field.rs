//! The ground's height.

use glam::{DVec2, DVec3};

use crate::{Bounds, Raster};

/// Ground height over World's plane, bilinear between grid nodes; outside the grid the nearest edge's height.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    /// World position of node (0, 0), metres; rows run north.
    pub origin: DVec2,
    /// Distance of neighbouring nodes, metres.
    pub cell_m: f64,
    /// Height at each node, metres.
    pub nodes: Raster<f32>,
}

impl HeightField {
    /// The same height everywhere within `bounds`.
    pub fn flat(bounds: Bounds, height_m: f64) -> Self {
        Self {
            origin: bounds.min,
            cell_m: bounds.size_m().max_element().max(1.0),
            nodes: Raster::filled(2, 2, height_m as f32),
        }
    }

    /// Height of the ground at a position, metres.
    pub fn height_m(&self, position: DVec2) -> f64 {
        let g = (position - self.origin) / self.cell_m;
        let limit = DVec2::new(f64::from(self.nodes.width - 1), f64::from(self.nodes.height - 1));
        let g = g.clamp(DVec2::ZERO, limit);
        let cell = g.floor().min((limit - 1.0).max(DVec2::ZERO));
        let (f, x, y) = (g - cell, cell.x as u32, cell.y as u32);
        let (x1, y1) = ((x + 1).min(self.nodes.width - 1), (y + 1).min(self.nodes.height - 1));
        let node = |x, y| f64::from(*self.nodes.at(x, y));
        let south = node(x, y) * (1.0 - f.x) + node(x1, y) * f.x;
        let north = node(x, y1) * (1.0 - f.x) + node(x1, y1) * f.x;
        south * (1.0 - f.y) + north * f.y
    }

    /// Unit normal of the ground at a position, from differences half a metre to each side.
    pub fn normal(&self, position: DVec2) -> DVec3 {
        let h = |dx, dy| self.height_m(position + DVec2::new(dx, dy));
        DVec3::new(h(-0.5, 0.0) - h(0.5, 0.0), h(0.0, -0.5) - h(0.0, 0.5), 1.0).normalize()
    }

    /// A point lifted onto the ground.
    pub fn on_ground(&self, position: DVec2) -> DVec3 {
        position.extend(self.height_m(position))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_plane_is_reproduced_and_its_normal_is_exact() {
        let nodes = Raster::from_fn(5, 4, |x, y| 0.1 * x as f32 + 0.2 * y as f32);
        let field = HeightField { origin: DVec2::new(-1.0, -1.0), cell_m: 1.0, nodes };
        assert!((field.height_m(DVec2::new(0.5, 0.25)) - (0.15 + 0.25)).abs() < 1e-6);
        assert!((field.normal(DVec2::new(1.0, 0.5)) - DVec3::new(-0.1, -0.2, 1.0).normalize()).length() < 1e-6);
        assert!((field.height_m(DVec2::splat(100.0)) - 1.0).abs() < 1e-6);
    }
}

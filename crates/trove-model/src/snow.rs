//! Snow that lies.

use std::sync::Arc;

use glam::{DVec2, Vec2};

use crate::Raster;

/// Snow on whatever faces up under the open sky.
#[derive(Clone, Debug, PartialEq)]
pub struct Snow {
    /// Share of level surfaces that it covers, 0 to 1.
    pub cover: f64,
    /// What wheels and feet have left of it on roads, sidewalks and the ground beside them; `None`: it lies as it fell.
    pub left: Option<Arc<SnowLeft>>,
}

/// Shares of snow that are left on the ground, over World's plane; all of it outside.
#[derive(Clone, Debug, PartialEq)]
pub struct SnowLeft {
    /// World position of the south-west corner, metres; rows run north.
    pub origin: DVec2,
    /// Side of a cell, metres.
    pub cell_m: f64,
    /// 255: all of it.
    pub shares: Raster<u8>,
}

impl SnowLeft {
    /// Share at a position, 0 to 1, bilinear between the cells' middles.
    pub fn at(&self, position: Vec2) -> f32 {
        let g = (position - self.origin.as_vec2()) / self.cell_m as f32 - 0.5;
        let low = g.floor();
        let (f, low) = (g - low, low.as_ivec2());
        let share = |dx: i32, dy: i32| {
            let (x, y) = (low.x + dx, low.y + dy);
            let is_inside = x >= 0 && y >= 0 && x < self.shares.width as i32 && y < self.shares.height as i32;
            if is_inside { f32::from(*self.shares.at(x as u32, y as u32)) / 255.0 } else { 1.0 }
        };
        let south = share(0, 0) * (1.0 - f.x) + share(1, 0) * f.x;
        let north = share(0, 1) * (1.0 - f.x) + share(1, 1) * f.x;
        south * (1.0 - f.y) + north * f.y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_those_of_cells_in_their_middles_and_all_of_it_outside() {
        let shares = Raster::from_fn(4, 3, |x, y| (x * 20 + y * 60) as u8);
        let left = SnowLeft { origin: DVec2::new(-1.0, 2.0), cell_m: 0.5, shares };
        for (x, y) in [(0, 0), (3, 0), (1, 2)] {
            let middle = Vec2::new(-1.0, 2.0) + (Vec2::new(x as f32, y as f32) + 0.5) * 0.5;
            let expected = (x * 20 + y * 60) as f32 / 255.0;
            assert!((left.at(middle) - expected).abs() < 1e-6, "{x} {y}");
        }
        assert!((left.at(Vec2::new(-0.5, 2.25)) - 10.0 / 255.0).abs() < 1e-6);
        assert_eq!(left.at(Vec2::new(50.0, -3.0)), 1.0);
    }
}

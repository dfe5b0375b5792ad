//! Heights on a grid of latitudes and longitudes.

use glam::DVec2;
use trove_model::{Bounds, MapProjection, Raster, Relief};

use crate::geo_extent::GeoExtent;

/// Heights beyond these are none: the Dead Sea and Mount Everest, with room for buildings and errors, metres.
const POSSIBLE_M: [f64; 2] = [-600.0, 9500.0];
/// Samples around the window that curves through it need.
const MARGIN: f64 = 2.0;
/// A position this near to a node is the node, cells.
const ON_NODE: f64 = 1e-6;

/// Which part of the earth is wanted.
pub(super) struct Window {
    extent: GeoExtent,
}

/// A grid of samples, the first of which is the north-west one.
pub(super) struct Grid {
    /// Longitude and latitude of the first sample, degrees.
    pub north_west_deg: DVec2,
    /// From sample to sample east and south, degrees.
    pub step_deg: DVec2,
    /// Columns and rows.
    pub size: [u32; 2],
}

/// The samples of a grid that are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cut {
    /// First column and row.
    pub first: [u32; 2],
    /// Columns and rows.
    pub size: [u32; 2],
}

/// Heights in metres; NaN where they are not known.
pub(super) struct Sheet {
    pub grid: Grid,
    pub heights_m: Raster<f32>,
}

impl Window {
    pub(super) fn around(projection: &MapProjection, area: Bounds) -> Self {
        let (min_lat_deg, min_lon_deg) = projection.geo_from_world(area.min);
        let (max_lat_deg, east_deg) = projection.geo_from_world(area.max);
        // Across the antimeridian the east is beyond 180°.
        let max_lon_deg = if east_deg < min_lon_deg { east_deg + 360.0 } else { east_deg };
        Self { extent: GeoExtent { min_lat_deg, max_lat_deg, min_lon_deg, max_lon_deg } }
    }

    /// The samples of a grid in the window and a few around it; `None` where no part of the window is between its
    /// outer samples.
    pub(super) fn cut(&self, grid: &Grid) -> Option<Cut> {
        let span_deg = (DVec2::new(f64::from(grid.size[0]), f64::from(grid.size[1])) - 1.0) * grid.step_deg;
        // The same longitude may be written 360° apart.
        let middle_deg = (self.extent.min_lon_deg + self.extent.max_lon_deg) / 2.0;
        let turns = ((middle_deg - grid.north_west_deg.x - span_deg.x / 2.0) / 360.0).round();
        let west_deg = grid.north_west_deg.x + 360.0 * turns;
        let range = |from: f64, to: f64, count: u32| {
            let last = f64::from(count) - 1.0;
            if !(from <= last && to >= 0.0 && last >= 1.0) {
                return None;
            }
            let first = (from.floor() - MARGIN).clamp(0.0, last);
            let end = (to.ceil() + MARGIN).clamp(0.0, last);
            Some((first as u32, (end - first) as u32 + 1))
        };
        let across = [self.extent.min_lon_deg, self.extent.max_lon_deg].map(|lon| (lon - west_deg) / grid.step_deg.x);
        let down = [self.extent.max_lat_deg, self.extent.min_lat_deg]
            .map(|lat| (grid.north_west_deg.y - lat) / grid.step_deg.y);
        let (x, width) = range(across[0], across[1], grid.size[0])?;
        let (y, height) = range(down[0], down[1], grid.size[1])?;
        (width > 1 && height > 1).then_some(Cut { first: [x, y], size: [width, height] })
    }
}

impl std::fmt::Display for Window {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.extent.fmt(f)
    }
}

impl Grid {
    /// The part of it that a cut leaves.
    pub(super) fn cut(&self, cut: Cut) -> Self {
        let first = DVec2::new(f64::from(cut.first[0]), -f64::from(cut.first[1]));
        Self { north_west_deg: self.north_west_deg + first * self.step_deg, size: cut.size, ..*self }
    }
}

impl Sheet {
    /// The same heights over World, rows running north.
    pub(super) fn relief(&self, projection: &MapProjection) -> Relief {
        let Grid { north_west_deg, step_deg, size: [width, height] } = self.grid;
        let south_deg = north_west_deg.y - step_deg.y * f64::from(height - 1);
        let origin = projection.world_from_geo(south_deg, north_west_deg.x);
        // One step from World's own origin: the projection is the same everywhere.
        let (lat_deg, lon_deg) = (projection.origin_lat_deg, projection.origin_lon_deg);
        let here = projection.world_from_geo(lat_deg, lon_deg);
        let cell_m = projection.world_from_geo(lat_deg + step_deg.y, lon_deg + step_deg.x) - here;
        let nodes = Raster::from_fn(width, height, |x, y| *self.heights_m.at(x, height - 1 - y));
        Relief { origin, cell_m, nodes, sources: Vec::new() }
    }
}

/// A height in metres, or NaN for what can be none.
pub(super) fn plausible(height_m: f64) -> f32 {
    if (POSSIBLE_M[0]..=POSSIBLE_M[1]).contains(&height_m) { height_m as f32 } else { f32::NAN }
}

/// The height that a sheet knows at a position, its nodes' own exactly.
pub(super) fn at(sheet: &Relief, position: DVec2) -> Option<f64> {
    let g = (position - sheet.origin) / sheet.cell_m;
    let nearest = g.round();
    let size = DVec2::new(f64::from(sheet.nodes.width), f64::from(sheet.nodes.height));
    if (g - nearest).abs().max_element() < ON_NODE && nearest.cmpge(DVec2::ZERO).all() && nearest.cmplt(size).all() {
        let height_m = *sheet.nodes.at(nearest.x as u32, nearest.y as u32);
        return height_m.is_finite().then_some(f64::from(height_m));
    }
    sheet.height_m(position)
}

//! A rectangle on the earth.

use glam::DVec2;
use trove_model::{Bounds, MapProjection};

/// A rectangle of latitudes and longitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeoExtent {
    /// Southern edge.
    pub min_lat_deg: f64,
    /// Northern edge.
    pub max_lat_deg: f64,
    /// Western edge, −180 to 180.
    pub min_lon_deg: f64,
    /// Eastern edge; above 180 where the rectangle crosses the antimeridian.
    pub max_lon_deg: f64,
}

impl GeoExtent {
    /// Around positions, each its latitude and longitude in degrees; `None` where there are none.
    pub(crate) fn around(positions_deg: impl Iterator<Item = [f64; 2]> + Clone) -> Option<Self> {
        let plain = Bounds::around(positions_deg.clone().map(|[lat, lon]| DVec2::new(lon, lat)))?;
        // Across the antimeridian the narrower rectangle is the right one.
        let across = Bounds::around(positions_deg.map(|[lat, lon]| DVec2::new(lon.rem_euclid(360.0), lat)))?;
        let narrow = if across.size_m().x < plain.size_m().x { across } else { plain };
        Some(Self {
            min_lat_deg: narrow.min.y,
            max_lat_deg: narrow.max.y,
            min_lon_deg: narrow.min.x,
            max_lon_deg: narrow.max.x,
        })
    }

    /// Around a rectangle in World.
    pub fn of_bounds(projection: &MapProjection, bounds: Bounds) -> Self {
        let Bounds { min, max } = bounds;
        let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
        let [a, b, c, d] = corners.map(|corner| projection.geo_from_world(corner));
        let east_of = |from: f64, lon: f64| (lon - from).rem_euclid(360.0);
        let west = if east_of(d.1, a.1) < 180.0 { d.1 } else { a.1 };
        Self {
            min_lat_deg: a.0.min(b.0),
            max_lat_deg: c.0.max(d.0),
            min_lon_deg: west,
            max_lon_deg: west + east_of(west, b.1).max(east_of(west, c.1)),
        }
    }

    /// Between two latitudes and two longitudes, degrees; `None` where they are no rectangle on the earth.
    pub(crate) fn between([south, north]: [f64; 2], [west, east]: [f64; 2]) -> Option<Self> {
        let is_on_earth = (-90.0..=90.0).contains(&south) && (south..=90.0).contains(&north);
        let is_around = |lon_deg: f64| (-180.0..=360.0).contains(&lon_deg);
        let east = if east < west { east + 360.0 } else { east };
        let extent = Self { min_lat_deg: south, max_lat_deg: north, min_lon_deg: west, max_lon_deg: east };
        (is_on_earth && is_around(west) && is_around(east)).then_some(extent)
    }

    /// The rectangle in World, metres.
    pub fn bounds(&self, projection: &MapProjection) -> Bounds {
        let width_deg = self.max_lon_deg - self.min_lon_deg;
        // From the middle, so that a wide rectangle is not taken for the rest of the earth.
        let middle_lon_deg = self.min_lon_deg + width_deg / 2.0;
        let min = projection.world_from_geo(self.min_lat_deg, middle_lon_deg);
        let max = projection.world_from_geo(self.max_lat_deg, middle_lon_deg);
        let metres_per_deg = projection.world_from_geo(0.0, projection.origin_lon_deg + 1.0).x
            - projection.world_from_geo(0.0, projection.origin_lon_deg).x;
        let half = DVec2::new(width_deg / 2.0 * metres_per_deg, 0.0);
        Bounds { min: min - half, max: max + half }
    }
}

impl std::fmt::Display for GeoExtent {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "latitude {:.4}° to {:.4}°, longitude {:.4}° to {:.4}°",
            self.min_lat_deg, self.max_lat_deg, self.min_lon_deg, self.max_lon_deg
        )
    }
}

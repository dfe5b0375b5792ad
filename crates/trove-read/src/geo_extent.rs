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

//! From latitude and longitude to World.

use glam::DVec2;

/// Radius of the sphere that nuScenes' own map tools use (WGS84's equatorial radius), metres.
const EARTH_RADIUS_M: f64 = 6_378_137.0;

/// Local equirectangular projection: x = Δlon·R·cos(lat₀), y = Δlat·R, less the anchor.
///
/// It is the devkit's (`export_poses.py`) to a centimetre over a city; its scale error grows with the distance from
/// the origin's latitude, 0.1 % at 10 km.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapProjection {
    /// Latitude of the dataset's own origin.
    pub origin_lat_deg: f64,
    /// Longitude of the dataset's own origin.
    pub origin_lon_deg: f64,
    /// World's origin in the dataset's own plane, metres.
    pub anchor_m: DVec2,
}

impl MapProjection {
    /// World coordinates, metres, of a position on earth; longitudes wrap at the antimeridian.
    pub fn world_from_geo(&self, lat_deg: f64, lon_deg: f64) -> DVec2 {
        let dlon_deg = (lon_deg - self.origin_lon_deg + 540.0).rem_euclid(360.0) - 180.0;
        let dlat_deg = lat_deg - self.origin_lat_deg;
        let plane_m = DVec2::new(
            dlon_deg.to_radians() * EARTH_RADIUS_M * self.origin_lat_deg.to_radians().cos(),
            dlat_deg.to_radians() * EARTH_RADIUS_M,
        );
        plane_m - self.anchor_m
    }

    /// Latitude and longitude, degrees, of a World position.
    pub fn geo_from_world(&self, world: DVec2) -> (f64, f64) {
        let plane_m = world + self.anchor_m;
        let lat_deg = self.origin_lat_deg + (plane_m.y / EARTH_RADIUS_M).to_degrees();
        let cos_lat = self.origin_lat_deg.to_radians().cos();
        let lon_deg = self.origin_lon_deg + (plane_m.x / (EARTH_RADIUS_M * cos_lat)).to_degrees();
        (lat_deg, (lon_deg + 540.0).rem_euclid(360.0) - 180.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back_is_the_same_place_on_both_sides_of_the_antimeridian() {
        for origin_lon_deg in [-71.05785369873047, 179.9999, -179.9999] {
            let projection =
                MapProjection { origin_lat_deg: 42.3, origin_lon_deg, anchor_m: DVec2::new(600.0, 1600.0) };
            let world = DVec2::new(250.0, -130.0);
            let (lat, lon) = projection.geo_from_world(world);
            assert!((projection.world_from_geo(lat, lon) - world).length() < 1e-6);
        }
    }

    #[test]
    fn a_degree_of_latitude_is_111_km() {
        let projection = MapProjection { origin_lat_deg: 0.0, origin_lon_deg: 0.0, anchor_m: DVec2::ZERO };
        assert!((projection.world_from_geo(1.0, 0.0).y - 111_319.49).abs() < 0.01);
    }
}

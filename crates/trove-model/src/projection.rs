//! From latitude and longitude to World.

use glam::DVec2;

/// WGS84: equatorial radius, metres, and flattening.
const EQUATORIAL_RADIUS_M: f64 = 6_378_137.0;
const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// Local equirectangular projection: World = (Δlon·e, Δlat·n) − anchor, with angles in radians from the origin and e, n the
/// metres in a radian there.
///
/// Its scale error grows with the distance from the origin's latitude, 0.1 % at 10 km.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapProjection {
    /// Latitude of the dataset's own origin.
    pub origin_lat_deg: f64,
    /// Longitude of the dataset's own origin.
    pub origin_lon_deg: f64,
    /// World's origin in the dataset's own plane, metres.
    pub anchor_m: DVec2,
    /// Metres in a radian of longitude (x) and of latitude (y) at the origin.
    pub metres_per_rad: DVec2,
    /// How World lies in the plane that the dataset's own coordinates are of.
    pub plane: DatasetPlane,
}

/// The plane of a dataset's own coordinates, such as a city's: World = R(turn) · (plane − origin) / scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DatasetPlane {
    /// World's origin in it, metres.
    pub origin_m: DVec2,
    /// Turns its axes into World's, counter-clockwise.
    pub turn_rad: f64,
    /// Its metres in one of World's.
    pub scale: f64,
}

impl DatasetPlane {
    /// A position of World, metres, from one in the plane.
    pub fn world(&self, plane_m: DVec2) -> DVec2 {
        DVec2::from_angle(self.turn_rad).rotate(plane_m - self.origin_m) / self.scale
    }
}

impl MapProjection {
    /// On a sphere of WGS84's equatorial radius, as in the tools of nuScenes (`export_poses.py`) and, within 10 cm over
    /// the first kilometre, KITTI (whose Mercator grows to the north). Up to 0.5 % longer than a tape would measure.
    pub fn spherical(origin_lat_deg: f64, origin_lon_deg: f64, anchor_m: DVec2) -> Self {
        let cos_lat = origin_lat_deg.to_radians().cos();
        let metres_per_rad = DVec2::new(EQUATORIAL_RADIUS_M * cos_lat, EQUATORIAL_RADIUS_M);
        Self::new(origin_lat_deg, origin_lon_deg, anchor_m, metres_per_rad)
    }

    /// On WGS84's ellipsoid: the metres of recordings in UTM or in a local frame.
    pub fn ellipsoidal(origin_lat_deg: f64, origin_lon_deg: f64, anchor_m: DVec2) -> Self {
        let (sin_lat, cos_lat) = origin_lat_deg.to_radians().sin_cos();
        let eccentricity2 = FLATTENING * (2.0 - FLATTENING);
        let bent = 1.0 - eccentricity2 * sin_lat * sin_lat;
        // Radii of curvature across the meridian and along it.
        let prime_vertical_m = EQUATORIAL_RADIUS_M / bent.sqrt();
        let meridian_m = prime_vertical_m * (1.0 - eccentricity2) / bent;
        let metres_per_rad = DVec2::new(prime_vertical_m * cos_lat, meridian_m);
        Self::new(origin_lat_deg, origin_lon_deg, anchor_m, metres_per_rad)
    }

    fn new(origin_lat_deg: f64, origin_lon_deg: f64, anchor_m: DVec2, metres_per_rad: DVec2) -> Self {
        let plane = DatasetPlane { origin_m: anchor_m, turn_rad: 0.0, scale: 1.0 };
        Self { origin_lat_deg, origin_lon_deg, anchor_m, metres_per_rad, plane }
    }

    /// World coordinates, metres, of a position on earth; longitudes wrap at the antimeridian.
    pub fn world_from_geo(&self, lat_deg: f64, lon_deg: f64) -> DVec2 {
        let dlon_deg = (lon_deg - self.origin_lon_deg + 540.0).rem_euclid(360.0) - 180.0;
        let dlat_deg = lat_deg - self.origin_lat_deg;
        DVec2::new(dlon_deg.to_radians(), dlat_deg.to_radians()) * self.metres_per_rad - self.anchor_m
    }

    /// Latitude and longitude, degrees, of a World position.
    pub fn geo_from_world(&self, world: DVec2) -> (f64, f64) {
        let rad = (world + self.anchor_m) / self.metres_per_rad;
        let lon_deg = self.origin_lon_deg + rad.x.to_degrees();
        (self.origin_lat_deg + rad.y.to_degrees(), (lon_deg + 540.0).rem_euclid(360.0) - 180.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back_is_the_same_place_on_both_sides_of_the_antimeridian() {
        for origin_lon_deg in [-71.05785369873047, 179.9999, -179.9999] {
            let projection = MapProjection::spherical(42.3, origin_lon_deg, DVec2::new(600.0, 1600.0));
            let world = DVec2::new(250.0, -130.0);
            let (lat, lon) = projection.geo_from_world(world);
            assert!((projection.world_from_geo(lat, lon) - world).length() < 1e-6);
        }
    }

    #[test]
    fn a_degree_of_latitude_is_111_km() {
        let projection = MapProjection::spherical(0.0, 0.0, DVec2::ZERO);
        assert!((projection.world_from_geo(1.0, 0.0).y - 111_319.49).abs() < 0.01);
    }

    #[test]
    fn an_ellipsoid_s_degrees_are_those_of_the_tables() {
        // Lengths of a degree at 45° by the series in NIMA TR8350.2: 111,131.8 m of latitude, 78,846.8 m of longitude.
        let projection = MapProjection::ellipsoidal(45.0, 7.0, DVec2::ZERO);
        let degree_m = projection.metres_per_rad * 1f64.to_radians();
        assert!((degree_m - DVec2::new(78_846.8, 111_131.8)).length() < 0.2, "{degree_m}");
    }
}

//! Other coordinates on earth than latitude and longitude: UTM's and ECEF's, all on WGS84.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DQuat, DVec2, DVec3};
use proj4rs::Proj;
use proj4rs::transform::transform;

/// A step north for telling which way it is, radians (6 m).
const STEP_RAD: f64 = 1e-6;

/// A zone of the Universal Transverse Mercator grid.
pub(crate) struct Utm {
    grid: Proj,
    geographic: Proj,
}

impl Utm {
    /// Zone 1 to 60; `None` for another number.
    pub(crate) fn new(zone: u32, is_south: bool) -> Option<Self> {
        if !(1..=60).contains(&zone) {
            return None;
        }
        let south = if is_south { " +south" } else { "" };
        let grid = Proj::from_proj_string(&format!("+proj=utm +zone={zone}{south} +datum=WGS84 +units=m")).ok()?;
        Some(Self { grid, geographic: geographic()? })
    }

    /// Latitude and longitude, degrees, of easting and northing, metres; `None` off the grid.
    pub(crate) fn geo_from_utm(&self, utm_m: DVec2) -> Option<(f64, f64)> {
        let geo = moved(&self.grid, &self.geographic, utm_m.extend(0.0))?;
        Some((geo.y.to_degrees(), geo.x.to_degrees()))
    }

    /// Easting and northing, metres, of latitude and longitude, degrees; `None` off the grid.
    pub(crate) fn utm_from_geo(&self, lat_deg: f64, lon_deg: f64) -> Option<DVec2> {
        let geo = DVec3::new(lon_deg.to_radians(), lat_deg.to_radians(), 0.0);
        Some(moved(&self.geographic, &self.grid, geo)?.truncate())
    }

    /// Direction of true north on the grid and length of a metre there: grid = `scale` · rotation by −convergence · true.
    /// The first is the angle, radians, by which true north lies clockwise of grid north; `None` off the grid.
    pub(crate) fn convergence_and_scale(&self, lat_deg: f64, lon_deg: f64) -> Option<(f64, f64)> {
        let step_deg = STEP_RAD.to_degrees();
        let at = |lat_deg| self.utm_from_geo(lat_deg, lon_deg);
        let north = at(lat_deg + step_deg)? - at(lat_deg - step_deg)?;
        let metres_per_rad = trove_model::MapProjection::ellipsoidal(lat_deg, lon_deg, DVec2::ZERO).metres_per_rad;
        Some((FRAC_PI_2 - north.to_angle(), north.length() / (2.0 * STEP_RAD * metres_per_rad.y)))
    }
}

/// Earth-centred, earth-fixed coordinates: x to latitude and longitude 0, z to the north pole, metres.
pub(crate) struct Ecef {
    geocentric: Proj,
    geographic: Proj,
}

impl Ecef {
    /// On WGS84; `None` where the projections cannot be had, which a test excludes.
    pub(crate) fn new() -> Option<Self> {
        let geocentric = Proj::from_proj_string("+proj=geocent +datum=WGS84 +units=m").ok()?;
        Some(Self { geocentric, geographic: geographic()? })
    }

    /// Latitude and longitude, degrees, and height above the ellipsoid, metres; `None` at the earth's centre.
    pub(crate) fn geo_from_ecef(&self, ecef_m: DVec3) -> Option<(f64, f64, f64)> {
        let geo = moved(&self.geocentric, &self.geographic, ecef_m)?;
        Some((geo.y.to_degrees(), geo.x.to_degrees(), geo.z))
    }
}

/// Rotation from ECEF's axes to east, north, up at a place.
pub(crate) fn east_north_up_from_ecef(lat_deg: f64, lon_deg: f64) -> DQuat {
    DQuat::from_rotation_x(lat_deg.to_radians() - FRAC_PI_2) * DQuat::from_rotation_z(-lon_deg.to_radians() - FRAC_PI_2)
}

fn geographic() -> Option<Proj> {
    Proj::from_proj_string("+proj=longlat +datum=WGS84").ok()
}

/// A point in other coordinates; `None` where it cannot be.
fn moved(from: &Proj, to: &Proj, point: DVec3) -> Option<DVec3> {
    let mut moved = (point.x, point.y, point.z);
    transform(from, to, &mut moved).ok()?;
    let moved = DVec3::from(moved);
    (point.is_finite() && moved.is_finite() && point.x.abs() < 1e9 * PI).then_some(moved)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utm_is_that_of_the_tables() {
        // Pittsburgh's origin of Argoverse 2 (av2/geometry/utm.py) and the place that it is given for.
        let zone = Utm::new(17, false).unwrap();
        let (lat_deg, lon_deg) = zone.geo_from_utm(DVec2::new(583_710.007_0, 4_477_259.999_9)).unwrap();
        assert!(
            (lat_deg - 40.44177902989321).abs() < 1e-7 && (lon_deg + 80.01294377242584).abs() < 1e-7,
            "{lat_deg} {lon_deg}"
        );
        let back = zone.utm_from_geo(lat_deg, lon_deg).unwrap();
        assert!((back - DVec2::new(583_710.007_0, 4_477_259.999_9)).length() < 1e-3);
        assert!(Utm::new(61, false).is_none() && Utm::new(0, true).is_none());
        assert_eq!(zone.geo_from_utm(DVec2::new(f64::NAN, 0.0)), None);
    }

    #[test]
    fn true_north_converges_with_the_grid_s_on_the_middle_meridian() {
        let zone = Utm::new(32, false).unwrap();
        let (convergence, scale) = zone.convergence_and_scale(49.0, 9.0).unwrap();
        assert!(convergence.abs() < 1e-7 && (scale - 0.9996).abs() < 1e-6, "{convergence} {scale}");
        // East of it grid north lies east of true north by Δlon·sin(lat), to the first order.
        let (convergence, _) = zone.convergence_and_scale(49.0, 10.0).unwrap();
        assert!((convergence + 1f64.to_radians() * 49f64.to_radians().sin()).abs() < 1e-5, "{convergence}");
    }

    #[test]
    fn ecef_s_axes_are_the_equator_and_the_pole() {
        let ecef = Ecef::new().unwrap();
        let (lat_deg, lon_deg, height_m) = ecef.geo_from_ecef(DVec3::new(0.0, 6_378_137.0 + 5.0, 0.0)).unwrap();
        assert!(lat_deg.abs() < 1e-9 && (lon_deg - 90.0).abs() < 1e-9 && (height_m - 5.0).abs() < 1e-4);
        // There the axis y looks up and x to the west.
        let rotation = east_north_up_from_ecef(lat_deg, lon_deg);
        assert!((rotation * DVec3::Y - DVec3::Z).length() < 1e-9 && (rotation * DVec3::X + DVec3::X).length() < 1e-9);
        assert!((rotation * DVec3::Z - DVec3::Y).length() < 1e-9);
        assert_eq!(ecef.geo_from_ecef(DVec3::NAN), None);
    }
}

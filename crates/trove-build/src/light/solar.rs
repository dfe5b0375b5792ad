//! Where the sun stands.
//!
//! Jean Meeus, *Astronomical Algorithms* (2nd edition), chapters 12, 22 and 25, low accuracy: 0.01° between 1950 and
//! 2050. The refraction is Sæmundsson's.

use glam::DVec3;

/// Julian day of 1970-01-01 00:00 UTC.
const JD_UNIX: f64 = 2_440_587.5;
/// Julian day of the epoch J2000.0.
const JD_J2000: f64 = 2_451_545.0;
/// Terrestrial time is ahead of UTC by 64 s (2000) to 69 s (since 2017).
const TT_FROM_UTC_S: f64 = 69.0;

/// Unit vector to the sun as it is seen (with refraction), World (x east, y north, z up), from a place on earth at
/// nanoseconds since 1970 UTC.
pub(super) fn to_sun(time_ns: i64, lat_deg: f64, lon_deg: f64) -> DVec3 {
    let seen = seen_from(equatorial(centuries(time_ns)), time_ns, lat_deg, lon_deg);
    let height = seen.z.clamp(-1.0, 1.0).asin();
    let lifted = height + refraction_rad(height);
    (seen.truncate().normalize_or_zero() * lifted.cos()).extend(lifted.sin())
}

/// A place among the stars, radians.
#[derive(Clone, Copy)]
pub(super) struct Equatorial {
    pub(super) right_ascension: f64,
    pub(super) declination: f64,
}

impl Equatorial {
    /// From ecliptic longitude and latitude, radians.
    pub(super) fn from_ecliptic(longitude: f64, latitude: f64, obliquity: f64) -> Self {
        let (sin, cos) = obliquity.sin_cos();
        let right_ascension =
            (longitude.sin() * latitude.cos() * cos - latitude.sin() * sin).atan2(longitude.cos() * latitude.cos());
        let declination = (latitude.sin() * cos + latitude.cos() * sin * longitude.sin()).asin();
        Self { right_ascension, declination }
    }
}

/// Julian centuries of terrestrial time since the epoch at nanoseconds since 1970 UTC.
pub(super) fn centuries(time_ns: i64) -> f64 {
    let days_tt = time_ns as f64 / 86_400e9 + TT_FROM_UTC_S / 86_400.0;
    (days_tt + JD_UNIX - JD_J2000) / 36_525.0
}

/// Unit vector to a place among the stars, World, without refraction.
pub(super) fn seen_from(
    Equatorial { right_ascension, declination }: Equatorial,
    time_ns: i64,
    lat_deg: f64,
    lon_deg: f64,
) -> DVec3 {
    let days_utc = time_ns as f64 / 86_400e9;
    // Sidereal time at Greenwich (12.4) turns right ascension into the hour angle here.
    let d = days_utc + JD_UNIX - JD_J2000;
    let sidereal_deg = 280.460_618_37 + 360.985_647_366_29 * d;
    let hour_angle = (sidereal_deg + lon_deg).to_radians() - right_ascension;

    let lat = lat_deg.to_radians();
    let east = -declination.cos() * hour_angle.sin();
    let north = declination.sin() * lat.cos() - declination.cos() * hour_angle.cos() * lat.sin();
    let up = declination.sin() * lat.sin() + declination.cos() * hour_angle.cos() * lat.cos();
    DVec3::new(east, north, up)
}

/// The ecliptic's slant, radians.
pub(super) fn obliquity_rad(t: f64) -> f64 {
    (23.439_291_1 - 0.013_004_2 * t + 0.002_56 * node_rad(t).cos()).to_radians()
}

fn node_rad(t: f64) -> f64 {
    (125.04 - 1_934.136 * t).to_radians()
}

/// The sun's apparent place.
fn equatorial(t: f64) -> Equatorial {
    let mean_longitude_deg = 280.466_46 + 36_000.769_83 * t + 0.000_303_2 * t * t;
    let anomaly = (357.529_11 + 35_999.050_29 * t - 0.000_153_7 * t * t).to_radians();
    let centre_deg = (1.914_602 - 0.004_817 * t) * anomaly.sin()
        + (0.019_993 - 0.000_101 * t) * (2.0 * anomaly).sin()
        + 0.000_289 * (3.0 * anomaly).sin();
    let longitude = (mean_longitude_deg + centre_deg - 0.005_69 - 0.004_78 * node_rad(t).sin()).to_radians();
    Equatorial::from_ecliptic(longitude, 0.0, obliquity_rad(t))
}

/// By how much air lifts a body at a true height, radians; nothing below −1°.
fn refraction_rad(height: f64) -> f64 {
    let h_deg = height.to_degrees();
    if h_deg < -1.0 {
        return 0.0;
    }
    let minutes = 1.02 / (h_deg + 10.3 / (h_deg + 5.11)).to_radians().tan();
    (minutes / 60.0).to_radians().max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Height and azimuth from north through east, degrees.
    fn sun_deg(unix_s: i64, lat_deg: f64, lon_deg: f64) -> (f64, f64) {
        let s = to_sun(unix_s * 1_000_000_000, lat_deg, lon_deg);
        (s.z.asin().to_degrees(), s.x.atan2(s.y).to_degrees().rem_euclid(360.0))
    }

    #[test]
    fn the_sun_stands_where_published_examples_have_it() {
        // Reda and Andreas, Solar Position Algorithm (NREL/TP-560-34302), appendix A.5: 2003-10-17 19:30:30 UTC,
        // topocentric zenith 50.11162°, azimuth 194.34024°.
        let (height, azimuth) = sun_deg(1_066_419_030, 39.742_476, -105.178_6);
        assert!((height - (90.0 - 50.111_62)).abs() < 0.02, "{height}");
        assert!((azimuth - 194.340_24).abs() < 0.02, "{azimuth}");
    }

    #[test]
    fn its_place_among_the_stars_is_meeus_own() {
        // Example 25.a: 1992-10-13 0h TD, apparent right ascension 198.38083°, declination −7.78507°.
        let Equatorial { right_ascension: ra, declination: dec } =
            equatorial((8_321.0 + JD_UNIX - JD_J2000) / 36_525.0);
        assert!((ra.to_degrees().rem_euclid(360.0) - 198.380_83).abs() < 1e-3);
        assert!((dec.to_degrees() + 7.785_07).abs() < 1e-3);
    }

    #[test]
    fn the_sun_is_in_the_zenith_where_the_almanac_has_it() {
        // Equinoxes and solstices of 2019 (UTC, to the minute) give the declination; the equation of time, to some
        // seconds, gives the longitude over which the sun stands.
        for (unix_s, declination_deg, equation_min) in [
            (1_553_119_080, 0.0, -7.42),    // March 20, 21:58
            (1_561_132_440, 23.435, -1.82), // June 21, 15:54
            (1_569_225_000, 0.0, 7.48),     // September 23, 07:50
            (1_576_988_340, -23.435, 1.70), // December 22, 04:19
        ] {
            let hours = f64::from(unix_s % 86_400) / 3600.0;
            let lon_deg = -15.0 * (hours - 12.0 + equation_min / 60.0);
            let (height, _) = sun_deg(i64::from(unix_s), declination_deg, lon_deg);
            assert!(height > 89.9, "{unix_s}: {height}");
        }
    }

    #[test]
    fn at_noon_it_stands_south_in_the_north_and_north_in_the_south() {
        // The equation of time is longest on November 3 (16 min 26 s) and February 11 (−14 min 14 s).
        for (unix_s, lat_deg, lon_deg, height_deg, azimuth_deg) in [
            (1_572_781_414, 51.4779, 0.0, 90.0 - 51.4779 - 15.05, 180.0), // Greenwich, 2019-11-03 11:43:34
            (1_549_887_254, 51.4779, 0.0, 90.0 - 51.4779 - 14.02, 180.0), // Greenwich, 2019-02-11 12:14:14
            (1_572_745_414, -33.8568, 150.0, 90.0 - 33.8568 + 14.92, 0.0), // 150° E, ten hours before Greenwich
        ] {
            let (height, azimuth) = sun_deg(unix_s, lat_deg, lon_deg);
            let off = (azimuth - azimuth_deg + 180.0).rem_euclid(360.0) - 180.0;
            assert!(off.abs() < 0.1, "{unix_s}: {azimuth}");
            assert!((height - height_deg).abs() < 0.1, "{unix_s}: {height} instead of {height_deg}");
        }
    }

    #[test]
    fn recordings_have_their_sun_on_the_right_side() {
        // scene-0061: Singapore, 2018-07-24 11:28:47 +0800, an hour and three quarters before noon by the sun.
        let (height, azimuth) = sun_deg(1_532_402_927, 1.299, 103.788);
        assert!((55.0..62.0).contains(&height) && azimuth < 90.0, "{height} {azimuth}");
        // scene-0103: Boston, 2018-08-01 15:2x −0400, in the south-west.
        let (height, azimuth) = sun_deg(1_533_151_600, 42.35, -71.05);
        assert!((35.0..60.0).contains(&height) && (210.0..260.0).contains(&azimuth), "{height} {azimuth}");
    }
}

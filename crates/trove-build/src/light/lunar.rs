//! Where the moon stands, and how bright it is.
//!
//! Jean Meeus, *Astronomical Algorithms* (2nd edition), chapters 47 and 48, the larger terms of each series: 0.03°. Its brightness
//! by phase is Allen's (*Astrophysical Quantities*, 3rd edition, §66).

use glam::DVec3;
use trove_model::Moon;

use super::solar::{Equatorial, centuries, obliquity_rad, seen_from, to_sun};

/// Multiples of the elongation, the sun's anomaly, the moon's anomaly and its argument of latitude, and degrees.
type Term = ([i8; 4], f64);
#[rustfmt::skip]
const LONGITUDE: [Term; 19] = [
    ([0, 0, 1, 0], 6.288_774), ([2, 0, -1, 0], 1.274_027), ([2, 0, 0, 0], 0.658_314), ([0, 0, 2, 0], 0.213_618),
    ([0, 1, 0, 0], -0.185_116), ([0, 0, 0, 2], -0.114_332), ([2, 0, -2, 0], 0.058_793), ([2, -1, -1, 0], 0.057_066),
    ([2, 0, 1, 0], 0.053_322), ([2, -1, 0, 0], 0.045_758), ([0, 1, -1, 0], -0.040_923), ([1, 0, 0, 0], -0.034_720),
    ([0, 1, 1, 0], -0.030_383), ([2, 0, 0, -2], 0.015_327), ([0, 0, 1, 2], -0.012_528), ([0, 0, 1, -2], 0.010_980),
    ([4, 0, -1, 0], 0.010_675), ([0, 0, 3, 0], 0.010_034), ([4, 0, -2, 0], 0.008_548),
];
#[rustfmt::skip]
const LATITUDE: [Term; 10] = [
    ([0, 0, 0, 1], 5.128_122), ([0, 0, 1, 1], 0.280_602), ([0, 0, 1, -1], 0.277_693), ([2, 0, 0, -1], 0.173_237),
    ([2, 0, -1, 1], 0.055_413), ([2, 0, -1, -1], 0.046_271), ([2, 0, 0, 1], 0.032_573), ([0, 0, 2, 1], 0.017_198),
    ([2, 0, 1, -1], 0.009_266), ([0, 0, 2, -1], 0.008_822),
];
/// Kilometres, of cosines.
const MEAN_DISTANCE_KM: f64 = 385_000.56;
#[rustfmt::skip]
const DISTANCE: [Term; 4] = [
    ([0, 0, 1, 0], -20_905.355), ([2, 0, -1, 0], -3_699.111), ([2, 0, 0, 0], -2_955.968), ([0, 0, 2, 0], -569.925),
];
const EARTH_KM: f64 = 6378.14;
/// Magnitudes of the full moon at its mean distance and of the sun.
const FULL_MAG: f64 = -12.73;
const SUN_MAG: f64 = -26.74;

/// The moon as it is seen from a place on earth at nanoseconds since 1970 UTC; `None` below the horizon.
pub(super) fn moon(time_ns: i64, lat_deg: f64, lon_deg: f64) -> Option<Moon> {
    let (equatorial, distance_km) = geocentric(centuries(time_ns));
    let from_centre = seen_from(equatorial, time_ns, lat_deg, lon_deg);
    // From the surface it stands lower than from Earth's centre.
    let to_moon = (from_centre * distance_km - DVec3::Z * EARTH_KM).normalize();
    let elongation_rad = to_moon.angle_between(to_sun(time_ns, lat_deg, lon_deg));
    let phase_deg = 180.0 - elongation_rad.to_degrees();
    let dimmer_mag = 0.026 * phase_deg + 4e-9 * phase_deg.powi(4);
    let share = 10f64.powf(-0.4 * (FULL_MAG + dimmer_mag - SUN_MAG)) * (MEAN_DISTANCE_KM / distance_km).powi(2);
    (to_moon.z > 0.0).then_some(Moon { to_moon, share_of_sun: share })
}

/// Where it stands among the stars, from Earth's centre, and its distance from there, kilometres.
fn geocentric(t: f64) -> (Equatorial, f64) {
    let mean_longitude_deg = 218.316_447_7 + 481_267.881_234_21 * t;
    let arguments_deg = [
        297.850_192_1 + 445_267.111_403_4 * t,
        357.529_109_2 + 35_999.050_290_9 * t,
        134.963_396_4 + 477_198.867_505_5 * t,
        93.272_095_0 + 483_202.017_523_3 * t,
    ];
    let angle = |multiples: &[i8; 4]| -> f64 {
        multiples
            .iter()
            .zip(arguments_deg)
            .map(|(n, argument_deg)| f64::from(*n) * argument_deg)
            .sum::<f64>()
            .to_radians()
    };
    let sum = |terms: &[Term]| -> f64 { terms.iter().map(|(multiples, size)| size * angle(multiples).sin()).sum() };
    let longitude = (mean_longitude_deg + sum(&LONGITUDE)).to_radians();
    let latitude = sum(&LATITUDE).to_radians();
    let distance_km =
        MEAN_DISTANCE_KM + DISTANCE.iter().map(|(multiples, km)| km * angle(multiples).cos()).sum::<f64>();
    (Equatorial::from_ecliptic(longitude, latitude, obliquity_rad(t)), distance_km)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_place_among_the_stars_is_meeus_own() {
        // Example 47.a: 1992-04-12 0h TD, right ascension 134.688°, declination 13.768°, 368,410 km.
        let (Equatorial { right_ascension, declination }, distance_km) =
            geocentric((2_448_724.5 - 2_451_545.0) / 36_525.0);
        assert!((right_ascension.to_degrees() - 134.688).abs() < 0.03, "{}", right_ascension.to_degrees());
        assert!((declination.to_degrees() - 13.768).abs() < 0.03, "{}", declination.to_degrees());
        assert!((distance_km - 368_410.0).abs() < 1000.0, "{distance_km}");
    }

    #[test]
    fn full_moons_are_opposite_to_the_sun_and_new_ones_dark() {
        // 2018-07-27 20:20 UTC, full (and eclipsed); 2018-08-11 09:58 UTC, new.
        let seen = |unix_s: i64| (0..24).filter_map(move |h| moon(unix_s * 1_000_000_000, 0.0, 15.0 * f64::from(h)));
        let full = seen(1_532_722_800).map(|moon| moon.share_of_sun).fold(0.0, f64::max);
        // 0.25 lx of the sun's 127,500 lx, a little farther than in the mean.
        assert!((0.25 / 127_500.0..0.33 / 127_500.0).contains(&full), "{full:e}");
        let new = seen(1_533_981_480).map(|moon| moon.share_of_sun).fold(0.0, f64::max);
        assert!(new < 1e-3 * full, "{new:e}");
    }
}

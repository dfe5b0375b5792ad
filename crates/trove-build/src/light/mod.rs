//! Sun and sky of the recording's place and time.

mod lamps;
mod lunar;
mod solar;

use std::sync::Arc;

use trove_model::{Bounds, Drive, Environment, EnvironmentMap, Light, PhysicalSky, Random, Seed};

pub(crate) use lamps::{is_dark, switch_on};
use lunar::moon;
use solar::to_sun;

/// How much light the ground reflects on average: asphalt and concrete with some green.
const GROUND_ALBEDO: f64 = 0.2;
/// The same under snow: roofs and lawns are white, roads are not.
const SNOW_ALBEDO: f64 = 0.6;
/// A drawn time of day has the sun at least this high, so that there are shadows.
const MIN_SUN_RAD: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// Nearer to the equator the air is humid all year.
const HUMID_LAT_DEG: f64 = 20.0;
/// Turbidities of humid air, and of fair weather elsewhere: skies as pale as those of the recordings.
const HUMID_TURBIDITY: [f64; 2] = [5.0, 7.5];
const FAIR_TURBIDITY: [f64; 2] = [3.0, 4.5];
/// Fair weather: what cars with cameras are mostly sent out in.
const FAIR_CLOUDS: [f64; 2] = [0.15, 0.4];
const DAY_NS: i64 = 86_400_000_000_000;

/// Where the light comes from.
#[derive(Clone, Debug)]
pub enum LightChoice {
    /// Sun and sky of the place.
    Sky(SkyChoice),
    /// A photographed sky.
    Map(Arc<EnvironmentMap>),
}

/// Sun and sky of the place: when, and what is known of the weather; what is not is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SkyChoice {
    /// When.
    pub moment: Moment,
    /// Linke turbidity, 1.7 (crystal clear) to 10 (hazy).
    pub turbidity: Option<f64>,
    /// Mean reflectance of the ground, 0 to 1.
    pub ground_albedo: Option<f64>,
    /// Share of the sky that is clouded, 0 to 1.
    pub clouds: Option<f64>,
}

/// A time for the sun.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Moment {
    /// The recording's, with fair weather.
    #[default]
    Capture,
    /// Nanoseconds since 1970 UTC, with fair weather.
    At(i64),
    /// Another time of the recording's day with the sun at least 10° high, in any weather.
    Drawn,
}

impl LightChoice {
    /// The time of a drive's pictures, nanoseconds since 1970 UTC.
    pub(crate) fn time_ns(&self, drive: &Drive) -> i64 {
        match self {
            Self::Sky(SkyChoice { moment: Moment::At(time_ns), .. }) => *time_ns,
            _ => drive.keyframes.first().map_or(0, |k| k.time_ns),
        }
    }
}

impl Default for LightChoice {
    /// Sun and sky of the recording's place and time.
    fn default() -> Self {
        Self::Sky(SkyChoice::default())
    }
}

/// The light of a place of which snow covers a share.
pub(crate) fn light(drive: &Drive, bounds: Bounds, choice: &LightChoice, snow: f64, seed: Seed) -> Light {
    let choice = match choice {
        LightChoice::Map(map) => return Light::clear(Environment::Map(map.clone())),
        LightChoice::Sky(sky) => sky,
    };
    let time_ns = drive.keyframes.first().map_or(0, |k| k.time_ns);
    let (lat_deg, lon_deg) = drive.projection.geo_from_world(bounds.centre());
    let [clear, hazy] = if lat_deg.abs() < HUMID_LAT_DEG { HUMID_TURBIDITY } else { FAIR_TURBIDITY };
    let mut random = seed.child("sky").random();
    let (turbidity, [fewest, most]) = match choice.moment {
        Moment::Capture | Moment::At(_) => (random.range(clear, hazy), FAIR_CLOUDS),
        Moment::Drawn => (random.range(2.0, hazy), [0.0, 1.0]),
    };
    let cloud_cover = random.range(fewest, most);
    let (to_sun, moon) = match choice.moment {
        Moment::Capture => (to_sun(time_ns, lat_deg, lon_deg), moon(time_ns, lat_deg, lon_deg)),
        Moment::At(time_ns) => (to_sun(time_ns, lat_deg, lon_deg), moon(time_ns, lat_deg, lon_deg)),
        Moment::Drawn => (daytime_sun(time_ns, lat_deg, lon_deg, &mut random), None),
    };
    let environment = Environment::Sky(PhysicalSky {
        to_sun,
        // By day nobody sees by it.
        moon: moon.filter(|_| to_sun.z < 0.0),
        turbidity: choice.turbidity.unwrap_or(turbidity),
        ground_albedo: choice.ground_albedo.unwrap_or(GROUND_ALBEDO + (SNOW_ALBEDO - GROUND_ALBEDO) * snow),
        cloud_cover: choice.clouds.unwrap_or(cloud_cover),
        cloud_seed: random.bits(),
    });
    Light::clear(environment)
}

/// Hour of the day by the mean sun, 0 to 24, at nanoseconds since 1970 UTC.
pub(crate) fn solar_hour(time_ns: i64, lon_deg: f64) -> f64 {
    let days = time_ns as f64 / DAY_NS as f64 + lon_deg / 360.0;
    24.0 * days.rem_euclid(1.0)
}

/// The sun at a time drawn within the 24 hours around `time_ns`; where it never rises high enough, at its highest.
fn daytime_sun(time_ns: i64, lat_deg: f64, lon_deg: f64, random: &mut Random) -> glam::DVec3 {
    let quarter_hours = (0..96).map(|i| to_sun(time_ns + i * (DAY_NS / 96), lat_deg, lon_deg));
    let positions: Vec<glam::DVec3> = quarter_hours.collect();
    let high: Vec<glam::DVec3> = positions.iter().copied().filter(|s| s.z >= MIN_SUN_RAD.sin()).collect();
    let highest = positions.into_iter().max_by(|a, b| a.z.total_cmp(&b.z));
    random.pick(&high).copied().or(highest).unwrap_or(glam::DVec3::Z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    const DRAWN: SkyChoice = SkyChoice { moment: Moment::Drawn, turbidity: None, ground_albedo: None, clouds: None };

    fn sky(choice: SkyChoice, seed: Seed) -> PhysicalSky {
        let drive = testing::drive();
        let bounds = Bounds::square(glam::DVec2::ZERO, 600.0);
        match light(&drive, bounds, &LightChoice::Sky(choice), 0.0, seed).environment {
            Environment::Sky(sky) => sky,
            Environment::Map(_) => panic!("a sky was asked for"),
        }
    }

    #[test]
    fn hours_are_those_of_the_place() {
        // 2018-08-01 16:45 UTC is noon at 71.25° W and half past midnight at 116.25° E.
        let time_ns = 1_533_141_900_000_000_000;
        assert!((solar_hour(time_ns, -71.25) - 12.0).abs() < 1e-6);
        assert!((solar_hour(time_ns, 116.25) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn a_drawn_sun_stands_at_least_ten_degrees_high_and_differs_by_seed() {
        let suns: Vec<f64> = (0..20).map(|i| sky(DRAWN, Seed(i)).to_sun.z).collect();
        assert!(suns.iter().all(|z| *z >= MIN_SUN_RAD.sin()));
        assert!(suns.iter().any(|z| (z - suns[0]).abs() > 0.2));
    }

    #[test]
    fn the_sun_at_capture_does_not_depend_on_the_seed() {
        let (a, b) = (sky(SkyChoice::default(), Seed(1)), sky(SkyChoice::default(), Seed(2)));
        assert_eq!(a.to_sun, b.to_sun);
        assert_ne!(a.cloud_seed, b.cloud_seed);
    }

    #[test]
    fn what_is_given_is_taken_and_changes_nothing_else() {
        let drawn = sky(DRAWN, Seed(3));
        let given = sky(SkyChoice { clouds: Some(1.0), turbidity: Some(2.5), ..DRAWN }, Seed(3));
        assert_eq!(given, PhysicalSky { cloud_cover: 1.0, turbidity: 2.5, ..drawn });
    }
}

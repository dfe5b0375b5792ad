//! Sun and sky of the recording's place and time.

mod solar;

use std::sync::Arc;

use trove_model::{Bounds, Drive, Environment, EnvironmentMap, Light, PhysicalSky, Random, Seed};

use solar::to_sun;

/// How much light the ground reflects on average: asphalt and concrete with some green.
const GROUND_ALBEDO: f64 = 0.2;
/// A drawn time of day has the sun at least this high, so that there are shadows.
const MIN_SUN_RAD: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// Nearer to the equator the air is humid all year.
const HUMID_LAT_DEG: f64 = 20.0;
/// Turbidities of humid air, and of fair weather elsewhere.
const HUMID_TURBIDITY: [f64; 2] = [4.0, 6.0];
const FAIR_TURBIDITY: [f64; 2] = [3.0, 4.0];
const DAY_NS: i64 = 86_400_000_000_000;

/// Where the light comes from.
#[derive(Clone, Debug)]
pub enum LightChoice {
    /// Sun and sky of the recording's place and time, with a haze and clouds that are drawn.
    CaptureTime,
    /// The same place at another time of that day with the sun at least 10° high, other haze, other clouds.
    Random,
    /// A photographed sky.
    Map(Arc<EnvironmentMap>),
}

/// The light of a place.
pub(crate) fn light(drive: &Drive, bounds: Bounds, choice: &LightChoice, seed: Seed) -> Light {
    let time_ns = drive.keyframes.first().map_or(0, |k| k.time_ns);
    let (lat_deg, lon_deg) = drive.projection.geo_from_world(bounds.centre());
    let mut random = seed.child("sky").random();
    let environment = match choice {
        LightChoice::Map(map) => Environment::Map(map.clone()),
        LightChoice::CaptureTime => {
            // Fair weather: what cars with cameras are mostly sent out in.
            let [clear, hazy] = if lat_deg.abs() < HUMID_LAT_DEG { HUMID_TURBIDITY } else { FAIR_TURBIDITY };
            let turbidity = random.range(clear, hazy);
            let cloud_cover = random.range(0.15, 0.4);
            let to_sun = to_sun(time_ns, lat_deg, lon_deg);
            Environment::Sky(PhysicalSky {
                to_sun,
                turbidity,
                ground_albedo: GROUND_ALBEDO,
                cloud_cover,
                cloud_seed: random.bits(),
            })
        }
        LightChoice::Random => {
            let turbidity = random.range(2.0, 6.0);
            let cloud_cover = random.range(0.0, 0.7);
            let to_sun = daytime_sun(time_ns, lat_deg, lon_deg, &mut random);
            Environment::Sky(PhysicalSky {
                to_sun,
                turbidity,
                ground_albedo: GROUND_ALBEDO,
                cloud_cover,
                cloud_seed: random.bits(),
            })
        }
    };
    Light { environment }
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

    fn sky(choice: &LightChoice, seed: Seed) -> PhysicalSky {
        let drive = testing::drive();
        let bounds = Bounds::square(glam::DVec2::ZERO, 600.0);
        match light(&drive, bounds, choice, seed).environment {
            Environment::Sky(sky) => sky,
            Environment::Map(_) => panic!("a sky was asked for"),
        }
    }

    #[test]
    fn a_drawn_sun_stands_at_least_ten_degrees_high_and_differs_by_seed() {
        let suns: Vec<f64> = (0..20).map(|i| sky(&LightChoice::Random, Seed(i)).to_sun.z).collect();
        assert!(suns.iter().all(|z| *z >= MIN_SUN_RAD.sin()));
        assert!(suns.iter().any(|z| (z - suns[0]).abs() > 0.2));
    }

    #[test]
    fn the_sun_at_capture_does_not_depend_on_the_seed() {
        let (a, b) = (sky(&LightChoice::CaptureTime, Seed(1)), sky(&LightChoice::CaptureTime, Seed(2)));
        assert_eq!(a.to_sun, b.to_sun);
        assert_ne!(a.cloud_seed, b.cloud_seed);
    }
}

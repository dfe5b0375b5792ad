//! From radiance to a picture: the sensor's faults, exposure, white balance and tone.
//!
//! The metering and the curve are those of a car's camera: it keeps the picture's mean brightness, lets the sky and the
//! brightest things run softly into white, and colours fade on the way there.

mod meter;
mod sensor;

use rayon::prelude::*;
use trove_model::{ExposureRule, Raster, Shot, WhiteBalance};

/// Develops a shot's picture, 8-bit sRGB; also returns the exposure that was used, in stops.
pub(crate) fn develop(radiance: &Raster<[f32; 3]>, shot: &Shot) -> (Raster<[u8; 3]>, f64) {
    let film = &shot.film;
    let radiance = radiance.map(|rgb| rgb.map(|c| if c.is_finite() { c.max(0.0) } else { 0.0 }));
    let radiance = match &film.sensor {
        Some(model) => sensor::optics(&radiance, model),
        None => radiance,
    };
    let curve = film.tone_curve();
    let ev = match film.exposure {
        ExposureRule::Fixed { ev } => ev,
        ExposureRule::Auto { compensation_ev } => meter::exposure_ev(&radiance, curve) + compensation_ev,
    };
    let balance = match film.white_balance {
        WhiteBalance::Daylight => [1.0; 3],
        WhiteBalance::Auto => meter::white_balance(&radiance),
    };
    let (gain, seed) = (ev.exp2() as f32, shot.seed.child("sensor"));
    let pixel = |(i, rgb): (usize, &[f32; 3])| {
        let exposed = rgb.map(|c| c * gain);
        let counted = film.sensor.as_ref().map_or(exposed, |model| sensor::counted(exposed, ev, model, seed, i));
        curve.srgb([0, 1, 2].map(|c| counted[c] * balance[c]))
    };
    let data = radiance.data.par_iter().enumerate().map(pixel).collect();
    (Raster { width: radiance.width, height: radiance.height, data }, ev)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::{Distortion, Film, Lens, Pose, Seed, SensorModel};

    fn shot(exposure: ExposureRule, sensor: Option<SensorModel>) -> Shot {
        let lens = Lens {
            width_px: 60,
            height_px: 30,
            fx_px: 30.0,
            fy_px: 30.0,
            cx_px: 30.0,
            cy_px: 15.0,
            distortion: Distortion::None,
        };
        Shot {
            film: Film { exposure, sensor, ..Film::default() },
            seed: Seed(1),
            ..Shot::new("test", lens, Pose::IDENTITY)
        }
    }

    fn auto() -> Shot {
        shot(ExposureRule::Auto { compensation_ev: 0.0 }, None)
    }

    fn grey(value: f32) -> Raster<[f32; 3]> {
        Raster::filled(60, 30, [value; 3])
    }

    #[test]
    fn a_picture_twice_as_bright_is_developed_alike() {
        let ((a, a_ev), (b, b_ev)) = (develop(&grey(0.02), &auto()), develop(&grey(0.04), &auto()));
        assert_eq!(a, b);
        assert!((a_ev - b_ev - 1.0).abs() < 1e-9, "{a_ev} {b_ev}");
    }

    #[test]
    fn a_picture_has_the_mean_of_a_cameras_however_bright_its_sky_is() {
        for sky in [2.0, 8.0, 40.0] {
            let mut street = grey(0.1);
            street.data[..60 * 10].fill([sky; 3]);
            let (picture, ev) = develop(&street, &auto());
            let mean = picture.data.iter().map(|rgb| f64::from(rgb[1])).sum::<f64>() / picture.data.len() as f64;
            assert!((mean / 255.0 - 0.42).abs() < 0.01, "{mean} at {ev}");
        }
    }

    #[test]
    fn nothing_brighter_than_white_darkens_the_road_any_more() {
        let ev = |lamp: f32| {
            let mut street = grey(0.1);
            street.data[..60].fill([lamp; 3]);
            develop(&street, &auto()).1
        };
        assert!((ev(1e4) - ev(10.0)).abs() < 1e-6 && ev(1e4) < ev(0.1));
    }

    #[test]
    fn a_black_an_empty_and_a_broken_picture_are_developed_too() {
        assert_eq!(develop(&grey(0.0), &auto()).1, 0.0);
        assert_eq!(develop(&grey(f32::NAN), &auto()).0.data[0], [0; 3]);
        assert_eq!(develop(&Raster::filled(0, 0, [0.0; 3]), &auto()).0.data.len(), 0);
    }

    #[test]
    fn noise_is_the_same_with_any_number_of_threads_and_differs_from_picture_to_picture() {
        let noisy = |threads: usize, seed: u64| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let fixed = ExposureRule::Fixed { ev: 0.0 };
            let shot = Shot { seed: Seed(seed), ..shot(fixed, Some(SensorModel::AUTOMOTIVE)) };
            pool.install(|| develop(&grey(0.1), &shot).0)
        };
        let one = noisy(1, 7);
        assert!(one == noisy(3, 7) && one != noisy(1, 8));
        let (low, high) = one.data.iter().fold((255, 0), |(l, h), p| (p[1].min(l), p[1].max(h)));
        assert!(high - low > 5, "{low} {high}");
    }
}

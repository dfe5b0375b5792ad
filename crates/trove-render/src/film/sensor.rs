//! The faults of a real camera: what the lens does to the light, and the noise of counting it.

use crate::convolution::{convolved, gaussian};
use rayon::prelude::*;
use trove_model::{Raster, Seed, SensorModel, ToneCurve};

use crate::poisson::poisson;

/// Light behind the lens: darker and with fringes of colour in the corners, slightly blurred.
pub(super) fn optics(radiance: &Raster<[f32; 3]>, sensor: &SensorModel) -> Raster<[f32; 3]> {
    let middle = [f64::from(radiance.width) * 0.5, f64::from(radiance.height) * 0.5];
    let corner = middle[0].hypot(middle[1]);
    // cos⁴ of an angle whose tangent grows with the distance from the middle.
    let fall = (1.0 - sensor.vignetting).powf(-0.5) - 1.0;
    // Red, green and blue are pictures of slightly different size.
    let shift = sensor.chromatic_aberration_px / corner;
    let rows = (0..radiance.height).into_par_iter().map(|y| {
        let pixel = |x: u32| {
            let from_middle = [f64::from(x) + 0.5 - middle[0], f64::from(y) + 0.5 - middle[1]];
            let r = from_middle[0].hypot(from_middle[1]) / corner;
            let light = (1.0 + fall * r * r).powi(-2) as f32;
            [1.0 - shift, 1.0, 1.0 + shift].map(|s| [0, 1].map(|i| middle[i] + s * from_middle[i])).map(|p| (p, light))
        };
        let channel = |([x, y], light): ([f64; 2], f32), c: usize| light * between(radiance, x, y, c);
        let colour = |x: u32| {
            let [r, g, b] = pixel(x);
            [channel(r, 0), channel(g, 1), channel(b, 2)]
        };
        (0..radiance.width).map(colour).collect::<Vec<_>>()
    });
    let data = rows.flatten_iter().collect();
    let seen = Raster { width: radiance.width, height: radiance.height, data };
    let seen = if sensor.glare > 0.0 { glaring(&seen, sensor.glare) } else { seen };
    if sensor.blur_px > 0.0 { convolved(&seen, &gaussian(sensor.blur_px)) } else { seen }
}

/// Standard deviations of what the lens scatters, as shares of the picture's diagonal, with equal light in each: together it
/// fades with the square of the distance.
const GLARE: [f64; 4] = [0.002, 0.008, 0.03, 0.12];
/// Reduced pictures are blurred by so many of their pixels.
const REDUCED_PX: f64 = 2.0;

/// A share of every pixel's light scattered over the picture; beyond the border it goes on as at it.
fn glaring(picture: &Raster<[f32; 3]>, share: f64) -> Raster<[f32; 3]> {
    let diagonal = f64::from(picture.width).hypot(f64::from(picture.height));
    let halos = GLARE.map(|part| {
        let sigma_px = part * diagonal;
        let factor = (sigma_px / REDUCED_PX).floor().max(1.0) as u32;
        (factor, convolved(&reduced(picture, factor), &gaussian(sigma_px / f64::from(factor))))
    });
    let of_each = (share / halos.len() as f64) as f32;
    let pixel = |i: u32| {
        let (x, y) = (f64::from(i % picture.width) + 0.5, f64::from(i / picture.width) + 0.5);
        let channel = |c: usize| {
            let halo = |(factor, halo): &(u32, Raster<[f32; 3]>)| {
                between(halo, x / f64::from(*factor), y / f64::from(*factor), c)
            };
            picture.data[i as usize][c] * (1.0 - share as f32) + of_each * halos.iter().map(halo).sum::<f32>()
        };
        [0, 1, 2].map(channel)
    };
    let data = (0..picture.width * picture.height).into_par_iter().map(pixel).collect();
    Raster { width: picture.width, height: picture.height, data }
}

/// The means of squares of `factor` pixels; at the border of those that are there.
fn reduced(picture: &Raster<[f32; 3]>, factor: u32) -> Raster<[f32; 3]> {
    Raster::from_fn(picture.width.div_ceil(factor), picture.height.div_ceil(factor), |x, y| {
        let columns = x * factor..((x + 1) * factor).min(picture.width);
        let rows = y * factor..((y + 1) * factor).min(picture.height);
        let count = (columns.len() * rows.len()) as f32;
        let mut sum = [0.0; 3];
        for rgb in rows.flat_map(|y| columns.clone().map(move |x| picture.at(x, y))) {
            (0..3).for_each(|c| sum[c] += rgb[c] / count);
        }
        sum
    })
}

/// One channel at a position between pixel centres, linearly; beyond the border it goes on as at it.
fn between(picture: &Raster<[f32; 3]>, x: f64, y: f64, channel: usize) -> f32 {
    let (left, top) = ((x - 0.5).floor(), (y - 0.5).floor());
    let (u, v) = ((x - 0.5 - left) as f32, (y - 0.5 - top) as f32);
    let column = |x: f64| x.clamp(0.0, f64::from(picture.width - 1)) as u32;
    let row = |y: f64| y.clamp(0.0, f64::from(picture.height - 1)) as u32;
    let at = |x: f64, y: f64| picture.at(column(x), row(y))[channel];
    let along = |y: f64| at(left, y) * (1.0 - u) + at(left + 1.0, y) * u;
    along(top) * (1.0 - v) + along(top + 1.0) * v
}

/// Stops by which a camera exposes longer than in the midday sun before it amplifies: a pixel of 4.5 µm behind f/1.8 is full
/// after 1/25,000 s there, and 1/60 s is the longest that driving allows.
const LONGER_EV: f64 = 8.5;

/// What the sensor counts of a pixel exposed by so many stops, in the exposure's unit: shot and read noise, and no more than
/// the well holds, or less where few electrons are amplified. `index` is the pixel's place in its picture.
pub(super) fn counted(exposed: [f32; 3], ev: f64, sensor: &SensorModel, seed: Seed, index: usize) -> [f32; 3] {
    let mut random = seed.nth(index as u64).random();
    let gain = (ev - LONGER_EV).max(0.0).exp2();
    let white_e = sensor.full_well_e / gain;
    // Amplified before it is read.
    let read_noise_e = sensor.read_noise_e / gain.sqrt();
    let per_unit = white_e / f64::from(ToneCurve::WHITE);
    exposed.map(|light| {
        let counted = poisson(f64::from(light) * per_unit, &mut random).min(white_e);
        ((counted + read_noise_e * random.normal()) / per_unit).max(0.0) as f32
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: SensorModel = SensorModel {
        full_well_e: 3000.0,
        read_noise_e: 0.0,
        vignetting: 0.0,
        blur_px: 0.0,
        chromatic_aberration_px: 0.0,
        glare: 0.0,
        jpeg_quality: None,
    };

    #[test]
    fn light_is_counted_with_the_noise_of_its_electrons_and_of_reading() {
        for (light, sensor) in [
            (0.01, PLAIN),
            (0.3, PLAIN),
            (1.0, SensorModel { read_noise_e: 25.0, ..PLAIN }),
            (0.3, SensorModel::AUTOMOTIVE),
        ] {
            let n = 20_000;
            let draws: Vec<f64> =
                (0..n).map(|i| f64::from(counted([light as f32; 3], 0.0, &sensor, Seed(3), i)[1])).collect();
            let mean = draws.iter().sum::<f64>() / n as f64;
            let variance = draws.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n as f64;
            let per_unit = sensor.full_well_e / f64::from(ToneCurve::WHITE);
            let expected = (light * per_unit + sensor.read_noise_e.powi(2)) / (per_unit * per_unit);
            assert!((mean / light - 1.0).abs() < 0.01, "{mean} instead of {light}");
            assert!((variance / expected - 1.0).abs() < 0.04, "{variance} instead of {expected} at {light}");
        }
        assert_eq!(counted([0.0; 3], 0.0, &PLAIN, Seed(1), 0), [0.0; 3]);
        assert!(counted([50.0; 3], 0.0, &PLAIN, Seed(1), 0).iter().all(|&c| (c - ToneCurve::WHITE).abs() < 1e-5));
    }

    #[test]
    fn what_is_amplified_by_four_stops_has_four_times_the_noise() {
        let noise = |ev: f64| {
            let n = 20_000;
            let draws: Vec<f64> = (0..n).map(|i| f64::from(counted([0.3; 3], ev, &PLAIN, Seed(4), i)[1])).collect();
            let mean = draws.iter().sum::<f64>() / n as f64;
            (draws.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n as f64).sqrt()
        };
        assert_eq!(noise(0.0), noise(LONGER_EV));
        assert!((noise(LONGER_EV + 4.0) / noise(0.0) - 4.0).abs() < 0.1, "{}", noise(LONGER_EV + 4.0) / noise(0.0));
    }

    #[test]
    fn glare_takes_its_share_of_a_lamp_and_spreads_it_farther_than_any_blur() {
        let (width, height) = (400, 300);
        let mut dark = Raster::filled(width, height, [0.0; 3]);
        *dark.at_mut(200, 150) = [1000.0; 3];
        let seen = optics(&dark, &SensorModel { glare: 0.1, ..PLAIN });
        let total: f64 = seen.data.iter().map(|rgb| f64::from(rgb[1])).sum();
        // Some of the widest halo falls beside the picture.
        assert!((0.97..1.005).contains(&(total / 1000.0)), "{total}");
        let spot = f64::from(seen.at(200, 150)[1]);
        assert!((900.0..910.0).contains(&spot), "{spot}");
        // Light in rings that are each three times as wide is about the same.
        let within = |low: f64, high: f64| {
            let away = |i: usize| (f64::from(i as u32 % width) - 200.0).hypot(f64::from(i as u32 / width) - 150.0);
            let is_in = |i: &usize| (low..high).contains(&away(*i));
            (0..seen.data.len()).filter(is_in).map(|i| f64::from(seen.data[i][1])).sum::<f64>()
        };
        let rings = [within(2.0, 6.0), within(6.0, 18.0), within(18.0, 54.0)];
        assert!(rings.iter().all(|ring| (10.0..45.0).contains(ring)), "{rings:?}");
    }

    #[test]
    fn corners_lose_their_share_of_light_and_the_middle_none() {
        let lit = optics(&Raster::filled(41, 31, [1.0; 3]), &SensorModel { vignetting: 0.3, ..PLAIN });
        assert!((lit.at(20, 15)[0] - 1.0).abs() < 1e-4);
        // The corner pixel's centre is half a pixel inside the corner.
        assert!((lit.at(0, 0)[1] - 0.7).abs() < 0.02, "{}", lit.at(0, 0)[1]);
    }

    #[test]
    fn a_point_becomes_a_spot_of_the_given_width_that_keeps_its_light() {
        let mut dark = Raster::filled(21, 21, [0.0; 3]);
        *dark.at_mut(10, 10) = [1.0; 3];
        let spot = optics(&dark, &SensorModel { blur_px: 1.2, ..PLAIN });
        let moment = |f: &dyn Fn(f64) -> f64| {
            (0..441).map(|i| f(f64::from(i % 21) - 10.0) * f64::from(spot.data[i as usize][0])).sum::<f64>()
        };
        assert!((moment(&|_| 1.0) - 1.0).abs() < 1e-5);
        assert!((moment(&|x| x * x).sqrt() - 1.2).abs() < 0.03, "{}", moment(&|x| x * x).sqrt());
    }

    #[test]
    fn red_lies_outside_blue_in_the_corners() {
        // A bright ring of radius 22 px about the middle.
        let ring = Raster::from_fn(61, 61, |x, y| {
            let r = (f64::from(x) - 30.0).hypot(f64::from(y) - 30.0);
            [(-0.5 * (r - 22.0).powi(2)).exp() as f32; 3]
        });
        let seen = optics(&ring, &SensorModel { chromatic_aberration_px: 2.0, ..PLAIN });
        let radius = |c: usize| {
            let row = || (31..61u32).map(|x| (f64::from(x) - 30.0, f64::from(seen.at(x, 30)[c])));
            row().map(|(r, light)| r * light).sum::<f64>() / row().map(|(_, light)| light).sum::<f64>()
        };
        // 22 px of the corner's 43 px away: 51 % of the shift.
        assert!((radius(0) - radius(1) - 1.02).abs() < 0.1, "{} {}", radius(0), radius(1));
        assert!((radius(1) - radius(2) - 1.02).abs() < 0.1, "{} {}", radius(1), radius(2));
    }
}

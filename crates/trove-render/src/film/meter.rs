//! What a camera's automatics find in a picture: how bright it is and which light is in it.

use trove_model::{Raster, ToneCurve, luminance};

/// Steps of the metering histogram in a stop, and the stops that it spans around 1.
const STEPS_PER_STOP: f64 = 32.0;
const SPAN_STOPS: f64 = 64.0;

/// The most that a camera exposes by, where the midday sun asks for about 1: a night street stays darker than by day. At 11 a
/// road of 1 cd/m², as lamps light it, is shown a stop and a half below a grey card.
const MOST_EV: f64 = 11.0;

/// Mean brightness of a developed picture, share of white: the means of photographs of cars' cameras are 0.43 ± 0.03
/// (nuScenes), 0.39 ± 0.02 (KITTI) and 0.42 ± 0.08 (CamVid by day), however much sky is in them.
const SHOWN_MEAN: f64 = 0.42;

/// What the brightest hundredth of a developed picture is shown at, at least, however little contrast fog or snow leaves: of
/// 482 photographs of nuScenes, KITTI, CamVid and Cityscapes two have less than 0.80.
const SHOWN_BRIGHTEST: f64 = 0.8;
const BRIGHTEST: f64 = 0.01;

/// Colours that may be grey under the light that is looked for differ from it by so much, stops between two channels.
const GREY_STOPS: f64 = 0.4;
/// Each round looks around the light that the last one found: light by light a sunset is reached.
const ROUNDS: usize = 8;
/// Fewer greys than this share of the pixels tell nothing.
const FEWEST: f64 = 0.05;
/// Share of the light's colour that is taken away, in stops: in nuScenes' photographs sunlit roads stay warm and shaded
/// ones cold.
const CORRECTED: f64 = 0.5;
/// The farthest that red or blue are turned up or down against green, stops.
const MOST_STOPS: f64 = 1.0;

/// The least exposure at which the developed picture's mean brightness is [`SHOWN_MEAN`] and its brightest parts are shown at
/// [`SHOWN_BRIGHTEST`]. White clips, so that a bright sky counts for no more than it covers. 0 for a black picture.
pub(super) fn exposure_ev(radiance: &Raster<[f32; 3]>, curve: ToneCurve) -> f64 {
    let mut histogram = vec![0u64; (SPAN_STOPS * STEPS_PER_STOP) as usize];
    for &rgb in &radiance.data {
        let stops = f64::from(luminance(rgb.into())).log2() + SPAN_STOPS / 2.0;
        let bin = (stops * STEPS_PER_STOP).max(0.0) as usize;
        histogram[bin.min(SPAN_STOPS as usize * STEPS_PER_STOP as usize - 1)] += 1;
    }
    // What is darker than all stops is black.
    histogram[0] = 0;
    if histogram.iter().all(|&count| count == 0) {
        return 0.0;
    }
    let pixels = radiance.data.len() as f64;
    let (mut bright, mut brighter) = (histogram.len() - 1, 0);
    while bright > 0 && ((brighter + histogram[bright]) as f64) < BRIGHTEST * pixels {
        brighter += histogram[bright];
        bright -= 1;
    }
    let is_too_dark = |ev: f64| {
        let shown = |bin: usize| {
            let stops = (bin as f64 + 0.5) / STEPS_PER_STOP - SPAN_STOPS / 2.0 + ev;
            f64::from(curve.shown(stops.exp2() as f32))
        };
        let sum: f64 = (1..histogram.len()).map(|bin| histogram[bin] as f64 * shown(bin)).sum();
        sum < SHOWN_MEAN * pixels || shown(bright) < SHOWN_BRIGHTEST
    };
    // Brightness grows with exposure.
    let (mut low, mut high) = (-SPAN_STOPS / 2.0, MOST_EV);
    while high - low > 1e-10 {
        let middle = (low + high) / 2.0;
        *if is_too_dark(middle) { &mut low } else { &mut high } = middle;
    }
    high
}

/// Gains of red, green and blue that make grey of what is grey in the lower two thirds of a picture, as far as a
/// camera goes; brightness stays as it is.
///
/// Near-greys are averaged, starting from daylight (the grey-world assumption, kept to colours that may be grey, so that
/// a meadow or a red bus does not count).
pub(super) fn white_balance(radiance: &Raster<[f32; 3]>) -> [f32; 3] {
    let lower = &radiance.data[radiance.width as usize * (radiance.height as usize / 3)..];
    // Red and blue against green, stops.
    let stops = |rgb: &[f32; 3]| [0, 2].map(|c| f64::from(rgb[c] / rgb[1]).log2());
    let colours: Vec<[f64; 2]> = lower.iter().map(stops).filter(|s| s.iter().all(|s| s.is_finite())).collect();
    let mut light = [0.0; 2];
    for _ in 0..ROUNDS {
        let (mut sum, mut count) = ([0.0; 2], 0usize);
        for colour in &colours {
            let [red, blue] = [colour[0] - light[0], colour[1] - light[1]];
            // A leaf is less red and less blue than green: light goes from red to blue, hardly ever to green.
            if red.abs() < GREY_STOPS && blue.abs() < GREY_STOPS && (red + blue).abs() < GREY_STOPS {
                sum = [sum[0] + red, sum[1] + blue];
                count += 1;
            }
        }
        if (count as f64) < FEWEST * colours.len() as f64 || count == 0 {
            break;
        }
        light = [light[0] + sum[0] / count as f64, light[1] + sum[1] / count as f64];
    }
    let [red, blue] = light.map(|stops| (-CORRECTED * stops).clamp(-MOST_STOPS, MOST_STOPS).exp2() as f32);
    let gains = [red, 1.0, blue];
    gains.map(|gain| gain / luminance(gains.into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Film;

    fn curve() -> ToneCurve {
        Film::default().tone_curve()
    }

    fn street(light: [f32; 3]) -> Raster<[f32; 3]> {
        Raster::from_fn(60, 30, |x, y| {
            let reflects = match (x % 4, y < 10) {
                (_, true) => [0.3, 0.5, 1.0],
                (0, _) => [0.05, 0.1, 0.03],
                (1, _) => [0.3, 0.3, 0.3],
                _ => [0.1, 0.1, 0.1],
            };
            [0, 1, 2].map(|c| reflects[c] * light[c])
        })
    }

    #[test]
    fn a_street_is_exposed_by_its_mean_and_what_has_no_contrast_by_its_brightest_part() {
        let shown = |picture: &Raster<[f32; 3]>| {
            let gain = exposure_ev(picture, curve()).exp2() as f32;
            let mut shown: Vec<f32> =
                picture.data.iter().map(|&rgb| curve().shown(luminance(rgb.into()) * gain)).collect();
            shown.sort_by(f32::total_cmp);
            (shown.iter().sum::<f32>() / shown.len() as f32, shown[shown.len() * 99 / 100])
        };
        // Steps of the histogram are a thirtieth of a stop.
        let bright_sky = Raster::from_fn(60, 30, |_, y| [if y < 10 { 2.0 } else { 0.1 }; 3]);
        let (mean, brightest) = shown(&bright_sky);
        assert!((f64::from(mean) - SHOWN_MEAN).abs() < 0.01 && f64::from(brightest) > SHOWN_BRIGHTEST);
        for light in [0.001, 1.0, 500.0] {
            let fog = Raster::from_fn(60, 30, |x, y| [light * (0.8 + 0.2 * (x + y) as f32 / 90.0); 3]);
            let (mean, brightest) = shown(&fog);
            assert!(
                (f64::from(brightest) - SHOWN_BRIGHTEST).abs() < 0.01 && f64::from(mean) > SHOWN_MEAN,
                "{mean} {brightest}"
            );
        }
    }

    #[test]
    fn a_night_in_which_hardly_anything_shines_is_exposed_by_the_most_that_a_camera_does() {
        let lamp = Raster::from_fn(60, 30, |x, y| [if (x, y) == (7, 3) { 1.0 } else { 0.0 }; 3]);
        assert!((exposure_ev(&lamp, curve()) - MOST_EV).abs() < 1e-6, "{}", exposure_ev(&lamp, curve()));
    }

    #[test]
    fn daylight_is_left_alone_whatever_the_sky_and_the_leaves_are_like() {
        for gain in white_balance(&street([1.0; 3])) {
            assert!((gain - 1.0).abs() < 0.01, "{gain}");
        }
    }

    #[test]
    fn half_of_an_evenings_warmth_is_taken_away() {
        // A third of a stop to red and from blue; farther off nothing looks grey to begin with.
        let light = [1.26, 1.0, 0.794];
        let gains = white_balance(&street(light));
        let [r, g, b] = [0, 1, 2].map(|c| gains[c] * light[c]);
        assert!(((r / g).log2() - 1.0 / 6.0).abs() < 0.02, "{}", r / g);
        assert!(((b / g).log2() + 1.0 / 6.0).abs() < 0.02, "{}", b / g);
        assert!((luminance(gains.into()) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_picture_without_greys_or_light_is_left_alone() {
        assert_eq!(white_balance(&Raster::filled(8, 8, [0.02, 0.3, 0.02])), [1.0; 3]);
        assert_eq!(white_balance(&Raster::filled(8, 8, [0.0; 3])), [1.0; 3]);
        assert_eq!(white_balance(&Raster::filled(0, 0, [0.0; 3])), [1.0; 3]);
    }
}

//! From radiance to a picture: exposure and tone.
//!
//! The metering and the curve are those of a car's camera: it exposes for the road rather than for the sky, lets the
//! brightest things run softly into white, and colours fade on the way there.

use trove_model::{ExposureRule, Raster};

/// Steps of the metering histogram in a stop, and the stops that it spans around 1.
const STEPS_PER_STOP: f64 = 32.0;
const SPAN_STOPS: f64 = 24.0;

/// The metered mean of the lower part of a picture becomes this radiance: what the same measurement gives on
/// photographs of sunny streets with little shade; the sunlit road then comes out at 105 to 130 of 255.
const METERED_TO: f64 = 0.16;

/// Shares of the metered pixels that are left out at the dark and at the bright end.
const TRIM: [f64; 2] = [0.05, 0.05];

/// Exposed radiance of a grey card, and the encoded grey that it becomes (118 of 255).
const GREY: [f32; 2] = [0.18, 0.463];

/// Steepness of the tone curve; the bare sRGB encoding has 0.81 at middle grey.
const CONTRAST: f32 = 0.85;

/// Exposed radiance that just becomes white: four stops above the grey card.
const WHITE: f32 = 3.0;

/// Share of brightness that is mixed into every channel: a camera's colour filters overlap.
const FADE: f32 = 0.1;

/// Exposes and tone-maps; also returns the exposure that was used, in stops.
pub(crate) fn develop(radiance: &Raster<[f32; 3]>, rule: &ExposureRule) -> (Raster<[u8; 3]>, f64) {
    let ev = match *rule {
        ExposureRule::Fixed { ev } => ev,
        ExposureRule::Auto { compensation_ev } => metered_ev(radiance) + compensation_ev,
    };
    let gain = ev.exp2() as f32;
    let picture = radiance.map(|&rgb| {
        let rgb = rgb.map(|c| if c.is_finite() { (c * gain).max(0.0) } else { 0.0 });
        let faded = FADE * luminance(rgb);
        rgb.map(|c| (response((1.0 - FADE) * c + faded) * 255.0 + 0.5) as u8)
    });
    (picture, ev)
}

/// Encoded brightness of an exposed radiance, 1 at [`WHITE`]: nearly a straight line in stops around middle grey that
/// bends to 0 and to 1 (Naka and Rushton's response, with a constant that leaves grey and white where they belong).
fn response(exposed: f32) -> f32 {
    let [grey, encoded] = GREY;
    let (power, white) = ((exposed / grey).powf(CONTRAST), (WHITE / grey).powf(CONTRAST));
    let half = (1.0 - encoded) / (encoded - 1.0 / white);
    power * (1.0 + half / white) / (power + half)
}

/// The exposure that brings the lower two thirds of a picture, where the sky is not, to middle brightness: the mean in
/// stops, pixels counting twice as much in the middle as at the sides, without the darkest and the brightest twentieth.
/// 0 for a black picture.
fn metered_ev(radiance: &Raster<[f32; 3]>) -> f64 {
    let (width, height) = (radiance.width as usize, radiance.height as usize);
    let mut histogram = vec![0u64; (SPAN_STOPS * STEPS_PER_STOP) as usize];
    for y in height / 3..height {
        for x in 0..width {
            let stops = f64::from(luminance(radiance.data[y * width + x])).log2() + SPAN_STOPS / 2.0;
            if stops.is_finite() {
                let bin = ((stops * STEPS_PER_STOP).max(0.0) as usize).min(histogram.len() - 1);
                let from_middle = (2 * x + 1).abs_diff(width);
                histogram[bin] += (2 * width - from_middle) as u64;
            }
        }
    }
    // Whole numbers, so that the sum does not depend on an order.
    let total: u64 = histogram.iter().sum();
    let (low, high) = ((total as f64 * TRIM[0]) as u64, total - (total as f64 * TRIM[1]) as u64);
    let (mut before, mut kept, mut weighted) = (0u64, 0u64, 0u64);
    for (bin, &count) in histogram.iter().enumerate() {
        let inside = (before + count).min(high).saturating_sub(before.max(low));
        kept += inside;
        weighted += inside * (2 * bin as u64 + 1);
        before += count;
    }
    if kept == 0 {
        return 0.0;
    }
    let mean_stops = weighted as f64 / kept as f64 / (2.0 * STEPS_PER_STOP) - SPAN_STOPS / 2.0;
    METERED_TO.log2() - mean_stops
}

fn luminance(rgb: [f32; 3]) -> f32 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    const AUTO: ExposureRule = ExposureRule::Auto { compensation_ev: 0.0 };

    fn grey(value: f32) -> Raster<[f32; 3]> {
        Raster::filled(60, 30, [value; 3])
    }

    #[test]
    fn a_grey_card_becomes_middle_grey_and_white_is_white() {
        let shown = |value: f32| develop(&grey(value), &ExposureRule::Fixed { ev: 0.0 }).0.data[0];
        assert_eq!(shown(0.0), [0; 3]);
        assert!(shown(0.18)[0].abs_diff(118) < 2, "{:?}", shown(0.18));
        assert_eq!(shown(WHITE), [255; 3]);
        assert_eq!(shown(f32::NAN), [0; 3]);
        let shades: Vec<u8> = (0..40).map(|i| shown((i as f32 * 0.3 - 9.0).exp2())[0]).collect();
        assert!(shades.is_sorted(), "{shades:?}");
    }

    #[test]
    fn a_picture_twice_as_bright_is_developed_alike() {
        let ((a, a_ev), (b, b_ev)) = (develop(&grey(0.02), &AUTO), develop(&grey(0.04), &AUTO));
        assert_eq!(a, b);
        assert!((a_ev - b_ev - 1.0).abs() < 1e-9, "{a_ev} {b_ev}");
    }

    #[test]
    fn neither_the_sky_nor_a_lamp_darkens_the_road() {
        let mut street = Raster::filled(60, 30, [0.1; 3]);
        let (_, plain_ev) = develop(&street, &AUTO);
        street.data[..60 * 10].fill([40.0; 3]);
        street.data[60 * 20..60 * 20 + 30].fill([1e4; 3]);
        let (_, ev) = develop(&street, &AUTO);
        assert!((ev - plain_ev).abs() < 0.05, "{ev} {plain_ev}");
    }

    #[test]
    fn bright_colours_fade_towards_white() {
        let mixed = |gain: f32| {
            let red = Raster::filled(1, 1, [0.4 * gain, 0.05 * gain, 0.02 * gain]);
            let [r, _, b] = develop(&red, &ExposureRule::Fixed { ev: 0.0 }).0.data[0];
            f32::from(b) / f32::from(r)
        };
        assert!(mixed(16.0) > 2.0 * mixed(1.0), "{} {}", mixed(16.0), mixed(1.0));
    }

    #[test]
    fn a_black_or_empty_picture_is_developed_too() {
        assert_eq!(develop(&grey(0.0), &AUTO).1, 0.0);
        assert_eq!(develop(&Raster::filled(0, 0, [0.0; 3]), &AUTO).0.data.len(), 0);
    }
}

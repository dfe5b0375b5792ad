//! The camera's response: from exposed light to encoded brightness.
//!
//! Colours of photographs are paler than the things that they show.

/// Exposed radiance of a grey card, and that which just becomes white, three stops above.
const GREY: f32 = 0.18;
pub(super) const WHITE: f32 = 1.5;

/// Share of brightness that is mixed into every channel: a camera's colour filters overlap.
const FADE: f32 = 0.15;

/// 8-bit sRGB of an exposed colour.
pub(super) fn srgb(exposed: [f32; 3], contrast: f32) -> [u8; 3] {
    let faded = FADE * luminance(exposed);
    exposed.map(|c| (shown((1.0 - FADE) * c + faded, contrast) * 255.0 + 0.5) as u8)
}

/// Encoded brightness of an exposed one, 0 to 1 for white.
pub(super) fn shown(exposed: f32, contrast: f32) -> f32 {
    encoded(steepened(held_back(exposed).min(1.0), contrast))
}

/// A sigmoid that leaves black, a grey card and white where they are: odds to a power.
fn steepened(shown: f32, contrast: f32) -> f32 {
    let odds = |share: f32| share / (1.0 - share);
    let grey = odds(held_back(GREY));
    let steep = grey * (odds(shown) / grey).powf(contrast);
    if steep.is_finite() { steep / (1.0 + steep) } else { 1.0 }
}

/// Bright light brought below 1, which it reaches at [`WHITE`]; the dark stays as it is (Reinhard et al. 2002, eq. 4).
fn held_back(exposed: f32) -> f32 {
    exposed * (1.0 + exposed / (WHITE * WHITE)) / (1.0 + exposed)
}

/// sRGB's encoding (IEC 61966-2-1).
fn encoded(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Brightness of a colour (Rec. 709).
pub(super) fn luminance(rgb: [f32; 3]) -> f32 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Film;

    const CONTRAST: f32 = Film::CONTRAST as f32;

    #[test]
    fn a_grey_card_becomes_middle_grey_and_white_is_white() {
        for contrast in [0.6, CONTRAST, 3.0] {
            let shown = |value: f32| srgb([value; 3], contrast)[0];
            assert_eq!(shown(0.0), 0);
            assert!(shown(GREY).abs_diff(113) < 3, "{}", shown(GREY));
            assert_eq!((shown(WHITE), shown(f32::MAX)), (255, 255));
            let shades: Vec<u8> = (0..40).map(|i| shown((i as f32 * 0.3 - 9.0).exp2())).collect();
            assert!(shades.is_sorted(), "{shades:?}");
        }
    }

    #[test]
    fn contrast_is_the_slope_of_brightness_around_a_grey_card() {
        // Of the light that is held back, without the encoding for display.
        let odds = |exposed: f32, contrast| {
            let shown = steepened(held_back(exposed), contrast);
            (shown / (1.0 - shown)).ln()
        };
        for contrast in [0.6, 1.0, CONTRAST] {
            let [slope, plain] = [contrast, 1.0].map(|c| odds(2.0 * GREY, c) - odds(0.5 * GREY, c));
            assert!((slope / plain - contrast).abs() < 1e-3, "{slope} {plain}");
        }
        // By default steeper than sRGB's encoding of the light that is held back.
        let stop = |side: f32| f32::from(srgb([GREY * side; 3], CONTRAST)[0]);
        assert!(stop(2.0) / stop(0.5) > 2.1, "{}", stop(2.0) / stop(0.5));
    }

    #[test]
    fn bright_colours_fade_towards_white() {
        let mixed = |gain: f32| {
            let [r, _, b] = srgb([0.4 * gain, 0.05 * gain, 0.02 * gain], CONTRAST);
            f32::from(b) / f32::from(r)
        };
        assert!(mixed(16.0) > 1.5 * mixed(1.0), "{} {}", mixed(16.0), mixed(1.0));
    }
}

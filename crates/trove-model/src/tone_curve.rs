//! A camera's response: from exposed light to encoded brightness, and back.

use crate::Film;
use crate::srgb::{decoded, encoded};

/// From exposed light, in which a grey card is [`ToneCurve::GREY`], to 8-bit sRGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneCurve {
    contrast: f32,
}

/// Share of brightness that is mixed into every channel: a camera's colour filters overlap, so that colours of photographs
/// are paler than the things that they show.
const FADE: f32 = 0.15;

impl ToneCurve {
    /// Exposed radiance of a grey card.
    pub const GREY: f32 = 0.18;
    /// Exposed radiance that just becomes white, three stops above.
    pub const WHITE: f32 = 1.5;

    /// That of a contrast, more than 0 (see [`Film::contrast`]).
    pub fn new(contrast: f64) -> Self {
        Self { contrast: contrast as f32 }
    }

    /// 8-bit sRGB of an exposed colour.
    pub fn srgb(&self, exposed: [f32; 3]) -> [u8; 3] {
        let faded = FADE * luminance(exposed);
        exposed.map(|c| (self.shown((1.0 - FADE) * c + faded) * 255.0 + 0.5) as u8)
    }

    /// The exposed colour of 8-bit sRGB; of what is white, and of what no mixture shows, the nearest.
    pub fn exposed_rgb(&self, srgb: [u8; 3]) -> [f32; 3] {
        let mixed = srgb.map(|c| self.exposed(f32::from(c) / 255.0));
        let faded = FADE * luminance(mixed);
        mixed.map(|c| ((c - faded) / (1.0 - FADE)).max(0.0))
    }

    /// Encoded brightness of an exposed one, 0 to 1 for white.
    pub fn shown(&self, exposed: f32) -> f32 {
        encoded(self.steepened(held_back(exposed).min(1.0)))
    }

    /// The exposed brightness of an encoded one, 0 to [`Self::WHITE`].
    pub fn exposed(&self, shown: f32) -> f32 {
        let flat = Self { contrast: 1.0 / self.contrast }.steepened(decoded(shown.clamp(0.0, 1.0)));
        let (white, dark) = (Self::WHITE * Self::WHITE, 1.0 - flat);
        // The positive root of what holds light back, without cancellation.
        2.0 * flat / (dark + (dark * dark + 4.0 * flat / white).sqrt())
    }

    /// A sigmoid that leaves black, a grey card and white where they are: odds to a power.
    fn steepened(&self, shown: f32) -> f32 {
        let odds = |share: f32| share / (1.0 - share);
        let grey = odds(held_back(Self::GREY));
        let steep = grey * (odds(shown) / grey).powf(self.contrast);
        if steep.is_finite() { steep / (1.0 + steep) } else { 1.0 }
    }
}

impl Film {
    /// Its response.
    pub fn tone_curve(&self) -> ToneCurve {
        ToneCurve::new(self.contrast)
    }
}

/// Bright light brought below 1, which it reaches at white; the dark stays as it is (Reinhard et al. 2002, eq. 4).
fn held_back(exposed: f32) -> f32 {
    exposed * (1.0 + exposed / (ToneCurve::WHITE * ToneCurve::WHITE)) / (1.0 + exposed)
}

/// Brightness of a colour (Rec. 709).
fn luminance(rgb: [f32; 3]) -> f32 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    const GREY: f32 = ToneCurve::GREY;

    fn grey(value: f32, contrast: f64) -> u8 {
        ToneCurve::new(contrast).srgb([value; 3])[0]
    }

    #[test]
    fn a_grey_card_becomes_middle_grey_and_white_is_white() {
        for contrast in [0.6, Film::CONTRAST, 3.0] {
            let shown = |value: f32| grey(value, contrast);
            assert_eq!(shown(0.0), 0);
            assert!(shown(GREY).abs_diff(113) < 3, "{}", shown(GREY));
            assert_eq!((shown(ToneCurve::WHITE), shown(f32::MAX)), (255, 255));
            let shades: Vec<u8> = (0..40).map(|i| shown((i as f32 * 0.3 - 9.0).exp2())).collect();
            assert!(shades.is_sorted(), "{shades:?}");
        }
    }

    #[test]
    fn contrast_is_the_slope_of_brightness_around_a_grey_card() {
        // Of the light that is held back, without the encoding for display.
        let odds = |exposed: f32, contrast| {
            let shown = ToneCurve::new(contrast).steepened(held_back(exposed));
            f64::from(shown / (1.0 - shown)).ln()
        };
        for contrast in [0.6, 1.0, Film::CONTRAST] {
            let [slope, plain] = [contrast, 1.0].map(|c| odds(2.0 * GREY, c) - odds(0.5 * GREY, c));
            assert!((slope / plain - contrast).abs() < 1e-3, "{slope} {plain}");
        }
        // By default steeper than sRGB's encoding of the light that is held back.
        let stop = |side: f32| f32::from(grey(GREY * side, Film::CONTRAST));
        assert!(stop(2.0) / stop(0.5) > 2.1, "{}", stop(2.0) / stop(0.5));
    }

    #[test]
    fn bright_colours_fade_towards_white() {
        let mixed = |gain: f32| {
            let [r, _, b] = ToneCurve::new(Film::CONTRAST).srgb([0.4 * gain, 0.05 * gain, 0.02 * gain]);
            f32::from(b) / f32::from(r)
        };
        assert!(mixed(16.0) > 1.5 * mixed(1.0), "{} {}", mixed(16.0), mixed(1.0));
    }

    #[test]
    fn a_picture_tells_the_light_that_it_was_exposed_to() {
        for contrast in [0.6, 1.0, Film::CONTRAST, 3.0] {
            let curve = ToneCurve::new(contrast);
            for exposed in [0.05, GREY, 0.4, 1.0] {
                let found = curve.exposed(curve.shown(exposed));
                assert!((found / exposed - 1.0).abs() < 1e-3, "{exposed} {found}");
            }
            let colour = [0.3, 0.12, 0.2];
            let found = curve.exposed_rgb(curve.srgb(colour));
            // Codes are steps of a 255th.
            assert!((0..3).all(|c| (found[c] / colour[c] - 1.0).abs() < 0.05), "{found:?}");
            let ends = [0, 255].map(|code| curve.exposed_rgb([code; 3])[1]);
            assert!(ends[0] == 0.0 && (ends[1] - ToneCurve::WHITE).abs() < 1e-4, "{ends:?}");
            assert_eq!(curve.exposed_rgb([255, 0, 0])[1..], [0.0; 2]);
        }
    }
}

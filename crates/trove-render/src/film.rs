//! From radiance to a picture: exposure and tone.

use trove_model::{ExposureRule, Raster};

/// Exposes and tone-maps; also returns the exposure that was used, in stops.
pub(crate) fn develop(radiance: &Raster<[f32; 3]>, rule: &ExposureRule) -> (Raster<[u8; 3]>, f64) {
    let ev = match *rule {
        ExposureRule::Fixed { ev } => ev,
        ExposureRule::Auto { compensation_ev } => compensation_ev,
    };
    let gain = ev.exp2() as f32;
    let picture = radiance.map(|rgb| rgb.map(|c| ((c * gain).clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0 + 0.5) as u8));
    (picture, ev)
}

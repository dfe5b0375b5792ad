//! Fog of a scene.

use trove_model::Light;
use trove_trace::Fog;

/// Height of clouds that rain and snow fall from, metres: so far above the ground there is 1/e of what it takes from light.
const CLOUDS_M: f64 = 1000.0;

/// Fog and what falls together, which thin out over a height between theirs; `None` in clear air.
pub(crate) fn fog(light: &Light, lowest_z: f32) -> Option<Fog> {
    let lowest_z_m = f64::from(lowest_z);
    let ground_z_m = light.fog.map_or(if lowest_z > f32::MIN { lowest_z_m } else { 0.0 }, |fog| fog.ground_z_m);
    let fog = light.fog.map(|fog| (fog.extinction_per_m(), fog.height_m));
    let falling = light.falling.map(|falling| (falling.extinction_per_m(), CLOUDS_M));
    let both = || fog.into_iter().chain(falling);
    let extinction_per_m: f64 = both().map(|(extinction, _)| extinction).sum();
    let depth: f64 = both().map(|(extinction, height_m)| extinction * height_m).sum();
    (extinction_per_m > 0.0).then(|| Fog {
        extinction_per_m: extinction_per_m as f32,
        height_m: (depth / extinction_per_m) as f32,
        ground_z: ground_z_m as f32,
        lowest_z,
    })
}

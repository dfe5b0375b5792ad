//! What fog, rain and snow themselves send back of a beam.

use std::f64::consts::PI;

use trove_model::{Class, InstanceId, Precipitation, Random, Scanner, SensorRay};

use super::echo::{Echo, Part};
use crate::fog::Fog;
use crate::sampling::poisson;

/// Extinction for backscatter of water droplets at 905 nm, steradians (O'Connor, Illingworth, Hogan 2004: 18.8).
const LIDAR_RATIO_SR: f64 = 18.8;

/// The echo of the droplets in one length of a pulse, before what the beam's middle meets. Where along the beam they send back
/// enough at once to be told is chance, by the squares with which their light fades.
pub(super) fn echo(
    fog: &Fog,
    falling: Option<Precipitation>,
    scanner: &Scanner,
    middle: &SensorRay,
    met: &[Part],
    mut random: Random,
) -> Option<Echo> {
    let free_m = met.iter().filter(|part| part.is_middle).map(|part| part.range_m).fold(f64::INFINITY, f64::min);
    let (near_m, far_m) = (scanner.nearest_m.max(scanner.pulse_m), scanner.farthest_m.min(free_m));
    if far_m <= near_m {
        return None;
    }
    let range_m = 1.0 / (1.0 / near_m + random.unit() * (1.0 / far_m - 1.0 / near_m));
    let (origin, direction) = (middle.origin.as_vec3(), middle.direction.as_vec3());
    let clear = f64::from(fog.transmittance(origin, direction, range_m as f32));
    let thick = f64::from(fog.extinction_per_m(origin.z + direction.z * range_m as f32));
    // A white matt surface sends back 1/π a steradian.
    let power = PI * thick * scanner.pulse_m / LIDAR_RATIO_SR * clear * clear;
    // Drops and flakes are so few that a beam meets several or none.
    let power = power
        * falling.map_or(1.0, |falling| {
            let share = (falling.extinction_per_m() / thick).min(1.0);
            let mean =
                falling.pieces_per_m3(0.0) * PI * (range_m * scanner.divergence_rad / 2.0).powi(2) * scanner.pulse_m;
            1.0 - share + share * poisson(mean, &mut random) / mean
        });
    Some(Echo { range_m, power: power as f32, class: Class::Void, instance: InstanceId(0) })
}

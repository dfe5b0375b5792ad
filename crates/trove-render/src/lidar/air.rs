//! What fog, rain, snow and spray themselves send back of a beam.

use std::f64::consts::PI;

use trove_model::{Class, InstanceId, Scanner, Seed, SensorRay};

use super::echo::{Echo, Part};
use crate::PreparedScene;
use crate::poisson::poisson;

/// Extinction for backscatter of water droplets at 905 nm, steradians (O'Connor, Illingworth, Hogan 2004: 18.8).
const LIDAR_RATIO_SR: f64 = 18.8;

/// The echo of fog and of what falls in one length of a pulse, before what the beam's middle meets. Where along the beam they
/// send back enough at once to be told is chance, by the squares with which their light fades.
pub(super) fn of_fog(
    scene: &PreparedScene,
    scanner: &Scanner,
    middle: &SensorRay,
    met: &[Part],
    seed: Seed,
) -> Option<Echo> {
    let fog = scene.fog?;
    let mut random = seed.child("fog").random();
    let [near_m, far_m] = free_m(scanner, met)?;
    let range_m = 1.0 / (1.0 / near_m + random.unit() * (1.0 / far_m - 1.0 / near_m));
    let height_m = middle.origin.z + middle.direction.z * range_m;
    let thick = f64::from(fog.extinction_per_m(height_m as f32));
    let echo = echo(scene, scanner, middle, thick, range_m);
    // Drops and flakes are so few that a beam meets several or none.
    let met = scene.falling.map_or(1.0, |falling| {
        let share = (falling.extinction_per_m() / thick).min(1.0);
        let mean = falling.pieces_per_m3(0.0) * PI * (range_m * scanner.divergence_rad / 2.0).powi(2) * scanner.pulse_m;
        1.0 - share + share * poisson(mean, &mut random) / mean
    });
    Some(Echo { power: echo.power * met as f32, ..echo })
}

/// The same of spray: by how thick it is along the beam.
pub(super) fn of_spray(
    scene: &PreparedScene,
    scanner: &Scanner,
    middle: &SensorRay,
    met: &[Part],
    seed: Seed,
) -> Option<Echo> {
    let spray = scene.spray.view();
    if spray.plumes.is_empty() {
        return None;
    }
    let [near_m, far_m] = free_m(scanner, met)?;
    let (origin, direction) = (middle.origin.as_vec3(), middle.direction.as_vec3());
    let lost = 1.0 - spray.transmittance(origin, direction, far_m as f32);
    let range_m = spray.met(origin, direction, far_m as f32, lost * seed.child("spray").random().unit() as f32)?;
    let thick = spray.extinction_at(origin + direction * range_m);
    (f64::from(range_m) > near_m).then(|| echo(scene, scanner, middle, f64::from(thick), f64::from(range_m)))
}

/// Between which ranges a beam's middle meets nothing but air; `None` where that is nowhere.
fn free_m(scanner: &Scanner, met: &[Part]) -> Option<[f64; 2]> {
    let free_m = met.iter().filter(|part| part.is_middle).map(|part| part.range_m).fold(f64::INFINITY, f64::min);
    let (near_m, far_m) = (scanner.nearest_m.max(scanner.pulse_m), scanner.farthest_m.min(free_m));
    (near_m < far_m).then_some([near_m, far_m])
}

/// Of droplets of which a metre takes so much of the light.
fn echo(scene: &PreparedScene, scanner: &Scanner, middle: &SensorRay, thick: f64, range_m: f64) -> Echo {
    let seen = f64::from(scene.seen(middle.origin.as_vec3(), middle.direction.as_vec3(), range_m as f32));
    // A white matt surface sends back 1/π a steradian.
    let power = PI * thick * scanner.pulse_m / LIDAR_RATIO_SR * seen * seen;
    Echo { range_m, power: power as f32, class: Class::Void, instance: InstanceId(0) }
}

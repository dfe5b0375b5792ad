//! What of a beam's echoes a LiDAR tells.

use trove_model::{Class, InstanceId, Random, Scanner, ToldReturns};

use super::echo::Echo;
use super::reflectance::MOST;

/// Reflectance of the target by which a scanner's reach is told.
const TARGET: f64 = 0.1;
/// Standard deviation of the detector's threshold, as a share of it.
const THRESHOLD_NOISE: f64 = 0.2;

/// A return that is told.
pub(super) struct Told {
    pub(super) range_m: f64,
    pub(super) intensity: u8,
    pub(super) class: Class,
    pub(super) instance: InstanceId,
}

/// The returns that are told of a beam, the strongest first.
pub(super) fn told(scanner: &Scanner, echoes: Vec<Echo>, mut random: Random) -> Vec<Told> {
    let mut found: Vec<(f64, Told)> = Vec::new();
    for Echo { range_m, power, class, instance } in echoes {
        // Both are drawn for every echo, so that one that is missed changes nothing else.
        let (threshold, error) = (1.0 + THRESHOLD_NOISE * random.normal(), random.normal());
        let signal = f64::from(power) / TARGET * (scanner.reach_m / range_m.max(scanner.nearest_m)).powi(2);
        let range_m = range_m + scanner.noise_m * error;
        if signal > threshold.max(0.0) && (scanner.nearest_m..=scanner.farthest_m).contains(&range_m) {
            let intensity = intensity(power, scanner.intensity_exponent);
            found.push((signal, Told { range_m, intensity, class, instance }));
        }
    }
    let strongest_first = |found: &mut Vec<(f64, Told)>| found.sort_by(|a, b| b.0.total_cmp(&a.0));
    match scanner.told {
        ToldReturns::Strongest => {
            strongest_first(&mut found);
            found.truncate(1);
        }
        ToldReturns::Last => drop(found.drain(..found.len().saturating_sub(1))),
        ToldReturns::Dual => {
            let last_m = found.last().map_or(0.0, |(_, last)| last.range_m);
            strongest_first(&mut found);
            // Where the strongest is the last one too, the second strongest stays second.
            if let Some(last) = found.iter().position(|(_, told)| told.range_m == last_m).filter(|i| *i > 0) {
                found.swap(1, last);
            }
            found.truncate(2);
        }
    }
    found.into_iter().map(|(_, told)| told).collect()
}

/// 0 to 100 for matt surfaces, by their reflectance; 101 to 255 for what is brighter, by its logarithm; raised by the exponent.
fn intensity(power: f32, exponent: f64) -> u8 {
    let value = if power <= 1.0 { 100.0 * power } else { 100.0 + 155.0 * power.ln() / MOST.ln() };
    (255.0 * (f64::from(value) / 255.0).max(0.0).powf(exponent)).round().min(255.0) as u8
}

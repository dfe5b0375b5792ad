//! What of a scan's cells a radar tells.

use glam::DVec3;
use trove_model::{Class, InstanceId, RadarDetection, RadarScan, RadarShot, Random, Seed};

use super::cells::{Cells, Key, around, sides};
use super::echo::{Echo, TARGET_M2};

/// A peak has to be so many times what is received beside it, on average.
const ABOVE_BESIDE: f64 = 3.0;
/// Cells of range beside a peak that are part of it, and those farther out that it is compared with, on either side.
const GUARD: i32 = 3;
const COMPARED: i32 = 10;
/// The receiver's own noise, of what is found in half of the looks.
const NOISE: f64 = 0.05;
/// Names of the streams of random numbers.
const FADING: &str = "fading";
const FALSE_ALARMS: &str = "false alarms";

/// What a scan finds.
pub(super) fn detections(shot: &RadarShot, scan: &RadarScan, echoes: Vec<Echo>, seed: Seed) -> Vec<RadarDetection> {
    let cells = Cells::new(scan, &echoes, seed.child(FADING));
    let mut found = Vec::new();
    for (key, cell) in &cells.cells {
        let received = cells.at(*key);
        // Of two that are equal the first is the peak.
        let is_peak = around(*key).all(|beside| match beside.cmp(key) {
            std::cmp::Ordering::Less => cells.at(beside) < received,
            std::cmp::Ordering::Equal => true,
            std::cmp::Ordering::Greater => cells.at(beside) <= received,
        });
        let mut random = key.iter().fold(seed, |seed, i| seed.nth(*i as u32 as u64)).random();
        let noise = -NOISE * (1.0 - random.unit()).ln();
        if is_peak && received + noise > (ABOVE_BESIDE * beside(&cells, *key)).max(1.0) {
            let mut measured = Measured::of(&cells, *key);
            measured.signal = received + noise;
            found.extend(measured.told(shot, scan, (cell.class, cell.instance, cell.surfaces), &mut random));
        }
    }
    found.extend(false_alarms(shot, scan, seed.child(FALSE_ALARMS).random()));
    found
}

/// What is received at other ranges of the same azimuth and speed, on average.
fn beside(cells: &Cells, [range, azimuth, speed]: Key) -> f64 {
    let compared = (GUARD + 1..=GUARD + COMPARED).flat_map(|away| [range - away, range + away]);
    compared.map(|range| cells.at([range, azimuth, speed])).sum::<f64>() / f64::from(2 * COMPARED)
}

/// What a scan measures of a peak.
struct Measured {
    range_m: f64,
    sine: f64,
    radial_mps: f64,
    signal: f64,
}

impl Measured {
    /// The middle of what is about a peak.
    fn of(cells: &Cells, key: Key) -> Self {
        let (mut sum, mut weighted) = (0.0, [0.0; 3]);
        for cell in around(key).filter_map(|key| cells.cells.get(&key)) {
            sum += cell.signal;
            weighted.iter_mut().zip(cell.at).for_each(|(all, x)| *all += x * cell.signal);
        }
        let [range_m, sine, radial_mps] = weighted.map(|all| all / sum);
        Self { range_m, sine, radial_mps, signal: 0.0 }
    }

    /// As it is told, with the sensor's errors; `None` for what is outside of what it tells.
    fn told(
        &self,
        shot: &RadarShot,
        scan: &RadarScan,
        (class, instance, surfaces): (Class, InstanceId, u8),
        random: &mut Random,
    ) -> Option<RadarDetection> {
        let radar = &shot.radar;
        let azimuth_rad = self.sine.clamp(-1.0, 1.0).asin();
        let direction = scan.at(azimuth_rad)?;
        let rcs_m2 = self.signal * TARGET_M2 * (self.range_m / direction.reach_m).powi(4);
        let range_m = self.range_m + scan.range_error_m * random.normal();
        let azimuth_rad = azimuth_rad + direction.error_rad * random.normal();
        let radial_mps = self.radial_mps + scan.speed_error_mps * random.normal();
        scan.at(azimuth_rad)?;
        let is_told = (scan.nearest_m..=scan.farthest_m).contains(&range_m)
            && (-radar.approach_mps..=radar.departure_mps).contains(&radial_mps);
        let (left, ahead) = azimuth_rad.sin_cos();
        let own = shot.world_from_radar.inverse().vector(shot.velocity_mps);
        let rcs_dbsm = 10.0 * rcs_m2.log10();
        (is_told && rcs_dbsm >= radar.faintest_dbsm).then(|| RadarDetection {
            range_m,
            azimuth_rad,
            radial_mps,
            ground_mps: radial_mps + own.dot(DVec3::new(ahead, left, 0.0)),
            rcs_dbsm,
            range_error_m: scan.range_error_m,
            azimuth_error_rad: direction.error_rad,
            speed_error_mps: scan.speed_error_mps,
            class,
            instance,
            surfaces,
        })
    }
}

/// Peaks of noise: anywhere, as strong as it takes to be told.
fn false_alarms(shot: &RadarShot, scan: &RadarScan, mut random: Random) -> Vec<RadarDetection> {
    let radar = &shot.radar;
    // Poisson's numbers (Knuth).
    let (limit, mut product, mut count) = ((-radar.false_alarms / radar.scans.len() as f64).exp(), random.unit(), 0);
    while product > limit {
        product *= random.unit();
        count += 1;
    }
    let edge = scan.half_width_rad().sin();
    let own = shot.velocity_mps.length();
    let mut found = Vec::new();
    for _ in 0..count {
        let (sine, signal) = (random.range(-edge, edge), 1.0 - NOISE * (1.0 - random.unit()).ln());
        let Some(direction) = scan.at(sine.asin()) else { continue };
        // Nearer, so much power is of a cross-section that is too faint to be told.
        let faintest_m2 = 10_f64.powf(radar.faintest_dbsm / 10.0);
        let least_m = direction.reach_m * (faintest_m2 / (TARGET_M2 * signal)).powf(0.25);
        let range_m = random.range(scan.nearest_m.max(least_m).min(scan.farthest_m), scan.farthest_m);
        let measured = Measured { range_m, sine, radial_mps: random.range(-own - 20.0, own + 20.0), signal };
        found.extend(measured.told(shot, scan, (Class::Void, InstanceId(0), 0), &mut random));
    }
    found
}

/// What a cycle tells of all its scans, the nearest first: what one scan finds within another's cell is told once, by the
/// finer.
pub(super) fn told(shot: &RadarShot, scans: Vec<Vec<RadarDetection>>) -> Vec<RadarDetection> {
    let cells: Vec<[f64; 3]> = shot.radar.scans.iter().map(|scan| sides(scan).map(|side| 2.0 * side)).collect();
    let mut order: Vec<usize> = (0..scans.len()).collect();
    order.sort_by(|a, b| cells[*a][0].total_cmp(&cells[*b][0]));
    let mut all: Vec<RadarDetection> = Vec::new();
    for scan in order {
        let [range_m, sine, speed_mps] = cells[scan];
        let is_same = |a: &RadarDetection, b: &RadarDetection| {
            (a.range_m - b.range_m).abs() < range_m
                && (a.azimuth_rad.sin() - b.azimuth_rad.sin()).abs() < sine
                && (a.radial_mps - b.radial_mps).abs() < speed_mps
        };
        let finer = all.len();
        let new = scans[scan].iter().filter(|new| !all[..finer].iter().any(|known| is_same(known, new)));
        let new: Vec<RadarDetection> = new.copied().collect();
        all.extend(new);
    }
    all.sort_by(|a, b| a.range_m.total_cmp(&b.range_m));
    all.truncate(shot.radar.most);
    all
}

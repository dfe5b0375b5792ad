//! Which fixes of a trace can be.

use glam::DVec2;
use trove_model::{MapProjection, Outcome, Report};

use super::fix::Fix;

/// Nobody drives faster, m/s.
const FASTEST_MPS: f64 = 100.0;
/// What a receiver may be off from one fix to the next however short the time, metres.
const JITTER_M: f64 = 15.0;
/// Traces that fixes may belong to, of which the longest is the true one.
const MOST_RUNS: usize = 16;
/// Nearer to the poles x and y are no map, degrees.
const HIGHEST_LAT_DEG: f64 = 89.0;

/// The fixes in the order of time that one vehicle can have been at; what is dropped is reported.
pub(super) fn possible(fixes: &[Fix], report: &Report) -> Vec<Fix> {
    let dropped = |what: &str, i: usize| report.note(Outcome::Dropped, &format!("GPS: {what}"), format!("fix {i}"));
    let mut runs = Vec::<Vec<(usize, Fix)>>::new();
    let mut latest_ns = None;
    for (i, &fix) in fixes.iter().enumerate() {
        let is_place = fix.lat_deg.abs() < HIGHEST_LAT_DEG && fix.lon_deg.abs() <= 180.0;
        // Receivers write 0, 0 where they know nothing.
        if !is_place || (fix.lat_deg == 0.0 && fix.lon_deg == 0.0) {
            dropped("fix without a place on earth", i);
            continue;
        }
        match latest_ns {
            Some(latest) if fix.time_ns == latest => dropped("fix of the same time as the one before", i),
            Some(latest) if fix.time_ns < latest => dropped("fix that is older than the one before", i),
            _ => {
                latest_ns = Some(fix.time_ns);
                match runs.iter().position(|run| run.last().is_some_and(|(_, last)| reaches(last, &fix))) {
                    Some(run) => runs[run].push((i, fix)),
                    None if runs.len() < MOST_RUNS => runs.push(vec![(i, fix)]),
                    None => dropped("fix that nobody can have driven to", i),
                }
            }
        }
    }
    // The first of the longest.
    let longest = (0..runs.len()).rev().max_by_key(|&r| runs[r].len());
    let Some(kept) = longest.map(|r| runs.swap_remove(r)) else { return Vec::new() };
    for (i, _) in runs.into_iter().flatten() {
        dropped("fix that nobody can have driven to", i);
    }
    kept.into_iter().map(|(_, fix)| fix).collect()
}

fn reaches(from: &Fix, to: &Fix) -> bool {
    let seconds = to.time_ns.saturating_sub(from.time_ns) as f64 * 1e-9;
    let projection = MapProjection::ellipsoidal(from.lat_deg, from.lon_deg, DVec2::ZERO);
    projection.world_from_geo(to.lat_deg, to.lon_deg).length() <= FASTEST_MPS * seconds + JITTER_M
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fix(seconds: f64, lat_deg: f64) -> Fix {
        Fix { time_ns: (seconds * 1e9) as i64, lat_deg, lon_deg: 8.0, alt_m: None, yaw_rad: None }
    }

    #[test]
    fn what_nobody_can_have_driven_is_dropped_and_told() {
        let step = 1e-4; // 11 m
        let mut fixes: Vec<Fix> = (0..10).map(|i| fix(f64::from(i), 49.0 + f64::from(i) * step)).collect();
        fixes.insert(0, fix(-1.0, 12.0)); // the first is of another place
        fixes[5].lat_deg += 0.5; // an outlier
        fixes.insert(8, fixes[7]); // twice
        fixes.insert(9, fix(2.0, 49.0)); // back in time
        fixes.insert(10, Fix { lon_deg: 0.0, ..fix(6.5, 0.0) });
        fixes.insert(11, fix(6.6, f64::NAN));
        let report = Report::default();
        let kept = possible(&fixes, &report);
        assert_eq!(kept.len(), 9);
        assert!(kept.windows(2).all(|w| w[0].time_ns < w[1].time_ns && w[1].lat_deg - w[0].lat_deg < 3.0 * step));
        let told: Vec<_> = report.entries().into_iter().map(|e| (e.what, e.count)).collect();
        let expected = [
            ("GPS: fix of the same time as the one before", 1),
            ("GPS: fix that is older than the one before", 1),
            ("GPS: fix that nobody can have driven to", 2),
            ("GPS: fix without a place on earth", 2),
        ];
        assert_eq!(told, expected.map(|(what, count)| (what.to_owned(), count)));
    }
}

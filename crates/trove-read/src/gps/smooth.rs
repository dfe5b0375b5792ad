//! A trace without its noise: robust local regression (Cleveland 1979), of the second degree in the plane and of the first
//! in height.

use glam::{DMat3, DVec3};

/// Half the window in the plane, seconds, or so many steps between fixes where those are longer; heights get more.
const WINDOW_S: f64 = 1.0;
const WINDOW_STEPS: f64 = 2.5;
const HEIGHT_WINDOWS: f64 = 5.0;
/// A window holds at most so many fixes on each side.
const MOST_BESIDE: usize = 100;
/// Rounds of weighing down what lies beside the curve.
const ROUNDS: usize = 3;
/// Nothing is measured better, metres.
const LEAST_SCALE_M: f64 = 0.05;
/// Residuals from so many medians on do not count.
const REJECTED_MEDIANS: f64 = 6.0;

/// A place of the smoothed trace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// From the first fix.
    pub(super) time_s: f64,
    pub(super) position: DVec3,
    pub(super) velocity_mps: DVec3,
}

/// The trace at its fixes, which are in the order of time.
pub(super) fn smoothed(times_s: &[f64], positions: &[DVec3]) -> Vec<Sample> {
    let mut steps: Vec<f64> = times_s.windows(2).map(|w| w[1] - w[0]).collect();
    steps.sort_by(f64::total_cmp);
    let window_s = WINDOW_S.max(WINDOW_STEPS * steps.get(steps.len() / 2).copied().unwrap_or(0.0));
    let mut trust = vec![1.0; positions.len()];
    let mut samples = Vec::new();
    for round in 0..ROUNDS {
        samples = (0..positions.len()).map(|i| at(i, times_s, positions, &trust, window_s)).collect();
        if round + 1 == ROUNDS {
            break;
        }
        let off_m = |(sample, position): (&Sample, &DVec3)| (sample.position - position).truncate().length();
        let residuals: Vec<f64> = samples.iter().zip(positions).map(off_m).collect();
        let mut sorted = residuals.clone();
        sorted.sort_by(f64::total_cmp);
        let scale_m = REJECTED_MEDIANS * sorted.get(sorted.len() / 2).copied().unwrap_or(0.0).max(LEAST_SCALE_M);
        trust = residuals.into_iter().map(|r| (1.0 - (r / scale_m).powi(2)).max(0.0).powi(2)).collect();
    }
    samples
}

fn at(i: usize, times_s: &[f64], positions: &[DVec3], trust: &[f64], window_s: f64) -> Sample {
    let plane = fitted(i, times_s, positions, trust, window_s, true);
    let height = fitted(i, times_s, positions, trust, HEIGHT_WINDOWS * window_s, false);
    let both = |plane: DVec3, height: DVec3| plane.truncate().extend(height.z);
    Sample { time_s: times_s[i], position: both(plane.0, height.0), velocity_mps: both(plane.1, height.1) }
}

/// Position and velocity at a fix by a curve through its neighbours.
fn fitted(
    i: usize,
    times_s: &[f64],
    positions: &[DVec3],
    trust: &[f64],
    window_s: f64,
    is_bent: bool,
) -> (DVec3, DVec3) {
    let from = i.saturating_sub(MOST_BESIDE);
    let to = (i + MOST_BESIDE + 1).min(times_s.len());
    // Moments of time in windows, and of positions with them.
    let (mut m, mut p) = ([0.0; 5], [DVec3::ZERO; 3]);
    for k in from..to {
        let t = (times_s[k] - times_s[i]) / window_s;
        let weight = (1.0 - t.abs().powi(3)).max(0.0).powi(3) * trust[k].max(1e-6);
        let mut power = weight;
        for (degree, moment) in m.iter_mut().enumerate() {
            *moment += power;
            if let Some(p) = p.get_mut(degree) {
                *p += positions[k] * power;
            }
            power *= t;
        }
    }
    // A little stiffness keeps lone fixes from being an equation without a solution.
    let stiff = 1e-6 * m[0];
    let bend = if is_bent { m[4] + stiff } else { f64::INFINITY };
    let normal = if bend.is_finite() {
        DMat3::from_cols_array(&[m[0], m[1], m[2], m[1], m[2] + stiff, m[3], m[2], m[3], bend])
    } else {
        DMat3::from_cols_array(&[m[0], m[1], 0.0, m[1], m[2] + stiff, 0.0, 0.0, 0.0, 1.0])
    };
    let p2 = if is_bent { p[2] } else { DVec3::ZERO };
    let inverse = normal.inverse();
    let solved = |row: DVec3| p[0] * row.x + p[1] * row.y + p2 * row.z;
    let rows = inverse.transpose();
    (solved(rows.x_axis), solved(rows.y_axis) / window_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Seed;

    #[test]
    fn a_noisy_bend_comes_out_smooth_and_an_outlier_does_not_count() {
        // 10 m/s on a circle of 40 m, up 3 %, at 10 Hz; fixes are off by up to 0.8 m, and one by 30 m.
        let mut random = Seed(3).random();
        let truth = |t: f64| DVec3::new(40.0 * (t / 4.0).sin(), 40.0 - 40.0 * (t / 4.0).cos(), 0.3 * t);
        let times: Vec<f64> = (0..200).map(|i| 0.1 * f64::from(i)).collect();
        let mut noise = || random.range(-0.8, 0.8);
        let mut positions: Vec<DVec3> =
            times.iter().map(|&t| truth(t) + DVec3::new(noise(), noise(), noise())).collect();
        positions[100].x += 30.0;
        let samples = smoothed(&times, &positions);
        let error = |i: usize| samples[i].position.distance(truth(times[i]));
        let mean_m = (0..200).map(error).sum::<f64>() / 200.0;
        assert!(mean_m < 0.35 && error(100) < 0.7, "{mean_m} {}", error(100));
        let fast = samples[50].velocity_mps;
        assert!((fast.truncate().length() - 10.0).abs() < 0.8 && (fast.z - 0.3).abs() < 0.1, "{fast}");
    }

    #[test]
    fn a_lone_fix_and_equal_ones_are_where_they_are() {
        let here = DVec3::new(1.0, 2.0, 3.0);
        let sample = smoothed(&[0.0], &[here])[0];
        assert!(sample.position.distance(here) < 1e-6 && sample.velocity_mps.length() < 1e-6, "{sample:?}");
        let samples = smoothed(&[0.0, 100.0, 200.0], &[here; 3]);
        assert!(samples.iter().all(|s| s.position.distance(here) < 1e-4), "{samples:?}");
    }
}

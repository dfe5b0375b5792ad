//! The rigid correction that evidence asks for, if it asks clearly.

use glam::{DMat3, DVec3};

use super::correction::Correction;
use super::evidence::{Evidence, Movable, Pull, Pulls};

/// A correction beyond these is not one of a map that is meant for this drive, metres and radians (1°).
const MAX_SHIFT_M: f64 = 6.0;
const MAX_TURN_RAD: f64 = 0.01745;
/// How maps err before anything is known, as standard deviations: it holds what the evidence leaves open, such as where
/// along a straight road the map should lie.
const PRIOR_SHIFT_M: f64 = 3.0;
const PRIOR_TURN_RAD: f64 = 0.01;
/// How far a single road or facade is drawn off its place, as a standard deviation, metres.
const NOISE_M: f64 = 0.7;
/// Beyond this a pull is taken for a mistake, step by step, metres (Geman and McClure's estimator).
const SCALES_M: [f64; 10] = [5.0, 4.0, 3.0, 2.0, 1.5, 1.2, 1.0, 1.0, 1.0, 1.0];
/// A correction has to take so much off the mean cost, of at least so many independent observations.
const LEAST_GAIN: f64 = 0.15;
const LEAST_OBSERVATIONS: f64 = 5.0;
/// No kind of evidence may end up further away than before by more than this, metres.
const MAX_WORSE_M: f64 = 0.05;
/// A smaller correction is none, metres.
const LEAST_M: f64 = 0.05;

/// What came of it.
pub(super) enum Fit {
    /// The map lies as well as can be told.
    Stays,
    /// The map lies better after this.
    Moves(Correction),
    /// The map would have to move too far.
    TooFar(Correction),
}

/// Estimates by Gauss–Newton with robust weights; the same evidence gives the same correction.
pub(super) fn fit(evidence: &Evidence, map: &Movable) -> Fit {
    let identity = Correction::identity(evidence.middle());
    let mut correction = identity;
    for scale_m in SCALES_M {
        correction = step(&correction, &evidence.pulls(map, &correction), scale_m);
    }
    let (before, after) = (evidence.pulls(map, &identity), evidence.pulls(map, &correction));
    if !is_better(&before, &after) || correction.shift_m.length() + 100.0 * correction.turn_rad.abs() < LEAST_M {
        return Fit::Stays;
    }
    let is_near = correction.shift_m.length() <= MAX_SHIFT_M && correction.turn_rad.abs() <= MAX_TURN_RAD;
    if is_near { Fit::Moves(correction) } else { Fit::TooFar(correction) }
}

/// The correction at which the pulls and the prior are in balance.
fn step(correction: &Correction, pulls: &Pulls, scale_m: f64) -> Correction {
    // Unknowns: shift along x and y, and turn about the pivot.
    let prior = DVec3::new(PRIOR_SHIFT_M, PRIOR_SHIFT_M, PRIOR_TURN_RAD).map(|deviation| deviation.powi(-2));
    let current = correction.shift_m.extend(correction.turn_rad);
    let (mut information, mut wanted) = (DMat3::from_diagonal(prior), -prior * current);
    for pull in pulls.all() {
        let lever = (pull.at - correction.pivot - correction.shift_m).perp();
        let row = pull.along.extend(pull.along.dot(lever));
        let trust = (1.0 + (pull.distance_m / scale_m).powi(2)).powi(-2);
        let weight = pull.weight * trust / (NOISE_M * NOISE_M);
        information += DMat3::from_cols(row * row.x, row * row.y, row * row.z) * weight;
        wanted += row * (pull.distance_m * weight);
    }
    // Positive definite by the prior.
    let next = current + information.inverse() * wanted;
    if next.is_finite() {
        Correction { shift_m: next.truncate(), turn_rad: next.z, ..*correction }
    } else {
        *correction
    }
}

fn is_better(before: &Pulls, after: &Pulls) -> bool {
    let weight = |pulls: &Pulls| pulls.all().map(|p| p.weight).sum::<f64>();
    // Beyond the widest scale all mistakes are alike.
    let share = |p: &Pull| {
        let scaled = (p.distance_m / SCALES_M[0]).powi(2);
        p.weight * scaled / (1.0 + scaled)
    };
    let cost = |pulls: &Pulls| pulls.all().map(share).sum::<f64>() / weight(pulls);
    let is_worse = |of: fn(&Pulls) -> &[Pull]| match (median_m(of(before)), median_m(of(after))) {
        (Some(before_m), Some(after_m)) => after_m > before_m + MAX_WORSE_M,
        (before_m, after_m) => before_m.is_some() && after_m.is_none(),
    };
    weight(before) >= LEAST_OBSERVATIONS
        && weight(after) >= 0.8 * weight(before)
        && cost(after) < (1.0 - LEAST_GAIN) * cost(before)
        && !is_worse(|p| &p.roads)
        && !is_worse(|p| &p.path)
        && !is_worse(|p| &p.facades)
}

/// Median of how far things are off, by weight; `None` without any.
pub(super) fn median_m(pulls: &[Pull]) -> Option<f64> {
    let mut sorted: Vec<(f64, f64)> = pulls.iter().map(|p| (p.distance_m.abs(), p.weight)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut left = sorted.iter().map(|s| s.1).sum::<f64>() / 2.0;
    let mut passed = |weight: f64| {
        left -= weight;
        left <= 0.0
    };
    sorted.iter().find(|(_, weight)| passed(*weight)).map(|(distance_m, _)| *distance_m)
}

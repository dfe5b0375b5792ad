//! Which way a model looks: by names of its parts and by its shape.

use glam::{Mat3, Vec2, Vec3};
use trove_model::Kind;

use super::axes::Axis;
use super::evidence::Evidence;
use super::model::Mark;
use super::profile;
use super::samples::{Sample, in_heights};
use super::upright::Upright;
use super::words::{match_of, words};

/// A direction and what speaks for it.
#[derive(Clone, Debug)]
pub(super) struct Front {
    pub(super) front: Axis,
    pub(super) confidence: f32,
    pub(super) reason: String,
}

const AHEAD: &str = "front|headlight|head light|hood|bonnet|windshield|windscreen|grille|steering|handlebar|handle|nose|face|eye|eyes|visor";
const BEHIND: &str = "rear|back|taillight|tail light|tail|trunk|boot|exhaust|brake light|spoiler|licence plate rear";

/// The likeliest of the four level directions.
pub(super) fn front(samples: &[Sample], marks: &[Mark], kind: Option<Kind>, upright: &Upright) -> Front {
    let up = upright.up;
    // Upright, x along the first level axis: what is judged has x and y level and z up, in heights.
    let x = up.across().next().unwrap_or(Axis::PlusX);
    let turn = Axis::turn(x, up);
    let points = in_heights(samples, turn);
    let mut evidence: Vec<Evidence> = by_names(marks, samples, turn).into_iter().collect();
    let length = (turn * upright.along.direction()).truncate().abs();
    evidence.extend(match kind {
        Some(kind) if kind.is_vehicle() => profile::vehicle(&points, length, kind),
        Some(
            Kind::Adult
            | Kind::Child
            | Kind::ConstructionWorker
            | Kind::PoliceOfficer
            | Kind::PersonalMobility
            | Kind::Wheelchair,
        ) => profile::person(&points),
        Some(Kind::TrafficSign) => profile::plate(&points),
        Some(Kind::TrafficSignal) => profile::lamps(&points),
        Some(Kind::StreetLamp) => profile::arm(&points),
        Some(Kind::Bench | Kind::Bin | Kind::Shelter | Kind::StreetFurniture) => profile::open_side(&points),
        _ => Vec::new(),
    });
    let allowed = |axis: &Axis| !bound_to_length(kind) || !upright.along_is_sure || axis.is_along(upright.along);
    let habit = match up {
        Axis::PlusY => Axis::PlusZ,
        Axis::PlusZ => Axis::MinusY,
        _ => x,
    };
    let score = |axis: Axis| {
        let direction = (turn * axis.direction()).truncate();
        let shape: f32 = evidence.iter().map(|e| e.score(direction)).sum();
        // A tie goes to where most files look, and lengthwise.
        let lengthwise = if axis.is_along(upright.along) { 0.1 } else { 0.0 };
        shape + lengthwise + if axis == habit { 0.15 } else { 0.0 }
    };
    let mut candidates: Vec<Axis> = up.across().filter(allowed).collect();
    candidates.sort_by(|a, b| score(*b).total_cmp(&score(*a)));
    let front = candidates[0];
    let margin = candidates.get(1).map_or(2.0, |second| score(front) - score(*second));
    let direction = (turn * front.direction()).truncate();
    let mut reasons: Vec<(f32, &str)> =
        evidence.iter().map(|e| (e.score(direction), e.reason)).filter(|r| r.0 > 0.1).collect();
    reasons.sort_by(|a, b| b.0.total_cmp(&a.0));
    let reason: Vec<&str> = reasons.iter().take(2).map(|r| r.1).collect();
    let reason = if reason.is_empty() { "as in most files".to_owned() } else { reason.join(", ") };
    Front { front, confidence: 1.0 / (1.0 + (-1.5 * margin).exp()), reason }
}

/// Kinds whose front is at an end of their length.
fn bound_to_length(kind: Option<Kind>) -> bool {
    kind.is_some_and(|k| {
        k.is_vehicle() || matches!(k, Kind::Barrier | Kind::Fence | Kind::Wall | Kind::GuardRail | Kind::Trailer)
    })
}

/// Pieces that are called after an end, by where they are.
fn by_names(marks: &[Mark], samples: &[Sample], turn: Mat3) -> Option<Evidence> {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    samples.iter().map(|s| turn * s.at).for_each(|p| (low, high) = (low.min(p), high.max(p)));
    let half = ((high - low) / 2.0).truncate().max_element().max(1e-9);
    let middle = ((low + high) / 2.0).truncate();
    let (mut sum, mut count) = (Vec2::ZERO, 0.0);
    for mark in marks {
        let words = words(&mark.name);
        let called = |phrases: &str| phrases.split('|').map(|p| match_of(&words, p)).max().unwrap_or(0);
        let (ahead, behind) = (called(AHEAD), called(BEHIND));
        let at = ((turn * mark.centre).truncate() - middle) / half;
        if ahead != behind && at.is_finite() {
            sum += if ahead > behind { at } else { -at };
            count += 1.0;
        }
    }
    (count > 0.0).then(|| Evidence { towards: sum / count * 4.0, either: false, reason: "names of its parts" })
}

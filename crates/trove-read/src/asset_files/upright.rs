//! Which way is up in a model, and how long its unit is: by what it shows and its proportions.

use glam::Vec3;

use super::axes::Axis;
use super::samples::Sample;
use super::subjects::{Expected, Subject};

/// Units that files are written in: metre, centimetre, millimetre, inch, foot, decimetre, ten metres.
const UNITS: [(f32, &str); 7] = [
    (1.0, "metres"),
    (0.01, "centimetres"),
    (0.001, "millimetres"),
    (0.0254, "inches"),
    (0.3048, "feet"),
    (0.1, "decimetres"),
    (10.0, "tens of metres"),
];

/// What was found out.
#[derive(Clone, Debug)]
pub(super) struct Upright {
    pub(super) up: Axis,
    /// The axis that the model's length (its forward axis) lies along, in either direction.
    pub(super) along: Axis,
    /// Whether the length clearly lies along it and not across.
    pub(super) along_is_sure: bool,
    pub(super) scale: Scale,
    pub(super) up_confidence: f32,
    pub(super) up_reason: String,
    pub(super) scale_confidence: f32,
    pub(super) scale_reason: String,
}

/// How large a model is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Scale {
    /// Metres a unit of the file.
    Unit(f32),
    /// Metres from the lowest to the highest point.
    Height(f32),
    /// Metres from the foremost to the rearmost point.
    Length(f32),
}

/// One way to stand, and how ill it fits.
struct Stance {
    up: Axis,
    along: Axis,
    shape: [f32; 3],
    /// Natural logarithm of the factor that makes it as large as its kind.
    log_scale: f32,
    misfit: f32,
}

/// Tries every way to stand. A file that says which way is up (`declared`) is believed unless proportions are clearly
/// against it.
pub(super) fn upright(size: Vec3, samples: &[Sample], expected: Option<Expected>, declared: bool) -> Upright {
    among(&Axis::ALL, size, samples, expected, declared)
}

/// The same where the user says which way is up.
pub(super) fn with_up(size: Vec3, samples: &[Sample], expected: Option<Expected>, up: Axis) -> Upright {
    among(&[up], size, samples, expected, true)
}

fn among(ups: &[Axis], size: Vec3, samples: &[Sample], expected: Option<Expected>, declared: bool) -> Upright {
    let Some(Expected { subject, shapes }) = expected else { return as_declared(ups, size, declared) };
    let mut stances: Vec<Stance> = Vec::new();
    for &up in ups {
        let shape_misfit = top_and_bottom(samples, up, subject);
        let prior = match (up, declared) {
            (Axis::PlusY, _) => 0.0,
            (Axis::PlusZ, true) => 4.0,
            (Axis::PlusZ, false) => 0.5,
            (_, true) => 9.0,
            (_, false) => 4.0,
        };
        for along in up.across().filter(|a| (*a as usize).is_multiple_of(2)) {
            for &shape in shapes {
                let (log_scale, misfit) = fit(size, up, along, shape, subject);
                stances.push(Stance { up, along, shape, log_scale, misfit: misfit + prior + shape_misfit });
            }
        }
    }
    stances.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let best = &stances[0];
    let margin = |other: Option<&Stance>| other.map_or(20.0, |o| o.misfit - best.misfit);
    let up_margin = margin(stances.iter().find(|s| s.up != best.up));
    let along_margin = margin(stances.iter().find(|s| s.up == best.up && s.along != best.along));
    let (scale, scale_confidence, scale_reason) = scale_of(best, size, subject);
    Upright {
        up: best.up,
        along: best.along,
        along_is_sure: along_margin > 1.0,
        scale,
        up_confidence: sureness(up_margin),
        up_reason: if best.up == Axis::PlusY && declared {
            "as the file says; proportions agree".into()
        } else {
            format!("proportions of {:.1} × {:.1} × {:.1} m", best.shape[0], best.shape[1], best.shape[2])
        },
        scale_confidence,
        scale_reason,
    }
}

/// Nothing is known of what it shows.
fn as_declared(ups: &[Axis], size: Vec3, declared: bool) -> Upright {
    let confidence = if declared { 0.6 } else { 0.3 };
    let up = if ups.contains(&Axis::PlusY) { Axis::PlusY } else { ups[0] };
    let longer = |a: Axis, b: Axis| if extent(size, a) > extent(size, b) { a } else { b };
    let along = up.across().filter(|a| (*a as usize).is_multiple_of(2)).reduce(longer).unwrap_or(Axis::PlusX);
    Upright {
        up,
        along,
        along_is_sure: false,
        scale: Scale::Unit(1.0),
        up_confidence: confidence,
        up_reason: "as in most files".into(),
        scale_confidence: confidence,
        scale_reason: "as in most files".into(),
    }
}

/// Margin between misfits (differences of χ²) → 0.5 to 1.
fn sureness(margin: f32) -> f32 {
    1.0 / (1.0 + (-margin / 2.0).exp())
}

fn extent(size: Vec3, axis: Axis) -> f32 {
    (size * axis.direction().abs()).max_element().max(1e-9)
}

/// The factor that fits a shape best, as a logarithm, and how much is left over.
fn fit(size: Vec3, up: Axis, along: Axis, shape: [f32; 3], subject: &Subject) -> (f32, f32) {
    let across = up.across().find(|a| !a.is_along(along)).unwrap_or(along);
    let dims = [along, across, up].map(|axis| extent(size, axis));
    let weights = subject.spread.map(|s| 1.0 / (s * s));
    let logs: [f32; 3] = std::array::from_fn(|i| (shape[i] / dims[i]).ln());
    let weighted = |w: [f32; 3]| (0..3).map(|i| logs[i] * w[i]).sum::<f32>() / w.iter().sum::<f32>();
    // One measure that is quite out of the ordinary has little say in how large the rest is.
    let first = weighted(weights);
    let doubted: [f32; 3] =
        std::array::from_fn(|i| weights[i] / (1.0 + weights[i] * (logs[i] - first) * (logs[i] - first)));
    let mean = weighted(doubted);
    let left: f32 = (0..3).map(|i| weights[i] * (logs[i] - mean) * (logs[i] - mean)).sum();
    // A file in metres that fits as it is speaks for this stance.
    let off = (mean / subject.tolerance).abs().min(2.0);
    (mean, left.min(40.0) + off * off)
}

/// Poles, people and trees are wider above than below, vehicles and cones below: how much this way up is against that.
fn top_and_bottom(samples: &[Sample], up: Axis, subject: &Subject) -> f32 {
    use trove_model::Kind;
    let wide_below = match subject.kind {
        Some(kind) if kind.is_vehicle() => 1.0,
        Some(Kind::TrafficCone | Kind::Hydrant | Kind::Barrier | Kind::Building) => 1.0,
        Some(Kind::Tree | Kind::TrafficSign | Kind::TrafficSignal | Kind::StreetLamp | Kind::UtilityPole) => -1.0,
        Some(Kind::Adult | Kind::ConstructionWorker | Kind::PoliceOfficer) => -0.5,
        _ => return 0.0,
    };
    let along = up.direction();
    let heights = || samples.iter().map(|s| s.at.dot(along));
    let (low, high) = (heights().fold(f32::MAX, f32::min), heights().fold(f32::MIN, f32::max));
    // Mean distance from the middle, across the way up.
    let width = |from: f32, to: f32| {
        let part =
            || samples.iter().filter(|s| (from..=to).contains(&((s.at.dot(along) - low) / (high - low).max(1e-9))));
        let count = part().count().max(1) as f32;
        let flat = |s: &Sample| s.at - along * s.at.dot(along);
        let middle = part().map(flat).sum::<Vec3>() / count;
        part().map(|s| flat(s).distance(middle)).sum::<f32>() / count
    };
    let ratio = (width(0.0, 0.35).max(1e-6) / width(0.65, 1.0).max(1e-6)).ln().clamp(-1.5, 1.5);
    -2.0 * wide_below * ratio
}

/// The file's own unit where that fits; else a usual unit; else the kind's usual size.
fn scale_of(best: &Stance, size: Vec3, subject: &Subject) -> (Scale, f32, String) {
    if best.log_scale.abs() <= subject.tolerance {
        let confidence = 1.0 - 0.4 * best.log_scale.abs() / subject.tolerance;
        return (Scale::Unit(1.0), confidence, "as large as its kind in metres".into());
    }
    let off = |unit: f32| (best.log_scale - unit.ln()).abs();
    let unit =
        UNITS.iter().min_by(|a, b| off(a.0).total_cmp(&off(b.0))).filter(|u| off(u.0) <= subject.tolerance / 2.0);
    if let Some((unit, name)) = unit {
        return (Scale::Unit(*unit), 0.8, format!("as large as its kind in {name}"));
    }
    let factor = best.log_scale.exp();
    let rounded = |metres: f32| (metres * 100.0).round() / 100.0;
    let reason = format!("its kind's usual size; in metres it would be {:.3} times as large", 1.0 / factor);
    // The measure that varies least among its kind.
    if subject.spread[0] < subject.spread[2] {
        (Scale::Length(rounded(extent(size, best.along) * factor)), 0.5, reason)
    } else {
        (Scale::Height(rounded(extent(size, best.up) * factor)), 0.5, reason)
    }
}

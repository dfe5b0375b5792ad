//! From the surfaces in a beam to its echoes.

use glam::DVec3;
use trove_model::{Class, InstanceId};

/// Surfaces in one plane are one, however slanted: they may be so far from each other's plane, metres.
const IN_PLANE_M: f64 = 0.1;

/// What one ray of a beam met.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub(super) range_m: f64,
    /// Its share of what a white matt surface that fills the beam and faces it sends back at the same range.
    pub(super) power: f32,
    /// World.
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
    /// Whether it is the beam's middle.
    pub(super) is_middle: bool,
    pub(super) class: Class,
    pub(super) instance: InstanceId,
}

/// Light that comes back together.
#[derive(Clone, Copy)]
pub(super) struct Echo {
    pub(super) range_m: f64,
    pub(super) power: f32,
    pub(super) class: Class,
    pub(super) instance: InstanceId,
}

/// The echoes of a beam, the nearest first.
pub(super) fn echoes(mut parts: Vec<Part>, pulse_m: f64) -> Vec<Echo> {
    parts.sort_by(|a, b| a.range_m.total_cmp(&b.range_m));
    let is_one =
        |a: &Part, b: &Part| b.range_m - a.range_m < pulse_m || (b.point - a.point).dot(a.normal).abs() < IN_PLANE_M;
    parts.chunk_by(is_one).map(echo).collect()
}

/// At the range of the beam's middle where that is part of it, else at the mean of its light.
fn echo(parts: &[Part]) -> Echo {
    let power: f32 = parts.iter().map(|part| part.power).sum();
    let mean_m = || {
        let weight = |part: &Part| f64::from(part.power.max(f32::MIN_POSITIVE));
        let sum: f64 = parts.iter().map(weight).sum();
        parts.iter().map(|part| part.range_m * weight(part)).sum::<f64>() / sum
    };
    let middle = parts.iter().find(|part| part.is_middle);
    let strongest = parts.iter().reduce(|a, b| if b.power > a.power { b } else { a });
    let Part { class, instance, .. } = *middle.or(strongest).unwrap_or(&parts[0]);
    Echo { range_m: middle.map_or_else(mean_m, |part| part.range_m), power, class, instance }
}

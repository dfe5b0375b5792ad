//! A road above the ground, with its height at every step.

use glam::DVec2;
use trove_model::{Polygon, Road};

use super::lift::Lift;
use crate::geometry::plane::strip;
use crate::roads::network::resampled;

/// From one level to the next, metres: 4.5 m for lorries, and the deck.
pub(super) const LEVEL_M: f64 = 5.6;
/// Below this a deck is a solid ramp, metres.
pub(super) const SOLID_M: f64 = 1.6;
/// From the outermost lane's gutter to the deck's outer side.
pub(super) const EDGE_M: f64 = 0.6;

/// A road above the ground.
#[derive(Clone, Debug)]
pub(in crate::roads) struct Deck<'a> {
    pub road: &'a Road,
    pub line: Vec<DVec2>,
    /// Above the ground, one a point of the line.
    pub heights_m: Vec<f64>,
}

/// Vertices with the same key are one node of the map.
pub(super) type Key = [i64; 2];

pub(super) fn key(p: DVec2) -> Key {
    (p * 100.0).round().as_i64vec2().to_array()
}

/// A line cut in two at some metres from its start.
pub(super) fn split(line: &[DVec2], at_m: f64) -> (Vec<DVec2>, Vec<DVec2>) {
    let mut before = vec![line[0]];
    let mut left_m = at_m;
    for (i, pair) in line.windows(2).enumerate() {
        let length_m = pair[0].distance(pair[1]);
        if length_m > left_m {
            let cut = pair[0].lerp(pair[1], left_m / length_m);
            before.push(cut);
            let after = std::iter::once(cut).chain(line[i + 1..].iter().copied()).collect();
            return (before, after);
        }
        before.push(pair[1]);
        left_m -= length_m;
    }
    (before, Vec::new())
}

impl Deck<'_> {
    /// With its heights counted from its road's own course over the ground, in place of from the ground.
    pub(super) fn lifted(mut self, lift: &Lift<'_>) -> Self {
        for (height_m, &p) in self.heights_m.iter_mut().zip(&self.line) {
            *height_m += lift.at(self.road, p);
        }
        self
    }

    /// Half of the width from outer side to outer side.
    pub(super) fn half_width_m(&self, carriageway_m: f64) -> f64 {
        carriageway_m / 2.0 + EDGE_M
    }

    /// Where it is a solid ramp, and where one can pass below it; the ramps a little less than they are.
    pub(in crate::roads) fn footprint(&self, carriageway_m: f64) -> [Vec<Polygon>; 2] {
        let half_m = self.half_width_m(carriageway_m);
        let solid = |i: &usize| self.heights_m[*i] < SOLID_M;
        let indices: Vec<usize> = (0..self.line.len()).collect();
        let mut areas = [Vec::new(), Vec::new()];
        for run in indices.chunk_by(|a, b| solid(a) == solid(b)) {
            let (first, last) = (run[0], (run[run.len() - 1] + 1).min(self.line.len() - 1));
            let is_solid = solid(&first);
            let inset_m = if is_solid { 0.1 } else { 0.0 };
            areas[usize::from(!is_solid)].extend(strip(&self.line[first..=last], half_m - inset_m));
        }
        areas
    }
}

/// A line with its heights at every step; `height_m` tells the height at metres along it.
pub(super) fn deck<'a>(road: &'a Road, line: &[DVec2], height_m: impl Fn(f64) -> f64) -> Deck<'a> {
    let line = resampled(line);
    let mut along_m = 0.0;
    let mut heights_m = Vec::with_capacity(line.len());
    for (i, &p) in line.iter().enumerate() {
        along_m += if i > 0 { p.distance(line[i - 1]) } else { 0.0 };
        heights_m.push(height_m(along_m));
    }
    // Slopes change gently; where decks meet they keep their height.
    for _ in 0..20 {
        let before = heights_m.clone();
        for i in 1..heights_m.len().saturating_sub(1) {
            heights_m[i] = 0.25 * before[i - 1] + 0.5 * before[i] + 0.25 * before[i + 1];
        }
    }
    Deck { road, line, heights_m }
}

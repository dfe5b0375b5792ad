//! Where a road above the ground has something below it.

use glam::DVec2;
use trove_model::{Bounds, LineKind, Road, StreetMap};

use super::deck::{key, split};
use crate::geometry::segments::SegmentIndex;

/// A road nearer than this to the middle of one below runs above it, metres.
const ABOVE_M: f64 = 3.0;
/// Near its ends every bridge runs beside the roads that it joins, metres.
const ENDS_M: f64 = 40.0;

/// A point of a road of a group, with how many levels it has to be above what crosses there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub road: usize,
    pub along_m: f64,
    /// What is below: the ground, or a road of the same group at some metres along it.
    pub below: Option<(usize, f64)>,
}

/// All crossings of a group of connected roads.
#[derive(Debug)]
pub(super) struct Crossings {
    pub all: Vec<Crossing>,
}

impl Crossings {
    pub(super) fn new(group: &[&Road], ground: &[&Road], raised: &[&Road], map: &StreetMap) -> Self {
        let rails = map.lines.iter().filter(|l| l.kind == LineKind::Railway).map(|l| l.line.as_slice());
        let others = raised.iter().filter(|r| !group.iter().any(|g| g.id == r.id));
        let mut all = Vec::new();
        for (i, road) in group.iter().enumerate() {
            let lower = others.clone().filter(|r| r.layer < road.layer).map(|r| r.centreline.as_slice());
            let below = ground.iter().map(|r| r.centreline.as_slice()).chain(rails.clone()).chain(lower);
            for line in below {
                all.extend(meetings(&road.centreline, line).map(|(along_m, _)| Crossing {
                    road: i,
                    along_m,
                    below: None,
                }));
            }
            for (k, other) in group.iter().enumerate().filter(|(_, other)| other.layer < road.layer) {
                let meets = meetings(&road.centreline, &other.centreline);
                all.extend(meets.map(|(along_m, other_m)| Crossing { road: i, along_m, below: Some((k, other_m)) }));
            }
        }
        // Roads that run along above others.
        let streets = SegmentIndex::new(ground.iter().map(|r| r.centreline.as_slice()));
        for (i, road) in group.iter().enumerate() {
            let length_m: f64 = road.centreline.windows(2).map(|w| w[0].distance(w[1])).sum();
            let middle_m = length_m / 2.0;
            if length_m > 2.0 * ENDS_M && streets.nearest(at(&road.centreline, middle_m), ABOVE_M).is_some() {
                all.push(Crossing { road: i, along_m: middle_m, below: None });
            }
        }
        Self { all }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }
}

/// The position at some metres along a line.
fn at(line: &[DVec2], along_m: f64) -> DVec2 {
    split(line, along_m).0.last().copied().unwrap_or_default()
}

/// Where two ways cross between their nodes, as metres along both; ways that meet on one level share a node.
fn meetings(a: &[DVec2], b: &[DVec2]) -> impl Iterator<Item = (f64, f64)> {
    let mut found = Vec::new();
    let bounds = |line: &[DVec2]| Bounds::around(line.iter().copied());
    if let (Some(of_a), Some(of_b)) = (bounds(a), bounds(b))
        && of_a.overlaps(&of_b)
    {
        let mut a_m = 0.0;
        for s in a.windows(2) {
            let mut b_m = 0.0;
            for t in b.windows(2) {
                if let Some((u, v)) = crossing(s, t) {
                    found.push((a_m + u * s[0].distance(s[1]), b_m + v * t[0].distance(t[1])));
                }
                b_m += t[0].distance(t[1]);
            }
            a_m += s[0].distance(s[1]);
        }
    }
    found.into_iter()
}

/// Shares of two segments at which they cross.
fn crossing(s: &[DVec2], t: &[DVec2]) -> Option<(f64, f64)> {
    if s.iter().any(|&p| t.iter().any(|&q| key(p) == key(q))) {
        return None;
    }
    let (d, e) = (s[1] - s[0], t[1] - t[0]);
    let area = d.perp_dot(e);
    let (u, v) = ((t[0] - s[0]).perp_dot(e) / area, (t[0] - s[0]).perp_dot(d) / area);
    ((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v)).then_some((u, v))
}

//! Where roads meet, and how traffic comes to it and leaves it.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{FurnitureKind, Outcome, Report, Road, RoadKind};

use crate::surroundings::KerbPoint;
use crate::surroundings::Surroundings;

/// Meeting points nearer than this to each other are one junction, metres.
const TOGETHER_M: f64 = 24.0;
/// A mapped signal belongs to a junction within this, metres.
const SIGNAL_REACH_M: f64 = 32.0;
/// Directions are taken over this length, metres.
const ARM_M: f64 = 15.0;
/// Kerbs are looked for within this of a junction's middle, metres.
const KERB_REACH_M: f64 = 42.0;
/// A kerb still runs along its road where its direction is within this (cosine).
const ALONG: f64 = 0.92;
/// A road's kerb is at most this far to the side of its middle line, metres.
const HALF_ROAD_M: f64 = 18.0;

/// A road on one side of a junction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arm<'m> {
    pub road: &'m Road,
    /// Towards the junction, unit.
    pub inward: DVec2,
    /// Where it meets the junction.
    pub end: DVec2,
    /// Traffic comes in on it.
    pub enters: bool,
}

/// A meeting of roads, or a crossing with signals.
#[derive(Clone, Debug)]
pub(super) struct Junction<'m> {
    pub centre: DVec2,
    pub arms: Vec<Arm<'m>>,
    pub signalled: bool,
}

/// A vertex of a road.
type Vertex = (usize, usize);

/// All junctions of roads for cars, in the order of their places.
pub(super) fn junctions<'m>(around: &Surroundings<'m>, report: &Report) -> Vec<Junction<'m>> {
    let Some(map) = around.place.map else { return Vec::new() };
    let is_street = |r: &Road| r.kind < RoadKind::Service && !r.tunnel;
    let roads: Vec<&Road> = map.roads.iter().filter(|r| is_street(r)).collect();
    let mut vertices: BTreeMap<(i32, [i64; 2]), Vec<Vertex>> = BTreeMap::new();
    for (i, road) in roads.iter().enumerate() {
        for (k, p) in road.centreline.iter().enumerate().filter(|(_, p)| around.place.bounds.contains(**p)) {
            let millimetres = (*p * 1000.0).round();
            vertices.entry((road.layer, [millimetres.x as i64, millimetres.y as i64])).or_default().push((i, k));
        }
    }
    let ways_out = |&(road, k): &Vertex| if k == 0 || k + 1 == roads[road].centreline.len() { 1 } else { 2 };
    let meetings = vertices.values().filter(|at| at.iter().map(ways_out).sum::<usize>() > 2);
    let mut clusters: Vec<Vec<Vertex>> = Vec::new();
    let place = |&(road, k): &Vertex| roads[road].centreline[k];
    for meeting in meetings {
        let near = clusters.iter_mut().find(|c| place(&c[0]).distance(place(&meeting[0])) < TOGETHER_M);
        match near {
            Some(cluster) => cluster.extend(meeting),
            None => clusters.push(meeting.clone()),
        }
    }
    let mut junctions: Vec<Junction<'m>> =
        clusters.iter().map(|c| junction(c, &roads)).filter(|j| j.arms.len() > 2).collect();
    signals(around, &roads, &mut junctions, report);
    junctions
}

fn junction<'m>(cluster: &[Vertex], roads: &[&'m Road]) -> Junction<'m> {
    let place = |&(road, k): &Vertex| roads[road].centreline[k];
    let centre = cluster.iter().map(place).sum::<DVec2>() / cluster.len() as f64;
    let mut arms = Vec::new();
    for &(road, k) in cluster {
        for forward in [false, true] {
            arms.extend(arm(roads[road], k, forward).filter(|_| !inside(cluster, road, k, forward)));
        }
    }
    Junction { centre, arms, signalled: false }
}

/// Whether the next meeting along a road belongs to the same junction.
fn inside(cluster: &[Vertex], road: usize, k: usize, forward: bool) -> bool {
    cluster.iter().any(|&(other, j)| other == road && if forward { j > k } else { j < k })
}

/// The way out of a vertex, along the road's direction or against it.
fn arm(road: &Road, k: usize, forward: bool) -> Option<Arm<'_>> {
    let line = &road.centreline;
    let end = line[k];
    let way: Vec<DVec2> = if forward { line[k..].to_vec() } else { line[..=k].iter().rev().copied().collect() };
    let far = way.iter().find(|p| p.distance(end) > ARM_M).or(way.last())?;
    let inward = (end - *far).try_normalize()?;
    // `oneway` traffic runs in the way's direction.
    Some(Arm { road, inward, end, enters: !(road.oneway && forward) })
}

/// Marks junctions with signals: those that the map has, and where it has none at all, those of main roads.
fn signals<'m>(around: &Surroundings<'m>, roads: &[&'m Road], junctions: &mut Vec<Junction<'m>>, report: &Report) {
    let furniture = around.place.map.iter().flat_map(|m| &m.furniture);
    let mapped: Vec<DVec2> = furniture
        .filter(|f| f.kind == FurnitureKind::TrafficSignal && around.place.bounds.contains(f.position))
        .map(|f| f.position)
        .collect();
    if mapped.is_empty() {
        for junction in junctions.iter_mut() {
            let mut kinds: Vec<RoadKind> = junction.arms.iter().filter(|a| !a.road.link).map(|a| a.road.kind).collect();
            kinds.sort();
            // The third most important arm is the second road's.
            junction.signalled = kinds.first().is_some_and(|k| (RoadKind::Primary..=RoadKind::Secondary).contains(k))
                && kinds.get(2).is_some_and(|k| *k <= RoadKind::Tertiary);
            if junction.signalled {
                let what = "signals at a junction of main roads, where the map has none";
                report.note(Outcome::Guessed, what, format_args!("at {:.0}", junction.centre));
            }
        }
    }
    for signal in mapped {
        let distance_m = |j: &Junction| j.centre.distance(signal);
        let nearest = junctions.iter_mut().min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)));
        match nearest {
            Some(junction) if distance_m(junction) < SIGNAL_REACH_M => junction.signalled = true,
            _ => junctions.extend(between_junctions(signal, roads)),
        }
    }
}

/// A signal on a road alone, where people cross it.
fn between_junctions<'m>(signal: DVec2, roads: &[&'m Road]) -> Option<Junction<'m>> {
    let (road, k) =
        roads.iter().find_map(|r| Some((*r, r.centreline.iter().position(|p| p.distance(signal) < 0.01)?)))?;
    let arms: Vec<Arm<'m>> = [false, true].into_iter().filter_map(|forward| arm(road, k, forward)).collect();
    Some(Junction { centre: signal, arms, signalled: true })
}

/// Which kerb beside a road is meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct KerbSearch {
    /// Where traffic drives to, unit.
    pub traffic: DVec2,
    /// A position on the road's middle line.
    pub on_road: DVec2,
    /// To the side of the kerb, unit.
    pub side: DVec2,
    /// How far along the traffic's way it may be beyond the junction's middle, metres; the nearest to the first is taken.
    pub along_m: [f64; 2],
}

impl Junction<'_> {
    /// The kerb point that is meant.
    pub(super) fn kerb(&self, around: &Surroundings, search: &KerbSearch) -> Option<KerbPoint> {
        let [first, last] = search.along_m;
        let along_m = |k: &KerbPoint| (k.position - self.centre).dot(search.traffic);
        let fits = |k: &KerbPoint| {
            let beside_m = (k.position - search.on_road).dot(search.side);
            k.outward.dot(search.side) > ALONG
                && (0.5..HALF_ROAD_M).contains(&beside_m)
                && (first.min(last)..first.max(last)).contains(&along_m(k))
        };
        let near = around.kerbs.near(self.centre, KERB_REACH_M).into_iter().filter(fits);
        near.min_by(|a, b| (along_m(a) - first).abs().total_cmp(&(along_m(b) - first).abs()))
    }
}

/// To the right of a direction, or to the left where traffic keeps there.
pub(super) fn kerb_side(direction: DVec2, on_left: bool) -> DVec2 {
    if on_left { direction.perp() } else { -direction.perp() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn a_way_out_knows_where_traffic_may_go() {
        let road =
            Road { oneway: true, ..testing::road(1, RoadKind::Primary, &[[-50.0, 0.0], [0.0, 0.0], [50.0, 0.0]]) };
        let [out, into] = [arm(&road, 1, true).unwrap(), arm(&road, 1, false).unwrap()];
        assert_eq!((out.inward, out.enters), (-DVec2::X, false));
        assert_eq!((into.inward, into.enters), (DVec2::X, true));
        assert_eq!(kerb_side(DVec2::X, false), -DVec2::Y);
    }
}

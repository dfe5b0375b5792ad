//! How high roads run between the ground and what they cross.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::Road;

use super::crossings::Crossings;
use super::deck::{Deck, Key, LEVEL_M, deck, key, split};
use super::lift::Lift;

/// Slopes that are tried, with whether the roads that lead up rise too; over a valley a bridge need not rise at all.
const ATTEMPTS: [(f64, bool); 5] = [(0.0, false), (0.06, false), (0.06, true), (0.09, true), (0.13, true)];
/// The least difference of levels at a crossing.
const CLEAR_M: f64 = 5.0;
/// A road that leads up begins to rise at least this far from the next junction.
const JUNCTION_M: f64 = 12.0;

/// Heights of the nodes of a group of connected roads.
pub(super) struct Attempt {
    slope: f64,
    heights_m: BTreeMap<Key, f64>,
    /// For roads on the ground (by index) how much of their start and end rises.
    pub risen: BTreeMap<usize, [f64; 2]>,
}

impl Attempt {
    /// The gentlest that leaves room below at all crossings.
    pub(super) fn first_that_clears(
        group: &[&Road],
        ground: &[&Road],
        crossings: &Crossings,
        lift: &Lift<'_>,
    ) -> Option<Self> {
        let lift_m = |road: usize, along_m: f64| {
            let position = split(&group[road].centreline, along_m).0.last().copied();
            position.map_or(0.0, |position| lift.at(group[road], position))
        };
        let attempts = ATTEMPTS.iter().map(|&(slope, leads_up)| Self::new(group, ground, slope, leads_up));
        attempts.into_iter().find(|attempt| {
            crossings.all.iter().all(|c| {
                let height_m = |road: usize, along_m| attempt.height_m(group[road], along_m) + lift_m(road, along_m);
                let below_m = c.below.map_or(0.0, |(road, along_m)| height_m(road, along_m));
                height_m(c.road, c.along_m) - below_m >= CLEAR_M
            })
        })
    }

    fn new(group: &[&Road], ground: &[&Road], slope: f64, leads_up: bool) -> Self {
        let mut heights_m: BTreeMap<Key, f64> = BTreeMap::new();
        for road in group {
            for &p in &road.centreline {
                let height_m = heights_m.entry(key(p)).or_insert(f64::INFINITY);
                *height_m = height_m.min(top_m(road));
            }
        }
        // Where roads on the ground are met, by the road and whether its start or its end is met.
        let mut risen: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        let mut met: BTreeMap<Key, Vec<(usize, usize)>> = BTreeMap::new();
        for (i, road) in ground.iter().enumerate() {
            for (k, &p) in road.centreline.iter().enumerate() {
                if heights_m.contains_key(&key(p)) {
                    met.entry(key(p)).or_default().push((i, k));
                }
            }
        }
        for (node, roads) in met {
            let lead_m = match roads[..] {
                [(road, vertex)] if leads_up => lead_m(ground, road, vertex, LEVEL_M / slope),
                _ => None,
            };
            if let (Some((end, metres)), [(road, _)]) = (lead_m, &roads[..]) {
                risen.entry(*road).or_default()[end] = metres;
            }
            heights_m.insert(node, lead_m.map_or(0.0, |(_, metres)| metres * slope));
        }
        // No road is steeper than the slope.
        loop {
            let mut changed = false;
            for pair in group.iter().flat_map(|r| r.centreline.windows(2)) {
                let rise_m = slope * pair[0].distance(pair[1]);
                for (from, to) in [(pair[0], pair[1]), (pair[1], pair[0])] {
                    let limit_m = heights_m[&key(from)] + rise_m;
                    if let Some(height_m) = heights_m.get_mut(&key(to)).filter(|h| **h > limit_m + 1e-6) {
                        *height_m = limit_m;
                        changed = true;
                    }
                }
            }
            if !changed {
                break;
            }
        }
        Self { slope, heights_m, risen }
    }

    /// Height of a road of the group at some metres along it.
    fn height_m(&self, road: &Road, along_m: f64) -> f64 {
        let mut start_m = 0.0;
        for pair in road.centreline.windows(2) {
            let length_m = pair[0].distance(pair[1]);
            if along_m <= start_m + length_m {
                let s = along_m - start_m;
                let rising = |p: DVec2, distance_m: f64| self.heights_m[&key(p)] + self.slope * distance_m;
                return top_m(road).min(rising(pair[0], s)).min(rising(pair[1], length_m - s));
            }
            start_m += length_m;
        }
        road.centreline.last().map_or(0.0, |&p| self.heights_m[&key(p)])
    }

    /// The group's decks and those of the roads that lead up to it.
    pub(super) fn decks<'a>(&self, group: &[&'a Road], ground: &[&'a Road], lift: &Lift<'_>) -> Vec<Deck<'a>> {
        let group = group.iter();
        let mut decks: Vec<Deck<'a>> = group
            .map(|road| deck(road, &road.centreline, |along_m| self.height_m(road, along_m)).lifted(lift))
            .collect();
        for (&road, ends) in &self.risen {
            for (end, &metres) in ends.iter().enumerate().filter(|(_, metres)| **metres > 0.0) {
                let mut line = ground[road].centreline.clone();
                if end == 1 {
                    line.reverse();
                }
                let mut line = split(&line, metres).0;
                if end == 1 {
                    line.reverse();
                }
                let height_m =
                    |along_m: f64| self.slope * if end == 1 { along_m } else { metres - along_m }.clamp(0.0, metres);
                decks.push(deck(ground[road], &line, height_m));
            }
        }
        decks
    }
}

/// The highest that a road runs.
fn top_m(road: &Road) -> f64 {
    LEVEL_M * f64::from(road.layer.clamp(1, 4))
}

/// How much of a road that ends at a bridge can rise up to it: which of its ends, and metres to the next junction.
fn lead_m(ground: &[&Road], road: usize, vertex: usize, most_m: f64) -> Option<(usize, f64)> {
    let line = &ground[road].centreline;
    let end = match vertex {
        0 => 0,
        v if v + 1 == line.len() => 1,
        _ => return None,
    };
    let mut points = line.clone();
    if end == 1 {
        points.reverse();
    }
    let shared =
        |p: DVec2| ground.iter().enumerate().any(|(i, r)| i != road && r.centreline.iter().any(|&q| key(q) == key(p)));
    let mut length_m = 0.0;
    for pair in points.windows(2) {
        length_m += pair[0].distance(pair[1]);
        if length_m > most_m + JUNCTION_M || shared(pair[1]) {
            break;
        }
    }
    let metres = (length_m - JUNCTION_M).min(most_m);
    (metres > JUNCTION_M).then_some((end, metres))
}

//! The map's roads from junction to junction.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{Road, RoadKind, StreetMap, Turns};

use crate::geometry::path::Path;
use crate::roads::cross_section::{Use, cross_section};
use crate::roads::network::Stretch;

/// Corners of a junction are cut off by this much more than the other roads' width.
const CORNER_M: f64 = 2.0;
/// A junction reaches no further along a road than this.
const FARTHEST_M: f64 = 18.0;
/// Arms that differ by less than this angle from straight on go straight on.
const STRAIGHT_RAD: f64 = 0.6;

/// A road that leaves a junction.
#[derive(Clone, Copy)]
struct Arm {
    /// Away from the junction, unit.
    along: DVec2,
    half_m: f64,
    kind: RoadKind,
    /// Traffic may leave the junction on it.
    leaves: bool,
}

/// A place where roads for cars meet.
pub(super) struct Junction {
    pub(super) position: DVec2,
    arms: Vec<Arm>,
}

impl Junction {
    /// Where traffic that comes along `along` can go.
    pub(super) fn turns(&self, along: DVec2) -> Turns {
        let mut turns = Turns::default();
        for arm in self.arms.iter().filter(|arm| arm.leaves && arm.along.dot(along) > -0.85) {
            match along.angle_to(arm.along) {
                a if a > STRAIGHT_RAD => turns.left = true,
                a if a < -STRAIGHT_RAD => turns.right = true,
                _ => turns.through = true,
            }
        }
        turns
    }

    /// How far the roads that cross a road reach along it.
    fn reach_m(&self, along: DVec2) -> f64 {
        let sine = |arm: &Arm| arm.along.perp_dot(along).abs();
        let across = self.arms.iter().filter(|arm| sine(arm) > 0.4);
        across.map(|arm| arm.half_m / sine(arm) + CORNER_M).fold(0.0, f64::max).min(FARTHEST_M)
    }

    /// Whether a road that comes along `along` meets a more important one.
    pub(super) fn is_minor(&self, kind: RoadKind, along: DVec2) -> bool {
        self.arms.iter().any(|arm| arm.kind < kind && arm.along.perp_dot(along).abs() > 0.4)
    }

    /// Half of the side of the square that crossing traffic uses, and a direction of it; `None` for a merge.
    pub(super) fn square(&self) -> Option<(f64, DVec2)> {
        let first = self.arms.first()?.along;
        let half_m = self.arms.iter().map(|arm| arm.half_m).fold(0.0, f64::max);
        (self.arms.iter().any(|arm| arm.along.perp_dot(first).abs() > 0.8)).then_some((half_m, first))
    }
}

/// Vertices where three or more arms of roads for cars meet, by their place in centimetres.
pub(super) fn junctions(map: &StreetMap, on_left: bool) -> BTreeMap<[i64; 2], Junction> {
    let mut junctions: BTreeMap<[i64; 2], Junction> = BTreeMap::new();
    let roads = map.roads.iter().filter(|r| r.kind.is_for_cars() && r.kind < RoadKind::Service && !r.tunnel);
    for road in roads {
        let half_m = cross_section(road, road.width_m, on_left).width_m / 2.0;
        for (i, &p) in road.centreline.iter().enumerate() {
            let junction = junctions.entry(key(p)).or_insert_with(|| Junction { position: p, arms: Vec::new() });
            let before = i.checked_sub(1).map(|k| (road.centreline[k], !road.oneway));
            let after = road.centreline.get(i + 1).map(|&q| (q, true));
            for (q, leaves) in before.into_iter().chain(after) {
                let along = (q - p).normalize_or_zero();
                junction.arms.push(Arm { along, half_m, kind: road.kind, leaves });
            }
        }
    }
    junctions.retain(|_, j| j.arms.len() > 2);
    junctions
}

fn key(p: DVec2) -> [i64; 2] {
    (p * 100.0).round().as_i64vec2().to_array()
}

/// A road between two junctions.
pub(super) struct Leg<'a> {
    pub(super) stretch: &'a Stretch<'a>,
    pub(super) path: Path<'a>,
    /// Between these lengths no other road's traffic crosses.
    pub(super) from_m: f64,
    pub(super) to_m: f64,
    /// The junctions that it begins and ends at; `None` where the map or the recorded area does.
    pub(super) ends: [Option<&'a Junction>; 2],
    /// Tells it from others.
    pub(super) number: u64,
}

impl<'a> Leg<'a> {
    pub(super) fn road(&self) -> &'a Road {
        self.stretch.road
    }

    /// Lanes of a direction of travel, from the left to the right as driven, as (left, right) offsets of the line.
    pub(super) fn lanes(&self, usage: Use) -> Vec<(f64, f64)> {
        let bands = self.stretch.section.bands.iter().filter(|b| b.usage == usage);
        let mut lanes: Vec<(f64, f64)> = bands.map(|b| (b.left_m, b.right_m)).collect();
        if usage == Use::Backward {
            lanes.reverse();
        }
        lanes
    }

    pub(super) fn length_m(&self) -> f64 {
        self.to_m - self.from_m
    }
}

/// All legs of some stretches, in their order.
pub(super) fn legs<'a>(stretches: &'a [Stretch<'a>], junctions: &'a BTreeMap<[i64; 2], Junction>) -> Vec<Leg<'a>> {
    let mut legs = Vec::new();
    for stretch in stretches.iter().filter(|s| s.line.len() > 1) {
        let path = Path::new(&stretch.line);
        let met = |i: &usize| junctions.get(&key(stretch.line[*i]));
        let mut cuts: Vec<(f64, Option<&Junction>)> = vec![(0.0, met(&0))];
        cuts.extend((1..stretch.line.len() - 1).filter_map(|i| Some((path.vertex_m(i), Some(met(&i)?)))));
        cuts.push((path.length_m(), met(&(stretch.line.len() - 1))));
        for pair in cuts.windows(2) {
            let [(a_m, start), (b_m, end)] = [pair[0], pair[1]];
            let reach_m = |j: Option<&Junction>, s_m: f64| j.map_or(0.0, |j| j.reach_m(path.at(s_m).1));
            let (from_m, to_m) = (a_m + reach_m(start, a_m), b_m - reach_m(end, b_m));
            if to_m - from_m > 1.0 {
                let number = stretch.road.id as u64 ^ ((a_m * 100.0) as u64).rotate_left(40);
                legs.push(Leg { stretch, path: Path::new(&stretch.line), from_m, to_m, ends: [start, end], number });
            }
        }
    }
    legs
}

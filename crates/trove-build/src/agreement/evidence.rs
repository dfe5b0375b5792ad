//! What a recording tells of where a street map should lie.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};
use trove_model::{Bounds, Drive, DrivingSide, Keyframe, Polygon, Road, StreetMap};

use super::correction::Correction;
use super::walls::{WallPiece, wall_pieces};
use crate::geometry::path::closed;
use crate::geometry::segments::SegmentIndex;

/// Distance of places on a road, metres.
const STEP_M: f64 = 4.0;
/// Neighbouring places err alike: so far apart they tell something of their own, metres.
const ALIKE_M: f64 = 20.0;
/// Things run alike up to this angle (cosine of 20°).
const PARALLEL: f64 = 0.94;
/// A road's lanes are looked for within this; they lie side by side with gaps up to this, metres.
const LANE_REACH_M: f64 = 16.0;
const LANE_GAP_M: f64 = 6.0;
/// A carriageway is so wide, metres.
const MIN_WIDTH_M: f64 = 4.0;
const MAX_WIDTH_M: f64 = 22.0;
/// A wall's outline is looked for within this, metres.
const OUTLINE_REACH_M: f64 = 8.0;
/// The vehicle's own road is looked for within this, metres.
const ROAD_REACH_M: f64 = 15.0;
/// Width of a lane where none is tagged, metres.
const LANE_M: f64 = 3.3;
/// Walls count from this far above the vehicle's wheels up to this, and this far from the sensor, metres.
const WALL_M: RangeInclusive<f64> = 2.5..=15.0;
const WALL_REACH_M: f64 = 50.0;
/// What lies this far from the driven path counts half, metres.
const NEAR_M: f64 = 100.0;

/// The recorded side, which does not move.
pub(super) struct Evidence {
    lanes: SegmentIndex,
    /// Edges of what can be driven on, for places whose lanes have no centre lines.
    edges: SegmentIndex,
    /// Positions of the vehicle and where it looks.
    path: Vec<(DVec2, DVec2)>,
    walls: Vec<WallPiece>,
    bounds: Bounds,
    on_left: bool,
}

/// The map's side, which does.
pub(super) struct Movable<'a> {
    roads: Vec<&'a Road>,
    lines: SegmentIndex,
    outlines: SegmentIndex,
}

/// A place that should move along a direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pull {
    /// Where it is after the correction so far.
    pub at: DVec2,
    /// Unit.
    pub along: DVec2,
    /// How far.
    pub distance_m: f64,
    /// How many independent observations it is worth.
    pub weight: f64,
}

/// Where a map should move, by what says so.
#[derive(Debug, Default)]
pub(super) struct Pulls {
    /// Roads to the middle of the dataset's lanes.
    pub roads: Vec<Pull>,
    /// Roads to the vehicle, as far as it is not on their lanes.
    pub path: Vec<Pull>,
    /// Outlines to the walls that the LiDAR saw.
    pub facades: Vec<Pull>,
}

impl Pulls {
    pub(super) fn all(&self) -> impl Iterator<Item = &Pull> {
        self.roads.iter().chain(&self.path).chain(&self.facades)
    }
}

impl<'a> Movable<'a> {
    pub(super) fn new(map: &'a StreetMap) -> Self {
        let roads: Vec<&Road> = map.roads.iter().filter(|r| r.kind.is_for_cars() && !r.tunnel).collect();
        let low = map.buildings.iter().filter(|b| b.min_height_m < *WALL_M.start());
        let rings: Vec<Vec<DVec2>> = low.flat_map(|b| b.footprint.rings()).map(|ring| closed(ring)).collect();
        Self {
            lines: SegmentIndex::new(roads.iter().map(|r| r.centreline.as_slice())),
            roads,
            outlines: SegmentIndex::new(rings.iter().map(Vec::as_slice)),
        }
    }
}

impl Evidence {
    pub(super) fn new(drive: &Drive, driving_side: DrivingSide, bounds: Bounds) -> Self {
        let lanes = drive.lane_map.iter().flat_map(|map| &map.lanes);
        let drivable = drive.lane_map.iter().flat_map(|map| &map.drivable);
        let edges: Vec<Vec<DVec2>> = drivable.flat_map(Polygon::rings).map(|ring| closed(ring)).collect();
        let pose = |k: &Keyframe| {
            let forward = k.world_from_ego.rotation * DVec3::X;
            Some((k.world_from_ego.translation.truncate(), forward.truncate().try_normalize()?))
        };
        let walls = |k: &Keyframe| wall_pieces(k, WALL_REACH_M, WALL_M);
        Self {
            lanes: SegmentIndex::new(lanes.map(|lane| lane.centreline.as_slice())),
            edges: SegmentIndex::new(edges.iter().map(Vec::as_slice)),
            path: drive.keyframes.iter().filter_map(pose).collect(),
            walls: drive.keyframes.iter().flat_map(walls).collect(),
            bounds,
            on_left: driving_side.is_left(),
        }
    }

    /// The middle of the driven path; the area's where there is none.
    pub(super) fn middle(&self) -> DVec2 {
        let sum: DVec2 = self.path.iter().map(|(p, _)| *p).sum();
        if self.path.is_empty() { self.bounds.centre() } else { sum / self.path.len() as f64 }
    }

    /// Where a corrected map should still move.
    pub(super) fn pulls(&self, map: &Movable, correction: &Correction) -> Pulls {
        Pulls {
            roads: (0..map.roads.len()).flat_map(|road| self.along_road(road, map, correction)).collect(),
            path: self.path.iter().filter_map(|&pose| self.at_pose(pose, map, correction)).collect(),
            facades: self.at_walls(map, correction),
        }
    }

    /// Places nearer to where the cameras were count for more.
    fn nearness(&self, p: DVec2) -> f64 {
        let near_m = self.path.iter().map(|(q, _)| q.distance(p)).fold(f64::INFINITY, f64::min);
        if near_m.is_finite() { 1.0 / (1.0 + (near_m / NEAR_M).powi(2)) } else { 1.0 }
    }

    fn along_road(&self, number: usize, map: &Movable, correction: &Correction) -> Vec<Pull> {
        let (road, mut pulls) = (map.roads[number], Vec::new());
        for pair in road.centreline.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|p| correction.apply(p));
            let Some(ahead) = (b - a).try_normalize() else { continue };
            let count = (a.distance(b) / STEP_M).ceil();
            for i in 0..count as usize {
                let at = a.lerp(b, (i as f64 + 0.5) / count);
                if !self.bounds.contains(at) {
                    continue;
                }
                let is_alone = || {
                    let others =
                        map.lines.around(correction.undo(at), LANE_REACH_M).into_iter().filter(|o| o.0 != number);
                    others.filter_map(|(_, [a, b])| (b - a).try_normalize()).all(|o| o.dot(ahead).abs() < PARALLEL)
                };
                let middle_m = self.lanes_middle_m(at, ahead, road.oneway);
                let middle_m = middle_m.or_else(|| self.drivable_middle_m(at, ahead).filter(|_| is_alone()));
                if let Some(distance_m) = middle_m {
                    let weight = self.nearness(at) * (a.distance(b) / count / ALIKE_M);
                    pulls.push(Pull { at, along: ahead.perp(), distance_m, weight });
                }
            }
        }
        pulls
    }

    /// How far to the left the middle of the lanes side by side is: of those that run as a one-way road does, or of those
    /// of both directions; `None` where they are not there.
    fn lanes_middle_m(&self, at: DVec2, ahead: DVec2, oneway: bool) -> Option<f64> {
        let mut crossings: Vec<(f64, bool)> = Vec::new();
        for (_, [a, b]) in self.lanes.around(at, LANE_REACH_M) {
            let (from, to) = ((a - at).dot(ahead), (b - at).dot(ahead));
            let runs_ahead = to > from;
            let is_parallel = (to - from).abs() > PARALLEL * a.distance(b);
            if !is_parallel || (oneway && !runs_ahead) || (from < 0.0) == (to < 0.0) {
                continue;
            }
            let left_m = (a.lerp(b, from / (from - to)) - at).dot(ahead.perp());
            if left_m.abs() < LANE_REACH_M {
                crossings.push((left_m, runs_ahead));
            }
        }
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let nearest = (0..crossings.len()).min_by(|&i, &j| crossings[i].0.abs().total_cmp(&crossings[j].0.abs()))?;
        let (mut first, mut last) = (nearest, nearest);
        while first > 0 && crossings[first].0 - crossings[first - 1].0 < LANE_GAP_M {
            first -= 1;
        }
        while last + 1 < crossings.len() && crossings[last + 1].0 - crossings[last].0 < LANE_GAP_M {
            last += 1;
        }
        let of_both = crossings[first..=last].iter().any(|c| c.1) && crossings[first..=last].iter().any(|c| !c.1);
        (oneway || of_both).then_some((crossings[first].0 + crossings[last].0) / 2.0)
    }

    /// How far to the left the middle between the edges of what can be driven on is; `None` where a place lies outside or
    /// the edges run otherwise, as at junctions. A street with two carriageways has one such middle for both.
    fn drivable_middle_m(&self, at: DVec2, ahead: DVec2) -> Option<f64> {
        let (mut left_m, mut right_m) = (None::<(f64, bool)>, None::<(f64, bool)>);
        for (_, [a, b]) in self.edges.around(at, LANE_REACH_M) {
            let (from, to) = ((a - at).dot(ahead), (b - at).dot(ahead));
            if (from < 0.0) == (to < 0.0) {
                continue;
            }
            let crossing_m = (a.lerp(b, from / (from - to)) - at).dot(ahead.perp());
            let is_parallel = (to - from).abs() > PARALLEL * a.distance(b);
            let side = if crossing_m > 0.0 { &mut left_m } else { &mut right_m };
            if crossing_m.abs() < LANE_REACH_M && side.is_none_or(|(other_m, _)| crossing_m.abs() < other_m.abs()) {
                *side = Some((crossing_m, is_parallel));
            }
        }
        let ((left_m, left), (right_m, right)) = left_m.zip(right_m)?;
        (left && right && (MIN_WIDTH_M..MAX_WIDTH_M).contains(&(left_m - right_m))).then_some((left_m + right_m) / 2.0)
    }

    /// How far the vehicle is beside the lanes that lead its way, on the road that it drives along.
    fn at_pose(&self, (position, forward): (DVec2, DVec2), map: &Movable, correction: &Correction) -> Option<Pull> {
        let p = correction.undo(position);
        let candidates = map.lines.around(p, ROAD_REACH_M).into_iter().filter_map(|(i, [a, b])| {
            let road = map.roads[i];
            let direction = (b - a).try_normalize()?;
            let with = direction.dot(forward);
            let runs_alike = if road.oneway { with > PARALLEL } else { with.abs() > PARALLEL };
            let is_beside = (0.0..=a.distance(b)).contains(&(p - a).dot(direction));
            // To the left of travel.
            let travel = direction * with.signum();
            (runs_alike && is_beside).then_some((road, travel, travel.perp_dot(p - a)))
        });
        let (road, travel, left_m) = candidates.min_by(|a, b| a.2.abs().total_cmp(&b.2.abs()))?;
        let lanes = road.lanes.map_or(if road.oneway { 1.0 } else { 2.0 }, f64::from);
        let half_m = road.width_m.unwrap_or(lanes * LANE_M) / 2.0;
        let (low_m, high_m) = match (road.oneway, self.on_left) {
            (true, _) => (-half_m, half_m),
            (false, true) => (0.0, half_m),
            (false, false) => (-half_m, 0.0),
        };
        Some(Pull {
            at: position,
            along: correction.rotate(travel.perp()),
            distance_m: left_m - left_m.clamp(low_m, high_m),
            // The whole path is one observation.
            weight: 1.0 / self.path.len() as f64,
        })
    }

    fn at_walls(&self, map: &Movable, correction: &Correction) -> Vec<Pull> {
        let mut found: Vec<([i64; 2], Pull)> = Vec::new();
        let mut in_square: BTreeMap<[i64; 2], f64> = BTreeMap::new();
        for wall in &self.walls {
            let edges = map.outlines.around(correction.undo(wall.position), OUTLINE_REACH_M).into_iter();
            let fitting = edges.filter_map(|(_, [a, b])| {
                let [a, b] = [a, b].map(|p| correction.apply(p));
                let along = (b - a).try_normalize()?;
                let is_beside = (-1.0..=a.distance(b) + 1.0).contains(&(wall.position - a).dot(along));
                let distance_m = along.perp_dot(wall.position - a);
                let fits = is_beside && along.dot(wall.axis).abs() > PARALLEL && distance_m.abs() < OUTLINE_REACH_M;
                fits.then_some((along.perp(), distance_m))
            });
            let Some((along, distance_m)) = fitting.min_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) else { continue };
            let square = (wall.position / ALIKE_M).floor();
            let square = [square.x as i64, square.y as i64];
            *in_square.entry(square).or_default() += 1.0;
            found.push((square, Pull { at: wall.position, along, distance_m, weight: self.nearness(wall.position) }));
        }
        // A wall that is seen often, or in many pieces, is one wall all the same.
        found.into_iter().map(|(square, pull)| Pull { weight: pull.weight / in_square[&square], ..pull }).collect()
    }
}

//! Vehicles that stand at kerbs and in rows by a place's habit: where nobody was recorded, its streets are not empty.

use glam::DVec2;
use trove_model::{Cycleway, KerbParking, Parking, ParkingOrientation, Random, Road, RoadKind, Seed, Sides};

use super::motion::Motion;
use super::shares::{Doing, Shares};
use crate::geometry::path::Path;
use crate::geometry::segments::{Nearest, SegmentIndex};
use crate::roads::{Footing, Lane, LaneUse};
use crate::surroundings::{KERB_STEP_M, KerbPoint, Surroundings};

/// Vehicles are put so near to a standpoint, metres.
const REACH_M: f64 = 75.0;
/// From a parked vehicle's side to the kerb, metres.
const KERB_GAP_M: f64 = 0.15;
/// With one row of this width a street keeps this much for those who drive, metres.
const ROW_M: f64 = 2.0;
const PASSING_M: f64 = 2.8;
/// A street wider than this is measured no further, metres.
const WIDEST_M: f64 = 16.0;
/// Nobody parks so near to a corner or a crossing, metres.
const CORNER_M: f64 = 4.0;
const CROSSING_M: f64 = 5.0;
/// A kerb that turns more than this along a vehicle is a corner, as a cosine.
const STRAIGHT: f64 = 0.985;
/// Where a kerb is lower than this share of its height, a drive crosses it.
const DROPPED: f64 = 0.6;
/// Vehicles side by side are so far apart along their row, metres: perpendicular and diagonal.
const BESIDE_M: f64 = 2.5;
const SLANTED_M: f64 = 2.9;

/// Streets with a habit.
pub(super) struct Streets<'a> {
    around: &'a Surroundings<'a>,
    habit: KerbParking,
    roads: Vec<&'a Road>,
    lines: SegmentIndex,
    crossings: Vec<DVec2>,
}

impl<'a> Streets<'a> {
    /// Those of a place; `density` scales its habit, and nobody parks near `crossings`.
    pub(super) fn new(around: &'a Surroundings<'a>, density: f64, crossings: Vec<DVec2>) -> Self {
        let KerbParking { quiet, busy, rows } = around.place.locale.traffic.kerb_parking;
        let habit = KerbParking { quiet: quiet * density, busy: busy * density, rows: rows * density };
        let roads = around.place.map.iter().flat_map(|map| &map.roads);
        let roads: Vec<&Road> =
            roads.filter(|r| r.kind.is_for_cars() && r.layer == 0 && !r.bridge && !r.tunnel).collect();
        let lines = SegmentIndex::new(roads.iter().map(|road| road.centreline.as_slice()));
        Self { around, habit, roads, lines, crossings }
    }

    /// Whoever may be parked, row by row and kerb by kerb; some are in each other's way.
    pub(super) fn parked(&self, shares: &Shares, random: &mut Random) -> Vec<Motion> {
        let mut parked = Vec::new();
        for lane in &self.around.stand.surfaces.lanes {
            if let LaneUse::Parking(orientation) = lane.usage {
                self.fill_row(lane, orientation, shares, random, &mut parked);
            }
        }
        for run in &self.around.kerbs.runs {
            self.fill_kerb(run, shares, random, &mut parked);
        }
        parked
    }

    fn fill_row(
        &self,
        lane: &Lane,
        orientation: ParkingOrientation,
        shares: &Shares,
        random: &mut Random,
        parked: &mut Vec<Motion>,
    ) {
        let path = Path::new(&lane.line);
        let mut at_m = random.range(0.5, 1.5);
        while let Some((kind, size_m)) = shares.someone(Doing::Parked, random) {
            let slot_m = match orientation {
                ParkingOrientation::Parallel => size_m.x + random.range(0.7, 1.4),
                ParkingOrientation::Diagonal => SLANTED_M,
                ParkingOrientation::Perpendicular => BESIDE_M,
            };
            if at_m + slot_m > path.length_m() {
                break;
            }
            let (position, along) = path.at(at_m + slot_m / 2.0);
            at_m += slot_m;
            if !self.is_near(position) || !random.chance(self.habit.rows) {
                continue;
            }
            if let Some(looks) = in_row(self.around, lane, [position, along], random) {
                parked.push(Motion::parked(kind, size_m, position, looks, random));
            }
        }
    }

    fn fill_kerb(&self, run: &[KerbPoint], shares: &Shares, random: &mut Random, parked: &mut Vec<Motion>) {
        let mut i = 0;
        while i < run.len() {
            let Some(share) = self.share(&run[i]) else {
                i += 1;
                continue;
            };
            let Some((kind, size_m)) = shares.someone(Doing::Parked, random) else { return };
            let along = (size_m.x / KERB_STEP_M).ceil() as usize;
            if !self.has_room(run, i, along) {
                i += 1;
                continue;
            }
            if random.chance(share) {
                let middle = (run[i].position + run[i + along].position) / 2.0;
                let outward = (run[i].outward + run[i + along].outward).normalize_or(run[i].outward);
                let position = middle - outward * (size_m.y / 2.0 + KERB_GAP_M);
                parked.push(Motion::parked(kind, size_m, position, run[i].traffic, random));
            }
            i += along + random.index(2) + 1;
        }
    }

    /// How much of a kerb is taken where vehicles may stand at it; `None` where they may not.
    fn share(&self, kerb: &KerbPoint) -> Option<f64> {
        if !kerb.sidewalk || !self.is_near(kerb.position) {
            return None;
        }
        let Nearest { line, position, along, .. } = self.lines.nearest(kerb.position, WIDEST_M)?;
        let road = self.roads[line];
        let is_left = along.perp_dot(kerb.position - position) > 0.0;
        let at_side = |sides: Sides<Option<Parking>>| if is_left { sides.left } else { sides.right };
        let has_cycles = if is_left { road.cycleway.left } else { road.cycleway.right };
        // Rows are filled as rows, and what is forbidden is known.
        if at_side(road.parking).is_some() || has_cycles.is_some_and(|c| c != Cycleway::No) {
            return None;
        }
        let share = match road.kind {
            _ if road.link || road.roundabout => return None,
            RoadKind::Residential | RoadKind::Minor => self.habit.quiet,
            RoadKind::Tertiary | RoadKind::Secondary => self.habit.busy,
            _ => return None,
        };
        let rows = ((self.width_m(kerb) - PASSING_M) / ROW_M).floor();
        // Where a street has room for one row, it is on the same side all along.
        let is_its_side = Seed(road.id.unsigned_abs()).random().chance(0.5) == is_left;
        (rows >= 2.0 || rows >= 1.0 && is_its_side).then_some(share)
    }

    /// From a kerb across to the next.
    fn width_m(&self, kerb: &KerbPoint) -> f64 {
        const STEP_M: f64 = 0.2;
        let is_road = |m: f64| {
            let p = kerb.position - kerb.outward * m;
            self.around.stand.surfaces.footing(p) == Footing::Carriageway
        };
        let steps = (1..(WIDEST_M / STEP_M) as usize).map(|i| i as f64 * STEP_M);
        steps.take_while(|m| is_road(*m)).last().unwrap_or(0.0)
    }

    /// Whether a kerb is straight, whole and far from crossings for so many points from the `i`-th.
    fn has_room(&self, run: &[KerbPoint], i: usize, along: usize) -> bool {
        let beyond = (CORNER_M / KERB_STEP_M) as usize;
        let Some(stretch) = run.get(i.saturating_sub(beyond)..=i + along + beyond) else { return false };
        let surfaces = self.around.stand.surfaces;
        let is_whole = |k: &KerbPoint| {
            k.sidewalk && surfaces.elevation_m(k.position + k.outward * 0.3) > DROPPED * surfaces.kerb_m
        };
        let clear_m = CROSSING_M + along as f64 * KERB_STEP_M / 2.0;
        let middle = run[i + along / 2].position;
        i >= beyond
            && stretch.iter().all(|k| k.outward.dot(run[i].outward) > STRAIGHT)
            && run[i..=i + along].iter().all(is_whole)
            && self.crossings.iter().all(|p| p.distance_squared(middle) > clear_m * clear_m)
    }

    fn is_near(&self, p: DVec2) -> bool {
        let keyframes = &self.around.place.drive.keyframes;
        keyframes.iter().any(|k| k.world_from_ego.translation.truncate().distance_squared(p) < REACH_M * REACH_M)
    }
}

/// Where a vehicle looks in a row for parking, at a position on it where the row runs `along`; `None` where no kerb is
/// beside it.
pub(super) fn in_row(
    around: &Surroundings,
    lane: &Lane,
    [position, along]: [DVec2; 2],
    random: &mut Random,
) -> Option<DVec2> {
    let kerb = *around.kerbs.near(position, lane.width_m + 1.0).first()?;
    let into = if kerb.outward.dot(along.perp()) > 0.0 { along.perp() } else { -along.perp() };
    let (looks, is_parallel) = match lane.usage {
        LaneUse::Parking(ParkingOrientation::Perpendicular) => (into, false),
        LaneUse::Parking(ParkingOrientation::Diagonal) => ((into + along).normalize(), false),
        _ => (along * kerb.traffic.dot(along).signum(), true),
    };
    let backs_in = !is_parallel && random.chance(0.3);
    Some(if backs_in { -looks } else { looks })
}

//! Walls, railings and fences between sidewalks and the open land behind them, where the map has none.

use glam::DVec2;
use trove_model::{Land, LandKind, LineKind, Outcome, Polygon, Report, Road, RoadKind, Seed};

use super::layer::{Layer, ROAD_REACH_M, Run};
use super::yard::{as_often, words};
use crate::geometry::segments::SegmentIndex;
use crate::roads::Footing;
use crate::surroundings::{KERB_STEP_M, KerbPoint};

/// A sidewalk is at least and at most this deep, kerb and all, metres; its end is looked for in such steps.
const DEPTH_M: [f64; 2] = [0.8, 9.0];
const DEPTH_STEP_M: f64 = 0.3;
/// A boundary's middle stands this far behind the sidewalk, metres.
const BEHIND_M: f64 = 0.25;
/// Nothing but land lies within this behind it, and no building and no mapped line stands within these, metres.
const LAND_M: f64 = 1.2;
const OFF_BUILDINGS_M: f64 = 1.5;
const OFF_MAPPED_M: f64 = 3.0;
/// Where the sidewalk's depth jumps by more than this from one kerb point to the next the boundary ends, metres.
const JUMP_M: f64 = 0.4;
/// Neighbouring points of a boundary are this far apart, metres.
const APART_M: [f64; 2] = [0.3, 2.5];
/// A boundary of one kind is so long, and shorter ones are not built; the next begins behind a gate so wide, metres.
const LENGTH_M: [f64; 2] = [10.0, 60.0];
const SHORTEST_M: f64 = 4.0;
const GATE_M: [f64; 2] = [1.0, 3.5];
/// Height over the model's.
const HEIGHTS: [f64; 2] = [0.85, 1.1];

/// Lays what bounds the land along all sidewalks of streets.
pub(super) fn along_sidewalks(layer: &mut Layer<'_, '_, '_, '_>, seed: Seed, report: &Report) {
    let (around, customs) = (layer.yard.around, &layer.yard.locale.street);
    let Some(map) = around.place.map else { return };
    let streets: Vec<&Road> = map.roads.iter().filter(|r| r.kind.is_for_cars() && !r.tunnel).collect();
    let index = SegmentIndex::new(streets.iter().map(|r| r.centreline.as_slice()));
    let is_boundary = |kind| matches!(kind, LineKind::Fence | LineKind::Wall | LineKind::GuardRail | LineKind::Hedge);
    let mapped = map.lines.iter().filter(|l| is_boundary(l.kind)).map(|l| l.line.as_slice());
    // Squares are walked on, and building sites have their hoardings.
    let open: Vec<&Polygon> = map.land.iter().filter(|l| is_walked_on(l)).map(|l| &l.polygon).collect();
    let boundaries = as_often(&customs.boundaries);
    let plan = Plan { mapped: SegmentIndex::new(mapped), open };
    for (i, kerbs) in around.kerbs.runs.iter().enumerate() {
        let mut random = seed.nth(i as u64).random();
        let mut at = 0;
        while at < kerbs.len() {
            let points = (random.range(LENGTH_M[0], LENGTH_M[1]) / KERB_STEP_M) as usize;
            let gate = (random.range(GATE_M[0], GATE_M[1]) / KERB_STEP_M) as usize;
            let scale = random.range(HEIGHTS[0], HEIGHTS[1]);
            let model = random.pick(&boundaries).copied().filter(|_| random.chance(customs.boundary_share));
            let stretch = &kerbs[at..(at + points).min(kerbs.len())];
            at += points + gate;
            let (Some(model), Some(middle)) = (model, stretch.get(stretch.len() / 2)) else { continue };
            let street = index.nearest(middle.position, ROAD_REACH_M).map(|n| streets[n.line].kind);
            if street.is_none_or(|kind| kind == RoadKind::Service) || !layer.is_seen(middle.position) {
                continue;
            }
            for line in plan.lines(stretch, layer) {
                let line = layer.traffic_on_the_right(line);
                let tags = &words(&model.tags);
                layer.lay(&Run { kind: model.kind, tags, line: &line, scale, in_sight_m: Some(0.0) }, report);
                report.note(Outcome::Guessed, "boundary behind a sidewalk", model.tags.join("/"));
            }
        }
    }
}

fn is_walked_on(land: &Land) -> bool {
    matches!(land.kind, LandKind::Paved | LandKind::Construction)
}

/// What keeps boundaries away.
struct Plan<'m> {
    mapped: SegmentIndex,
    open: Vec<&'m Polygon>,
}

impl Plan<'_> {
    /// Where a boundary can stand along a stretch of kerb.
    fn lines(&self, stretch: &[KerbPoint], layer: &Layer<'_, '_, '_, '_>) -> Vec<Vec<DVec2>> {
        let (mut lines, mut line) = (Vec::new(), Vec::<DVec2>::new());
        let mut depth_before_m = 0.0;
        for kerb in stretch {
            let found = self.depth_m(kerb, layer);
            let at = found.map(|depth_m| kerb.position + kerb.outward * (depth_m + BEHIND_M));
            let step_m = line.last().zip(at).map(|(last, at)| last.distance(at));
            let jumps = found.is_some_and(|depth_m| (depth_m - depth_before_m).abs() > JUMP_M);
            if found.is_none() || (step_m.is_some() && jumps) || step_m.is_some_and(|m| m > APART_M[1]) {
                lines.push(std::mem::take(&mut line));
            }
            depth_before_m = found.unwrap_or(0.0);
            // Around a corner of the block the points come close to each other.
            if step_m.is_none_or(|m| m > APART_M[0]) {
                line.extend(at);
            }
        }
        lines.push(line);
        lines.retain(|l| l.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>() > SHORTEST_M);
        lines
    }

    /// How far behind the kerb open land begins; `None` where none does or it stays open.
    fn depth_m(&self, kerb: &KerbPoint, layer: &Layer<'_, '_, '_, '_>) -> Option<f64> {
        let surfaces = layer.yard.around.stand.surfaces;
        let footing = |depth_m: f64| surfaces.footing(kerb.position + kerb.outward * depth_m);
        if !kerb.sidewalk {
            return None;
        }
        let steps = ((DEPTH_M[1] - DEPTH_M[0]) / DEPTH_STEP_M) as usize;
        let depths = (0..=steps).map(|i| DEPTH_M[0] + DEPTH_STEP_M * i as f64);
        let mut beyond_m = depths.into_iter().find(|&d| footing(d) != Footing::Sidewalk)?;
        let mut within_m = beyond_m - DEPTH_STEP_M;
        for _ in 0..5 {
            let middle_m = (within_m + beyond_m) / 2.0;
            let is_sidewalk = footing(middle_m) == Footing::Sidewalk;
            *(if is_sidewalk { &mut within_m } else { &mut beyond_m }) = middle_m;
        }
        let at = kerb.position + kerb.outward * (beyond_m + BEHIND_M);
        let is_land = [0.0, 0.5, 1.0].iter().all(|t| footing(beyond_m + BEHIND_M + t * LAND_M) == Footing::Land);
        let is_free = layer.yard.clearance.building_distance_m(at) > OFF_BUILDINGS_M
            && self.mapped.nearest(at, OFF_MAPPED_M).is_none()
            && !self.open.iter().any(|polygon| polygon.contains(at));
        (is_land && is_free).then_some(beyond_m)
    }
}

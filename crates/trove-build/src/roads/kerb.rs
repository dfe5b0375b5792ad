//! Kerbs: how high they are, their stones' shape, and where they are dropped.

use glam::DVec2;
use trove_model::{Bounds, Drive, FurnitureKind, Polygon, RoadKind, StreetMap};

use super::network::Stretch;
use crate::geometry::plane::strip;

/// Width of a kerb stone.
pub(super) const STONE_M: f64 = 0.15;
/// Height of a dropped kerb.
pub(super) const LOW_M: f64 = 0.015;
/// The stone's front edge is cut by this much; its face leans as much into the gutter.
const CHAMFER_M: f64 = 0.02;
/// Width of a dropped kerb at a crossing that the map draws as a point or line.
const CROSSING_M: f64 = 3.0;
/// A crossing is at most this much longer than its road is wide, at each end.
const BEYOND_M: f64 = 1.2;
/// Half of a crossing's length where the road's width is not at hand.
const HALF_LENGTH_M: f64 = 9.0;

/// A stone's front from the road to its top, as distance into the carriageway and height.
pub(super) fn profile(kerb_m: f64) -> [DVec2; 3] {
    [
        // A little below the road, so that no light comes through.
        DVec2::new(1.2 * CHAMFER_M, -0.01),
        DVec2::new(CHAMFER_M, kerb_m - CHAMFER_M),
        DVec2::new(0.0, kerb_m),
    ]
}

/// Where kerbs are dropped: at crossings and at the mouths of driveways.
pub(super) fn dropped(
    drive: &Drive,
    map: Option<&StreetMap>,
    stretches: &[Stretch<'_>],
    bounds: Bounds,
) -> Vec<Polygon> {
    let recorded = drive.lane_map.iter().flat_map(|m| &m.crossings).cloned();
    let mut dropped: Vec<Polygon> = recorded.collect();
    let Some(map) = map else { return dropped };
    let inside = |p: &DVec2| bounds.contains(*p);
    let ways = map.roads.iter().filter(|r| r.kind == RoadKind::Crossing && r.centreline.iter().any(inside));
    dropped.extend(ways.flat_map(|r| strip(&lengthened(&r.centreline), CROSSING_M / 2.0)));
    let points = map.furniture.iter().filter(|f| f.kind == FurnitureKind::Crossing && inside(&f.position));
    for at in points.map(|f| f.position) {
        let on = stretches.iter().find_map(|s| {
            let i = s.line.iter().position(|p| p.distance(at) < 0.05)?;
            let (before, after) = (s.line[i.saturating_sub(1)], s.line[(i + 1).min(s.line.len() - 1)]);
            Some(((after - before).normalize_or_zero().perp(), (s.width_m / 2.0 + BEYOND_M).min(HALF_LENGTH_M)))
        });
        if let Some((across, half_m)) = on {
            dropped.extend(strip(&[at - across * half_m, at + across * half_m], CROSSING_M / 2.0));
        }
    }
    dropped.extend(stretches.iter().filter(|s| s.road.kind == RoadKind::Service).flat_map(|s| mouths(s, stretches)));
    dropped
}

/// A crossing up to the sidewalk: mapped ones end on the kerb, more or less.
fn lengthened(line: &[DVec2]) -> Vec<DVec2> {
    let mut line = line.to_vec();
    let n = line.len();
    let (first, last) = ((line[0] - line[1]).normalize_or_zero(), (line[n - 1] - line[n - 2]).normalize_or_zero());
    line[0] += first * BEYOND_M;
    line[n - 1] += last * BEYOND_M;
    line
}

/// Where a driveway leaves a wider road: its first metres beyond that road's kerb, a little wider than itself.
fn mouths(driveway: &Stretch<'_>, stretches: &[Stretch<'_>]) -> Vec<Polygon> {
    let mut reversed = driveway.line.clone();
    reversed.reverse();
    let mut mouths = Vec::new();
    for line in [&driveway.line, &reversed] {
        let is_end =
            |s: &&Stretch<'_>| s.road.kind < RoadKind::Service && s.line.iter().any(|p| p.distance(line[0]) < 0.05);
        let Some(road) = stretches.iter().filter(is_end).max_by(|a, b| a.width_m.total_cmp(&b.width_m)) else {
            continue;
        };
        let along = (line[1] - line[0]).normalize_or_zero();
        let from = line[0] + along * (road.width_m / 2.0 - 1.0);
        mouths.extend(strip(&[from, from + along * 4.0], driveway.width_m / 2.0 + 1.0));
    }
    mouths
}

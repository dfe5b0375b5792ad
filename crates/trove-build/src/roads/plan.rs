//! What of the roads is told of: areas in the plane, lanes and lines on the ground.

use glam::{DVec2, DVec3};
use trove_model::{LaneUsage, PaintedLine, PlannedLane, Polygon, RoadPlan};

use super::course::{Lane, LaneUse};
use super::layout::Layout;
use super::markings::Markings;
use super::network::resampled;
use super::wear::PAINT_M;
use crate::geometry::path::closed;
use crate::geometry::segments::SegmentIndex;
use crate::ground::Drape;

/// What is this near to a kerb is at its foot, metres.
const FOOT_M: f64 = 0.01;

/// The plan of what was laid out and painted.
pub(super) fn plan(layout: &Layout<'_>, markings: &Markings, lanes: &[Lane], drape: &Drape<'_>) -> RoadPlan {
    let lifted = |line: &[DVec2], lift_m: f64| -> Vec<DVec3> {
        line.iter().map(|&p| p.extend(drape.height_m(p) + lift_m)).collect()
    };
    let lane = |lane: &Lane| PlannedLane {
        centreline: lifted(&lane.line, 0.0),
        width_m: lane.width_m,
        usage: match lane.usage {
            LaneUse::Driving => LaneUsage::Driving,
            LaneUse::Cycling => LaneUsage::Cycling,
            LaneUse::Parking(_) => LaneUsage::Parking,
        },
    };
    let line = |painted: &super::markings::Line| PaintedLine {
        points: lifted(&painted.line, PAINT_M),
        paint: painted.paint,
        pattern: painted.pattern,
        width_m: painted.width_m,
    };
    RoadPlan {
        drivable: layout.carriageway.clone(),
        walkways: [&layout.kerb[..], &layout.pavement].concat(),
        crossings: markings.crossings.clone(),
        lanes: lanes.iter().map(lane).collect(),
        lines: markings.lines.iter().map(line).collect(),
        kerbs: kerbs(layout).iter().map(|line| lifted(line, 0.0)).collect(),
    }
}

/// The parts of the carriageway's outlines that run along kerbs.
fn kerbs(layout: &Layout<'_>) -> Vec<Vec<DVec2>> {
    let stones: Vec<Vec<DVec2>> = layout.kerb.iter().flat_map(Polygon::rings).map(|ring| closed(ring)).collect();
    let stones = SegmentIndex::new(stones.iter().map(Vec::as_slice));
    let at_foot = |p: DVec2| stones.nearest(p, FOOT_M).is_some();
    let mut kerbs = Vec::new();
    for polygon in layout.carriageway.iter().map(|p| p.clone().oriented()) {
        for ring in polygon.rings() {
            let line = resampled(&closed(ring));
            // Both ends may be corners of other kerbs.
            let pairs: Vec<_> = line.windows(2).map(|p| (p, at_foot(p[0].midpoint(p[1])))).collect();
            let runs = pairs.chunk_by(|a, b| a.1 == b.1).filter(|run| run[0].1);
            kerbs.extend(runs.map(|run| {
                let ends = run.iter().map(|(pair, _)| pair[1]);
                std::iter::once(run[0].0[0]).chain(ends).collect::<Vec<_>>()
            }));
        }
    }
    kerbs
}

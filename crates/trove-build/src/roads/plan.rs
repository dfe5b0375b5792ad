//! What of the roads is told of: areas in the plane, lanes and lines on the ground.

use glam::{DVec2, DVec3};
use trove_model::{LaneUsage, PaintedLine, PlannedLane, RoadPlan};

use super::course::{Lane, LaneUse};
use super::layout::Layout;
use super::markings::Markings;
use super::wear::PAINT_M;
use crate::ground::Drape;

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
    }
}

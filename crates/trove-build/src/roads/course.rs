//! How traffic uses the carriageway: where its roads run, and their lanes from the left to the right.

use glam::DVec2;
use trove_model::{Drive, ParkingOrientation, Polygon};

use super::corners::Node;
use super::cross_section::{Band, Use};
use super::network::Stretch;
use crate::geometry::path::shifted;
use crate::geometry::plane::strip;

/// Nothing is parked this near to a crossing.
const CROSSING_CLEAR_M: f64 = 4.0;
/// A road or one recorded lane: strips along it stay on the carriageway.
#[derive(Clone, Debug)]
pub(super) struct Course {
    /// The middle of the carriageway or of the recorded lane, metres; bands are measured from it.
    pub line: Vec<DVec2>,
    /// Lanes from the left to the right, seen along the line; at least one.
    pub bands: Vec<Band>,
}

/// A lane of a road as it is built.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lane {
    /// Its middle, in the direction in which it is driven, or in which what is parked looks; at least two vertices.
    pub line: Vec<DVec2>,
    /// From edge to edge.
    pub width_m: f64,
    /// What it is for.
    pub usage: LaneUse,
}

/// What a lane is for, whichever way it runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LaneUse {
    /// Cars, and whoever rides among them.
    Driving,
    /// Bicycles alone.
    Cycling,
    /// Vehicles stand here.
    Parking(ParkingOrientation),
}

/// The lanes of all courses; those for bicycles and for parking run as the nearest lane beside them that is driven.
pub(super) fn lanes(courses: &[Course]) -> Vec<Lane> {
    let lanes_of = |course: &Course| -> Vec<Lane> {
        let middle_m = |band: &Band| (band.left_m + band.right_m) / 2.0;
        let driven = course.bands.iter().filter(|b| matches!(b.usage, Use::Forward | Use::Backward));
        let lane = |band: &Band| {
            let apart_m = |other: &&Band| (middle_m(other) - middle_m(band)).abs();
            let nearest = driven.clone().min_by(|a, b| apart_m(a).total_cmp(&apart_m(b)));
            let mut line = shifted(&course.line, middle_m(band));
            if nearest.is_some_and(|n| n.usage == Use::Backward) {
                line.reverse();
            }
            let usage = match band.usage {
                Use::Forward | Use::Backward => LaneUse::Driving,
                Use::Cycle => LaneUse::Cycling,
                Use::Parking(orientation) => LaneUse::Parking(orientation),
            };
            Lane { line, width_m: band.width_m(), usage }
        };
        course.bands.iter().map(lane).collect()
    };
    courses.iter().filter(|c| c.line.len() > 1).flat_map(lanes_of).collect()
}

/// All roads of a place: the recorded lanes, then what the map adds.
pub(super) fn courses(drive: &Drive, stretches: &[Stretch<'_>], bays: &[Bay]) -> Vec<Course> {
    let recorded = drive.lane_map.iter().flat_map(|m| &m.lanes).filter(|l| l.centreline.len() > 1).map(|lane| {
        let length_m: f64 = lane.centreline.windows(2).map(|w| w[0].distance(w[1])).sum();
        let half_m = (lane.polygon.area_m2() / length_m.max(1.0) / 2.0).clamp(1.2, 3.0);
        let band = Band { usage: Use::Forward, left_m: half_m, right_m: -half_m };
        Course { line: lane.centreline.clone(), bands: vec![band] }
    });
    let mapped =
        stretches.iter().map(|stretch| Course { line: stretch.line.clone(), bands: stretch.section.bands.clone() });
    let bays = bays.iter().map(|bay| Course { line: bay.line.clone(), bands: vec![bay.band] });
    recorded.chain(mapped).chain(bays).filter(|c| !c.bands.is_empty()).collect()
}

/// A row of bays beside a road, between its junctions and crossings.
#[derive(Clone, Debug)]
pub(super) struct Bay {
    /// The road's line along it.
    pub line: Vec<DVec2>,
    pub band: Band,
}

impl Bay {
    /// Its area, a little over the kerb that it replaces.
    pub(super) fn area(&self) -> Vec<Polygon> {
        let middle_m = (self.band.left_m + self.band.right_m) / 2.0;
        strip(&shifted(&self.line, middle_m), self.band.width_m() / 2.0 + 0.01)
    }
}

/// The bays of all stretches, away from where roads meet and people cross.
pub(super) fn bays(stretches: &[Stretch<'_>], nodes: &[Node], crossings: &[Polygon]) -> Vec<Bay> {
    let mut bays = Vec::new();
    for stretch in stretches.iter().filter(|s| s.section.bays.iter().any(Option::is_some)) {
        let clear = |p: DVec2| {
            !nodes.iter().any(|n| n.arms > 2 && n.at.distance(p) < n.reach_m())
                && !crossings.iter().any(|c| c.contains(p) || c.edge_distance_m(p) < CROSSING_CLEAR_M)
        };
        let runs = stretch.line.chunk_by(|&a, &b| clear(a) && clear(b)).filter(|run| run.len() > 2);
        for run in runs {
            let bay = |band: &Band| Bay { line: run.to_vec(), band: *band };
            bays.extend(stretch.section.bays.iter().flatten().map(bay));
        }
    }
    bays
}

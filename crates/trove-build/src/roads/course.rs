//! How traffic uses the carriageway: where its roads run, and their lanes from the left to the right.

use glam::DVec2;
use trove_model::{Cycleway, Drive, Parking, ParkingOrientation, Polygon, Road, RoadKind};

use super::corners::Node;
use super::layout::shifted;
use super::network::Stretch;
use crate::geometry::plane::strip;

/// Between the outermost lane and the kerb, metres.
pub(super) const GUTTER_M: f64 = 0.25;
/// Width of a marked lane for bicycles.
const CYCLE_LANE_M: f64 = 1.6;
/// Nothing is parked this near to a crossing.
const CROSSING_CLEAR_M: f64 = 4.0;
/// A carriageway is at least this wide.
const NARROWEST_M: f64 = 3.0;

/// A road or one recorded lane: strips along it stay on the carriageway.
#[derive(Clone, Debug)]
pub(super) struct Course {
    /// The middle of the carriageway or of the recorded lane, metres; bands are measured from it.
    pub line: Vec<DVec2>,
    /// Lanes from the left to the right, seen along the line; at least one.
    pub bands: Vec<Band>,
}

/// What a lane is for; directions are the line's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Use {
    Forward,
    Backward,
    Cycle,
    /// Cars stand here, within the carriageway or in bays beside it.
    Parking(ParkingOrientation),
}

/// A lane: between two distances to the left of a line, the left one larger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Band {
    pub usage: Use,
    pub left_m: f64,
    pub right_m: f64,
}

impl Band {
    pub(super) fn width_m(&self) -> f64 {
        self.left_m - self.right_m
    }
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

/// A road cut across.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CrossSection {
    /// Lanes from the left to the right, without bays.
    pub bands: Vec<Band>,
    /// Bays beside the carriageway on the left and on the right.
    pub bays: [Option<Band>; 2],
    /// From kerb to kerb, without bays; the middle is the road's line.
    pub width_m: f64,
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

/// A road's lanes by its tags, else by its kind; `kerb_to_kerb_m` is its width where that is known.
pub(super) fn cross_section(road: &Road, kerb_to_kerb_m: Option<f64>, on_left: bool) -> CrossSection {
    let (forward, backward) = lane_counts(road);
    let lane_m = usual_lane_m(road, forward + backward);
    // From the left to the right: what stands or cycles at the left edge, lanes of the left half, then the right.
    let along = |usage, n: u32| std::iter::repeat_n((usage, lane_m), n as usize);
    let [left, right] = [
        edge(road, road.parking.left, road.cycleway.left, on_left || !road.oneway),
        edge(road, road.parking.right, road.cycleway.right, !on_left || !road.oneway),
    ];
    let (first, second) = if on_left {
        ((Use::Forward, forward), (Use::Backward, backward))
    } else {
        ((Use::Backward, backward), (Use::Forward, forward))
    };
    let mut widths: Vec<(Use, f64)> = left;
    widths.extend(along(first.0, first.1).chain(along(second.0, second.1)));
    widths.extend(right.into_iter().rev());

    let sum_m: f64 = widths.iter().map(|(_, width_m)| width_m).sum();
    let width_m = kerb_to_kerb_m.unwrap_or(sum_m + 2.0 * GUTTER_M).max(NARROWEST_M);
    let scale = (width_m - 2.0 * GUTTER_M) / sum_m;
    let mut at_m = width_m / 2.0 - GUTTER_M;
    let bands = widths
        .into_iter()
        .map(|(usage, usual_m)| {
            let left_m = at_m;
            at_m -= usual_m * scale;
            Band { usage, left_m, right_m: at_m }
        })
        .collect();
    let half_m = width_m / 2.0;
    let bay = |parking| match parking {
        Some(Parking::Bays(orientation)) => Some((Use::Parking(orientation), parking_m(orientation))),
        _ => None,
    };
    let bays = [
        bay(road.parking.left).map(|(usage, m)| Band { usage, left_m: half_m + m, right_m: half_m }),
        bay(road.parking.right).map(|(usage, m)| Band { usage, left_m: -half_m, right_m: -half_m - m }),
    ];
    CrossSection { bands, bays, width_m }
}

/// What lies at one edge of the carriageway, from the kerb inwards.
fn edge(road: &Road, parking: Option<Parking>, cycleway: Option<Cycleway>, is_own_side: bool) -> Vec<(Use, f64)> {
    let mut widths = Vec::new();
    match parking {
        Some(Parking::Lane(orientation)) => widths.push((Use::Parking(orientation), parking_m(orientation))),
        // One-way streets with houses usually have a row of parked cars.
        None if road.oneway && is_own_side && is_quiet(road) && road.width_m.is_none() => {
            widths.push((Use::Parking(ParkingOrientation::Parallel), 2.0));
        }
        _ => {}
    }
    if cycleway == Some(Cycleway::Lane) {
        widths.push((Use::Cycle, CYCLE_LANE_M));
    }
    widths
}

fn is_quiet(road: &Road) -> bool {
    road.kind == RoadKind::Residential && road.lanes.is_none_or(|l| l <= 1) && !road.link && !road.roundabout
}

fn parking_m(orientation: ParkingOrientation) -> f64 {
    match orientation {
        ParkingOrientation::Parallel => 2.0,
        ParkingOrientation::Diagonal => 4.3,
        ParkingOrientation::Perpendicular => 4.9,
    }
}

/// Lanes in the way's direction and against it.
fn lane_counts(road: &Road) -> (u32, u32) {
    let usual = match (road.kind, road.oneway) {
        _ if road.link || road.roundabout => 1,
        (RoadKind::Motorway | RoadKind::Trunk, true) | (RoadKind::Primary, true) => 2,
        (RoadKind::Motorway | RoadKind::Trunk | RoadKind::Primary, false) => 4,
        (RoadKind::Secondary, true) => 2,
        (_, true) => 1,
        (RoadKind::Service, false) => 1,
        _ => 2,
    };
    let lanes = road.lanes.filter(|l| (1..=12).contains(l)).unwrap_or(usual);
    if road.oneway {
        return (lanes, 0);
    }
    let backward = road.lanes_backward.filter(|&b| b < lanes).unwrap_or(lanes / 2);
    (lanes - backward, backward)
}

fn usual_lane_m(road: &Road, lanes: u32) -> f64 {
    match road.kind {
        RoadKind::Motorway | RoadKind::Trunk => 3.6,
        RoadKind::Primary | RoadKind::Secondary => 3.4,
        // One lane for both directions: cars meet in gaps.
        RoadKind::Service if road.oneway => 3.2,
        RoadKind::Service if lanes == 1 => 4.4,
        RoadKind::Service => 2.75,
        _ if lanes == 1 && !road.oneway => 4.4,
        _ => 3.2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Sides;

    fn road(kind: RoadKind) -> Road {
        crate::testing::road(1, kind, &[[0.0, 0.0], [100.0, 0.0]])
    }

    fn uses(section: &CrossSection) -> Vec<Use> {
        section.bands.iter().map(|b| b.usage).collect()
    }

    #[test]
    fn lanes_lie_side_by_side_between_the_gutters() {
        let lane = Some(Parking::Lane(ParkingOrientation::Parallel));
        let road = Road {
            lanes: Some(3),
            lanes_backward: Some(1),
            parking: Sides { left: None, right: lane },
            cycleway: Sides { left: None, right: Some(Cycleway::Lane) },
            ..road(RoadKind::Secondary)
        };
        let section = cross_section(&road, None, false);
        let parking = Use::Parking(ParkingOrientation::Parallel);
        assert_eq!(uses(&section), [Use::Backward, Use::Forward, Use::Forward, Use::Cycle, parking]);
        assert!(section.bands.windows(2).all(|w| (w[0].right_m - w[1].left_m).abs() < 1e-9));
        assert!((section.bands[0].left_m - (section.width_m / 2.0 - GUTTER_M)).abs() < 1e-9);
        assert!((section.bands[4].right_m + (section.width_m / 2.0 - GUTTER_M)).abs() < 1e-9);
        assert!((section.width_m - (3.0 * 3.4 + 1.6 + 2.0 + 0.5)).abs() < 1e-9);
    }

    #[test]
    fn the_driven_side_is_the_countrys_and_a_known_width_is_shared_out() {
        let section = cross_section(&road(RoadKind::Tertiary), Some(8.5), true);
        assert_eq!(uses(&section), [Use::Forward, Use::Backward]);
        assert_eq!(section.bands[0].width_m(), 4.0);
    }

    #[test]
    fn bays_lie_beside_the_carriageway() {
        let bays = Some(Parking::Bays(ParkingOrientation::Perpendicular));
        let road = Road { parking: Sides { left: bays, right: None }, ..road(RoadKind::Tertiary) };
        let section = cross_section(&road, None, false);
        let bay = section.bays[0].unwrap();
        assert_eq!(bay.right_m, section.width_m / 2.0);
        assert!((bay.width_m() - parking_m(ParkingOrientation::Perpendicular)).abs() < 1e-9);
        assert_eq!(section.bays[1], None);
    }
}

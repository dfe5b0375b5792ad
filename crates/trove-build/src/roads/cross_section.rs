//! A road cut across: its lanes from the left to the right, by its tags or its kind.

use trove_model::{Cycleway, Parking, ParkingOrientation, Road, RoadKind};

/// Between the outermost lane and the kerb, metres.
pub(super) const GUTTER_M: f64 = 0.25;
/// Width of a marked lane for bicycles.
const CYCLE_LANE_M: f64 = 1.6;
/// A carriageway is at least this wide.
const NARROWEST_M: f64 = 3.0;

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

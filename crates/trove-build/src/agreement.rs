//! How well a street map and a drive agree.

use glam::DVec2;
use trove_model::{Bounds, Drive, Outcome, Report, StreetMap};

use crate::segments::SegmentIndex;

/// Further away than this is no road of that lane, metres: the distance counts as this much.
const REACH_M: f64 = 200.0;
/// Steps along lines, metres.
const STEP_M: f64 = 2.0;
/// Above this, map and drive do not lie on each other, metres.
const LIMIT_M: f64 = 5.0;

/// Distances of a drive to the roads of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Agreement {
    /// Median distance of the driven path to the nearest road for cars, metres; `None` without a path or a road.
    pub path_to_road_median_m: Option<f64>,
    /// The same of the dataset's lane centres; `None` without lanes or a road.
    pub lane_to_road_median_m: Option<f64>,
}

/// Measures how far the driven path and the dataset's lanes within the drive's area lie from the map's roads.
pub fn agreement(drive: &Drive, map: &StreetMap) -> Agreement {
    let roads = map.roads.iter().filter(|r| r.kind.is_for_cars() && r.centreline.len() > 1);
    let index = SegmentIndex::new(roads.clone().map(|r| r.centreline.as_slice()));
    if roads.count() == 0 {
        return Agreement::default();
    }
    let bounds = crate::area(drive);
    let path: Vec<DVec2> = drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let lanes = drive.lane_map.iter().flat_map(|m| &m.lanes);
    let centres: Vec<DVec2> = lanes
        .flat_map(
            |lane| if lane.centreline.len() > 1 { steps(&lane.centreline) } else { vec![lane.polygon.centroid()] },
        )
        .filter(|p| bounds.is_some_and(|b: Bounds| b.contains(*p)))
        .collect();
    Agreement {
        path_to_road_median_m: median_distance_m(&index, &path),
        lane_to_road_median_m: median_distance_m(&index, &centres),
    }
}

impl Agreement {
    /// Writes it to a report, with a warning where map and drive do not lie on each other.
    pub(crate) fn report(&self, drive: &Drive, report: &Report) {
        let rows = [
            ("map.path_to_road_median_m", self.path_to_road_median_m),
            ("map.lane_to_road_median_m", self.lane_to_road_median_m),
        ];
        for (name, value) in rows {
            let Some(value_m) = value else { continue };
            report.measure(name, value_m);
            if value_m > LIMIT_M {
                let example = format!("{}: {name} is {value_m:.1}", drive.id);
                report.note(Outcome::Warned, "street map and drive do not lie on each other", example);
            }
        }
        if self.path_to_road_median_m.is_none() {
            report.note(Outcome::Warned, "street map has no road for cars around the drive", &drive.id);
        }
    }
}

/// Points along a line.
fn steps(line: &[DVec2]) -> Vec<DVec2> {
    let mut points = Vec::new();
    for pair in line.windows(2) {
        let count = (pair[0].distance(pair[1]) / STEP_M).ceil().max(1.0);
        points.extend((0..count as usize).map(|i| pair[0].lerp(pair[1], i as f64 / count)));
    }
    points
}

fn median_distance_m(index: &SegmentIndex, points: &[DVec2]) -> Option<f64> {
    let distance_m = |p: &DVec2| index.nearest(*p, REACH_M).map_or(REACH_M, |n| n.distance_m);
    let mut distances_m: Vec<f64> = points.iter().map(distance_m).collect();
    distances_m.sort_by(f64::total_cmp);
    distances_m.get(distances_m.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn a_map_beside_the_drive_is_measured_and_warned_about() {
        for (shift_m, warned) in [(1.5, false), (9.0, true)] {
            let map = testing::map_with_road([[-300.0, -shift_m], [300.0, -shift_m]]);
            let found = agreement(&testing::drive(), &map);
            assert!((found.path_to_road_median_m.unwrap() - shift_m).abs() < 1e-9);
            assert!((found.lane_to_road_median_m.unwrap() - (shift_m + 4.0)).abs() < 1e-9);
            let report = Report::default();
            found.report(&testing::drive(), &report);
            let path = |e: &trove_model::Entry| e.examples.iter().any(|x| x.contains("path"));
            assert_eq!(report.entries().iter().any(path), warned);
        }
        assert_eq!(agreement(&testing::drive(), &StreetMap::default()), Agreement::default());
    }
}

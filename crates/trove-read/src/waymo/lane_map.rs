//! Map features → `LaneMap` around the drive.
//!
//! Waymo's map has lines where ours has areas: a lane is as wide as the lines and edges beside it leave it, and vehicles
//! can drive as far as the road's edge.

use std::collections::HashMap;

use glam::{DVec2, IVec2};
use trove_model::{Bounds, Lane, LaneMap, Outcome, Polygon, Report};

use super::poses::FARTHEST_M;
use super::records::{MapFeature, MapForm};

/// What lies farther from the driven path is left out, metres.
const REACH_M: f64 = 400.0;
/// Half of a lane that nothing bounds, and of a lane for bicycles, metres.
const HALF_LANE_M: f64 = 1.75;
const HALF_BICYCLE_LANE_M: f64 = 0.75;
/// Lines farther from the middle of a lane are another lane's, metres.
const WIDEST_HALF_LANE_M: f64 = 2.6;
/// A road's edge nearer than this to the middle of a lane ends the carriageway; cars park between, metres.
const EDGE_REACH_M: f64 = 5.5;
/// Side of a cell in which lines are looked up, and distance of the stations along a lane, metres.
const CELL_M: f64 = 8.0;
const STATION_M: f64 = 2.0;

/// Segments of lines, by where they are.
#[derive(Default)]
struct Lines {
    cells: HashMap<IVec2, Vec<(DVec2, DVec2)>>,
}

/// The map around a driven path; `None` where the segment has none.
pub(super) fn of(features: &[MapFeature], world_from_map_m: DVec2, path: &[DVec2], report: &Report) -> Option<LaneMap> {
    if features.is_empty() {
        return None;
    }
    let reach = Bounds::around(path.iter().copied())?.grown(REACH_M);
    let world = |line: &[DVec2]| -> Vec<DVec2> {
        let mut line: Vec<_> = line.iter().map(|p| *p + world_from_map_m).collect();
        line.dedup();
        let is_sound = line.iter().all(|p| p.abs().max_element() < FARTHEST_M);
        if !is_sound {
            report.note(Outcome::Dropped, "Waymo map feature with an absurd position", "");
        }
        if is_sound && line.iter().any(|p| reach.contains(*p)) { line } else { Vec::new() }
    };
    let (mut marks, mut edges, mut map) = (Lines::default(), Lines::default(), LaneMap::default());
    for feature in features {
        match &feature.form {
            MapForm::RoadLine { is_between_directions, line } => {
                let line = world(line);
                marks.add(&line);
                if line.len() >= 2 {
                    if *is_between_directions { &mut map.road_dividers } else { &mut map.lane_dividers }.push(line);
                }
            }
            MapForm::RoadEdge(line) => edges.add(&world(line)),
            MapForm::Crosswalk(outline) => map.crossings.extend(area(world(outline))),
            MapForm::Driveway(outline) => map.drivable.extend(area(world(outline))),
            MapForm::Lane { .. } => {}
            MapForm::Other => report.note(Outcome::Dropped, "Waymo map feature that is not used", feature.id),
        }
    }
    for feature in features {
        let MapForm::Lane { is_for_bicycles, line } = &feature.form else { continue };
        let line = world(line);
        if line.len() < 2 {
            continue;
        }
        report.note(Outcome::Guessed, "width of a Waymo lane, from the lines beside it", feature.id);
        let half_m = if *is_for_bicycles { HALF_BICYCLE_LANE_M } else { HALF_LANE_M };
        let beside = |at: DVec2, aside: DVec2| {
            let nearest = |lines: &Lines, reach_m| lines.along(at, aside, reach_m);
            nearest(&marks, WIDEST_HALF_LANE_M).or(nearest(&edges, WIDEST_HALF_LANE_M)).unwrap_or(half_m)
        };
        let to_edge = |at: DVec2, aside: DVec2| {
            let lane_m = beside(at, aside);
            edges.along(at, aside, EDGE_REACH_M).map_or(lane_m, |edge_m| edge_m.max(lane_m))
        };
        let stations = stations(&line);
        map.drivable.extend(area(widened(&stations, to_edge)));
        let Some(polygon) = area(widened(&stations, beside)) else { continue };
        map.lanes.push(Lane { token: feature.id.to_string(), polygon, centreline: line });
    }
    Some(map)
}

/// An area; `None` for an outline of nothing.
fn area(outline: Vec<DVec2>) -> Option<Polygon> {
    let polygon = Polygon::simple(outline).oriented();
    (polygon.exterior.len() >= 3 && polygon.area_m2() > 0.1).then_some(polygon)
}

/// Points along a line with the direction there, a few metres apart.
fn stations(line: &[DVec2]) -> Vec<(DVec2, DVec2)> {
    let mut stations = Vec::new();
    let mut passed_m = STATION_M;
    for (i, pair) in line.windows(2).enumerate() {
        let (step, is_last) = (pair[1] - pair[0], i + 2 == line.len());
        let Some(ahead) = step.try_normalize() else { continue };
        if passed_m >= STATION_M {
            stations.push((pair[0], ahead));
            passed_m = 0.0;
        }
        passed_m += step.length();
        if is_last {
            stations.push((pair[1], ahead));
        }
    }
    stations
}

/// The outline of a line that is so wide on either side as is said of a point and a direction to the side.
fn widened(stations: &[(DVec2, DVec2)], half_m: impl Fn(DVec2, DVec2) -> f64) -> Vec<DVec2> {
    let side = |sign: f64| {
        stations
            .iter()
            .map(move |(at, ahead)| (*at, ahead.perp() * sign))
            .map(|(at, aside)| at + aside * half_m(at, aside))
    };
    let mut outline: Vec<_> = side(-1.0).collect();
    let left: Vec<_> = side(1.0).collect();
    outline.extend(left.into_iter().rev());
    outline
}

impl Lines {
    fn add(&mut self, line: &[DVec2]) {
        for pair in line.windows(2) {
            // Segments are short; a long one is in the cells of its ends and of what lies between at a cell's distance.
            let pieces = ((pair[0].distance(pair[1]) / CELL_M).ceil() as usize).clamp(1, 1000);
            let at = |i: usize| pair[0].lerp(pair[1], i as f64 / pieces as f64);
            for i in 0..pieces {
                let (a, b) = (at(i), at(i + 1));
                self.cells.entry(cell(a.midpoint(b))).or_default().push((a, b));
            }
        }
    }

    /// How far a point is from the first line in a direction; `None` where there is none within reach.
    fn along(&self, at: DVec2, direction: DVec2, reach_m: f64) -> Option<f64> {
        let middle = cell(at + direction * reach_m / 2.0);
        let mut nearest_m = None::<f64>;
        for (x, y) in (-1..=1).flat_map(|x| (-1..=1).map(move |y| (x, y))) {
            for (a, b) in self.cells.get(&(middle + IVec2::new(x, y))).into_iter().flatten() {
                let (along, across) = (*b - *a, direction.perp());
                let slope = along.dot(across);
                let share = (at - *a).dot(across) / slope;
                let distance_m = (*a + along * share - at).dot(direction);
                if (0.0..=1.0).contains(&share) && (0.0..=reach_m).contains(&distance_m) {
                    nearest_m = Some(nearest_m.map_or(distance_m, |nearest| nearest.min(distance_m)));
                }
            }
        }
        nearest_m.map(|distance_m| distance_m.max(0.3))
    }
}

fn cell(at: DVec2) -> IVec2 {
    (at / CELL_M).floor().as_ivec2()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(y_m: f64) -> Vec<DVec2> {
        (0..=40).map(|x| DVec2::new(f64::from(x), y_m)).collect()
    }

    fn street(forms: Vec<MapForm>) -> (LaneMap, Report) {
        let report = Report::default();
        let features: Vec<_> = (0..).zip(forms).map(|(id, form)| MapFeature { id, form }).collect();
        (of(&features, DVec2::ZERO, &[DVec2::ZERO], &report).unwrap(), report)
    }

    #[test]
    fn a_lane_is_as_wide_as_the_lines_beside_it_leave_it() {
        let (map, _) = street(vec![
            MapForm::Lane { is_for_bicycles: false, line: line(0.0) },
            MapForm::RoadLine { is_between_directions: true, line: line(1.6) },
            MapForm::RoadEdge(line(-4.0)),
        ]);
        let lane = &map.lanes[0].polygon;
        assert!((lane.area_m2() - 40.0 * (1.6 + HALF_LANE_M)).abs() < 1e-6, "{}", lane.area_m2());
        assert!((map.drivable[0].area_m2() - 40.0 * 5.6).abs() < 1e-6);
        assert_eq!((map.road_dividers.len(), map.lane_dividers.len()), (1, 0));
        assert_eq!(map.lanes[0].centreline.first(), Some(&DVec2::ZERO));
    }

    #[test]
    fn areas_are_areas_and_what_has_no_place_is_reported() {
        let square = vec![DVec2::ZERO, DVec2::X * 3.0, DVec2::splat(3.0), DVec2::Y * 3.0];
        let far: Vec<_> = square.iter().map(|p| *p + DVec2::splat(5000.0)).collect();
        let (map, report) = street(vec![
            MapForm::Crosswalk(square.clone()),
            MapForm::Driveway(square),
            MapForm::Crosswalk(far),
            MapForm::Crosswalk(vec![DVec2::NAN; 4]),
            MapForm::Other,
        ]);
        assert!((map.crossings.len(), map.drivable.len()) == (1, 1) && map.crossings[0].area_m2() > 8.9);
        assert_eq!(report.entries().iter().map(|entry| entry.count).sum::<u64>(), 2);
    }
}

//! Paint on the road.

use glam::DVec2;
use trove_model::{Drive, FurnitureKind, Polygon, RoadKind, StreetMap};

use super::layout::{Layout, shifted};
use super::network::{RECORDED, resampled};
use crate::plane::{difference, intersection, strip, union};
use crate::plane_raster::PlaneRaster;

/// Width of a line.
const LINE_M: f64 = 0.12;
/// A dash and the gap behind it.
const DASH_M: f64 = 3.0;
const GAP_M: f64 = 6.0;
/// Distance between the middles of a double line's lines.
const DOUBLE_M: f64 = 0.3;
/// A zebra's bar and its period across the road.
const BAR_M: f64 = 0.5;
const BAR_PERIOD_M: f64 = 1.1;
/// Width of a crossing that the map draws as a line.
const CROSSING_M: f64 = 3.0;
/// Thickness of a stop line.
const STOP_M: f64 = 0.4;
/// Lines end this far from the middle of a junction, beyond half the other road's width.
const JUNCTION_M: f64 = 3.0;
/// Lines nearer than this to one that is painted already are the same line.
const SAME_LINE_M: f64 = 0.6;

/// Painted areas on the carriageway.
pub(super) struct Markings {
    pub white: Vec<Polygon>,
    pub yellow: Vec<Polygon>,
}

/// A line to be painted.
struct Stroke {
    line: Vec<DVec2>,
    style: Style,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Style {
    DashedWhite,
    /// Between directions: double yellow in the Americas, solid white elsewhere.
    Divider,
}

/// Lane and road dividers, zebras and stop lines: the dataset's, and the map's where the dataset has none.
pub(super) fn markings(drive: &Drive, map: Option<&StreetMap>, layout: &Layout<'_>) -> Markings {
    let crossings = crossings(drive, map, &layout.recorded);
    let yellow_dividers = (-170.0..-30.0).contains(&drive.projection.origin_lon_deg);
    let bounds = trove_model::Bounds::around(layout.carriageway.iter().flat_map(|p| p.exterior.iter().copied()));
    let Some(bounds) = bounds else { return Markings { white: Vec::new(), yellow: Vec::new() } };
    let mut painted = PlaneRaster::new(bounds, 0.2);
    let (mut white, mut yellow) = (Vec::new(), Vec::new());
    for stroke in recorded_strokes(drive).into_iter().chain(mapped_strokes(map, layout)) {
        for line in fresh(&stroke.line, &mut painted) {
            match stroke.style {
                Style::DashedWhite => white.extend(dashes(&line).iter().flat_map(|d| strip(d, LINE_M / 2.0))),
                Style::Divider if yellow_dividers => {
                    for side in [-0.5, 0.5] {
                        yellow.extend(strip(&shifted(&line, side * DOUBLE_M), LINE_M / 2.0));
                    }
                }
                Style::Divider => white.extend(strip(&line, LINE_M / 2.0)),
            }
        }
    }
    white.extend(drive.lane_map.iter().flat_map(|m| &m.stop_lines).filter_map(stop_line));
    // Nothing else is painted on a crossing.
    let clear = |paint: &[Polygon]| difference(&union(paint), &crossings);
    let bars = intersection(&union(&crossings.iter().flat_map(zebra).collect::<Vec<_>>()), &crossings);
    let white = union(&[clear(&white), bars].concat());
    Markings {
        white: intersection(&white, &layout.carriageway),
        yellow: difference(&intersection(&clear(&yellow), &layout.carriageway), &white),
    }
}

fn recorded_strokes(drive: &Drive) -> Vec<Stroke> {
    let Some(map) = &drive.lane_map else { return Vec::new() };
    let dividers = map.road_dividers.iter().map(|line| Stroke { line: line.clone(), style: Style::Divider });
    let lanes = map.lane_dividers.iter().map(|line| Stroke { line: line.clone(), style: Style::DashedWhite });
    dividers.chain(lanes).collect()
}

/// Centre and lane lines of the stretches that the dataset's map lacks, ending at junctions.
fn mapped_strokes(map: Option<&StreetMap>, layout: &Layout<'_>) -> Vec<Stroke> {
    let junctions = map.map(junctions).unwrap_or_default();
    let mut strokes = Vec::new();
    for stretch in &layout.stretches {
        let road = stretch.road;
        if road.kind >= RoadKind::Minor || stretch.width_m < 5.5 {
            continue;
        }
        let lanes = road.lanes.unwrap_or(2).clamp(1, 8);
        let lane_m = stretch.width_m / f64::from(lanes);
        // From the left edge: a line after every lane, the middle one between the directions.
        for i in 1..lanes {
            let offset_m = stretch.width_m / 2.0 - f64::from(i) * lane_m;
            let middle = !road.oneway && i == lanes.div_ceil(2);
            let style = if middle { Style::Divider } else { Style::DashedWhite };
            let line = shifted(&stretch.line, offset_m);
            let clear = |k: usize| {
                !junctions.iter().any(|(p, radius_m)| p.distance(stretch.line[k]) < radius_m + JUNCTION_M)
                    && layout.recorded.at(line[k]) != RECORDED
            };
            for run in runs(line.len(), clear) {
                strokes.push(Stroke { line: line[run].to_vec(), style });
            }
        }
    }
    strokes
}

/// Vertices where three or more arms of roads for cars meet, with half the widest one's width.
fn junctions(map: &StreetMap) -> Vec<(DVec2, f64)> {
    let mut arms: std::collections::BTreeMap<[i64; 2], (DVec2, u32, f64)> = std::collections::BTreeMap::new();
    for road in map.roads.iter().filter(|r| r.kind.is_for_cars() && r.kind < RoadKind::Service) {
        let last = road.centreline.len().saturating_sub(1);
        for (i, &p) in road.centreline.iter().enumerate() {
            let key = (p * 100.0).round().as_i64vec2().to_array();
            let arm = arms.entry(key).or_insert((p, 0, 0.0));
            arm.1 += if i == 0 || i == last { 1 } else { 2 };
            arm.2 = arm.2.max(road.width_m.unwrap_or(8.0) / 2.0);
        }
    }
    arms.into_values().filter(|a| a.1 > 2).map(|(p, _, radius_m)| (p, radius_m)).collect()
}

/// Ranges of at least two indices for which `holds`.
fn runs(len: usize, holds: impl Fn(usize) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut runs = Vec::new();
    let mut start = None;
    for i in 0..=len {
        match (i < len && holds(i), start) {
            (true, None) => start = Some(i),
            (false, Some(from)) => {
                if i - from > 1 {
                    runs.push(from..i);
                }
                start = None;
            }
            _ => {}
        }
    }
    runs
}

/// The parts of a line where none has been painted yet; they count as painted from now on.
fn fresh(line: &[DVec2], painted: &mut PlaneRaster) -> Vec<Vec<DVec2>> {
    let points = resampled(line);
    let lines: Vec<Vec<DVec2>> =
        runs(points.len(), |i| painted.at(points[i]) == 0).into_iter().map(|run| points[run].to_vec()).collect();
    for line in &lines {
        painted.fill(&strip(line, SAME_LINE_M), 1);
    }
    lines
}

/// Pieces of [`DASH_M`] with gaps of [`GAP_M`].
fn dashes(line: &[DVec2]) -> Vec<Vec<DVec2>> {
    let mut dashes: Vec<Vec<DVec2>> = Vec::new();
    let mut along_m = 0.0;
    for pair in line.windows(2) {
        let length_m = pair[0].distance(pair[1]);
        let mut at_m = 0.0;
        while at_m < length_m {
            let phase_m = (along_m + at_m).rem_euclid(DASH_M + GAP_M);
            let (inside, rest_m) =
                if phase_m < DASH_M { (true, DASH_M - phase_m) } else { (false, DASH_M + GAP_M - phase_m) };
            // Rounding must not make a step of nothing.
            let to_m = (at_m + rest_m.max(1e-6)).min(length_m);
            if inside {
                let (p, q) = (pair[0].lerp(pair[1], at_m / length_m), pair[0].lerp(pair[1], to_m / length_m));
                match dashes.last_mut() {
                    Some(dash) if dash.last().is_some_and(|l| l.distance(p) < 1e-3) => dash.push(q),
                    _ => dashes.push(vec![p, q]),
                }
            }
            at_m = to_m;
        }
        along_m += length_m;
    }
    dashes
}

/// Where people cross: the dataset's crossings, and the map's beyond the recorded area.
fn crossings(drive: &Drive, map: Option<&StreetMap>, recorded: &PlaneRaster) -> Vec<Polygon> {
    let mut crossings: Vec<Polygon> = drive.lane_map.iter().flat_map(|m| m.crossings.clone()).collect();
    if let Some(map) = map {
        let beyond = |line: &[DVec2]| line.iter().all(|&p| recorded.at(p) != RECORDED);
        let ways = map.roads.iter().filter(|r| r.kind == RoadKind::Crossing && beyond(&r.centreline));
        let drawn: Vec<Polygon> = ways.flat_map(|r| strip(&r.centreline, CROSSING_M / 2.0)).collect();
        let points = map.furniture.iter().filter(|f| f.kind == FurnitureKind::Crossing);
        for at in points.map(|f| f.position).filter(|&p| recorded.at(p) != RECORDED) {
            if !drawn.iter().any(|c| c.contains(at)) {
                crossings.extend(across(map, at));
            }
        }
        crossings.extend(drawn);
    }
    union(&crossings)
}

/// A crossing of the road that has a vertex at `at`.
fn across(map: &StreetMap, at: DVec2) -> Vec<Polygon> {
    let on = |r: &&trove_model::Road| r.kind.is_for_cars() && r.centreline.iter().any(|p| p.distance(at) < 0.05);
    let Some(road) = map.roads.iter().find(on) else { return Vec::new() };
    let Some(i) = road.centreline.iter().position(|p| p.distance(at) < 0.05) else { return Vec::new() };
    let (before, after) =
        (road.centreline[i.saturating_sub(1)], road.centreline[(i + 1).min(road.centreline.len() - 1)]);
    let side = (after - before).normalize_or_zero().perp() * 8.0;
    strip(&[at - side, at + side], CROSSING_M / 2.0)
}

/// The long side's direction of a polygon, with its half length and half width about its middle.
fn long_axis(polygon: &Polygon) -> Option<(DVec2, DVec2, DVec2)> {
    let direction = polygon
        .edges()
        .map(|(a, b)| b - a)
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?
        .try_normalize()?;
    let extent = |axis: DVec2| {
        let along = polygon.exterior.iter().map(|p| p.dot(axis));
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), d| (lo.min(d), hi.max(d)))
    };
    let ((u0, u1), (v0, v1)) = (extent(direction), extent(direction.perp()));
    let middle = direction * (u0 + u1) / 2.0 + direction.perp() * (v0 + v1) / 2.0;
    let half = DVec2::new(u1 - u0, v1 - v0) / 2.0;
    Some(if half.x >= half.y {
        (middle, direction, half)
    } else {
        (middle, direction.perp(), DVec2::new(half.y, half.x))
    })
}

/// A crossing's bars: people walk along its long side, bars lie along the road.
fn zebra(crossing: &Polygon) -> Vec<Polygon> {
    let Some((middle, walk, half)) = long_axis(crossing) else { return Vec::new() };
    let bars = (2.0 * half.x / BAR_PERIOD_M).floor().min(60.0);
    let first = -(bars - 1.0) / 2.0;
    (0..bars as usize)
        .flat_map(|i| {
            let at = middle + walk * (first + i as f64) * BAR_PERIOD_M;
            strip(&[at - walk.perp() * half.y, at + walk.perp() * half.y], BAR_M / 2.0)
        })
        .collect()
}

/// A line across the lane in the middle of the area that a dataset's map calls a stop line.
fn stop_line(area: &Polygon) -> Option<Polygon> {
    let (middle, across, half) = long_axis(area)?;
    strip(&[middle - across * half.x, middle + across * half.x], (STOP_M / 2.0).min(half.y)).into_iter().next()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane;
    use trove_model::Bounds;

    #[test]
    fn dashes_are_three_metres_of_every_nine_round_corners_too() {
        let line = [DVec2::ZERO, DVec2::new(40.0, 0.0), DVec2::new(40.0, 50.0)];
        let dashes = dashes(&line);
        assert_eq!(dashes.len(), 10);
        let length: f64 = dashes.iter().flat_map(|d| d.windows(2)).map(|w| w[0].distance(w[1])).sum();
        assert!((length - 30.0).abs() < 1e-3);
    }

    #[test]
    fn a_zebra_has_bars_along_the_road() {
        let crossing = plane::rectangle(Bounds { min: DVec2::ZERO, max: DVec2::new(11.0, 3.0) });
        let bars = zebra(&crossing);
        assert_eq!(bars.len(), 10);
        for bar in &bars {
            let size = bar.bounds().unwrap().size_m();
            assert!((size - DVec2::new(BAR_M, 3.0)).length() < 0.01, "{size}");
        }
    }

    #[test]
    fn a_line_is_painted_once() {
        let mut painted = PlaneRaster::new(Bounds::square(DVec2::ZERO, 100.0), 0.2);
        let line = [DVec2::new(-30.0, 1.0), DVec2::new(30.0, 1.0)];
        assert_eq!(fresh(&line, &mut painted).len(), 1);
        assert_eq!(fresh(&[line[1], line[0]], &mut painted).len(), 0);
    }
}

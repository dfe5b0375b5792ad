//! Where people cross, and what is painted there.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{
    Bounds, CrossingMarking, CrossingStyle, Dash, Drive, FurnitureKind, MarkingCustoms, Polygon, RoadKind, StreetMap,
};

use super::lines::dashes;
use crate::geometry::plane::{difference, grown, intersection, strip, union};

/// Width of a crossing that the map draws as a line.
const CROSSING_M: f64 = 3.2;
/// A crossing this near to a signal is one of its crossings.
const SIGNAL_M: f64 = 30.0;
/// Half of the length of a crossing that the map draws as a point, before it is cut off at the kerbs.
const POINT_HALF_M: f64 = 12.0;
/// Lines beside a crossing, and the dashes of broken ones.
const LINE_M: f64 = 0.3;
const DASHES: Dash = Dash { dash_m: 0.5, gap_m: 0.3 };
/// Smaller than this it is a corner of a crossing that a kerb cut off.
const LEAST_M2: f64 = 3.0;

/// A place to cross, on the carriageway.
pub(super) struct Crossing {
    /// Cut off at the kerbs.
    pub(super) area: Vec<Polygon>,
    /// Along which people walk, unit, its middle, and half of length and width.
    walk: DVec2,
    middle: DVec2,
    half: DVec2,
    /// `None`: nothing is painted.
    style: Option<CrossingStyle>,
}

/// The dataset's crossings, and the map's where it has none; `is_painted` tells where one without signals is, of which
/// neither says so.
pub(super) fn crossings(
    drive: &Drive,
    map: Option<&StreetMap>,
    carriageway: &[Polygon],
    bounds: Bounds,
    customs: &MarkingCustoms,
    is_painted: impl Fn(DVec2) -> bool,
) -> Vec<Crossing> {
    let furniture = map.map_or(&[][..], |m| &m.furniture);
    let signals: Vec<DVec2> =
        furniture.iter().filter(|f| f.kind == FurnitureKind::TrafficSignal).map(|f| f.position).collect();
    let style = |marking: Option<CrossingMarking>, at: DVec2| {
        let signalised = || signals.iter().any(|s| s.distance(at) < SIGNAL_M);
        match marking {
            Some(CrossingMarking::Unmarked) => None,
            Some(CrossingMarking::Zebra) => Some(CrossingStyle::Bars),
            Some(CrossingMarking::Ladder) => Some(CrossingStyle::Ladder),
            Some(CrossingMarking::Lines) => Some(CrossingStyle::Lines),
            Some(CrossingMarking::Dashes) => Some(CrossingStyle::Dashes),
            Some(CrossingMarking::Signals) => Some(customs.signalised),
            Some(CrossingMarking::Usual) | None if signalised() => Some(customs.signalised),
            Some(CrossingMarking::Usual) | None => is_painted(at).then_some(customs.zebra),
        }
    };
    let near = |p: &Polygon| p.bounds().is_some_and(|b| b.overlaps(&bounds));
    let mut outlines: Vec<(Polygon, Option<CrossingMarking>)> =
        drive.lane_map.iter().flat_map(|m| &m.crossings).map(|outline| (outline.clone(), None)).collect();
    if let Some(map) = map {
        let ways = map.roads.iter().filter(|r| r.kind == RoadKind::Crossing && r.layer == 0 && !r.tunnel && !r.bridge);
        for way in ways {
            // Segment by segment: a way may go round a corner on an island.
            let segments = way.centreline.windows(2).filter(|w| w[0].distance(w[1]) > 1.5);
            outlines.extend(segments.flat_map(|w| strip(w, CROSSING_M / 2.0)).map(|o| (o, way.crossing)));
        }
        let vertices = vertices(map);
        for point in map.furniture.iter().filter(|f| f.kind == FurnitureKind::Crossing) {
            let across = vertices.get(&key(point.position)).map(|&along| across(point.position, along));
            outlines.extend(across.into_iter().flatten().map(|o| (o, point.crossing())));
        }
    }
    outlines.retain(|(outline, _)| near(outline));
    let all: Vec<Polygon> = outlines.iter().map(|(outline, _)| outline.clone()).collect();
    let on_road = intersection(&union(&all), carriageway);

    let mut found: Vec<Crossing> = Vec::new();
    for (outline, marking) in &outlines {
        let (Some((middle, walk, half)), Some(bounds)) = (long_axis(outline), outline.bounds()) else { continue };
        if found.iter().any(|c| c.is_near(middle) && c.area.iter().any(|a| a.contains(middle))) {
            continue;
        }
        let pieces: Vec<Polygon> =
            on_road.iter().filter(|p| p.bounds().is_some_and(|b| b.overlaps(&bounds))).cloned().collect();
        let mut area = intersection(&pieces, &union(std::slice::from_ref(outline)));
        // Where a way bends, its two crossings share a corner, and one has it.
        let taken: Vec<Polygon> = found.iter().filter(|c| c.is_near(middle)).flat_map(|c| c.area.clone()).collect();
        area = difference(&area, &taken);
        area.retain(|p| p.area_m2() > LEAST_M2);
        if !area.is_empty() {
            found.push(Crossing { area, walk, middle, half, style: style(*marking, middle) });
        }
    }
    found
}

impl Crossing {
    /// Whether it may reach within a crossing's length of a point.
    pub(super) fn is_near(&self, p: DVec2) -> bool {
        self.middle.distance(p) < self.half.x + 2.0 * POINT_HALF_M
    }

    /// What is white, cut off at the kerbs.
    pub(super) fn painted(&self, customs: &MarkingCustoms) -> Vec<Polygon> {
        let Some(style) = self.style else { return Vec::new() };
        let half_m = self.half.y;
        let sides = |line: &dyn Fn(&[DVec2]) -> Vec<Polygon>| -> Vec<Polygon> {
            let side = |sign: f64| {
                let middle = self.middle + self.walk.perp() * (sign * (half_m - LINE_M / 2.0));
                line(&[middle - self.walk * self.half.x, middle + self.walk * self.half.x])
            };
            [-1.0, 1.0].into_iter().flat_map(side).collect()
        };
        let solid = |line: &[DVec2]| strip(line, LINE_M / 2.0);
        let broken = |line: &[DVec2]| dashes(line, DASHES).iter().flat_map(|d| strip(d, LINE_M / 2.0)).collect();
        let paint = match style {
            CrossingStyle::Bars => self.bars(customs.bar),
            CrossingStyle::Lines => sides(&solid),
            CrossingStyle::Dashes => sides(&broken),
            CrossingStyle::Ladder => union(&[sides(&solid), self.bars(customs.bar)].concat()),
        };
        intersection(&paint, &self.area)
    }

    /// Bars along the road, over the walk's whole length.
    fn bars(&self, bar: Dash) -> Vec<Polygon> {
        let period_m = bar.dash_m + bar.gap_m;
        let bars = (2.0 * self.half.x / period_m).floor().min(80.0);
        let first = -(bars - 1.0) / 2.0;
        let across = self.walk.perp() * self.half.y;
        let at = |i: usize| self.middle + self.walk * (first + i as f64) * period_m;
        (0..bars as usize).flat_map(|i| strip(&[at(i) - across, at(i) + across], bar.dash_m / 2.0)).collect()
    }
}

/// All areas on which people cross, a little larger: nothing else is painted there.
pub(super) fn kept_clear(crossings: &[Crossing]) -> Vec<Polygon> {
    let marked = crossings.iter().filter(|c| c.style.is_some()).flat_map(|c| c.area.iter().cloned());
    grown(&union(&marked.collect::<Vec<_>>()), 0.15)
}

/// A crossing of a road that runs along `along` at a point.
fn across(at: DVec2, along: DVec2) -> Vec<Polygon> {
    let side = along.perp() * POINT_HALF_M;
    strip(&[at - side, at + side], CROSSING_M / 2.0)
}

/// Directions of the roads for cars at their vertices, by place.
fn vertices(map: &StreetMap) -> BTreeMap<[i64; 2], DVec2> {
    let mut vertices = BTreeMap::new();
    for road in map.roads.iter().filter(|r| r.kind.is_for_cars()) {
        let line = &road.centreline;
        for (i, &p) in line.iter().enumerate() {
            let along = line[(i + 1).min(line.len() - 1)] - line[i.saturating_sub(1)];
            vertices.entry(key(p)).or_insert(along.normalize_or_zero());
        }
    }
    vertices
}

/// A place to a tenth of a metre.
fn key(p: DVec2) -> [i64; 2] {
    (p * 10.0).round().as_i64vec2().to_array()
}

/// The middle, the long side's direction, half length and half width of a polygon.
pub(in crate::roads) fn long_axis(polygon: &Polygon) -> Option<(DVec2, DVec2, DVec2)> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane;

    fn crossing(style: CrossingStyle) -> Crossing {
        let outline = plane::rectangle(Bounds { min: DVec2::ZERO, max: DVec2::new(11.0, 3.0) });
        let (middle, walk, half) = long_axis(&outline).unwrap();
        Crossing { area: vec![outline], walk, middle, half, style: Some(style) }
    }

    fn customs(dash_m: f64, gap_m: f64) -> MarkingCustoms {
        MarkingCustoms { bar: trove_model::Dash { dash_m, gap_m }, ..crate::testing::locale("BE").markings }
    }

    #[test]
    fn a_zebra_has_bars_along_the_road_as_wide_as_the_country_says() {
        let bars = crossing(CrossingStyle::Bars).painted(&customs(0.5, 0.6));
        assert_eq!(bars.len(), 10);
        for bar in &bars {
            let size = bar.bounds().unwrap().size_m();
            assert!((size - DVec2::new(0.5, 3.0)).length() < 0.01, "{size}");
        }
    }

    #[test]
    fn lines_lie_on_both_sides_of_the_walk() {
        let lines = crossing(CrossingStyle::Lines).painted(&customs(0.5, 0.6));
        assert_eq!(lines.len(), 2);
        assert!(lines.iter().all(|l| (l.bounds().unwrap().size_m().x - 11.0).abs() < 0.01));
        assert_eq!(crossing(CrossingStyle::Dashes).painted(&customs(0.5, 0.6)).len(), 28);
        assert_eq!(crossing(CrossingStyle::Ladder).painted(&customs(0.5, 0.6)).len(), 1);
    }
}

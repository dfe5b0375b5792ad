//! Paint on the road.
//!
//! The dataset's lines first, the map's where it has none; what countries do differently stands in
//! [`MarkingCustoms`].

mod approaches;
mod bays;
mod crossings;
mod legs;
mod lines;
mod recorded;
mod symbols;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use glam::{DVec2, Vec3};
use rayon::prelude::*;
use trove_model::{
    Bounds, CentreLine, Dash, Drive, KerbLines, LinePattern, MarkPattern, MarkingCustoms, Paint, Polygon, Report, Road,
    RoadKind, Seed, StreetMap,
};

use self::approaches::{Control, approach, box_junction};
use self::crossings::Crossing;
use self::legs::{Junction, Leg};
use self::lines::Stroke;
use super::cross_section::Use;
use super::layout::Layout;
use super::network::RECORDED;
use crate::geometry::plane::{difference, grown, intersection, strip, union};
use crate::geometry::plane_raster::PlaneRaster;

pub(super) use self::crossings::long_axis;

/// Lines along the kerb, from it inwards to their outer edge, and their width.
const KERB_LINES_M: [f64; 2] = [0.5, 0.7];
const KERB_LINE_M: f64 = 0.1;
/// Share of the junctions with signals that have a box where boxes are usual.
const BOX_SHARE: f64 = 0.4;
/// Share of the cycle lanes that are coated, where they are longer than this.
const COAT_SHARE: f64 = 0.4;
const SHORTEST_COAT_M: f64 = 15.0;
/// Share of the slow streets that have their limit painted at their entrances.
const LIMIT_SHARE: f64 = 0.5;
/// A line so near to the edge of the carriageway or to a crossing is painted in part at most, metres.
const WHOLE_M: f64 = 0.2;
/// Limits of speed that are painted, km/h.
const PAINTED_LIMIT_KMH: f64 = 30.0;

/// Painted areas on the carriageway; those of all paints together do not overlap.
#[derive(Default)]
pub(super) struct Markings {
    pub paints: BTreeMap<Paint, Vec<Polygon>>,
    /// Coated asphalt below the paint, with its tint.
    pub coats: Vec<(Vec3, Vec<Polygon>)>,
    /// The lines along lanes among the paint.
    pub lines: Vec<Line>,
    /// Where people cross.
    pub crossings: Vec<Polygon>,
}

/// A line along lanes, or two side by side, as far as nothing else is painted over it.
pub(super) struct Line {
    /// Its middle; along dashes and gaps alike.
    pub line: Vec<DVec2>,
    pub paint: Paint,
    /// The left side first as seen along the line.
    pub pattern: MarkPattern,
    /// Of one of two.
    pub width_m: f64,
}

/// Everything that is painted on the road of a place.
pub(super) fn markings(
    drive: &Drive,
    map: Option<&StreetMap>,
    layout: &Layout<'_>,
    near: &[Polygon],
    customs: &MarkingCustoms,
    seed: Seed,
    report: &Report,
) -> Markings {
    let bounds = Bounds::around(layout.carriageway.iter().flat_map(|p| p.exterior.iter().copied()));
    let Some(bounds) = bounds else { return Markings::default() };
    let on_left = layout.driving_side.is_left();
    let is_painted = |of: Seed| of.random().chance(customs.painted_share);
    let is_zebra = |at: DVec2| is_painted(seed.child("crossing").nth(place(at)));
    let crossings = crossings::crossings(drive, map, &layout.carriageway, bounds, customs, is_zebra);
    let junctions = map.map(|m| legs::junctions(m, on_left)).unwrap_or_default();
    let mut legs = legs::legs(&layout.stretches, &junctions);
    let streets = seed.child("painted");
    legs.retain(|leg| {
        let Road { name, id, .. } = leg.road();
        is_painted(name.as_ref().map_or(streets.nth(id.unsigned_abs()), |name| streets.child(name)))
    });
    let control = Control::new(map);

    let mut areas: BTreeMap<Paint, Vec<Polygon>> = BTreeMap::new();
    let mut painted = PlaneRaster::new(bounds, 0.2);
    let mut lines: Vec<Line> = Vec::new();
    let mapped = legs.iter().flat_map(|leg| lines::strokes(leg, customs)).filter(|s| is_unrecorded(&s.line, layout));
    for stroke in recorded_strokes(drive, customs).into_iter().chain(mapped) {
        let fresh = stroke.fresh(&mut painted);
        areas.entry(stroke.paint).or_default().extend(stroke.painted(&fresh));
        let Stroke { paint, pattern, width_m, .. } = stroke;
        lines.extend(fresh.into_iter().map(|line| Line { line, paint, pattern: mark_pattern(pattern), width_m }));
    }
    let detailed: Vec<(Vec<Polygon>, Vec<Polygon>)> =
        legs.par_iter().map(|leg| details(leg, &control, &crossings, customs, on_left, seed, report)).collect();
    let white = areas.entry(Paint::White).or_default();
    let mut coated = Vec::new();
    for (paint, coat) in detailed {
        white.extend(paint);
        coated.extend(coat);
    }
    white.extend(recorded::at_junctions(drive, &control, &crossings, customs));
    white.extend(bays::bays(&layout.courses));
    white.extend(
        drive.lane_map.iter().flat_map(|m| &m.stop_lines).filter_map(|area| stop_line(area, customs.stop_line_m)),
    );
    if customs.boxes {
        let boxed = |j: &&Junction| {
            let chosen = seed.child("box").nth(place(j.position)).random().chance(BOX_SHARE);
            chosen && bounds.contains(j.position) && control.is_signalised(j.position)
        };
        let boxes = junctions.values().filter(boxed).flat_map(box_junction);
        areas.entry(Paint::Yellow).or_default().extend(boxes);
    }
    let kerb_lines = match customs.kerb_lines {
        KerbLines::None => None,
        KerbLines::DoubleYellow => Some((Paint::Yellow, &KERB_LINES_M[..])),
        KerbLines::Red => Some((Paint::Red, &KERB_LINES_M[..1])),
    };
    if let Some((paint, from_kerb_m)) = kerb_lines {
        let beside = no_parking(layout, near);
        // A little more than is near, so that no line runs where only the path's surroundings end.
        let road = intersection(&layout.carriageway, &grown(near, 3.0));
        areas.entry(paint).or_default().extend(lines::along_kerbs(&road, &beside, from_kerb_m, KERB_LINE_M));
    }

    // Nothing else is painted on a crossing.
    let clear = crossings::kept_clear(&crossings);
    let bars: Vec<Polygon> = crossings.iter().flat_map(|c: &Crossing| c.painted(customs)).collect();
    let mut below: Vec<Polygon> = union(&bars);
    let mut paints: BTreeMap<Paint, Vec<Polygon>> = BTreeMap::new();
    for (paint, area) in areas {
        let area = difference(&intersection(&union(&area), &layout.carriageway), &clear);
        let area = difference(&area, &below);
        below = union(&[below, area.clone()].concat());
        paints.insert(paint, area);
    }
    paints.entry(customs.crossing_paint).or_default().extend(union(&bars));
    let coats = if coated.is_empty() {
        Vec::new()
    } else {
        vec![(Vec3::from_array(customs.cycle_coat), intersection(&union(&coated), &layout.carriageway))]
    };
    let mut free = PlaneRaster::new(bounds, 0.2);
    free.fill(&layout.carriageway, 1);
    free.fill(&clear, 0);
    let is_free = |p: DVec2| {
        [DVec2::ZERO, DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].iter().all(|way| free.at(p + way * WHOLE_M) != 0)
    };
    let lines = lines.into_iter().flat_map(|whole| {
        let parts = lines::runs(whole.line.len(), |i| is_free(whole.line[i]));
        parts.into_iter().map(move |part| Line { line: whole.line[part].to_vec(), ..whole })
    });
    let crossings = crossings.iter().flat_map(|crossing| crossing.area.clone()).collect();
    Markings { paints, coats, lines: lines.collect(), crossings }
}

/// What is painted on a leg besides its lines, white, and what is coated.
fn details(
    leg: &Leg<'_>,
    control: &Control,
    crossings: &[Crossing],
    customs: &MarkingCustoms,
    on_left: bool,
    seed: Seed,
    report: &Report,
) -> (Vec<Polygon>, Vec<Polygon>) {
    let seed = seed.child("leg").nth(leg.number);
    let mut white = Vec::new();
    if leg.road().kind < RoadKind::Service {
        for usage in [Use::Forward, Use::Backward] {
            white.extend(approach(leg, usage, control, crossings, customs, seed, report));
        }
    }
    white.extend(bays::rows(leg, seed.child("bays")));
    let (symbols, lanes) = bays::cycle_lanes(leg, on_left);
    white.extend(symbols);
    white.extend(limit(leg, seed.child("limit")));
    let coated = leg.length_m() > SHORTEST_COAT_M && seed.child("coat").random().chance(COAT_SHARE);
    (white, if coated { lanes } else { Vec::new() })
}

/// The speed limit at the entrances of a slow street.
fn limit(leg: &Leg<'_>, seed: Seed) -> Vec<Polygon> {
    let road = leg.road();
    let slow = road.speed_limit_kmh.filter(|v| (10.0..=PAINTED_LIMIT_KMH + 0.1).contains(v));
    let Some(limit) = slow.filter(|_| leg.length_m() > 40.0 && seed.random().chance(LIMIT_SHARE)) else {
        return Vec::new();
    };
    // Miles are painted as miles.
    let kmh = if (limit / 10.0).fract().abs() < 0.01 { limit } else { limit / 1.609_344 };
    let word = symbols::word(&format!("{kmh:.0}"));
    let ends = [(Use::Forward, leg.from_m + 8.0, 1.0), (Use::Backward, leg.to_m - 8.0, -1.0)];
    let entrance = |(usage, s_m, sign): (Use, f64, f64)| {
        let lane = leg.lanes(usage).first().copied()?;
        let along = leg.path.at(s_m).1 * sign;
        Some(symbols::laid(&word, leg.path.beside(s_m, (lane.0 + lane.1) / 2.0), along))
    };
    ends.into_iter().filter_map(entrance).flatten().collect()
}

fn recorded_strokes(drive: &Drive, customs: &MarkingCustoms) -> Vec<Stroke> {
    let Some(map) = &drive.lane_map else { return Vec::new() };
    let CentreLine { paint, wide, .. } = customs.centre;
    let stroke =
        |line: &Vec<DVec2>, paint, pattern| Stroke { line: line.clone(), paint, pattern, width_m: customs.line_m };
    let dividers = map.road_dividers.iter().map(|line| stroke(line, paint, wide));
    let lanes = map.lane_dividers.iter().map(|line| stroke(line, Paint::White, LinePattern::Dashed(customs.lane)));
    let marks = map.marks.iter().map(|mark| stroke(&mark.line, mark.paint, line_pattern(mark.pattern, customs.lane)));
    dividers.chain(lanes).chain(marks).collect()
}

fn line_pattern(pattern: MarkPattern, dash: Dash) -> LinePattern {
    match pattern {
        MarkPattern::Solid => LinePattern::Solid,
        MarkPattern::Dashed => LinePattern::Dashed(dash),
        MarkPattern::DoubleSolid => LinePattern::Double,
        MarkPattern::DoubleDashed => LinePattern::DoubleDashed(dash),
        MarkPattern::SolidDashed => LinePattern::SolidDashed(dash),
        MarkPattern::DashedSolid => LinePattern::DashedSolid(dash),
    }
}

fn mark_pattern(pattern: LinePattern) -> MarkPattern {
    match pattern {
        LinePattern::Solid => MarkPattern::Solid,
        LinePattern::Dashed(_) => MarkPattern::Dashed,
        LinePattern::Double => MarkPattern::DoubleSolid,
        LinePattern::DoubleDashed(_) => MarkPattern::DoubleDashed,
        LinePattern::SolidDashed(_) => MarkPattern::SolidDashed,
        LinePattern::DashedSolid(_) => MarkPattern::DashedSolid,
    }
}

fn is_unrecorded(line: &[DVec2], layout: &Layout<'_>) -> bool {
    line.iter().filter(|&&p| layout.recorded.at(p) == RECORDED).count() * 2 < line.len()
}

/// Where nobody may park: along all roads near the driven path but quiet ones, and those with rows for it.
fn no_parking(layout: &Layout<'_>, near: &[Polygon]) -> Vec<Polygon> {
    let parks = |s: &&super::network::Stretch<'_>| {
        s.road.kind >= RoadKind::Residential || s.section.bands.iter().any(|b| matches!(b.usage, Use::Parking(_)))
    };
    let reach = Bounds::around(near.iter().flat_map(|p| p.exterior.iter().copied()));
    let is_near = |s: &&super::network::Stretch<'_>| {
        reach.zip(Bounds::around(s.line.iter().copied())).is_some_and(|(a, b)| a.overlaps(&b))
    };
    let quiet =
        layout.stretches.iter().filter(is_near).filter(parks).flat_map(|s| strip(&s.line, s.width_m / 2.0 + 1.0));
    difference(near, &grown(&union(&quiet.collect::<Vec<_>>()), 0.5))
}

/// A line across the lane in the middle of the area that a dataset's map calls a stop line.
fn stop_line(area: &Polygon, depth_m: f64) -> Option<Polygon> {
    let (middle, across, half) = crossings::long_axis(area)?;
    strip(&[middle - across * half.x, middle + across * half.x], (depth_m / 2.0).min(half.y)).into_iter().next()
}

/// A number for a place, the same in every run.
fn place(p: DVec2) -> u64 {
    let cell = (p * 10.0).round().as_i64vec2();
    (cell.x as u64).rotate_left(32) ^ cell.y as u64
}

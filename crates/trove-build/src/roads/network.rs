//! Carriageways of OpenStreetMap's roads, where the dataset's own map ends.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{Outcome, Report, Road};

use super::cross_section::{CrossSection, cross_section};
use super::houses::Houses;
use crate::geometry::path;
use crate::geometry::plane_raster::PlaneRaster;

/// Roads are looked at every so many metres.
const STEP_M: f64 = 2.0;
/// A road that stays this near to the recorded area is the recorded road, drawn a little beside it.
pub(super) const BESIDE_M: f64 = 8.0;
/// How far a road that leaves the recorded area is taken back into it, so that the two join.
const OVERLAP_STEPS: usize = 2;
/// Gaps in the recorded area that a road crosses are closed up to this length: the largest junctions.
const LONGEST_GAP_STEPS: usize = 20;
/// Values of the raster that tells what was recorded.
pub(super) const NEAR: u8 = 1;
pub(super) const RECORDED: u8 = 2;
/// A street that is wider than this was measured across a square or a car park.
const WIDEST_M: f64 = 30.0;

/// A stretch of road with its lanes and its width from kerb to kerb.
#[derive(Clone, Debug)]
pub(super) struct Stretch<'a> {
    pub road: &'a Road,
    pub line: Vec<DVec2>,
    pub section: CrossSection,
    pub width_m: f64,
}

/// The stretches that the recorded area lacks of roads on the ground with their lines.
pub(super) fn stretches<'a>(
    ground: Vec<(&'a Road, Vec<DVec2>)>,
    recorded: &PlaneRaster,
    houses: &Houses<'_>,
    on_left: bool,
    report: &Report,
) -> Vec<Stretch<'a>> {
    let key = |p: &DVec2| (*p * 100.0).round().as_i64vec2().to_array();
    let mut touches: BTreeMap<[i64; 2], u32> = BTreeMap::new();
    for p in ground.iter().flat_map(|(_, line)| line) {
        *touches.entry(key(p)).or_default() += 1;
    }
    let is_met = |p: Option<&DVec2>| p.is_some_and(|p| touches[&key(p)] > 1);
    let mut stretches = Vec::new();
    for (road, centreline) in ground {
        let meets = [is_met(centreline.first()), is_met(centreline.last())];
        let points = resampled(&centreline);
        let measured = measured_width_m(&points, road.oneway, recorded);
        let known_m = measured.or(road.width_m.filter(|w| (2.0..=WIDEST_M).contains(w)));
        let usual = cross_section(road, known_m, on_left);
        let room_m = houses.room_m(road.kind, &points);
        let section = if known_m.is_none() && usual.width_m > room_m {
            // As if that were its tagged width: nobody is guessed to park there.
            cross_section(&Road { width_m: Some(room_m), ..road.clone() }, Some(room_m), on_left)
        } else {
            usual
        };
        for line in beyond(&points, meets, recorded) {
            if known_m.is_none() {
                let what = "width of a road, from its lanes or kind";
                report.note(Outcome::Guessed, what, format_args!("osm way {}", road.id));
            }
            stretches.push(Stretch { road, line, width_m: section.width_m, section: section.clone() });
        }
    }
    stretches
}

/// The line with points every [`STEP_M`]; its own vertices stay.
pub(super) fn resampled(line: &[DVec2]) -> Vec<DVec2> {
    path::resampled(line, STEP_M)
}

/// The median width of the recorded area along a road, across junctions left out; `None` where they share too little.
fn measured_width_m(points: &[DVec2], oneway: bool, recorded: &PlaneRaster) -> Option<f64> {
    const SAMPLE_M: f64 = 0.5;
    let reach = |from: DVec2, step: DVec2| {
        (1..60).find(|&i| recorded.at(from + step * f64::from(i)) != RECORDED).map(|i| f64::from(i) * SAMPLE_M)
    };
    let mut widths: Vec<f64> = points
        .windows(2)
        .filter(|w| recorded.at(w[0]) == RECORDED)
        .filter_map(|w| {
            let across = (w[1] - w[0]).normalize_or_zero().perp() * SAMPLE_M;
            let (left_m, right_m) = (reach(w[0], across)?, reach(w[0], -across)?);
            // Far to one side of a one-way road lies the other direction's road.
            let nearer_m = left_m.min(right_m);
            let divided = oneway && left_m.max(right_m) > 2.0 * nearer_m;
            Some(if divided { 2.0 * nearer_m } else { left_m + right_m }).filter(|&width| width <= WIDEST_M)
        })
        .collect();
    widths.sort_by(f64::total_cmp);
    // Ten samples are 20 m: less is a junction.
    (widths.len() >= 10).then(|| widths[widths.len() / 2].max(3.0))
}

/// Whether most points of a line have nothing recorded at their sides: it crosses a gap in the recorded area, and does
/// not run along its edge.
fn lies_open(line: &[DVec2], recorded: &PlaneRaster) -> bool {
    let open = |i: &usize| {
        let (before, after) = (line[i.saturating_sub(1)], line[(i + 1).min(line.len() - 1)]);
        let across = (after - before).normalize_or_zero().perp();
        let side = |sign: f64| (1..=4).any(|k| recorded.at(line[*i] + across * sign * f64::from(k)) == RECORDED);
        !side(1.0) && !side(-1.0)
    };
    line.len() > 1 && 2 * (0..line.len()).filter(open).count() > line.len()
}

/// The parts of a resampled road outside the recorded area; `meets` tells whether other roads go on at its ends.
fn beyond(points: &[DVec2], meets: [bool; 2], recorded: &PlaneRaster) -> Vec<Vec<DVec2>> {
    let state: Vec<u8> = points.iter().map(|&p| recorded.at(p)).collect();
    let near_steps = (BESIDE_M * 1.5 / STEP_M) as usize;
    let mut lines = Vec::new();
    let mut i = 0;
    while i < points.len() {
        if state[i] == RECORDED {
            i += 1;
            continue;
        }
        let end = (i..points.len()).find(|&k| state[k] == RECORDED).unwrap_or(points.len());
        let far = (i..end).find(|&k| state[k] != NEAR).zip((i..end).rfind(|&k| state[k] != NEAR));
        let joins = (i > 0 || meets[0]) && (end < points.len() || meets[1]);
        let between = joins && end - i <= LONGEST_GAP_STEPS;
        if far.is_none() && between && lies_open(&points[i..end], recorded) {
            lines.push(points[i.saturating_sub(OVERLAP_STEPS)..(end + OVERLAP_STEPS).min(points.len())].to_vec());
        }
        if let Some((first, last)) = far {
            // It leaves the recorded area: up to its edge, unless it runs beside it for long.
            let from = if first - i <= near_steps { i.saturating_sub(OVERLAP_STEPS) } else { first };
            let to = if end - 1 - last <= near_steps { (end + OVERLAP_STEPS).min(points.len()) } else { last + 1 };
            if to - from >= 2 {
                lines.push(points[from..to].to_vec());
            }
        }
        i = end;
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane;
    use trove_model::{Bounds, RoadKind};

    fn road(points: &[(f64, f64)]) -> Road {
        let points: Vec<[f64; 2]> = points.iter().map(|&(x, y)| [x, y]).collect();
        crate::testing::road(1, RoadKind::Residential, &points)
    }

    fn recorded() -> PlaneRaster {
        let bounds = Bounds::square(DVec2::ZERO, 400.0);
        let area = [plane::rectangle(Bounds { min: DVec2::new(-100.0, -6.0), max: DVec2::new(100.0, 6.0) })];
        let mut raster = PlaneRaster::new(bounds, 0.5);
        raster.fill(&plane::grown(&area, BESIDE_M), NEAR);
        raster.fill(&area, RECORDED);
        raster
    }

    #[test]
    fn a_road_goes_on_where_the_recording_ends_with_the_recorded_width() {
        let raster = recorded();
        let road = road(&[(-50.0, 0.0), (150.0, 0.0)]);
        let found =
            stretches(vec![(&road, road.centreline.clone())], &raster, &Houses::default(), false, &Report::default());
        assert_eq!(found.len(), 1);
        assert!((found[0].width_m - 12.0).abs() <= 1.0, "{}", found[0].width_m);
        assert!(found[0].line[0].x < 100.0 && found[0].line[0].x > 90.0);
    }

    #[test]
    fn a_junction_that_was_not_recorded_is_filled_by_the_roads_that_meet_there() {
        let square = |x0: f64, y0: f64, x1: f64, y1: f64| {
            plane::rectangle(Bounds { min: DVec2::new(x0, y0), max: DVec2::new(x1, y1) })
        };
        let area = [square(-100.0, -4.0, -8.0, 4.0), square(8.0, -4.0, 100.0, 4.0), square(-4.0, 8.0, 4.0, 90.0)];
        let mut raster = PlaneRaster::new(Bounds::square(DVec2::ZERO, 400.0), 0.5);
        raster.fill(&plane::grown(&area, BESIDE_M), NEAR);
        raster.fill(&area, RECORDED);
        let roads =
            [[(-90.0, 0.0), (0.0, 0.0)], [(0.0, 0.0), (90.0, 0.0)], [(0.0, 80.0), (0.0, 0.0)]].map(|r| road(&r));
        let ground = roads.iter().map(|r| (r, r.centreline.clone())).collect();
        assert_eq!(stretches(ground, &raster, &Houses::default(), false, &Report::default()).len(), 3);
    }

    #[test]
    fn a_road_drawn_beside_the_recorded_one_is_not_built_again() {
        let raster = recorded();
        let road = road(&[(-90.0, 9.0), (90.0, 9.0)]);
        assert!(
            stretches(vec![(&road, road.centreline.clone())], &raster, &Houses::default(), false, &Report::default())
                .is_empty()
        );
    }
}

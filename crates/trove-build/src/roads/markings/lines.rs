//! Lines along the road.

use glam::DVec2;
use trove_model::{CentreLine, Dash, LinePattern, MarkingCustoms, Paint, Polygon, RoadKind};

use super::legs::Leg;
use crate::geometry::path::shifted;
use crate::geometry::plane::strip;
use crate::geometry::plane_raster::PlaneRaster;
use crate::roads::cross_section::{Band, Use};
use crate::roads::network::resampled;

/// Distance between the middles of a double line's lines, in widths of a line.
const DOUBLE: f64 = 2.2;
/// Lines nearer than this to one that is painted already are the same line.
const SAME_LINE_M: f64 = 0.6;
/// Where traffic waits, lanes are not changed: their lines are solid this far before a junction.
const SOLID_M: f64 = 20.0;
/// Lanes narrower than this are not marked out.
const NARROWEST_M: f64 = 2.4;
/// A line beside a lane for bicycles is this much wider.
const CYCLE_LINE: f64 = 1.6;

/// A line to be painted.
pub(super) struct Stroke {
    pub(super) line: Vec<DVec2>,
    pub(super) paint: Paint,
    pub(super) pattern: LinePattern,
    pub(super) width_m: f64,
}

impl Stroke {
    /// The parts of it where nothing has been painted yet; they count as painted from now on.
    pub(super) fn fresh(&self, painted: &mut PlaneRaster) -> Vec<Vec<DVec2>> {
        fresh(&self.line, painted)
    }

    /// What of its fresh parts gets paint.
    pub(super) fn painted(&self, fresh: &[Vec<DVec2>]) -> Vec<Polygon> {
        let half_m = self.width_m / 2.0;
        let solid = |line: &[DVec2]| strip(line, half_m);
        let broken =
            |line: &[DVec2], dash| dashes(line, dash).iter().flat_map(|d| strip(d, half_m)).collect::<Vec<_>>();
        let beside = |line: &[DVec2], side: f64| shifted(line, side * DOUBLE / 2.0 * self.width_m);
        let both = |left: Vec<Polygon>, right: Vec<Polygon>| [left, right].concat();
        fresh
            .iter()
            .flat_map(|line| {
                let (left, right) = (beside(line, 1.0), beside(line, -1.0));
                match self.pattern {
                    LinePattern::Solid => solid(line),
                    LinePattern::Dashed(dash) => broken(line, dash),
                    LinePattern::Double => both(solid(&right), solid(&left)),
                    LinePattern::DoubleDashed(dash) => both(broken(&left, dash), broken(&right, dash)),
                    LinePattern::SolidDashed(dash) => both(solid(&left), broken(&right, dash)),
                    LinePattern::DashedSolid(dash) => both(broken(&left, dash), solid(&right)),
                }
            })
            .collect()
    }
}

/// The lines of a road between two junctions.
pub(super) fn strokes(leg: &Leg<'_>, customs: &MarkingCustoms) -> Vec<Stroke> {
    let bands = &leg.stretch.section.bands;
    let mut strokes = Vec::new();
    let mut add = |from_m: f64, to_m: f64, offset_m: f64, paint: Paint, pattern: LinePattern, width: f64| {
        let line = leg.path.part(from_m, to_m, offset_m);
        if line.len() > 1 {
            strokes.push(Stroke { line, paint, pattern, width_m: customs.line_m * width });
        }
    };
    let (from_m, to_m) = (leg.from_m, leg.to_m);
    for pair in bands.windows(2) {
        let offset_m = pair[0].right_m;
        match (pair[0].usage, pair[1].usage) {
            (a, b) if a == b && matches!(a, Use::Forward | Use::Backward) => {
                if !is_marked_out(leg, pair, customs) {
                    continue;
                }
                // Solid where traffic waits.
                let waits = leg.ends[usize::from(a == Use::Forward)].is_some();
                let solid_m = if waits { SOLID_M.min(leg.length_m() / 2.0) } else { 0.0 };
                let dashed = LinePattern::Dashed(lane_dash(leg, customs));
                let (a_m, b_m) = if a == Use::Forward { (from_m, to_m - solid_m) } else { (from_m + solid_m, to_m) };
                add(a_m, b_m, offset_m, Paint::White, dashed, 1.0);
                add(from_m, a_m, offset_m, Paint::White, LinePattern::Solid, 1.0);
                add(b_m, to_m, offset_m, Paint::White, LinePattern::Solid, 1.0);
            }
            (Use::Forward, Use::Backward) | (Use::Backward, Use::Forward) if is_marked_out(leg, pair, customs) => {
                let lanes = bands.iter().filter(|b| matches!(b.usage, Use::Forward | Use::Backward)).count();
                let CentreLine { paint, narrow, wide, .. } = customs.centre;
                add(from_m, to_m, offset_m, paint, if lanes > 2 { wide } else { narrow }, 1.0);
            }
            (Use::Cycle, _) | (_, Use::Cycle) => {
                add(from_m, to_m, offset_m, Paint::White, LinePattern::Solid, CYCLE_LINE);
            }
            _ => {}
        }
    }
    if leg.road().kind <= RoadKind::Trunk && !leg.road().link {
        let edges =
            bands.first().map(|b| b.left_m - customs.line_m).zip(bands.last().map(|b| b.right_m + customs.line_m));
        if let Some((left_m, right_m)) = edges {
            // Where the line between directions is yellow, so is the one beside the median.
            let median = if leg.road().oneway { customs.centre.paint } else { Paint::White };
            add(from_m, to_m, left_m, median, LinePattern::Solid, 1.2);
            add(from_m, to_m, right_m, Paint::White, LinePattern::Solid, 1.2);
        }
    }
    strokes
}

fn is_marked_out(leg: &Leg<'_>, lanes: &[Band], customs: &MarkingCustoms) -> bool {
    let road = leg.road();
    let busy = road.kind <= RoadKind::Tertiary || road.lanes.is_some_and(|l| l > 2);
    let quiet = customs.centre.on_quiet_streets && road.kind < RoadKind::Service;
    (busy || quiet) && lanes.iter().all(|b| b.width_m() >= NARROWEST_M)
}

fn lane_dash(leg: &Leg<'_>, customs: &MarkingCustoms) -> Dash {
    if leg.road().kind <= RoadKind::Trunk { customs.fast_lane } else { customs.lane }
}

/// Lines that lie a little within the edges of the carriageway.
pub(super) fn along_kerbs(
    carriageway: &[Polygon],
    where_to: &[Polygon],
    from_kerb_m: &[f64],
    width_m: f64,
) -> Vec<Polygon> {
    use crate::geometry::plane::{difference, grown, intersection};
    let ring = |from_m: &f64| {
        let band = difference(&grown(carriageway, -from_m), &grown(carriageway, -from_m - width_m));
        intersection(&band, where_to)
    };
    from_kerb_m.iter().flat_map(ring).collect()
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

/// Ranges of at least two indices for which `holds`.
pub(super) fn runs(len: usize, holds: impl Fn(usize) -> bool) -> Vec<std::ops::Range<usize>> {
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

/// The dashes of a broken line.
pub(super) fn dashes(line: &[DVec2], dash: Dash) -> Vec<Vec<DVec2>> {
    let period_m = dash.dash_m + dash.gap_m;
    let mut dashes: Vec<Vec<DVec2>> = Vec::new();
    let mut along_m = 0.0;
    for pair in line.windows(2) {
        let length_m = pair[0].distance(pair[1]);
        let mut at_m = 0.0;
        while at_m < length_m {
            let phase_m = (along_m + at_m).rem_euclid(period_m);
            let (inside, rest_m) =
                if phase_m < dash.dash_m { (true, dash.dash_m - phase_m) } else { (false, period_m - phase_m) };
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

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Bounds;

    #[test]
    fn a_line_that_is_broken_on_one_side_is_solid_on_the_other() {
        let dash = Dash { dash_m: 3.0, gap_m: 9.0 };
        // Metres of paint to the left of a line of 48 m along x, and to the right.
        let painted_m = |pattern| {
            let line = vec![DVec2::new(-24.0, 0.0), DVec2::new(24.0, 0.0)];
            let stroke = Stroke { line, paint: Paint::Yellow, pattern, width_m: 0.1 };
            let mut raster = PlaneRaster::new(Bounds::square(DVec2::ZERO, 60.0), 0.25);
            let (left, right): (Vec<_>, Vec<_>) =
                stroke.painted(&stroke.fresh(&mut raster)).into_iter().partition(|p| p.centroid().y > 0.0);
            [left, right].map(|side| (side.iter().map(Polygon::area_m2).sum::<f64>() / 0.1).round())
        };
        assert_eq!(painted_m(LinePattern::SolidDashed(dash)), [48.0, 12.0]);
        assert_eq!(painted_m(LinePattern::DashedSolid(dash)), [12.0, 48.0]);
        assert_eq!(painted_m(LinePattern::DoubleDashed(dash)), [12.0, 12.0]);
        assert_eq!(painted_m(LinePattern::Double), [48.0, 48.0]);
    }

    #[test]
    fn dashes_are_as_long_as_the_country_says_round_corners_too() {
        let line = [DVec2::ZERO, DVec2::new(40.0, 0.0), DVec2::new(40.0, 50.0)];
        let dashes = dashes(&line, Dash { dash_m: 3.0, gap_m: 6.0 });
        assert_eq!(dashes.len(), 10);
        let length: f64 = dashes.iter().flat_map(|d| d.windows(2)).map(|w| w[0].distance(w[1])).sum();
        assert!((length - 30.0).abs() < 1e-3);
    }

    #[test]
    fn a_line_is_painted_once() {
        let mut painted = PlaneRaster::new(Bounds::square(DVec2::ZERO, 100.0), 0.2);
        let line = [DVec2::new(-30.0, 1.0), DVec2::new(30.0, 1.0)];
        assert_eq!(fresh(&line, &mut painted).len(), 1);
        assert_eq!(fresh(&[line[1], line[0]], &mut painted).len(), 0);
    }
}

//! Centre lines of lanes whose map gives only their outlines and what follows on what.

use glam::DVec2;
use trove_model::Polygon;

/// Vertices that are made along a lane.
const STATIONS: usize = 12;
/// An outline of more vertices is not searched for its ends, which takes the cube of them in time.
const MOST_VERTICES: usize = 200;
/// What is not longer than this many times its width has no telling which way it runs.
const SLENDER: f64 = 1.5;
/// By so much must one direction fit the lane's neighbours better than the other, metres.
const CLEAR_M: f64 = 2.0;

/// The line midway between a lane's sides, from the lanes before it to those after it; empty where its form or its
/// neighbours do not tell.
pub(super) fn between_sides(outline: &[DVec2], before: &[&Polygon], after: &[&Polygon]) -> Vec<DVec2> {
    let Some(mut line) = midline(outline) else { return Vec::new() };
    let (Some(&start), Some(&end)) = (line.first(), line.last()) else { return Vec::new() };
    let gap_m = |p: DVec2, lanes: &[&Polygon]| {
        let nearest = lanes.iter().map(|lane| lane.edge_distance_m(p)).fold(f64::INFINITY, f64::min);
        if nearest.is_finite() { nearest } else { 0.0 }
    };
    let forward_m = gap_m(start, before) + gap_m(end, after);
    let backward_m = gap_m(end, before) + gap_m(start, after);
    if (forward_m - backward_m).abs() < CLEAR_M {
        return Vec::new();
    }
    if backward_m < forward_m {
        line.reverse();
    }
    line
}

/// The line between the two sides of a slender outline, in either direction.
fn midline(outline: &[DVec2]) -> Option<Vec<DVec2>> {
    // Two edges are the lane's ends: those between which the sides run nearest to each other.
    let n = outline.len();
    if n > MOST_VERTICES {
        return None;
    }
    let sides = |i: usize, j: usize| {
        let left = stations(&(i + 1..=j).map(|k| outline[k]).collect::<Vec<_>>());
        let mut right: Vec<_> = (j + 1..=i + n).map(|k| outline[k % n]).collect();
        right.reverse();
        (left, stations(&right))
    };
    let width_m = |(left, right): &(Vec<DVec2>, Vec<DVec2>)| {
        left.iter().zip(right).map(|(a, b)| a.distance(*b)).sum::<f64>() / STATIONS as f64
    };
    let pairs = (0..n).flat_map(|i| (i + 2..n).map(move |j| (i, j))).filter(|(i, j)| j - i < n - 1);
    let candidates = pairs.map(|(i, j)| sides(i, j));
    let narrowest = candidates.min_by(|a, b| width_m(a).total_cmp(&width_m(b)))?;
    let line: Vec<_> = narrowest.0.iter().zip(&narrowest.1).map(|(a, b)| a.midpoint(*b)).collect();
    let length_m: f64 = line.windows(2).map(|w| w[0].distance(w[1])).sum();
    (length_m > SLENDER * width_m(&narrowest)).then_some(line)
}

/// Points at equal distances along a line.
fn stations(line: &[DVec2]) -> Vec<DVec2> {
    let total_m: f64 = line.windows(2).map(|w| w[0].distance(w[1])).sum();
    let (mut points, mut passed_m, mut k) = (Vec::with_capacity(STATIONS), 0.0, 0);
    for i in 0..STATIONS {
        let wanted_m = total_m * i as f64 / (STATIONS - 1) as f64;
        while k + 2 < line.len() && passed_m + line[k].distance(line[k + 1]) < wanted_m {
            passed_m += line[k].distance(line[k + 1]);
            k += 1;
        }
        let next = line[(k + 1).min(line.len() - 1)];
        let step_m = line[k].distance(next);
        let share = if step_m > 0.0 { ((wanted_m - passed_m) / step_m).clamp(0.0, 1.0) } else { 0.0 };
        points.push(line[k].lerp(next, share));
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn block(x_m: f64, length_m: f64) -> Polygon {
        let corner = |x, y| DVec2::new(x_m + x * length_m, y * 4.0);
        Polygon::simple(vec![corner(0.0, 0.0), corner(0.4, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)])
    }

    #[test]
    fn a_lane_runs_from_what_is_before_it_to_what_is_after_it() {
        let (west, lane, east) = (block(-20.0, 20.0), block(0.0, 30.0), block(30.0, 20.0));
        let line = between_sides(&lane.exterior, &[&west], &[&east]);
        assert!(line[0].distance(DVec2::new(0.0, 2.0)) < 1e-9 && line[11].distance(DVec2::new(30.0, 2.0)) < 1e-9);
        let line = between_sides(&lane.exterior, &[&east], &[]);
        assert!(line[0].distance(DVec2::new(30.0, 2.0)) < 1e-9, "{line:?}");
        assert!(between_sides(&lane.exterior, &[], &[]).is_empty());
        assert!(between_sides(&block(0.0, 4.0).exterior, &[&west], &[&east]).is_empty());
    }

    proptest! {
        #[test]
        fn any_outline_has_a_finite_line_or_none(points in prop::collection::vec((-50.0..50.0f64, -50.0..50.0f64), 0..9)) {
            let outline: Vec<_> = points.into_iter().map(DVec2::from).collect();
            let line = between_sides(&outline, &[&block(-20.0, 20.0)], &[]);
            prop_assert!(line.iter().all(|p| p.is_finite()));
        }
    }
}

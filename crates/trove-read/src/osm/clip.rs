//! What of a line or an outline lies in a rectangle.

use glam::DVec2;
use trove_model::Bounds;

/// The part of a segment in a rectangle, as shares of its length (Liang and Barsky 1984).
pub(super) fn inside_range(a: DVec2, b: DVec2, area: Bounds) -> Option<(f64, f64)> {
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        let (from, step) = (a[axis], b[axis] - a[axis]);
        for (distance, towards) in [(area.min[axis] - from, step), (from - area.max[axis], -step)] {
            if towards > 0.0 {
                enter = enter.max(distance / towards);
            } else if towards < 0.0 {
                leave = leave.min(distance / towards);
            } else if distance > 0.0 {
                return None;
            }
        }
    }
    (enter < leave).then_some((enter, leave))
}

/// The pieces of a line in a rectangle, in its order; the line itself where it is all inside.
pub(super) fn line_within(line: &[DVec2], area: Bounds) -> Vec<Vec<DVec2>> {
    if line.iter().all(|&p| area.contains(p)) {
        return vec![line.to_vec()];
    }
    let mut pieces: Vec<Vec<DVec2>> = Vec::new();
    let mut goes_on = false;
    for pair in line.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let Some((enter, leave)) = inside_range(a, b, area) else {
            goes_on = false;
            continue;
        };
        match pieces.last_mut().filter(|_| goes_on) {
            Some(piece) => piece.push(a.lerp(b, leave)),
            None => pieces.push(vec![a.lerp(b, enter), a.lerp(b, leave)]),
        }
        goes_on = leave >= 1.0;
    }
    pieces
}

/// An outline cut to a rectangle (Sutherland and Hodgman 1974): where it leaves and comes back it runs along the
/// rectangle's edge. The outline itself where it is all inside.
pub(super) fn ring_within(ring: &[DVec2], area: Bounds) -> Vec<DVec2> {
    let mut ring = ring.to_vec();
    for axis in 0..2 {
        for (limit, sign) in [(area.min[axis], 1.0), (area.max[axis], -1.0)] {
            let depth = |p: DVec2| sign * (p[axis] - limit);
            if ring.iter().all(|&p| depth(p) >= 0.0) {
                continue;
            }
            let mut cut = Vec::with_capacity(ring.len());
            for i in 0..ring.len() {
                let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
                if depth(a) >= 0.0 {
                    cut.push(a);
                }
                if (depth(a) >= 0.0) != (depth(b) >= 0.0) {
                    cut.push(a.lerp(b, depth(a) / (depth(a) - depth(b))));
                }
            }
            ring = cut;
        }
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Polygon;

    const AREA: Bounds = Bounds { min: DVec2::ZERO, max: DVec2::new(10.0, 10.0) };

    fn points(points: &[[f64; 2]]) -> Vec<DVec2> {
        points.iter().map(|&p| DVec2::from_array(p)).collect()
    }

    #[test]
    fn a_line_is_cut_where_it_leaves_and_goes_on_where_it_comes_back() {
        let inside = points(&[[1.0, 1.0], [9.0, 9.0]]);
        assert_eq!(line_within(&inside, AREA), [inside]);
        let across = points(&[[-1e7, 5.0], [1e7, 5.0]]);
        assert_eq!(line_within(&across, AREA), [points(&[[0.0, 5.0], [10.0, 5.0]])]);
        let twice = points(&[[5.0, 5.0], [15.0, 5.0], [15.0, 8.0], [5.0, 8.0], [4.0, 8.0]]);
        let pieces = [points(&[[5.0, 5.0], [10.0, 5.0]]), points(&[[10.0, 8.0], [5.0, 8.0], [4.0, 8.0]])];
        assert_eq!(line_within(&twice, AREA), pieces);
        assert!(line_within(&points(&[[20.0, 0.0], [20.0, 5.0]]), AREA).is_empty());
    }

    #[test]
    fn an_outline_keeps_the_area_that_it_has_inside() {
        let area = |ring: &[[f64; 2]]| Polygon::simple(ring_within(&points(ring), AREA)).area_m2();
        assert_eq!(area(&[[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]]), 1.0);
        assert!((area(&[[-1e7, -1e7], [1e7, -1e7], [1e7, 1e7], [-1e7, 1e7]]) - 100.0).abs() < 1e-6);
        // A triangle whose tip lies outside: what remains is a trapezium.
        assert!((area(&[[0.0, 0.0], [10.0, 0.0], [5.0, 20.0]]) - 75.0).abs() < 1e-9);
        assert!(ring_within(&points(&[[20.0, 0.0], [30.0, 0.0], [30.0, 9.0]]), AREA).is_empty());
    }
}

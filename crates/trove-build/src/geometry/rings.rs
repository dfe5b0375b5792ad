//! Splitting areas along straight lines.
//!
//! An area is a set of rings, outer ones counter-clockwise and inner ones clockwise, as [`Polygon::oriented`] leaves
//! them. Both halves get the very same points on the line, so that what is cut here fits together again.

use glam::DVec2;
use trove_model::{Bounds, Polygon};

pub(crate) type Ring = Vec<DVec2>;

/// A directed line: points with `normal · p < offset` lie on its left hand side, all others on its right.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub normal: DVec2,
    pub offset: f64,
}

impl Line {
    fn distance(&self, p: DVec2) -> f64 {
        self.normal.dot(p) - self.offset
    }

    /// Where the segment crosses the line; the same whichever way round it is given.
    pub(crate) fn crossing(&self, a: DVec2, b: DVec2) -> DVec2 {
        let (a, b) = if (a.x, a.y) <= (b.x, b.y) { (a, b) } else { (b, a) };
        let (da, db) = (self.distance(a), self.distance(b));
        let mut p = a + (b - a) * (da / (da - db)).clamp(0.0, 1.0);
        // Along an axis the coordinate is exact, so that neighbours agree on it.
        if self.normal == DVec2::X {
            p.x = self.offset;
        } else if self.normal == DVec2::Y {
            p.y = self.offset;
        }
        p
    }

    pub(crate) fn is_left(&self, p: DVec2) -> bool {
        self.distance(p) < 0.0
    }
}

/// A run of a ring's vertices on one side, from the point where it enters that side to the point where it leaves.
struct Chain {
    points: Ring,
    entry: f64,
    exit: f64,
}

/// The parts of an area on both sides of a line: (left, right).
pub(crate) fn split(rings: Vec<Ring>, line: Line) -> (Vec<Ring>, Vec<Ring>) {
    let mut whole: [Vec<Ring>; 2] = [Vec::new(), Vec::new()];
    let mut chains: [Vec<Chain>; 2] = [Vec::new(), Vec::new()];
    for ring in rings {
        let side: Vec<usize> = ring.iter().map(|&p| usize::from(!line.is_left(p))).collect();
        let n = ring.len();
        let Some(start) = (0..n).find(|&i| side[i] != side[(i + n - 1) % n]) else {
            if n > 0 {
                whole[side[0]].push(ring);
            }
            continue;
        };
        let along = DVec2::new(-line.normal.y, line.normal.x);
        let mut i = 0;
        while i < n {
            let first = (start + i) % n;
            let here = side[first];
            let entry = line.crossing(ring[(first + n - 1) % n], ring[first]);
            let mut points = vec![entry];
            while i < n && side[(start + i) % n] == here {
                points.push(ring[(start + i) % n]);
                i += 1;
            }
            let exit = line.crossing(ring[(start + i + n - 1) % n], ring[(start + i) % n]);
            points.push(exit);
            chains[here].push(Chain { points, entry: along.dot(entry), exit: along.dot(exit) });
        }
    }
    let [left, right] = chains;
    let [mut left_rings, mut right_rings] = whole;
    left_rings.extend(joined(left));
    right_rings.extend(joined(right));
    (left_rings, right_rings)
}

/// Joins chains to rings: along the line, crossings bound the area in pairs, and in each pair one chain leaves
/// and one enters.
fn joined(chains: Vec<Chain>) -> Vec<Ring> {
    let mut crossings: Vec<(f64, bool, usize)> =
        chains.iter().enumerate().flat_map(|(i, c)| [(c.entry, false, i), (c.exit, true, i)]).collect();
    crossings.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let mut next = vec![usize::MAX; chains.len()];
    let mut open: Vec<(bool, usize)> = Vec::new();
    for &(_, leaves, chain) in &crossings {
        // An unsound area (rings that overlap by rounding) may leave twice in a row: the nearest partner is taken.
        match open.pop() {
            Some((other_leaves, other)) if other_leaves != leaves => {
                let (from, to) = if leaves { (chain, other) } else { (other, chain) };
                next[from] = to;
            }
            Some(other) => open.extend([other, (leaves, chain)]),
            None => open.push((leaves, chain)),
        }
    }
    let mut used = vec![false; chains.len()];
    let mut rings = Vec::new();
    for start in 0..chains.len() {
        let mut ring = Ring::new();
        let mut at = start;
        while at != usize::MAX && !used[at] {
            used[at] = true;
            for &p in &chains[at].points {
                if ring.last() != Some(&p) {
                    ring.push(p);
                }
            }
            at = next[at];
        }
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        if ring.len() > 2 {
            rings.push(ring);
        }
    }
    rings
}

/// What of some polygons lies in a rectangle; those that lie in it whole stay as they are.
pub(crate) fn clipped(area: &[Polygon], window: Bounds) -> Vec<Polygon> {
    let sides = [(DVec2::X, window.min.x, window.max.x), (DVec2::Y, window.min.y, window.max.y)];
    let mut inside = Vec::new();
    for polygon in area {
        match polygon.bounds() {
            Some(b) if window.contains(b.min) && window.contains(b.max) => inside.push(polygon.clone()),
            Some(b) if window.overlaps(&b) => {
                let oriented = polygon.clone().oriented();
                let mut rings: Vec<Ring> = oriented.rings().cloned().collect();
                for (normal, low, high) in sides {
                    rings = split(rings, Line { normal, offset: low }).1;
                    rings = split(rings, Line { normal, offset: high }).0;
                }
                inside.extend(polygons(rings));
            }
            _ => {}
        }
    }
    inside
}

/// Rings put together to polygons: every inner ring goes to the smallest outer one around it.
pub(crate) fn polygons(rings: Vec<Ring>) -> Vec<Polygon> {
    let (outer, inner): (Vec<Ring>, Vec<Ring>) = rings.into_iter().partition(|r| signed_area(r) > 0.0);
    let mut polygons: Vec<Polygon> = outer.into_iter().map(Polygon::simple).collect();
    for hole in inner {
        let holds = |p: &&mut Polygon| hole.iter().any(|&v| Polygon::contains(p, v));
        let home = polygons.iter_mut().filter(holds).min_by(|a, b| a.area_m2().total_cmp(&b.area_m2()));
        if let Some(home) = home {
            home.holes.push(hole);
        }
    }
    polygons
}

pub(crate) fn signed_area(ring: &[DVec2]) -> f64 {
    let Some(&o) = ring.first() else { return 0.0 };
    (0..ring.len()).map(|i| (ring[i] - o).perp_dot(ring[(i + 1) % ring.len()] - o)).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(min: f64, max: f64) -> Ring {
        vec![DVec2::splat(min), DVec2::new(max, min), DVec2::splat(max), DVec2::new(min, max)]
    }

    fn area(rings: &[Ring]) -> f64 {
        rings.iter().map(|r| signed_area(r)).sum()
    }

    #[test]
    fn a_square_with_a_hole_falls_into_two_halves_of_the_right_area() {
        let hole: Ring = square(4.0, 6.0).into_iter().rev().collect();
        let (left, right) = split(vec![square(0.0, 10.0), hole], Line { normal: DVec2::X, offset: 5.0 });
        assert_eq!((left.len(), right.len()), (1, 1));
        assert_eq!((area(&left), area(&right)), (48.0, 48.0));
    }

    #[test]
    fn a_window_shows_the_part_of_an_area_that_lies_in_it() {
        let hole: Ring = square(4.0, 6.0).into_iter().rev().collect();
        let frame = Polygon { exterior: square(0.0, 10.0), holes: vec![hole] };
        let window = Bounds { min: DVec2::new(5.0, -3.0), max: DVec2::new(20.0, 8.0) };
        let seen = clipped(&[frame, Polygon::simple(square(5.5, 5.8)), Polygon::simple(square(30.0, 31.0))], window);
        let total: f64 = seen.iter().map(Polygon::area_m2).sum();
        assert!((total - (40.0 - 2.0 + 0.09)).abs() < 1e-9, "{total}");
    }

    #[test]
    fn a_cut_through_vertices_and_along_edges_keeps_the_area() {
        let comb: Ring = [(0., 0.), (6., 0.), (6., 5.), (5., 5.), (5., 2.), (3., 2.), (3., 5.), (2., 2.), (0., 5.)]
            .map(|(x, y)| DVec2::new(x, y))
            .into();
        for offset in [0.0, 1.0, 2.0, 3.5, 5.0] {
            let (south, north) = split(vec![comb.clone()], Line { normal: DVec2::Y, offset });
            assert!((area(&south) + area(&north) - signed_area(&comb)).abs() < 1e-12);
            assert!(south.iter().flatten().all(|p| p.y <= offset));
            assert!(north.iter().flatten().all(|p| p.y >= offset));
        }
    }
}

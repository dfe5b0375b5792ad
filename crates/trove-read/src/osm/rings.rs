//! From ways in any order and direction to polygons.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use glam::DVec2;
use trove_model::{Bounds, Polygon};

use super::effort::Effort;

/// Two vertices nearer than this are one, metres: OpenStreetMap stores a centimetre.
const SAME_PLACE_M: f64 = 1e-3;
/// Rings below this area are slips of the pen, square metres.
const MIN_AREA_M2: f64 = 0.5;

/// Closed rings of node ids, without the first id again at the end.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Traced {
    pub(super) rings: Vec<Vec<i64>>,
    /// Some edges are part of no ring.
    pub(super) open: bool,
}

/// Joins ways to rings, whatever their roles, order and direction. An edge that two ways share separates nothing and is
/// left out, so areas that touch along an edge become one.
pub(super) fn trace<'a>(ways: impl Iterator<Item = &'a [i64]>) -> Traced {
    let mut edges: BTreeSet<(i64, i64)> = BTreeSet::new();
    for pair in ways.flat_map(|way| way.windows(2)) {
        let edge = (pair[0].min(pair[1]), pair[0].max(pair[1]));
        if edge.0 != edge.1 && !edges.remove(&edge) {
            edges.insert(edge);
        }
    }
    let mut neighbours: BTreeMap<i64, BTreeSet<i64>> = BTreeMap::new();
    for &(a, b) in &edges {
        neighbours.entry(a).or_default().insert(b);
        neighbours.entry(b).or_default().insert(a);
    }
    let mut traced = Traced { open: cut_loose_ends(&mut neighbours), ..Traced::default() };
    while let Some((&start, _)) = neighbours.first_key_value() {
        trace_from(start, &mut neighbours, &mut traced);
    }
    traced
}

/// Removes edges that lead nowhere; whether there were any.
fn cut_loose_ends(neighbours: &mut BTreeMap<i64, BTreeSet<i64>>) -> bool {
    let mut ends: VecDeque<i64> = neighbours.iter().filter(|(_, n)| n.len() == 1).map(|(&id, _)| id).collect();
    let found = !ends.is_empty();
    while let Some(end) = ends.pop_front() {
        let Some(next) = neighbours.get(&end).and_then(|n| n.first().copied()) else { continue };
        remove_edge(neighbours, end, next);
        if neighbours.get(&next).is_some_and(|n| n.len() == 1) {
            ends.push_back(next);
        }
    }
    found
}

fn remove_edge(neighbours: &mut BTreeMap<i64, BTreeSet<i64>>, a: i64, b: i64) {
    for (from, to) in [(a, b), (b, a)] {
        if let Some(n) = neighbours.get_mut(&from) {
            n.remove(&to);
            if n.is_empty() {
                neighbours.remove(&from);
            }
        }
    }
}

/// Walks along edges and cuts off a ring whenever a node is met again, so that every ring is simple.
fn trace_from(start: i64, neighbours: &mut BTreeMap<i64, BTreeSet<i64>>, traced: &mut Traced) {
    let (mut path, mut place) = (vec![start], BTreeMap::from([(start, 0)]));
    while let Some(&current) = path.last() {
        let Some(next) = neighbours.get(&current).and_then(|n| n.first().copied()) else {
            // Nothing leads on: the way back to the last fork is part of no ring.
            path.pop();
            place.remove(&current);
            traced.open |= !path.is_empty();
            continue;
        };
        remove_edge(neighbours, current, next);
        match place.get(&next) {
            None => {
                place.insert(next, path.len());
                path.push(next);
            }
            Some(&at) => {
                let ring = path.split_off(at + 1);
                for id in &ring {
                    place.remove(id);
                }
                traced.rings.push(std::iter::once(next).chain(ring).collect());
            }
        }
    }
}

/// Polygons of some rings by the even-odd rule: a ring inside one other is a hole, inside two an island. Repeated
/// vertices, spikes and crossings of a ring with itself are repaired first.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Repaired {
    pub(super) polygons: Vec<Polygon>,
    /// A ring crossed itself and was cut there.
    pub(super) crossed: bool,
    /// A ring had no area to speak of.
    pub(super) vanished: bool,
    /// Rings were left out because they would take too long.
    pub(super) tangled: bool,
}

/// See [`Repaired`]; the rings are open (the last vertex is not the first again).
pub(super) fn polygons(rings: impl IntoIterator<Item = Vec<DVec2>>, effort: &Effort) -> Repaired {
    let mut repaired = Repaired::default();
    let mut simple = Vec::new();
    for ring in rings {
        let Some(loops) = untangled(cleaned(ring), effort) else {
            repaired.tangled = true;
            continue;
        };
        repaired.crossed |= loops.len() > 1;
        let before = simple.len();
        simple.extend(loops.into_iter().map(cleaned).filter(|l| l.len() > 2 && area_m2(l) >= MIN_AREA_M2));
        repaired.vanished |= simple.len() == before;
    }
    // Each ring is looked for in every other.
    let corners: usize = simple.iter().map(Vec::len).sum();
    if simple.len() > 1 && !effort.spend(corners.saturating_mul(corners)) {
        repaired.tangled = true;
    } else {
        repaired.polygons = nested(simple);
    }
    repaired
}

fn area_m2(ring: &[DVec2]) -> f64 {
    (0..ring.len()).map(|i| ring[i].perp_dot(ring[(i + 1) % ring.len()])).sum::<f64>().abs() / 2.0
}

/// Without repeated vertices and without spikes (out and back again).
fn cleaned(ring: Vec<DVec2>) -> Vec<DVec2> {
    let same = |a: DVec2, b: DVec2| a.distance_squared(b) < SAME_PLACE_M * SAME_PLACE_M;
    let mut clean: Vec<DVec2> = Vec::with_capacity(ring.len());
    for p in ring {
        if clean.last().is_some_and(|&q| same(p, q)) {
            continue;
        }
        if clean.len() > 1 && same(p, clean[clean.len() - 2]) {
            clean.pop();
            continue;
        }
        clean.push(p);
    }
    // The same across the seam.
    while clean.len() > 2 {
        let n = clean.len();
        if same(clean[n - 1], clean[0]) || same(clean[n - 2], clean[0]) {
            clean.pop();
        } else if same(clean[n - 1], clean[1]) {
            clean.remove(0);
        } else {
            break;
        }
    }
    clean
}

/// A ring cut in two wherever it crosses itself; `None` where that takes too long.
fn untangled(ring: Vec<DVec2>, effort: &Effort) -> Option<Vec<Vec<DVec2>>> {
    // Each cut takes a crossing away; more cuts than vertices mean that rounding makes new ones.
    let (mut waiting, mut simple, mut cuts) = (vec![ring], Vec::new(), 0);
    while let Some(mut ring) = waiting.pop() {
        match first_crossing(&ring, effort)?.filter(|_| cuts < 1000) {
            None => simple.push(ring),
            Some((i, j, at)) => {
                cuts += 1;
                let mut cut_off = ring.split_off(i + 1);
                let mut tail = cut_off.split_off(j - i);
                ring.push(at);
                ring.append(&mut tail);
                cut_off.push(at);
                waiting.extend([ring, cut_off]);
            }
        }
    }
    Some(simple)
}

/// Two edges of a ring by their first vertices, the lower one first, and where they cross.
type Crossing = (usize, usize, DVec2);

/// A crossing of a ring with itself, where there is one; `None` where finding out takes too long.
fn first_crossing(ring: &[DVec2], effort: &Effort) -> Option<Option<Crossing>> {
    let n = ring.len();
    let edge = |i: usize| (ring[i], ring[(i + 1) % n]);
    // From west to east, so that each edge meets those only that overlap it in x.
    let mut order: Vec<usize> = (0..n).collect();
    let west = |i: usize| edge(i).0.x.min(edge(i).1.x);
    order.sort_by(|&a, &b| west(a).total_cmp(&west(b)));
    for (k, &a) in order.iter().enumerate() {
        let east = edge(a).0.x.max(edge(a).1.x);
        for &b in order[k + 1..].iter().take_while(|&&b| west(b) <= east) {
            if !effort.spend(1) {
                return None;
            }
            let (i, j) = (a.min(b), a.max(b));
            if let Some(at) = crossing(edge(i), edge(j)) {
                return Some(Some((i, j, at)));
            }
        }
    }
    Some(None)
}

/// Where two segments cross between their ends.
fn crossing((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)) -> Option<DVec2> {
    let (ab, cd) = (b - a, d - c);
    let denominator = ab.perp_dot(cd);
    if denominator == 0.0 {
        return None;
    }
    let t = (c - a).perp_dot(cd) / denominator;
    let u = (c - a).perp_dot(ab) / denominator;
    // Within half a millimetre of an end it is a touch.
    let (dt, du) = (0.5 * SAME_PLACE_M / ab.length(), 0.5 * SAME_PLACE_M / cd.length());
    (t > dt && t < 1.0 - dt && u > du && u < 1.0 - du).then(|| a + ab * t)
}

fn nested(rings: Vec<Vec<DVec2>>) -> Vec<Polygon> {
    let rings: Vec<(Polygon, Option<Bounds>)> = rings
        .into_iter()
        .map(|ring| {
            let bounds = Bounds::around(ring.iter().copied());
            (Polygon::simple(ring), bounds)
        })
        .collect();
    let containers = |i: usize| -> Vec<usize> {
        let (ring, bounds) = &rings[i];
        let overlapping = |other: &Option<Bounds>| matches!((bounds, other), (Some(a), Some(b)) if a.overlaps(b));
        let around = |j: &usize| *j != i && overlapping(&rings[*j].1) && lies_in(&ring.exterior, &rings[*j].0);
        (0..rings.len()).filter(around).collect()
    };
    let containers: Vec<Vec<usize>> = (0..rings.len()).map(containers).collect();
    let mut polygons: Vec<(usize, Polygon)> = Vec::new();
    for (i, around) in containers.iter().enumerate() {
        if around.len().is_multiple_of(2) {
            polygons.push((i, rings[i].0.clone()));
        }
    }
    for (i, around) in containers.iter().enumerate() {
        if !around.len().is_multiple_of(2) {
            // Its outer ring is the innermost of those around it.
            let outer = around.iter().copied().max_by_key(|&j| containers[j].len());
            if let Some((_, polygon)) = polygons.iter_mut().find(|(j, _)| Some(*j) == outer) {
                polygon.holes.push(rings[i].0.exterior.clone());
            }
        }
    }
    polygons.into_iter().map(|(_, polygon)| polygon.oriented()).collect()
}

/// Whether most of a ring's edges lie in a polygon; single vertices may touch it.
fn lies_in(ring: &[DVec2], polygon: &Polygon) -> bool {
    let middle = |i: usize| (ring[i] + ring[(i + 1) % ring.len()]) / 2.0;
    let inside = (0..ring.len()).filter(|&i| polygon.contains(middle(i))).count();
    2 * inside > ring.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn polygons(rings: impl IntoIterator<Item = Vec<DVec2>>) -> Repaired {
        super::polygons(rings, &Effort::default())
    }

    fn ring(points: &[[f64; 2]]) -> Vec<DVec2> {
        points.iter().map(|&p| DVec2::from_array(p)).collect()
    }

    #[test]
    fn ways_in_any_order_and_direction_make_one_ring() {
        let ways: [&[i64]; 3] = [&[1, 2, 3], &[5, 1], &[5, 4, 3]];
        let traced = trace(ways.into_iter());
        assert_eq!(traced, Traced { rings: vec![vec![1, 2, 3, 4, 5]], open: false });
    }

    #[test]
    fn what_does_not_close_is_left_out_and_what_does_is_kept() {
        let ways: [&[i64]; 3] = [&[1, 2, 3, 1], &[3, 7, 8], &[20, 21]];
        assert_eq!(trace(ways.into_iter()), Traced { rings: vec![vec![1, 2, 3]], open: true });
    }

    #[test]
    fn areas_that_share_an_edge_become_one() {
        let ways: [&[i64]; 2] = [&[1, 2, 3, 4, 1], &[2, 5, 6, 3, 2]];
        let traced = trace(ways.into_iter());
        assert_eq!(traced.rings, [vec![1, 2, 5, 6, 3, 4]]);
    }

    #[test]
    fn a_bow_tie_becomes_two_triangles() {
        let repaired = polygons([ring(&[[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]])]);
        assert!(repaired.crossed);
        let areas: Vec<f64> = repaired.polygons.iter().map(Polygon::area_m2).collect();
        assert_eq!(areas, [4.0, 4.0]);
    }

    #[test]
    fn spikes_and_repeated_vertices_are_cut_off() {
        let repaired = polygons([ring(&[[0., 0.], [4., 0.], [4., 0.], [9., 0.], [4., 0.], [4., 4.], [0., 4.]])]);
        assert_eq!(repaired.polygons, [Polygon::simple(ring(&[[0., 0.], [4., 0.], [4., 4.], [0., 4.]]))]);
        assert!(polygons([ring(&[[0., 0.], [4., 0.], [8., 0.]])]).vanished);
    }

    #[test]
    fn holes_and_islands_nest() {
        let square = |low: f64, high: f64| ring(&[[low, low], [high, low], [high, high], [low, high]]);
        let repaired = polygons([square(4.0, 6.0), square(0.0, 10.0), square(2.0, 8.0)]);
        let shape = |p: &Polygon| (p.area_m2(), p.holes.len());
        assert_eq!(repaired.polygons.iter().map(shape).collect::<Vec<_>>(), [(4.0, 0), (64.0, 1)]);
    }

    #[test]
    fn an_outline_that_takes_too_long_is_left_out() {
        // Every edge of the star crosses nearly every other.
        let star =
            |n: usize| (0..n).map(move |i| DVec2::from_angle((i * (n / 2)) as f64 / n as f64 * std::f64::consts::TAU));
        let tangled = super::polygons([star(5001).map(|p| p * 100.0).collect()], &Effort::of(100_000));
        assert!(tangled.tangled && tangled.polygons.is_empty());
        assert!(!polygons([star(5).map(|p| p * 100.0).collect()]).tangled);
    }

    proptest! {
        #[test]
        fn any_ring_becomes_polygons_whose_rings_do_not_cross(
            points in prop::collection::vec((0..12i32, 0..12i32), 0..14),
        ) {
            let ring = points.iter().map(|&(x, y)| DVec2::new(f64::from(x), f64::from(y))).collect();
            for polygon in polygons([ring]).polygons {
                prop_assert!(polygon.rings().all(|r| r.len() > 2 && first_crossing(r, &Effort::default()) == Some(None)));
            }
        }
    }
}

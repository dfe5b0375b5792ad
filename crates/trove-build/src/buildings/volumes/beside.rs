//! What stands beside the walls: walls that touch are drawn apart by a centimetre, and know how far they are hidden.

use glam::DVec2;
use rayon::prelude::*;
use trove_model::{Bounds, Polygon};

use super::house::{Beside, Cover, House};
use crate::geometry::near::Near;

/// Walls of two volumes that run along each other are at least this far apart, metres.
const APART_M: f64 = 0.01;
/// So far apart they count as one wall, and overlap at most, metres.
const TOUCHING_M: f64 = 0.12;
const OVERLAP_M: f64 = 0.08;
/// Walls that run along each other do so to this (sine).
const ALONG: f64 = 0.035;
/// What is further away is in nothing's way, metres.
const ROOM_M: f64 = 1.6;
/// A volume as others see it.
struct Neighbour {
    floor_m: f64,
    /// Walls of models are not where their footprints are, to the centimetre.
    hides: bool,
    rings: Vec<Vec<DVec2>>,
    /// World heights.
    bottom_m: f64,
    eaves_m: f64,
    top_m: f64,
}

/// Draws touching walls apart, and tells every volume what stands beside it.
pub(in crate::buildings) fn beside(houses: &mut [House<'_>]) {
    let mut neighbours: Vec<Neighbour> = Vec::new();
    let mut boxes: Vec<Option<Bounds>> = Vec::new();
    for house in houses.iter() {
        for volume in &house.volumes {
            boxes.push(volume.footprint.bounds());
            neighbours.push(Neighbour {
                floor_m: house.floor_m,
                hides: house.model.is_none(),
                rings: volume.footprint.rings().cloned().collect(),
                bottom_m: volume.bottom_m + house.floor_m,
                eaves_m: volume.eaves_m + house.floor_m,
                top_m: volume.top_m + house.floor_m,
            });
        }
    }
    let near = Near::new(boxes.iter().copied());
    let around = |i: usize| {
        boxes[i].into_iter().flat_map(|b| near.at(b.grown(ROOM_M))).filter(move |&j| j != i).collect::<Vec<_>>()
    };
    let drawn: Vec<(Polygon, Vec<Beside>)> = (0..neighbours.len())
        .into_par_iter()
        .map(|i| {
            let own = &neighbours[i];
            let near: Vec<(usize, &Neighbour)> = around(i).into_iter().map(|j| (j, &neighbours[j])).collect();
            let touching = |edge: (DVec2, DVec2)| moved_by_touch(edge, own, i, &near);
            let footprint = drawn_in(&own.rings, touching);
            let sides: Vec<Beside> = footprint.edges().map(|edge| side(edge, own, &near)).collect();
            (footprint, sides)
        })
        .collect();
    let volumes = houses.iter_mut().flat_map(|h| &mut h.volumes);
    for (volume, (footprint, sides)) in volumes.zip(drawn) {
        volume.footprint = footprint;
        volume.sides = sides;
    }
}

/// Where another edge runs along an edge against its direction: from, to, and how far outside.
fn along(a: DVec2, b: DVec2, edge: (DVec2, DVec2)) -> Option<[f64; 3]> {
    let length_m = a.distance(b);
    let direction = (b - a) / length_m.max(1e-9);
    let (p, q) = (edge.1 - a, edge.0 - a);
    let their = (q - p).normalize_or_zero();
    if their.dot(direction) < 0.5 || their.perp_dot(direction).abs() > ALONG {
        return None;
    }
    let (from, to) = (p.dot(direction).max(0.0), q.dot(direction).min(length_m));
    if to - from < 0.1 {
        return None;
    }
    // The nearest of the two where both run.
    let out = |s: f64| {
        let t = ((s - p.dot(direction)) / (q - p).dot(direction)).clamp(0.0, 1.0);
        -(p + (q - p) * t).dot(direction.perp())
    };
    Some([from, to, out(from).min(out(to))])
}

fn edges(ring: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()]))
}

/// How far an edge has to move in not to lie on the wall of an earlier volume, or of a higher one, metres.
fn moved_by_touch((a, b): (DVec2, DVec2), own: &Neighbour, index: usize, near: &[(usize, &Neighbour)]) -> f64 {
    let yields = |(j, n): &&(usize, &Neighbour)| {
        n.bottom_m < own.top_m && own.bottom_m < n.top_m && (n.top_m, index) > (own.top_m, *j)
    };
    let against = near.iter().filter(yields).flat_map(|(_, n)| n.rings.iter().flat_map(|r| edges(r)));
    against
        .filter_map(|edge| along(a, b, edge))
        .filter(|[_, _, out]| (-OVERLAP_M..APART_M).contains(out))
        .map(|[_, _, out]| APART_M - out)
        .fold(0.0, f64::max)
}

/// Rings with their edges moved in; a ring that would cross itself stays.
fn drawn_in(rings: &[Vec<DVec2>], mut moved_m: impl FnMut((DVec2, DVec2)) -> f64) -> Polygon {
    let mut drawn = rings.iter().map(|ring| {
        let moved: Vec<f64> = edges(ring).map(&mut moved_m).collect();
        drawn_in_ring(ring, &moved).unwrap_or_else(|| ring.clone())
    });
    let exterior = drawn.next().unwrap_or_default();
    Polygon { exterior, holes: drawn.collect() }
}

fn drawn_in_ring(ring: &[DVec2], moved: &[f64]) -> Option<Vec<DVec2>> {
    let n = ring.len();
    let mut drawn = Vec::with_capacity(n + 2);
    let mut starts = Vec::with_capacity(n);
    for i in 0..n {
        let (k, at) = ((i + n - 1) % n, ring[i]);
        let [before, after] = [at - ring[k], ring[(i + 1) % n] - at].map(DVec2::normalize_or_zero);
        let sine = before.perp_dot(after);
        if sine.abs() > 0.3 {
            // Where the moved lines meet.
            let (n1, n2) = (before.perp(), after.perp());
            let (m1, m2) = (moved[k], moved[i]);
            drawn.push(at + DVec2::new(m1 * n2.y - m2 * n1.y, m2 * n1.x - m1 * n2.x) / sine);
        } else {
            drawn.push(at + before.perp() * moved[k]);
            if moved[k] != moved[i] {
                drawn.push(at + after.perp() * moved[i]);
            }
        }
        starts.push(drawn.len() - 1);
    }
    let keeps_its_way = |i: usize| {
        let (from, to) = (drawn[starts[i]], drawn[(starts[i] + 1) % drawn.len()]);
        (to - from).dot(ring[(i + 1) % n] - ring[i]) > 0.0
    };
    (0..n).all(keeps_its_way).then_some(drawn)
}

/// What stands before an edge.
fn side((a, b): (DVec2, DVec2), own: &Neighbour, near: &[(usize, &Neighbour)]) -> Beside {
    let length_m = a.distance(b);
    let direction = (b - a) / length_m.max(1e-9);
    let outward = -direction.perp();
    let mut side = Beside { covers: Vec::new(), length_m, room_m: ROOM_M / 2.0 };
    for (_, other) in near {
        // Roofs are in the way of eaves, walls hide walls.
        let in_the_way = other.top_m > own.eaves_m - 1.0 && other.bottom_m < own.eaves_m + 1.0;
        for edge in other.rings.iter().flat_map(|r| edges(r)) {
            if other.hides
                && other.bottom_m < own.bottom_m + 0.5
                && let Some([from_m, to_m, _]) =
                    along(a, b, edge).filter(|[_, _, out]| (-OVERLAP_M..TOUCHING_M).contains(out))
            {
                let up_to_m = other.eaves_m - own.floor_m;
                side.covers.push(Cover { from_m, to_m, up_to_m });
            }
            if in_the_way {
                let local = |p: DVec2| DVec2::new((p - a).dot(direction), (p - a).dot(outward));
                let free_m = nearest_before(local(edge.0), local(edge.1), length_m);
                side.room_m = side.room_m.min(free_m / 2.0);
            }
        }
    }
    side.covers.sort_by(|x, y| x.from_m.total_cmp(&y.from_m).then(x.to_m.total_cmp(&y.to_m)));
    side
}

/// How near a segment comes to an edge of some length along x from its front, y.
fn nearest_before(p: DVec2, q: DVec2, length_m: f64) -> f64 {
    let (mut low, mut high) = (0.0f64, 1.0f64);
    let way = q - p;
    // Cut to what is before the edge, and a bit beside it.
    for (start, step, least, most) in [(p.x, way.x, -0.5, length_m + 0.5), (p.y, way.y, 0.02, ROOM_M)] {
        if step.abs() < 1e-9 {
            if start < least || start > most {
                return ROOM_M;
            }
        } else {
            let (s, t) = ((least - start) / step, (most - start) / step);
            low = low.max(s.min(t));
            high = high.min(s.max(t));
        }
    }
    if low > high { ROOM_M } else { (p.y + way.y * low).min(p.y + way.y * high).max(0.0) }
}

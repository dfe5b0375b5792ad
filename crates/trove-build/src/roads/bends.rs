//! Streets bend where a map has corners: mappers click points, and join ways wherever the number of lanes changes.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{Road, StreetMap};

/// A street leaves its drawn corner by at most this, metres, and its bend is at most so long to each side.
const OFF_CORNER_M: f64 = 0.6;
const REACH_M: f64 = 12.0;
/// Of the line between two corners each has at most this share.
const SHARE: f64 = 0.45;
/// Bends of less are none; at sharper ones than the second, streets have corners. Degrees.
const BEND_DEG: [f64; 2] = [1.5, 75.0];
/// An arc has a vertex every so many degrees.
const STEP_DEG: f64 = 4.0;

/// A vertex of a road: which road, and where in it.
#[derive(Clone, Copy, Debug)]
struct Spot {
    road: usize,
    vertex: usize,
}

/// The map with the corners of its roads for cars rounded, within ways and where two ways follow one another. What else
/// begins or ends at such a corner follows it; free ends and sharp corners stay. A drive through a place and what is
/// built there want the same map.
pub fn with_bends(mut map: StreetMap) -> StreetMap {
    round(&mut map.roads);
    map
}

fn round(roads: &mut [Road]) {
    let mut corners: BTreeMap<[u64; 2], Vec<Spot>> = BTreeMap::new();
    for (road, line) in roads.iter().enumerate().filter(|(_, r)| r.kind.is_for_cars()) {
        for (vertex, p) in line.centreline.iter().enumerate() {
            corners.entry(p.to_array().map(f64::to_bits)).or_default().push(Spot { road, vertex });
        }
    }
    // What stands for a vertex, in its road's order.
    let mut rounded: BTreeMap<(usize, usize), Vec<DVec2>> = BTreeMap::new();
    for spots in corners.values() {
        let (ends, inner): (Vec<Spot>, Vec<Spot>) = spots.iter().partition(|spot| neighbour(roads, **spot).is_some());
        match (&ends[..], &inner[..]) {
            (ends, &[through]) => {
                let line = &roads[through.road].centreline;
                let [before, at, after] = [through.vertex - 1, through.vertex, through.vertex + 1].map(|i| line[i]);
                if let Some(bend) = bend(before, at, after) {
                    let middle = vec![bend[bend.len() / 2]];
                    rounded.extend(ends.iter().map(|end| ((end.road, end.vertex), middle.clone())));
                    rounded.insert((through.road, through.vertex), bend);
                }
            }
            (&[one, other], []) => {
                let at = roads[one.road].centreline[one.vertex];
                let sides = neighbour(roads, one).zip(neighbour(roads, other));
                if let Some(bend) = sides.and_then(|(before, after)| bend(before, at, after)) {
                    let (first, second) = (&bend[..=bend.len() / 2], &bend[bend.len() / 2..]);
                    // From its inner vertex to its end, or the other way round.
                    let along = |spot: Spot, inwards: bool, half: &[DVec2]| {
                        let forward = inwards == (spot.vertex > 0);
                        if forward { half.to_vec() } else { half.iter().rev().copied().collect() }
                    };
                    rounded.insert((one.road, one.vertex), along(one, true, first));
                    rounded.insert((other.road, other.vertex), along(other, false, second));
                }
            }
            _ => {}
        }
    }
    for ((road, vertex), bend) in rounded.into_iter().rev() {
        roads[road].centreline.splice(vertex..=vertex, bend);
    }
}

/// The vertex beside a road's end; `None` of a vertex that is no end.
fn neighbour(roads: &[Road], Spot { road, vertex }: Spot) -> Option<DVec2> {
    let line = &roads[road].centreline;
    if vertex == 0 { Some(line[1]) } else { (vertex + 1 == line.len()).then(|| line[vertex - 1]) }
}

/// An arc instead of a corner, a parabola with a vertex in its middle; `None` where the line is straight or sharp.
fn bend(before: DVec2, at: DVec2, after: DVec2) -> Option<Vec<DVec2>> {
    let [towards, away] = [at - before, after - at];
    let turn_deg = towards.angle_to(away).abs().to_degrees();
    if !(BEND_DEG[0]..=BEND_DEG[1]).contains(&turn_deg) {
        return None;
    }
    let off_reach_m = 2.0 * OFF_CORNER_M / (turn_deg.to_radians() / 2.0).sin();
    let shortest_m = towards.length().min(away.length());
    let reach_m = (SHARE * shortest_m).min(REACH_M).min(off_reach_m);
    let [from, to] = [at - towards.normalize() * reach_m, at + away.normalize() * reach_m];
    let steps = 2 * (turn_deg / STEP_DEG / 2.0).ceil() as usize;
    let point = |i: usize| {
        let t = i as f64 / steps as f64;
        from.lerp(at, t).lerp(at.lerp(to, t), t)
    };
    Some((0..=steps).map(point).collect())
}

#[cfg(test)]
mod tests {
    use trove_model::RoadKind;

    use super::*;

    fn road(kind: RoadKind, points: &[[f64; 2]]) -> Road {
        Road::new(1, kind, points.iter().copied().map(DVec2::from_array).collect())
    }

    /// The sharpest turn of a line, degrees.
    fn sharpest_deg(line: &[DVec2]) -> f64 {
        line.windows(3).map(|w| (w[1] - w[0]).angle_to(w[2] - w[1]).abs().to_degrees()).fold(0.0, f64::max)
    }

    #[test]
    fn a_corner_within_a_way_becomes_a_bend_near_it() {
        let mut roads = [road(RoadKind::Residential, &[[0.0, 0.0], [40.0, 0.0], [75.0, 20.0]])];
        round(&mut roads);
        let line = &roads[0].centreline;
        assert_eq!([line[0], line[line.len() - 1]], [[0.0, 0.0], [75.0, 20.0]].map(DVec2::from_array));
        assert!(sharpest_deg(line) < 8.0, "{line:?}");
        let corner = DVec2::new(40.0, 0.0);
        let off_m = line.iter().map(|p| p.distance(corner)).fold(f64::INFINITY, f64::min);
        assert!((0.1..0.61).contains(&off_m), "{off_m}");
    }

    #[test]
    fn two_ways_that_follow_one_another_bend_as_one_whichever_way_they_are_drawn() {
        let joint = [40.0, 0.0];
        for (first, second) in [
            ([[0.0, 0.0], joint], [joint, [75.0, 20.0]]),
            ([joint, [0.0, 0.0]], [joint, [75.0, 20.0]]),
            ([[0.0, 0.0], joint], [[75.0, 20.0], joint]),
            ([joint, [0.0, 0.0]], [[75.0, 20.0], joint]),
        ] {
            let mut roads = [road(RoadKind::Primary, &first), road(RoadKind::Primary, &second)];
            round(&mut roads);
            let lines = roads.map(|r| r.centreline);
            let ordered = |line: &[DVec2]| {
                let mut line = line.to_vec();
                line.sort_by(|a, b| a.x.total_cmp(&b.x));
                line
            };
            let [first, second] = lines.map(|line| ordered(&line));
            assert_eq!(first.last(), second.first(), "they still meet");
            let whole = [&first[..], &second[1..]].concat();
            assert!(sharpest_deg(&whole) < 8.0 && whole.len() > 6, "{whole:?}");
        }
    }

    #[test]
    fn a_side_street_follows_the_bend_and_crossings_and_sharp_corners_stay() {
        let bent = [[0.0, 0.0], [40.0, 0.0], [75.0, 20.0]];
        let side = [[40.0, 0.0], [40.0, -50.0]];
        let mut roads = [road(RoadKind::Primary, &bent), road(RoadKind::Residential, &side)];
        round(&mut roads);
        let end = roads[1].centreline[0];
        assert!(roads[0].centreline.contains(&end) && end != DVec2::new(40.0, 0.0), "{end}");

        let across = [[40.0, 30.0], [40.0, 0.0], [42.0, -30.0]];
        let mut roads = [road(RoadKind::Primary, &bent), road(RoadKind::Primary, &across)];
        let before = roads.clone();
        round(&mut roads);
        assert_eq!(roads, before, "a crossroads");

        let mut roads = [road(RoadKind::Primary, &[[0.0, 0.0], [40.0, 0.0], [40.0, 50.0]])];
        let before = roads.clone();
        round(&mut roads);
        assert_eq!(roads, before, "a right angle");
    }

    #[test]
    fn a_ring_is_rounded_where_it_is_closed_too() {
        let corner = |i: i32| DVec2::from_angle(f64::from(i % 8).to_radians() * 45.0) * 15.0;
        let mut roads = [Road::new(1, RoadKind::Primary, (0..=8).map(corner).collect())];
        round(&mut roads);
        let line = &roads[0].centreline;
        assert_eq!(line.first(), line.last());
        assert!(sharpest_deg(line) < 15.0, "{line:?}");
    }
}

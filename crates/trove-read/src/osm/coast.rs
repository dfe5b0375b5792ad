//! Coastlines → the sea.
//!
//! A coastline runs with the land on its left and the water on its right, and no way around the sea exists. Within the
//! area's rectangle the sea's outline is made of the pieces of coastline in it, joined clockwise along the rectangle's
//! edge, which keeps the water on the right as well.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{Bounds, Land, LandKind, Outcome, Polygon, Report, StreetMap};

use super::clip::inside_range;
use super::places::Places;
use super::raw::{Raw, RawWay};
use super::rings::polygons;

/// A sea with more of the streets and buildings in it comes from a coast with a piece missing; piers are fewer.
const MAX_FLOODED: f64 = 0.2;

/// Adds the sea within the area, where a coastline says that there is one.
pub(super) fn add(raw: &Raw, places: &Places, map: &mut StreetMap, report: &Report) {
    let ways: Vec<&RawWay> = raw.ways.iter().filter(|way| is_coastline(way)).collect();
    let (mut pieces, mut waters, mut islands, mut cut_off) = (Vec::new(), Vec::new(), Vec::new(), false);
    for chain in joined(&ways) {
        let line: Vec<DVec2> = chain.iter().filter_map(|&id| places.of(id)).collect();
        if !places.touched_by(&line) {
            continue;
        }
        let closed = chain.len() > 3 && chain.first() == chain.last();
        if closed && line.iter().all(|&p| places.area.contains(p)) {
            // Counter-clockwise the land is inside.
            let ring = line[1..].to_vec();
            if runs_counter_clockwise(&ring) {
                islands.push(ring)
            } else {
                waters.push(ring)
            }
            continue;
        }
        let clipped = clip(&line, closed, places.area);
        if clipped.ends_inside {
            report.note(Outcome::Dropped, "osm: coastline that ends in the area", format!("node {}", chain[0]));
        }
        cut_off |= clipped.ends_inside;
        pieces.extend(clipped.pieces);
    }
    // Islands alone stand in the sea, unless the mainland's coast is not all in the file.
    if !cut_off && pieces.is_empty() && waters.is_empty() && !islands.is_empty() {
        waters.push(corners(places.area).to_vec());
    }
    waters.extend(closed_along_the_edge(pieces, places.area));
    // An island without water around it would become a lake.
    let seas: Vec<Polygon> = waters.iter().cloned().map(Polygon::simple).collect();
    islands.retain(|island| seas.iter().any(|sea| sea.contains(island[0])));
    let sea = polygons(waters.into_iter().chain(islands), &places.effort).polygons;
    let id = ways.first().map_or(0, |way| way.id);
    if flooded_share(&sea, map) > MAX_FLOODED {
        report.note(
            Outcome::Dropped,
            "osm: sea that would flood the streets (is its coastline complete?)",
            format!("way {id}"),
        );
        return;
    }
    map.land.extend(sea.into_iter().map(|polygon| Land { id, kind: LandKind::Water, polygon }));
}

/// The share of buildings and of places on streets that lie in the sea; bridges and tunnels may.
fn flooded_share(sea: &[Polygon], map: &StreetMap) -> f64 {
    let streets = map.roads.iter().filter(|road| road.layer == 0 && !road.bridge && !road.tunnel);
    let places = streets.flat_map(|road| road.centreline.iter().copied());
    let places = places.chain(map.buildings.iter().map(|building| building.footprint.centroid()));
    let (mut all, mut flooded) = (0u32, 0u32);
    for place in places {
        all += 1;
        flooded += u32::from(sea.iter().any(|polygon| polygon.contains(place)));
    }
    f64::from(flooded) / f64::from(all.max(1))
}

/// Whether a way is a piece of coastline.
pub(super) fn is_coastline(way: &RawWay) -> bool {
    way.tags.get("natural") == "coastline"
}

/// Ways joined end to start, never turned round: their direction says where the water is.
fn joined(ways: &[&RawWay]) -> Vec<Vec<i64>> {
    let ends = |way: &RawWay| Some((*way.nodes.first()?, *way.nodes.last()?));
    let mut by_start: BTreeMap<i64, Vec<i64>> = BTreeMap::new();
    let mut chains = Vec::new();
    for way in ways {
        match ends(way) {
            Some((start, end)) if start != end => {
                by_start.insert(start, way.nodes.clone());
            }
            Some(_) => chains.push(way.nodes.clone()),
            None => {}
        }
    }
    while let Some((_, mut chain)) = by_start.pop_first() {
        // On from its end, then back from its start by trying all that end there.
        while let Some(next) = chain.last().and_then(|end| by_start.remove(end)) {
            chain.extend_from_slice(&next[1..]);
        }
        while let Some(start) = by_start.iter().find(|(_, way)| way.last() == chain.first()).map(|(&start, _)| start) {
            let Some(mut before) = by_start.remove(&start) else { break };
            before.extend_from_slice(&chain[1..]);
            chain = before;
        }
        chains.push(chain);
    }
    chains
}

fn runs_counter_clockwise(ring: &[DVec2]) -> bool {
    (0..ring.len()).map(|i| ring[i].perp_dot(ring[(i + 1) % ring.len()])).sum::<f64>() > 0.0
}

#[derive(Default)]
struct Clipped {
    /// Each from the rectangle's edge to its edge.
    pieces: Vec<Vec<DVec2>>,
    /// The line begins or ends within the rectangle; that piece is left out.
    ends_inside: bool,
}

fn clip(line: &[DVec2], closed: bool, area: Bounds) -> Clipped {
    let mut line = line.to_vec();
    if closed && let Some(outside) = line.iter().position(|&p| !area.contains(p)) {
        // A ring is cut open outside.
        line.pop();
        line.rotate_left(outside);
        line.push(line[0]);
    }
    let mut clipped = Clipped::default();
    let mut piece: Option<Vec<DVec2>> = None;
    for pair in line.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let Some((enter, leave)) = inside_range(a, b, area) else { continue };
        if enter > 0.0 {
            piece = Some(vec![a.lerp(b, enter)]);
        }
        clipped.ends_inside |= piece.is_none();
        if let Some(points) = &mut piece {
            points.push(a.lerp(b, leave));
        }
        if leave < 1.0 {
            clipped.pieces.extend(piece.take());
        }
    }
    clipped.ends_inside |= piece.is_some();
    clipped
}

/// Clockwise from the north-west.
fn corners(area: Bounds) -> [DVec2; 4] {
    let (min, max) = (area.min, area.max);
    [DVec2::new(min.x, max.y), max, DVec2::new(max.x, min.y), min]
}

/// Rings of pieces that follow each other clockwise along the rectangle's edge.
fn closed_along_the_edge(pieces: Vec<Vec<DVec2>>, area: Bounds) -> Vec<Vec<DVec2>> {
    let size = area.size_m();
    let around_m = 2.0 * (size.x + size.y);
    // Metres along the edge, clockwise from the north-west corner; the nearest edge counts.
    let along_m = |p: DVec2| {
        let to_edges = [area.max.y - p.y, area.max.x - p.x, p.y - area.min.y, p.x - area.min.x];
        let nearest = (0..4).min_by(|&i, &j| to_edges[i].abs().total_cmp(&to_edges[j].abs())).unwrap_or(0);
        match nearest {
            0 => p.x - area.min.x,
            1 => size.x + area.max.y - p.y,
            2 => size.x + size.y + area.max.x - p.x,
            _ => 2.0 * size.x + size.y + p.y - area.min.y,
        }
    };
    let corners_at = [0.0, size.x, size.x + size.y, 2.0 * size.x + size.y];
    let ahead_m = |from: f64, to: f64| (to - from).rem_euclid(around_m);
    let mut waiting: Vec<Option<Vec<DVec2>>> = pieces.into_iter().map(Some).collect();
    let mut rings = Vec::new();
    while let Some(first) = waiting.iter().position(Option::is_some) {
        let (mut ring, start_at) = (Vec::new(), waiting[first].as_ref().map_or(0.0, |p| along_m(p[0])));
        let mut next = Some(first);
        while let Some(piece) = next.and_then(|i| waiting[i].take()) {
            ring.extend_from_slice(&piece);
            let exit = along_m(piece[piece.len() - 1]);
            // The next piece's beginning, or this ring's own.
            let entry = |i: &usize| waiting[*i].as_ref().map(|p| ahead_m(exit, along_m(p[0])));
            let candidates = (0..waiting.len()).filter_map(|i| Some((i, entry(&i)?)));
            let nearest = candidates.min_by(|a, b| a.1.total_cmp(&b.1));
            let home_m = ahead_m(exit, start_at);
            let (target, distance_m) = match nearest {
                Some((i, distance_m)) if distance_m < home_m => (Some(i), distance_m),
                _ => (None, home_m),
            };
            let mut passed: Vec<(f64, DVec2)> = corners_at
                .into_iter()
                .zip(corners(area))
                .map(|(at, corner)| (ahead_m(exit, at), corner))
                .filter(|(ahead, _)| *ahead < distance_m)
                .collect();
            passed.sort_by(|a, b| a.0.total_cmp(&b.0));
            ring.extend(passed.into_iter().map(|(_, corner)| corner));
            next = target;
        }
        rings.push(ring);
    }
    rings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::osm::effort::Effort;

    const AREA: Bounds = Bounds { min: DVec2::ZERO, max: DVec2::new(10.0, 10.0) };

    fn sea_m2(lines: &[&[[f64; 2]]]) -> f64 {
        let points = |line: &[[f64; 2]]| line.iter().map(|&p| DVec2::from_array(p)).collect::<Vec<_>>();
        let pieces = lines.iter().flat_map(|line| clip(&points(line), false, AREA).pieces).collect();
        polygons(closed_along_the_edge(pieces, AREA), &Effort::default()).polygons.iter().map(Polygon::area_m2).sum()
    }

    #[test]
    fn the_sea_is_on_the_right_of_its_coast() {
        // Northward at x = 4: the water is in the east.
        assert_eq!(sea_m2(&[&[[4.0, -5.0], [4.0, 15.0]]]), 60.0);
        assert_eq!(sea_m2(&[&[[4.0, 15.0], [4.0, -5.0]]]), 40.0);
    }

    #[test]
    fn two_coasts_enclose_a_strait_or_leave_an_isthmus() {
        let (north, south) = ([[4.0, -5.0], [4.0, 15.0]], [[6.0, 15.0], [6.0, -5.0]]);
        assert_eq!(sea_m2(&[&north, &south]), 20.0);
        let (north, south) = ([[6.0, -5.0], [6.0, 15.0]], [[4.0, 15.0], [4.0, -5.0]]);
        assert_eq!(sea_m2(&[&north, &south]), 80.0);
    }

    #[test]
    fn a_coast_that_ends_in_the_area_is_left_out() {
        let clipped = clip(&[DVec2::new(5.0, -5.0), DVec2::new(5.0, 5.0)], false, AREA);
        assert!(clipped.ends_inside && clipped.pieces.is_empty());
    }
}

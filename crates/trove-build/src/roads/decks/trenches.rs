//! Mouths of tunnels: open ramps down between walls, to a portal.

use std::collections::BTreeSet;

use glam::DVec2;
use trove_model::{Outcome, Polygon, Report, Road, StreetMap};

use super::deck::{Deck, EDGE_M, Key, deck, key, split};
use super::lift::Lift;
use crate::geometry::plane::strip;
use crate::geometry::plane_raster::PlaneRaster;
use crate::geometry::segments::SegmentIndex;

/// How deep the road lies at the portal, and how steep it goes there.
const DEPTH_M: f64 = 5.2;
const SLOPE: f64 = 0.11;
/// A portal stands where a hill is so much higher than the mouth, and the road as deep as it goes but for so much; and
/// this far in at least.
const HILL_M: f64 = 1.0;
const NEARLY: f64 = 0.3;
const HILL_FROM_M: f64 = 6.0;
/// How far the tunnel can be looked into.
const INSIDE_M: f64 = 16.0;
/// Beside an open ramp this much is free, from its middle to that of another road.
const BESIDE_M: f64 = 8.0;
/// Near its mouth other roads may join.
const MOUTH_M: f64 = 12.0;

/// The mouth of a tunnel.
#[derive(Clone, Debug)]
pub(in crate::roads) struct Trench<'a> {
    /// From the mouth into the tunnel; heights are below the ground.
    pub deck: Deck<'a>,
    /// The point of its line at which the portal stands.
    pub portal: usize,
}

impl Trench<'_> {
    /// Where the ground is open.
    pub(in crate::roads) fn footprint(&self, carriageway_m: f64) -> Vec<Polygon> {
        strip(&self.deck.line[..=self.portal], carriageway_m / 2.0 + EDGE_M - 0.1)
    }
}

/// The mouths of tunnels that meet roads on the ground; those without room for their ramp are reported.
pub(super) fn trenches<'a>(
    tunnels: &[&'a Road],
    ground: &[&Road],
    map: &StreetMap,
    recorded: &PlaneRaster,
    lift: &Lift<'_>,
    report: &Report,
) -> Vec<Trench<'a>> {
    let met: BTreeSet<Key> = ground.iter().flat_map(|r| &r.centreline).map(|&p| key(p)).collect();
    let mut trenches = Vec::new();
    for &road in tunnels {
        report.note(Outcome::Dropped, "road in a tunnel, except its mouths", format_args!("osm way {}", road.id));
        let mut line = road.centreline.clone();
        for _ in 0..2 {
            if met.contains(&key(line[0])) {
                let trench = trench(road, &line, lift);
                if is_free(&trench, ground, map, recorded) {
                    trenches.push(trench);
                } else {
                    let what = "tunnel mouth without room for its ramp";
                    report.note(Outcome::Dropped, what, format_args!("osm way {}", road.id));
                }
            }
            line.reverse();
        }
    }
    trenches
}

fn trench<'a>(road: &'a Road, line: &[DVec2], lift: &Lift<'_>) -> Trench<'a> {
    let most_m = DEPTH_M / SLOPE;
    let line = split(line, most_m + INSIDE_M).0;
    // Under a hill a road goes down less, or not at all.
    let descent_m = |along_m: f64| {
        let at = split(&line, along_m).0.last().copied().unwrap_or_default();
        (DEPTH_M + lift.at(road, at)).clamp(0.0, along_m * SLOPE)
    };
    let deck = deck(road, &line, |along_m| -descent_m(along_m)).lifted(lift);
    let mut along_m = 0.0;
    let reaches = |i: &usize| {
        along_m += deck.line[*i].distance(deck.line[i - 1]);
        along_m >= most_m
            || (along_m > HILL_FROM_M
                && lift.at(road, deck.line[*i]) < -HILL_M
                && deck.heights_m[*i] < NEARLY - DEPTH_M)
    };
    let portal = (1..deck.line.len()).find(reaches).unwrap_or(0);
    // What is seen of the tunnel ends behind the portal.
    let mut inside_m = 0.0;
    let seen = |i: &usize| {
        inside_m += deck.line[*i].distance(deck.line[i - 1]);
        inside_m > INSIDE_M
    };
    let end = (portal + 1..deck.line.len()).find(seen).map_or(deck.line.len(), |i| i + 1);
    let deck = Deck { line: deck.line[..end].to_vec(), heights_m: deck.heights_m[..end].to_vec(), ..deck };
    Trench { deck, portal }
}

/// Whether the tunnel is long enough, and nothing stands or drives above its ramp.
fn is_free(trench: &Trench<'_>, ground: &[&Road], map: &StreetMap, recorded: &PlaneRaster) -> bool {
    let line = &trench.deck.line;
    let Some(end) = line.last().filter(|_| trench.portal > 0) else { return false };
    let others = SegmentIndex::new(ground.iter().map(|r| r.centreline.as_slice()));
    let open = &line[..=trench.portal];
    let beyond_mouth = open.iter().filter(|p| p.distance(line[0]) > MOUTH_M);
    let built = |p: &DVec2| {
        let near = |b: &Polygon| b.bounds().is_some_and(|b| b.grown(BESIDE_M).contains(*p));
        let close = |b: &Polygon| b.contains(*p) || b.edge_distance_m(*p) < BESIDE_M / 2.0;
        map.buildings.iter().any(|b| near(&b.footprint) && close(&b.footprint))
    };
    end.distance(line[0]) > MOUTH_M
        && open.iter().all(|&p| recorded.at(p) == 0)
        && beyond_mouth.clone().all(|&p| others.nearest(p, BESIDE_M).is_none())
        && !open.iter().any(built)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::{Bounds, RoadKind};

    #[test]
    fn a_tunnel_opens_where_it_has_room_and_is_reported_where_a_road_lies_on_it() {
        let road = |id, points: &[[f64; 2]]| crate::testing::road(id, RoadKind::Primary, points);
        let tunnel = Road { tunnel: true, layer: -1, ..road(1, &[[0.0, 0.0], [300.0, 0.0]]) };
        let roads = [
            road(2, &[[-90.0, 0.0], [0.0, 0.0]]),
            road(3, &[[300.0, 0.0], [390.0, 0.0]]),
            road(4, &[[270.0, -50.0], [270.0, 50.0]]),
        ];
        let ground: Vec<&Road> = roads.iter().collect();
        let recorded = PlaneRaster::new(Bounds::square(DVec2::ZERO, 900.0), 1.0);
        let report = Report::default();
        let flat = trove_model::HeightField::flat(Bounds::square(DVec2::ZERO, 900.0), 0.0);
        let lift = Lift { ground: &flat, spans: &crate::ground::Spans::default() };
        let trenches = trenches(&[&tunnel], &ground, &StreetMap::default(), &recorded, &lift, &report);
        assert_eq!(trenches.len(), 1);
        let (deck, portal) = (&trenches[0].deck, trenches[0].portal);
        assert!((deck.line[portal].x - DEPTH_M / SLOPE).abs() < 2.1 && deck.heights_m[portal] < 0.3 - DEPTH_M);
        assert!(report.entries().iter().any(|e| e.what.contains("mouth") && e.count == 1));
    }
}

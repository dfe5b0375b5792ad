//! Where roads meet: their corners are rounded there, and nothing is parked.

use std::collections::BTreeMap;

use glam::DVec2;
use rayon::prelude::*;
use trove_model::{Bounds, Polygon, Road, RoadKind};

use super::network::Stretch;
use crate::geometry::plane::{closed, difference, disc, intersection, rectangle, union};

/// Vertices nearer than this are one, metres; ways that meet share a node.
const SAME_M: f64 = 0.01;
/// Islands that roads leave between them are as large as this, m².
const ISLAND_M2: f64 = 8.0;
/// What lies at a corner reaches this many times as far as its road is wide and its corner round.
const REACH: f64 = 1.3;

/// A point that roads share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub at: DVec2,
    /// Ends of roads that lead away from it; a road that passes counts twice.
    pub arms: u32,
    /// How often roads touch it.
    touches: u32,
    /// Half of the narrowest and of the widest road's width.
    pub half_widths_m: [f64; 2],
    /// Radius of its corners.
    pub radius_m: f64,
}

impl Node {
    /// How far it reaches along its roads.
    pub(super) fn reach_m(&self) -> f64 {
        (self.half_widths_m[1] + self.radius_m) * REACH
    }
}

/// The nodes at which stretches meet.
pub(super) fn nodes(stretches: &[Stretch<'_>]) -> Vec<Node> {
    let mut nodes: BTreeMap<[i64; 2], Node> = BTreeMap::new();
    for stretch in stretches {
        let half_m = stretch.width_m / 2.0;
        let ends = [stretch.line.first(), stretch.line.last()];
        for at in &stretch.line {
            let node = nodes.entry((*at / SAME_M).round().as_i64vec2().to_array()).or_insert(Node {
                at: *at,
                arms: 0,
                touches: 0,
                half_widths_m: [f64::INFINITY, 0.0],
                radius_m: f64::INFINITY,
            });
            node.arms += if ends.contains(&Some(at)) { 1 } else { 2 };
            node.touches += 1;
            node.half_widths_m = [node.half_widths_m[0].min(half_m), node.half_widths_m[1].max(half_m)];
            node.radius_m = node.radius_m.min(radius_m(stretch.road));
        }
    }
    nodes.into_values().filter(|node| node.touches > 1).collect()
}

/// Corners are as round as the least of the roads needs (kerb radii of RASt 06 and of the *Urban Street Design Guide*).
fn radius_m(road: &Road) -> f64 {
    match road.kind {
        _ if road.link => 9.0,
        RoadKind::Motorway | RoadKind::Trunk | RoadKind::Primary => 9.0,
        RoadKind::Secondary => 7.0,
        RoadKind::Tertiary => 6.0,
        RoadKind::Service => 3.0,
        _ => 4.5,
    }
}

/// What to add to the strips of roads so that they join: round corners at junctions, round joints elsewhere.
pub(super) fn corners(nodes: &[Node], strips: &[Polygon]) -> Vec<Polygon> {
    let bounds: Vec<Option<Bounds>> = strips.iter().map(Polygon::bounds).collect();
    let corner = |node: &Node| -> Vec<Polygon> {
        if node.arms == 2 {
            return vec![disc(node.at, node.half_widths_m[0])];
        }
        let window = Bounds::square(node.at, 2.0 * node.reach_m());
        let near = strips.iter().zip(&bounds).filter(|(_, b)| b.is_some_and(|b| b.overlaps(&window)));
        let joined = union(&near.map(|(strip, _)| strip.clone()).collect::<Vec<_>>());
        let filled = closed(&intersection(&joined, &[rectangle(window)]), node.radius_m);
        // What roads go around stays: roundabouts have their island.
        let islands = joined.into_iter().flat_map(|p| p.holes).map(|hole| Polygon::simple(hole).oriented());
        let islands: Vec<Polygon> = islands.filter(|island| island.area_m2() > ISLAND_M2).collect();
        difference(&filled, &islands)
    };
    nodes.par_iter().flat_map_iter(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane::strip;
    use crate::roads::cross_section::cross_section;

    fn stretch<'a>(road: &'a Road) -> Stretch<'a> {
        let section = cross_section(road, Some(6.0), false);
        Stretch { road, line: road.centreline.clone(), width_m: section.width_m, section }
    }

    #[test]
    fn a_junction_gets_round_corners_and_a_bend_between_ways_a_round_joint() {
        let road = |id, points: &[[f64; 2]]| crate::testing::road(id, RoadKind::Residential, points);
        let roads = [
            road(1, &[[-50.0, 0.0], [0.0, 0.0], [50.0, 0.0]]),
            road(2, &[[0.0, 0.0], [0.0, 50.0]]),
            road(3, &[[0.0, 50.0], [40.0, 60.0]]),
        ];
        let stretches: Vec<Stretch<'_>> = roads.iter().map(stretch).collect();
        let nodes = nodes(&stretches);
        let arms: Vec<u32> = nodes.iter().map(|n| n.arms).collect();
        assert_eq!(arms, [3, 2]);
        let strips: Vec<Polygon> = stretches.iter().flat_map(|s| strip(&s.line, 3.0)).collect();
        let corners = corners(&nodes, &strips);
        let covers = |x, y| corners.iter().any(|c| c.contains(DVec2::new(x, y)));
        // The corner's arc leaves r·(1 − 1/√2) of its diagonal to the road.
        assert!(covers(3.8, 3.8) && covers(-3.8, 3.8) && !covers(5.0, 5.0) && !covers(3.5, -3.5));
        assert!(covers(-1.5, 52.0));

        let ring: Vec<[f64; 2]> =
            (0..=16).map(|i| (DVec2::from_angle(i as f64 * std::f64::consts::FRAC_PI_8) * 6.0).to_array()).collect();
        let mut ring = road(4, &ring);
        ring.centreline[16] = ring.centreline[0];
        let roads = [ring, road(5, &[[6.0, 0.0], [60.0, 0.0]])];
        let stretches: Vec<Stretch<'_>> = roads.iter().map(stretch).collect();
        let strips: Vec<Polygon> = stretches.iter().flat_map(|s| strip(&s.line, 3.0)).collect();
        let corners = super::corners(&super::nodes(&stretches), &strips);
        assert!(!corners.iter().any(|c| c.contains(DVec2::ZERO)), "a roundabout has lost its island");
    }
}

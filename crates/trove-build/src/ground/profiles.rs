//! How high the roads of a map run over a relief: smooth along their course, and no steeper than roads are.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{Road, RoadKind, StreetMap};

/// Heights are told in steps of at most this, metres.
const STEP_M: f64 = 5.0;
/// What is shorter than about this is noise of the relief, or a house in it, metres.
const SMOOTH_M: f64 = 25.0;
/// Passes of over-relaxation, and its factor: long bridges hang from their ends alone.
const RELAXATIONS: usize = 400;
const OVER: f64 = 1.8;
/// Passes that take slopes down to what roads have, and that round off what these leave.
const LEVELLINGS: usize = 600;
const ROUNDINGS: usize = 8;

/// The steepest that a kind of road is.
fn steepest(kind: RoadKind) -> f64 {
    match kind {
        RoadKind::Motorway => 0.07,
        RoadKind::Trunk => 0.09,
        RoadKind::Primary => 0.11,
        RoadKind::Secondary => 0.13,
        RoadKind::Tertiary => 0.15,
        _ => 0.18,
    }
}

/// A short piece of a road, between two points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Index of the road in the map.
    pub road: usize,
    /// Indices of the points.
    pub ends: [usize; 2],
}

/// All roads for cars in short pieces that share points where ways share nodes.
#[derive(Clone, Debug, Default)]
pub(super) struct Profiles {
    pub points: Vec<DVec2>,
    pub heights_m: Vec<f64>,
    pub pieces: Vec<Piece>,
}

impl Profiles {
    /// Over land of a height, metres. Roads on bridges and in tunnels hang between what they join.
    pub(super) fn new(map: &StreetMap, land_m: impl Fn(DVec2) -> f64) -> Self {
        let mut profiles = Self::default();
        let mut nodes: BTreeMap<[i64; 2], usize> = BTreeMap::new();
        // How much of a point lies on the ground.
        let mut grounded: Vec<bool> = Vec::new();
        for (index, road) in map.roads.iter().enumerate().filter(|(_, road)| road.kind.is_for_cars()) {
            let is_grounded = !hangs(road);
            let mut point = |p: DVec2, is_node: bool, profiles: &mut Self| {
                let next = profiles.points.len();
                let key = (p * 100.0).round().as_i64vec2().to_array();
                let at = if is_node { *nodes.entry(key).or_insert(next) } else { next };
                if at == next {
                    profiles.points.push(p);
                    grounded.push(false);
                }
                grounded[at] |= is_grounded;
                at
            };
            let Some(&first) = road.centreline.first() else { continue };
            let mut from = point(first, true, &mut profiles);
            for pair in road.centreline.windows(2) {
                let steps = (pair[0].distance(pair[1]) / STEP_M).ceil().max(1.0);
                for i in 1..=steps as usize {
                    let t = i as f64 / steps;
                    let to = point(pair[0].lerp(pair[1], t), i as f64 == steps, &mut profiles);
                    if to != from {
                        profiles.pieces.push(Piece { road: index, ends: [from, to] });
                    }
                    from = to;
                }
            }
        }
        let land_m: Vec<f64> = profiles.points.iter().map(|&p| land_m(p)).collect();
        profiles.relax(&land_m, &grounded);
        profiles.level(map);
        profiles
    }

    /// A membrane over the land: Σ m (h − land)² + SMOOTH² Σ (Δh)² / length is least (successive over-relaxation).
    fn relax(&mut self, land_m: &[f64], grounded: &[bool]) {
        let mut masses_m = vec![0.0; self.points.len()];
        for piece in &self.pieces {
            let half_m = self.length_m(piece) / 2.0;
            piece.ends.iter().filter(|&&end| grounded[end]).for_each(|&end| masses_m[end] += half_m);
        }
        let neighbours = self.neighbours();
        self.heights_m = land_m.to_vec();
        for _ in 0..RELAXATIONS {
            for (i, near) in neighbours.iter().enumerate() {
                let (mut sum, mut total) = (masses_m[i] * land_m[i], masses_m[i]);
                for &(other, length_m) in near {
                    let pull = SMOOTH_M * SMOOTH_M / length_m;
                    sum += pull * self.heights_m[other];
                    total += pull;
                }
                if total > 0.0 {
                    self.heights_m[i] += OVER * (sum / total - self.heights_m[i]);
                }
            }
        }
    }

    /// Takes slopes down to what the roads' kinds have, both ends giving way alike.
    fn level(&mut self, map: &StreetMap) {
        for _ in 0..LEVELLINGS {
            let mut changed = false;
            for piece in &self.pieces {
                let [a, b] = piece.ends;
                let most_m = steepest(map.roads[piece.road].kind) * self.length_m(piece);
                let rise_m = self.heights_m[b] - self.heights_m[a];
                let excess_m = rise_m - rise_m.clamp(-most_m, most_m);
                if excess_m.abs() > 1e-4 {
                    self.heights_m[a] += excess_m / 2.0;
                    self.heights_m[b] -= excess_m / 2.0;
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
        let neighbours = self.neighbours();
        for _ in 0..ROUNDINGS {
            let before = self.heights_m.clone();
            for (i, near) in neighbours.iter().enumerate().filter(|(_, near)| near.len() > 1) {
                // By distance, so that a steady slope stays as it is.
                let pulls = near.iter().map(|&(other, length_m)| (before[other] / length_m, 1.0 / length_m));
                let (sum, total) = pulls.fold((0.0, 0.0), |(s, t), (ds, dt)| (s + ds, t + dt));
                self.heights_m[i] = 0.5 * before[i] + 0.5 * sum / total;
            }
        }
    }

    fn neighbours(&self) -> Vec<Vec<(usize, f64)>> {
        let mut neighbours = vec![Vec::new(); self.points.len()];
        for piece in &self.pieces {
            let ([a, b], length_m) = (piece.ends, self.length_m(piece));
            neighbours[a].push((b, length_m));
            neighbours[b].push((a, length_m));
        }
        neighbours
    }

    /// Never 0.
    pub(super) fn length_m(&self, piece: &Piece) -> f64 {
        self.points[piece.ends[0]].distance(self.points[piece.ends[1]]).max(0.01)
    }
}

/// Whether a road runs above or below the ground.
pub(super) fn hangs(road: &Road) -> bool {
    road.bridge || road.tunnel || road.layer > 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn road(id: i64, ends: [[f64; 2]; 2]) -> Road {
        crate::testing::road(id, RoadKind::Residential, &ends)
    }

    fn height_m(profiles: &Profiles, p: DVec2) -> f64 {
        let nearest = (0..profiles.points.len())
            .min_by(|&a, &b| profiles.points[a].distance(p).total_cmp(&profiles.points[b].distance(p)));
        profiles.heights_m[nearest.unwrap()]
    }

    #[test]
    fn a_steady_slope_is_kept_and_a_house_in_the_relief_is_not_driven_over() {
        let map = StreetMap { roads: vec![road(1, [[-300.0, 0.0], [300.0, 0.0]])], ..StreetMap::default() };
        let slope = |p: DVec2| 0.08 * p.x;
        let profiles = Profiles::new(&map, slope);
        for x in [-200.0, -55.0, 0.0, 120.0] {
            let p = DVec2::new(x, 0.0);
            assert!((height_m(&profiles, p) - slope(p)).abs() < 0.05, "{x}: {}", height_m(&profiles, p));
        }
        let with_house = Profiles::new(&map, |p| slope(p) + if p.x.abs() < 10.0 { 9.0 } else { 0.0 });
        let steepest = with_house.pieces.iter().map(|piece| {
            let [a, b] = piece.ends.map(|end| with_house.heights_m[end]);
            (b - a).abs() / with_house.length_m(piece)
        });
        assert!(steepest.fold(0.0, f64::max) < 0.181);
        assert!(height_m(&with_house, DVec2::ZERO) < 4.0, "{}", height_m(&with_house, DVec2::ZERO));
    }

    #[test]
    fn a_bridge_runs_straight_over_a_valley_between_the_roads_that_it_joins() {
        let bridge = Road { bridge: true, layer: 1, ..road(2, [[-100.0, 0.0], [100.0, 0.0]]) };
        let roads = vec![road(1, [[-300.0, 0.0], [-100.0, 0.0]]), bridge, road(3, [[100.0, 0.0], [300.0, 0.0]])];
        let map = StreetMap { roads, ..StreetMap::default() };
        let valley = |p: DVec2| 20.0 + 0.02 * p.x - if p.x.abs() < 80.0 { 30.0 } else { 0.0 };
        let profiles = Profiles::new(&map, valley);
        for x in [-60.0, 0.0, 60.0] {
            let found = height_m(&profiles, DVec2::new(x, 0.0));
            assert!((found - (20.0 + 0.02 * x)).abs() < 0.3, "{x}: {found}");
        }
    }
}

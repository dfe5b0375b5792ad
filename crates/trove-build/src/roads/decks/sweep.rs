//! The shape of roads above and below the ground: deck, parapets, sides, piers; trenches with their walls and portals.

use glam::{DVec2, DVec3, Vec2};
use trove_model::Mesh;

use super::deck::{Deck, EDGE_M, SOLID_M};
use super::trenches::Trench;
use crate::ground::Drape;
use crate::roads::cross_section::{CrossSection, Use};

/// Thickness of a deck.
const THICK_M: f64 = 0.9;
/// Parapets.
const PARAPET_M: DVec2 = DVec2::new(0.3, 0.9);
/// Distance of piers, their size along and across the deck, and the lowest deck that has them.
const PIERS_M: f64 = 26.0;
const PIER_M: DVec2 = DVec2::new(1.2, 2.4);
const PIERED_M: f64 = 3.0;
/// Solid ramps go this far into the ground.
const FOOT_M: f64 = 0.3;
/// Height of a tunnel inside, and of the walls of its mouth above the ground.
const INSIDE_M: f64 = 4.6;
const RIM_M: f64 = 1.0;
/// Decks that overlap where roads part lie this much apart, and no nearer than so many decks.
const APART_M: f64 = 0.002;
const APART: usize = 8;
/// A line's width, its height above the asphalt, and its dashes in steps of the deck's line: so many of so many.
const LINE_M: f64 = 0.12;
const PAINT_M: f64 = 0.004;
const DASH: [usize; 2] = [2, 6];

/// Meshes of all decks together.
#[derive(Debug, Default)]
pub(in crate::roads) struct DeckMeshes {
    pub asphalt: Mesh,
    pub paint: Mesh,
    pub concrete: Mesh,
}

/// A deck's points across and along, ready to be swept.
struct Sweep<'a> {
    deck: &'a Deck<'a>,
    half_m: f64,
    /// Height of the asphalt in World.
    tops_m: Vec<f64>,
    grounds_m: Vec<f64>,
    /// Across the line to its left; longer at bends, so that the width stays.
    across: Vec<DVec2>,
}

/// The meshes of decks with their cross-sections; `is_free` tells where a pier may stand.
pub(in crate::roads) fn meshes(
    decks: &[(Deck<'_>, CrossSection)],
    trenches: &[(Trench<'_>, CrossSection)],
    drape: &Drape<'_>,
    is_free: impl Fn(DVec2) -> bool,
) -> DeckMeshes {
    let mut meshes = DeckMeshes::default();
    for (i, (deck, section)) in decks.iter().enumerate() {
        let lift_m = (i % APART) as f64 * APART_M;
        let sweep = Sweep::new(deck, deck.half_width_m(section.width_m), lift_m, drape);
        let half_m = sweep.half_m - PARAPET_M.x;
        sweep.strip(&mut meshes.asphalt, [half_m, -half_m], [0.0, 0.0], |_| true);
        sweep.paint(&mut meshes.paint, section);
        let beside = |p: DVec2, z: f64| {
            decks.iter().enumerate().any(|(k, (other, section))| k != i && covers(other, section, p, z, drape))
        };
        for side in [1.0, -1.0] {
            sweep.side(&mut meshes.concrete, side, beside);
        }
        sweep.underside(&mut meshes.concrete);
        sweep.piers(&mut meshes.concrete, &is_free);
    }
    for (trench, section) in trenches {
        let deck = &trench.deck;
        let sweep = Sweep::new(deck, deck.half_width_m(section.width_m), 0.0, drape);
        let half_m = sweep.half_m - PARAPET_M.x;
        sweep.strip(&mut meshes.asphalt, [half_m, -half_m], [0.0, 0.0], |_| true);
        sweep.paint(&mut meshes.paint, section);
        sweep.trench(&mut meshes.concrete, trench.portal);
    }
    meshes
}

/// Whether another deck lies at a point at about this height.
fn covers(deck: &Deck<'_>, section: &CrossSection, p: DVec2, z: f64, drape: &Drape<'_>) -> bool {
    let half_m = section.width_m / 2.0 + EDGE_M;
    deck.line.windows(2).zip(&deck.heights_m).any(|(pair, height_m)| {
        let along = pair[1] - pair[0];
        let t = (p - pair[0]).dot(along) / along.length_squared();
        (0.0..=1.0).contains(&t)
            && pair[0].lerp(pair[1], t).distance(p) < half_m
            && (drape.height_m(pair[0]) + height_m - z).abs() < 1.5
    })
}

impl<'a> Sweep<'a> {
    fn new(deck: &'a Deck<'a>, half_m: f64, lift_m: f64, drape: &Drape<'_>) -> Self {
        let grounds_m: Vec<f64> = deck.line.iter().map(|&p| drape.height_m(p)).collect();
        let tops_m = grounds_m.iter().zip(&deck.heights_m).map(|(g, h)| g + h + lift_m).collect();
        let way = |i: usize| (deck.line[i + 1] - deck.line[i]).normalize_or_zero().perp();
        let n = deck.line.len();
        let across = (0..n).map(|i| {
            let (before, after) = (way(i.saturating_sub(1).min(n - 2)), way(i.min(n - 2)));
            let sum = before + after;
            sum * 2.0 / sum.length_squared().max(0.5)
        });
        Self { deck, half_m, tops_m, grounds_m, across: across.collect() }
    }

    fn point(&self, i: usize, offset_m: f64, z: f64) -> DVec3 {
        (self.deck.line[i] + self.across[i] * offset_m).extend(z)
    }

    /// Where the deck ends below: at its underside, or in the ground where it is a solid ramp.
    fn bottom_m(&self, i: usize) -> f64 {
        if self.deck.heights_m[i] < SOLID_M { self.grounds_m[i] - FOOT_M } else { self.tops_m[i] - THICK_M }
    }

    /// A strip between two distances to the left of the line, the left one first, seen from above.
    fn strip(&self, mesh: &mut Mesh, offsets_m: [f64; 2], lifts_m: [f64; 2], wanted: impl Fn(usize) -> bool) {
        let mut along_m = 0.0;
        for i in 0..self.deck.line.len() - 1 {
            let length_m = self.deck.line[i].distance(self.deck.line[i + 1]);
            if wanted(i) {
                let corner = |k: usize, side: usize| self.point(k, offsets_m[side], self.tops_m[k] + lifts_m[side]);
                let corners = [corner(i, 1), corner(i + 1, 1), corner(i + 1, 0), corner(i, 0)];
                quad(mesh, corners, [along_m, along_m + length_m], [0.0, offsets_m[0] - offsets_m[1]]);
            }
            along_m += length_m;
        }
    }

    /// Parapet and outer face of one side (1: left); no parapet where another deck joins.
    fn side(&self, mesh: &mut Mesh, side: f64, beside: impl Fn(DVec2, f64) -> bool) {
        let (outer_m, inner_m) = (self.half_m * side, (self.half_m - PARAPET_M.x) * side);
        let joined: Vec<bool> = (0..self.deck.line.len())
            .map(|i| {
                let middle = self.point(i, (outer_m + inner_m) / 2.0, self.tops_m[i]);
                beside(middle.truncate(), middle.z)
            })
            .collect();
        let mut along_m = 0.0;
        for i in 0..self.deck.line.len() - 1 {
            let next_m = along_m + self.deck.line[i].distance(self.deck.line[i + 1]);
            let high_m = if joined[i] || joined[i + 1] { 0.0 } else { PARAPET_M.y };
            let row = |k: usize| {
                let top_m = self.tops_m[k];
                [
                    self.point(k, inner_m, top_m),
                    self.point(k, inner_m, top_m + high_m),
                    self.point(k, outer_m, top_m + high_m),
                    // A ramp's foot is carried on to where the deck leaves the ground.
                    self.point(k, outer_m, self.bottom_m(i)),
                ]
            };
            let (here, there) = (row(i), row(i + 1));
            let mut v_m = 0.0;
            for k in 0..3 {
                let height_m = here[k].distance(here[k + 1]);
                let corners = [here[k], there[k], there[k + 1], here[k + 1]];
                let mut turned = if side > 0.0 { corners } else { [corners[1], corners[0], corners[3], corners[2]] };
                // Both ends have the bottom of the step's start.
                if k == 2 {
                    for (corner, end) in turned
                        .iter_mut()
                        .zip(if side > 0.0 { [i, i + 1, i + 1, i] } else { [i + 1, i, i, i + 1] })
                        .skip(2)
                    {
                        let solid = self.deck.heights_m[i] < SOLID_M;
                        corner.z = if solid { self.grounds_m[end] - FOOT_M } else { self.tops_m[end] - THICK_M };
                    }
                }
                if height_m > 1e-6 {
                    quad(mesh, turned, [along_m, next_m], [v_m, v_m + height_m]);
                }
                v_m += height_m;
            }
            along_m = next_m;
        }
    }

    /// The deck seen from below, and the walls at which solid ramps end.
    fn underside(&self, mesh: &mut Mesh) {
        let solid = |i: usize| self.deck.heights_m[i] < SOLID_M;
        let last = self.deck.line.len() - 1;
        let mut along_m = 0.0;
        for i in 0..last {
            let next_m = along_m + self.deck.line[i].distance(self.deck.line[i + 1]);
            let below = |k: usize, side: f64| self.point(k, self.half_m * side, self.tops_m[k] - THICK_M);
            if !solid(i) {
                let corners = [below(i, 1.0), below(i + 1, 1.0), below(i + 1, -1.0), below(i, -1.0)];
                quad(mesh, corners, [along_m, next_m], [0.0, 2.0 * self.half_m]);
            }
            // The end of a solid ramp, seen from below the deck.
            if i > 0 && solid(i) != solid(i - 1) {
                let foot = |side: f64| self.point(i, self.half_m * side, self.grounds_m[i] - FOOT_M);
                let side = if solid(i) { 1.0 } else { -1.0 };
                let corners = [foot(side), foot(-side), below(i, -side), below(i, side)];
                quad(mesh, corners, [0.0, 2.0 * self.half_m], [0.0, self.deck.heights_m[i]]);
            }
            along_m = next_m;
        }
    }

    /// Walls of a tunnel's mouth up to its portal, and what is seen of the tunnel behind it.
    fn trench(&self, mesh: &mut Mesh, portal: usize) {
        let (inner_m, outer_m) = (self.half_m - PARAPET_M.x, self.half_m);
        let last = self.deck.line.len() - 1;
        let rim_m = |i: usize| self.grounds_m[i] + RIM_M;
        let mut along_m = 0.0;
        for i in 0..last {
            let next_m = along_m + self.deck.line[i].distance(self.deck.line[i + 1]);
            let mut face = |offsets_m: [f64; 2], low: &dyn Fn(usize) -> f64, high: &dyn Fn(usize) -> f64| {
                let corner = |k: usize, at: usize, z: f64| self.point(k, offsets_m[at], z);
                // Faces look to the right of the line's direction where they are given from right to left.
                let corners = [
                    corner(i, 0, low(i)),
                    corner(i + 1, 0, low(i + 1)),
                    corner(i + 1, 1, high(i + 1)),
                    corner(i, 1, high(i)),
                ];
                let height_m = corners[0].distance(corners[3]);
                quad(mesh, corners, [along_m, next_m], [0.0, height_m]);
            };
            let road = |k: usize| self.tops_m[k];
            let ceiling = |k: usize| self.tops_m[k] + INSIDE_M;
            let foot = |k: usize| self.grounds_m[k] - FOOT_M;
            if i < portal {
                face([inner_m, inner_m], &road, &rim_m);
                face([inner_m, outer_m], &rim_m, &rim_m);
                face([outer_m, outer_m], &rim_m, &foot);
                face([-inner_m, -inner_m], &rim_m, &road);
                face([-outer_m, -inner_m], &rim_m, &rim_m);
                face([-outer_m, -outer_m], &foot, &rim_m);
            } else {
                face([inner_m, inner_m], &road, &ceiling);
                face([-inner_m, -inner_m], &ceiling, &road);
                face([inner_m, -inner_m], &ceiling, &ceiling);
            }
            along_m = next_m;
        }
        // The wall above the portal, from both sides, and the dark at the end of what is seen.
        let mut across = |i: usize, low_m: f64, high_m: f64, side: f64, half_m: f64| {
            let (a, b) = (half_m * side, -half_m * side);
            let corners =
                [self.point(i, a, low_m), self.point(i, b, low_m), self.point(i, b, high_m), self.point(i, a, high_m)];
            quad(mesh, corners, [0.0, 2.0 * half_m], [0.0, high_m - low_m]);
        };
        let lintel_m = self.tops_m[portal] + INSIDE_M;
        across(portal, lintel_m, rim_m(portal), 1.0, inner_m);
        across(portal, self.grounds_m[portal] - FOOT_M, rim_m(portal), -1.0, outer_m);
        across(last, self.tops_m[last], self.tops_m[last] + INSIDE_M, 1.0, inner_m);
    }

    fn piers(&self, mesh: &mut Mesh, is_free: impl Fn(DVec2) -> bool) {
        let mut along_m = 0.0;
        let mut next_m = PIERS_M / 2.0;
        for i in 0..self.deck.line.len() - 1 {
            along_m += self.deck.line[i].distance(self.deck.line[i + 1]);
            if along_m < next_m || self.deck.heights_m[i] < PIERED_M {
                continue;
            }
            let across = self.across[i].normalize_or_zero();
            let half = DVec2::new(PIER_M.x, PIER_M.y.min(self.half_m)) / 2.0;
            let corners = [(-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)]
                .map(|(x, y)| self.deck.line[i] - across.perp() * half.x * x + across * half.y * y);
            if !corners.iter().all(|&p| is_free(p)) {
                continue;
            }
            next_m = along_m + PIERS_M;
            let (low_m, high_m) = (self.grounds_m[i] - FOOT_M, self.tops_m[i] - THICK_M);
            for k in 0..4 {
                let (a, b) = (corners[k], corners[(k + 1) % 4]);
                let face = [a.extend(low_m), b.extend(low_m), b.extend(high_m), a.extend(high_m)];
                quad(mesh, face, [0.0, a.distance(b)], [0.0, high_m - low_m]);
            }
        }
    }

    /// Lines between lanes, broken between those of one direction.
    fn paint(&self, mesh: &mut Mesh, section: &CrossSection) {
        let mut stroke = |offset_m: f64, dashed: bool| {
            let edges = [offset_m + LINE_M / 2.0, offset_m - LINE_M / 2.0];
            self.strip(mesh, edges, [PAINT_M; 2], |i| !dashed || i % DASH[1] < DASH[0]);
        };
        if let (Some(first), Some(last)) = (section.bands.first(), section.bands.last()) {
            stroke(first.left_m, false);
            stroke(last.right_m, false);
        }
        for pair in section.bands.windows(2) {
            let apart = [pair[0].usage, pair[1].usage] == [Use::Backward, Use::Forward]
                || [pair[0].usage, pair[1].usage] == [Use::Forward, Use::Backward];
            stroke(pair[0].right_m, !apart);
        }
    }
}

/// Two triangles, counter-clockwise; u runs from the first corner to the second, v to the fourth, in metres.
fn quad(mesh: &mut Mesh, corners: [DVec3; 4], u: [f64; 2], v: [f64; 2]) {
    let normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalize_or_zero().as_vec3();
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(corners.map(DVec3::as_vec3));
    mesh.normals.extend([normal; 4]);
    let uv = |u: f64, v: f64| Vec2::new(u as f32, v as f32);
    mesh.uvs.extend([uv(u[0], v[0]), uv(u[1], v[0]), uv(u[1], v[1]), uv(u[0], v[1])]);
    mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::cross_section::cross_section;
    use trove_model::{Bounds, HeightField, Road, RoadKind};

    #[test]
    fn a_trench_is_seen_from_its_road_and_from_above() {
        let road = crate::testing::road(1, RoadKind::Secondary, &[[0.0, 0.0], [60.0, 0.0]]);
        let deck = crate::roads::decks::deck::deck(&road, &road.centreline, |along_m| -(along_m * 0.11).min(5.2));
        let section = cross_section(&road, None, false);
        let field = HeightField::flat(Bounds::square(DVec2::ZERO, 600.0), 0.0);
        let trench = Trench { deck, portal: 24 };
        let mesh = meshes(&[], &[(trench, section)], &Drape::new(&field), |_| true).concrete;
        assert_eq!(mesh.defect(), None);
        // Someone on the road sees the front of whatever is not above or behind the walls.
        let eye = DVec3::new(10.0, 0.0, 0.5);
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize].as_dvec3());
            let (normal, middle) = ((b - a).cross(c - a).normalize(), (a + b + c) / 3.0);
            let hidden = middle.y.abs() > 4.0 || normal.x > 0.5 || normal.z.abs() > 0.5;
            assert!(hidden || normal.dot(eye - middle) > 0.0, "{middle} {normal}");
        }
    }

    #[test]
    fn a_deck_faces_up_on_top_and_down_below_and_has_no_open_side() {
        let road = Road { bridge: true, ..crate::testing::road(1, RoadKind::Secondary, &[[0.0, 0.0], [200.0, 20.0]]) };
        let rise = |along_m: f64| (along_m * 0.06).min((201.0 - along_m) * 0.06).clamp(0.0, 5.6);
        let deck = crate::roads::decks::deck::deck(&road, &road.centreline, rise);
        let section = cross_section(&road, None, false);
        let field = HeightField::flat(Bounds::square(DVec2::ZERO, 600.0), 0.0);
        let meshes = meshes(&[(deck, section.clone())], &[], &Drape::new(&field), |_| true);
        for mesh in [&meshes.asphalt, &meshes.paint, &meshes.concrete] {
            assert_eq!(mesh.defect(), None);
        }
        let corners = |mesh: &Mesh, t: &[u32; 3]| t.map(|i| mesh.positions[i as usize].as_dvec3());
        let area = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a) / 2.0;
        let top: DVec3 = meshes.asphalt.triangles.iter().map(|t| area(corners(&meshes.asphalt, t))).sum();
        let expected_m2 = 201.0 * (section.width_m + 2.0 * (EDGE_M - PARAPET_M.x));
        assert!((top.z - expected_m2).abs() < 0.02 * expected_m2, "{} {expected_m2}", top.z);
        // Seen from far outside along any direction, as much of the concrete shows its front as its back hides.
        let sum: DVec3 = meshes.concrete.triangles.iter().map(|t| area(corners(&meshes.concrete, t))).sum();
        let tops_m2 = 201.0 * 2.0 * PARAPET_M.x;
        assert!(sum.truncate().length() < 12.0, "{sum}");
        assert!(sum.z < tops_m2, "{sum}");
    }
}

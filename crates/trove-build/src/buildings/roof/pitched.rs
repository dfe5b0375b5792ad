//! Pitched roofs: faces of the straight skeleton under a profile.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use trove_model::{Polygon, RoofShape};

use super::fill;
use super::skeleton::{Skeleton, skeleton};
use crate::buildings::shell::{Shell, Slot};
use crate::buildings::volumes::Volume;

/// Points of an outline that are no further than this off the line of their neighbours make no side, metres.
const STRAIGHT_M: f64 = 0.04;
/// Outlines of more sides than this are not pitched.
const MOST_SIDES: usize = 90;
/// A roof whose outline closes within this has no inside to speak of, metres.
const LEAST_RUN_M: f64 = 0.25;
/// Triangles fill a face to this, m².
const FILLED_M2: f64 = 1e-3;
/// Steps of a barrel's or a dome's arc.
const ARC_STEPS: usize = 6;
/// The end of a wing wider than this is hipped, metres.
const WIDEST_GABLE_M: f64 = 24.0;

/// How a roof rises, in shares of its run and of its height.
#[derive(Clone, Debug)]
struct Profile(Vec<[f64; 2]>);

impl Profile {
    fn of(shape: RoofShape) -> Self {
        let arc = |i: usize| {
            let angle = std::f64::consts::FRAC_PI_2 * i as f64 / ARC_STEPS as f64;
            [1.0 - angle.cos(), angle.sin()]
        };
        Self(match shape {
            RoofShape::Gambrel => vec![[0.0, 0.0], [0.36, 0.64], [1.0, 1.0]],
            RoofShape::Mansard => vec![[0.0, 0.0], [0.24, 0.8], [1.0, 1.0]],
            RoofShape::Round | RoofShape::Dome | RoofShape::Onion => (0..=ARC_STEPS).map(arc).collect(),
            _ => vec![[0.0, 0.0], [1.0, 1.0]],
        })
    }

    fn height(&self, run: f64) -> f64 {
        let at = |pair: &[[f64; 2]]| {
            let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
            (run <= x1).then(|| y0 + (y1 - y0) * (run - x0) / (x1 - x0))
        };
        if run <= 0.0 { 0.0 } else { self.0.windows(2).find_map(at).unwrap_or(1.0) }
    }
}

/// A pitched roof with what is put on and around it in mind.
pub(super) struct Pitched {
    pub skeleton: Skeleton,
    profile: Profile,
    eaves: f64,
    rise_m: f64,
    run_m: f64,
    /// The outline's own points along each side, first and last included.
    chains: Vec<Vec<DVec2>>,
    /// For each side the edge of the footprint where it starts.
    pub edges: Vec<usize>,
    /// The asked-for shape could not be had, and this came out instead.
    pub became: RoofShape,
}

/// Finds the roof of a volume between two levels; `None` where its outline has no skeleton.
pub(super) fn pitched(volume: &Volume<'_>, shape: RoofShape, eaves: f64, top: f64) -> Option<Pitched> {
    let Outline { rings, chains, edges } = Outline::of(&volume.footprint);
    let sides = chains.len();
    if !(3..=MOST_SIDES).contains(&sides) {
        return None;
    }
    let hipped = skeleton(&rings, &vec![0.0; sides])?;
    let starts = starts(volume, shape, &rings, &edges, &hipped);
    let is_gabled = starts.iter().any(|&s| s > 0.0);
    let ends = is_gabled.then(|| skeleton(&rings, &starts)).flatten();
    // A gable on the wrong side makes a roof run across half the house.
    let found = ends.filter(|s| s.last_s() < 2.2 * hipped.last_s());
    let wants_gables =
        matches!(shape, RoofShape::Gabled | RoofShape::Gambrel | RoofShape::Round | RoofShape::HalfHipped);
    let plain = if wants_gables { RoofShape::Hipped } else { shape };
    let forms = found.map(|skeleton| (skeleton, shape)).into_iter().chain([(hipped, plain)]);
    let roof = |(skeleton, became): (Skeleton, RoofShape)| {
        let (run_m, profile) = (skeleton.last_s(), Profile::of(became));
        let (chains, edges) = (chains.clone(), edges.clone());
        Pitched { skeleton, profile, eaves, rise_m: top - eaves, run_m, chains, edges, became }
    };
    forms.map(roof).find(|roof| roof.run_m >= LEAST_RUN_M && roof.is_whole())
}

/// The corners that matter of an outline, and the rest of its points between them.
struct Outline {
    rings: Vec<Vec<DVec2>>,
    chains: Vec<Vec<DVec2>>,
    edges: Vec<usize>,
}

impl Outline {
    fn of(footprint: &Polygon) -> Self {
        let mut outline = Self { rings: Vec::new(), chains: Vec::new(), edges: Vec::new() };
        let mut first_edge = 0;
        for ring in footprint.rings() {
            let n = ring.len();
            let kept = corners(ring);
            if kept.len() >= 3 {
                for (k, &i) in kept.iter().enumerate() {
                    let next = kept[(k + 1) % kept.len()];
                    let length = (next + n - i - 1) % n + 1;
                    outline.chains.push((0..=length).map(|j| ring[(i + j) % n]).collect());
                    outline.edges.push(first_edge + i);
                }
                outline.rings.push(kept.iter().map(|&i| ring[i]).collect());
            }
            first_edge += n;
        }
        outline
    }
}

/// Indices of a ring's corners: points within a nearly straight side are left out.
fn corners(ring: &[DVec2]) -> Vec<usize> {
    let mut kept: Vec<usize> = (0..ring.len()).collect();
    loop {
        let n = kept.len();
        let off = |k: usize| {
            let [a, b, c] = [kept[(k + n - 1) % n], kept[k], kept[(k + 1) % n]].map(|i| ring[i]);
            let along = (c - a).normalize_or_zero();
            // A point that turns back is a corner however near it is.
            if (b - a).dot(along) < 0.0 || (c - b).dot(along) < 0.0 {
                f64::INFINITY
            } else {
                (b - a).perp_dot(along).abs()
            }
        };
        match (0..n).map(|k| (k, off(k))).min_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((k, off_m)) if n > 3 && off_m < STRAIGHT_M => drop(kept.remove(k)),
            _ => return kept,
        }
    }
}

/// When each side starts to lean inwards: party walls and the ends of gabled wings never do.
fn starts(volume: &Volume<'_>, shape: RoofShape, rings: &[Vec<DVec2>], edges: &[usize], hipped: &Skeleton) -> Vec<f64> {
    let n = edges.len();
    let length_m =
        |i: usize| hipped.faces[i].get(1).map_or(0.0, |&b| hipped.nodes[i].position.distance(hipped.nodes[b].position));
    let is_party = |i: usize| volume.sides.get(edges[i]).is_some_and(|s| s.is_covered(volume.eaves_m));
    let neighbours = |i: usize| -> [usize; 2] {
        let mut first = 0;
        for ring in rings {
            if i < first + ring.len() {
                let at = i - first;
                return [first + (at + ring.len() - 1) % ring.len(), first + (at + 1) % ring.len()];
            }
            first += ring.len();
        }
        [i, i]
    };
    let with_ends = matches!(shape, RoofShape::Gabled | RoofShape::Gambrel | RoofShape::Round | RoofShape::HalfHipped);
    if matches!(shape, RoofShape::Pyramidal | RoofShape::Cone | RoofShape::Dome | RoofShape::Onion) {
        return vec![0.0; n];
    }
    // The end of a wing is a side whose hip is a triangle between two convex corners.
    let is_end = |i: usize| {
        let [before, after] = neighbours(i).map(|k| hipped.sides[k].along);
        let along = hipped.sides[i].along;
        let convex = before.perp_dot(along) > 0.5 && along.perp_dot(after) > 0.5;
        with_ends && hipped.faces[i].len() == 3 && convex && length_m(i) < WIDEST_GABLE_M
    };
    let mut wanted: Vec<(bool, f64, usize)> = if n == 4 && rings.len() == 1 {
        // Of a rectangle the pair of sides with the party walls, else the shorter one.
        let party = |k: usize| usize::from(is_party(k)) + usize::from(is_party(k + 2));
        let across = length_m(0) + length_m(2) < length_m(1) + length_m(3);
        let pair = match party(0).cmp(&party(1)) {
            std::cmp::Ordering::Greater => 0,
            std::cmp::Ordering::Less => 1,
            std::cmp::Ordering::Equal => usize::from(across == volume.building.ridge_across),
        };
        [pair, pair + 2].into_iter().filter(|&i| with_ends || is_party(i)).map(|i| (is_party(i), 0.0, i)).collect()
    } else {
        (0..n).filter(|&i| is_party(i) || is_end(i)).map(|i| (is_party(i), length_m(i), i)).collect()
    };
    // Party walls first, the longest before the others; then the narrowest ends.
    wanted.sort_by(|a, b| {
        b.0.cmp(&a.0).then(if a.0 { b.1.total_cmp(&a.1) } else { a.1.total_cmp(&b.1) }).then(a.2.cmp(&b.2))
    });
    let mut starts = vec![0.0; n];
    for (party, _, i) in wanted {
        if neighbours(i).iter().all(|&k| starts[k] == 0.0) {
            let hip = shape == RoofShape::HalfHipped && !party;
            starts[i] = if hip { 0.55 * hipped.last_s() } else { f64::INFINITY };
        }
    }
    starts
}

impl Pitched {
    /// The roof's level when the moving outline has come by.
    pub(super) fn level(&self, time: f64) -> f64 {
        self.eaves + self.rise_m * self.profile.height(time / self.run_m)
    }

    /// Rise over run where a face leaves its eaves.
    pub(super) fn slope_at_eaves(&self) -> f64 {
        let [run, rise] = self.profile.0[1];
        rise * self.rise_m / (run * self.run_m)
    }

    /// Times at which the slope changes.
    pub(super) fn breaks(&self) -> Vec<f64> {
        let inner = &self.profile.0[1..self.profile.0.len() - 1];
        let mut breaks: Vec<f64> = inner.iter().map(|[run, _]| run * self.run_m).collect();
        breaks.extend(self.skeleton.sides.iter().map(|s| s.start).filter(|s| s.is_finite() && *s > 0.0));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
        breaks
    }

    /// The outline's own points along a side, first and last included.
    pub(super) fn chain(&self, side: usize) -> &[DVec2] {
        &self.chains[side]
    }

    pub(super) fn is_gable(&self, side: usize) -> bool {
        self.skeleton.sides[side].start.is_infinite()
    }

    /// A side's face in its own plane, with the outline's own points: along the side, and in time.
    fn in_plane(&self, side: usize) -> Vec<DVec2> {
        let own = &self.skeleton.sides[side];
        let chain = &self.chains[side];
        let between = chain[1..chain.len() - 1].iter().map(|p| DVec2::new((*p - own.from).dot(own.along), 0.0));
        let mut corners = self.skeleton.faces[side].iter().map(|&n| self.skeleton.in_face(side, n));
        corners.next().into_iter().chain(between).chain(corners).collect()
    }

    /// Whether triangles can fill every face: one that crosses itself would leave a hole in the roof.
    fn is_whole(&self) -> bool {
        (0..self.skeleton.faces.len()).filter(|&side| !self.skeleton.faces[side].is_empty()).all(|side| {
            let flat = self.in_plane(side);
            let area_m2 = |i: usize, j: usize, k: usize| (flat[j] - flat[i]).perp_dot(flat[k] - flat[i]) / 2.0;
            let whole_m2: f64 = (1..flat.len() - 1).map(|i| area_m2(0, i, i + 1)).sum();
            let filled_m2: f64 = fill::triangles(&flat).into_iter().map(|[i, j, k]| area_m2(i, j, k)).sum();
            (whole_m2 - filled_m2).abs() <= FILLED_M2
        })
    }

    /// Puts the faces on a shell: slopes as roof, what stands upright as gables.
    pub(super) fn cover(&self, shell: &mut Shell) {
        let breaks = self.breaks();
        // A cut of a border has the same point in both faces.
        let mut points: Vec<DVec3> = self.skeleton.nodes.iter().map(|n| n.position.extend(n.time)).collect();
        let mut cuts: BTreeMap<(usize, usize, usize), usize> = BTreeMap::new();
        for (side, face) in self.skeleton.faces.iter().enumerate() {
            if face.is_empty() {
                continue;
            }
            // The side's own points stand between its ends.
            let between = self.chains[side].len() - 2;
            let mut ring = vec![face[0]];
            for &p in &self.chains[side][1..=between] {
                ring.push(points.len());
                points.push(p.extend(0.0));
            }
            ring.extend(&face[1..]);
            let Some(own) = self.skeleton.sides.get(side) else { continue };
            for triangle in fill::triangles(&self.in_plane(side)) {
                let mut piece: Vec<usize> = triangle.map(|i| ring[i]).to_vec();
                for (level, &time) in breaks.iter().enumerate() {
                    let (below, above) = cut(&piece, level, time, &mut points, &mut cuts);
                    self.face(shell, own.start, &below, &points);
                    piece = above;
                }
                self.face(shell, own.start, &piece, &points);
            }
        }
    }

    fn face(&self, shell: &mut Shell, start: f64, piece: &[usize], points: &[DVec3]) {
        if piece.len() < 3 {
            return;
        }
        let last = piece.iter().map(|&i| points[i].z).fold(0.0, f64::max);
        let corners: Vec<DVec3> = piece.iter().map(|&i| points[i].truncate().extend(self.level(points[i].z))).collect();
        let level = corners.iter().all(|p| (p.z - corners[0].z).abs() < 0.01);
        let slot = if last <= start + 1e-6 && start > 0.0 {
            Slot::Gable
        } else if level {
            Slot::FlatRoof
        } else {
            Slot::PitchedRoof
        };
        shell.slope(slot, &corners);
    }
}

/// The parts of a convex piece below and above a time.
fn cut(
    piece: &[usize],
    level: usize,
    time: f64,
    points: &mut Vec<DVec3>,
    cuts: &mut BTreeMap<(usize, usize, usize), usize>,
) -> (Vec<usize>, Vec<usize>) {
    let (mut below, mut above) = (Vec::new(), Vec::new());
    let side = |z: f64| {
        if (z - time).abs() < 1e-6 {
            0
        } else if z < time {
            -1
        } else {
            1
        }
    };
    for k in 0..piece.len() {
        let (i, j) = (piece[k], piece[(k + 1) % piece.len()]);
        let (a, b) = (points[i], points[j]);
        let (sa, sb) = (side(a.z), side(b.z));
        if sa <= 0 {
            below.push(i);
        }
        if sa >= 0 {
            above.push(i);
        }
        if sa * sb < 0 {
            let (low, high) = (i.min(j), i.max(j));
            let at = *cuts.entry((low, high, level)).or_insert_with(|| {
                let (p, q) = (points[low], points[high]);
                points.push((p + (q - p) * ((time - p.z) / (q.z - p.z))).truncate().extend(time));
                points.len() - 1
            });
            below.push(at);
            above.push(at);
        }
    }
    // What only touches the line has no part there.
    let has_area = |part: &Vec<usize>| part.iter().any(|&i| side(points[i].z) != 0);
    (if has_area(&below) { below } else { Vec::new() }, if has_area(&above) { above } else { Vec::new() })
}

//! The straight skeleton of a footprint (Aichholzer, Aurenhammer, Alberts, Gärtner 1995), by letting its edges move.
//!
//! Every edge of the outline moves inwards at one metre a second from its own start time on, corners staying where
//! the lines of their two edges meet. What an edge sweeps is its face of the roof; an edge that never starts sweeps
//! nothing and has a gable above it. All vertices are looked at after every event: footprints have tens of corners.

use glam::DVec2;

/// Corners nearer to each other than this are one, metres.
const SAME_M: f64 = 2e-3;
/// Edges that run against each other to this (sine) leave a ridge between them.
const PARALLEL: f64 = 1e-4;

/// A corner of the skeleton: where, and when the moving edges came by (which is the roof's height at slope one).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    pub position: DVec2,
    pub time: f64,
}

/// A side of the outline, its inside on the left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub from: DVec2,
    pub along: DVec2,
    /// When it starts to move; infinite for a gable.
    pub start: f64,
}

impl Side {
    fn inward(&self) -> DVec2 {
        self.along.perp()
    }

    fn speed(&self, time: f64) -> f64 {
        if time >= self.start - 1e-9 { 1.0 } else { 0.0 }
    }

    fn offset(&self, time: f64) -> f64 {
        (time - self.start).max(0.0)
    }
}

/// Faces of a roof.
#[derive(Clone, Debug)]
pub(super) struct Skeleton {
    /// The first ones are the corners of the outline, in their order.
    pub nodes: Vec<Node>,
    pub sides: Vec<Side>,
    /// For each side its face, counter-clockwise from the side's start; empty where nothing rises above it.
    pub faces: Vec<Vec<usize>>,
}

/// A corner of the moving outline.
#[derive(Clone, Copy, Debug)]
struct Corner {
    /// Where it is now.
    at: DVec2,
    velocity: DVec2,
    /// Where its trace began.
    node: usize,
    /// The sides before and after it.
    sides: [usize; 2],
    before: usize,
    after: usize,
    alive: bool,
}

#[derive(Clone, Copy, Debug)]
enum Event {
    Collapse,
    Start,
    /// A corner runs into the side behind another corner.
    Split(usize, usize),
}

struct Wavefront {
    skeleton: Skeleton,
    corners: Vec<Corner>,
    time: f64,
    /// Directed borders of each face.
    borders: Vec<Vec<[usize; 2]>>,
}

/// The skeleton of rings (outer counter-clockwise, inner clockwise) whose sides start to move at the times given, ring
/// by ring; `None` where rounding led it astray.
pub(super) fn skeleton(rings: &[Vec<DVec2>], starts: &[f64]) -> Option<Skeleton> {
    let mut front = Wavefront {
        skeleton: Skeleton { nodes: Vec::new(), sides: Vec::new(), faces: Vec::new() },
        corners: Vec::new(),
        time: 0.0,
        borders: Vec::new(),
    };
    for ring in rings {
        let (first, n) = (front.corners.len(), ring.len());
        for (i, &at) in ring.iter().enumerate() {
            let along = (ring[(i + 1) % n] - at).try_normalize()?;
            let side = first + i;
            front.skeleton.sides.push(Side { from: at, along, start: *starts.get(side)? });
            front.skeleton.nodes.push(Node { position: at, time: 0.0 });
            front.corners.push(Corner {
                at,
                velocity: DVec2::ZERO,
                node: side,
                sides: [first + (i + n - 1) % n, side],
                before: first + (i + n - 1) % n,
                after: first + (i + 1) % n,
                alive: true,
            });
            front.borders.push(vec![[side, first + (i + 1) % n]]);
        }
    }
    front.run(rings.iter().map(|r| signed_area_m2(r)).sum())
}

impl Wavefront {
    fn run(mut self, outline_m2: f64) -> Option<Skeleton> {
        let limit = 12 * self.corners.len() + 60;
        for _ in 0..limit {
            self.clean()?;
            if self.corners.iter().all(|c| !c.alive) {
                return self.finish(outline_m2);
            }
            self.steer()?;
            let (time, event) = self.next_event()?;
            let step = time - self.time;
            for corner in self.corners.iter_mut().filter(|c| c.alive) {
                corner.at += corner.velocity * step;
            }
            self.time = time;
            if let Event::Split(corner, side) = event {
                self.split(corner, side);
            }
        }
        None
    }

    fn side(&self, i: usize) -> &Side {
        &self.skeleton.sides[i]
    }

    /// The node at a place; a new one where there is none.
    fn node(&mut self, position: DVec2) -> usize {
        let time = self.time;
        let same = |n: &Node| n.position.distance(position) < SAME_M && (n.time - time).abs() < SAME_M;
        match self.skeleton.nodes.iter().position(same) {
            Some(i) => i,
            None => {
                self.skeleton.nodes.push(Node { position, time });
                self.skeleton.nodes.len() - 1
            }
        }
    }

    fn border(&mut self, face: usize, from: usize, to: usize) {
        if from != to {
            self.borders[face].push([from, to]);
        }
    }

    /// Ends a corner's trace at a node.
    fn end(&mut self, corner: usize, node: usize) {
        let Corner { node: from, sides: [left, right], .. } = self.corners[corner];
        self.border(left, from, node);
        self.border(right, node, from);
        self.corners[corner].alive = false;
    }

    /// A new corner between two, on the given sides.
    fn corner(&mut self, at: DVec2, node: usize, sides: [usize; 2], before: usize, after: usize) {
        let i = self.corners.len();
        self.corners.push(Corner { at, velocity: DVec2::ZERO, node, sides, before, after, alive: true });
        self.corners[before].after = i;
        self.corners[after].before = i;
    }

    /// Takes out sides without length, spikes, and loops that have closed.
    fn clean(&mut self) -> Option<()> {
        let mut i = 0;
        let limit = 40 * self.corners.len() + 400;
        let mut steps = 0;
        while i < self.corners.len() {
            steps += 1;
            if steps > limit {
                return None;
            }
            if !self.corners[i].alive {
                i += 1;
                continue;
            }
            let here = self.corners[i];
            let next = self.corners[here.after];
            if here.after == i {
                let node = self.node(here.at);
                self.end(i, node);
            } else if here.after == here.before {
                // Two corners left: what is between them is a ridge.
                let (a, b) = (self.node(here.at), self.node(next.at));
                self.end(i, a);
                self.end(here.after, b);
                self.border(here.sides[1], b, a);
                self.border(next.sides[1], a, b);
            } else if here.at.distance(next.at) < SAME_M {
                let node = self.node(here.at);
                self.end(i, node);
                self.end(here.after, node);
                self.corner(here.at, node, [here.sides[0], next.sides[1]], here.before, next.after);
                // What was before may have changed.
                i = here.before.min(i);
                continue;
            } else if self.spike(i) {
                i = here.before.min(here.after).min(i);
                continue;
            }
            i += 1;
        }
        Some(())
    }

    /// Takes the tip off a spike: its two sides lie on each other, as far as the shorter one goes, as a ridge.
    fn spike(&mut self, tip: usize) -> bool {
        let here = self.corners[tip];
        let [left, right] = here.sides.map(|s| self.side(s).along);
        if left.dot(right) > 0.0 || left.perp_dot(right).abs() > PARALLEL {
            return false;
        }
        let (before, after) = (self.corners[here.before], self.corners[here.after]);
        let (to_before, to_after) = (here.at.distance(before.at), here.at.distance(after.at));
        // A corner of a thin wedge that is still open is none.
        let along = (after.at - here.at) / to_after;
        if (before.at - here.at).perp_dot(along).abs() > SAME_M || (before.at - here.at).dot(along) < 0.0 {
            return false;
        }
        let tip_node = self.node(here.at);
        if to_after <= to_before {
            let node = self.node(after.at);
            self.end(tip, tip_node);
            self.end(here.after, node);
            self.border(here.sides[1], node, tip_node);
            self.border(here.sides[0], tip_node, node);
            self.corner(after.at, node, [here.sides[0], after.sides[1]], here.before, after.after);
        } else {
            let node = self.node(before.at);
            self.end(tip, tip_node);
            self.end(here.before, node);
            self.border(here.sides[0], tip_node, node);
            self.border(here.sides[1], node, tip_node);
            self.corner(before.at, node, [before.sides[0], here.sides[1]], before.before, here.after);
        }
        true
    }

    /// Velocities from the sides' lines.
    fn steer(&mut self) -> Option<()> {
        for i in 0..self.corners.len() {
            let corner = self.corners[i];
            if !corner.alive {
                continue;
            }
            let [left, right] = corner.sides.map(|s| *self.side(s));
            let (n1, n2) = (left.inward(), right.inward());
            let (s1, s2) = (left.speed(self.time), right.speed(self.time));
            let det = n1.perp_dot(n2);
            self.corners[i].velocity = if det.abs() > PARALLEL {
                DVec2::new(s1 * n2.y - s2 * n1.y, s2 * n1.x - s1 * n2.x) / det
            } else if s1 == s2 && n1.dot(n2) > 0.0 {
                n1 * s1
            } else {
                return None;
            };
        }
        Some(())
    }

    /// What happens next, and when.
    fn next_event(&self) -> Option<(f64, Event)> {
        let mut best: Option<(f64, Event)> = None;
        let mut offer = |time: f64, event: Event| {
            if best.is_none_or(|(t, _)| time < t - 1e-9) {
                best = Some((time, event));
            }
        };
        for side in &self.skeleton.sides {
            if side.start.is_finite() && side.start > self.time + 1e-9 {
                offer(side.start, Event::Start);
            }
        }
        let alive = || self.corners.iter().enumerate().filter(|(_, c)| c.alive);
        for (_, corner) in alive() {
            let next = &self.corners[corner.after];
            let along = self.side(corner.sides[1]).along;
            let (length, closing) = ((next.at - corner.at).dot(along), (corner.velocity - next.velocity).dot(along));
            if closing > 1e-9 {
                offer(self.time + (length / closing).max(0.0), Event::Collapse);
            }
        }
        for (i, corner) in alive() {
            let [left, right] = corner.sides.map(|s| self.side(s).along);
            if left.perp_dot(right) > -1e-6 {
                continue;
            }
            for (j, start) in alive() {
                let end = &self.corners[start.after];
                let side = self.side(start.sides[1]);
                if i == j || start.after == i || corner.sides.contains(&start.sides[1]) {
                    continue;
                }
                let inward = side.inward();
                let ahead = (corner.at - side.from).dot(inward) - side.offset(self.time);
                let closing = side.speed(self.time) - corner.velocity.dot(inward);
                if closing < 1e-9 || ahead < -SAME_M {
                    continue;
                }
                let step = (ahead / closing).max(0.0);
                let hit = corner.at + corner.velocity * step;
                let (a, b) = (start.at + start.velocity * step, end.at + end.velocity * step);
                let s = (hit - a).dot(side.along);
                if s >= -SAME_M && s <= (b - a).dot(side.along) + SAME_M {
                    offer(self.time + step, Event::Split(i, j));
                }
            }
        }
        best
    }

    /// A corner meets the side behind another: the outline falls apart there, or grows together with another.
    fn split(&mut self, corner: usize, start: usize) {
        let (hit, from) = (self.corners[corner], self.corners[start]);
        let (side, end) = (from.sides[1], from.after);
        let node = self.node(hit.at);
        self.end(corner, node);
        self.corner(hit.at, node, [hit.sides[0], side], hit.before, end);
        self.corner(hit.at, node, [side, hit.sides[1]], start, hit.after);
    }

    /// Borders put together to faces.
    fn finish(mut self, outline_m2: f64) -> Option<Skeleton> {
        for (i, borders) in std::mem::take(&mut self.borders).into_iter().enumerate() {
            let mut left: Vec<[usize; 2]> = Vec::new();
            for [a, b] in borders {
                match left.iter().position(|&[c, d]| (c, d) == (b, a)) {
                    Some(k) => drop(left.swap_remove(k)),
                    None => left.push([a, b]),
                }
            }
            let mut face = Vec::new();
            if !left.is_empty() {
                let first = left.iter().position(|&[a, _]| a == i)?;
                let [start, mut at] = left.swap_remove(first);
                face.push(start);
                while at != start {
                    face.push(at);
                    let k = left.iter().position(|&[a, _]| a == at)?;
                    at = left.swap_remove(k)[1];
                }
                if !left.is_empty() {
                    return None;
                }
            }
            self.skeleton.faces.push(face);
        }
        self.skeleton.is_sound(outline_m2).then_some(self.skeleton)
    }
}

impl Skeleton {
    /// A node in a side's own plane: along it, and in time.
    pub(super) fn in_face(&self, side: usize, node: usize) -> DVec2 {
        let (side, node) = (&self.sides[side], &self.nodes[node]);
        DVec2::new((node.position - side.from).dot(side.along), node.time)
    }

    /// The time at which the last of the outline is gone.
    pub(super) fn last_s(&self) -> f64 {
        self.nodes.iter().map(|n| n.time).fold(0.0, f64::max)
    }

    /// Whether the faces fill the outline, and every face lies in its side's plane.
    fn is_sound(&self, outline_m2: f64) -> bool {
        let area = |face: &[usize], at: &dyn Fn(usize) -> DVec2| {
            signed_area_m2(&face.iter().map(|&n| at(n)).collect::<Vec<_>>())
        };
        let covered: f64 = self.faces.iter().map(|f| area(f, &|n| self.nodes[n].position)).sum();
        // Each face must run round once the right way, and where its side moves lie as far in as time has passed.
        let sound = |(i, face): (usize, &Vec<usize>)| {
            let side = &self.sides[i];
            let in_plane = |&n: &usize| {
                let node = &self.nodes[n];
                ((node.position - side.from).dot(side.inward()) - side.offset(node.time)).abs() < 0.02
            };
            face.is_empty() || (area(face, &|n| self.in_face(i, n)) > -1e-6 && face.iter().all(in_plane))
        };
        (covered - outline_m2).abs() < 0.005 * outline_m2 && self.faces.iter().enumerate().all(sound)
    }
}

/// Area of a ring, positive where it runs counter-clockwise.
fn signed_area_m2(ring: &[DVec2]) -> f64 {
    let Some(&o) = ring.first() else { return 0.0 };
    (0..ring.len()).map(|i| (ring[i] - o).perp_dot(ring[(i + 1) % ring.len()] - o)).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&(x, y)| DVec2::from_angle(0.3).rotate(DVec2::new(x, y))).collect()
    }

    fn found(rings: &[Vec<DVec2>], starts: &[f64]) -> Skeleton {
        skeleton(rings, starts).unwrap()
    }

    const L: [(f64, f64); 6] = [(0., 0.), (20., 0.), (20., 8.), (8., 8.), (8., 22.), (0., 22.)];
    const U: [(f64, f64); 8] = [(0., 0.), (24., 0.), (24., 18.), (16., 18.), (16., 7.), (7., 7.), (7., 20.), (0., 20.)];
    const CROSS: [(f64, f64); 12] = [
        (4., 0.),
        (8., 0.),
        (8., 4.),
        (12., 4.),
        (12., 8.),
        (8., 8.),
        (8., 12.),
        (4., 12.),
        (4., 8.),
        (0., 8.),
        (0., 4.),
        (4., 4.),
    ];

    #[test]
    fn a_rectangle_has_two_hips_and_a_ridge() {
        let found = found(&[ring(&[(0., 0.), (20., 0.), (20., 8.), (0., 8.)])], &[0.0; 4]);
        assert_eq!(found.faces.iter().map(Vec::len).collect::<Vec<_>>(), [4, 3, 4, 3]);
        assert!((found.last_s() - 4.0).abs() < 1e-6);
    }

    #[test]
    fn sides_that_never_start_carry_gables() {
        let gabled = [0.0, f64::INFINITY, 0.0, f64::INFINITY];
        let found = found(&[ring(&[(0., 0.), (20., 0.), (20., 8.), (0., 8.)])], &gabled);
        assert_eq!(found.nodes.len(), 6);
        assert_eq!(found.faces.iter().map(Vec::len).collect::<Vec<_>>(), [4, 3, 4, 3]);
    }

    #[test]
    fn wings_courts_and_crosses_are_covered() {
        for shape in [&L[..], &U[..], &CROSS[..]] {
            found(&[ring(shape)], &vec![0.0; shape.len()]);
        }
        let mut court = ring(&[(6., 6.), (14., 6.), (14., 13.), (6., 13.)]);
        court.reverse();
        found(&[ring(&[(0., 0.), (20., 0.), (20., 20.), (0., 20.)]), court], &[0.0; 8]);
    }

    #[test]
    fn gables_and_half_hips_stand_at_the_ends_of_wings() {
        for start in [f64::INFINITY, 2.0] {
            let mut starts = [0.0; 6];
            (starts[1], starts[4]) = (start, start);
            found(&[ring(&L)], &starts);
            let mut starts = [0.0; 8];
            (starts[2], starts[6]) = (start, start);
            found(&[ring(&U)], &starts);
            let mut starts = [0.0; 12];
            for i in [0, 3, 6, 9] {
                starts[i] = start;
            }
            found(&[ring(&CROSS)], &starts);
        }
    }

    #[test]
    fn round_and_irregular_outlines_are_covered() {
        let round: Vec<DVec2> = (0..24).map(|i| DVec2::from_angle(f64::from(i) * 0.2618) * 9.0).collect();
        found(&[round], &[0.0; 24]);
        let mut failed = 0;
        for seed in 0..400u64 {
            let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) + 1;
            let mut unit = || {
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                (state >> 11) as f64 / (1u64 << 53) as f64
            };
            let n = 5 + (seed % 14) as usize;
            let star: Vec<DVec2> = (0..n)
                .map(|i| DVec2::from_angle(std::f64::consts::TAU * i as f64 / n as f64) * (4.0 + 12.0 * unit()))
                .collect();
            failed += u32::from(skeleton(&[star], &vec![0.0; n]).is_none());
        }
        assert!(failed <= 8, "{failed} of 400");
    }
}

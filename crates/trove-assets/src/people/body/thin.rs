//! Fewer triangles on the same vertices, after Garland and Heckbert 1997: edges collapse onto one of their ends, so that
//! what is left keeps its shape targets and skinning weights.

use std::collections::{BTreeSet, BinaryHeap};

use glam::{DVec3, Vec3};

/// What a squared metre of edge costs on its own, which keeps triangles of like size.
const EVENNESS: f64 = 0.003;
/// The same for an edge between vertices that move with different joints, so that knees keep their rings.
const BENDING: f64 = 0.05;

/// A sum of squared distances to planes, upper triangle of a symmetric 4×4 matrix.
#[derive(Clone, Copy, Default)]
struct Quadric([f64; 10]);

impl Quadric {
    fn plane(n: DVec3, through: DVec3, weight: f64) -> Self {
        let (a, b, c, d) = (n.x, n.y, n.z, -n.dot(through));
        Self([a * a, a * b, a * c, a * d, b * b, b * c, b * d, c * c, c * d, d * d].map(|x| x * weight))
    }

    fn add(&mut self, other: &Self) {
        self.0.iter_mut().zip(other.0).for_each(|(x, y)| *x += y);
    }

    fn at(&self, p: DVec3) -> f64 {
        let q = &self.0;
        let squares = q[0] * p.x * p.x + q[4] * p.y * p.y + q[7] * p.z * p.z + q[9];
        squares + 2.0 * (q[1] * p.x * p.y + q[2] * p.x * p.z + q[3] * p.x + q[5] * p.y * p.z + q[6] * p.y + q[8] * p.z)
    }
}

/// A collapse of `from` onto `to`, cheapest first.
#[derive(PartialEq)]
struct Collapse {
    cost: f64,
    from: u32,
    to: u32,
    stamp: u32,
}

impl Eq for Collapse {}
impl PartialOrd for Collapse {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Collapse {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        other.cost.total_cmp(&self.cost).then_with(|| (other.from, other.to).cmp(&(self.from, self.to)))
    }
}

struct Thinning<'a> {
    positions: &'a [Vec3],
    importance: &'a dyn Fn(u32) -> f32,
    /// How differently two vertices move, 0 to 2.
    difference: &'a dyn Fn(u32, u32) -> f32,
    triangles: Vec<Option<[u32; 3]>>,
    of_vertex: Vec<Vec<u32>>,
    quadrics: Vec<Quadric>,
    stamps: Vec<u32>,
}

/// About `keep` of the triangles. Open edges stay where they are. What removing a vertex costs is multiplied by its
/// `importance`; `difference` says from 0 to 2 how differently two vertices move.
pub(super) fn thinned(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    keep: usize,
    importance: &dyn Fn(u32) -> f32,
    difference: &dyn Fn(u32, u32) -> f32,
) -> Vec<[u32; 3]> {
    let n = positions.len();
    let mut thinning = Thinning {
        positions,
        importance,
        difference,
        triangles: triangles.iter().copied().map(Some).collect(),
        of_vertex: vec![Vec::new(); n],
        quadrics: vec![Quadric::default(); n],
        stamps: vec![0; n],
    };
    for (i, t) in triangles.iter().enumerate() {
        t.iter().for_each(|&v| thinning.of_vertex[v as usize].push(i as u32));
    }
    thinning.start(triangles);
    let mut left = triangles.len();
    let mut heap = BinaryHeap::new();
    for v in 0..n as u32 {
        thinning.offer(v, &mut heap);
    }
    while left > keep {
        let Some(Collapse { from, to, stamp, .. }) = heap.pop() else { break };
        if stamp == thinning.stamps[from as usize] && thinning.may(from, to) {
            left -= thinning.collapse(from, to);
            for v in thinning.neighbours(to).into_iter().chain([to]) {
                thinning.stamps[v as usize] += 1;
                thinning.offer(v, &mut heap);
            }
        }
    }
    thinning.triangles.into_iter().flatten().collect()
}

impl Thinning<'_> {
    fn at(&self, v: u32) -> DVec3 {
        self.positions[v as usize].as_dvec3()
    }

    /// Planes of the faces, and upright ones through open edges.
    fn start(&mut self, triangles: &[[u32; 3]]) {
        for t in triangles {
            let [a, b, c] = t.map(|v| self.at(v));
            let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
            let face = Quadric::plane(normal, a, 1.0);
            for k in 0..3 {
                let (v, w) = (t[k], t[(k + 1) % 3]);
                self.quadrics[v as usize].add(&face);
                if self.shared(v, w) == 1 {
                    let along = self.at(w) - self.at(v);
                    if let Some(across) = along.cross(normal).try_normalize() {
                        let wall = Quadric::plane(across, self.at(v), 20.0);
                        self.quadrics[v as usize].add(&wall);
                        self.quadrics[w as usize].add(&wall);
                    }
                }
            }
        }
    }

    fn faces(&self, v: u32) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.of_vertex[v as usize].iter().filter_map(|&t| self.triangles[t as usize]).filter(move |t| t.contains(&v))
    }

    fn neighbours(&self, v: u32) -> BTreeSet<u32> {
        self.faces(v).flatten().filter(|&w| w != v).collect()
    }

    /// Number of faces at an edge.
    fn shared(&self, v: u32, w: u32) -> usize {
        self.faces(v).filter(|t| t.contains(&w)).count()
    }

    fn offer(&self, from: u32, heap: &mut BinaryHeap<Collapse>) {
        let importance = f64::from((self.importance)(from));
        for to in self.neighbours(from) {
            let length = self.at(from).distance_squared(self.at(to));
            let bending = BENDING * f64::from((self.difference)(from, to));
            let error = self.quadrics[from as usize].at(self.at(to)).max(0.0);
            let cost = importance * (error + length * (EVENNESS + bending));
            heap.push(Collapse { cost, from, to, stamp: self.stamps[from as usize] });
        }
    }

    /// Whether the surface stays one and no face turns over.
    fn may(&self, from: u32, to: u32) -> bool {
        let shared = self.shared(from, to);
        let is_open = |v: u32| self.neighbours(v).into_iter().any(|w| self.shared(v, w) == 1);
        let meeting = self.neighbours(from).intersection(&self.neighbours(to)).count();
        if shared == 0 || shared > 2 || meeting != shared || (is_open(from) && shared == 2) {
            return false;
        }
        self.faces(from).filter(|t| !t.contains(&to)).all(|t| {
            let normal = |t: [u32; 3]| {
                let [a, b, c] = t.map(|v| self.at(v));
                (b - a).cross(c - a).normalize_or_zero()
            };
            normal(t).dot(normal(t.map(|v| if v == from { to } else { v }))) > 0.3
        })
    }

    /// Returns how many triangles went.
    fn collapse(&mut self, from: u32, to: u32) -> usize {
        let mut gone = 0;
        for t in std::mem::take(&mut self.of_vertex[from as usize]) {
            let Some(corners) = self.triangles[t as usize] else { continue };
            if corners.contains(&to) {
                self.triangles[t as usize] = None;
                gone += 1;
            } else {
                self.triangles[t as usize] = Some(corners.map(|v| if v == from { to } else { v }));
                self.of_vertex[to as usize].push(t);
            }
        }
        let quadric = self.quadrics[from as usize];
        self.quadrics[to as usize].add(&quadric);
        gone
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Shape;
    use glam::vec3;

    #[test]
    fn a_thinned_ball_stays_closed_and_round() {
        let n = 24u32;
        let mut positions = vec![vec3(0.0, 0.0, -1.0), vec3(0.0, 0.0, 1.0)];
        for i in 1..n / 2 {
            let a = std::f32::consts::TAU * i as f32 / n as f32;
            let ring = (0..n).map(|k| std::f32::consts::TAU * k as f32 / n as f32);
            positions.extend(ring.map(|b| vec3(a.sin() * b.cos(), a.sin() * b.sin(), -a.cos())));
        }
        let at = |i: u32, k: u32| match i {
            0 => 0,
            i if i == n / 2 => 1,
            i => 2 + (i - 1) * n + k % n,
        };
        let quads = (0..n / 2).flat_map(|i| (0..n).map(move |k| (i, k)));
        let triangles: Vec<[u32; 3]> = quads
            .flat_map(|(i, k)| [[at(i, k), at(i, k + 1), at(i + 1, k + 1)], [at(i, k), at(i + 1, k + 1), at(i + 1, k)]])
            .filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
            .collect();
        let kept = thinned(&positions, &triangles, 160, &|_| 1.0, &|_, _| 0.0);
        assert!(kept.len() <= 160 && kept.len() > 150, "{}", kept.len());
        let edges: BTreeSet<[u32; 2]> = kept.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]).collect();
        assert!(edges.iter().all(|&[a, b]| edges.contains(&[b, a])), "a hole");
        let ball = Shape { positions, triangles: kept, ..Shape::default() };
        assert!((3.7..4.19).contains(&ball.volume_m3()), "{}", ball.volume_m3());
    }
}

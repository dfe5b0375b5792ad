//! Pieces of the body's mesh, cut once for everyone: their vertices are mixtures of the body's.

use std::collections::HashMap;

use glam::Vec3;
use trove_model::HumanBody;

/// A vertex between vertices of the body: their indices and shares.
pub(super) type Spot = Vec<(u32, f32)>;
/// Joints that move a vertex, and their shares.
pub(super) type Weights = [(u16, f32); 4];

/// Triangles between spots.
#[derive(Clone, Debug, Default)]
pub(super) struct Pattern {
    pub(super) spots: Vec<Spot>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// The value of a spot in a shape.
pub(super) fn at(spot: &Spot, positions: &[Vec3]) -> Vec3 {
    spot.iter().map(|&(v, share)| positions[v as usize] * share).sum()
}

/// What moves a spot.
pub(super) fn weights_at(spot: &Spot, body: &HumanBody) -> Weights {
    let mut sums: Vec<(u16, f32)> = Vec::with_capacity(8);
    for &(v, share) in spot {
        for &(joint, weight) in &body.weights[v as usize] {
            match sums.iter_mut().find(|s| s.0 == joint) {
                Some(sum) => sum.1 += weight * share,
                None => sums.push((joint, weight * share)),
            }
        }
    }
    sums.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    sums.truncate(4);
    let whole: f32 = sums.iter().map(|s| s.1).sum();
    std::array::from_fn(|i| sums.get(i).map_or((0, 0.0), |s| (s.0, s.1 / whole)))
}

impl Pattern {
    /// Triangles on the body's own vertices.
    pub(super) fn new(triangles: &[[u32; 3]]) -> Self {
        let mut pattern = Self::default();
        let mut place = HashMap::new();
        for t in triangles {
            let t = t.map(|v| {
                *place.entry(v).or_insert_with(|| {
                    pattern.spots.push(vec![(v, 1.0)]);
                    pattern.spots.len() as u32 - 1
                })
            });
            pattern.triangles.push(t);
        }
        pattern
    }

    /// What lies where `inside` of a point of the body's own shape is positive, cut along its zero.
    pub(super) fn cut(&self, body: &HumanBody, inside: impl Fn(Vec3) -> f32) -> Self {
        self.divided(body, inside, false)
    }

    /// The whole, its triangles divided along the zero of `inside`.
    pub(super) fn scored(&self, body: &HumanBody, inside: impl Fn(Vec3) -> f32) -> Self {
        self.divided(body, inside, true)
    }

    fn divided(&self, body: &HumanBody, inside: impl Fn(Vec3) -> f32, keeps_both: bool) -> Self {
        let mut values: Vec<f32> = self.spots.iter().map(|s| inside(at(s, &body.positions))).collect();
        // A cut that passes near a vertex passes through it, lest slivers come about.
        for t in &self.triangles {
            for k in 0..3 {
                let (i, j) = (t[k] as usize, t[(k + 1) % 3] as usize);
                let (a, b) = (values[i], values[j]);
                if a * b < 0.0 {
                    if a.abs() < 0.06 * b.abs() {
                        values[i] = 0.0;
                    } else if b.abs() < 0.06 * a.abs() {
                        values[j] = 0.0;
                    }
                }
            }
        }
        let mut kept = Self::default();
        let mut place: HashMap<[u32; 2], u32> = HashMap::new();
        for t in &self.triangles {
            for sign in if keeps_both { &[1.0, -1.0][..] } else { &[1.0] } {
                let value = |i: u32| values[i as usize] * sign;
                let mut corners = Vec::with_capacity(4);
                for k in 0..3 {
                    let (i, j) = (t[k], t[(k + 1) % 3]);
                    if value(i) >= 0.0 {
                        corners.push([i, i]);
                    }
                    if value(i) * value(j) < 0.0 {
                        corners.push([i.min(j), i.max(j)]);
                    }
                }
                // What lies in the cut as a whole belongs to its inside.
                let is_here = t.iter().any(|&i| value(i) > 0.0) || (*sign > 0.0 && keeps_both && corners.len() == 3);
                if corners.len() < 3 || !is_here {
                    continue;
                }
                let corners: Vec<u32> = corners
                    .into_iter()
                    .map(|edge| {
                        *place.entry(edge).or_insert_with(|| {
                            let [i, j] = edge.map(|v| v as usize);
                            kept.spots.push(if i == j {
                                self.spots[i].clone()
                            } else {
                                mixed(&self.spots[i], &self.spots[j], values[i] / (values[i] - values[j]))
                            });
                            kept.spots.len() as u32 - 1
                        })
                    })
                    .collect();
                for k in 2..corners.len() {
                    kept.triangles.push([corners[0], corners[k - 1], corners[k]]);
                }
            }
        }
        kept
    }

    /// Directed edges that only one triangle has.
    pub(super) fn open_edges(&self) -> Vec<[u32; 2]> {
        let edges = || self.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
        let all: std::collections::HashSet<[u32; 2]> = edges().collect();
        edges().filter(|&[a, b]| !all.contains(&[b, a])).collect()
    }
}

fn mixed(a: &Spot, b: &Spot, t: f32) -> Spot {
    let mut spot: Spot = a.iter().map(|&(v, share)| (v, share * (1.0 - t))).collect();
    for &(v, share) in b {
        match spot.iter_mut().find(|s| s.0 == v) {
            Some(s) => s.1 += share * t,
            None => spot.push((v, share * t)),
        }
    }
    spot
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    #[test]
    fn a_cut_keeps_one_side_and_divides_what_it_crosses() {
        let positions = vec![vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0)];
        let weights = vec![[(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)]; 3];
        let body = HumanBody { positions, weights, ..HumanBody::default() };
        let lower = Pattern::new(&[[0, 1, 2]]).cut(&body, |p| 0.5 - p.z);
        assert_eq!((lower.triangles.len(), lower.spots.len(), lower.open_edges().len()), (2, 4, 4));
        assert!(lower.spots.iter().all(|s| at(s, &body.positions).z <= 0.5));
        assert_eq!(Pattern::new(&[[0, 1, 2]]).cut(&body, |p| p.z - 2.0).triangles.len(), 0);
        let scored = Pattern::new(&[[0, 1, 2]]).scored(&body, |p| 0.5 - p.z);
        assert_eq!((scored.triangles.len(), scored.spots.len(), scored.open_edges().len()), (3, 5, 5));
    }
}

//! Branches that grow towards light: space colonisation (Runions, Lane, Prusinkiewicz 2007).

use glam::{Vec2, Vec3, vec2};
use trove_model::Random;

use crate::shape::Shape;

/// A joint of the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) at: Vec3,
    /// Index of the joint below; the root's is its own.
    pub(super) parent: usize,
    pub(super) radius_m: f32,
    /// How it grew.
    pub(super) along: Vec3,
    /// Nothing grew from it.
    pub(super) tip: bool,
}

/// How a tree grows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Growth {
    pub(super) step_m: f32,
    /// Points nearer than this to a joint are reached.
    pub(super) kill_m: f32,
    /// Pull upwards (or downwards) in every step.
    pub(super) lift: f32,
    pub(super) trunk_radius_m: f32,
}

/// da Vinci's rule with the exponent that trees are measured to have.
pub(super) const PIPE_EXPONENT: f32 = 2.3;

impl Growth {
    /// Grows a trunk, given by its joints, towards points until all are reached.
    pub(super) fn grow(&self, trunk: &[Vec3], mut points: Vec<Vec3>, random: &mut Random) -> Vec<Node> {
        let mut nodes: Vec<Node> = Vec::new();
        for (i, &at) in trunk.iter().enumerate() {
            nodes.push(Node { at, parent: i.saturating_sub(1), radius_m: 0.0, along: Vec3::Z, tip: false });
        }
        let mut nearest: Vec<(usize, f32)> = vec![(0, f32::INFINITY); points.len()];
        let mut seen = 0;
        for _ in 0..160 {
            // Every point learns of the joints that are new.
            for (point, near) in points.iter().zip(&mut nearest) {
                for (i, node) in nodes.iter().enumerate().skip(seen) {
                    let d = point.distance_squared(node.at);
                    if d < near.1 {
                        *near = (i, d);
                    }
                }
            }
            seen = nodes.len();
            let reached: Vec<bool> = nearest.iter().map(|n| n.1 < self.kill_m * self.kill_m).collect();
            let mut keep = reached.iter().map(|r| !r);
            points.retain(|_| keep.next().unwrap_or(false));
            let mut keep = reached.iter().map(|r| !r);
            nearest.retain(|_| keep.next().unwrap_or(false));

            let mut pull = vec![Vec3::ZERO; nodes.len()];
            for (point, near) in points.iter().zip(&nearest) {
                pull[near.0] += (*point - nodes[near.0].at).normalize_or_zero();
            }
            for (i, pull) in pull.into_iter().enumerate() {
                let Some(pull) = pull.try_normalize() else { continue };
                let jitter = Vec3::from_array(std::array::from_fn(|_| random.range(-0.22, 0.22) as f32));
                let along = (pull + Vec3::Z * self.lift + nodes[i].along * 0.35 + jitter).normalize_or(pull);
                let at = nodes[i].at + along * self.step_m;
                nodes.push(Node { at, parent: i, radius_m: 0.0, along, tip: false });
            }
            if nodes.len() == seen || nodes.len() > 6000 {
                break;
            }
        }
        self.thicken(&mut nodes);
        nodes
    }

    /// Radii from the tips down; a parent always stands before its children.
    fn thicken(&self, nodes: &mut [Node]) {
        let mut area = vec![0.0f32; nodes.len()];
        for i in (1..nodes.len()).rev() {
            nodes[i].tip = area[i] == 0.0;
            area[i] = area[i].max(1.0);
            area[nodes[i].parent] += area[i];
        }
        let whole = area[0].max(1.0);
        for (node, area) in nodes.iter_mut().zip(area) {
            node.radius_m = self.trunk_radius_m * (area / whole).powf(1.0 / PIPE_EXPONENT);
        }
    }
}

/// The branches as tubes thicker than `least_m`, uvs in metres.
pub(super) fn branches(nodes: &[Node], least_m: f32) -> Shape {
    // Every joint goes on in its thickest child; the others begin branches of their own.
    let mut main: Vec<Option<usize>> = vec![None; nodes.len()];
    for (i, node) in nodes.iter().enumerate().skip(1) {
        let best = &mut main[node.parent];
        if best.is_none_or(|b| nodes[b].radius_m < node.radius_m) {
            *best = Some(i);
        }
    }
    let mut shapes = Vec::new();
    for (i, node) in nodes.iter().enumerate() {
        let starts = i == 0 || main[node.parent] != Some(i);
        if !starts || node.radius_m < least_m {
            continue;
        }
        let mut path: Vec<(Vec3, f32)> = Vec::new();
        if i > 0 {
            path.push((nodes[node.parent].at, node.radius_m));
        }
        let mut next = Some(i);
        while let Some(k) = next.filter(|&k| nodes[k].radius_m >= least_m) {
            // The trunk spreads into its roots.
            let flare = 1.0 + 0.55 * (-nodes[k].at.z / (3.0 * nodes[0].radius_m)).exp();
            path.push((nodes[k].at, nodes[k].radius_m * flare));
            next = main[k];
        }
        if path.len() > 1 {
            shapes.push(limb(&path));
        }
    }
    Shape::join(shapes)
}

/// A tapered tube whose uvs are metres around and along.
pub(super) fn limb(path: &[(Vec3, f32)]) -> Shape {
    let radius = path[0].1;
    let around = if radius > 0.12 {
        12
    } else if radius > 0.04 {
        6
    } else {
        4
    };
    let length: f32 = path.windows(2).map(|w| w[0].0.distance(w[1].0)).sum();
    // Whole repeats of the half metre of bark, lest it tear where the tube closes.
    let girth = (std::f32::consts::TAU * radius / 0.5).round().max(1.0) * 0.5;
    let mut shape = Shape::tapered_tube(path, around);
    shape.uvs.iter_mut().for_each(|uv| *uv = Vec2::new(uv.x * girth, uv.y * length));
    shape
}

/// Cards that leaves are painted on.
#[derive(Clone, Debug, Default)]
pub(super) struct Foliage {
    shape: Shape,
}

impl Foliage {
    /// A square card with its foot at a point, growing along a direction, its face turned towards `face`; light
    /// falls on it as on a crown whose surface there has the normal `outward`.
    pub(super) fn card(&mut self, foot: Vec3, along: Vec3, face: Vec3, size_m: f32, outward: Vec3) {
        let along = along.normalize_or(Vec3::Z);
        let across = along.cross(face).normalize_or(along.any_orthonormal_vector());
        let normal = across.cross(along);
        let shade = (outward * 0.75 + normal * 0.45).normalize_or(outward);
        let base = self.shape.positions.len() as u32;
        for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            let p = foot + across * (u - 0.5) * size_m + along * v * size_m;
            self.shape.positions.push(p);
            self.shape.normals.push((shade + across * (u - 0.5) * 0.3).normalize_or(shade));
            self.shape.uvs.push(vec2(u, v));
        }
        self.shape.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
        self.shape.slots.extend([0, 0]);
    }

    pub(super) fn into_shape(self) -> Shape {
        self.shape
    }
}

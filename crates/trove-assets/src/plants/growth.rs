//! Branches that grow towards light: space colonisation (Runions, Lane, Prusinkiewicz 2007).

use glam::{Vec2, Vec3};
use trove_model::Random;

use super::individual::Level;
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

/// How finely branches are drawn.
#[derive(Clone, Copy, Debug)]
struct Detail {
    /// Thinner ones are left out, as a share of the trunk's radius.
    least: f32,
    /// One joint of so many is kept.
    every: usize,
    /// Sides of the trunk, of branches and of twigs.
    around: [usize; 3],
}

impl Detail {
    fn of(level: Level) -> Self {
        match level {
            Level::Near => Self { least: 0.0, every: 1, around: [14, 6, 4] },
            Level::Middle => Self { least: 0.09, every: 2, around: [8, 4, 3] },
            Level::Far => Self { least: 0.25, every: 4, around: [5, 3, 3] },
        }
    }
}

/// The branches as tubes thicker than `least_m`, uvs in metres; the trunk spreads into `roots` at its foot, 0 to 1.
pub(super) fn branches(nodes: &[Node], least_m: f32, roots: f32, level: Level) -> Shape {
    let detail = Detail::of(level);
    let least_m = least_m.max(detail.least * nodes[0].radius_m);
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
            // It comes out of its parent with a collar.
            let collar = (node.radius_m * 1.35).min(nodes[node.parent].radius_m);
            path.push((nodes[node.parent].at, collar));
        }
        let mut next = Some(i);
        while let Some(k) = next.filter(|&k| nodes[k].radius_m >= least_m) {
            path.push((nodes[k].at, nodes[k].radius_m));
            next = main[k];
        }
        let last = path.len() - 1;
        let mut kept: Vec<(Vec3, f32)> =
            path.iter().enumerate().filter(|(k, _)| *k == last || k % detail.every == 0).map(|(_, p)| *p).collect();
        if let Some(tip) = kept.last_mut().filter(|_| last > 0) {
            tip.1 *= 0.6;
        }
        if kept.len() > 1 {
            shapes.push(if i == 0 { trunk(&kept, roots, detail) } else { limb(&kept, detail.around) });
        }
    }
    Shape::join(shapes)
}

/// A trunk whose foot spreads into roots.
fn trunk(path: &[(Vec3, f32)], roots: f32, detail: Detail) -> Shape {
    const ROOTS: f32 = 5.0;
    let (foot, radius) = path[0];
    let above = path[1];
    let low = (1..4).map(|i| (0.6 * radius * i as f32).min(above.0.z * 0.9)).map(|z| {
        let t = z / above.0.z.max(1e-3);
        (foot.lerp(above.0, t), radius + (above.1 - radius) * t)
    });
    let extra = if detail.every > 2 { 0 } else { 3 };
    let path: Vec<(Vec3, f32)> =
        std::iter::once(path[0]).chain(low.take(extra)).chain(path[1..].iter().copied()).collect();
    let girth = (std::f32::consts::TAU * radius / 0.5).round().max(1.0) * 0.5;
    let around = detail.around[0];
    let mut at_m = 0.0;
    let mut lengths = Vec::new();
    let rings: Vec<Vec<Vec3>> = path
        .iter()
        .enumerate()
        .map(|(i, &(centre, r))| {
            at_m += if i > 0 { centre.distance(path[i - 1].0) } else { 0.0 };
            lengths.push(at_m);
            let flare = roots * (-centre.z / (1.6 * radius)).exp();
            let ring = |k: usize| {
                let turn = std::f32::consts::TAU * k as f32 / around as f32;
                let root = 0.5 + 0.5 * (ROOTS * turn + 0.7 * (2.0 * turn).sin()).cos();
                // Trunks are not quite round.
                let round = 1.0 + 0.05 * (2.0 * turn + 1.3 * centre.z).sin() + 0.03 * (3.0 * turn - centre.z).sin();
                let out = r * round * (1.0 + flare * (0.35 + 0.9 * root));
                centre + Vec2::from_angle(turn).extend(0.0) * out
            };
            (0..around).map(ring).collect()
        })
        .collect();
    let top = *lengths.last().unwrap_or(&1.0);
    let mut shape = Shape::loft(&rings);
    shape.uvs.iter_mut().for_each(|uv| *uv = Vec2::new(uv.x * girth, uv.y * top));
    shape
}

/// A tapered tube whose uvs are metres around and along; `around` are the sides of a thick, a middling and a thin one.
pub(super) fn limb(path: &[(Vec3, f32)], around: [usize; 3]) -> Shape {
    let radius = path[0].1;
    let around = match radius {
        r if r > 0.12 => around[0],
        r if r > 0.035 => around[1],
        _ => around[2],
    };
    let length: f32 = path.windows(2).map(|w| w[0].0.distance(w[1].0)).sum();
    // Whole repeats of the half metre of bark, lest it tear where the tube closes.
    let girth = (std::f32::consts::TAU * radius / 0.5).round().max(1.0) * 0.5;
    let mut shape = Shape::tapered_tube(path, around);
    shape.uvs.iter_mut().for_each(|uv| *uv = Vec2::new(uv.x * girth, uv.y * length));
    shape
}

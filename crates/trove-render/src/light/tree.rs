//! Which of many lights shines on a place: a tree of lights (Conty Estevez and Kulla, "Importance Sampling of Many
//! Lights with Adaptive Tree Splitting", 2018).

use std::f32::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use glam::{Mat3, Vec3};
use trove_model::Beam;

/// Lights that are compared one by one.
const LEAF: usize = 8;

/// Groups that are compared one by one at most.
const CUT: usize = 96;
/// How many of its radii away a group is compared as it is: one that shines evenly, and one with a beam.
const APART: f32 = 2.0;
const APART_IN_BEAM: f32 = 12.0;
/// Beams that at best give this share of all before them are not told apart.
const FAINT: f32 = 0.02;

/// A beam that fills more than this at its brightest is broad, as street lamps' are; low beams fill some hundredths.
const BROAD_SR: f32 = 0.5;
/// What a beam is taken to give at least: another part of the lamp may shine there.
pub(super) const LEAST_SHARE: f32 = 1e-3;

/// Places at which a node may be cut, along each axis.
const BINS: usize = 12;

/// What the tree knows of a light that shines from one side of a flat piece.
#[derive(Clone, Copy)]
pub(super) struct TreeEntry {
    pub(super) low: Vec3,
    pub(super) high: Vec3,
    pub(super) centre: Vec3,
    /// Unit normal of the shining side.
    pub(super) axis: Vec3,
    /// In the brightest direction of its beam, if it has one.
    pub(super) power: f32,
    /// Index of its beam.
    pub(super) aim: Option<u32>,
}

/// A beam, turned.
pub(super) struct Aim {
    pub(super) beam: Arc<Beam>,
    mesh_from_world: Mat3,
    /// Whether its light is spread so wide that groups of it need no telling apart.
    pub(super) is_broad: bool,
}

impl Aim {
    pub(super) fn new(beam: Arc<Beam>, mesh_from_world: Mat3) -> Self {
        let is_broad = beam.flux() > BROAD_SR * beam.most();
        Self { beam, mesh_from_world, is_broad }
    }

    /// Share of the radiance that leaves into a direction, World.
    pub(super) fn share(&self, direction: Vec3) -> f32 {
        self.beam.share(self.mesh_from_world * direction)
    }

    /// What it leaves of the flux of a matt surface with a normal, World, of any length but 0.
    pub(super) fn flux_share(&self, normal: Vec3) -> f32 {
        self.beam.flux_share((self.mesh_from_world * normal).normalize_or_zero())
    }
}

/// Lights sorted into nested groups, each with its power, its place and the directions into which it shines.
pub(super) struct Tree {
    nodes: Vec<Node>,
    aims: Vec<Aim>,
    /// Lights in the order of the leaves.
    order: Vec<u32>,
    /// The leaf of each light.
    leaf_of: Vec<u32>,
}

struct Node {
    centre: Vec3,
    radius: f32,
    axis: Vec3,
    cos_cone: f32,
    power: f32,
    aim: Shared,
    parent: u32,
    /// The first node behind it and all below it.
    end: u32,
    kind: NodeKind,
}

/// The beam of a group's lights.
#[derive(Clone, Copy, PartialEq)]
enum Shared {
    /// They have none.
    None,
    /// All have this one.
    One(u32),
    Several,
}

#[derive(Clone, Copy)]
enum NodeKind {
    /// The first child follows its parent; this is the second.
    Inner(u32),
    /// Start and end in the order.
    Leaf(u32, u32),
}

impl Tree {
    /// From at least one light, and the beams that they have.
    pub(super) fn new(entries: &[TreeEntry], aims: Vec<Aim>) -> Self {
        let order = (0..entries.len() as u32).collect();
        let mut tree = Self { nodes: Vec::new(), aims, order, leaf_of: vec![0; entries.len()] };
        tree.grow(entries, 0, entries.len(), 0);
        tree
    }

    fn grow(&mut self, entries: &[TreeEntry], start: usize, end: usize, parent: u32) {
        let here = self.nodes.len() as u32;
        let lights = &mut self.order[start..end];
        let group = lights.iter().map(|&i| Group::of(&entries[i as usize])).reduce(Group::with).expect("not empty");
        let is_leaf = lights.len() <= LEAF && group.aim != Shared::Several;
        let middle = start + if is_leaf { 0 } else { split(entries, lights) };
        self.nodes.push(group.node(parent, NodeKind::Leaf(start as u32, end as u32)));
        if middle == start {
            for &light in &self.order[start..end] {
                self.leaf_of[light as usize] = here;
            }
            self.nodes[here as usize].end = here + 1;
            return;
        }
        self.grow(entries, start, middle, here);
        self.nodes[here as usize].kind = NodeKind::Inner(self.nodes.len() as u32);
        self.grow(entries, middle, end, here);
        self.nodes[here as usize].end = self.nodes.len() as u32;
    }

    /// A light and the probability with which it is drawn for a surface at `from` that is lit from the side of `normal`
    /// (both if it is 0), given its cut; `weight` says what single lights give there. `None` where none gives anything.
    pub(super) fn draw(
        &self,
        cut: &Cut,
        from: Vec3,
        normal: Vec3,
        u: f32,
        weight: impl Fn(u32) -> f32,
    ) -> Option<(u32, f32)> {
        let (here, share, mut u) = pick(cut.groups().map(|&(node, importance)| (node, importance)), cut.total, u)?;
        let (mut here, mut probability) = (here as usize, share);
        loop {
            match self.nodes[here].kind {
                NodeKind::Inner(second) => {
                    let first = self.first_share(here, second, from, normal)?;
                    if u < first {
                        (u, probability, here) = (u / first, probability * first, here + 1);
                    } else {
                        (u, probability) = ((u - first) / (1.0 - first), probability * (1.0 - first));
                        here = second as usize;
                    }
                }
                NodeKind::Leaf(start, end) => {
                    let lights = &self.order[start as usize..end as usize];
                    let mut weights = [0.0; LEAF];
                    weights.iter_mut().zip(lights).for_each(|(w, &light)| *w = weight(light));
                    let total = weights.iter().sum();
                    let (light, share, _) = pick(lights.iter().copied().zip(weights), total, u)?;
                    return Some((light, probability * share));
                }
            }
        }
    }

    /// The probability with which a light is drawn.
    pub(super) fn probability(&self, light: u32, from: Vec3, normal: Vec3, weight: impl Fn(u32) -> f32) -> f32 {
        let own = weight(light);
        if own <= 0.0 {
            return 0.0;
        }
        let leaf = self.leaf_of[light as usize];
        let NodeKind::Leaf(start, end) = self.nodes[leaf as usize].kind else { return 0.0 };
        let total: f32 = self.order[start as usize..end as usize].iter().map(|&light| weight(light)).sum();
        let cut = self.cut(from, normal);
        let holds = |&&(node, _): &&(u32, f32)| node <= leaf && leaf < self.nodes[node as usize].end;
        let Some(&(top, importance)) = cut.groups().find(holds) else { return 0.0 };
        let mut probability = own / total * (importance / cut.total);
        let mut here = leaf as usize;
        while here != top as usize {
            let parent = self.nodes[here].parent as usize;
            let NodeKind::Inner(second) = self.nodes[parent].kind else { return 0.0 };
            let Some(first) = self.first_share(parent, second, from, normal) else { return 0.0 };
            probability *= if here == second as usize { 1.0 - first } else { first };
            here = parent;
        }
        probability
    }

    /// The beam of this index.
    pub(super) fn aim(&self, index: u32) -> &Aim {
        &self.aims[index as usize]
    }

    /// Groups that together hold all lights that give something to a surface, each so small for its distance that its
    /// bound tells what it gives.
    pub(super) fn cut(&self, from: Vec3, normal: Vec3) -> Cut {
        let mut cut = Cut { groups: [(0, 0.0); CUT], count: 0, total: 0.0 };
        let mut waiting = [0u32; CUT];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let here = waiting[count];
            let node = &self.nodes[here as usize];
            let has_room = cut.count + count + 2 <= CUT;
            if let NodeKind::Inner(second) = node.kind
                && has_room
                && !node.is_apart(from)
                && (node.aim != Shared::Several || node.bound(from, normal) > FAINT * cut.total)
            {
                (waiting[count], waiting[count + 1]) = (second, here + 1);
                count += 2;
                continue;
            }
            let importance = self.importance(here, from, normal);
            if importance > 0.0 {
                cut.groups[cut.count] = (here, importance);
                cut.count += 1;
                cut.total += importance;
            }
        }
        cut
    }

    /// What a node's lights give to a surface, roughly and but for occlusion; 0 only where they give nothing.
    fn importance(&self, node: u32, from: Vec3, normal: Vec3) -> f32 {
        let node = &self.nodes[node as usize];
        let bound = node.bound(from, normal);
        match node.aim {
            Shared::One(aim) if bound > 0.0 => bound * self.aim(aim).share(from - node.centre).max(LEAST_SHARE),
            _ => bound,
        }
    }

    /// Probability of a node's first child; `None` where neither gives anything.
    fn first_share(&self, here: usize, second: u32, from: Vec3, normal: Vec3) -> Option<f32> {
        let a = self.importance(here as u32 + 1, from, normal);
        let b = self.importance(second, from, normal);
        (a + b > 0.0).then(|| a / (a + b))
    }
}

/// Groups that are compared one by one.
pub(super) struct Cut {
    /// Indices of nodes, and bounds on what they give.
    groups: [(u32, f32); CUT],
    count: usize,
    total: f32,
}

impl Cut {
    fn groups(&self) -> std::slice::Iter<'_, (u32, f32)> {
        self.groups[..self.count].iter()
    }
}

/// What a number in [0, 1) falls on among weights with this sum, its share of them, and where in it the number lies, again
/// in [0, 1); `None` where none weighs anything.
fn pick(weights: impl Iterator<Item = (u32, f32)>, total: f32, u: f32) -> Option<(u32, f32, f32)> {
    let mut left = u * total;
    let mut found = None;
    for (i, weight) in weights.filter(|(_, weight)| *weight > 0.0) {
        found = Some((i, weight / total, (left / weight).clamp(0.0, 1.0 - f32::EPSILON)));
        if left < weight {
            break;
        }
        left -= weight;
    }
    found
}

impl Node {
    /// Whether its bound is near what it gives, seen from there.
    fn is_apart(&self, from: Vec3) -> bool {
        let apart = match self.aim {
            Shared::None => APART,
            Shared::One(_) => APART_IN_BEAM,
            Shared::Several => return false,
        };
        (self.centre - from).length_squared() > (apart * self.radius).powi(2)
    }

    /// Bound on what the group gives to a surface, but for occlusion; 0 only where it gives nothing.
    fn bound(&self, from: Vec3, normal: Vec3) -> f32 {
        let to_group = self.centre - from;
        let distance_squared = to_group.length_squared();
        let radius_squared = self.radius * self.radius;
        // Inside the group's sphere it may be in any direction.
        if distance_squared <= radius_squared {
            return self.power / radius_squared.max(f32::MIN_POSITIVE);
        }
        let to_group = to_group / distance_squared.sqrt();
        let sin_spread = (radius_squared / distance_squared).sqrt();
        let cos_spread = (1.0 - sin_spread * sin_spread).sqrt();
        // The smallest angles that any light of the group may make with its normal and with the surface's.
        let angle = nearer(-self.axis.dot(to_group), self.cos_cone);
        let cos_light = nearer(angle, cos_spread);
        let cos_surface = if normal == Vec3::ZERO { 1.0 } else { nearer(normal.dot(to_group), cos_spread) };
        if cos_light <= 0.0 || cos_surface <= 0.0 {
            return 0.0;
        }
        // Lights that face apart never all face a place: half of a hemisphere's shine there, a quarter of a sphere's.
        let mean = 0.5 + self.cos_cone * (0.375 + 0.125 * self.cos_cone);
        self.power * mean * cos_light * cos_surface / distance_squared
    }
}

/// The cosine of max(a − b, 0) for angles a, b with these cosines.
fn nearer(cos_a: f32, cos_b: f32) -> f32 {
    if cos_a >= cos_b {
        return 1.0;
    }
    let sines = ((1.0 - cos_a * cos_a).max(0.0) * (1.0 - cos_b * cos_b).max(0.0)).sqrt();
    cos_a * cos_b + sines
}

/// A set of lights.
#[derive(Clone, Copy)]
struct Group {
    low: Vec3,
    high: Vec3,
    axis: Vec3,
    /// Half the opening of the cone of all normals.
    cone_rad: f32,
    power: f32,
    aim: Shared,
}

impl Group {
    fn of(entry: &TreeEntry) -> Self {
        let TreeEntry { low, high, axis, power, aim, .. } = *entry;
        Self { low, high, axis, cone_rad: 0.0, power, aim: aim.map_or(Shared::None, Shared::One) }
    }

    fn with(self, other: Self) -> Self {
        let (axis, cone_rad) = cone_around(&self, &other);
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            axis,
            cone_rad,
            power: self.power + other.power,
            aim: if self.aim == other.aim { self.aim } else { Shared::Several },
        }
    }

    /// How costly it is to have these lights in one node: power times the sizes of box and cone (equation 2 there).
    fn cost(&self) -> f32 {
        let size = self.high - self.low;
        let area = size.x * size.y + size.y * size.z + size.z * size.x;
        let (sin, cos) = self.cone_rad.sin_cos();
        let reach = (self.cone_rad + FRAC_PI_2).min(PI);
        let border = 2.0 * reach * sin - (self.cone_rad - 2.0 * reach).cos() - 2.0 * self.cone_rad * sin + cos;
        self.power * area * (2.0 * PI * (1.0 - cos) + FRAC_PI_2 * border)
    }

    fn node(&self, parent: u32, kind: NodeKind) -> Node {
        // Rounding must not leave a light outside.
        let cos_cone = if self.cone_rad >= PI { -1.0 } else { (self.cone_rad + 1e-3).cos() };
        Node {
            centre: (self.low + self.high) * 0.5,
            radius: (self.high - self.low).length() * 0.5 * 1.0001,
            axis: self.axis,
            cos_cone,
            power: self.power,
            aim: self.aim,
            parent,
            end: 0,
            kind,
        }
    }
}

/// The smallest cone that holds both groups' cones.
fn cone_around(a: &Group, b: &Group) -> (Vec3, f32) {
    let (a, b) = if a.cone_rad >= b.cone_rad { (a, b) } else { (b, a) };
    let between = a.axis.dot(b.axis).clamp(-1.0, 1.0).acos();
    if (between + b.cone_rad).min(PI) <= a.cone_rad {
        return (a.axis, a.cone_rad);
    }
    let cone_rad = (a.cone_rad + between + b.cone_rad) * 0.5;
    let turn_axis = a.axis.cross(b.axis);
    if cone_rad >= PI || turn_axis.length_squared() < 1e-12 {
        return (a.axis, if between < FRAC_PI_2 && cone_rad < PI { a.cone_rad.max(between + b.cone_rad) } else { PI });
    }
    let (sin, cos) = (cone_rad - a.cone_rad).sin_cos();
    let side = turn_axis.normalize().cross(a.axis);
    ((a.axis * cos + side * sin).normalize(), cone_rad)
}

/// Sorts lights into two parts at the cheapest of the places tried; returns where the second starts.
fn split(entries: &[TreeEntry], lights: &mut [u32]) -> usize {
    // Beams are compared last: most are faint beside what shines evenly.
    let has_beam = |i: u32| entries[i as usize].aim.is_some();
    lights.sort_by_key(|&i| has_beam(i));
    let even = lights.partition_point(|&i| !has_beam(i));
    if even > 0 && even < lights.len() {
        return even;
    }
    let centre = |i: u32| entries[i as usize].centre;
    let low = lights.iter().map(|&i| centre(i)).fold(Vec3::INFINITY, Vec3::min);
    let high = lights.iter().map(|&i| centre(i)).fold(-Vec3::INFINITY, Vec3::max);
    let extent = high - low;
    let bin_of =
        |i: u32, axis: usize| ((((centre(i) - low)[axis] / extent[axis]) * BINS as f32) as usize).min(BINS - 1);
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in (0..3).filter(|&axis| extent[axis] > 0.0) {
        let mut bins: [Option<Group>; BINS] = [None; BINS];
        for &i in lights.iter() {
            let bin = &mut bins[bin_of(i, axis)];
            let light = Group::of(&entries[i as usize]);
            *bin = Some(bin.map_or(light, |group| group.with(light)));
        }
        let join = |parts: &[Option<Group>]| parts.iter().flatten().copied().reduce(Group::with);
        // Long thin nodes are worse than their surface says.
        let regular = extent.max_element() / extent[axis];
        for cut in 1..BINS {
            let (Some(a), Some(b)) = (join(&bins[..cut]), join(&bins[cut..])) else { continue };
            let cost = regular * (a.cost() + b.cost());
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, cut));
            }
        }
    }
    match best {
        Some((_, axis, cut)) => {
            lights.sort_by_key(|&i| bin_of(i, axis) >= cut);
            lights.partition_point(|&i| bin_of(i, axis) < cut)
        }
        // All in one place.
        None => lights.len() / 2,
    }
}

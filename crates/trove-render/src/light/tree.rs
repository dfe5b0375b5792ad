//! Which of many lights shines on a place: a tree of lights (Conty Estevez and Kulla, "Importance Sampling of Many
//! Lights with Adaptive Tree Splitting", 2018).

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;

/// Lights that are compared one by one.
const LEAF: usize = 8;

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
    pub(super) power: f32,
}

/// Lights sorted into nested groups, each with its power, its place and the directions into which it shines.
pub(super) struct Tree {
    nodes: Vec<Node>,
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
    parent: u32,
    kind: NodeKind,
}

#[derive(Clone, Copy)]
enum NodeKind {
    /// The first child follows its parent; this is the second.
    Inner(u32),
    /// Start and end in the order.
    Leaf(u32, u32),
}

impl Tree {
    /// From at least one light.
    pub(super) fn new(entries: &[TreeEntry]) -> Self {
        let order = (0..entries.len() as u32).collect();
        let mut tree = Self { nodes: Vec::new(), order, leaf_of: vec![0; entries.len()] };
        tree.grow(entries, 0, entries.len(), 0);
        tree
    }

    fn grow(&mut self, entries: &[TreeEntry], start: usize, end: usize, parent: u32) {
        let here = self.nodes.len() as u32;
        let lights = &mut self.order[start..end];
        let group = lights.iter().map(|&i| Group::of(&entries[i as usize])).reduce(Group::with).expect("not empty");
        let middle = start + if lights.len() > LEAF { split(entries, lights) } else { 0 };
        self.nodes.push(group.node(parent, NodeKind::Leaf(start as u32, end as u32)));
        if middle == start {
            for &light in &self.order[start..end] {
                self.leaf_of[light as usize] = here;
            }
            return;
        }
        self.grow(entries, start, middle, here);
        self.nodes[here as usize].kind = NodeKind::Inner(self.nodes.len() as u32);
        self.grow(entries, middle, end, here);
    }

    /// A light and the probability with which it is drawn for a surface at `from` that is lit from the side of `normal`
    /// (both if it is 0); `weight` says what single lights give there. `None` where none gives anything.
    pub(super) fn draw(&self, from: Vec3, normal: Vec3, u: f32, weight: impl Fn(u32) -> f32) -> Option<(u32, f32)> {
        let (mut u, mut probability, mut here) = (u, 1.0, 0);
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
                    let mut total = 0.0;
                    for (w, &light) in weights.iter_mut().zip(lights) {
                        *w = weight(light);
                        total += *w;
                    }
                    if total <= 0.0 {
                        return None;
                    }
                    let mut left = u * total;
                    let mut found = None;
                    for (&w, &light) in weights.iter().zip(lights).filter(|(w, _)| **w > 0.0) {
                        found = Some((light, probability * (w / total)));
                        if left < w {
                            break;
                        }
                        left -= w;
                    }
                    return found;
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
        let mut here = self.leaf_of[light as usize] as usize;
        let NodeKind::Leaf(start, end) = self.nodes[here].kind else { return 0.0 };
        let total: f32 = self.order[start as usize..end as usize].iter().map(|&light| weight(light)).sum();
        let mut probability = own / total;
        while here != 0 {
            let parent = self.nodes[here].parent as usize;
            let NodeKind::Inner(second) = self.nodes[parent].kind else { return 0.0 };
            let Some(first) = self.first_share(parent, second, from, normal) else { return 0.0 };
            probability *= if here == second as usize { 1.0 - first } else { first };
            here = parent;
        }
        probability
    }

    /// Probability of a node's first child; `None` where neither gives anything.
    fn first_share(&self, here: usize, second: u32, from: Vec3, normal: Vec3) -> Option<f32> {
        let a = self.nodes[here + 1].importance(from, normal);
        let b = self.nodes[second as usize].importance(from, normal);
        (a + b > 0.0).then(|| a / (a + b))
    }
}

impl Node {
    /// Bound on what the group gives to a surface, but for occlusion; 0 only where it gives nothing.
    fn importance(&self, from: Vec3, normal: Vec3) -> f32 {
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
        self.power * cos_light * cos_surface / distance_squared
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
}

impl Group {
    fn of(entry: &TreeEntry) -> Self {
        let TreeEntry { low, high, axis, power, .. } = *entry;
        Self { low, high, axis, cone_rad: 0.0, power }
    }

    fn with(self, other: Self) -> Self {
        let (axis, cone_rad) = cone_around(&self, &other);
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            axis,
            cone_rad,
            power: self.power + other.power,
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
            parent,
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

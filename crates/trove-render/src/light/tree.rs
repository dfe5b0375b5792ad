//! A tree of lights, made ready (Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
//! Splitting", 2018).

use std::f32::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use glam::{Mat3, Vec3};
use trove_model::Beam;
use trove_trace::light::{self, Beams, Group, GroupAim, LEAF};

/// A beam that fills more than this at its brightest is broad, as street lamps' are; low beams fill some hundredths.
const BROAD_SR: f32 = 0.5;

/// Places at which a group may be cut, along each axis.
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
    index: u32,
    mesh_from_world: Mat3,
    /// Whether its light is spread so wide that groups of it need no telling apart.
    pub(super) is_broad: bool,
}

impl Aim {
    pub(super) fn new(beam: Arc<Beam>, index: u32, mesh_from_world: Mat3) -> Self {
        let is_broad = beam.flux() > BROAD_SR * beam.most();
        Self { beam, index, mesh_from_world, is_broad }
    }

    /// What it leaves of the flux of a matt surface with a normal, World, of any length but 0.
    pub(super) fn flux_share(&self, normal: Vec3) -> f32 {
        self.beam.flux_share((self.mesh_from_world * normal).normalize_or_zero())
    }
}

/// What [`light::Tree`] looks up.
pub(super) struct Tree {
    groups: Vec<Group>,
    order: Vec<u32>,
    leaf_of: Vec<u32>,
    aims: Vec<light::Aim>,
}

impl Tree {
    /// From at least one light, and the beams that they have.
    pub(super) fn new(entries: &[TreeEntry], aims: &[Aim]) -> Self {
        let order = (0..entries.len() as u32).collect();
        let (groups, leaf_of) = (Vec::new(), vec![0; entries.len()]);
        let mut tree = Self { groups, order, leaf_of, aims: Vec::new() };
        tree.grow(entries, 0, entries.len(), 0);
        tree.aims.extend(aims.iter().map(|aim| light::Aim { mesh_from_world: aim.mesh_from_world, beam: aim.index }));
        tree
    }

    /// To be looked up.
    pub(super) fn view<'a>(&'a self, beams: Beams<'a>) -> light::Tree<'a> {
        let Self { groups, order, leaf_of, aims } = self;
        light::Tree { groups, order, leaf_of, aims, beams }
    }

    fn grow(&mut self, entries: &[TreeEntry], start: usize, end: usize, parent: u32) {
        let here = self.groups.len() as u32;
        let lights = &mut self.order[start..end];
        let set = lights.iter().map(|&i| Set::of(&entries[i as usize])).reduce(Set::with).expect("not empty");
        let is_leaf = lights.len() <= LEAF && set.aim != GroupAim::Several;
        let middle = start + if is_leaf { 0 } else { split(entries, lights) };
        self.groups.push(set.group(parent, start as u32, (end - start) as u32));
        if middle == start {
            for &light in &self.order[start..end] {
                self.leaf_of[light as usize] = here;
            }
            self.groups[here as usize].end = here + 1;
            return;
        }
        self.grow(entries, start, middle, here);
        self.groups[here as usize].second = self.groups.len() as u32;
        self.grow(entries, middle, end, here);
        self.groups[here as usize].end = self.groups.len() as u32;
    }
}

/// A set of lights.
#[derive(Clone, Copy)]
struct Set {
    low: Vec3,
    high: Vec3,
    axis: Vec3,
    /// Half the opening of the cone of all normals.
    cone_rad: f32,
    power: f32,
    aim: GroupAim,
}

impl Set {
    fn of(entry: &TreeEntry) -> Self {
        let TreeEntry { low, high, axis, power, aim, .. } = *entry;
        Self { low, high, axis, cone_rad: 0.0, power, aim: aim.map_or(GroupAim::None, GroupAim::One) }
    }

    fn with(self, other: Self) -> Self {
        let (axis, cone_rad) = cone_around(&self, &other);
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            axis,
            cone_rad,
            power: self.power + other.power,
            aim: if self.aim == other.aim { self.aim } else { GroupAim::Several },
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

    fn group(&self, parent: u32, start: u32, count: u32) -> Group {
        // Rounding must not leave a light outside.
        let cos_cone = if self.cone_rad >= PI { -1.0 } else { (self.cone_rad + 1e-3).cos() };
        Group {
            centre: (self.low + self.high) * 0.5,
            radius: (self.high - self.low).length() * 0.5 * 1.0001,
            axis: self.axis,
            cos_cone,
            power: self.power,
            aim: self.aim,
            parent,
            end: 0,
            second: 0,
            start,
            count,
        }
    }
}

/// The smallest cone that holds both groups' cones.
fn cone_around(a: &Set, b: &Set) -> (Vec3, f32) {
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
        let mut bins: [Option<Set>; BINS] = [None; BINS];
        for &i in lights.iter() {
            let bin = &mut bins[bin_of(i, axis)];
            let light = Set::of(&entries[i as usize]);
            *bin = Some(bin.map_or(light, |group| group.with(light)));
        }
        let join = |parts: &[Option<Set>]| parts.iter().flatten().copied().reduce(Set::with);
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

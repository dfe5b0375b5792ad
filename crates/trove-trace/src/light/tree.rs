//! Which of many lights shines on a place: a tree of lights (Conty Estevez and Kulla, "Importance Sampling of Many
//! Lights with Adaptive Tree Splitting", 2018).

use glam::Vec3;

use super::beam::{Aim, Beams};
use crate::math::sqrt;

/// Lights that are compared one by one at most.
pub const LEAF: usize = 8;

/// Groups that are compared one by one at most.
const CUT: usize = 96;
/// How many of its radii away a group is compared as it is: one that shines evenly, and one with a beam.
const APART: f32 = 2.0;
const APART_IN_BEAM: f32 = 12.0;
/// Beams that at best give this share of all before them are not told apart.
const FAINT: f32 = 0.02;

/// What a beam is taken to give at least: another part of the lamp may shine there.
pub const LEAST_SHARE: f32 = 1e-3;

/// Lights sorted into nested groups, each with its power, its place and the directions into which it shines.
#[derive(Clone, Copy)]
pub struct Tree<'a> {
    /// Each group before those that it is of.
    pub groups: &'a [Group],
    /// Lights in the order of the leaves.
    pub order: &'a [u32],
    /// The leaf of each light.
    pub leaf_of: &'a [u32],
    /// How beams are turned.
    pub aims: &'a [Aim],
    /// The beams.
    pub beams: Beams<'a>,
}

/// A group of lights.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Group {
    /// Of a sphere that holds them.
    pub centre: Vec3,
    /// Of that sphere.
    pub radius: f32,
    /// Of a cone that holds their normals, unit.
    pub axis: Vec3,
    /// Cosine of half its opening.
    pub cos_cone: f32,
    /// Area times luminance of all, in the brightest direction of their beams.
    pub power: f32,
    /// The beam that all of them have.
    pub aim: GroupAim,
    /// The group that it is of.
    pub parent: u32,
    /// The first group behind it and all below it.
    pub end: u32,
    /// The second of the two groups that it consists of, of which the first follows it; 0 for a leaf.
    pub second: u32,
    /// Where a leaf's lights begin in the order.
    pub start: u32,
    /// How many lights a leaf has, at most [`LEAF`] of them.
    pub count: u32,
}

/// The beam of a group's lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, u32)]
pub enum GroupAim {
    /// They have none.
    None,
    /// All have this one.
    One(u32),
    /// They have different ones.
    Several,
}

/// Groups that are compared one by one for a surface.
pub struct Cut {
    /// Indices of groups, and bounds on what they give.
    groups: [(u32, f32); CUT],
    count: usize,
    total: f32,
}

impl Cut {
    #[inline(always)]
    fn groups(&self) -> core::slice::Iter<'_, (u32, f32)> {
        self.groups[..self.count].iter()
    }
}

impl Tree<'_> {
    /// A light and the probability with which it is drawn for a surface at `from` that is lit from the side of `normal`
    /// (both if it is 0), given its cut; `weight` says what single lights give there. `None` where none gives anything.
    #[inline]
    pub fn draw(&self, cut: &Cut, from: Vec3, normal: Vec3, u: f32, weight: impl Fn(u32) -> f32) -> Option<(u32, f32)> {
        let (here, share, mut u) = pick(cut.groups().copied(), cut.total, u)?;
        let (mut here, mut probability) = (here, share);
        loop {
            let group = &self.groups[here as usize];
            if group.second == 0 {
                let lights = self.lights(group);
                let mut weights = [0.0; LEAF];
                weights.iter_mut().zip(lights).for_each(|(w, &light)| *w = weight(light));
                let total = weights.iter().sum();
                let (light, share, _) = pick(lights.iter().copied().zip(weights), total, u)?;
                return Some((light, probability * share));
            }
            let first = self.first_share(here, group.second, from, normal)?;
            if u < first {
                (u, probability, here) = (u / first, probability * first, here + 1);
            } else {
                (u, probability) = ((u - first) / (1.0 - first), probability * (1.0 - first));
                here = group.second;
            }
        }
    }

    /// The probability with which a light is drawn.
    #[inline]
    pub fn probability(&self, light: u32, from: Vec3, normal: Vec3, weight: impl Fn(u32) -> f32) -> f32 {
        let own = weight(light);
        if own <= 0.0 {
            return 0.0;
        }
        let leaf = self.leaf_of[light as usize];
        let total: f32 = self.lights(&self.groups[leaf as usize]).iter().map(|&light| weight(light)).sum();
        let cut = self.cut(from, normal);
        let holds = |&&(group, _): &&(u32, f32)| group <= leaf && leaf < self.groups[group as usize].end;
        let Some(&(top, importance)) = cut.groups().find(holds) else { return 0.0 };
        let mut probability = own / total * (importance / cut.total);
        let mut here = leaf;
        while here != top {
            let parent = self.groups[here as usize].parent;
            let second = self.groups[parent as usize].second;
            let Some(first) = self.first_share(parent, second, from, normal) else { return 0.0 };
            probability *= if here == second { 1.0 - first } else { first };
            here = parent;
        }
        probability
    }

    /// Groups that together hold all lights that give something to a surface, each so small for its distance that its
    /// bound tells what it gives.
    #[inline]
    pub fn cut(&self, from: Vec3, normal: Vec3) -> Cut {
        let mut cut = Cut { groups: [(0, 0.0); CUT], count: 0, total: 0.0 };
        let mut waiting = [0u32; CUT];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let here = waiting[count];
            let group = &self.groups[here as usize];
            let has_room = cut.count + count + 2 <= CUT;
            if group.second != 0
                && has_room
                && !group.is_apart(from)
                && (group.aim != GroupAim::Several || group.bound(from, normal) > FAINT * cut.total)
            {
                (waiting[count], waiting[count + 1]) = (group.second, here + 1);
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

    #[inline(always)]
    fn lights(&self, leaf: &Group) -> &[u32] {
        &self.order[leaf.start as usize..][..leaf.count as usize]
    }

    /// What a group's lights give to a surface, roughly and but for occlusion; 0 only where they give nothing.
    #[inline(always)]
    fn importance(&self, group: u32, from: Vec3, normal: Vec3) -> f32 {
        let group = &self.groups[group as usize];
        let bound = group.bound(from, normal);
        match group.aim {
            GroupAim::One(aim) if bound > 0.0 => {
                bound * self.beams.aimed(&self.aims[aim as usize], from - group.centre).max(LEAST_SHARE)
            }
            _ => bound,
        }
    }

    /// Probability of a group's first part; `None` where neither gives anything.
    #[inline(always)]
    fn first_share(&self, here: u32, second: u32, from: Vec3, normal: Vec3) -> Option<f32> {
        let a = self.importance(here + 1, from, normal);
        let b = self.importance(second, from, normal);
        (a + b > 0.0).then(|| a / (a + b))
    }
}

/// What a number in [0, 1) falls on among weights with this sum, its share of them, and where in it the number lies, again
/// in [0, 1); `None` where none weighs anything.
#[inline(always)]
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

impl Group {
    /// Whether its bound is near what it gives, seen from there.
    #[inline(always)]
    fn is_apart(&self, from: Vec3) -> bool {
        let apart = match self.aim {
            GroupAim::None => APART,
            GroupAim::One(_) => APART_IN_BEAM,
            GroupAim::Several => return false,
        };
        let least = apart * self.radius;
        (self.centre - from).length_squared() > least * least
    }

    /// Bound on what the group gives to a surface, but for occlusion; 0 only where it gives nothing.
    #[inline(always)]
    fn bound(&self, from: Vec3, normal: Vec3) -> f32 {
        let to_group = self.centre - from;
        let distance_squared = to_group.length_squared();
        let radius_squared = self.radius * self.radius;
        // Inside the group's sphere it may be in any direction.
        if distance_squared <= radius_squared {
            return self.power / radius_squared.max(f32::MIN_POSITIVE);
        }
        let to_group = to_group / sqrt(distance_squared);
        let sin_spread = sqrt(radius_squared / distance_squared);
        let cos_spread = sqrt(1.0 - sin_spread * sin_spread);
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
#[inline(always)]
fn nearer(cos_a: f32, cos_b: f32) -> f32 {
    if cos_a >= cos_b {
        return 1.0;
    }
    let sines = sqrt((1.0 - cos_a * cos_a).max(0.0) * (1.0 - cos_b * cos_b).max(0.0));
    cos_a * cos_b + sines
}

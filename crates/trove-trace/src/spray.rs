//! Puffs of droplets behind vehicles, which scatter light as fog does.
//!
//! What is seen straight or through panes is seen through them; mirrors show none, and they cast no shadow.

use glam::Vec3;

use crate::math::{exp, log_less, sqrt};

/// Halvings of the way through puffs, in which a droplet is looked for.
const HALVINGS: u32 = 24;

/// An ellipsoid of droplets, thickest in its middle: by (1 − r²)², r from 0 there to 1 at its edge.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Puff {
    /// World, metres.
    pub centre: Vec3,
    /// What makes it a ball of radius 1: one over half of its size along each of World's axes, metres.
    pub per_radius: Vec3,
    /// What a metre takes from light in its middle, as the exponent of its loss.
    pub extinction_per_m: f32,
}

/// What one vehicle throws up.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Plume {
    /// Box around its puffs, World.
    pub low: Vec3,
    /// Its other corner.
    pub high: Vec3,
    /// Its first puff.
    pub first: u32,
    /// How many it has.
    pub count: u32,
}

/// All spray of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Spray<'a> {
    /// Of vehicles.
    pub plumes: &'a [Plume],
    /// Of all plumes.
    pub puffs: &'a [Puff],
}

impl Puff {
    /// What a metre takes at a place in World.
    fn extinction_at(&self, place: Vec3) -> f32 {
        let inside = (1.0 - ((place - self.centre) * self.per_radius).length_squared()).max(0.0);
        self.extinction_per_m * inside * inside
    }

    /// What it takes of light on the first `t_m` metres along a unit direction, as the exponent of the loss.
    fn optical_depth(&self, origin: Vec3, direction: Vec3, t_m: f32) -> f32 {
        let (from, way) = ((origin - self.centre) * self.per_radius, direction * self.per_radius);
        let per_m = sqrt(way.length_squared());
        let nearest_m = -from.dot(way) / (per_m * per_m);
        let inside_squared = 1.0 - (from + way * nearest_m).length_squared();
        if inside_squared <= 0.0 {
            return 0.0;
        }
        let half = sqrt(inside_squared);
        let [first, last] = [0.0, t_m].map(|t| ((t - nearest_m) * per_m).clamp(-half, half));
        // ∫ (h² − u²)² du
        let until = |u: f32| {
            let u2 = u * u;
            u * (inside_squared * (inside_squared - u2 / 1.5) + u2 * u2 / 5.0)
        };
        self.extinction_per_m * (until(last) - until(first)) / per_m
    }

    /// How far from a place its farthest point can be.
    fn reach(&self, place: Vec3) -> f32 {
        sqrt((self.centre - place).length_squared()) + 1.0 / self.per_radius.min_element()
    }
}

impl Plume {
    /// Whether a ray goes through its box.
    fn is_on(&self, origin: Vec3, direction: Vec3, t_max: f32) -> bool {
        let [a, b] = [self.low, self.high].map(|side| (side - origin) / direction);
        a.min(b).max_element().max(0.0) <= a.max(b).min_element().min(t_max)
    }
}

impl<'a> Spray<'a> {
    /// The puffs of plumes whose boxes a ray goes through.
    fn on(&self, origin: Vec3, direction: Vec3, t_max: f32) -> impl Iterator<Item = &'a Puff> {
        let Self { plumes, puffs } = *self;
        let on = plumes.iter().filter(move |plume| plume.is_on(origin, direction, t_max));
        on.flat_map(move |plume| &puffs[plume.first as usize..][..plume.count as usize])
    }

    /// Exponent of what it takes on the first metres of a ray.
    fn depth(&self, origin: Vec3, direction: Vec3, t: f32) -> f32 {
        self.on(origin, direction, t).map(|puff| puff.optical_depth(origin, direction, t)).sum()
    }

    /// Share of light that passes along a unit direction for `t` metres.
    pub fn transmittance(&self, origin: Vec3, direction: Vec3, t: f32) -> f32 {
        exp(-self.depth(origin, direction, t))
    }

    /// Where within `t_max` metres a ray meets a droplet, by a number drawn from 0 to 1; `None` where it meets none.
    pub fn met(&self, origin: Vec3, direction: Vec3, t_max: f32, u: f32) -> Option<f32> {
        let wanted = u * log_less(u);
        if self.depth(origin, direction, t_max) <= wanted {
            return None;
        }
        // What a ray without an end passes lies before its farthest puff's end.
        let farthest = self.on(origin, direction, t_max).map(|puff| puff.reach(origin)).fold(0.0, f32::max);
        let (mut near, mut far) = (0.0, farthest.min(t_max));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if self.depth(origin, direction, middle) > wanted { far = middle } else { near = middle }
        }
        Some(far)
    }

    /// What a metre takes at a place in World.
    pub fn extinction_at(&self, place: Vec3) -> f32 {
        self.puffs.iter().map(|puff| puff.extinction_at(place)).sum()
    }
}

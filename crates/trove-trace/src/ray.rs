//! Rays and what they meet.

use glam::Vec3;

/// No motion, no material, no instance.
pub const NONE: u32 = u32::MAX;

/// A ray in World; distances are in lengths of `direction`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Ray {
    /// Where it starts, World.
    pub origin: Vec3,
    /// Hits before this distance do not count.
    pub t_min: f32,
    /// Where it runs, World, of any length but 0.
    pub direction: Vec3,
    /// Nor do those from this distance on.
    pub t_max: f32,
    /// When, from 0 to 1; the moment of the labels is 0.5.
    pub time: f32,
}

impl Hit {
    /// None: instance and triangle are [`NONE`].
    pub const NOTHING: Self = Self { t: f32::INFINITY, instance: NONE, triangle: NONE, u: 0.0, v: 0.0 };
}

impl Ray {
    /// Another ray of the same time, to infinity.
    #[inline]
    pub fn then(&self, origin: Vec3, direction: Vec3) -> Self {
        Self { origin, t_min: 0.0, direction, t_max: f32::INFINITY, time: self.time }
    }
}

/// Where a ray meets a triangle: the point is (1 − u − v)·a + u·b + v·c.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Hit {
    /// Distance, lengths of the ray's direction.
    pub t: f32,
    /// Index into the scene's instances.
    pub instance: u32,
    /// Index into the mesh's triangles.
    pub triangle: u32,
    /// Share of the second corner.
    pub u: f32,
    /// Share of the third corner.
    pub v: f32,
}

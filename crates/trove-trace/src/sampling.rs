//! Directions drawn with pairs of random numbers.

use core::f32::consts::{FRAC_PI_4, PI};

use glam::Vec3;

use crate::math::{eighth, sqrt};

/// A direction about +z with density cos θ / π.
#[inline]
pub fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let [x, y] = disk(u);
    Vec3::new(x, y, sqrt((1.0 - x * x - y * y).max(0.0)))
}

/// Density of [`cosine_hemisphere`].
#[inline]
pub fn cosine_pdf(cos: f32) -> f32 {
    cos.max(0.0) / PI
}

/// A point on the unit disk, neighbours staying neighbours (Shirley, Chiu 1997).
#[inline]
pub fn disk(u: [f32; 2]) -> [f32; 2] {
    let [x, y] = u.map(|u| 2.0 * u - 1.0);
    if x == 0.0 && y == 0.0 {
        return [0.0, 0.0];
    }
    if x.abs() > y.abs() {
        let (sin, cos) = eighth(FRAC_PI_4 * (y / x));
        [x * cos, x * sin]
    } else {
        let (sin, cos) = eighth(FRAC_PI_4 * (x / y));
        [y * sin, y * cos]
    }
}

/// Three axes of which z is given.
#[derive(Clone, Copy)]
pub struct Basis {
    x: Vec3,
    y: Vec3,
    z: Vec3,
}

impl Basis {
    /// About a unit vector.
    #[inline]
    pub fn about(z: Vec3) -> Self {
        let (x, y) = z.any_orthonormal_pair();
        Self { x, y, z }
    }

    /// From coordinates along the axes.
    #[inline]
    pub fn to_world(self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    /// Coordinates along the axes.
    #[inline]
    pub fn to_local(self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }
}

/// Weight of a direction drawn with density `a` that could have been drawn with density `b` too (Veach 1995, power 2).
#[inline]
pub fn power_heuristic(a: f32, b: f32) -> f32 {
    // Divided first, so that large densities do not overflow.
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}

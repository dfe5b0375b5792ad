//! Random numbers for a pixel and what directions are drawn with them.

mod sampler;

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use glam::Vec3;
use trove_model::Random;

pub(crate) use sampler::Sampler;

/// Mean count from which on it is drawn from a normal distribution, which is near enough then.
const MANY: f64 = 40.0;

/// A direction about +z with density cos θ / π.
pub(crate) fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let [x, y] = disk(u);
    Vec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt())
}

/// Density of [`cosine_hemisphere`].
pub(crate) fn cosine_pdf(cos: f32) -> f32 {
    cos.max(0.0) / PI
}

/// A point on the unit disk, neighbours staying neighbours (Shirley, Chiu 1997).
pub(crate) fn disk(u: [f32; 2]) -> [f32; 2] {
    let [x, y] = u.map(|u| 2.0 * u - 1.0);
    if x == 0.0 && y == 0.0 {
        return [0.0, 0.0];
    }
    let (r, angle) = if x.abs() > y.abs() { (x, FRAC_PI_4 * (y / x)) } else { (y, FRAC_PI_2 - FRAC_PI_4 * (x / y)) };
    let (sin, cos) = angle.sin_cos();
    [r * cos, r * sin]
}

/// Three axes of which z is given.
#[derive(Clone, Copy)]
pub(crate) struct Basis {
    x: Vec3,
    y: Vec3,
    z: Vec3,
}

impl Basis {
    /// About a unit vector.
    pub(crate) fn about(z: Vec3) -> Self {
        let (x, y) = z.any_orthonormal_pair();
        Self { x, y, z }
    }

    pub(crate) fn to_world(self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    pub(crate) fn to_local(self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }
}

/// Weight of a direction drawn with density `a` that could have been drawn with density `b` too (Veach 1995, power 2).
pub(crate) fn power_heuristic(a: f32, b: f32) -> f32 {
    // Divided first, so that large densities do not overflow.
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}

/// A draw from the Poisson distribution.
pub(crate) fn poisson(mean: f64, random: &mut Random) -> f64 {
    if mean >= MANY {
        return (mean + mean.sqrt() * random.normal()).round().max(0.0);
    }
    // Inversion: the chances of 0, 1, 2 … are gone through until the drawn number is used up.
    let (mut left, mut chance, mut count) = (random.unit(), (-mean).exp(), 0.0);
    while left >= chance && count < 10.0 * MANY {
        left -= chance;
        count += 1.0;
        chance *= mean / count;
    }
    count
}

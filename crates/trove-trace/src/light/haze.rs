//! Air of a fair day between the eye and what it sees: it takes little, and sends the sky's light in its place.

use glam::Vec3;

use crate::math::exp;

/// What air takes from light near the ground.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Haze {
    /// Of red, green and blue.
    pub extinction_per_m: Vec3,
}

impl Haze {
    /// Share of red, green and blue that passes `distance_m` metres of it.
    #[inline]
    pub fn transmittance(self, distance_m: f32) -> Vec3 {
        (-self.extinction_per_m * distance_m).map(exp)
    }
}

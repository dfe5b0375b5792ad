//! A ray against boxes.

use glam::{Vec3, Vec4, Vec4Swizzles};

use crate::pair::Pair;

/// A ray as boxes want it.
#[derive(Clone, Copy)]
pub(crate) struct Beam {
    origin: Vec3,
    inverse: Vec3,
}

impl Beam {
    pub(crate) fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, inverse: Vec3::new(inverse(direction.x), inverse(direction.y), inverse(direction.z)) }
    }

    /// Where it enters both boxes; infinity where it does not.
    #[inline(always)]
    pub(crate) fn enters(&self, pair: &Pair) -> [f32; 2] {
        let along = |bounds: Vec4, origin: f32, inverse: f32| (bounds - origin) * inverse;
        let x = along(pair.bounds[0], self.origin.x, self.inverse.x);
        let y = along(pair.bounds[1], self.origin.y, self.inverse.y);
        let z = along(pair.bounds[2], self.origin.z, self.inverse.z);
        let near = most(most(least(x, x.zwxy()), least(y, y.zwxy())), least(z, z.zwxy()));
        let far = least(least(most(x, x.zwxy()), most(y, y.zwxy())), most(z, z.zwxy()));
        let enter = |near: f32, far: f32| if far >= near && far >= 0.0 { near } else { f32::INFINITY };
        [enter(near.x, far.x), enter(near.y, far.y)]
    }
}

/// 1 / x, and as large as it gets where x is next to 0.
fn inverse(x: f32) -> f32 {
    if x.abs() <= f32::EPSILON { x.signum() / f32::EPSILON } else { 1.0 / x }
}

/// The lesser one of each two numbers, of which none is NaN.
#[inline(always)]
fn least(a: Vec4, b: Vec4) -> Vec4 {
    // A card has an instruction for what a processor would have to do for NaN, and the other way round.
    if cfg!(target_arch = "nvptx64") {
        Vec4::new(a.x.min(b.x), a.y.min(b.y), a.z.min(b.z), a.w.min(b.w))
    } else {
        a.min(b)
    }
}

/// The greater one.
#[inline(always)]
fn most(a: Vec4, b: Vec4) -> Vec4 {
    if cfg!(target_arch = "nvptx64") {
        Vec4::new(a.x.max(b.x), a.y.max(b.y), a.z.max(b.z), a.w.max(b.w))
    } else {
        a.max(b)
    }
}

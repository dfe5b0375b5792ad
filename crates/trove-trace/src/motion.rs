//! Where an instance is while the shutter is open.

use glam::Affine3A;

/// `world_from_mesh` over a ray's time: two straight stretches that meet at the moment of the labels.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Motion {
    /// At [`Motion::MIDDLE`].
    pub middle: Affine3A,
    /// At times 0 and 1.
    pub ends: [Affine3A; 2],
}

impl Motion {
    /// A ray's time at the moment of the labels.
    pub const MIDDLE: f32 = 0.5;

    /// At a ray's time.
    #[inline]
    pub fn at(&self, time: f32) -> Affine3A {
        let [before, after] = &self.ends;
        let (end, share) = if time < Self::MIDDLE {
            (before, 1.0 - 2.0 * time)
        } else if time > Self::MIDDLE {
            (after, 2.0 * time - 1.0)
        } else {
            return self.middle;
        };
        Affine3A {
            matrix3: self.middle.matrix3 * (1.0 - share) + end.matrix3 * share,
            translation: self.middle.translation * (1.0 - share) + end.translation * share,
        }
    }
}

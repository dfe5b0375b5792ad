//! Coordinate frames and rigid transforms that compose only where the frames meet.

use std::marker::PhantomData;
use std::ops::Mul;

use glam::{DAffine3, DMat3, DQuat, DVec3};

/// A coordinate frame, known to the compiler only.
pub trait Frame: Copy + 'static {
    /// Name as it is printed.
    const NAME: &'static str;
}

macro_rules! frame {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct $name;
        impl Frame for $name {
            const NAME: &'static str = stringify!($name);
        }
    };
}

frame!(
    /// Metres, right-handed, x east, y north, z up; the origin is the drive's anchor.
    World
);
frame!(
    /// The recording vehicle: x forward, y left, z up; the origin is the middle of the rear axle on the ground.
    Ego
);
frame!(
    /// An object: x forward, y left, z up; the origin is the centre of its box.
    Body
);
frame!(
    /// OpenCV camera: x right, y down, z forward; the origin is the centre of projection.
    Camera
);
frame!(
    /// A sensor, such as a LiDAR, in its own axes.
    SensorFrame
);

/// Rigid transform that takes coordinates in `Src` to coordinates in `Dst`; write it `dst_from_src`.
pub struct Pose<Dst, Src> {
    /// Unit quaternion.
    pub rotation: DQuat,
    /// Origin of `Src` in `Dst`, metres.
    pub translation: DVec3,
    frames: PhantomData<fn() -> (Dst, Src)>,
}

impl<Dst: Frame, Src: Frame> Pose<Dst, Src> {
    /// The frames coincide.
    pub const IDENTITY: Self = Self { rotation: DQuat::IDENTITY, translation: DVec3::ZERO, frames: PhantomData };

    /// From a quaternion, which is normalised, and the origin of `Src` in `Dst`.
    pub fn new(rotation: DQuat, translation: DVec3) -> Self {
        Self { rotation: rotation.normalize(), translation, frames: PhantomData }
    }

    /// From the heading `yaw_rad` about z (counter-clockwise from x) and the origin of `Src` in `Dst`.
    pub fn from_yaw(yaw_rad: f64, translation: DVec3) -> Self {
        Self::new(DQuat::from_rotation_z(yaw_rad), translation)
    }

    /// `src_from_dst`.
    pub fn inverse(&self) -> Pose<Src, Dst> {
        let rotation = self.rotation.conjugate();
        Pose { rotation, translation: -(rotation * self.translation), frames: PhantomData }
    }

    /// Takes a point.
    pub fn point(&self, point_src: DVec3) -> DVec3 {
        self.rotation * point_src + self.translation
    }

    /// Takes a direction or a displacement.
    pub fn vector(&self, vector_src: DVec3) -> DVec3 {
        self.rotation * vector_src
    }

    /// Heading of `Src`'s x axis about `Dst`'s z axis, in (−π, π].
    pub fn yaw_rad(&self) -> f64 {
        let forward = self.vector(DVec3::X);
        forward.y.atan2(forward.x)
    }

    /// Rotation matrix whose columns are `Src`'s axes in `Dst`.
    pub fn rotation_matrix(&self) -> DMat3 {
        DMat3::from_quat(self.rotation)
    }

    /// The same transform without its frames.
    pub fn affine(&self) -> DAffine3 {
        DAffine3::from_rotation_translation(self.rotation, self.translation)
    }

    /// Between `self` (t = 0) and `other` (t = 1): linear in translation, spherical in rotation.
    pub fn interpolate(&self, other: &Self, t: f64) -> Self {
        Self::new(self.rotation.slerp(other.rotation, t), self.translation.lerp(other.translation, t))
    }

    /// False where a number is NaN or infinite.
    pub fn is_finite(&self) -> bool {
        self.rotation.is_finite() && self.translation.is_finite()
    }
}

impl<Dst: Frame, Src: Frame> Clone for Pose<Dst, Src> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<Dst: Frame, Src: Frame> Copy for Pose<Dst, Src> {}

impl<Dst: Frame, Src: Frame> PartialEq for Pose<Dst, Src> {
    fn eq(&self, other: &Self) -> bool {
        self.rotation == other.rotation && self.translation == other.translation
    }
}

impl<Dst: Frame, Src: Frame> std::fmt::Debug for Pose<Dst, Src> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}_from_{}({:?}, {:?})", Dst::NAME, Src::NAME, self.rotation, self.translation)
    }
}

/// `a_from_b * b_from_c = a_from_c`.
impl<A: Frame, B: Frame, C: Frame> Mul<Pose<B, C>> for Pose<A, B> {
    type Output = Pose<A, C>;
    fn mul(self, b_from_c: Pose<B, C>) -> Pose<A, C> {
        Pose::new(self.rotation * b_from_c.rotation, self.point(b_from_c.translation))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn pose<A: Frame, B: Frame>() -> impl Strategy<Value = Pose<A, B>> {
        (-3.0..3.0f64, -3.0..3.0f64, -3.0..3.0f64, prop::array::uniform3(-1e3..1e3f64))
            .prop_map(|(x, y, z, t)| Pose::new(DQuat::from_euler(glam::EulerRot::ZYX, z, y, x), DVec3::from_array(t)))
    }

    proptest! {
        #[test]
        fn a_pose_and_its_inverse_cancel(p in pose::<World, Ego>(), v in prop::array::uniform3(-1e3..1e3f64)) {
            let v = DVec3::from_array(v);
            prop_assert!((p.inverse().point(p.point(v)) - v).length() < 1e-9);
        }

        #[test]
        fn composition_takes_points_one_after_the_other(a in pose::<World, Ego>(), b in pose::<Ego, Camera>(), v in prop::array::uniform3(-1e3..1e3f64)) {
            let v = DVec3::from_array(v);
            prop_assert!(((a * b).point(v) - a.point(b.point(v))).length() < 1e-9);
        }

        #[test]
        fn the_yaw_that_goes_in_comes_out(yaw in -3.1..3.1f64) {
            prop_assert!((Pose::<World, Body>::from_yaw(yaw, DVec3::ZERO).yaw_rad() - yaw).abs() < 1e-12);
        }
    }
}

//! Where wheels and floor are.

pub(super) const WHEEL_M: f32 = 0.225;
/// Behind the front of the mudguard.
pub(super) const FRONT_AXLE_M: f32 = 0.31;
pub(super) const REAR_AXLE_M: f32 = 2.31;
/// Height of the floor.
pub(super) const FLOOR_M: f32 = 0.3;

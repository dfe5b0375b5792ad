//! Garments, cut from the body's clothing helpers, and who wears which.

use glam::{Vec3, vec3};
use serde::Deserialize;
use trove_model::HumanBody;

use super::pattern::Pattern;
use super::skeleton::Skeleton;
use super::wearer::nearest;

/// What covers the trunk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Top {
    /// How far down the arms: 0 none, 1 to the elbow, 2 to the wrist.
    pub(super) sleeve: f32,
    /// How deep the neckline is cut below the throat.
    pub(super) neck_m: f32,
    /// Height of its hem in the body's own shape: 0.1 at the waist, 0 over the hips.
    pub(super) hem_m: f32,
    /// How wide it is: 0 close, 1 loose.
    pub(super) wide: f32,
}

/// What covers the legs.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Bottom {
    /// Down to a place along the legs: 1 the knee, 2 the ankle; width of the leg at its hem.
    Trousers { to: f32, hem_m: f32 },
    /// A skirt down to a height in the body's own shape.
    Skirt { hem_m: f32 },
}

/// The body's own shape, for cutting: where on limbs a point lies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cutter {
    arm: [Vec3; 3],
    leg: [Vec3; 3],
}

pub(super) const WAIST_M: f32 = 0.112;

impl Cutter {
    pub(super) fn new(body: &HumanBody) -> Self {
        let skeleton = Skeleton::new(body, &body.positions);
        let chain = |names: [&str; 3]| names.map(|n| skeleton.at(n, 0));
        Self { arm: chain(["upperarm", "lowerarm", "hand"]), leg: chain(["thigh", "calf", "foot"]) }
    }

    /// How far along an arm a point is: 0 at the shoulder and on the trunk, 1 at the elbow, 2 at the wrist, more beyond.
    pub(super) fn along_arm(&self, p: Vec3) -> f32 {
        let q = vec3(p.x, p.y.abs(), p.z);
        if q.y < 0.15 || q.z < 0.62 - 1.2 * q.y {
            return 0.0;
        }
        let beyond = (q - self.arm[2]).dot((self.arm[2] - self.arm[1]).normalize_or_zero());
        if beyond > 0.0 { 2.0 + beyond / 0.23 } else { nearest(&self.arm, q).1 }
    }

    /// How far along a leg: 0 at the hip and above, 1 at the knee, 2 at the ankle.
    pub(super) fn along_leg(&self, p: Vec3) -> f32 {
        if p.z > 0.05 { 0.0 } else { nearest(&self.leg, vec3(p.x, p.y.abs(), p.z)).1 }
    }

    /// Where a point lies under a top, about metres from its edges.
    pub(super) fn under_top(&self, top: &Top, p: Vec3) -> f32 {
        let front = ((p.x - 0.0) / 0.08).clamp(0.0, 1.0);
        let aside = (p.y.abs() - 0.045).max(0.0);
        let neck = 0.578 - 0.28 * p.x - top.neck_m * front + 0.9 * aside - p.z;
        let sleeve = (top.sleeve - self.along_arm(p)) * 0.23;
        let arm = self.along_arm(p) > 0.0;
        neck.min(sleeve).min(if arm { 1.0 } else { p.z - top.hem_m })
    }

    /// The same for what covers the legs; arms and hands hang beside it.
    pub(super) fn under_bottom(&self, bottom: &Bottom, p: Vec3) -> f32 {
        if self.along_arm(p) > 0.0 {
            return -1.0;
        }
        match bottom {
            Bottom::Trousers { to, .. } => (WAIST_M - p.z).min((to - self.along_leg(p)) * 0.4),
            Bottom::Skirt { hem_m } => (WAIST_M - p.z).min(p.z - hem_m),
        }
    }

    /// Where a point lies in shoes that end at a height.
    pub(super) fn in_shoes(top_m: f32, p: Vec3) -> f32 {
        // The opening is higher at the heel and the tongue.
        top_m - p.z
    }

    /// The opening of a jacket over the chest.
    pub(super) fn lapels(p: Vec3) -> f32 {
        if p.x < 0.02 { -1.0 } else { 0.30 * (p.z - 0.27) - p.y.abs() }
    }
}

/// What of the skin is not under any of these.
pub(super) fn bare(body: &HumanBody, skin: &Pattern, covers: impl Fn(Vec3) -> f32) -> Pattern {
    // Cloth overlaps the skin by two centimetres.
    skin.cut(body, |p| 0.022 - covers(p))
}

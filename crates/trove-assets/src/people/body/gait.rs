//! Walking and running: feet that stay where they touch the ground, and all that follows from them. Shares of the cycle
//! and angles are those of normal gait (Perry and Burnfield 2010; Novacheck 1998).

use std::f32::consts::TAU;

use glam::{Quat, Vec3, vec3};

use super::skeleton::Skeleton;
use super::stance::{Arm, Foot, Legs, Stance};

/// A way of going.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Gait {
    Walk,
    Run,
}

impl Gait {
    /// How far a cycle of two steps goes, metres.
    pub(super) fn stride_m(self, skeleton: &Skeleton) -> f32 {
        Legs::of(skeleton).length_m * if self == Self::Walk { 1.56 } else { 2.7 }
    }

    /// Share of the cycle in which a foot is on the ground, and where its middle stands then.
    fn contact(self) -> [f32; 2] {
        if self == Self::Walk { [0.62, 0.29] } else { [0.36, 0.15] }
    }

    /// How far the toes point down at a time of the contact.
    fn pitch(self, phase: f32) -> f32 {
        let rise = |from: f32, to: f32| ((phase - from) / (to - from)).clamp(0.0, 1.0);
        match self {
            Self::Walk => -0.33 * (1.0 - rise(0.0, 0.12)) + 0.95 * rise(0.36, 0.62).powf(1.4),
            Self::Run => 1.05 * rise(0.14, 0.36).powf(1.3),
        }
    }

    /// A foot at a time since it touched the ground.
    fn foot(self, phase: f32, legs: &Legs, stride_m: f32) -> Foot {
        let [contact, middle] = self.contact();
        let width = if self == Self::Walk { 0.07 } else { 0.045 };
        let standing = |phase: f32| {
            let pitch = self.pitch(phase);
            let pivot = if pitch < 0.0 { legs.heel } else { legs.ball };
            let ankle = vec3(stride_m * (middle - phase), 0.0, 0.0) + pivot - Quat::from_rotation_y(pitch) * pivot;
            (ankle, pitch)
        };
        let (ankle, pitch, toes) = if phase <= contact {
            let (ankle, pitch) = standing(phase);
            (ankle, pitch, pitch.max(0.0) * 0.85)
        } else {
            let t = (phase - contact) / (1.0 - contact);
            let ((from, pitch_from), (to, pitch_to)) = (standing(contact), standing(0.0));
            // As fast as the ground at both ends (Hermite).
            let speed = -stride_m * (1.0 - contact);
            let (t2, t3) = (t * t, t * t * t);
            let x = from.x * (2.0 * t3 - 3.0 * t2 + 1.0)
                + to.x * (3.0 * t2 - 2.0 * t3)
                + speed * ((t3 - 2.0 * t2 + t) + (t3 - t2)) * 0.4;
            let lift = if self == Self::Walk { 0.06 } else { 0.36 } * legs.length_m;
            let early = if self == Self::Walk { t } else { t.powf(0.75) };
            let z = from.z + (to.z - from.z) * t + lift * (early * TAU / 2.0).sin();
            let s = t2 * (3.0 - 2.0 * t);
            let kick = if self == Self::Walk { 0.1 } else { 0.35 } * (t * TAU / 2.0).sin();
            (vec3(x, 0.0, z), pitch_from + (pitch_to - pitch_from) * s + kick, pitch_from * 0.85 * (1.0 - t).powi(3))
        };
        let ankle = ankle / legs.length_m + Vec3::Y * width;
        Foot { ankle, pitch_rad: pitch, yaw_rad: 0.09, toes_rad: toes }
    }

    /// The whole body at a share of the cycle since the left foot touched the ground.
    pub(super) fn stance(self, phase: f32, skeleton: &Skeleton) -> Stance {
        let legs = Legs::of(skeleton);
        let stride_m = self.stride_m(skeleton);
        let phases = [phase, (phase + 0.5).fract()];
        let feet = phases.map(|p| self.foot(p, &legs, stride_m));
        let [contact, _] = self.contact();
        let is_walk = self == Self::Walk;
        // The hips are as high as the standing legs let them.
        let reach = if is_walk { 0.985f32 } else { 0.95 };
        let highest = if is_walk { 0.968f32 } else { 0.945 };
        let standing = feet.iter().zip(phases).filter(|(_, p)| *p <= contact).map(|(foot, _)| {
            let [x, _, z] = foot.ankle.to_array();
            z + (reach * reach - x * x).max(0.1).sqrt()
        });
        let hips_up = standing.fold(highest, f32::min);
        let forward = (TAU * phase).cos();
        let aside = (TAU * (phase - 0.25)).cos();
        let (amplitude, chest) = if is_walk { (0.4, 0.08) } else { (0.75, 0.16) };
        let arms = [0, 1].map(|side| {
            // Each arm goes with the other side's leg.
            let a = amplitude * if side == 0 { -forward } else { forward } + 0.06;
            if is_walk {
                let length = 0.975 - 0.05 * a.max(0.0);
                Arm { wrist: vec3(a.sin(), 0.12, -a.cos() * 0.97) * length, ..Arm::HANGING }
            } else {
                // The elbow stays bent; the hand goes from the hip to before the chest.
                let wrist = vec3(0.38 + 0.42 * a, 0.08 - 0.16 * a.max(0.0), -0.52 + 0.32 * a.max(0.0) - 0.04 * a);
                Arm { wrist, elbow: vec3(-1.0, 0.35, -0.6 + 0.3 * a), roll_rad: 0.2, curl: 0.6 }
            }
        });
        let lean = if is_walk { 0.045 } else { 0.16 };
        Stance {
            hips_up,
            hips_shift: [0.0, if is_walk { 0.028 } else { 0.015 } * aside],
            pelvis: vec3(-0.05 * aside, lean * 0.5, -chest * forward),
            spine: vec3(0.05 * aside, lean * 0.5, 2.0 * chest * forward),
            head: vec3(0.0, 0.05 + lean * 0.3, 0.0),
            arms,
            feet,
            knees_out: 0.06,
        }
    }
}

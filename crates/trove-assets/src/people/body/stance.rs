//! What a body does, in measures of its own limbs, and how its joints come to stand so.

use glam::{EulerRot, Mat3, Quat, Vec3, vec3};

use super::skeleton::{Posed, Skeleton};
use crate::people::figure::bent;

/// A hand's place and shape, seen from its shoulder.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arm {
    /// Wrist from the shoulder in the chest's axes, in lengths of the arm: forward, outward, up.
    pub(super) wrist: Vec3,
    /// Where the elbow points, likewise.
    pub(super) elbow: Vec3,
    /// How far the hand is turned about the forearm, thumb towards the body.
    pub(super) roll_rad: f32,
    /// 0 fingers as at rest, 1 a fist.
    pub(super) curl: f32,
}

impl Arm {
    pub(super) const HANGING: Self =
        Self { wrist: vec3(0.06, 0.11, -0.95), elbow: vec3(-1.0, 0.4, -0.2), roll_rad: 0.0, curl: 0.25 };

    pub(super) const fn reaching(wrist: Vec3, elbow: Vec3) -> Self {
        Self { wrist, elbow, ..Self::HANGING }
    }

    pub(super) const fn gripping(self) -> Self {
        Self { curl: 0.75, ..self }
    }
}

/// A foot's place from below the middle of the hips, in lengths of the leg.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    /// Forward, outward, lift of the ankle above where it is when the foot stands flat.
    pub(super) ankle: Vec3,
    /// Toes down.
    pub(super) pitch_rad: f32,
    /// Toes outward.
    pub(super) yaw_rad: f32,
    /// Toes bent up against the foot.
    pub(super) toes_rad: f32,
}

impl Foot {
    pub(super) const fn flat(forward: f32, outward: f32) -> Self {
        Self { ankle: vec3(forward, outward, 0.0), pitch_rad: 0.0, yaw_rad: 0.15, toes_rad: 0.0 }
    }
}

/// A posture; turns are (roll to the right, forward pitch, yaw to the left).
#[derive(Clone, Copy, Debug)]
pub(super) struct Stance {
    /// How high the hip joints are above where the ankles are in flat feet, in lengths of the leg.
    pub(super) hips_up: f32,
    /// The hips' shift forward and to the left, likewise.
    pub(super) hips_shift: [f32; 2],
    pub(super) pelvis: Vec3,
    /// The chest against the pelvis.
    pub(super) spine: Vec3,
    /// The head against the world.
    pub(super) head: Vec3,
    pub(super) arms: [Arm; 2],
    pub(super) feet: [Foot; 2],
    /// How far the knees point outward.
    pub(super) knees_out: f32,
}

impl Stance {
    /// At ease.
    pub(super) const EASY: Self = Self {
        hips_up: 0.985,
        hips_shift: [0.0, 0.0],
        pelvis: Vec3::ZERO,
        spine: vec3(0.0, 0.02, 0.0),
        head: vec3(0.0, 0.03, 0.0),
        arms: [Arm::HANGING; 2],
        feet: [Foot::flat(0.0, 0.12), Foot::flat(-0.02, 0.12)],
        knees_out: 0.12,
    };

    /// The joints so; the soles are about at z = 0, the hips above x = y = 0.
    pub(super) fn pose(&self, skeleton: &Skeleton) -> Posed {
        let turn = |t: Vec3| Quat::from_euler(EulerRot::ZYX, t.z, t.y, t.x);
        let mut posed = skeleton.rest();
        let legs = Legs::of(skeleton);
        let pelvis = skeleton.find("pelvis");
        skeleton.turn(&mut posed, 0, turn(self.pelvis));
        let [left, right] = [0, 1].map(|s| posed.places[skeleton.side("thigh", s)]);
        let [forward, aside] = self.hips_shift;
        let hips = vec3(forward * legs.length_m, aside * legs.length_m, self.hips_up * legs.length_m + legs.ankle_m);
        posed.shift(hips - (left + right) / 2.0);

        let bend = turn(self.spine / 3.0);
        let mut above = posed.turns[pelvis];
        for name in ["spine_01", "spine_02", "spine_03"] {
            above *= bend;
            skeleton.turn(&mut posed, skeleton.find(name), above);
        }
        let head = turn(self.head);
        skeleton.turn(&mut posed, skeleton.find("neck_01"), above.slerp(head, 0.4));
        skeleton.turn(&mut posed, skeleton.find("head"), head);
        for side in 0..2 {
            self.arms[side].pose(skeleton, &mut posed, side, above);
            self.feet[side].pose(skeleton, &mut posed, side, self.knees_out, &legs);
        }
        posed
    }
}

/// What a walker's legs measure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Legs {
    /// Hip to knee to ankle.
    pub(super) length_m: f32,
    /// Height of the ankle in a flat foot.
    pub(super) ankle_m: f32,
    /// Where the heel and the ball of the foot touch the ground, from the ankle.
    pub(super) heel: Vec3,
    pub(super) ball: Vec3,
}

impl Legs {
    pub(super) fn of(skeleton: &Skeleton) -> Self {
        let [hip, knee, ankle, ball] = ["thigh", "calf", "foot", "ball"].map(|name| skeleton.at(name, 0));
        let length_m = hip.distance(knee) + knee.distance(ankle);
        let ankle_m = ankle.z - skeleton.floor_m;
        let forward = ball.x - ankle.x;
        Self { length_m, ankle_m, heel: vec3(-0.38 * forward, 0.0, -ankle_m), ball: vec3(forward, 0.0, -ankle_m) }
    }
}

impl Arm {
    fn pose(&self, skeleton: &Skeleton, posed: &mut Posed, side: usize, chest: Quat) {
        let out = [1.0, -1.0][side];
        let there = |v: Vec3| chest * (v * vec3(1.0, out, 1.0));
        let [clavicle, upper, lower, hand] =
            ["clavicle", "upperarm", "lowerarm", "hand"].map(|n| skeleton.side(n, side));
        let rest = |j: usize| skeleton.joints[j];
        let lengths = [rest(upper).distance(rest(lower)), rest(lower).distance(rest(hand))];
        // The shoulder goes along with an arm that is raised, and sinks below one that hangs.
        let raise = (0.06 + 0.4 * (self.wrist.z + 0.5)).clamp(-0.1, 0.45);
        let swing = 0.25 * (self.wrist.x - 0.3).max(0.0);
        let shoulder_turn = Quat::from_rotation_z(out * swing) * Quat::from_rotation_x(out * raise);
        skeleton.turn(posed, clavicle, chest * shoulder_turn);

        let (shoulder, pole) = (posed.places[upper], there(self.elbow));
        let wanted = shoulder + there(self.wrist) * (lengths[0] + lengths[1]);
        let elbow = bent(shoulder, wanted, lengths[0], lengths[1], pole);
        let wrist = elbow + (wanted - elbow).normalize_or(-Vec3::Z) * lengths[1];
        let rest_pole = {
            let along = (rest(hand) - rest(upper)).normalize_or(-Vec3::Z);
            let aside = rest(lower) - rest(upper);
            aside - along * aside.dot(along)
        };
        let upper_turn = frame(elbow - shoulder, pole) * frame(rest(lower) - rest(upper), rest_pole).inverse();
        skeleton.turn(posed, upper, upper_turn);
        let lower_turn = frame(wrist - elbow, pole) * frame(rest(hand) - rest(lower), rest_pole).inverse();
        let along = (wrist - elbow).normalize_or(-Vec3::Z);
        let roll = |share: f32| Quat::from_axis_angle(along, out * self.roll_rad * share);
        skeleton.turn(posed, lower, roll(0.4) * lower_turn);
        skeleton.turn(posed, hand, roll(1.0) * lower_turn);

        // Fingers bend about the line of the knuckles, towards the palm, which faces down at rest.
        let knuckles = (skeleton.at("index_01", side) - skeleton.at("pinky_01", side)).normalize_or(Vec3::X);
        let pointing = skeleton.at("middle_01", side) - rest(hand);
        let sign = if knuckles.cross(pointing).z < 0.0 { 1.0 } else { -1.0 };
        for finger in ["index", "middle", "ring", "pinky", "thumb"] {
            let share = if finger == "thumb" { 0.35 } else { 1.0 };
            for (knuckle, angle) in [("01", 1.1), ("02", 1.5), ("03", 0.9)] {
                let joint = skeleton.side(&format!("{finger}_{knuckle}"), side);
                let by = Quat::from_axis_angle(posed.turns[joint] * knuckles, sign * angle * share * self.curl);
                skeleton.turn(posed, joint, by * posed.turns[joint]);
            }
        }
    }
}

impl Foot {
    fn pose(&self, skeleton: &Skeleton, posed: &mut Posed, side: usize, knees_out: f32, legs: &Legs) {
        let out = [1.0, -1.0][side];
        let [thigh, calf, foot, ball] = ["thigh", "calf", "foot", "ball"].map(|n| skeleton.side(n, side));
        let rest = |j: usize| skeleton.joints[j];
        let lengths = [rest(thigh).distance(rest(calf)), rest(calf).distance(rest(foot))];
        let hip = posed.places[thigh];
        let wanted = self.ankle * vec3(1.0, out, 1.0) * legs.length_m + Vec3::Z * legs.ankle_m;
        let pole = posed.turns[0] * vec3(1.0, out * knees_out, 0.35);
        let knee = bent(hip, wanted, lengths[0], lengths[1], pole);
        let ankle = knee + (wanted - knee).normalize_or(-Vec3::Z) * lengths[1];
        skeleton.turn(posed, thigh, frame(knee - hip, pole) * frame(rest(calf) - rest(thigh), Vec3::X).inverse());
        skeleton.turn(posed, calf, frame(ankle - knee, pole) * frame(rest(foot) - rest(calf), Vec3::X).inverse());
        let sole = Quat::from_rotation_z(out * self.yaw_rad) * Quat::from_rotation_y(self.pitch_rad);
        skeleton.turn(posed, foot, sole);
        skeleton.turn(posed, ball, sole * Quat::from_rotation_y(-self.toes_rad));
    }
}

/// Axes whose first is `along` and whose second leans towards `pole`.
fn frame(along: Vec3, pole: Vec3) -> Quat {
    let x = along.normalize_or(Vec3::X);
    let y = (pole - x * pole.dot(x)).try_normalize().unwrap_or_else(|| x.any_orthonormal_vector());
    Quat::from_mat3(&Mat3::from_cols(x, y, x.cross(y)))
}

//! A clothed human body in any pose: every garment and the skin under it is one blended surface.

use glam::{Quat, Vec3, vec3};
use trove_model::Keypoints;

use super::wardrobe::{Hair, Leg, Outfit, Sleeve, Wardrobe};
use crate::shape::{Blend, Limb, Shape};

/// Edge of the cells that clothes, and heads and hands, are made of.
const CLOTH_CELL_M: f32 = 0.043;
const SKIN_CELL_M: f32 = 0.0235;

/// Measures of a body; what they are shares of is its height.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Physique {
    pub(crate) height_m: f32,
    /// Distance of a shoulder joint from the middle.
    pub(crate) shoulder: f32,
    /// Distance of a hip joint from the middle.
    pub(crate) hip: f32,
    /// Thickness of trunk and limbs; 1 is slim.
    pub(crate) girth: f32,
    /// Height of the head as a share of an adult's.
    pub(crate) head: f32,
    pub(crate) bust: bool,
}

impl Physique {
    /// A grown man.
    pub(crate) const MAN: Self =
        Self { height_m: 1.77, shoulder: 0.1, hip: 0.05, girth: 1.08, head: 1.05, bust: false };
    /// A grown woman.
    pub(crate) const WOMAN: Self =
        Self { height_m: 1.65, shoulder: 0.089, hip: 0.054, girth: 0.98, head: 1.02, bust: true };
    /// A child of about eight.
    pub(crate) const CHILD: Self =
        Self { height_m: 1.3, shoulder: 0.095, hip: 0.05, girth: 1.0, head: 0.96, bust: false };
}

/// Where the joints that matter are, metres; index 0 is left. The body faces +x.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose {
    /// Middle between the hip joints.
    pub(crate) hips: Vec3,
    /// How far the trunk leans forward.
    pub(crate) lean_rad: f32,
    pub(crate) ankles: [Vec3; 2],
    /// How far the toes point down.
    pub(crate) toes_rad: [f32; 2],
    pub(crate) wrists: [Vec3; 2],
}

const SIDES: [f32; 2] = [1.0, -1.0];

impl Pose {
    /// At ease, arms hanging.
    pub(crate) fn standing(body: &Physique) -> Self {
        let h = body.height_m;
        let foot = |side: f32, x: f32| vec3(x * h, side * 0.058 * h, 0.045 * h);
        let hand = |side: f32, x: f32| vec3(x * h, side * (body.shoulder + 0.045) * h, 0.495 * h);
        Self {
            hips: vec3(0.0, 0.0, 0.523 * h),
            lean_rad: 0.02,
            ankles: [foot(1.0, 0.012), foot(-1.0, -0.02)],
            toes_rad: [0.0; 2],
            wrists: [hand(1.0, 0.02), hand(-1.0, 0.035)],
        }
    }

    /// In the middle of a step as long as a share of the height, the left or the right foot in front.
    pub(crate) fn walking(body: &Physique, step: f32, left_in_front: bool) -> Self {
        let h = body.height_m;
        let front = usize::from(!left_in_front);
        let (reach, mut pose) = (step * h / 2.0, Self::standing(body));
        pose.hips.z = 0.505 * h;
        pose.lean_rad = 0.06;
        for (i, side) in SIDES.into_iter().enumerate() {
            let forward = if i == front { 1.0 } else { -1.0 };
            let lift = if i == front { 0.012 } else { 0.04 };
            pose.ankles[i] = vec3(forward * reach, side * 0.04 * h, (0.045 + lift) * h);
            pose.toes_rad[i] = if i == front { -0.3 } else { 0.55 };
            let swing = if i == front { vec3(-0.12, 0.0, 0.505) } else { vec3(0.16, 0.0, 0.525) };
            pose.wrists[i] = swing * h + Vec3::Y * side * (body.shoulder + 0.035) * h;
        }
        pose
    }
}

/// A body in a pose, with its joints.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Figure {
    body: Physique,
    pose: Pose,
    trunk: Quat,
    hips: [Vec3; 2],
    knees: [Vec3; 2],
    shoulders: [Vec3; 2],
    elbows: [Vec3; 2],
    pub(crate) neck: Vec3,
    pub(crate) head: Vec3,
}

impl Figure {
    pub(crate) fn new(body: Physique, pose: Pose) -> Self {
        let h = body.height_m;
        let trunk = Quat::from_rotation_y(pose.lean_rad);
        // The shoulders turn a little against the hips, as in walking.
        let stride = (pose.ankles[0].x - pose.ankles[1].x) / h;
        let twist = Quat::from_rotation_z((stride * 0.35).clamp(-0.15, 0.15));
        let up = |x: f32, y: f32, z: f32| pose.hips + trunk * twist * (vec3(x, y, z) * h);
        let hips = SIDES.map(|s| pose.hips + vec3(0.0, s * body.hip * h, 0.0));
        let shoulders = SIDES.map(|s| up(-0.008, s * body.shoulder, 0.283));
        let knees = [0, 1].map(|i| {
            let pole = vec3(1.0, SIDES[i] * 0.12, 0.15);
            bent(hips[i], pose.ankles[i], 0.248 * h, 0.238 * h, pole)
        });
        let elbows = [0, 1].map(|i| {
            let pole = vec3(-1.0, SIDES[i] * 0.5, -0.5);
            bent(shoulders[i], pose.wrists[i], 0.168 * h, 0.148 * h, pole)
        });
        let neck = up(0.0, 0.0, 0.317);
        let head = neck + Quat::from_rotation_y(pose.lean_rad * 0.35) * (vec3(0.014, 0.0, 0.1) * h);
        Self { body, pose, trunk, hips, knees, shoulders, elbows, neck, head }
    }

    /// Everything, with its slots.
    pub(crate) fn dressed(&self, outfit: &Outfit, slots: &Wardrobe) -> Shape {
        let mut parts = vec![
            self.skin(outfit).slot(slots.skin),
            self.face().slot(slots.dark),
            self.hair(outfit.hair).slot(slots.hair),
            self.top(outfit).slot(slots.top),
            self.bottom(outfit).slot(slots.bottom),
            self.shoes().slot(slots.shoes),
        ];
        if outfit.leg == Leg::Skirt {
            parts.push(self.legs(0.0, 0.62, 0.9).slot(slots.skin));
        }
        Shape::join(parts)
    }

    /// Points of face and joints.
    pub(crate) fn keypoints(&self) -> Keypoints<Vec3> {
        let face = |x: f32, y: f32, z: f32| self.at_head(x, y, z);
        let [eyes, ears] =
            [(0.09, 0.031, 0.016), (-0.005, 0.087, 0.002)].map(|(x, y, z)| SIDES.map(|s| face(x, s * y, z)));
        let pairs =
            [eyes, ears, self.shoulders, self.elbows, self.pose.wrists, self.hips, self.knees, self.pose.ankles];
        let nose = face(0.108, 0.0, -0.022);
        std::array::from_fn(|i| if i == 0 { nose } else { pairs.as_flattened()[i - 1] })
    }

    fn m(&self, share: f32) -> f32 {
        share * self.body.height_m
    }

    fn radius(&self, share: f32) -> f32 {
        share * self.body.height_m * self.body.girth
    }

    /// A point relative to the trunk: shares of the height forward, left and up from the hips.
    pub(crate) fn at_trunk(&self, x: f32, y: f32, z: f32) -> Vec3 {
        self.pose.hips + self.trunk * (vec3(x, y, z) * self.body.height_m)
    }

    /// Turns what is modelled upright to how the trunk leans.
    pub(crate) fn trunk(&self) -> Quat {
        self.trunk
    }

    fn head_scale(&self) -> f32 {
        self.body.head
    }

    fn head_turn(&self) -> Quat {
        Quat::from_rotation_y(self.pose.lean_rad * 0.25)
    }

    fn at_head(&self, x: f32, y: f32, z: f32) -> Vec3 {
        self.head + self.head_turn() * (vec3(x, y, z) * self.head_scale())
    }

    /// Head, neck, hands, and the arms and legs that clothes leave bare.
    fn skin(&self, outfit: &Outfit) -> Shape {
        let k = self.head_scale();
        let at = |x: f32, y: f32, z: f32| self.at_head(x, y, z);
        let mut head = vec![
            Limb::new(at(-0.012, 0.0, 0.03), at(0.005, 0.0, 0.028), 0.08 * k, 0.078 * k).wide(Vec3::X, 1.17),
            Limb::new(at(0.02, 0.0, -0.01), at(0.042, 0.0, -0.075), 0.068 * k, 0.04 * k),
            Limb::new(at(0.084, 0.0, 0.005), at(0.096, 0.0, -0.022), 0.007 * k, 0.012 * k),
            Limb::new(self.neck - vec3(0.0, 0.0, 0.03), at(-0.012, 0.0, -0.03), self.radius(0.03), self.radius(0.028)),
        ];
        for side in SIDES {
            head.push(Limb::new(
                at(-0.005, side * 0.079, 0.022),
                at(-0.004, side * 0.077, -0.018),
                0.01 * k,
                0.007 * k,
            ));
        }
        let mut parts = vec![Blend::new(head, 0.022).surface(SKIN_CELL_M)];
        for (i, side) in SIDES.into_iter().enumerate() {
            let (wrist, elbow) = (self.pose.wrists[i], self.elbows[i]);
            let along = (wrist - elbow).normalize_or(-Vec3::Z);
            let palm = wrist + along * self.m(0.045);
            let tips = palm + (along + vec3(0.15, -side * 0.25, 0.0)).normalize() * self.m(0.04);
            let thumb = palm + (along + vec3(0.9, -side * 0.2, 0.0)).normalize() * self.m(0.026);
            let from = match outfit.sleeve {
                Sleeve::Long => wrist - along * self.m(0.03),
                Sleeve::Short | Sleeve::None => elbow,
            };
            let mut arm = vec![
                Limb::new(
                    from,
                    wrist,
                    self.radius(if outfit.sleeve == Sleeve::Long { 0.0155 } else { 0.025 }),
                    self.radius(0.0155),
                ),
                Limb::new(wrist, palm, self.radius(0.014), self.radius(0.019)).wide(Vec3::X, 1.3),
                Limb::new(palm, tips, self.radius(0.017), self.radius(0.011)).wide(Vec3::X, 1.3),
                Limb::new(palm, thumb, self.radius(0.009), self.radius(0.007)),
            ];
            if outfit.sleeve != Sleeve::Long {
                let start =
                    if outfit.sleeve == Sleeve::None { self.shoulders[i] } else { self.shoulders[i].lerp(elbow, 0.4) };
                arm.push(Limb::new(start, elbow, self.radius(0.027), self.radius(0.025)));
            }
            parts.push(
                Blend::new(arm, 0.015).surface(SKIN_CELL_M * if outfit.sleeve == Sleeve::Long { 0.95 } else { 1.1 }),
            );
        }
        if outfit.leg == Leg::Shorts {
            parts.push(self.legs(0.0, 0.35, 0.9));
        }
        Shape::join(parts)
    }

    /// Bare legs from a share of the thigh (`from`) to the ankles; `slim` as a share of the trousers' width.
    fn legs(&self, knee: f32, from: f32, slim: f32) -> Shape {
        let legs = (0..2).map(|i| {
            let start = self.hips[i].lerp(self.knees[i], from);
            let calf = self.knees[i].lerp(self.pose.ankles[i], 0.3) - vec3(self.m(0.008), 0.0, 0.0);
            let limbs = vec![
                Limb::new(start, self.knees[i], self.radius(0.042 * slim), self.radius(0.033 * slim + knee)),
                Limb::new(self.knees[i], calf, self.radius(0.031 * slim), self.radius(0.034 * slim)),
                Limb::new(calf, self.pose.ankles[i], self.radius(0.034 * slim), self.radius(0.022 * slim)),
            ];
            Blend::new(limbs, 0.03).surface(CLOTH_CELL_M)
        });
        Shape::join(legs)
    }

    /// Eyes and mouth.
    fn face(&self) -> Shape {
        let k = self.head_scale();
        let eye = |side: f32| {
            Shape::ellipsoid(vec3(0.006, 0.012, 0.006) * k, 8).moved(self.at_head(0.086, side * 0.031, 0.016))
        };
        let mouth = Shape::ellipsoid(vec3(0.005, 0.02, 0.004) * k, 8).moved(self.at_head(0.082, 0.0, -0.052));
        Shape::join([eye(1.0), eye(-1.0), mouth])
    }

    fn hair(&self, hair: Hair) -> Shape {
        let k = self.head_scale();
        let at = |x: f32, y: f32, z: f32| self.at_head(x, y, z);
        let mut limbs = vec![
            Limb::new(at(-0.028, 0.0, 0.045), at(0.012, 0.0, 0.055), 0.081 * k, 0.07 * k).wide(Vec3::X, 1.1),
            Limb::new(at(-0.04, 0.0, 0.02), at(-0.05, 0.0, -0.02), 0.072 * k, 0.05 * k),
        ];
        match hair {
            Hair::Short => {}
            Hair::Long => {
                limbs.push(
                    Limb::new(at(-0.05, 0.0, 0.0), at(-0.075, 0.0, -0.19), 0.07 * k, 0.045 * k).wide(Vec3::Y, 1.25),
                );
                for side in SIDES {
                    limbs.push(Limb::new(
                        at(-0.01, side * 0.07, 0.02),
                        at(-0.03, side * 0.075, -0.11),
                        0.022 * k,
                        0.025 * k,
                    ));
                }
            }
            Hair::Bun => {
                limbs.push(Limb::new(at(-0.115, 0.0, 0.05), at(-0.12, 0.0, 0.045), 0.036 * k, 0.036 * k));
            }
            Hair::Tail => {
                limbs.push(Limb::new(at(-0.1, 0.0, 0.04), at(-0.14, 0.0, -0.03), 0.022 * k, 0.028 * k));
                limbs.push(Limb::new(at(-0.14, 0.0, -0.03), at(-0.13, 0.0, -0.14), 0.028 * k, 0.012 * k));
            }
        }
        Blend::new(limbs, 0.03).surface(SKIN_CELL_M * 1.2)
    }

    fn top(&self, outfit: &Outfit) -> Shape {
        let loose = outfit.loose_m;
        let r = |share: f32| self.radius(share) + loose;
        let at = |x: f32, y: f32, z: f32| self.at_trunk(x, y, z);
        let wide = self.trunk * Vec3::Y;
        let hem = if outfit.leg == Leg::Skirt { 0.02 } else { -0.01 - outfit.hem };
        let shoulder = self.body.shoulder;
        let hip = if self.body.bust { 1.62 } else { 1.5 };
        let mut limbs = vec![
            Limb::new(at(0.0, 0.0, 0.11), at(-0.008, 0.0, hem), r(0.058), r(0.066)).wide(wide, hip).blunt(),
            Limb::new(at(0.0, 0.0, 0.1), at(0.004, 0.0, 0.22), r(0.056), r(0.064)).wide(wide, 1.48),
            Limb::new(at(-0.006, 0.0, 0.22), at(-0.01, 0.0, 0.265), r(0.061), r(0.038)).wide(wide, 1.6),
            Limb::new(
                at(-0.006, 0.0, 0.265),
                self.neck - Vec3::Z * self.m(0.004),
                r(0.042),
                self.radius(0.031) + 0.004,
            ),
        ];
        if outfit.leg != Leg::Skirt {
            // The hem falls over the thighs.
            for i in 0..2 {
                let (hip, knee) = (self.hips[i] - vec3(self.m(0.012), 0.0, 0.0), self.knees[i]);
                limbs.push(Limb::new(hip, hip.lerp(knee, 0.12 + outfit.hem * 2.5), r(0.057), r(0.055)).blunt());
            }
        }
        if self.body.bust {
            for side in SIDES {
                limbs.push(Limb::new(at(0.035, side * 0.04, 0.215), at(0.045, side * 0.038, 0.2), r(0.032), r(0.03)));
            }
        }
        for (i, side) in SIDES.into_iter().enumerate() {
            let (shoulder_m, elbow, wrist) = (self.shoulders[i], self.elbows[i], self.pose.wrists[i]);
            limbs.push(Limb::new(at(-0.006, side * shoulder * 0.5, 0.272), shoulder_m, r(0.032), r(0.0275)));
            limbs.push(Limb::new(at(-0.01, side * 0.026, 0.308), shoulder_m, r(0.021), r(0.023)));
            match outfit.sleeve {
                Sleeve::None => {}
                Sleeve::Short => {
                    limbs.push(Limb::new(shoulder_m, shoulder_m.lerp(elbow, 0.68), r(0.0285), r(0.032)).blunt());
                }
                Sleeve::Long => {
                    limbs.push(Limb::new(shoulder_m, elbow, r(0.0285), r(0.026)));
                    limbs.push(Limb::new(elbow, wrist, r(0.026), r(0.0195)).blunt());
                }
            }
        }
        Blend::new(limbs, 0.035).surface(CLOTH_CELL_M * 0.95)
    }

    fn bottom(&self, outfit: &Outfit) -> Shape {
        let at = |x: f32, y: f32, z: f32| self.at_trunk(x, y, z);
        let r = |share: f32| self.radius(share) + outfit.loose_m * 0.6;
        let hip = if self.body.bust { 1.62 } else { 1.5 };
        let mut limbs =
            vec![Limb::new(at(-0.006, 0.0, 0.06), at(-0.012, 0.0, 0.0), r(0.056), r(0.06)).wide(Vec3::Y, hip)];
        if outfit.leg == Leg::Skirt {
            let knees = (self.knees[0] + self.knees[1]) / 2.0;
            let hem = at(0.0, 0.0, 0.0).lerp(knees, 1.02);
            let spread = (self.knees[0] - self.knees[1]).length() / 2.0;
            limbs.push(
                Limb::new(at(-0.01, 0.0, 0.02), hem, r(0.058), r(0.06) + spread * 0.5).wide(Vec3::Y, 1.4).blunt(),
            );
            return Blend::new(limbs, 0.05).surface(CLOTH_CELL_M);
        }
        for i in 0..2 {
            let (hip, knee, ankle) = (self.hips[i], self.knees[i], self.pose.ankles[i]);
            let seat = hip - vec3(self.m(0.022), 0.0, self.m(0.005));
            limbs.push(Limb::new(seat, hip.lerp(knee, 0.3), r(0.05), r(0.046)));
            if outfit.leg == Leg::Shorts {
                limbs.push(Limb::new(hip, hip.lerp(knee, 0.85), r(0.052), r(0.046)).blunt());
                continue;
            }
            limbs.push(Limb::new(hip, knee, r(0.052), r(0.035)));
            let calf = knee.lerp(ankle, 0.35) - vec3(self.m(0.006), 0.0, 0.0);
            limbs.push(Limb::new(knee, calf, r(0.034), r(0.036)));
            let cuff = ankle - (ankle - knee).normalize_or(Vec3::Z) * self.m(0.006);
            limbs.push(Limb::new(calf, cuff, r(0.036), r(0.028)).blunt());
        }
        Blend::new(limbs, 0.03).surface(CLOTH_CELL_M)
    }

    fn shoes(&self) -> Shape {
        let shoes = (0..2).map(|i| {
            let (m, out) = (|s: f32| self.m(s), SIDES[i] * 0.12);
            let limbs = vec![
                Limb::new(vec3(m(-0.018), 0.0, m(-0.022)), vec3(m(0.05), 0.0, m(-0.026)), m(0.024), m(0.022)),
                Limb::new(vec3(m(0.05), 0.0, m(-0.026)), vec3(m(0.1), 0.0, m(-0.031)), m(0.025), m(0.016))
                    .wide(Vec3::Y, 1.15),
                Limb::new(vec3(0.0, 0.0, m(0.012)), vec3(m(0.02), 0.0, m(-0.02)), m(0.023), m(0.024)),
            ];
            let mut shoe = Blend::new(limbs, 0.02);
            shoe.floor_m = m(-0.044);
            let turn = Quat::from_rotation_z(out) * Quat::from_rotation_y(self.pose.toes_rad[i]);
            shoe.surface(0.03).turned(turn).moved(self.pose.ankles[i])
        });
        Shape::join(shoes)
    }
}

/// The middle joint of a limb of two bones, bent towards `pole`.
pub(super) fn bent(from: Vec3, to: Vec3, upper_m: f32, lower_m: f32, pole: Vec3) -> Vec3 {
    let reach = to - from;
    let length = reach.length().clamp((upper_m - lower_m).abs() + 1e-3, (upper_m + lower_m) * 0.999);
    let along = reach.normalize_or(-Vec3::Z);
    let side = (pole - along * pole.dot(along)).normalize_or(Vec3::X);
    let share = (upper_m * upper_m - lower_m * lower_m + length * length) / (2.0 * length);
    from + along * share + side * (upper_m * upper_m - share * share).max(0.0).sqrt()
}

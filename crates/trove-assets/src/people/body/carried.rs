//! What people have on and with them that is not cloth. Places are those of the body's own shape, in metres.

use std::f32::consts::TAU;

use glam::{Quat, Vec3, vec2, vec3};

use super::skeleton::Posed;
use super::wearer::{Piece, Wearer};
use crate::shape::Shape;

/// What hangs plumb from a hand, or stands upright in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Held {
    Shopping,
    Briefcase,
    Umbrella,
    Box,
}

impl Wearer<'_> {
    /// Where the clothed back is, metres at rest: its middle between the shoulder blades.
    fn back(&self) -> Vec3 {
        let tights = self.body.groups.get("helper-tights").into_iter().flatten().flatten();
        let near = tights.filter(|&&v| {
            let p = self.body.positions[v as usize];
            p.y.abs() < 0.07 && (0.3..0.48).contains(&p.z)
        });
        let lowest = near.map(|&v| self.positions[v as usize].x).fold(f32::INFINITY, f32::min);
        let spine = (self.skeleton.joints[self.skeleton.find("spine_03")]
            + self.skeleton.joints[self.skeleton.find("neck_01")])
            / 2.0;
        vec3(lowest, 0.0, spine.z)
    }

    pub(super) fn backpack(&self, worn: &[&Piece], slot: u16, strap: u16) -> Vec<Piece> {
        let s = 0.5 + 0.5 * self.scale;
        let (joint, back) = (self.skeleton.find("spine_03"), self.back());
        let sack = Shape::rounded_block(vec3(0.15, 0.29, 0.44) * s, 0.065 * s)
            .bent(|p| p * vec3(1.0 - 0.5 * (p.z / s), 1.0 - 0.35 * p.z / s, 1.0))
            .moved(back + vec3(-0.085, 0.0, -0.08) * s);
        let pocket =
            Shape::rounded_block(vec3(0.06, 0.22, 0.2) * s, 0.028 * s).moved(back + vec3(-0.185, 0.0, -0.17) * s);
        let strap = |side: f32| {
            let path = [
                (-0.05, 0.085, 0.5),
                (-0.01, 0.1, 0.57),
                (0.06, 0.102, 0.55),
                (0.11, 0.1, 0.47),
                (0.11, 0.115, 0.38),
                (0.05, 0.135, 0.31),
                (-0.03, 0.11, 0.27),
            ];
            let path = path.map(|(x, y, z)| vec3(x, y * side, z));
            self.strap(&path, worn, 0.045 * s, strap)
        };
        vec![Piece::stiff(sack, joint, slot), Piece::stiff(pocket, joint, slot), strap(1.0), strap(-1.0)]
    }

    /// A bag at the right hip on a strap across the body.
    pub(super) fn satchel(&self, worn: &[&Piece], slot: u16) -> Vec<Piece> {
        let hip = self.skeleton.at("thigh", 1);
        let joint = self.skeleton.find("pelvis");
        let aside = self.skeleton.at("thigh", 1).y - 0.115 * self.scale;
        let bag = Shape::rounded_block(vec3(0.24, 0.075, 0.19), 0.03).moved(vec3(hip.x - 0.01, aside, hip.z + 0.0));
        let flap =
            Shape::rounded_block(vec3(0.245, 0.02, 0.12), 0.009).moved(vec3(hip.x - 0.01, aside - 0.038, hip.z + 0.04));
        let ring = [
            (0.03, -0.165, 0.12),
            (0.12, -0.09, 0.2),
            (0.15, -0.01, 0.33),
            (0.12, 0.06, 0.46),
            (0.05, 0.085, 0.56),
            (-0.02, 0.08, 0.57),
            (-0.05, 0.03, 0.45),
            (-0.03, -0.05, 0.3),
            (-0.04, -0.12, 0.2),
            (-0.02, -0.165, 0.12),
        ];
        let strap = self.strap(&ring.map(|(x, y, z)| vec3(x, y, z)), worn, 0.028, slot);
        vec![Piece::stiff(bag, joint, slot), Piece::stiff(flap, joint, slot), strap]
    }

    /// A flat phone in the right hand.
    pub(super) fn phone(&self, slot: u16) -> Piece {
        let [hand, middle, thumb] = ["hand", "middle_01", "thumb_02"].map(|n| self.skeleton.at(n, 1));
        let along = (middle - hand).normalize_or(Vec3::X);
        let across = (thumb - hand - along * (thumb - hand).dot(along)).normalize_or(Vec3::Y);
        let palm = along.cross(across);
        let palm = if palm.z < 0.0 { palm } else { -palm };
        let turn = Quat::from_mat3(&glam::Mat3::from_cols(across.cross(palm), across, palm));
        let turn = if turn.is_finite() { turn } else { Quat::IDENTITY };
        let block = Shape::rounded_block(vec3(0.145, 0.07, 0.009), 0.004).turned(turn);
        Piece::stiff(block.moved(middle + palm * 0.032 + along * 0.02), self.skeleton.side("hand", 1), slot)
    }

    /// A baseball cap: its crown, and its visor.
    pub(super) fn cap(&self, slot: u16) -> Piece {
        let crown = [
            vec2(0.101, -0.005),
            vec2(0.103, 0.02),
            vec2(0.094, 0.055),
            vec2(0.07, 0.079),
            vec2(0.035, 0.091),
            vec2(0.0, 0.094),
        ];
        let crown = Shape::lathe(&crown, 18).scaled(vec3(1.12, 0.9, 1.0));
        let rows: Vec<Vec<Vec3>> = [0.0f32, 0.5, 1.0]
            .iter()
            .map(|t| {
                let angles = (0..=10).map(|k| -1.15 + 2.3 * k as f32 / 10.0);
                let reach = |a: f32| (0.112 + 0.072 * t * (a * 1.35).cos().max(0.0), 0.09);
                angles
                    .map(|a| vec3(reach(a).0 * a.cos(), reach(a).1 * a.sin(), 0.008 - 0.014 * t - 0.02 * (a * a) * t))
                    .collect()
            })
            .collect();
        let visor = Shape::sheet(&rows).inside_out().plate(0.003);
        self.on_head(crown.and(visor), vec3(0.058, 0.0, 0.768), 0.1, slot)
    }

    /// A knitted hat over the ears' tips, with its brim turned up.
    pub(super) fn beanie(&self, slot: u16) -> Piece {
        let turned = [
            vec2(0.1, -0.014),
            vec2(0.106, -0.01),
            vec2(0.107, 0.018),
            vec2(0.101, 0.024),
            vec2(0.097, 0.052),
            vec2(0.082, 0.083),
            vec2(0.049, 0.105),
            vec2(0.0, 0.113),
        ];
        let hat = Shape::lathe(&turned, 20).scaled(vec3(1.14, 0.94, 1.0));
        self.on_head(hat, vec3(0.056, 0.0, 0.765), -0.12, slot)
    }

    pub(super) fn police_cap(&self, slot: u16, badge: u16) -> Vec<Piece> {
        let band = [
            vec2(0.104, 0.0),
            vec2(0.106, 0.04),
            vec2(0.142, 0.07),
            vec2(0.132, 0.086),
            vec2(0.06, 0.094),
            vec2(0.0, 0.094),
        ];
        let visor = Shape::ellipsoid(vec3(0.09, 0.085, 0.01), 14).moved(vec3(0.075, 0.0, 0.0));
        let cap = Shape::lathe(&band, 20).scaled(vec3(1.1, 0.92, 1.0)).and(visor);
        let shield = Shape::rounded_block(vec3(0.012, 0.034, 0.036), 0.005).moved(vec3(0.128, 0.0, 0.038));
        let at = vec3(0.058, 0.0, 0.785);
        vec![self.on_head(cap, at, 0.06, slot), self.on_head(shield, at, 0.06, badge)]
    }

    /// A hard hat with its rim and ridge.
    pub(super) fn helmet(&self, slot: u16) -> Piece {
        let shell = [
            vec2(0.135, -0.002),
            vec2(0.137, 0.006),
            vec2(0.123, 0.014),
            vec2(0.12, 0.05),
            vec2(0.102, 0.092),
            vec2(0.062, 0.12),
            vec2(0.0, 0.13),
        ];
        let shell = Shape::lathe(&shell, 22).scaled(vec3(1.08, 0.9, 1.0));
        let under =
            Shape::lathe(&[vec2(0.0, 0.004), vec2(0.135, -0.002)], 22).scaled(vec3(1.08, 0.9, 1.0)).inside_out();
        let peak = Shape::ellipsoid(vec3(0.07, 0.085, 0.008), 14).moved(vec3(0.115, 0.0, 0.0));
        let ridge = Shape::ellipsoid(vec3(0.105, 0.02, 0.05), 12).moved(Vec3::Z * 0.089);
        self.on_head(Shape::join([shell, under, peak, ridge]), vec3(0.056, 0.0, 0.77), 0.06, slot)
    }

    /// A form at a place of the body's own head, tilted back.
    fn on_head(&self, shape: Shape, at: Vec3, tilt_rad: f32, slot: u16) -> Piece {
        let fit = self.head_fit();
        let mut shape = shape.turned(Quat::from_rotation_y(-tilt_rad)).moved(at);
        shape.positions.iter_mut().for_each(|p| *p = fit(*p));
        Piece::stiff(shape, self.skeleton.find("head"), slot)
    }

    /// What a hand holds in a posture: slots are for the thing, its metal, its dark parts.
    pub(super) fn held(&self, held: Held, posed: &Posed, slots: [u16; 3]) -> Vec<(Shape, u16)> {
        let [thing, metal, dark] = slots;
        let knuckles = |side| {
            let [hand, middle] = ["hand", "middle_01"].map(|n| posed.places[self.skeleton.side(n, side)]);
            hand.lerp(middle, 0.95)
        };
        let grip = knuckles(1);
        match held {
            Held::Shopping => {
                let sack = Shape::rounded_block(vec3(0.32, 0.12, 0.34), 0.03)
                    .bent(|p| p * vec3(1.0, 1.0 + 0.5 * (0.17 - p.z), 1.0))
                    .moved(grip - Vec3::Z * 0.36);
                let handles = [-0.04, 0.04].map(|y| {
                    Shape::tube(
                        &[
                            grip + vec3(-0.09, y, -0.2),
                            grip + vec3(-0.02, 0.0, -0.02),
                            grip + vec3(0.02, 0.0, -0.02),
                            grip + vec3(0.09, y, -0.2),
                        ],
                        0.005,
                        5,
                    )
                });
                vec![(sack.and(Shape::join(handles)), thing)]
            }
            Held::Briefcase => {
                let case = Shape::rounded_block(vec3(0.4, 0.1, 0.29), 0.02).moved(grip - Vec3::Z * 0.2);
                let handle = Shape::tube(
                    &[
                        grip + vec3(-0.07, 0.0, -0.06),
                        grip + vec3(-0.05, 0.0, -0.02),
                        grip + vec3(0.05, 0.0, -0.02),
                        grip + vec3(0.07, 0.0, -0.06),
                    ],
                    0.009,
                    6,
                );
                vec![(case.and(handle), dark)]
            }
            Held::Umbrella => {
                let top = grip + Vec3::Z * 0.68;
                let rings: Vec<Vec<Vec3>> = (0..=5)
                    .map(|i| {
                        let a = 1.12 * i as f32 / 5.0;
                        (0..=16)
                            .map(|k| {
                                // Cloth hangs in between eight ribs.
                                let t = TAU * k as f32 / 16.0;
                                let sag = if k % 2 == 1 { 0.95 } else { 1.0 };
                                let r = 0.56 * a.sin() * sag;
                                top + vec3(r * t.cos(), r * t.sin(), 0.5 * (a.cos() - 1.0))
                            })
                            .collect()
                    })
                    .collect();
                let shaft = Shape::tube(&[grip - Vec3::Z * 0.1, top + Vec3::Z * 0.04], 0.006, 6);
                vec![(Shape::sheet(&rings).inside_out().plate(0.003), thing), (shaft, metal)]
            }
            Held::Box => {
                let middle = (knuckles(0) + grip) / 2.0;
                let size = vec3(0.28, (knuckles(0).y - grip.y).abs().max(0.2), 0.24);
                vec![(Shape::rounded_block(size, 0.006).moved(middle + vec3(0.03, 0.0, 0.04)), thing)]
            }
        }
    }
}

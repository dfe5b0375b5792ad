//! Bicycles.

use std::f32::consts::PI;

use glam::{Quat, Vec3, vec2, vec3};

use super::parts::{Parts, on_circle};
use crate::people::Pose;
use crate::shape::{Blend, Limb, Shape};

/// How the frame is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Frame {
    /// Two triangles.
    Diamond,
    /// A low, curved tube to step over.
    Low,
}

/// How the bars are bent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bars {
    Flat,
    /// Down and back, for racing.
    Drop,
    /// Swept back to the rider.
    Swept,
}

/// Measures of a bicycle; x = 0 is the rear axle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BicyclePlan {
    pub(crate) wheel_m: f32,
    pub(crate) front_wheel_m: f32,
    pub(crate) tyre_m: f32,
    pub(crate) wheelbase_m: f32,
    pub(crate) saddle_m: f32,
    /// Height of the grips above the saddle.
    pub(crate) rise_m: f32,
    pub(crate) frame: Frame,
    pub(crate) bars: Bars,
    pub(crate) mudguards: bool,
    pub(crate) basket: bool,
    pub(crate) rack: bool,
    pub(crate) battery: bool,
    /// A fork and a rear triangle with springs, discs for brakes.
    pub(crate) mountain: bool,
    /// A box between the rider and the front wheel.
    pub(crate) cargo: bool,
}

impl BicyclePlan {
    pub(crate) const CITY: Self = Self {
        wheel_m: 0.345,
        front_wheel_m: 0.345,
        tyre_m: 0.02,
        wheelbase_m: 1.08,
        saddle_m: 0.93,
        rise_m: 0.17,
        frame: Frame::Low,
        bars: Bars::Swept,
        mudguards: true,
        basket: true,
        rack: true,
        battery: false,
        mountain: false,
        cargo: false,
    };
    pub(crate) const ROADSTER: Self = Self { frame: Frame::Diamond, basket: false, rise_m: 0.12, ..Self::CITY };
    pub(crate) const TREKKING: Self =
        Self { frame: Frame::Diamond, bars: Bars::Flat, basket: false, saddle_m: 0.97, rise_m: 0.06, ..Self::CITY };
    pub(crate) const ELECTRIC: Self =
        Self { battery: true, basket: false, tyre_m: 0.026, bars: Bars::Flat, rise_m: 0.13, ..Self::CITY };
    pub(crate) const RACING: Self = Self {
        wheel_m: 0.338,
        front_wheel_m: 0.338,
        tyre_m: 0.013,
        wheelbase_m: 0.99,
        saddle_m: 0.99,
        rise_m: -0.05,
        frame: Frame::Diamond,
        bars: Bars::Drop,
        mudguards: false,
        basket: false,
        rack: false,
        ..Self::CITY
    };
    pub(crate) const MOUNTAIN: Self = Self {
        wheel_m: 0.355,
        front_wheel_m: 0.355,
        tyre_m: 0.03,
        wheelbase_m: 1.14,
        saddle_m: 0.95,
        rise_m: 0.06,
        frame: Frame::Diamond,
        bars: Bars::Flat,
        mudguards: false,
        basket: false,
        rack: false,
        mountain: true,
        ..Self::CITY
    };
    pub(crate) const CARGO: Self = Self {
        wheel_m: 0.33,
        front_wheel_m: 0.25,
        wheelbase_m: 1.86,
        rise_m: 0.16,
        tyre_m: 0.026,
        basket: false,
        battery: true,
        cargo: true,
        ..Self::CITY
    };
    pub(crate) const CHILD: Self = Self {
        wheel_m: 0.25,
        front_wheel_m: 0.25,
        tyre_m: 0.02,
        wheelbase_m: 0.8,
        saddle_m: 0.66,
        rise_m: 0.14,
        frame: Frame::Diamond,
        bars: Bars::Flat,
        basket: false,
        rack: false,
        ..Self::CITY
    };

    /// How large the frame is against an adult's.
    fn size(&self) -> f32 {
        self.saddle_m / 0.95
    }

    fn crank_m(&self) -> f32 {
        0.17 * self.size()
    }

    fn bracket(&self) -> Vec3 {
        vec3(0.44 * self.size(), 0.0, 0.28 * self.size().max(0.85))
    }

    fn saddle(&self) -> Vec3 {
        vec3(self.bracket().x - 0.27 * self.size(), 0.0, self.saddle_m)
    }

    /// Upper end of the steering tube.
    fn head(&self) -> Vec3 {
        let x = if self.cargo { 0.9 } else { self.wheelbase_m - 0.21 * self.size() };
        vec3(x, 0.0, (self.saddle_m - 0.08).min(self.saddle_m + self.rise_m - 0.1))
    }

    fn grip(&self) -> Vec3 {
        let (head, z) = (self.head(), self.saddle_m + self.rise_m);
        match self.bars {
            Bars::Flat => vec3(head.x + 0.02, 0.3 * self.size().max(0.8), z),
            Bars::Drop => vec3(head.x + 0.14, 0.2, z),
            Bars::Swept => vec3(head.x - 0.17, 0.27, z),
        }
    }

    fn pedal(&self, side: f32) -> Vec3 {
        let turn = vec3(0.3 * side, 0.0, -0.954 * side) * self.crank_m();
        self.bracket() + turn + Vec3::Y * 0.13 * side
    }

    /// Someone of a height sitting on it.
    pub(crate) fn pose(&self, height_m: f32) -> Pose {
        let ankle = |side: f32| self.pedal(side) + vec3(-0.055 * height_m, -0.02 * side, 0.02 + 0.045 * height_m);
        let grip = self.grip();
        let wrist = |side: f32| grip * vec3(1.0, side, 1.0) + vec3(-0.055, 0.0, 0.035);
        let hips = self.saddle() + vec3(0.0, 0.0, 0.035 + 0.025 * height_m);
        // The lean that the arms' reach asks for.
        let (reach, rise) = (grip.x - hips.x, grip.z - hips.z);
        let trunk = 0.288 * height_m;
        let arms = 0.29 * height_m;
        let distance = reach.hypot(rise).clamp(0.3, trunk + arms * 0.99);
        let inner =
            ((trunk * trunk + distance * distance - arms * arms) / (2.0 * trunk * distance)).clamp(-1.0, 1.0).acos();
        let lean = (PI / 2.0 - (rise.atan2(reach) + inner)).clamp(0.02, 0.85);
        Pose {
            hips,
            lean_rad: lean,
            ankles: [ankle(1.0), ankle(-1.0)],
            toes_rad: [0.12, 0.3],
            wrists: [wrist(1.0), wrist(-1.0)],
        }
    }

    pub(crate) fn build(&self, parts: &Parts) -> Shape {
        let rear = vec3(0.0, 0.0, self.wheel_m);
        let front = vec3(self.wheelbase_m, 0.0, self.front_wheel_m);
        let mut shapes = vec![
            parts.wire_wheel(self.wheel_m, self.tyre_m, self.mountain).moved(rear),
            parts.wire_wheel(self.front_wheel_m, self.tyre_m, self.mountain).moved(front),
            self.frame(parts, rear, front),
            self.cockpit(parts),
            self.drive(parts, rear),
            self.saddle_shape(parts),
        ];
        if self.mudguards {
            shapes.push(self.guards(parts, rear, front));
        }
        if self.rack {
            shapes.push(self.carrier(parts, rear));
        }
        if self.basket {
            shapes.push(self.basket_shape(parts));
        }
        if self.cargo {
            shapes.push(self.cargo_box(parts, front));
        }
        if self.battery {
            let b = self.bracket();
            let pack = Shape::rounded_block(vec3(0.11, 0.09, 0.36), 0.03).turned(Quat::from_rotation_y(-0.35));
            shapes.push(pack.moved(b + vec3(-0.13, 0.0, 0.3)).slot(parts.black));
            let motor = Shape::cylinder(0.085, 0.13, 18).upright().moved(b - Vec3::Y * 0.065);
            shapes.push(motor.slot(parts.black));
        }
        Shape::join(shapes)
    }

    fn frame(&self, parts: &Parts, rear: Vec3, front: Vec3) -> Shape {
        let k = self.size();
        let (head, bracket, saddle) = (self.head(), self.bracket(), self.saddle());
        let low = if self.cargo { vec3(head.x + 0.05, 0.0, head.z - 0.3) } else { head + (front - head) * 0.27 };
        let seat = bracket.lerp(saddle, 0.78);
        let fat = if self.mountain || self.battery { 1.4 } else { 1.0 } * k;
        let tube = |a: Vec3, b: Vec3, radius: f32| Shape::tube(&[a, b], radius, 10);
        let mut frame = vec![
            tube(bracket, seat, 0.0165 * fat.min(1.2)),
            tube(low - (head - low) * 0.12, head + (head - low) * 0.08, 0.021 * k),
            Shape::cylinder(0.026 * k, 0.074, 16).upright().moved(bracket - Vec3::Y * 0.037),
        ];
        match self.frame {
            Frame::Diamond => {
                frame.push(tube(bracket, low, 0.02 * fat));
                frame.push(tube(bracket.lerp(seat, 0.94), head.lerp(low, 0.15), 0.0165 * fat));
            }
            Frame::Low => {
                let curve: Vec<Vec3> = (0..=8)
                    .map(|i| i as f32 / 8.0)
                    .map(|t| bracket.lerp(low, t) + vec3(0.0, 0.0, -0.07 * (PI * t).sin()))
                    .collect();
                frame.push(Shape::tube(&curve, 0.024 * fat, 10));
                frame.push(tube(bracket.lerp(seat, 0.35), curve[5], 0.012));
            }
        }
        if self.cargo {
            // A long low tube to the front wheel.
            let keel = [
                bracket + vec3(0.1, 0.0, 0.0),
                vec3(0.75, 0.0, 0.26),
                vec3(front.x - 0.5, 0.0, 0.26),
                vec3(front.x - 0.16, 0.0, 0.58),
            ];
            frame.push(Shape::tube(&keel, 0.028, 10));
            frame.push(tube(low, vec3(low.x, 0.0, 0.27), 0.02));
            frame.push(tube(keel[3] - Vec3::Z * 0.08, keel[3] + Vec3::Z * 0.12, 0.024));
        }
        let mut steel = vec![tube(seat, saddle - Vec3::Z * 0.02, 0.0135)];
        let crown = if self.cargo { vec3(front.x - 0.13, 0.0, 0.56) } else { low - (head - low) * 0.14 };
        let mut fork = Vec::new();
        for side in [1.0, -1.0] {
            let out = Vec3::Y * side * (0.055 + self.tyre_m * 0.5);
            frame.push(Shape::tube(
                &[bracket + out * 0.45 - Vec3::X * 0.02, rear + out + vec3(0.08, 0.0, 0.0), rear + out],
                0.0095 * k,
                8,
            ));
            frame.push(tube(seat.lerp(bracket, 0.06) + out * 0.35, rear + out, 0.008 * k));
            if self.mountain {
                let knee = crown.lerp(front, 0.42) + out;
                steel.push(tube(crown + out, knee, 0.016));
                fork.push(tube(knee, front + out, 0.022));
            } else {
                fork.push(Shape::tube(
                    &[crown + out * 0.25, crown + out - Vec3::Z * 0.035, crown.lerp(front, 0.8) + out, front + out],
                    0.0125 * k,
                    8,
                ));
            }
            // Brakes on the rims, or discs.
            if !self.mountain {
                for p in [crown + out * 0.6 + vec3(0.03, 0.0, -0.05), seat.lerp(rear, 0.34) + out * 0.6] {
                    steel.push(tube(p + Vec3::Z * 0.05, p - Vec3::Z * 0.03, 0.008));
                }
            }
        }
        if self.mountain {
            fork.push(Shape::capsule(crown + Vec3::Y * 0.08, crown - Vec3::Y * 0.08, 0.024, 10));
            for axle in [rear, front] {
                steel.push(Shape::cylinder(0.085, 0.003, 24).upright().moved(axle + Vec3::Y * 0.045));
            }
        }
        let bottle =
            Shape::cylinder(0.037, 0.17, 14).turned(Quat::from_rotation_arc(Vec3::Z, (low - bracket).normalize()));
        let mut all = vec![Shape::join(frame).slot(parts.paint), Shape::join(steel).slot(parts.steel)];
        let forks = if self.mountain { parts.black } else { parts.paint };
        all.push(Shape::join(fork).slot(forks));
        if self.frame == Frame::Diamond && !self.mudguards {
            let up = (low - bracket).normalize().cross(Vec3::Y) * -0.065;
            all.push(bottle.moved(bracket.lerp(low, 0.3) + up).slot(parts.amber));
        }
        // Kickstand.
        if self.mudguards {
            let foot = vec3(0.1, 0.16, 0.02);
            all.push(tube(vec3(0.2, 0.06, 0.27 * k), foot, 0.008).slot(parts.steel));
        }
        Shape::join(all)
    }

    /// Stem, bars, grips, levers, bell, lamp.
    fn cockpit(&self, parts: &Parts) -> Shape {
        let (head, grip) = (self.head(), self.grip());
        let mirrored = vec3(1.0, -1.0, 1.0);
        let top = vec3(head.x - 0.01, 0.0, grip.z.max(head.z + 0.04));
        let clamp = match self.bars {
            Bars::Drop => top + vec3(0.08, 0.0, 0.0),
            Bars::Flat => top + vec3(0.06, 0.0, 0.0),
            Bars::Swept => top + vec3(0.02, 0.0, 0.02),
        };
        let mut steel = vec![Shape::tube(&[head, top, clamp], 0.014, 8)];
        let half: Vec<Vec3> = match self.bars {
            Bars::Flat => vec![grip, grip * vec3(1.0, 0.4, 1.0) + Vec3::X * 0.03, clamp],
            Bars::Swept => vec![
                grip,
                grip + vec3(0.1, 0.02, 0.0),
                clamp + vec3(0.03, 0.17, 0.03),
                clamp + vec3(0.02, 0.06, 0.0),
                clamp,
            ],
            Bars::Drop => {
                let hood = vec3(clamp.x + 0.07, 0.2, clamp.z);
                vec![
                    hood + vec3(-0.1, 0.02, -0.13),
                    hood + vec3(-0.02, 0.02, -0.13),
                    hood + vec3(0.03, 0.01, -0.08),
                    hood + vec3(0.01, 0.0, -0.01),
                    hood + vec3(-0.06, 0.0, 0.0),
                    clamp + vec3(0.0, 0.17, 0.0),
                    clamp,
                ]
            }
        };
        let other = half.iter().rev().skip(1).map(|p| *p * mirrored);
        let bar: Vec<Vec3> = half.iter().copied().chain(other).collect();
        steel.push(Shape::tube(&bar, 0.0115, 8));
        let mut black = Vec::new();
        for side in [1.0, -1.0] {
            let to = |p: Vec3| p * vec3(1.0, side, 1.0);
            match self.bars {
                Bars::Drop => {
                    let hood = vec3(clamp.x + 0.07, 0.2, clamp.z);
                    black.push(Shape::capsule(to(hood - Vec3::X * 0.05), to(hood + vec3(0.04, 0.0, 0.03)), 0.02, 8));
                    steel.push(Shape::tube(
                        &[
                            to(hood + vec3(0.03, 0.0, 0.02)),
                            to(hood + vec3(0.06, 0.0, -0.04)),
                            to(hood + vec3(0.03, 0.0, -0.11)),
                        ],
                        0.006,
                        6,
                    ));
                    black.push(Shape::tube(&bar[..4].iter().map(|p| to(*p)).collect::<Vec<_>>(), 0.0155, 8));
                }
                _ => {
                    let inner = half[0].lerp(half[1], 0.6);
                    black.push(Shape::capsule(to(grip), to(inner), 0.0165, 10));
                    let lever = [
                        inner + vec3(0.02, -0.02, -0.01),
                        inner.lerp(grip, 0.3) + vec3(0.055, 0.0, -0.02),
                        grip + vec3(0.05, 0.0, -0.03),
                    ];
                    steel.push(Shape::tube(&lever.map(to), 0.006, 6));
                }
            }
        }
        // A cable from a lever to the fork, one to the frame.
        let cable = [
            grip * 0.5 + clamp * 0.5 + vec3(0.04, 0.0, 0.0),
            clamp + vec3(0.1, 0.05, -0.03),
            head + vec3(0.08, 0.02, -0.14),
        ];
        black.push(Shape::tube(&cable, 0.004, 4));
        black.push(Shape::tube(&cable.map(|p| p * mirrored), 0.004, 4));
        let mut all = vec![Shape::join(steel).slot(parts.steel), Shape::join(black).slot(parts.black)];
        if self.mudguards {
            let at = head + vec3(0.07, 0.0, -0.05);
            let shell = Shape::ellipsoid(vec3(0.045, 0.032, 0.032), 14).moved(at);
            all.push(shell.slot(parts.black));
            all.push(Shape::ellipsoid(vec3(0.014, 0.029, 0.029), 14).moved(at + Vec3::X * 0.036).slot(parts.lamp));
            all.push(
                Shape::ellipsoid(vec3(0.024, 0.024, 0.02), 12).moved(clamp + vec3(0.0, 0.07, 0.02)).slot(parts.steel),
            );
        }
        Shape::join(all)
    }

    /// Cranks, chain, sprockets, pedals.
    fn drive(&self, parts: &Parts, rear: Vec3) -> Shape {
        let bracket = self.bracket();
        let (big, small, y) = (0.09 * self.size(), 0.04, -0.048);
        let mut steel = Vec::new();
        let mut black = Vec::new();
        let teeth: Vec<_> = (0..56)
            .map(|i| on_circle(i as f32 / 56.0, big + if i % 2 == 0 { 0.004 } else { 0.0 }, 0.0))
            .map(|p| vec2(p.x, p.z))
            .collect();
        steel.push(Shape::extruded(&teeth, 0.004).upright().moved(bracket + Vec3::Y * y));
        for r in [0.052, 0.044, 0.036] {
            steel.push(Shape::cylinder(r, 0.003, 20).upright().moved(rear + Vec3::Y * (y + 0.012 - (0.052 - r) * 0.6)));
        }
        // The chain's loop as one flat band.
        let lean = bracket - rear;
        let up = lean.cross(Vec3::Y).normalize() * -1.0;
        let up = if up.z < 0.0 { -up } else { up };
        for (sign, slack) in [(1.0, 0.0), (-1.0, 0.02)] {
            let (a, b) = (rear + up * small * sign, bracket + up * big * sign);
            let middle = a.lerp(b, 0.5) - Vec3::Z * slack;
            let path = [a, middle, b].map(|p| p + Vec3::Y * y);
            let row = |dy: f32, dz: f32| path.iter().map(|p| *p + vec3(0.0, dy, dz)).collect::<Vec<_>>();
            steel.push(Shape::sheet(&[
                row(-0.004, 0.004),
                row(0.004, 0.004),
                row(0.004, -0.004),
                row(-0.004, -0.004),
                row(-0.004, 0.004),
            ]));
        }
        if !self.mudguards {
            let cage = [rear + vec3(0.01, y, -0.06), rear + vec3(0.03, y, -0.13)];
            black.push(Shape::tube(&cage, 0.01, 6));
            black.extend(cage.map(|p| Shape::cylinder(0.022, 0.008, 12).upright().moved(p)));
        } else if !self.battery {
            // A guard over the chain.
            let guard = Shape::rounded_block(vec3(lean.length() + 0.1, 0.02, 0.06), 0.01);
            let turn = Quat::from_rotation_arc(Vec3::X, lean.normalize());
            black.push(guard.turned(turn).moved(rear.lerp(bracket, 0.55) + vec3(0.0, y - 0.01, 0.06)));
        }
        for side in [1.0, -1.0] {
            let pedal = self.pedal(side);
            let end = vec3(pedal.x, 0.075 * side, pedal.z);
            steel.push(Shape::tapered_tube(&[(bracket + Vec3::Y * 0.06 * side, 0.014), (end, 0.01)], 8));
            steel.push(Shape::tube(&[end, pedal], 0.006, 6));
            black.push(Shape::rounded_block(vec3(0.095, 0.085, 0.022), 0.008).moved(pedal));
        }
        let reflectors = [1.0, -1.0].map(|side| Shape::block(vec3(0.1, 0.05, 0.012)).moved(self.pedal(side)));
        Shape::join([
            Shape::join(steel).slot(parts.steel),
            Shape::join(black).slot(parts.black),
            Shape::join(reflectors).slot(parts.amber),
        ])
    }

    fn saddle_shape(&self, parts: &Parts) -> Shape {
        let at = self.saddle();
        let wide = if self.bars == Bars::Swept { 1.25 } else { 1.0 };
        let limbs = vec![
            Limb::new(vec3(-0.1, 0.035 * wide, 0.0), vec3(-0.02, 0.02, 0.003), 0.035, 0.03),
            Limb::new(vec3(-0.1, -0.035 * wide, 0.0), vec3(-0.02, -0.02, 0.003), 0.035, 0.03),
            Limb::new(vec3(-0.02, 0.0, 0.004), vec3(0.14, 0.0, 0.002), 0.035, 0.018),
        ];
        let saddle = Blend::new(limbs, 0.03).surface(0.02).scaled(vec3(1.0, 1.0, 0.75)).moved(at);
        let rails = [0.02, -0.02].map(|y| {
            Shape::tube(
                &[
                    at + vec3(-0.08, y, -0.01),
                    at + vec3(-0.05, y, -0.035),
                    at + vec3(0.06, y, -0.035),
                    at + vec3(0.1, y * 0.4, -0.005),
                ],
                0.0035,
                5,
            )
        });
        let tail = Shape::rounded_block(vec3(0.02, 0.045, 0.035), 0.008)
            .moved(self.bracket().lerp(at, 0.8) + vec3(-0.035, 0.0, 0.03));
        Shape::join([saddle.slot(parts.black), Shape::join(rails).slot(parts.steel), tail.slot(parts.red)])
    }

    fn guards(&self, parts: &Parts, rear: Vec3, front: Vec3) -> Shape {
        let mut all = Vec::new();
        for (axle, r, from, to) in [(rear, self.wheel_m, 0.35, 3.5), (front, self.front_wheel_m, 0.85, 3.75)] {
            let radius = r + 0.022;
            let half = self.tyre_m + 0.008;
            let row = |y: f32, dr: f32| -> Vec<Vec3> {
                (0..=18)
                    .map(|i| from + (to - from) * i as f32 / 18.0)
                    .map(|a: f32| axle + vec3(a.cos() * (radius + dr), y, a.sin() * (radius + dr)))
                    .collect()
            };
            let guard = Shape::sheet(&[
                row(-half, -0.022),
                row(-half * 0.75, -0.006),
                row(0.0, 0.0),
                row(half * 0.75, -0.006),
                row(half, -0.022),
            ]);
            all.push(guard.inside_out().smooth(1.2).plate(0.0025).slot(parts.paint));
            for a in [to - 0.15, to - 1.1] {
                for side in [1.0, -1.0] {
                    let end = axle + vec3(a.cos() * radius, side * half, a.sin() * radius);
                    all.push(Shape::tube(&[axle + Vec3::Y * 0.05 * side, end], 0.0028, 4).slot(parts.steel));
                }
            }
        }
        let a: f32 = 2.9;
        let at = rear + vec3(a.cos(), 0.0, a.sin()) * (self.wheel_m + 0.045);
        all.push(Shape::rounded_block(vec3(0.02, 0.05, 0.07), 0.01).moved(at).slot(parts.red));
        Shape::join(all)
    }

    fn carrier(&self, parts: &Parts, rear: Vec3) -> Shape {
        let z = self.wheel_m * 2.0 + 0.07;
        let mut rods = Vec::new();
        for y in [-0.06, 0.0, 0.06] {
            rods.push(Shape::tube(&[vec3(-0.26, y, z), vec3(0.12, y, z)], 0.005, 5));
        }
        for x in [-0.26, -0.07, 0.12] {
            rods.push(Shape::tube(&[vec3(x, -0.065, z), vec3(x, 0.065, z)], 0.005, 5));
        }
        for side in [1.0, -1.0] {
            for x in [-0.2, -0.02] {
                rods.push(Shape::tube(&[rear + Vec3::Y * 0.06 * side, vec3(x, 0.065 * side, z)], 0.0045, 5));
            }
        }
        Shape::join(rods).slot(parts.black)
    }

    /// A basket of wire over the front wheel.
    fn basket_shape(&self, parts: &Parts) -> Shape {
        let at = self.head() + vec3(0.24, 0.0, 0.06);
        let corner = |x: f32, y: f32, z: f32| at + vec3(x * (0.13 + 0.03 * z), y * (0.16 + 0.04 * z), -0.14 + 0.26 * z);
        let mut wires = Vec::new();
        for i in 0..=4 {
            let z = i as f32 / 4.0;
            let ring = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)].map(|(x, y)| corner(x, y, z));
            wires.push(Shape::tube(&ring, if i == 4 { 0.005 } else { 0.0025 }, 4));
        }
        for i in 0..=7 {
            let t = i as f32 / 3.5 - 1.0;
            for s in [-1.0, 1.0] {
                wires.push(Shape::tube(&[corner(t, s, 0.0), corner(t, s, 1.0)], 0.0022, 3));
                wires.push(Shape::tube(&[corner(s, t, 0.0), corner(s, t, 1.0)], 0.0022, 3));
            }
            wires.push(Shape::tube(&[corner(t, -1.0, 0.0), corner(t, 1.0, 0.0)], 0.0022, 3));
        }
        Shape::join(wires).slot(parts.black)
    }

    /// An open wooden box on the long frame.
    fn cargo_box(&self, parts: &Parts, front: Vec3) -> Shape {
        let (a, b) = (0.98, front.x - 0.3);
        let wall = |low: [f32; 3], high: [f32; 3]| {
            let (low, high) = (Vec3::from(low), Vec3::from(high));
            Shape::rounded_block(high - low, 0.006).moved((low + high) / 2.0)
        };
        let (h, low, high) = (0.27, 0.3, 0.74);
        let sides = wall([a, h - 0.012, low], [b + 0.06, h, high]).both_sides();
        let ends =
            wall([a, -h, low], [a + 0.012, h, high + 0.05]).and(wall([b + 0.05, -h, low], [b + 0.062, h, high - 0.12]));
        let floor = wall([a, -h, low], [b + 0.06, h, low + 0.012]);
        let rim =
            [vec3(a, h, high), vec3(b + 0.06, h, high), vec3(b + 0.06, -h, high), vec3(a, -h, high), vec3(a, h, high)];
        let ring: Vec<Vec3> = (0..=8).map(|i| on_circle(i as f32 / 8.0, 0.03, 0.0)).collect();
        let bell = Shape::tube(&ring, 0.004, 4).moved(vec3(b + 0.07, 0.0, 0.55));
        let rod = Shape::tube(&[vec3(self.head().x, 0.03, 0.24), vec3(front.x, 0.06, front.z - 0.02)], 0.008, 6);
        Shape::join([
            Shape::join([sides, ends, floor]).slot(parts.wood),
            Shape::tube(&rim, 0.012, 6).slot(parts.black),
            bell.slot(parts.lamp),
            rod.slot(parts.steel),
        ])
    }
}

//! Motorcycles and motor scooters.

use std::f32::consts::TAU;

use glam::{Quat, Vec3, vec2, vec3};

use super::parts::{Parts, on_circle};
use crate::people::Pose;
use crate::shape::{Blend, Limb, Prism, Shape, rect};
use crate::vehicles::{PLATE_M, on_back};

/// How it is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Build {
    /// Open engine, tank between the knees.
    Naked,
    /// A fairing over the engine.
    Sports,
    /// Long and low, feet in front.
    Cruiser,
    /// Light, with a step-through frame.
    Underbone,
    /// A board for the feet behind a leg shield.
    Scooter,
}

/// A motorcycle; x = 0 is the rear axle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motorcycle {
    pub(crate) build: Build,
    /// A box on the carrier.
    pub(crate) delivers: bool,
}

impl Motorcycle {
    fn wheelbase_m(self) -> f32 {
        match self.build {
            Build::Naked => 1.42,
            Build::Sports => 1.4,
            Build::Cruiser => 1.62,
            Build::Underbone => 1.25,
            Build::Scooter => 1.32,
        }
    }

    /// Radii of wheel and tyre.
    fn wheel_m(self) -> (f32, f32) {
        match self.build {
            Build::Naked | Build::Sports => (0.31, 0.072),
            Build::Cruiser => (0.33, 0.075),
            Build::Underbone => (0.29, 0.045),
            Build::Scooter => (0.25, 0.058),
        }
    }

    fn grip(self) -> Vec3 {
        match self.build {
            Build::Naked => vec3(0.93, 0.37, 1.06),
            Build::Sports => vec3(0.98, 0.32, 0.92),
            Build::Cruiser => vec3(0.92, 0.4, 1.06),
            Build::Underbone => vec3(0.82, 0.33, 1.0),
            Build::Scooter => vec3(0.88, 0.33, 1.05),
        }
    }

    fn seat(self) -> Vec3 {
        match self.build {
            Build::Naked => vec3(0.42, 0.0, 0.80),
            Build::Sports => vec3(0.38, 0.0, 0.83),
            Build::Cruiser => vec3(0.42, 0.0, 0.69),
            Build::Underbone => vec3(0.3, 0.0, 0.76),
            Build::Scooter => vec3(0.28, 0.0, 0.78),
        }
    }

    /// Where the left foot rests.
    fn rest(self) -> Vec3 {
        match self.build {
            Build::Naked => vec3(0.52, 0.2, 0.33),
            Build::Sports => vec3(0.36, 0.2, 0.38),
            Build::Cruiser => vec3(1.02, 0.24, 0.32),
            Build::Underbone => vec3(0.5, 0.19, 0.27),
            Build::Scooter => vec3(0.72, 0.13, 0.29),
        }
    }

    /// Someone of a height sitting on it.
    pub(crate) fn pose(self, height_m: f32) -> Pose {
        let ankle = |side: f32| self.rest() * vec3(1.0, side, 1.0) + vec3(-0.06, 0.0, 0.05 * height_m);
        let wrist = |side: f32| self.grip() * vec3(1.0, side, 1.0) + vec3(-0.065, 0.0, 0.035);
        Pose {
            hips: self.seat() + vec3(0.0, 0.0, 0.09),
            lean_rad: match self.build {
                Build::Naked => 0.25,
                Build::Sports => 0.62,
                Build::Cruiser => 0.08,
                Build::Underbone | Build::Scooter => 0.14,
            },
            ankles: [ankle(1.0), ankle(-1.0)],
            toes_rad: if self.build == Build::Cruiser { [-0.35; 2] } else { [0.08; 2] },
            wrists: [wrist(1.0), wrist(-1.0)],
        }
    }

    /// Upper end of the steering axis.
    fn head(self) -> Vec3 {
        let grip = self.grip();
        vec3(grip.x + if self.build == Build::Cruiser { 0.17 } else { 0.08 }, 0.0, grip.z - 0.1)
    }

    pub(crate) fn shape(self, parts: &Parts) -> Shape {
        let (r, tyre) = self.wheel_m();
        let (rear, front) = (vec3(0.0, 0.0, r), vec3(self.wheelbase_m(), 0.0, r));
        let spokes = if self.build == Build::Cruiser { 10 } else { 5 };
        let mut shapes = vec![
            parts.cast_wheel(r, tyre * 1.2, spokes).moved(rear),
            parts.cast_wheel(r, tyre, spokes).moved(front),
            self.body(parts),
            self.fork(parts, front, tyre),
            self.bars(parts),
            self.guards(parts, rear, front),
            self.tail(parts),
        ];
        if self.build != Build::Scooter {
            shapes.push(self.engine(parts));
            shapes.push(self.chassis(parts, rear));
        }
        shapes.push(self.exhaust(parts));
        if self.delivers {
            shapes.push(self.top_box(parts));
        }
        Shape::join(shapes)
    }

    fn fork(self, parts: &Parts, front: Vec3, tyre: f32) -> Shape {
        let head = self.head();
        let mut steel = Vec::new();
        let mut black = Vec::new();
        for side in [1.0, -1.0] {
            let y = Vec3::Y * side * (tyre + 0.045);
            let top = head + y;
            let covered = matches!(self.build, Build::Scooter | Build::Underbone);
            let top = if covered { (front + y).lerp(top, 0.52) } else { top };
            let knee = (front + y).lerp(top, if covered { 0.7 } else { 0.42 });
            black.push(Shape::tube(&[front + y, knee], 0.029, 12));
            steel.push(Shape::tube(&[knee, top], 0.021, 12));
            black.push(Shape::tube(&[front + y * 0.6, front + y * 1.25], 0.018, 10));
            // Callipers on the discs.
            black.push(
                Shape::rounded_block(vec3(0.05, 0.05, 0.09), 0.012).moved(front + y * 0.8 + vec3(-0.1, 0.0, 0.06)),
            );
        }
        let plates: &[f32] = if matches!(self.build, Build::Scooter | Build::Underbone) { &[] } else { &[0.72, 0.97] };
        for t in plates.iter().copied() {
            let at = front.lerp(head, t);
            black.push(Shape::rounded_block(vec3(0.09, (tyre + 0.07) * 2.0, 0.035), 0.014).moved(at));
        }
        Shape::join([Shape::join(steel).slot(parts.steel), Shape::join(black).slot(parts.black)])
    }

    /// Bars, grips, levers, mirrors, indicators, instruments.
    fn bars(self, parts: &Parts) -> Shape {
        let (grip, head) = (self.grip(), self.head());
        let mut steel = Vec::new();
        let mut black = Vec::new();
        let mut glass = Vec::new();
        let mut amber = Vec::new();
        for side in [1.0, -1.0] {
            let to = |p: Vec3| p * vec3(1.0, side, 1.0);
            let end = grip + vec3(-0.02, 0.02, 0.0);
            let inner = grip + vec3(0.04, -0.12, 0.0);
            let rise = if self.build == Build::Sports {
                vec3(head.x, 0.11, head.z + 0.02)
            } else {
                vec3(head.x - 0.01, 0.13, head.z + 0.08)
            };
            steel.push(Shape::tube(&[to(vec3(head.x, 0.0, rise.z - 0.02)), to(rise), to(inner), to(end)], 0.011, 8));
            black.push(Shape::capsule(to(end), to(inner), 0.0175, 10));
            black.push(Shape::rounded_block(vec3(0.05, 0.06, 0.045), 0.012).moved(to(inner - Vec3::Y * 0.02)));
            let lever =
                [inner + vec3(0.03, -0.01, 0.0), grip + vec3(0.075, -0.03, -0.005), end + vec3(0.075, 0.0, -0.01)];
            steel.push(Shape::tube(&lever.map(to), 0.006, 6));
            let stalk = inner + vec3(0.0, -0.03, 0.02);
            let mirror = stalk + vec3(-0.02, 0.13, 0.19);
            steel.push(Shape::tube(&[to(stalk), to(stalk + vec3(0.02, 0.05, 0.12)), to(mirror)], 0.006, 6));
            black.push(Shape::ellipsoid(vec3(0.018, 0.072, 0.046), 14).moved(to(mirror)));
            glass.push(Shape::ellipsoid(vec3(0.004, 0.062, 0.037), 14).moved(to(mirror - Vec3::X * 0.016)));
            let lamp = head + vec3(0.07, 0.19, -0.08);
            black.push(Shape::tube(&[to(head + vec3(0.03, 0.08, -0.08)), to(lamp)], 0.008, 6));
            amber.push(Shape::ellipsoid(vec3(0.032, 0.022, 0.02), 10).moved(to(lamp + Vec3::Y * 0.01)));
        }
        let panel = Shape::rounded_block(vec3(0.06, 0.17, 0.09), 0.025).turned(Quat::from_rotation_y(-0.7));
        black.push(panel.moved(head + vec3(0.05, 0.0, 0.07)));
        let cable = [
            grip * vec3(1.0, 0.6, 1.0) + vec3(0.06, 0.0, 0.0),
            head + vec3(0.14, 0.1, 0.03),
            head + vec3(0.08, 0.06, -0.2),
        ];
        black.push(Shape::tube(&cable, 0.006, 5).both_sides());
        Shape::join([
            Shape::join(steel).slot(parts.steel),
            Shape::join(black).slot(parts.black),
            Shape::join(glass).slot(parts.mirror),
            Shape::join(amber).slot(parts.amber),
        ])
    }

    fn guards(self, parts: &Parts, rear: Vec3, front: Vec3) -> Shape {
        let (r, tyre) = self.wheel_m();
        let arc = |axle: Vec3, from: f32, to: f32, wide: f32| {
            let row = |y: f32, dr: f32| -> Vec<Vec3> {
                (0..=10)
                    .map(|i| from + (to - from) * i as f32 / 10.0)
                    .map(|a: f32| axle + vec3(a.cos() * (r + 0.028 + dr), y, a.sin() * (r + 0.028 + dr)))
                    .collect()
            };
            let w = tyre * wide;
            let guard = Shape::sheet(&[
                row(-w, -0.05),
                row(-w * 0.9, -0.012),
                row(-w * 0.4, 0.0),
                row(w * 0.4, 0.0),
                row(w * 0.9, -0.012),
                row(w, -0.05),
            ]);
            guard.inside_out().smooth(1.2).plate(0.004)
        };
        let (a, b) = if self.build == Build::Cruiser { (0.9, 3.2) } else { (0.85, 2.75) };
        let back = if self.build == Build::Cruiser { (0.9, 2.9) } else { (1.2, 2.1) };
        let rear_slot = if self.build == Build::Cruiser { parts.paint } else { parts.black };
        Shape::join([arc(front, a, b, 1.25).slot(parts.paint), arc(rear, back.0, back.1, 1.4).slot(rear_slot)])
    }

    /// Plate, lamp, indicators at the back.
    fn tail(self, parts: &Parts) -> Shape {
        let seat = self.seat();
        let end = match self.build {
            Build::Cruiser => vec3(-0.3, 0.0, 0.6),
            Build::Sports => vec3(-0.3, 0.0, seat.z + 0.05),
            _ => vec3(-0.32, 0.0, seat.z - 0.04),
        };
        let holder = end + vec3(-0.03, 0.0, -0.16);
        let size = PLATE_M * vec2(0.42, 1.1);
        let plate = on_back(Vec3::X * -0.006, size).turned(Quat::from_rotation_y(0.3)).moved(holder);
        let board =
            Shape::rounded_block(vec3(0.008, size.x + 0.01, size.y + 0.01), 0.003).turned(Quat::from_rotation_y(0.3));
        let arm = Shape::tube(&[end + vec3(0.1, 0.0, -0.03), holder + vec3(0.02, 0.0, 0.04)], 0.022, 8);
        let mut all = vec![
            plate.slot(parts.plate),
            board.moved(holder).and(arm).slot(parts.black),
            Shape::ellipsoid(vec3(0.03, 0.075, 0.028), 14).moved(end).slot(parts.red),
        ];
        for side in [1.0, -1.0] {
            let lamp = end + vec3(0.02, side * 0.14, -0.05);
            all.push(Shape::tube(&[end + vec3(0.04, 0.0, -0.05), lamp], 0.007, 6).slot(parts.black));
            all.push(Shape::ellipsoid(vec3(0.03, 0.02, 0.018), 10).moved(lamp).slot(parts.amber));
        }
        Shape::join(all)
    }

    /// Case, finned cylinders, covers, radiator.
    fn engine(self, parts: &Parts) -> Shape {
        let low = if self.build == Build::Underbone { 0.3 } else { 0.34 };
        let x = if self.build == Build::Cruiser { 0.72 } else { 0.6 };
        let case = Blend::new(
            vec![
                Limb::new(vec3(x - 0.12, 0.0, low), vec3(x + 0.1, 0.0, low - 0.02), 0.12, 0.11).wide(Vec3::Y, 1.25),
                Limb::new(vec3(x - 0.16, 0.0, low + 0.08), vec3(x - 0.1, 0.0, low + 0.1), 0.09, 0.09),
            ],
            0.05,
        )
        .surface(0.045);
        let mut steel = vec![case];
        for side in [1.0, -1.0] {
            for (dx, radius) in [(-0.08, 0.085), (0.09, 0.07)] {
                let lid = Shape::lathe(
                    &[vec2(radius, 0.0), vec2(radius, 0.02), vec2(radius * 0.85, 0.032), vec2(0.0, 0.034)],
                    20,
                )
                .upright();
                let lid = if side > 0.0 { lid } else { lid.scaled(vec3(1.0, -1.0, 1.0)) };
                steel.push(lid.moved(vec3(x + dx, side * 0.135, low)));
            }
        }
        let tilts: &[f32] = match self.build {
            Build::Cruiser => &[0.42, -0.42],
            Build::Underbone => &[1.35],
            _ => &[0.4],
        };
        let mut black = Vec::new();
        for &tilt in tilts {
            let up = Quat::from_rotation_y(tilt);
            let foot = vec3(x + 0.02, 0.0, low + 0.07);
            let (l, w) = if self.build == Build::Underbone {
                (0.12, 0.13)
            } else {
                (0.17, if tilts.len() > 1 { 0.15 } else { 0.3 })
            };
            for k in 0..8 {
                let fin = Shape::block(vec3(l, w, 0.008)).moved(Vec3::Z * (0.05 + 0.02 * k as f32));
                steel.push(fin.turned(up).moved(foot));
            }
            let barrel = Shape::rounded_block(vec3(l * 0.85, w * 0.9, 0.18), 0.02).moved(Vec3::Z * 0.12);
            black.push(barrel.turned(up).moved(foot));
            let top = Shape::rounded_block(vec3(l * 0.95, w * 0.95, 0.07), 0.025).moved(Vec3::Z * 0.245);
            steel.push(top.turned(up).moved(foot));
        }
        if matches!(self.build, Build::Naked | Build::Sports) {
            let radiator = Shape::rounded_block(vec3(0.04, 0.34, 0.24), 0.012).turned(Quat::from_rotation_y(-0.28));
            black.push(radiator.moved(vec3(0.98, 0.0, 0.56)));
        }
        let rest = self.rest();
        for side in [1.0, -1.0] {
            let at = rest * vec3(1.0, side, 1.0);
            black.push(Shape::tube(&[at - vec3(0.0, 0.1 * side, 0.0), at + vec3(0.0, 0.05 * side, 0.0)], 0.012, 8));
        }
        Shape::join([Shape::join(steel).slot(parts.steel), Shape::join(black).slot(parts.black)])
    }

    /// Frame tubes, swing arm, shock absorbers, chain.
    fn chassis(self, parts: &Parts, rear: Vec3) -> Shape {
        let (head, seat) = (self.head(), self.seat());
        let pivot = vec3(0.42, 0.0, 0.38);
        let mut black = Vec::new();
        let mut steel = Vec::new();
        for side in [1.0, -1.0] {
            let y = |w: f32| Vec3::Y * side * w;
            black.push(Shape::tapered_tube(&[(rear + y(0.1), 0.022), (pivot + y(0.09), 0.032)], 8));
            let spine = [
                pivot + y(0.12),
                vec3(0.46, 0.0, seat.z - 0.12) + y(0.12),
                head + vec3(-0.12, 0.0, -0.16) + y(0.09),
                head + vec3(0.0, 0.0, -0.08),
            ];
            black.push(Shape::tube(&spine, 0.02, 8));
            black.push(Shape::tube(
                &[pivot + y(0.1), vec3(0.85, 0.0, 0.28) + y(0.1), head + vec3(0.04, 0.0, -0.22)],
                0.016,
                8,
            ));
            black.push(Shape::tube(
                &[vec3(0.4, 0.0, seat.z - 0.14) + y(0.11), vec3(-0.2, 0.0, seat.z - 0.09) + y(0.08)],
                0.016,
                8,
            ));
            if self.build != Build::Sports {
                let (a, b) = (rear + vec3(0.06, 0.0, 0.03) + y(0.13), vec3(0.16, 0.0, seat.z - 0.12) + y(0.13));
                steel.push(Shape::tube(&[a, b], 0.012, 8));
                let turns = 26;
                let (u, v) = ((b - a).normalize().any_orthonormal_vector(), (b - a).normalize());
                let w = v.cross(u);
                let coil: Vec<Vec3> = (0..=turns)
                    .map(|i| {
                        let (t, angle) = (0.25 + 0.6 * i as f32 / turns as f32, i as f32 * 1.6);
                        a.lerp(b, t) + (u * angle.cos() + w * angle.sin()) * 0.028
                    })
                    .collect();
                steel.push(Shape::tube(&coil, 0.006, 4));
            }
        }
        let sprocket = Shape::cylinder(0.1, 0.006, 28).upright().moved(rear + Vec3::Y * 0.085);
        steel.push(sprocket);
        for dz in [0.095, -0.095] {
            let chain = [rear + vec3(0.0, 0.088, dz), pivot + vec3(0.05, 0.088, dz * 0.45)];
            black.push(Shape::tube(&chain, 0.009, 4));
        }
        let stand = [vec3(0.4, 0.12, 0.3), vec3(0.3, 0.24, 0.02)];
        black.push(Shape::tube(&stand, 0.012, 6));
        Shape::join([Shape::join(black).slot(parts.black), Shape::join(steel).slot(parts.steel)])
    }

    fn exhaust(self, parts: &Parts) -> Shape {
        let smooth = |points: &[(Vec3, f32)]| Shape::tapered_tube(points, 14);
        match self.build {
            Build::Scooter => {
                let pot = [
                    (vec3(0.1, -0.17, 0.27), 0.02),
                    (vec3(0.05, -0.18, 0.27), 0.05),
                    (vec3(-0.24, -0.2, 0.32), 0.058),
                    (vec3(-0.27, -0.2, 0.325), 0.03),
                ];
                smooth(&pot).slot(parts.black)
            }
            Build::Cruiser => {
                let pipe = |z: f32, x: f32| {
                    smooth(&[
                        (vec3(x, -0.1, 0.52), 0.026),
                        (vec3(x + 0.02, -0.19, 0.42), 0.027),
                        (vec3(0.5, -0.2, z), 0.028),
                        (vec3(0.3, -0.2, z), 0.044),
                        (vec3(-0.42, -0.22, z + 0.03), 0.048),
                        (vec3(-0.43, -0.22, z + 0.03), 0.034),
                    ])
                };
                pipe(0.26, 0.92).and(pipe(0.38, 0.62)).slot(parts.steel)
            }
            _ => {
                let low = if self.build == Build::Underbone { 0.24 } else { 0.22 };
                let bend = [
                    (vec3(0.88, -0.06, 0.52), 0.022),
                    (vec3(0.94, -0.08, 0.36), 0.023),
                    (vec3(0.82, -0.1, low), 0.024),
                    (vec3(0.42, -0.14, low + 0.01), 0.026),
                ];
                let end = if self.build == Build::Sports { vec3(-0.2, -0.2, 0.5) } else { vec3(-0.3, -0.2, 0.4) };
                let start = vec3(0.24, -0.17, low + 0.08);
                let can = [
                    (bend[3].0, 0.028),
                    (start, 0.04),
                    (start.lerp(end, 0.12), 0.062),
                    (end, 0.064),
                    (end + (end - start) * 0.02, 0.036),
                ];
                smooth(&bend).and(smooth(&can)).slot(parts.steel)
            }
        }
    }

    /// Tank, seat, panels, headlamp.
    fn body(self, parts: &Parts) -> Shape {
        let blend = |limbs: &[(Vec3, Vec3, f32, f32, f32)], softness: f32, cell: f32| {
            let limbs = limbs.iter().map(|&(a, b, r, s, wide)| Limb::new(a, b, r, s).wide(Vec3::Y, wide)).collect();
            Blend::new(limbs, softness).surface(cell)
        };
        let (seat, head) = (self.seat(), self.head());
        let mut shapes = Vec::new();
        match self.build {
            Build::Scooter => {
                let rear = blend(
                    &[
                        (vec3(0.42, 0.0, 0.52), vec3(0.1, 0.0, 0.58), 0.14, 0.15, 1.15),
                        (vec3(0.1, 0.0, 0.58), vec3(-0.24, 0.0, 0.7), 0.14, 0.07, 1.2),
                        (vec3(0.4, 0.0, 0.4), vec3(0.3, 0.0, 0.42), 0.1, 0.1, 1.3),
                    ],
                    0.06,
                    0.042,
                );
                let shield = blend(
                    &[
                        (vec3(1.0, 0.0, 0.36), vec3(1.0, 0.0, 0.72), 0.06, 0.06, 3.2),
                        (vec3(1.0, 0.0, 0.72), vec3(0.95, 0.0, 0.92), 0.06, 0.05, 2.8),
                        (vec3(1.14, 0.0, 0.58), vec3(1.02, 0.0, 0.92), 0.085, 0.06, 1.5),
                    ],
                    0.06,
                    0.042,
                );
                let cowl = blend(&[(vec3(0.9, 0.0, 1.0), vec3(1.0, 0.0, 0.99), 0.075, 0.07, 2.3)], 0.03, 0.038);
                let board = Shape::rounded_block(vec3(0.6, 0.34, 0.08), 0.035).moved(vec3(0.68, 0.0, 0.26));
                let engine = Shape::rounded_block(vec3(0.42, 0.2, 0.2), 0.07).moved(vec3(0.12, 0.05, 0.3));
                let belt = Shape::capsule(vec3(0.0, 0.14, 0.26), vec3(0.34, 0.14, 0.28), 0.09, 12);
                shapes.extend([
                    Shape::join([rear, shield, cowl]).slot(parts.paint),
                    Shape::join([board, engine, belt]).slot(parts.black),
                ]);
                let lamp = Shape::ellipsoid(vec3(0.05, 0.1, 0.055), 18).moved(vec3(1.045, 0.0, 1.0));
                shapes.push(lamp.slot(parts.lamp));
                shapes
                    .push(Shape::ellipsoid(vec3(0.03, 0.12, 0.03), 14).moved(vec3(1.215, 0.0, 0.64)).slot(parts.lamp));
            }
            Build::Underbone => {
                let panel = blend(
                    &[
                        (vec3(0.42, 0.0, 0.5), vec3(-0.05, 0.0, 0.62), 0.1, 0.09, 1.1),
                        (vec3(-0.05, 0.0, 0.62), vec3(-0.28, 0.0, 0.7), 0.08, 0.05, 1.2),
                    ],
                    0.05,
                    0.04,
                );
                let spine = blend(&[(vec3(0.42, 0.0, 0.48), vec3(0.82, 0.0, 0.78), 0.075, 0.08, 0.9)], 0.03, 0.038);
                let shield = blend(
                    &[
                        (vec3(0.9, 0.0, 0.42), vec3(0.88, 0.0, 0.8), 0.04, 0.045, 4.6),
                        (vec3(1.06, 0.0, 0.62), vec3(0.95, 0.0, 0.88), 0.07, 0.06, 1.7),
                    ],
                    0.05,
                    0.04,
                );
                let cowl = blend(&[(vec3(0.84, 0.0, 0.98), vec3(0.93, 0.0, 0.97), 0.065, 0.07, 1.9)], 0.03, 0.038);
                shapes.push(Shape::join([panel, spine, shield, cowl]).slot(parts.paint));
                shapes
                    .push(Shape::ellipsoid(vec3(0.04, 0.085, 0.06), 18).moved(vec3(0.975, 0.0, 0.97)).slot(parts.lamp));
            }
            _ => {
                let long = self.build == Build::Cruiser;
                let tank_end = vec3(head.x - 0.2, 0.0, seat.z + if long { 0.16 } else { 0.15 });
                let tank = blend(
                    &[
                        (seat + vec3(0.22, 0.0, 0.04), tank_end - vec3(0.08, 0.0, 0.03), 0.075, 0.115, 1.3),
                        (tank_end - vec3(0.08, 0.0, 0.03), tank_end + vec3(0.06, 0.0, -0.02), 0.115, 0.09, 1.35),
                    ],
                    0.05,
                    0.036,
                );
                shapes.push(tank.slot(parts.paint));
                shapes.push(
                    Shape::cylinder(0.035, 0.012, 16).moved(tank_end + vec3(-0.06, 0.0, 0.085)).slot(parts.steel),
                );
                if !long {
                    let tail = blend(
                        &[
                            (seat + vec3(-0.2, 0.0, -0.05), seat + vec3(-0.64, 0.0, 0.03), 0.065, 0.035, 1.6),
                            (seat + vec3(0.1, 0.0, -0.1), seat + vec3(-0.25, 0.0, -0.07), 0.06, 0.06, 1.5),
                        ],
                        0.05,
                        0.04,
                    );
                    shapes.push(tail.slot(parts.paint));
                }
            }
        }
        let long = if self.build == Build::Scooter { 0.5 } else { 0.46 };
        let cushion = blend(
            &[
                (seat + vec3(0.16, 0.0, -0.03), seat + vec3(-0.14, 0.0, -0.03), 0.045, 0.06, 2.0),
                (seat + vec3(-0.2, 0.0, 0.02), seat + vec3(-long, 0.0, 0.035), 0.055, 0.04, 2.0),
            ],
            0.05,
            0.04,
        );
        shapes.push(cushion.slot(parts.black));
        match self.build {
            Build::Sports => {
                let fairing = blend(
                    &[
                        (vec3(0.92, 0.0, 0.7), vec3(1.22, 0.0, 0.83), 0.19, 0.1, 1.15),
                        (vec3(1.02, 0.0, 0.6), vec3(0.6, 0.0, 0.36), 0.17, 0.11, 1.15),
                        (vec3(0.6, 0.0, 0.5), vec3(0.95, 0.0, 0.62), 0.13, 0.17, 1.25),
                        (vec3(1.15, 0.0, 0.86), vec3(1.36, 0.0, 0.78), 0.12, 0.04, 1.5),
                    ],
                    0.06,
                    0.045,
                );
                // Vents in its sides, dark lamps in its nose.
                let vent = [vec2(0.78, 0.52), vec2(1.0, 0.6), vec2(0.96, 0.7), vec2(0.8, 0.62)];
                let mut fairing = fairing.slot(parts.paint).mark_both(&Prism::side(&vent, 0.05..=1.0), parts.black);
                let lamp = [vec2(0.03, 0.79), vec2(0.12, 0.82), vec2(0.13, 0.86), vec2(0.04, 0.84)];
                fairing = fairing.mark_both(&Prism::front(&lamp, 1.1..=1.6), parts.lamp);
                shapes.push(fairing);
                let screen = Shape::ellipsoid(vec3(0.22, 0.13, 0.1), 20).turned(Quat::from_rotation_y(0.5));
                shapes.push(screen.moved(vec3(1.08, 0.0, 0.96)).slot(parts.glass));
            }
            Build::Naked | Build::Cruiser => {
                let at = head + vec3(0.15, 0.0, if self.build == Build::Naked { -0.1 } else { -0.08 });
                let bowl =
                    [vec2(0.0, -0.1), vec2(0.05, -0.09), vec2(0.082, -0.05), vec2(0.094, 0.0), vec2(0.094, 0.02)];
                let turn = Quat::from_rotation_y(TAU / 4.0);
                shapes.push(Shape::lathe(&bowl, 24).turned(turn).moved(at).slot(parts.black));
                shapes
                    .push(Shape::ellipsoid(vec3(0.022, 0.086, 0.086), 20).moved(at + Vec3::X * 0.018).slot(parts.lamp));
                let ring: Vec<Vec3> =
                    (0..=24).map(|i| on_circle(i as f32 / 24.0, 0.09, 0.0)).map(|p| vec3(0.02, p.x, p.z)).collect();
                shapes.push(Shape::tube(&ring, 0.007, 6).moved(at).slot(parts.steel));
            }
            _ => {}
        }
        Shape::join(shapes)
    }

    /// A box for parcels on a carrier.
    fn top_box(self, parts: &Parts) -> Shape {
        let seat = self.seat();
        let at = vec3(-0.3, 0.0, seat.z + 0.3);
        let case = Shape::rounded_block(vec3(0.44, 0.46, 0.44), 0.05).moved(at);
        let case =
            case.slot(parts.case).mark(&Prism::top(&rect(-2.0, 2.0, -2.0, 2.0), at.z + 0.1..=at.z + 0.12), parts.black);
        let carrier = Shape::rounded_block(vec3(0.42, 0.34, 0.03), 0.012).moved(at - Vec3::Z * 0.235);
        let legs =
            [0.1, -0.1].map(|y| Shape::tube(&[vec3(0.0, y, seat.z - 0.02), vec3(-0.3, y, at.z - 0.235)], 0.01, 6));
        let reflector = Shape::rounded_block(vec3(0.006, 0.3, 0.03), 0.002).moved(at + vec3(-0.222, 0.0, -0.1));
        Shape::join([case, carrier.and(Shape::join(legs)).slot(parts.black), reflector.slot(parts.red)])
    }
}

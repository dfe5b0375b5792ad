//! Motorcycles and motor scooters.

use glam::{Quat, Vec3, vec3};

use super::parts::Parts;
use crate::people::Pose;
use crate::shape::{Blend, Limb, Shape};

/// How it is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motorcycle {
    /// Open engine, tank between the knees.
    Roadster,
    /// A fairing over the engine.
    Sports,
    /// Step-through, feet on a board.
    Scooter,
}

impl Motorcycle {
    fn wheelbase_m(self) -> f32 {
        if self == Self::Scooter { 1.3 } else { 1.42 }
    }

    fn wheel_m(self) -> (f32, f32) {
        if self == Self::Scooter { (0.24, 0.055) } else { (0.31, 0.07) }
    }

    fn grip(self) -> Vec3 {
        match self {
            Self::Roadster => vec3(0.98, 0.36, 1.04),
            Self::Sports => vec3(1.0, 0.31, 0.92),
            Self::Scooter => vec3(0.9, 0.3, 1.02),
        }
    }

    fn seat(self) -> Vec3 {
        match self {
            Self::Roadster => vec3(0.42, 0.0, 0.80),
            Self::Sports => vec3(0.38, 0.0, 0.83),
            Self::Scooter => vec3(0.28, 0.0, 0.79),
        }
    }

    /// Someone of a height sitting on it.
    pub(crate) fn pose(self, height_m: f32) -> Pose {
        let foot = match self {
            Self::Roadster => vec3(0.52, 0.2, 0.33),
            Self::Sports => vec3(0.36, 0.2, 0.38),
            Self::Scooter => vec3(0.72, 0.13, 0.29),
        };
        let ankle = |side: f32| foot * vec3(1.0, side, 1.0) + vec3(-0.05, 0.0, 0.05 * height_m);
        let wrist = |side: f32| self.grip() * vec3(1.0, side, 1.0) + vec3(-0.07, 0.0, 0.04);
        Pose {
            hips: self.seat() + vec3(0.0, 0.0, 0.1),
            lean_rad: match self {
                Self::Roadster => 0.25,
                Self::Sports => 0.6,
                Self::Scooter => 0.1,
            },
            ankles: [ankle(1.0), ankle(-1.0)],
            toes_rad: [0.1; 2],
            wrists: [wrist(1.0), wrist(-1.0)],
        }
    }

    pub(crate) fn build(self, parts: &Parts) -> Shape {
        let (r, tyre) = self.wheel_m();
        let (rear, front) = (vec3(0.0, 0.0, r), vec3(self.wheelbase_m(), 0.0, r));
        let grip = self.grip();
        let mut shapes = vec![
            parts.cast_wheel(r, tyre * 1.15).moved(rear),
            parts.cast_wheel(r, tyre).moved(front),
            self.body(parts),
        ];
        // Fork, bars and what hangs on them.
        let head = vec3(grip.x + 0.06, 0.0, grip.z - 0.08);
        let mut steel = Vec::new();
        for side in [1.0, -1.0] {
            let y = Vec3::Y * side * (tyre + 0.04);
            steel.push(Shape::tube(&[front + y, head + y * 0.8], 0.024, 10));
            let end = grip * vec3(1.0, side, 1.0);
            steel.push(Shape::tube(
                &[head, head + vec3(0.0, 0.12 * side, 0.07), end + vec3(0.05, -0.1 * side, 0.0)],
                0.012,
                8,
            ));
            shapes.push(
                Shape::capsule(end + vec3(0.03, -0.07 * side, 0.0), end - vec3(0.01, -0.02 * side, 0.0), 0.018, 8)
                    .slot(parts.black),
            );
            let stalk = head + vec3(-0.02, 0.26 * side, 0.1);
            let glass = stalk + vec3(-0.04, 0.1 * side, 0.17);
            steel.push(Shape::tube(&[stalk, glass], 0.006, 6));
            shapes.push(Shape::ellipsoid(vec3(0.02, 0.07, 0.045), 12).moved(glass).slot(parts.black));
            let blinker = Shape::ellipsoid(vec3(0.025, 0.03, 0.02), 8);
            shapes.push(blinker.clone().moved(head + vec3(0.08, 0.17 * side, -0.05)).slot(parts.amber));
            shapes.push(blinker.moved(vec3(-0.25, 0.14 * side, self.seat().z - 0.12)).slot(parts.amber));
        }
        let arc = |axle: Vec3, from: f32, to: f32| {
            let points = (0..=10).map(|i| from + (to - from) * i as f32 / 10.0);
            let arc: Vec<Vec3> = points.map(|a: f32| vec3(a.cos(), 0.0, a.sin()) * (r + 0.025)).collect();
            let row = |y: f32, scale: f32| arc.iter().map(|p| axle + *p * scale + Vec3::Y * y).collect::<Vec<_>>();
            let guard = Shape::sheet(&[row(-0.075, 0.88), row(-0.05, 1.0), row(0.05, 1.0), row(0.075, 0.88)]);
            guard.inside_out().plate(0.004)
        };
        shapes.push(arc(front, 0.7, 2.9).slot(parts.paint));
        shapes.push(arc(rear, 1.6, 3.3).slot(parts.black));
        let plate = Shape::rounded_block(vec3(0.01, 0.2, 0.14), 0.004).turned(Quat::from_rotation_y(0.35));
        shapes.push(plate.moved(vec3(-0.33, 0.0, 0.56)).slot(parts.plate));
        let exhaust = [
            (vec3(0.55, -0.14, 0.3), 0.025),
            (vec3(0.25, -0.17, 0.28), 0.03),
            (vec3(0.2, -0.18, 0.3), 0.055),
            (vec3(-0.28, -0.19, 0.42), 0.06),
        ];
        steel.push(Shape::tapered_tube(&exhaust, 14));
        shapes.push(Shape::join(steel).slot(parts.steel));
        Shape::join(shapes)
    }

    /// Engine, tank, seat, panels and lamps.
    fn body(self, parts: &Parts) -> Shape {
        let blend = |limbs: Vec<Limb>| Blend::new(limbs, 0.06).surface(0.032);
        let seat = self.seat();
        let head = self.grip() * vec3(1.0, 0.0, 1.0);
        let limb = Limb::new;
        if self == Self::Scooter {
            let tail = blend(vec![
                limb(vec3(0.45, 0.0, 0.55), vec3(-0.15, 0.0, 0.66), 0.14, 0.12).wide(Vec3::Y, 1.2),
                limb(vec3(0.4, 0.0, 0.36), vec3(0.2, 0.0, 0.45), 0.1, 0.11).wide(Vec3::Y, 1.3),
                limb(vec3(-0.1, 0.0, 0.68), vec3(-0.3, 0.0, 0.72), 0.1, 0.05).wide(Vec3::Y, 1.2),
            ]);
            let shield = blend(vec![
                limb(vec3(1.0, 0.0, 0.34), vec3(0.93, 0.0, 0.95), 0.07, 0.06).wide(Vec3::Y, 3.0),
                limb(vec3(0.9, 0.0, 1.0), vec3(0.98, 0.0, 0.98), 0.07, 0.07).wide(Vec3::Y, 2.2),
            ]);
            let board = Shape::rounded_block(vec3(0.78, 0.36, 0.09), 0.04).moved(vec3(0.64, 0.0, 0.27));
            let cushion = blend(vec![
                limb(seat + vec3(0.2, 0.0, -0.04), seat - vec3(0.2, 0.0, 0.03), 0.07, 0.075).wide(Vec3::Y, 1.8),
                limb(seat - vec3(0.15, 0.0, 0.02), seat - vec3(0.5, 0.0, 0.0), 0.07, 0.05).wide(Vec3::Y, 1.8),
            ]);
            let engine = Shape::rounded_block(vec3(0.42, 0.22, 0.2), 0.06).moved(vec3(0.12, 0.03, 0.3));
            let lamp = Shape::ellipsoid(vec3(0.05, 0.09, 0.06), 14).moved(vec3(1.02, 0.0, 0.97));
            let rear = Shape::ellipsoid(vec3(0.04, 0.08, 0.035), 12).moved(vec3(-0.34, 0.0, 0.7));
            return Shape::join([
                tail.and(shield).slot(parts.paint),
                Shape::join([board, cushion, engine]).slot(parts.black),
                lamp.slot(parts.lamp),
                rear.slot(parts.red),
            ]);
        }
        let tank = blend(vec![
            limb(seat + vec3(0.24, 0.0, 0.06), vec3(head.x - 0.18, 0.0, seat.z + 0.14), 0.09, 0.115)
                .wide(Vec3::Y, 1.35),
            limb(seat + vec3(-0.25, 0.0, -0.04), seat + vec3(-0.68, 0.0, 0.04), 0.07, 0.04).wide(Vec3::Y, 1.5),
            limb(seat + vec3(0.1, 0.0, -0.08), seat + vec3(-0.25, 0.0, -0.05), 0.06, 0.06).wide(Vec3::Y, 1.6),
        ]);
        let cushion = blend(vec![
            limb(seat + vec3(0.14, 0.0, -0.02), seat + vec3(-0.16, 0.0, -0.02), 0.05, 0.06).wide(Vec3::Y, 2.0),
            limb(seat + vec3(-0.22, 0.0, 0.03), seat + vec3(-0.5, 0.0, 0.05), 0.05, 0.045).wide(Vec3::Y, 2.0),
        ]);
        let engine = [
            Shape::rounded_block(vec3(0.42, 0.34, 0.24), 0.05).moved(vec3(0.62, 0.0, 0.34)),
            Shape::rounded_block(vec3(0.24, 0.3, 0.3), 0.03)
                .turned(Quat::from_rotation_y(0.4))
                .moved(vec3(0.78, 0.0, 0.55)),
            crate::vehicles::upright(Shape::cylinder(0.12, 0.4, 20)).moved(vec3(0.55, -0.2, 0.36)),
        ];
        let frame = [
            Shape::tube(
                &[vec3(0.0, 0.1, 0.31), vec3(0.4, 0.12, 0.42), vec3(0.48, 0.13, 0.7), head + vec3(0.0, 0.05, -0.15)],
                0.03,
                8,
            ),
            Shape::tube(&[vec3(0.45, 0.12, 0.35), vec3(0.95, 0.1, 0.4), head + vec3(0.02, 0.04, -0.2)], 0.02, 8),
        ];
        let mut shapes = vec![
            tank.slot(parts.paint),
            cushion.slot(parts.black),
            Shape::join(engine).slot(parts.steel),
            Shape::join(frame).both_sides().slot(parts.black),
            Shape::ellipsoid(vec3(0.03, 0.08, 0.03), 12).moved(seat + vec3(-0.7, 0.0, 0.04)).slot(parts.red),
        ];
        if self == Self::Sports {
            let fairing = blend(vec![
                limb(vec3(0.9, 0.0, 0.7), vec3(1.22, 0.0, 0.83), 0.2, 0.1).wide(Vec3::Y, 1.15),
                limb(vec3(1.0, 0.0, 0.6), vec3(0.55, 0.0, 0.37), 0.17, 0.11).wide(Vec3::Y, 1.15),
                limb(vec3(0.6, 0.0, 0.5), vec3(0.95, 0.0, 0.62), 0.14, 0.17).wide(Vec3::Y, 1.25),
                limb(vec3(1.15, 0.0, 0.85), vec3(1.34, 0.0, 0.78), 0.12, 0.05).wide(Vec3::Y, 1.5),
            ]);
            let screen = Shape::ellipsoid(vec3(0.2, 0.13, 0.1), 18).turned(Quat::from_rotation_y(0.5));
            let screen = screen.moved(vec3(1.08, 0.0, 0.96)).slot(parts.black);
            shapes.extend([fairing.slot(parts.paint), screen]);
            for side in [1.0, -1.0] {
                let lamp = Shape::ellipsoid(vec3(0.05, 0.06, 0.025), 12).moved(vec3(1.34, 0.075 * side, 0.81));
                shapes.push(lamp.slot(parts.lamp));
            }
        } else {
            let shell = Shape::ellipsoid(vec3(0.1, 0.1, 0.1), 16).moved(head + vec3(0.13, 0.0, -0.1)).slot(parts.black);
            let glass = Shape::ellipsoid(vec3(0.03, 0.09, 0.09), 16).moved(head + vec3(0.205, 0.0, -0.1));
            shapes.extend([shell, glass.slot(parts.lamp)]);
        }
        Shape::join(shapes)
    }
}

//! Bicycles.

use glam::{Quat, Vec3, vec3};

use super::parts::Parts;
use crate::people::Pose;
use crate::shape::Shape;

/// Measures of a bicycle; x = 0 is the rear axle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BicyclePlan {
    pub(crate) wheel_radius_m: f32,
    pub(crate) tyre_m: f32,
    /// Low entry, mudguards, basket, upright bars.
    pub(crate) city: bool,
}

impl BicyclePlan {
    const WHEELBASE_M: f32 = 1.04;
    const CRANK_M: f32 = 0.17;

    fn bracket(&self) -> Vec3 {
        vec3(0.43, 0.0, 0.28)
    }

    fn saddle(&self) -> Vec3 {
        vec3(if self.city { 0.16 } else { 0.2 }, 0.0, if self.city { 0.9 } else { 0.95 })
    }

    fn grip(&self) -> Vec3 {
        if self.city { vec3(0.64, 0.27, 1.1) } else { vec3(0.83, 0.28, 1.02) }
    }

    fn pedal(&self, side: f32) -> Vec3 {
        self.bracket()
            + vec3(0.05 * side, 0.12 * side, -0.162 * side).normalize() * Self::CRANK_M * vec3(1.0, 0.0, 1.0)
            + Vec3::Y * 0.13 * side
    }

    /// Someone of a height sitting on it.
    pub(crate) fn pose(&self, height_m: f32) -> Pose {
        let ankle = |side: f32| self.pedal(side) + vec3(-0.09, -0.02 * side, 0.055 + 0.035 * height_m);
        let wrist = |side: f32| self.grip() * vec3(1.0, side, 1.0) + vec3(-0.06, 0.0, 0.045);
        Pose {
            hips: self.saddle() + vec3(0.02, 0.0, 0.09),
            lean_rad: if self.city { 0.22 } else { 0.52 },
            ankles: [ankle(1.0), ankle(-1.0)],
            toes_rad: [0.15, 0.25],
            wrists: [wrist(1.0), wrist(-1.0)],
        }
    }

    pub(crate) fn build(&self, parts: &Parts) -> Shape {
        let r = self.wheel_radius_m;
        let (rear, front) = (vec3(0.0, 0.0, r), vec3(Self::WHEELBASE_M, 0.0, r));
        let (head_low, head_high) = (vec3(0.91, 0.0, 0.68), vec3(0.86, 0.0, 0.86));
        let (bracket, saddle) = (self.bracket(), self.saddle());
        let seat = bracket.lerp(saddle, 0.8);
        let tube = |a: Vec3, b: Vec3, radius: f32| Shape::tube(&[a, b], radius, 8);
        let mut frame = vec![
            tube(bracket, head_low, 0.02),
            tube(bracket, seat, 0.017),
            tube(head_low - (head_high - head_low) * 0.1, head_high, 0.021),
        ];
        let top =
            if self.city { (bracket.lerp(seat, 0.45), head_low + vec3(0.0, 0.0, 0.03)) } else { (seat, head_high) };
        frame.push(tube(top.0, top.1, 0.016));
        let mut metal = vec![tube(seat, saddle, 0.014)];
        for side in [1.0, -1.0] {
            let out = Vec3::Y * side * 0.055;
            frame.push(tube(bracket + out * 0.5, rear + out, 0.01));
            frame.push(tube(seat + out * 0.3, rear + out, 0.009));
            let crown = head_low - (head_high - head_low) * 0.12;
            frame.push(Shape::tube(&[crown + out * 0.2, crown + out - Vec3::Z * 0.03, front + out], 0.012, 8));
            let pedal = self.pedal(side);
            let crank = vec3(pedal.x, 0.07 * side, pedal.z);
            metal.push(tube(bracket + Vec3::Y * 0.06 * side, crank, 0.011));
            metal.push(tube(crank, pedal, 0.006));
        }
        metal.push(tube(head_high, head_high + vec3(-0.02, 0.0, self.grip().z - head_high.z - 0.02), 0.014));
        let grip = self.grip();
        let middle = head_high + vec3(-0.02, 0.0, grip.z - head_high.z - 0.02);
        let bend = if self.city { middle + vec3(0.04, 0.16, 0.05) } else { middle + vec3(0.03, 0.14, 0.01) };
        let mirrored = vec3(1.0, -1.0, 1.0);
        metal.push(Shape::tube(&[grip, bend, middle, bend * mirrored, grip * mirrored], 0.011, 8));
        let mut black = vec![
            Shape::ellipsoid(vec3(0.14, 0.085, 0.03), 14).moved(saddle + vec3(-0.03, 0.0, 0.0)),
            Shape::ellipsoid(vec3(0.12, 0.03, 0.022), 10).moved(saddle + vec3(0.09, 0.0, 0.005)),
        ];
        for side in [1.0, -1.0] {
            let end = grip * vec3(1.0, side, 1.0);
            black.push(Shape::capsule(end, end + vec3(0.07, -0.08 * side, -0.01), 0.017, 8));
            black.push(Shape::rounded_block(vec3(0.09, 0.08, 0.022), 0.008).moved(self.pedal(side)));
        }
        // Chain and its ring.
        let sprocket = crate::vehicles::upright(Shape::cylinder(0.095, 0.004, 24)).moved(bracket + Vec3::Y * -0.05);
        let chain = [vec3(0.0, -0.048, r + 0.035), bracket + vec3(0.0, -0.048, 0.092)];
        let lower = [vec3(0.0, -0.048, r - 0.035), bracket + vec3(0.0, -0.048, -0.092)];
        metal.push(sprocket);
        black.extend([Shape::tube(&chain, 0.006, 4), Shape::tube(&lower, 0.006, 4)]);
        let mut shapes = vec![
            parts.wire_wheel(r, self.tyre_m).moved(rear),
            parts.wire_wheel(r, self.tyre_m).moved(front),
            Shape::join(frame).slot(parts.paint),
        ];
        if self.city {
            for (axle, from, to) in [(rear, 0.3, 3.4), (front, 0.9, 3.6)] {
                let arc: Vec<Vec3> = (0..=12)
                    .map(|i| from + (to - from) * i as f32 / 12.0)
                    .map(|a: f32| axle + vec3(a.cos(), 0.0, a.sin()) * (r + 0.03))
                    .collect();
                let row =
                    |y: f32, drop: f32| arc.iter().map(|p| axle + (*p - axle) * drop + Vec3::Y * y).collect::<Vec<_>>();
                let guard = Shape::sheet(&[row(-0.03, 0.95), row(-0.018, 1.0), row(0.018, 1.0), row(0.03, 0.95)]);
                shapes.push(guard.inside_out().plate(0.002).slot(parts.paint));
            }
            let basket = Shape::rounded_block(vec3(0.26, 0.34, 0.22), 0.02).moved(head_high + vec3(0.2, 0.0, 0.06));
            shapes.push(basket.slot(parts.black));
            let rack = Shape::rounded_block(vec3(0.36, 0.12, 0.02), 0.006).moved(vec3(-0.06, 0.0, r + 0.42));
            shapes.push(rack.slot(parts.black));
            metal.push(tube(rear + Vec3::Y * 0.05, vec3(-0.1, 0.05, r + 0.42), 0.005));
            metal.push(tube(rear - Vec3::Y * 0.05, vec3(-0.1, -0.05, r + 0.42), 0.005));
        }
        let lamp = Shape::ellipsoid(vec3(0.03, 0.028, 0.028), 10).moved(head_high + vec3(0.05, 0.0, 0.02));
        let tail = Shape::rounded_block(vec3(0.02, 0.05, 0.04), 0.008).turned(Quat::from_rotation_y(0.2));
        shapes.extend([
            Shape::join(metal).slot(parts.steel),
            Shape::join(black).slot(parts.black),
            lamp.slot(parts.lamp),
            tail.moved(seat + vec3(-0.05, 0.0, 0.0)).slot(parts.red),
        ]);
        Shape::join(shapes)
    }
}

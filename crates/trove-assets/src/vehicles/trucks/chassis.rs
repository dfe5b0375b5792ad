//! Frames of lorries and trailers: rails, axles, tanks, guards, and what hangs at the back.

use std::f32::consts::PI;

use glam::{Quat, Vec3, vec2, vec3};

use crate::shape::{Shape, arc};
use crate::vehicles::decal::{HAZARD, RED_WHITE, slanted, tiled};
use crate::vehicles::wheel::{Rim, wheel};
use crate::vehicles::workshop::{Workshop, bar, block, tank};

/// A frame to build; distances are from the vehicle's front.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<'a> {
    pub(crate) from_m: f32,
    pub(crate) to_m: f32,
    /// Half the width over the tyres.
    pub(crate) half_m: f32,
    /// Top of the rails.
    pub(crate) deck_m: f32,
    pub(crate) wheel_m: f32,
    /// Axles with single tyres that steer.
    pub(crate) front_axles_m: &'a [f32],
    /// Axles at the back.
    pub(crate) rear_axles_m: &'a [f32],
    /// Whether those have twin tyres.
    pub(crate) twin: bool,
    /// Tank, boxes and guards between the axles.
    pub(crate) sides: bool,
    /// Stripes of the bar at the back: yellow and black, or red and white.
    pub(crate) hazard: bool,
}

impl Frame<'_> {
    /// Width of a tyre.
    fn tyre_m(&self) -> f32 {
        self.wheel_m * if self.twin { 0.5 } else { 0.7 }
    }

    pub(crate) fn build(&self, work: &mut Workshop) {
        self.rails(work);
        for &axle in self.front_axles_m {
            let width = self.wheel_m * 0.56;
            let at = vec3(-axle, self.half_m - width / 2.0, self.wheel_m);
            let front = wheel(&work.slots, self.wheel_m, width, Rim::Steel).moved(at);
            work.model.add_marked(front.both_sides());
            self.axle(work, axle, false);
        }
        for &axle in self.rear_axles_m {
            self.rear_wheels(work, axle);
            self.axle(work, axle, self.twin);
        }
        self.mudguards(work);
        if self.sides {
            self.between(work);
        }
        self.back(work);
    }

    fn rails(&self, work: &mut Workshop) {
        let (from, to) = (self.from_m + 0.1, self.to_m - 0.06);
        let (length, x) = (to - from, -(from + to) / 2.0);
        let (height, z) = (0.25, self.deck_m - 0.125);
        // A rail open to the inside: web and two flanges.
        work.pair(work.slots.frame, block([length, 0.012, height], [x, 0.43, z], 0.004));
        for dz in [-0.119, 0.119] {
            work.pair(work.slots.frame, block([length, 0.08, 0.012], [x, 0.396, z + dz], 0.004));
        }
        let members = (length / 0.9) as usize + 1;
        for i in 0..=members {
            let x = -from - length * i as f32 / members as f32;
            work.add(work.slots.frame, block([0.07, 0.84, 0.16], [x.clamp(-to + 0.04, -from - 0.04), 0.0, z], 0.01));
        }
        let air = self.to_m - 0.75;
        if air > self.from_m + 1.5 {
            work.add(work.slots.frame, tank(vec3(-air, -0.3, z - 0.24), vec3(-air, 0.3, z - 0.24), 0.12));
        }
    }

    fn rear_wheels(&self, work: &mut Workshop, axle: f32) {
        let (r, width) = (self.wheel_m, self.tyre_m());
        let rim = if self.twin { Rim::DeepSteel } else { Rim::Steel };
        let outer = wheel(&work.slots, r, width, rim).moved(vec3(-axle, self.half_m - width / 2.0, r));
        work.model.add_marked(outer.both_sides());
        if self.twin {
            let side = [
                (r * 0.6, 0.03),
                (r * 0.93, 0.0),
                (r, width * 0.13),
                (r, width * 0.87),
                (r * 0.93, width),
                (r * 0.6, width - 0.03),
            ];
            let inner = Shape::lathe(&side.map(|(radius, y)| vec2(radius, y)), 28).upright();
            work.pair(work.slots.rubber, inner.moved(vec3(-axle, self.half_m - width * 2.2, r)));
        }
    }

    /// Beam, springs, and for driven ones the differential and its shaft.
    fn axle(&self, work: &mut Workshop, axle: f32, driven: bool) {
        let (r, slots) = (self.wheel_m, work.slots);
        let reach = self.half_m - 0.2;
        work.add(slots.frame, Shape::tube(&[vec3(-axle, -reach, r), vec3(-axle, reach, r)], 0.075, 10));
        let spring: Vec<Vec3> = (0..=8)
            .map(|i| i as f32 / 4.0 - 1.0)
            .map(|t| vec3(-axle + t * 0.58, 0.48, r + 0.1 + 0.14 * t * t))
            .collect();
        let leaves = Shape::join((0..3).map(|k| {
            let shorter = 1.0 - 0.22 * k as f32;
            let path: Vec<Vec3> =
                spring.iter().map(|p| vec3(-axle + (p.x + axle) * shorter, p.y, p.z - 0.025 * k as f32)).collect();
            let row = |dy: f32| path.iter().map(|p| *p + Vec3::Y * dy).collect::<Vec<_>>();
            Shape::sheet(&[row(-0.04), row(0.04)]).plate(0.018)
        }));
        work.pair(slots.frame, leaves);
        if driven {
            let case = Shape::ellipsoid(vec3(0.24, 0.22, 0.24), 16).moved(vec3(-axle, 0.0, r));
            let shaft =
                Shape::tube(&[vec3(-axle + 0.2, 0.0, r + 0.05), vec3(-axle + 1.6, 0.0, self.deck_m - 0.2)], 0.05, 8);
            work.add(slots.frame, case.and(shaft));
        }
    }

    /// Guards over the rear wheels, flaps behind the last.
    fn mudguards(&self, work: &mut Workshop) {
        let (r, slots) = (self.wheel_m, work.slots);
        let (inner, outer) = (self.half_m - 0.6, self.half_m - 0.005);
        for (i, &axle) in self.rear_axles_m.iter().enumerate() {
            let last = i + 1 == self.rear_axles_m.len();
            let top = (self.deck_m - r - 0.03).min(r + 0.07);
            let flat = |p: Vec3| vec3(p.x, p.y, p.z.min(r + top));
            let row = |y: f32, radius: f32| -> Vec<Vec3> {
                arc(vec2(-axle, r), radius, 0.35, if last { PI + 0.1 } else { PI - 0.4 }, 12, y)
                    .into_iter()
                    .map(flat)
                    .collect()
            };
            let guard = Shape::sheet(&[row(inner, r + 0.07), row(outer, r + 0.07), row(outer, r + 0.04)]);
            work.pair(slots.trim, guard.plate(0.008));
            if last {
                let at = vec3(-axle - r - 0.08, (inner + outer) / 2.0, r * 0.74);
                work.pair(slots.rubber, Shape::block(vec3(0.014, outer - inner, r * 0.9)).moved(at));
                let spray = vec3(-axle - r - 0.09, (inner + outer) / 2.0, r * 0.55);
                work.pair(slots.white, Shape::block(vec3(0.004, (outer - inner) * 0.5, 0.06)).moved(spray));
            }
        }
    }

    /// Tank and boxes on the rails, rails that keep cyclists out.
    fn between(&self, work: &mut Workshop) {
        let (r, slots) = (self.wheel_m, work.slots);
        let front = self.front_axles_m.last().map_or(self.from_m, |a| a + r + 0.3).max(self.from_m + 0.05);
        let back = self.rear_axles_m.first().map_or(self.to_m, |a| a - r - 0.18);
        let room = back - front;
        if room < 0.5 {
            return;
        }
        let z = self.deck_m - 0.38;
        let size = (self.deck_m * 0.29).min(0.3);
        let length = (room * 0.45).min(1.3);
        let x = -front - length / 2.0 - 0.05;
        // Tank with straps and cap on one side, battery box and air tanks on the other.
        let y = self.half_m - size - 0.06;
        work.add(
            slots.alu,
            Shape::rounded_block(vec3(length, size * 2.0, size * 2.0), size * 0.42).moved(vec3(x, y, z)),
        );
        for t in [-0.3, 0.3] {
            let strap = Shape::rounded_block(vec3(0.05, size * 2.0 + 0.016, size * 2.0 + 0.016), size * 0.43);
            work.add(slots.frame, strap.moved(vec3(x + length * t, y, z)));
        }
        work.add(
            slots.trim,
            Shape::cylinder(0.055, 0.04, 12).upright().moved(vec3(
                x + length * 0.38,
                self.half_m - 0.07,
                z + size * 0.5,
            )),
        );
        work.add(slots.trim, block([length * 0.6, 0.5, 0.4], [x + length * 0.15, -self.half_m + 0.32, z + 0.02], 0.03));
        for dz in [-0.1, 0.13] {
            let ends = [x - length * 0.25, x - length * 0.25 - 0.55].map(|x| vec3(x, -self.half_m + 0.25, z + dz));
            work.add(slots.frame, tank(ends[1], ends[0], 0.11));
        }
        if room > 1.5 {
            let (from, to) = (-front - length - 0.25, -back + 0.04);
            for z in [0.42, 0.7] {
                work.pair(
                    slots.alu,
                    block(
                        [from - to, 0.025, 0.1],
                        [(from + to) / 2.0, self.half_m - 0.03, z * self.wheel_m / 0.48],
                        0.008,
                    ),
                );
            }
            for x in [from - 0.15, to + 0.2] {
                work.pair(
                    slots.frame,
                    block([0.05, 0.03, self.deck_m - 0.4], [x, self.half_m - 0.06, self.deck_m / 2.0 + 0.08], 0.005),
                );
            }
            let spare = Shape::cylinder(r * 0.95, 0.26, 24).upright().turned(Quat::from_rotation_x(PI / 2.0));
            if from - to > 2.2 * r {
                work.add(slots.rubber, spare.moved(vec3((from + to) / 2.0, 0.0, self.deck_m - 0.42)));
            }
        }
    }

    /// Bar against driving under, lamps, plate.
    fn back(&self, work: &mut Workshop) {
        let slots = work.slots;
        let x = -self.to_m + 0.06;
        let z = (self.deck_m * 0.46).max(0.36);
        let half = self.half_m - 0.03;
        work.add(slots.frame, block([0.09, half * 2.0, 0.12], [x, 0.0, z], 0.015));
        let colors = if self.hazard { HAZARD } else { RED_WHITE };
        let stripes = slanted(&mut work.model, if self.hazard { "hazard" } else { "red-white" }, colors);
        let face = Shape::sheet(&[
            vec![vec3(x - 0.047, half - 0.01, z - 0.05), vec3(x - 0.047, -half + 0.01, z - 0.05)],
            vec![vec3(x - 0.047, half - 0.01, z + 0.05), vec3(x - 0.047, -half + 0.01, z + 0.05)],
        ]);
        work.add(stripes, tiled(face, vec2(half * 2.0 / 0.2, 0.5)));
        for y in [0.42, half - 0.25] {
            work.pair(
                slots.frame,
                bar(vec3(x + 0.02, y, z), vec3(x + 0.12, y.min(0.45), self.deck_m - 0.1), 0.05, 0.08),
            );
        }
        // Clusters of lamps: blinker, tail and brake, reversing.
        let lamp_z = (z + 0.2).min(self.deck_m - 0.1);
        work.pair(slots.trim, block([0.07, 0.46, 0.15], [x - 0.005, half - 0.27, lamp_z], 0.02));
        for (k, slot) in [slots.amber, slots.red, slots.white].into_iter().enumerate() {
            for side in [1.0, -1.0] {
                let at = vec3(x - 0.042, side * (half - 0.12 - 0.145 * k as f32), lamp_z);
                work.tail_lens(slot, at, 0.058);
            }
        }
        work.number_plate(vec3(x - 0.02, 0.0, lamp_z - 0.01), false);
        work.pair(slots.trim, block([0.05, 0.05, 0.03], [x - 0.02, 0.14, lamp_z + 0.08], 0.01));
        work.pair(slots.red, block([0.012, 0.1, 0.05], [x - 0.046, half - 0.62, lamp_z], 0.004));
    }
}

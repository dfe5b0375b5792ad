//! Floor, seats, poles and who drives.

use glam::{Vec3, vec3};

use super::body::{BusPlan, SKIRT_M};
use crate::shape::Shape;
use crate::vehicles::workshop::{Workshop, block};

impl BusPlan {
    pub(super) fn inside(&self, work: &mut Workshop, ends: [bool; 2]) {
        let slots = work.slots;
        let half = self.half() - 0.09;
        let (from, to) = (if ends[0] { 0.45 } else { 0.1 }, self.length_m - if ends[1] { 0.35 } else { 0.1 });
        let (length, x) = (to - from, -(from + to) / 2.0);
        for (deck, &(low, high)) in self.decks.iter().enumerate() {
            let floor = if deck > 0 {
                low - 0.42
            } else if self.coach {
                low - 0.55
            } else {
                SKIRT_M + 0.1
            };
            work.add(slots.interior, block([length, half * 2.0, 0.05], [x, 0.0, floor], 0.01));
            let ceiling = if deck + 1 < self.decks.len() { high + 0.16 } else { self.roof() - 0.1 };
            let narrow = if deck + 1 < self.decks.len() { 0.0 } else { 0.24 };
            work.add(slots.white, block([length - 0.4, (half - narrow) * 2.0, 0.04], [x, 0.0, ceiling], 0.01));
            self.seats(work, deck, floor, [from, to], ends);
            if !self.coach {
                for y in [0.5, -0.5] {
                    let rail = [vec3(-from - 1.4, y, high - 0.12), vec3(-to + 0.4, y, high - 0.12)];
                    work.add(slots.yellow, Shape::tube(&rail, 0.017, 6));
                }
            }
        }
        if ends[0] {
            self.driver_seat(work, half);
        }
    }

    fn seats(&self, work: &mut Workshop, deck: usize, floor: f32, [from, to]: [f32; 2], ends: [bool; 2]) {
        let slots = work.slots;
        let half = self.half() - 0.09;
        let pitch = if self.coach { 0.82 } else { 0.86 };
        let mut s = from + if deck == 0 && ends[0] { 2.1 } else { 0.55 };
        let mut row = 0;
        while s < to - 0.5 {
            for side in [1.0, -1.0] {
                let at_door = deck == 0
                    && side == self.door_side
                    && self.doors_m.iter().any(|&(door, width)| s > door - 0.5 && s < door + width + 0.45);
                if at_door {
                    continue;
                }
                // Low floors have seats on pedestals over the wheels.
                let raised = !self.coach && deck == 0 && self.axles_m.iter().any(|a| (a - s).abs() < 0.75);
                let lift = if raised {
                    0.5
                } else if self.coach || deck > 0 {
                    0.0
                } else {
                    0.12
                };
                let at = vec3(-s, side * (half - 0.46), floor + 0.44 + lift);
                let cushion = Shape::block(vec3(0.44, 0.88, 0.1)).moved(at);
                let back = Shape::rounded_block(vec3(0.09, 0.86, 0.7), 0.04).moved(at + vec3(-0.22, 0.0, 0.36));
                work.add(slots.seat_cloth, cushion.and(back));
                work.add(slots.interior, block([0.3, 0.5, at.z - floor], [at.x, at.y, (at.z + floor) / 2.0], 0.0));
                if !self.coach && row % 2 == 0 {
                    let y = side * (half - 0.94);
                    let top = self.decks[deck].1 - 0.1;
                    let pole = [vec3(-s - 0.22, y, floor), vec3(-s - 0.22, y, top)];
                    work.add(slots.yellow, Shape::tube(&pole, 0.017, 5));
                }
            }
            s += pitch;
            row += 1;
        }
    }

    fn driver_seat(&self, work: &mut Workshop, half: f32) {
        let slots = work.slots;
        let low = self.front_low_m;
        let y = -self.door_side * (half - 0.52);
        let hips = vec3(-1.28, y, low + 0.12);
        work.seat(hips - Vec3::Z * 0.1, 0.52);
        let wheel = vec3(-0.78, y, low + 0.36);
        work.steering_wheel(wheel, 0.24, 0.35);
        work.driver(hips, wheel);
        work.add(slots.interior, block([0.4, half * 1.85, 0.22], [-0.42, 0.0, low - 0.08], 0.06));
        work.add(slots.interior, block([0.3, 0.75, 0.34], [-0.5, y, low + 0.08], 0.06));
        // The wall behind the driver, half of it glass.
        let floor = SKIRT_M + 0.12;
        work.add(slots.interior, block([0.04, 0.95, low + 0.35 - floor], [-1.72, y, (low + 0.35 + floor) / 2.0], 0.01));
        work.add(slots.interior, block([0.9, 0.9, low - 0.3 - floor], [-1.25, y, (low - 0.3 + floor) / 2.0], 0.02));
    }
}

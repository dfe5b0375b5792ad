//! What a frame carries: floors, boxes, drop sides, tipping bodies.

use glam::{Vec3, vec2, vec3};

use crate::shape::{Prism, Shape, pane, rect};
use crate::vehicles::coverings::metric;
use crate::vehicles::decal::{RED_WHITE, on_side, slanted, tiled, writing};
use crate::vehicles::hull::{Section, lying};
use crate::vehicles::workshop::{Workshop, bar, block};

/// A body on a frame: between two distances from the front, up to a height.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bed {
    pub(crate) from: f32,
    pub(crate) to: f32,
    pub(crate) half: f32,
    /// Its lower edge.
    pub(crate) deck: f32,
    pub(crate) top: f32,
}

impl Bed {
    pub(crate) fn length(&self) -> f32 {
        self.to - self.from
    }

    pub(crate) fn middle(&self) -> f32 {
        -(self.from + self.to) / 2.0
    }

    /// Top of the floor.
    pub(crate) fn floor_top(&self) -> f32 {
        self.deck + 0.16
    }

    /// Cross beams, floor with an edge, marker lamps.
    pub(crate) fn floor(&self, work: &mut Workshop, slot: u16) {
        let slots = work.slots;
        work.add(slot, block([self.length(), self.half * 2.0, 0.14], [self.middle(), 0.0, self.deck + 0.08], 0.012));
        let boards = Shape::block(vec3(self.length() - 0.06, self.half * 2.0 - 0.06, 0.02));
        work.add(slots.boards, metric(boards.moved(vec3(self.middle(), 0.0, self.floor_top() - 0.005))));
        let beams = (self.length() / 0.55) as usize + 1;
        for i in 0..=beams {
            let x = -self.from - 0.06 - (self.length() - 0.12) * i as f32 / beams as f32;
            work.add(slots.frame, block([0.06, self.half * 1.96, 0.1], [x, 0.0, self.deck - 0.03], 0.008));
        }
        self.marker_lamps(work, self.deck + 0.08);
    }

    /// Amber side lamps and a strip that reflects.
    pub(crate) fn marker_lamps(&self, work: &mut Workshop, z: f32) {
        let count = (self.length() / 2.2).ceil().max(2.0) as usize;
        for i in 0..count {
            let x = -self.from - self.length() * (i as f32 + 0.5) / count as f32;
            work.pair(work.slots.amber, block([0.1, 0.012, 0.035], [x, self.half + 0.003, z], 0.005));
        }
    }

    /// A strip of red and white along the sides and across the back.
    pub(crate) fn tape(&self, work: &mut Workshop, z: f32) {
        let slot = slanted(&mut work.model, "red-white", RED_WHITE);
        for side in [1.0, -1.0] {
            let strip =
                on_side(side, vec3(self.middle(), side * (self.half + 0.004), z), vec2(self.length() - 0.2, 0.05));
            work.add(slot, tiled(strip, vec2(self.length() / 0.6, 0.08)));
        }
    }

    /// A closed box with rails along its edges, doors with rods, hinges and lamps, and on some a name.
    pub(crate) fn closed(&self, work: &mut Workshop, name: &str) {
        let slots = work.slots;
        let (low, high) = (self.deck + 0.1, self.top);
        let height = high - low;
        let shell = Shape::rounded_block(vec3(self.length() - 0.03, self.half * 2.0 - 0.02, height - 0.02), 0.02);
        let shell = shell.moved(vec3(self.middle(), 0.0, (low + high) / 2.0));
        work.add(slots.panel, metric(shell));
        self.floor(work, slots.alu);
        // Rails along the edges: round in front, square elsewhere.
        let (front, back) = (-self.from, -self.to);
        for z in [low + 0.06, high - 0.05] {
            work.pair(slots.alu, block([self.length(), 0.03, 0.12], [self.middle(), self.half - 0.012, z], 0.012));
            work.add(slots.alu, block([0.03, self.half * 2.0, 0.12], [front - 0.012, 0.0, z], 0.012));
            work.add(slots.alu, block([0.05, self.half * 2.0, 0.1], [back + 0.022, 0.0, z], 0.01));
        }
        work.pair(
            slots.alu,
            Shape::tube(
                &[vec3(front - 0.05, self.half - 0.045, low), vec3(front - 0.05, self.half - 0.045, high - 0.03)],
                0.05,
                12,
            ),
        );
        work.pair(slots.alu, block([0.07, 0.07, height], [back + 0.032, self.half - 0.032, (low + high) / 2.0], 0.012));
        self.doors(work, low + 0.1, high - 0.09);
        self.tape(work, low - 0.02);
        for y in [self.half - 0.16, 0.22, -0.22, -self.half + 0.16] {
            let slot = if y.abs() > 0.5 { slots.red } else { slots.amber };
            work.add(slot, block([0.02, 0.1, 0.035], [back - 0.005, y, high - 0.05], 0.006));
        }
        if !name.is_empty() {
            self.name(work, name, ((low + high) / 2.0 + height * 0.12, height * 0.2));
        }
    }

    /// A name on both sides, on two of five.
    pub(crate) fn name(&self, work: &mut Workshop, name: &str, (z, size): (f32, f32)) {
        let inks = [vec3(0.02, 0.06, 0.25), vec3(0.4, 0.02, 0.02), vec3(0.02, 0.02, 0.022), vec3(0.02, 0.2, 0.08)];
        let (slot, aspect) = writing(&mut work.model, name, &inks);
        let height = size.min(self.length() * 0.8 / aspect);
        let both = [1.0, -1.0].map(|side| {
            on_side(side, vec3(self.middle(), side * (self.half + 0.002), z), vec2(height * aspect, height))
        });
        work.model.add_extra("name", 0.4, false, Shape::join(both).slot(slot));
    }

    /// Two leaves at the back with four rods.
    pub(crate) fn doors(&self, work: &mut Workshop, low: f32, high: f32) {
        let slots = work.slots;
        let x = -self.to;
        work.add(slots.seam, block([0.006, 0.014, high - low], [x + 0.006, 0.0, (low + high) / 2.0], 0.002));
        work.add(slots.seam, block([0.006, self.half * 1.88, 0.014], [x + 0.006, 0.0, low], 0.002));
        for y in [self.half * 0.62, self.half * 0.2] {
            let rod = Shape::tube(&[vec3(x - 0.018, y, low - 0.07), vec3(x - 0.018, y, high + 0.03)], 0.015, 8);
            work.pair(slots.steel, rod);
            for t in [0.03, 0.35, 0.68, 0.97] {
                work.pair(slots.steel, block([0.03, 0.07, 0.045], [x - 0.006, y, low + (high - low) * t], 0.008));
            }
            work.pair(slots.steel, block([0.022, 0.24, 0.03], [x - 0.034, y + 0.1, low + 0.42], 0.008));
        }
        for i in 0..4 {
            let z = low + (high - low) * (0.1 + 0.27 * i as f32);
            work.pair(slots.steel, block([0.02, 0.16, 0.06], [x - 0.004, self.half - 0.11, z], 0.008));
        }
        for y in [-self.half * 0.42, self.half * 0.42] {
            work.add(slots.rubber, block([0.06, 0.14, 0.1], [x, y, low - 0.2], 0.02));
        }
    }

    /// A cooling unit on the front wall.
    pub(crate) fn cooler(&self, work: &mut Workshop) {
        let slots = work.slots;
        let (z, x) = (self.top - 0.5, -self.from + 0.17);
        let case = lying(&[
            Section { x: x - 0.2, z, half: vec2(0.86, 0.42), corner: 0.06 },
            Section { x: x + 0.1, z, half: vec2(0.85, 0.41), corner: 0.14 },
            Section { x: x + 0.2, z: z - 0.02, half: vec2(0.78, 0.34), corner: 0.16 },
        ]);
        let grille = rect(-0.66, 0.66, z - 0.28, z + 0.02);
        let case = case.slot(slots.white).mark(&Prism::front(&pane(&grille, 0.06), x - 0.05..=x + 0.4), slots.seam);
        work.model.add_marked(case);
        for i in 0..6 {
            work.add(slots.trim, block([0.02, 1.3, 0.018], [x + 0.2, 0.0, z - 0.25 + 0.05 * i as f32], 0.005));
        }
    }

    /// Sides that fold down, of planks, with posts and latches; `gap` leaves the back open.
    pub(crate) fn drop_sides(&self, work: &mut Workshop, height_m: f32, slot: u16, open_back: bool) {
        let slots = work.slots;
        let low = self.floor_top();
        let planks = (height_m / 0.2).round().max(1.0) as usize;
        let each = height_m / planks as f32;
        for k in 0..planks {
            let z = low + each * (k as f32 + 0.5);
            work.pair(
                slot,
                block([self.length() - 0.02, 0.03, each - 0.008], [self.middle(), self.half - 0.018, z], 0.01),
            );
            if !open_back {
                work.add(slot, block([0.03, self.half * 1.96, each - 0.008], [-self.to + 0.018, 0.0, z], 0.01));
            }
        }
        let bays = (self.length() / 1.6).round().max(2.0) as usize;
        for i in 0..=bays {
            let x = -self.from - 0.05 - (self.length() - 0.1) * i as f32 / bays as f32;
            let post = block([0.08, 0.045, height_m + 0.22], [x, self.half - 0.012, low + height_m / 2.0 - 0.08], 0.01);
            work.pair(slots.steel, post);
            if i < bays {
                let x = x - self.length() / bays as f32 / 2.0;
                work.pair(slots.frame, block([0.05, 0.03, 0.14], [x, self.half, low + 0.02], 0.008));
            }
        }
    }

    /// The wall behind the cab.
    pub(crate) fn headboard(&self, work: &mut Workshop, height_m: f32, slot: u16) {
        let (low, x) = (self.floor_top(), -self.from - 0.03);
        work.add(
            slot,
            metric(Shape::rounded_block(vec3(0.04, self.half * 1.98, height_m), 0.012).moved(vec3(
                x,
                0.0,
                low + height_m / 2.0,
            ))),
        );
        for y in [-0.8, -0.27, 0.27, 0.8] {
            work.add(
                work.slots.steel,
                block([0.05, 0.06, height_m], [x + 0.03, y * self.half, low + height_m / 2.0], 0.01),
            );
        }
        work.add(work.slots.steel, block([0.07, self.half * 2.0, 0.07], [x, 0.0, low + height_m], 0.015));
    }

    /// Sides of profiled steel that lean outwards, ribs, a guard over the cab, a ram; gravel in most.
    pub(crate) fn tipper(&self, work: &mut Workshop) {
        let slots = work.slots;
        let (low, high) = (self.deck + 0.12, self.top);
        let (front, back) = (-self.from, -self.to);
        let wall = high - low;
        let inside = |z: f32| self.half - 0.07 - 0.1 * (1.0 - ((z - low) / wall).min(1.0)).powi(2);
        // The tub as one skin, out and in.
        let ring = |z: f32, inset: f32, y: f32| -> Vec<Vec3> {
            let (a, b, h) = (front - inset, back + inset, y);
            vec![vec3(a, -h, z), vec3(a, h, z), vec3(b, h, z), vec3(b, -h, z)]
        };
        let shell = Shape::loft(&[
            ring(low, 0.1, inside(low) - 0.06),
            ring(low + 0.12, 0.0, inside(low) + 0.03),
            ring(high, 0.0, self.half - 0.03),
            ring(high, 0.06, self.half - 0.09),
            ring(low + 0.2, 0.06, inside(low) - 0.05),
            ring(low + 0.1, 0.12, inside(low) - 0.12),
        ]);
        work.add(slots.second, shell.smooth(0.15));
        let ribs = (self.length() / 0.62).round() as usize;
        for i in 0..=ribs {
            let x = front - 0.05 - (self.length() - 0.1) * i as f32 / ribs as f32;
            let rib = bar(vec3(x, inside(low) + 0.03, low + 0.08), vec3(x + 0.001, self.half - 0.025, high), 0.1, 0.05);
            work.pair(slots.second, rib);
        }
        work.pair(
            slots.second,
            block([self.length(), 0.09, 0.11], [self.middle(), self.half - 0.05, high - 0.03], 0.02),
        );
        work.pair(slots.second, block([self.length(), 0.07, 0.09], [self.middle(), inside(low), low + 0.08], 0.02));
        // Tailgate with its hinges and its own ribs.
        for y in [-0.66, -0.22, 0.22, 0.66] {
            work.add(
                slots.second,
                block([0.05, 0.09, wall - 0.14], [back - 0.02, y * self.half, (low + high) / 2.0], 0.01),
            );
        }
        for z in [low + 0.12, high - 0.06] {
            work.add(slots.second, block([0.06, self.half * 1.9, 0.1], [back - 0.02, 0.0, z], 0.01));
        }
        work.pair(slots.steel, block([0.16, 0.05, 0.16], [back + 0.03, self.half - 0.12, high + 0.02], 0.02));
        // Guard over the cab.
        let guard = [
            vec3(front - 0.01, 0.0, high - 0.05),
            vec3(front + 0.04, 0.0, high + 0.12),
            vec3(front + 0.12, 0.0, high + 0.17),
            vec3(front + 0.8, 0.0, high + 0.2),
        ];
        let row = |y: f32| guard.iter().map(|p| *p + Vec3::Y * y).collect::<Vec<_>>();
        work.add(slots.second, Shape::sheet(&[row(-self.half * 0.92), row(self.half * 0.92)]).plate(-0.03));
        // Frame below, ram.
        work.pair(slots.frame, block([self.length(), 0.1, 0.14], [self.middle(), 0.42, self.deck + 0.05], 0.01));
        for i in 0..ribs {
            let x = front - self.length() * (i as f32 + 0.5) / ribs as f32;
            work.add(slots.frame, block([0.08, self.half * 1.7, 0.1], [x, 0.0, low - 0.02], 0.01));
        }
        let ram =
            Shape::tube(&[vec3(front + 0.03, 0.0, self.deck - 0.3), vec3(front + 0.03, 0.0, high - 0.1)], 0.09, 14);
        work.add(slots.paint, ram);
        self.marker_lamps(work, low + 0.08);
    }
}

//! Bodies of lorries that do more than carry: tankers, mixers, refuse collectors, fire engines, tractors.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec2, Vec3, vec2, vec3};

use super::bed::Bed;
use crate::shape::{Prism, Shape, arc, pane, rect};
use crate::vehicles::coverings::metric;
use crate::vehicles::decal::{HAZARD, on_back, on_side, slanted, tiled, writing};
use crate::vehicles::hull::{Section, lying};
use crate::vehicles::workshop::{Workshop, bar, block, cut_out};

impl Bed {
    /// A ladder on the back, from one height to another.
    fn ladder(&self, work: &mut Workshop, x: f32, y: f32, low: f32, high: f32) {
        for dy in [-0.19, 0.19] {
            work.add(work.slots.steel, Shape::tube(&[vec3(x, y + dy, low), vec3(x, y + dy, high)], 0.016, 6));
        }
        let rungs = ((high - low) / 0.3) as usize;
        for i in 0..=rungs {
            let z = low + 0.05 + 0.3 * i as f32;
            work.add(work.slots.steel, Shape::tube(&[vec3(x, y - 0.19, z), vec3(x, y + 0.19, z)], 0.013, 6));
        }
    }

    /// An elliptic tank with domed ends, rings, manholes, a walkway, pipes, and the orange plates of dangerous goods.
    pub(crate) fn tank(&self, work: &mut Workshop, slot: u16) {
        let slots = work.slots;
        let (half, radius) = (self.half - 0.06, (self.top - self.deck - 0.2) / 2.0);
        let z = self.deck + 0.08 + radius;
        let section =
            |x: f32, share: f32| Section { x, z, half: vec2(half, radius) * share, corner: radius * share * 0.93 };
        let (a, b) = (-self.to + 0.1, -self.from - 0.1);
        let ends = [(0.0, 0.55), (0.05, 0.78), (0.14, 0.92), (0.26, 0.985), (0.34, 1.0)];
        let sections: Vec<Section> = ends
            .iter()
            .map(|&(d, s)| section(a + d, s))
            .chain(ends.iter().rev().map(|&(d, s)| section(b - d, s)))
            .collect();
        work.add(slot, metric(lying(&sections)));
        let rings = (self.length() / 1.9).round() as usize;
        for i in 0..=rings {
            let x = a + 0.4 + (b - a - 0.8) * i as f32 / rings as f32;
            work.add(slots.alu, lying(&[section(x - 0.035, 1.006), section(x + 0.035, 1.006)]));
            if i < rings {
                let lid = vec3(x + (b - a - 0.8) / rings as f32 / 2.0, 0.0, z + radius - 0.02);
                work.add(slots.steel, Shape::cylinder(0.25, 0.1, 20).moved(lid));
                work.add(slots.alu, Shape::cylinder(0.2, 0.13, 16).moved(lid));
            }
        }
        // Walkway with its rail, ladder, cradle, cabinet of valves.
        work.pair(slots.alu, block([b - a - 0.8, 0.05, 0.1], [(a + b) / 2.0, 0.42, z + radius + 0.02], 0.01));
        self.ladder(work, a - 0.03, 0.4, self.deck - 0.15, self.top + 0.05);
        for i in 0..=3 {
            let x = a + 0.6 + (b - a - 1.2) * i as f32 / 3.0;
            let cradle = pane(
                &[
                    vec2(-half * 0.8, self.deck),
                    vec2(half * 0.8, self.deck),
                    vec2(half * 0.92, z - radius * 0.3),
                    vec2(-half * 0.92, z - radius * 0.3),
                ],
                0.05,
            );
            let plate = Shape::extruded(&cradle, 0.05)
                .turned(Quat::from_rotation_z(PI / 2.0) * Quat::from_rotation_x(PI / 2.0));
            work.add(slots.frame, plate.moved(vec3(x, 0.0, 0.0)));
        }
        let x = (a + b) / 2.0;
        work.pair(slots.alu, block([1.3, 0.3, 0.5], [x - 0.8, self.half - 0.2, self.deck - 0.16], 0.04));
        work.pair(slots.alu, block([b - a - 0.4, 0.16, 0.05], [x, self.half - 0.08, self.deck + 0.14], 0.015));
        work.pair(
            slots.trim,
            Shape::tube(
                &[vec3(a + 0.3, self.half - 0.1, self.deck), vec3(x - 1.6, self.half - 0.1, self.deck)],
                0.07,
                10,
            ),
        );
        self.marker_lamps(work, self.deck + 0.14);
        self.tape(work, z - radius * 0.2);
        let orange = vec3(0.72, 0.2, 0.01);
        let (plate, figures) = (
            work.model.slot(trove_model::Material::plain("orange plate", orange, 0.5), &[]),
            writing(&mut work.model, "30/1202", &[Vec3::splat(0.012)]),
        );
        work.add(plate, block([0.01, 0.4, 0.3], [-self.to + 0.02, -0.5, self.deck - 0.02], 0.002));
        work.add(figures.0, on_back(vec3(-self.to + 0.012, -0.5, self.deck - 0.02), vec2(0.36, 0.36 / figures.1)));
    }

    /// A tilted drum with a spiral, its water tank, chutes and ladder.
    pub(crate) fn mixer(&self, work: &mut Workshop) {
        let slots = work.slots;
        let (front, back) = (-self.from, -self.to);
        let length = self.length();
        let tilt = 0.165;
        let radius = (self.half - 0.06).min((self.top - self.deck) * 0.41);
        // Radius along the drum's axis, from its drive to its mouth.
        let profile: [(f32, f32); 11] = [
            (0.0, 0.0),
            (0.42, 0.0),
            (0.62, 0.05),
            (0.93, 0.2),
            (1.0, 0.36),
            (0.985, 0.52),
            (0.78, 0.78),
            (0.5, 0.985),
            (0.47, 1.0),
            (0.44, 1.0),
            (0.4, 0.93),
        ];
        let reach = length * 0.92;
        let dense: Vec<Vec2> = profile
            .windows(2)
            .flat_map(|w| {
                let [(r0, t0), (r1, t1)] = [w[0], w[1]];
                let steps = 1 + ((t1 - t0).abs() * 14.0) as usize;
                (0..steps).map(move |i| {
                    let u = i as f32 / steps as f32;
                    vec2((r0 + (r1 - r0) * u) * radius, (t0 + (t1 - t0) * u) * reach)
                })
            })
            .chain([vec2(0.4 * radius, 0.93 * reach)])
            .collect();
        let place = |s: Shape| {
            let lying = s.turned(Quat::from_rotation_y(-PI / 2.0 + tilt));
            lying.moved(vec3(front - 0.1, 0.0, self.deck + 0.08 + radius * 0.98))
        };
        let mut drum = Shape::lathe(&dense, 32).smooth(0.8).slot(slots.second);
        // Stripes of the other paint, wound around like the blades inside.
        for k in 0..2 {
            let t = 0.3 + 0.34 * k as f32;
            let band = Prism::top(&rect(-3.0, 3.0, -3.0, 3.0), t * reach..=(t + 0.1) * reach);
            drum = drum.mark(&band, slots.paint);
        }
        work.model.add_marked(place(drum));
        let spiral = |phase: f32| -> Shape {
            let path: Vec<Vec3> = (0..=32)
                .map(|i| {
                    let t = 0.22 + 0.7 * i as f32 / 32.0;
                    let r = dense.windows(2).find(|w| w[1].y >= t * reach).map_or(0.5, |w| {
                        let u = ((t * reach - w[0].y) / (w[1].y - w[0].y).max(1e-4)).clamp(0.0, 1.0);
                        w[0].x + (w[1].x - w[0].x) * u
                    });
                    let a = phase + t * TAU * 2.1;
                    vec3(a.cos() * r, a.sin() * r, t * reach)
                })
                .collect();
            Shape::tube(&path, 0.018, 5)
        };
        work.add(slots.second, place(spiral(0.0).and(spiral(PI))));
        let ring = Shape::lathe(
            &[
                vec2(radius * 0.8, 0.745 * reach),
                vec2(radius * 0.86, 0.745 * reach),
                vec2(radius * 0.86, 0.785 * reach),
                vec2(radius * 0.78, 0.785 * reach),
            ],
            36,
        );
        work.add(slots.steel, place(ring));
        // Stands in front and behind, rollers.
        let axis = |t: f32| {
            vec3(front - 0.1, 0.0, self.deck + 0.08 + radius * 0.98) + vec3(-(tilt.cos()), 0.0, tilt.sin()) * reach * t
        };
        let nose = axis(0.0);
        work.add(
            slots.frame,
            block([0.36, 0.7, nose.z - self.deck + 0.2], [nose.x + 0.02, 0.0, (nose.z + self.deck) / 2.0], 0.05),
        );
        work.add(slots.paint, Shape::tube(&[nose + vec3(0.18, 0.0, 0.0), axis(0.05)], radius * 0.36, 18));
        let rear = axis(0.765);
        let low = rear.z - radius * 0.82;
        for y in [-0.5, 0.5] {
            work.add(slots.frame, bar(vec3(rear.x + 0.5, y, self.deck), vec3(rear.x, y * 1.1, low + 0.16), 0.12, 0.14));
            work.add(slots.frame, bar(vec3(rear.x - 0.5, y, self.deck), vec3(rear.x, y * 1.1, low + 0.16), 0.12, 0.14));
            work.add(
                slots.steel,
                Shape::tube(
                    &[vec3(rear.x - 0.12, y * 1.1, low + 0.2), vec3(rear.x + 0.12, y * 1.1, low + 0.2)],
                    0.11,
                    14,
                ),
            );
        }
        work.add(slots.frame, block([0.2, 1.2, 0.16], [rear.x, 0.0, self.deck + 0.1], 0.02));
        // Hopper above the mouth, chute below it.
        let mouth = axis(1.0);
        let funnel = [
            (mouth.x + 0.35, mouth.z + 0.78),
            (mouth.x - 0.42, mouth.z + 0.78),
            (mouth.x - 0.12, mouth.z + 0.1),
            (mouth.x + 0.16, mouth.z + 0.3),
        ];
        let funnel = cut_out(&funnel.map(|(x, z)| vec2(x, z.min(self.top))), 0.7);
        work.add(slots.second, funnel);
        for y in [-0.42, 0.42] {
            work.add(
                slots.frame,
                bar(vec3(back + 0.12, y, self.deck), vec3(mouth.x + 0.05, y, mouth.z + 0.4), 0.09, 0.09),
            );
        }
        let chute: Vec<Vec<Vec3>> =
            [(mouth.x - 0.08, mouth.z - 0.2), (mouth.x - 0.2, mouth.z - 0.5), (back + 0.02, self.deck + 0.26)]
                .iter()
                .map(|&(x, z)| {
                    (0..=8)
                        .map(|i| PI * (1.0 + i as f32 / 8.0))
                        .map(|a| vec3(x + 0.1 * a.sin(), 0.27 * a.cos(), z + 0.27 * a.sin() + 0.2))
                        .collect()
                })
                .collect();
        work.add(slots.second, Shape::sheet(&chute).plate(0.012));
        work.add(slots.second, block([0.7, 0.06, 0.34], [back + 0.55, self.half - 0.14, self.deck + 0.22], 0.03));
        self.ladder(work, back + 0.06, -0.62, self.deck - 0.25, mouth.z + 0.25);
        work.add(slots.steel, block([0.5, 0.62, 0.03], [back + 0.3, -0.6, mouth.z - 0.05], 0.01));
        // Water tank, wings over the wheels.
        let water = crate::vehicles::workshop::tank(
            vec3(front - 0.36, -0.85, self.deck + 0.36),
            vec3(front - 0.36, -0.2, self.deck + 0.36),
            0.26,
        );
        work.add(slots.alu, water);
        work.pair(
            slots.paint,
            block([length * 0.62, 0.5, 0.03], [back + length * 0.36, self.half - 0.26, self.deck + 0.1], 0.012),
        );
        work.pair(
            slots.paint,
            block([length * 0.62, 0.02, 0.16], [back + length * 0.36, self.half - 0.02, self.deck + 0.03], 0.008),
        );
        self.marker_lamps(work, self.deck + 0.04);
    }

    /// A pressing body with a tail that lifts bins.
    pub(crate) fn refuse(&self, work: &mut Workshop) {
        let slots = work.slots;
        let (low, high, h) = (self.deck + 0.02, self.top, self.half);
        let (front, tail) = (-self.from, -self.to + 1.75);
        let section = |x: f32, inset: f32| Section {
            x,
            z: (low + high) / 2.0,
            half: vec2(h - 0.02 - inset, (high - low) / 2.0 - inset),
            corner: 0.3,
        };
        work.add(
            slots.second,
            lying(&[section(tail - 0.02, 0.0), section(front - 0.1, 0.0), section(front - 0.02, 0.06)]),
        );
        let ribs = ((front - tail) / 0.75).round() as usize;
        for i in 0..=ribs {
            let x = tail + 0.06 + (front - 0.16 - tail) * i as f32 / ribs as f32;
            let rib = Section { x: x - 0.035, half: vec2(h + 0.004, (high - low) / 2.0 + 0.02), ..section(x, 0.0) };
            work.add(slots.second, lying(&[rib, Section { x: x + 0.035, ..rib }]));
        }
        // The tail: its side view, thinner in the hopper.
        let outline = [
            vec2(tail - 0.02, low + 0.1),
            vec2(tail - 0.02, high + 0.02),
            vec2(tail - 0.55, high + 0.05),
            vec2(-self.to + 0.55, high - 0.35),
            vec2(-self.to + 0.24, low + 1.15),
            vec2(-self.to + 0.08, low + 0.3),
            vec2(-self.to + 0.14, low - 0.3),
            vec2(-self.to + 0.6, low - 0.42),
            vec2(tail - 0.5, low - 0.3),
        ];
        let mut body = cut_out(&outline, h * 2.0 - 0.06).slot(slots.second);
        // The mouth of the hopper.
        let mouth = rect(-h + 0.14, h - 0.14, low + 0.28, low + 1.28);
        body = body.mark(&Prism::front(&pane(&mouth, 0.08), -self.to - 0.1..=-self.to + 0.6), slots.seam);
        work.model.add_marked(body);
        let edge: Vec<Vec3> = outline[2..7].iter().map(|p| vec3(p.x - 0.012, h - 0.06, p.y)).collect();
        work.pair(slots.second, Shape::tube(&edge, 0.05, 6));
        let hazard = slanted(&mut work.model, "hazard", HAZARD);
        let strip = on_back(vec3(-self.to + 0.07, 0.0, low + 0.16), vec2(h * 1.8, 0.16));
        work.add(hazard, tiled(strip, vec2(h * 1.8 / 0.3, 0.55)));
        let lifter = vec3(-self.to + 0.1, 0.0, low + 0.02);
        work.add(slots.frame, block([0.12, h * 1.5, 0.12], [lifter.x, 0.0, lifter.z - 0.1], 0.02));
        for k in 0..8 {
            let y = -h * 0.7 + h * 1.4 * k as f32 / 7.0;
            work.add(slots.steel, block([0.1, 0.03, 0.14], [lifter.x - 0.05, y, lifter.z - 0.02], 0.008));
        }
        for side in [1.0, -1.0] {
            let y = side * (h - 0.05);
            let ram = [vec3(tail + 0.1, y, high - 0.25), vec3(-self.to + 0.62, y, low + 0.9)];
            work.add(slots.chrome, Shape::tube(&ram, 0.035, 10));
            work.add(slots.second, Shape::tube(&[ram[0], ram[0].lerp(ram[1], 0.6)], 0.06, 12));
            // Where the men stand.
            work.add(slots.steel, block([0.42, 0.4, 0.04], [-self.to + 0.22, side * (h - 0.22), 0.48], 0.01));
            work.add(
                slots.frame,
                bar(
                    vec3(-self.to + 0.4, side * (h - 0.22), 0.5),
                    vec3(-self.to + 0.5, side * (h - 0.22), low - 0.2),
                    0.05,
                    0.05,
                ),
            );
            let grip = [
                vec3(-self.to + 0.28, y, low + 0.95),
                vec3(-self.to + 0.14, y + 0.02 * side, low + 0.85),
                vec3(-self.to + 0.1, y + 0.02 * side, low + 0.5),
            ];
            work.add(slots.yellow, Shape::tube(&grip, 0.016, 6));
            work.tail_lens(slots.red, vec3(-self.to + 0.4, side * (h - 0.2), high - 0.42), 0.06);
            work.tail_lens(slots.amber, vec3(-self.to + 0.46, side * (h - 0.36), high - 0.36), 0.06);
        }
        work.beacon(vec3(tail - 0.3, 0.7, high + 0.03));
        work.beacon(vec3(tail - 0.3, -0.7, high + 0.03));
        self.tape(work, low + 0.04);
        let (slot, aspect) = writing(&mut work.model, "KEEP IT CLEAN", &[Vec3::splat(0.7), Vec3::splat(0.03)]);
        let height = ((front - tail) * 0.7 / aspect).min(0.42);
        let both = [1.0, -1.0].map(|s| {
            on_side(
                s,
                vec3((front + tail) / 2.0, s * (h + 0.008), (low + high) / 2.0 + 0.3),
                vec2(height * aspect, height),
            )
        });
        work.model.add_extra("name", 0.5, false, Shape::join(both).slot(slot));
    }

    /// Lockers with shutters, hose fittings, a ladder on the roof, bands that shine.
    pub(crate) fn fire(&self, work: &mut Workshop) {
        let slots = work.slots;
        let (low, high, h) = (self.deck - 0.38, self.top, self.half);
        let (front, back) = (-self.from, -self.to);
        let section = |x: f32, inset: f32| Section {
            x,
            z: (low + high) / 2.0,
            half: vec2(h - inset, (high - low) / 2.0 - inset),
            corner: 0.09,
        };
        let mut body =
            lying(&[section(back, 0.03), section(back + 0.04, 0.0), section(front - 0.03, 0.0), section(front, 0.02)])
                .slot(slots.paint);
        let shutters = 3;
        let room = (self.length() - 0.24) / shutters as f32;
        for k in 0..shutters {
            let (a, b) = (front - 0.12 - room * k as f32, front - 0.12 - room * (k as f32 + 1.0));
            // The middle one is shorter: there the wheel is.
            let foot = if k == 1 { self.deck + 0.35 } else { low + 0.12 };
            let hole = rect(b + 0.06, a - 0.06, foot, high - 0.2);
            body = body.mark_both(&Prism::side(&pane(&hole, 0.03), 0.4..=3.0), slots.trim);
            work.slats_both((hole[0] + hole[2]) / 2.0, h + 0.002, hole[2] - hole[0] - vec2(0.06, 0.06));
            work.pair(slots.steel, block([0.5, 0.03, 0.03], [(a + b) / 2.0, h + 0.02, foot + 0.07], 0.01));
        }
        let shutter = rect(-0.62, 0.62, low + 0.3, high - 0.3);
        body = body.mark(&Prism::front(&pane(&shutter, 0.03), back - 0.2..=back + 0.05), slots.trim);
        work.model.add_marked(body);
        work.add(
            slots.slats,
            metric(Shape::block(vec3(0.02, 1.16, high - low - 0.68)).moved(vec3(
                back - 0.004,
                0.0,
                (low + high) / 2.0,
            ))),
        );
        // White and yellow bands.
        let hull = self.length();
        for side in [1.0, -1.0] {
            work.add(
                slots.white,
                Shape::block(vec3(hull - 0.1, 0.006, 0.14)).moved(vec3(self.middle(), side * (h + 0.001), high - 0.11)),
            );
            work.add(
                slots.yellow,
                Shape::block(vec3(hull - 0.1, 0.006, 0.05)).moved(vec3(self.middle(), side * (h + 0.002), high - 0.2)),
            );
        }
        let chevron = slanted(&mut work.model, "red-yellow", [vec3(0.42, 0.012, 0.014), vec3(0.62, 0.52, 0.02)]);
        for side in [1.0, -1.0] {
            let strip = on_back(vec3(back - 0.003, side * 0.92, (low + high) / 2.0), vec2(0.46, high - low - 0.3));
            work.add(chevron, tiled(strip, vec2(1.5, (high - low) / 0.3)));
        }
        let (slot, aspect) = writing(&mut work.model, "FIRE", &[vec3(0.7, 0.7, 0.68)]);
        for side in [1.0, -1.0] {
            let at = vec3(self.middle(), side * (h + 0.007), high - 0.11);
            work.add(slots.paint, Shape::block(vec3(0.14 * aspect, 0.008, 0.14)).moved(at));
            work.add(slot, on_side(side, at + Vec3::Y * side * 0.006, vec2(0.12 * aspect, 0.12)));
        }
        // Roof: a rail, the ladder, boxes, blue lamps.
        work.pair(
            slots.alu,
            Shape::tube(&[vec3(back + 0.1, h - 0.08, high + 0.16), vec3(front - 0.1, h - 0.08, high + 0.16)], 0.02, 6),
        );
        for i in 0..=4 {
            let x = back + 0.1 + (self.length() - 0.2) * i as f32 / 4.0;
            work.pair(
                slots.alu,
                Shape::tube(&[vec3(x, h - 0.08, high - 0.02), vec3(x, h - 0.08, high + 0.16)], 0.016, 6),
            );
        }
        let length = self.length() * 1.05;
        for y in [0.18, 0.62] {
            work.add(slots.alu, block([length, 0.05, 0.09], [self.middle() - 0.05, y, high + 0.26], 0.015));
        }
        for i in 0..(length / 0.3) as usize {
            let x = self.middle() - 0.05 - length / 2.0 + 0.15 + 0.3 * i as f32;
            work.add(slots.alu, Shape::tube(&[vec3(x, 0.18, high + 0.26), vec3(x, 0.62, high + 0.26)], 0.016, 6));
        }
        work.add(slots.alu, block([1.4, 0.7, 0.3], [self.middle() - 0.5, -0.5, high + 0.14], 0.03));
        work.add(slots.alu, block([0.8, 0.6, 0.24], [front - 0.8, -0.5, high + 0.11], 0.03));
        self.tape(work, low + 0.05);
    }

    /// Coupling plate, walkway, air hoses and wings of a tractor.
    pub(crate) fn fifth_wheel(&self, work: &mut Workshop, coupling_m: f32, wheel_m: f32, axles: &[f32]) {
        let slots = work.slots;
        let x = -coupling_m;
        let mut plate = Shape::cylinder(0.47, 0.07, 28);
        plate = plate.and(block([0.5, 0.7, 0.07], [-0.42, 0.0, 0.035], 0.02));
        work.add(slots.frame, plate.turned(Quat::from_rotation_y(-0.06)).moved(vec3(x, 0.0, self.deck + 0.12)));
        work.pair(slots.frame, block([0.7, 0.1, 0.16], [x, 0.4, self.deck + 0.06], 0.02));
        work.add(slots.steel, metric(block([1.1, 0.86, 0.03], [-self.from - 0.62, 0.0, self.deck + 0.02], 0.006)));
        // Coiled hoses on a bracket behind the cab.
        for (k, slot) in [slots.red, slots.yellow, slots.trim].into_iter().enumerate() {
            let y = -0.16 + 0.16 * k as f32;
            let coil: Vec<Vec3> = (0..=70)
                .map(|i| {
                    let (t, a) = (i as f32 / 70.0, i as f32 * 0.9);
                    vec3(
                        -self.from - 0.12 - 0.035 * a.cos() - 0.3 * t,
                        y + 0.035 * a.sin(),
                        self.deck + 1.0 - 0.35 * (PI * t).sin(),
                    )
                })
                .collect();
            work.add(slot, Shape::tube(&coil, 0.009, 5));
        }
        work.add(slots.frame, block([0.06, 0.6, 0.9], [-self.from - 0.08, 0.0, self.deck + 0.55], 0.02));
        for &axle in axles {
            let row = |y: f32, r: f32| arc(vec2(-axle, wheel_m), r, 0.1, PI - 0.1, 12, y);
            let r = wheel_m + 0.09;
            let wing = Shape::sheet(&[
                row(self.half - 0.58, r),
                row(self.half - 0.03, r),
                row(self.half, r - 0.03),
                row(self.half, r - 0.1),
            ]);
            work.pair(slots.trim, wing.plate(0.01));
        }
    }
}

impl Workshop {
    /// Shutters of slats on both sides about (x, z).
    fn slats_both(&mut self, at: Vec2, y: f32, size: Vec2) {
        let sheet = metric(Shape::block(vec3(size.x, 0.016, size.y)).moved(vec3(at.x, y, at.y)));
        self.pair(self.slots.slats, sheet);
    }

    /// A light bar of blue lamps across a roof.
    pub(crate) fn blue_lights(&mut self, at: Vec3, width_m: f32) {
        let blue = trove_model::Material {
            coat: 1.0,
            ..trove_model::Material::plain("blue light", vec3(0.01, 0.06, 0.6), 0.2)
        };
        let blue = self.model.slot(blue, &[]);
        self.add(self.slots.trim, block([0.24, width_m, 0.06], [at.x, at.y, at.z + 0.03], 0.02));
        for side in [-1.0, 1.0] {
            self.add(
                blue,
                block([0.27, width_m * 0.36, 0.14], [at.x, at.y + side * width_m * 0.31, at.z + 0.11], 0.05),
            );
        }
        self.add(self.slots.white, block([0.22, width_m * 0.24, 0.12], [at.x, at.y, at.z + 0.1], 0.03));
    }
}

//! Canvas: over bows with the curtains drawn up, as curtain sides, over hoops.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::Seed;

use super::bed::Bed;
use crate::shape::{Prism, Shape, rect};
use crate::vehicles::coverings::metric;
use crate::vehicles::decal::{HAZARD, decal, on_back, slanted, tiled, writing};
use crate::vehicles::workshop::{Workshop, bar, block};

/// Distance between the bows below a canvas.
const BAY_M: f32 = 1.15;

impl Bed {
    fn bays(&self) -> f32 {
        (self.length() / BAY_M).round().max(2.0)
    }

    /// Cloth over a cross section (y, z) from the left hem to the right one; it sags between bows by `sag_m`.
    fn cloth(&self, profile: &[Vec2], sag_m: f32, overhang_m: f32) -> Shape {
        let bays = self.bays();
        let steps = bays as usize * 6;
        let (from, length) = (-self.to - overhang_m, self.length() + overhang_m * 2.0);
        let middle = vec2(0.0, self.deck + 0.6);
        let mut random = Seed(0xc107).nth((self.to * 100.0) as u64).random();
        let rows: Vec<Vec<Vec3>> = (0..=steps)
            .map(|i| {
                let t = i as f32 / steps as f32;
                let sag = sag_m * (PI * t * bays).sin().powi(2);
                let flutter = random.range(-0.014, 0.014) as f32;
                let last = profile.len() - 1;
                let place = |(k, p): (usize, &Vec2)| {
                    let hem = k == 0 || k == last;
                    let p = *p + (middle - *p).normalize_or_zero() * if hem { sag * 0.3 } else { sag };
                    let fold = if hem { vec2(flutter * p.x.signum(), flutter) } else { Vec2::ZERO };
                    vec3(from + length * t, p.x + fold.x, p.y + fold.y)
                };
                profile.iter().enumerate().map(place).collect()
            })
            .collect();
        metric(Shape::sheet(&rows).smooth(0.9))
    }

    /// A bow from side to side below the canvas, at every bay.
    fn bows(&self, work: &mut Workshop, profile: &[Vec2], radius_m: f32) {
        let bays = self.bays() as usize;
        let path = |x: f32| profile.iter().map(|p| vec3(x, p.x * 0.985, p.y - 0.03)).collect::<Vec<_>>();
        let bows = (0..=bays).map(|i| {
            Shape::tube(&path(-self.from - 0.06 - (self.length() - 0.12) * i as f32 / bays as f32), radius_m, 6)
        });
        work.add(work.slots.steel, Shape::join(bows));
    }

    /// Low sides and posts under a canvas roof whose curtains are drawn up, a tail lift at the back.
    pub(crate) fn canopy(&self, work: &mut Workshop) {
        let slots = work.slots;
        self.floor(work, slots.steel);
        self.drop_sides(work, 0.62, slots.alu, true);
        self.headboard(work, self.top - self.floor_top() - 0.12, slots.panel);
        let h = self.half;
        let top = self.top;
        let roof =
            [(h + 0.012, top - 0.24), (h + 0.015, top - 0.1), (h - 0.01, top - 0.03), (h - 0.08, top), (h * 0.4, top)];
        let roof: Vec<Vec2> = roof
            .iter()
            .map(|&(y, z)| vec2(y, z))
            .chain([vec2(0.0, top)])
            .chain(roof.iter().rev().map(|&(y, z)| vec2(-y, z)))
            .collect();
        let cloth = self.cloth(&roof, 0.035, 0.05);
        work.add(slots.canvas, cloth);
        self.bows(work, &roof[3..8], 0.02);
        // Purlins, and the edge that the curtains hang from.
        for y in [0.0, h * 0.5] {
            work.pair(slots.steel, block([self.length(), 0.04, 0.05], [self.middle(), y, top - 0.06], 0.008));
        }
        work.pair(slots.alu, block([self.length(), 0.04, 0.12], [self.middle(), h - 0.045, top - 0.13], 0.01));
        work.add(slots.alu, block([0.06, h * 2.0, 0.1], [-self.to + 0.02, 0.0, top - 0.05], 0.015));
        // Posts, and curtains rolled up between them.
        for i in 0..=2 {
            let x = -self.from - 0.05 - (self.length() - 0.1) * i as f32 / 2.0;
            work.pair(
                slots.steel,
                block([0.09, 0.07, top - self.deck - 0.2], [x, h - 0.045, (top + self.deck) / 2.0], 0.012),
            );
        }
        let mut random = Seed(0x3011).random();
        for side in [1.0, -1.0] {
            let steps = 44;
            let path: Vec<(Vec3, f32)> = (0..=steps)
                .map(|i| {
                    let t = i as f32 / steps as f32;
                    let hung = 0.06 * (TAU * 1.5 * t).sin().powi(2);
                    let radius = 0.085 + random.range(-0.014, 0.014) as f32;
                    (vec3(-self.from - self.length() * t, side * (h - 0.06), top - 0.27 - hung), radius)
                })
                .collect();
            work.add(slots.canvas, metric(Shape::tapered_tube(&path, 9).smooth(1.2)));
            for i in 1..8 {
                let x = -self.from - self.length() * i as f32 / 8.0;
                let strap = block([0.03, 0.012, 0.3], [x, side * (h + 0.035), top - 0.3], 0.003);
                work.add(slots.trim, strap);
            }
        }
        // The rear curtain, rolled up too.
        let path: Vec<(Vec3, f32)> = (0..=14)
            .map(|i| {
                (
                    vec3(-self.to - 0.02, h * (1.0 - i as f32 / 7.0), top - 0.24),
                    0.075 + random.range(-0.012, 0.012) as f32,
                )
            })
            .collect();
        work.add(slots.canvas, metric(Shape::tapered_tube(&path, 9).smooth(1.2)));
        self.tail_lift(work, "SUNRISE FOODS");
    }

    /// The platform of a tail lift, folded up, with its ram, its stripes and its lamps.
    pub(crate) fn tail_lift(&self, work: &mut Workshop, name: &str) {
        let slots = work.slots;
        let (low, high) = (self.deck - 0.06, (self.deck + 1.62).min(self.top - 0.35));
        let x = -self.to - 0.055;
        let panel = Shape::rounded_block(vec3(0.06, self.half * 1.98, high - low), 0.018)
            .moved(vec3(x, 0.0, (low + high) / 2.0))
            .slot(slots.alu);
        let mut panel = panel;
        for z in [low + 0.14, high - 0.36] {
            panel = panel.mark(&Prism::front(&rect(-3.0, 3.0, z, z + 0.008), x - 0.2..=x), slots.trim);
        }
        for y in [-0.55, 0.55] {
            panel =
                panel.mark(&Prism::front(&rect(y - 0.004, y + 0.004, low + 0.1, high - 0.3), x - 0.2..=x), slots.trim);
        }
        work.model.add_marked(panel);
        // A box with the control's flap on either side, round stickers of speed and length.
        let back = x - 0.032;
        for side in [1.0, -1.0] {
            let y = side * self.half * 0.78;
            work.add(slots.cargo, block([0.05, 0.2, 0.26], [back - 0.01, y, high - 0.5], 0.015));
            let stripes = slanted(&mut work.model, "hazard-white", [vec3(0.6, 0.42, 0.1), vec3(0.6, 0.58, 0.54)]);
            let size = vec2(0.12, 0.62);
            let flag = decal(vec3(back - 0.002, side * self.half * 0.56, low + 0.5), Vec3::Y * -side, Vec3::Z, size);
            let flag = if side > 0.0 { flag } else { flag.inside_out() };
            work.add(stripes, tiled(flag, vec2(0.6, 3.0)));
            let sticker = Shape::cylinder(0.075, 0.004, 20).turned(Quat::from_rotation_y(-PI / 2.0));
            work.add(if side > 0.0 { slots.white } else { slots.yellow }, sticker.moved(vec3(back, y, low + 0.26)));
            work.add(
                slots.red,
                Shape::ellipsoid(vec3(0.01, 0.035, 0.035), 12).moved(vec3(back, side * (self.half - 0.1), low + 0.3)),
            );
            let (figure, aspect) = writing(&mut work.model, if side > 0.0 { "60" } else { "45" }, &[Vec3::splat(0.02)]);
            work.add(figure, on_back(vec3(back - 0.006, y, low + 0.26), vec2(0.085 * aspect, 0.085)));
            // Arms and hinges.
            let y = side * self.half * 0.56;
            work.add(slots.frame, bar(vec3(x + 0.02, y, low + 0.06), vec3(x + 0.5, y, low - 0.34), 0.07, 0.09));
            work.add(slots.steel, block([0.1, 0.14, 0.12], [x - 0.005, y, low + 0.04], 0.02));
        }
        work.add(
            slots.steel,
            Shape::tube(&[vec3(x, -self.half * 0.62, low - 0.08), vec3(x, self.half * 0.62, low - 0.08)], 0.035, 10),
        );
        // The rail that swings out.
        let rail = [(0.42, 0.5), (0.42, 0.06), (0.36, 0.0), (0.0, 0.0), (-0.06, 0.06), (-0.06, 0.5)];
        let rail: Vec<Vec3> = rail.iter().map(|&(y, z)| vec3(back - 0.035, y + 0.1, high - 0.44 + z)).collect();
        work.add(slots.steel, Shape::tube(&rail, 0.014, 6));
        if !name.is_empty() {
            let (slot, aspect) = writing(&mut work.model, name, &[vec3(0.45, 0.05, 0.03)]);
            let height = (self.half * 1.0 / aspect).min(0.34);
            work.add(slot, on_back(vec3(back - 0.004, -0.05, low + 0.85), vec2(height * aspect, height)));
        }
        let bumper = slanted(&mut work.model, "hazard", HAZARD);
        let strip = on_back(vec3(back - 0.003, 0.0, low + 0.035), vec2(self.half * 1.0, 0.05));
        work.add(bumper, tiled(strip, vec2(self.half * 5.0, 0.25)));
    }

    /// Curtains with folds, held by straps with buckles, under a hard roof; doors behind.
    pub(crate) fn curtains(&self, work: &mut Workshop, name: &str) {
        let slots = work.slots;
        let (low, high, h) = (self.deck + 0.1, self.top, self.half);
        self.floor(work, slots.alu);
        self.headboard(work, high - self.floor_top(), slots.panel);
        work.add(
            slots.panel,
            metric(block([self.length(), h * 2.0 - 0.04, 0.05], [self.middle(), 0.0, high - 0.03], 0.02)),
        );
        work.pair(slots.alu, block([self.length(), 0.05, 0.16], [self.middle(), h - 0.01, high - 0.085], 0.015));
        work.add(
            slots.panel,
            metric(block([0.04, h * 1.96, high - low], [-self.to + 0.03, 0.0, (low + high) / 2.0], 0.01)),
        );
        work.pair(slots.alu, block([0.1, 0.08, high - low], [-self.to + 0.05, h - 0.035, (low + high) / 2.0], 0.012));
        work.pair(slots.alu, block([0.1, 0.08, high - low], [-self.from - 0.05, h - 0.035, (low + high) / 2.0], 0.012));
        let (bottom, top) = (low - 0.04, high - 0.15);
        let columns = (self.length() / 0.12) as usize;
        let mut random = Seed(0xc0).nth((self.to * 100.0) as u64).random();
        let waves: Vec<f32> = (0..=columns).map(|_| random.range(-1.0, 1.0) as f32).collect();
        let wave = |i: usize| {
            let x = self.length() * i as f32 / columns as f32;
            0.011 * (TAU * x / 0.62).sin() + 0.006 * waves[i]
        };
        let row = |t: f32| -> Vec<Vec3> {
            let loose = 0.25 + 0.75 * (PI * t.powf(0.7)).sin();
            (0..=columns)
                .map(|i| {
                    let x = -self.to + 0.1 + (self.length() - 0.2) * i as f32 / columns as f32;
                    vec3(x, -h - 0.004 - wave(i) * loose, bottom + (top - bottom) * t)
                })
                .collect()
        };
        let curtain = Shape::sheet(&[0.0, 0.05, 0.3, 0.65, 1.0].map(row)).smooth(1.0);
        work.pair(slots.canvas, metric(curtain));
        let straps = (self.length() / 0.6).round() as usize;
        for i in 1..straps {
            let x = -self.from - self.length() * i as f32 / straps as f32;
            work.pair(slots.trim, block([0.045, 0.012, top - bottom], [x, h + 0.02, (top + bottom) / 2.0], 0.004));
            work.pair(slots.steel, block([0.06, 0.025, 0.12], [x, h + 0.024, bottom + 0.06], 0.008));
        }
        self.doors(work, low + 0.08, high - 0.1);
        self.tape(work, low - 0.02);
        if !name.is_empty() {
            self.name_on(work, name);
        }
    }

    fn name_on(&self, work: &mut Workshop, name: &str) {
        let wider = Self { half: self.half + 0.024, ..*self };
        let height = self.top - self.deck;
        wider.name(work, name, (self.deck + height * 0.62, height * 0.24));
    }

    /// Canvas over round hoops, tied down over drop sides with a rope; closed in front, a flap at the back.
    pub(crate) fn hoops(&self, work: &mut Workshop) {
        let slots = work.slots;
        self.floor(work, slots.steel);
        self.drop_sides(work, 0.5, slots.boards, false);
        self.headboard(work, 0.7, slots.boards);
        let (h, hem, top) = (self.half + 0.02, self.floor_top() + 0.34, self.top);
        let spring = top - 0.42;
        let arch = (0..=10).map(|i| PI * i as f32 / 10.0).map(|a| {
            // Flatter than a circle on top.
            vec2(h * a.cos().signum() * a.cos().abs().powf(0.75), spring + (top - spring) * a.sin().max(0.0).powf(0.85))
        });
        let profile: Vec<Vec2> = [vec2(h + 0.01, hem), vec2(h, (hem + spring) / 2.0)]
            .into_iter()
            .chain(arch)
            .chain([vec2(-h, (hem + spring) / 2.0), vec2(-h - 0.01, hem)])
            .collect();
        let cloth = self.cloth(&profile, 0.045, 0.01);
        work.add(slots.canvas, cloth);
        self.bows(work, &profile, 0.018);
        for (x, sign) in [(-self.from, 1.0), (-self.to, -1.0)] {
            let inner: Vec<Vec3> = profile.iter().map(|p| vec3(x + 0.03 * sign, p.x * 0.98, p.y - 0.015)).collect();
            let mut wall: Vec<Vec<Vec3>> = Vec::new();
            for t in [0.0, 0.25, 0.5, 0.75, 1.0] {
                // Rows from hem to hem, drawn towards the middle of the hem's height.
                let sag = -0.05 * sign * (PI * t).sin();
                wall.push(inner.iter().map(|p| vec3(p.x + sag, p.y, hem + (p.z - hem) * t)).collect());
            }
            let wall = Shape::sheet(&wall).smooth(0.9);
            work.add(slots.canvas, metric(if sign > 0.0 { wall.inside_out() } else { wall }));
        }
        // Rope and eyes.
        let eyes = self.bays() as usize * 4;
        for side in [1.0, -1.0] {
            let rope: Vec<Vec3> = (0..=eyes)
                .map(|i| {
                    let x = -self.from - 0.03 - (self.length() - 0.06) * i as f32 / eyes as f32;
                    let z = if i % 2 == 0 { hem + 0.05 } else { hem - 0.2 };
                    vec3(x, side * (h + 0.018), z)
                })
                .collect();
            work.add(slots.white, Shape::tube(&rope, 0.006, 4));
            for p in rope.iter().step_by(2) {
                work.add(slots.steel, Shape::ellipsoid(vec3(0.022, 0.008, 0.022), 8).moved(*p));
            }
        }
        for y in [-0.45, 0.45] {
            let path = [hem - 0.1, spring, top - 0.1].map(|z| vec3(-self.to - 0.035, y, z));
            work.add(slots.trim, Shape::tube(&path, 0.014, 4));
        }
    }
}

//! A bus's hull with its windows, doors and wheels.

use std::f32::consts::PI;

use glam::{Vec2, Vec3, vec2, vec3};

use crate::shape::{Prism, Shape, pane, rect, shrunk};
use crate::vehicles::hull::{Hull, Row, arch};
use crate::vehicles::wheel::{Rim, wheel};
use crate::vehicles::workshop::{Workshop, block};

/// A bus to build; x = 0 is its front.
#[derive(Clone, Copy, Debug)]
pub(super) struct BusPlan {
    pub(super) length_m: f32,
    pub(super) width_m: f32,
    pub(super) height_m: f32,
    /// Distances from the front; the first one's wheels steer.
    pub(super) axles_m: &'static [f32],
    /// Lower and upper edges of the rows of windows.
    pub(super) decks: &'static [(f32, f32)],
    /// Doors: distance from the front and width.
    pub(super) doors_m: &'static [(f32, f32)],
    /// Which side the doors are on: 1 left, −1 right; the driver sits on the other.
    pub(super) door_side: f32,
    /// Lower edge of the windscreen.
    pub(super) front_low_m: f32,
    /// What its displays say.
    pub(super) route: &'static str,
    /// High floor, luggage below, seats in rows.
    pub(super) coach: bool,
    pub(super) wheel_m: f32,
}

/// Lower edge of the body.
pub(super) const SKIRT_M: f32 = 0.3;

impl BusPlan {
    pub(super) fn half(&self) -> f32 {
        self.width_m / 2.0
    }

    /// Top of the roof's skin; units stand on it.
    pub(super) fn roof(&self) -> f32 {
        self.height_m - if self.decks.len() > 1 || self.coach { 0.04 } else { 0.2 }
    }

    pub(super) fn build(&self, work: &mut Workshop) {
        self.piece(work, 0.0, [true, true]);
    }

    /// A hull that begins at x, with a front, with a back.
    pub(super) fn piece(&self, work: &mut Workshop, x: f32, ends: [bool; 2]) {
        // Built with its front at the origin: what is there already goes out of its way and comes back.
        work.model.shift(Vec3::X * -x);
        let hull = self.hull(ends);
        let mut skin = hull.skin().slot(work.slots.paint);
        skin = self.livery(work, skin);
        skin = self.windows(work, skin, ends);
        skin = self.doors(work, skin);
        if ends[0] {
            skin = self.front(work, &hull, skin);
        }
        if ends[1] {
            skin = self.back(work, &hull, skin);
        }
        self.wheels(work, &mut skin, ends);
        work.model.add_marked(skin);
        self.inside(work, ends);
        self.roof_units(work, ends);
        work.model.shift(Vec3::X * x);
    }

    /// A tall rounded hull, its ends bowed where they are seen.
    pub(super) fn hull(&self, ends: [bool; 2]) -> Hull {
        let (half, top) = (self.half(), self.roof());
        let bow = [if ends[0] { 0.16 } else { 0.0 }, if ends[1] { 0.07 } else { 0.0 }];
        let corner = [if ends[0] { 0.22 } else { 0.05 }, if ends[1] { 0.16 } else { 0.05 }];
        let rake = if !ends[0] {
            0.0
        } else if self.coach {
            0.42
        } else {
            0.14
        };
        let back_rake = if !ends[1] { 0.0 } else { 0.09 };
        let low = self.front_low_m;
        let row = |z: f32, inset: f32, t: f32, over: f32| Row {
            z,
            front: -rake * t - over * f32::from(u8::from(ends[0])),
            back: -self.length_m + back_rake * t + over * 0.6 * f32::from(u8::from(ends[1])),
            half: half - inset,
            corner,
            bow,
        };
        let at = |z: f32| ((z - low) / (top - low)).max(0.0).powf(1.5);
        Hull::new(vec![
            row(SKIRT_M, 0.04, 0.0, 0.05),
            row(SKIRT_M + 0.03, 0.012, 0.0, 0.015),
            row(SKIRT_M + 0.1, 0.0, 0.0, 0.0),
            row(low, 0.0, 0.0, 0.0),
            row(low + (top - low) * 0.3, 0.005, at(low + (top - low) * 0.3), 0.0),
            row(low + (top - low) * 0.6, 0.025, at(low + (top - low) * 0.6), 0.0),
            row(top - 0.36, 0.05, at(top - 0.36), 0.0),
            row(top - 0.2, 0.075, at(top - 0.2), 0.02),
            row(top - 0.1, 0.125, at(top - 0.1), 0.06),
            row(top - 0.035, 0.21, at(top - 0.035), 0.13),
            row(top - 0.008, 0.34, 1.0, 0.22),
            row(top, 0.6, 1.0, 0.36),
        ])
    }

    /// A band along the skirt, a swoosh at the back.
    fn livery(&self, work: &mut Workshop, skin: Shape) -> Shape {
        let side = |polygon: &[Vec2]| Prism::side(polygon, 0.4..=3.0);
        let (l, low) = (self.length_m, self.decks[0].0);
        let slots = work.slots;
        let band = rect(-l - 1.0, 1.0, SKIRT_M - 0.1, SKIRT_M + 0.24);
        let top = self.height_m + 0.2;
        let swoosh = [vec2(-l * 0.72, SKIRT_M), vec2(-l * 0.94, top), vec2(-l - 1.0, top), vec2(-l - 1.0, SKIRT_M)];
        let thin = [vec2(-l * 0.66, SKIRT_M), vec2(-l * 0.88, top), vec2(-l * 0.9, top), vec2(-l * 0.685, SKIRT_M)];
        skin.mark_both(&side(&swoosh), slots.second)
            .mark_both(&side(&thin), slots.second)
            .mark_both(&side(&band), slots.second)
            .mark_both(&side(&rect(-l + 0.2, -0.5, low - 0.1, low - 0.085)), slots.seam)
    }

    fn windows(&self, work: &mut Workshop, skin: Shape, ends: [bool; 2]) -> Shape {
        let slots = work.slots;
        let side = |polygon: &[Vec2]| Prism::side(polygon, 0.4..=3.0);
        let mut skin = skin;
        for (deck, &(low, high)) in self.decks.iter().enumerate() {
            let from = if !ends[0] {
                0.15
            } else if deck > 0 {
                0.42
            } else {
                0.5
            };
            let to = self.length_m
                - if !ends[1] {
                    0.15
                } else if deck == 0 && !self.coach {
                    1.0
                } else {
                    0.55
                };
            let band = rect(-to - 0.05, -from + 0.05, low - 0.02, high + 0.03);
            skin = skin.mark_both(&side(&pane(&band, 0.12)), slots.trim);
            let count = ((to - from) / 1.72).round();
            let step = (to - from) / count;
            for i in 0..count as usize {
                let (a, b) = (from + step * i as f32 + 0.02, from + step * (i + 1) as f32 - 0.02);
                let glass = rect(-b, -a, low + 0.02, high - 0.01);
                skin = skin.mark_both(&side(&glass), slots.glass);
                // A part that opens.
                if i % 3 == 1 && !self.coach {
                    let line = rect(-b, -a, high - 0.34, high - 0.315);
                    skin = skin.mark_both(&side(&line), slots.trim);
                }
            }
        }
        // Flaps along the skirt, fillers, vents.
        let mut s = 1.3;
        while s + 1.3 < self.length_m - 0.3 {
            let flap = rect(-s - 1.3, -s, SKIRT_M + 0.1, self.decks[0].0 - if self.coach { 0.3 } else { 0.14 });
            let clear = self.axles_m.iter().all(|a| s + 1.3 < a - 0.6 || s > a + 0.6);
            if clear {
                work.pair(slots.seam, lined(self.half(), flap[0], flap[2]));
            }
            s += 1.36;
        }
        for z in 0..5 {
            let vent =
                rect(-self.length_m + 0.55, -self.length_m + 1.25, 0.7 + 0.045 * z as f32, 0.722 + 0.045 * z as f32);
            work.pair(slots.seam, lined(self.half(), vent[0], vent[2]));
        }
        skin
    }

    /// Leaves of glass in black frames, with rubber between.
    fn doors(&self, work: &mut Workshop, skin: Shape) -> Shape {
        let slots = work.slots;
        let range = if self.door_side > 0.0 { 0.4..=3.0 } else { -3.0..=-0.4 };
        let high = if self.coach { 2.6 } else { self.decks[0].1 + 0.02 };
        let mut skin = skin;
        for &(from, width) in self.doors_m {
            let side = |polygon: &[Vec2]| Prism::side(polygon, range.clone());
            let frame = rect(-from - width, -from, SKIRT_M + 0.05, high);
            skin = skin.mark(&side(&frame), slots.trim);
            let leaves = if width > 1.0 { 2 } else { 1 };
            for k in 0..leaves {
                let leaf = width / leaves as f32;
                let a = from + leaf * k as f32;
                let glass = rect(-a - leaf + 0.065, -a - 0.065, SKIRT_M + 0.2, high - 0.12);
                skin = skin.mark(&side(&glass), slots.glass);
                let x = -a - if k == 0 { leaf - 0.1 } else { 0.1 };
                let grip = [SKIRT_M + 0.75, high - 0.55].map(|z| vec3(x, self.door_side * (self.half() - 0.06), z));
                work.add(slots.yellow, Shape::tube(&grip, 0.016, 6));
            }
            if leaves == 2 {
                let seal = rect(-from - width / 2.0 - 0.012, -from - width / 2.0 + 0.012, SKIRT_M + 0.05, high);
                skin = skin.mark(&side(&seal), slots.rubber);
            }
            let step = block(
                [width - 0.1, 0.3, 0.04],
                [-from - width / 2.0, self.door_side * (self.half() - 0.2), SKIRT_M + 0.07],
                0.01,
            );
            work.add(slots.steel, step);
        }
        skin
    }

    fn wheels(&self, work: &mut Workshop, skin: &mut Shape, ends: [bool; 2]) {
        let (half, r) = (self.half(), self.wheel_m);
        for (i, &axle) in self.axles_m.iter().enumerate() {
            let (well, lip) = arch(skin, vec2(-axle, r), r + 0.1, half, 0.62);
            work.add(work.slots.seam, well);
            work.add(work.slots.trim, lip);
            let steers = i == 0 && ends[0] || i == 2;
            let rim = if steers { Rim::Steel } else { Rim::DeepSteel };
            let tyre = wheel(&work.slots, r, r * 0.58, rim).moved(vec3(-axle, half - r * 0.29 - 0.05, r));
            work.model.add_marked(tyre.both_sides());
            work.add(
                work.slots.frame,
                Shape::tube(&[vec3(-axle, -half + 0.3, r), vec3(-axle, half - 0.3, r)], 0.09, 8),
            );
        }
        let floor = Shape::block(vec3(self.length_m - 0.5, self.width_m - 0.2, 0.04));
        work.add(work.slots.frame, floor.moved(vec3(-self.length_m / 2.0, 0.0, SKIRT_M + 0.06)));
    }
}

/// Thin lines around a flap in the flat part of both sides.
fn lined(half: f32, low: Vec2, high: Vec2) -> Shape {
    let w = 0.009;
    let bar = |a: Vec2, b: Vec2| {
        let (size, middle) = (b - a, (a + b) / 2.0);
        Shape::block(vec3(size.x, 0.004, size.y)).moved(vec3(middle.x, half, middle.y))
    };
    Shape::join([
        bar(low, vec2(high.x, low.y + w)),
        bar(vec2(low.x, high.y - w), high),
        bar(low, vec2(low.x + w, high.y)),
        bar(vec2(high.x - w, low.y), high),
    ])
}

/// Folded bellows between two hulls.
pub(super) fn bellows(work: &mut Workshop, plan: &BusPlan, front_x: f32, back_x: f32) {
    let folds = 15;
    let rings: Vec<Vec<Vec3>> = (0..=folds * 2)
        .map(|i| {
            let inset = if i % 2 == 0 { 0.13 } else { 0.035 };
            let x = back_x + (front_x - back_x) * i as f32 / (folds * 2) as f32;
            let (h, low, high) = (plan.half() - inset, SKIRT_M + 0.12 + inset, plan.roof() - inset - 0.02);
            let round = |cy: f32, cz: f32, from: f32| {
                (0..=3)
                    .map(move |k| from + PI / 2.0 * k as f32 / 3.0)
                    .map(move |a| vec2(cy + 0.24 * a.cos(), cz + 0.24 * a.sin()))
            };
            let ring = round(h - 0.24, high - 0.24, 0.0).chain(round(-h + 0.24, high - 0.24, PI / 2.0));
            [vec2(h, low)].into_iter().chain(ring).chain([vec2(-h, low)]).map(|p| vec3(x, p.x, p.y)).collect()
        })
        .collect();
    work.add(work.slots.rubber, Shape::loft(&rings).smooth(0.1));
}

/// Lines of a rear flap or the like.
pub(super) fn framed(
    skin: Shape,
    polygon_yz: &[Vec2],
    x: std::ops::RangeInclusive<f32>,
    body: u16,
    line: u16,
) -> Shape {
    skin.mark(&Prism::front(polygon_yz, x.clone()), line).mark(&Prism::front(&shrunk(polygon_yz, 0.008), x), body)
}

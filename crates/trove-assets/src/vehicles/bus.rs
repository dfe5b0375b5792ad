//! Buses and coaches.

use std::f32::consts::TAU;

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Kind};

use super::palette::Palette;
use super::wheel::{Rim, wheel};
use crate::shape::{Model, Prism, Shape};

/// Liveries.
const CITY: [Vec3; 7] = [
    vec3(0.5, 0.015, 0.02),
    vec3(0.32, 0.015, 0.04),
    vec3(0.03, 0.25, 0.1),
    vec3(0.7, 0.7, 0.68),
    vec3(0.7, 0.7, 0.68),
    vec3(0.02, 0.08, 0.3),
    vec3(0.65, 0.42, 0.02),
];
const COACH: [Vec3; 5] = [
    vec3(0.74, 0.74, 0.72),
    vec3(0.74, 0.74, 0.72),
    vec3(0.4, 0.41, 0.42),
    vec3(0.03, 0.06, 0.2),
    vec3(0.3, 0.02, 0.03),
];

/// Every bus.
pub(crate) fn assets() -> Vec<Asset> {
    let city = BusPlan {
        length_m: 11.95,
        width_m: 2.5,
        height_m: 3.1,
        axles_m: &[2.7, 8.7],
        decks: &[(1.05, 2.5)],
        doors_m: &[(0.75, 1.25), (5.3, 1.25)],
        doors_left: false,
        front_low_m: 0.95,
    };
    let coach = BusPlan {
        length_m: 12.2,
        height_m: 3.6,
        axles_m: &[2.8, 8.9],
        decks: &[(1.75, 3.15)],
        doors_m: &[(0.6, 0.95)],
        front_low_m: 1.15,
        ..city
    };
    let midi =
        BusPlan { length_m: 8.2, width_m: 2.35, height_m: 3.0, axles_m: &[2.2, 6.1], doors_m: &[(0.7, 1.1)], ..city };
    let double = BusPlan {
        length_m: 11.0,
        height_m: 4.35,
        axles_m: &[2.6, 8.1],
        decks: &[(1.1, 2.15), (2.75, 3.85)],
        doors_left: true,
        ..city
    };
    let bus = |id: &str, kind, paints: &[Vec3], build: &dyn Fn(&Palette) -> Shape| {
        let mut model = Model::default();
        let palette = Palette::new(&mut model, paints, &[vec3(0.7, 0.7, 0.68)]);
        model.add_marked(build(&palette));
        model.asset(id, kind, Kind::Bus.class())
    };
    let left = BusPlan { doors_left: true, ..city };
    vec![
        bus("bus/city", Kind::Bus, &CITY, &|p| city.build(p)),
        bus("bus/city-doors-left", Kind::Bus, &CITY, &|p| left.build(p)),
        bus("bus/midi", Kind::Bus, &CITY, &|p| midi.build(p)),
        bus("bus/coach", Kind::Bus, &COACH, &|p| coach.build(p)),
        bus("bus/double-decker", Kind::Bus, &CITY, &|p| double.build(p)),
        bus("bus/articulated", Kind::ArticulatedBus, &CITY, &articulated),
    ]
}

/// A bus to build; x = 0 is its front.
#[derive(Clone, Copy, Debug)]
struct BusPlan {
    length_m: f32,
    width_m: f32,
    height_m: f32,
    axles_m: &'static [f32],
    /// Lower and upper edges of the rows of windows.
    decks: &'static [(f32, f32)],
    /// Doors: distance from the front and width.
    doors_m: &'static [(f32, f32)],
    doors_left: bool,
    /// Lower edge of the windscreen.
    front_low_m: f32,
}

const FLOOR_M: f32 = 0.3;
const WHEEL_M: f32 = 0.48;

impl BusPlan {
    fn build(&self, palette: &Palette) -> Shape {
        let mut skin = self.skin([0.22, 0.08]).slot(palette.paint);
        skin = self.windows(skin, palette);
        skin = self.front(skin, palette);
        skin = self.back(skin, palette);
        Shape::join([self.wheels(&mut skin, palette), self.interior(palette), self.fittings(palette), skin])
    }

    /// A tall rounded hull, its front and back bowed.
    fn skin(&self, bow: [f32; 2]) -> Shape {
        let (half, top) = (self.width_m / 2.0, self.height_m - 0.18);
        let rows = [
            (FLOOR_M, 0.05, 0.06),
            (FLOOR_M + 0.12, 0.0, 0.01),
            (1.0, 0.0, 0.0),
            (top - 0.5, 0.02, 0.07),
            (top - 0.14, 0.05, 0.14),
            (top - 0.03, 0.15, 0.26),
            (top, 0.32, 0.5),
        ];
        let ring = |&(z, inset, rake): &(f32, f32, f32)| -> Vec<Vec3> {
            let h = half - inset;
            let end = |forward: bool| {
                (0..=10).map(move |i| {
                    let t = -1.0 + 2.0 * i as f32 / 10.0;
                    let round = 0.12 * t.abs().powi(8);
                    if forward {
                        vec3(-rake - bow[0] * t * t - round, h * t, z)
                    } else {
                        vec3(-self.length_m + rake * 0.5 + bow[1] * t * t + round, -h * t, z)
                    }
                })
            };
            end(true).chain(end(false)).collect()
        };
        Shape::loft(&rows.iter().map(ring).collect::<Vec<_>>()).smooth(0.5)
    }

    fn windows(&self, skin: Shape, palette: &Palette) -> Shape {
        let mut skin = skin;
        let door_side = if self.doors_left { 0.5..=2.0 } else { -2.0..=-0.5 };
        for (deck, &(low, high)) in self.decks.iter().enumerate() {
            let (from, to) = (0.62, self.length_m - 0.5);
            let band = rect(-to, -from, low, high);
            skin = skin.mark_both(&Prism::side(&band, 0.5..=2.0), palette.trim);
            let count = ((to - from) / 1.45).round();
            for i in 0..count as usize {
                let step = (to - from) / count;
                let (a, b) = (from + step * i as f32 + 0.03, from + step * (i + 1) as f32 - 0.03);
                let pane = rect(-b, -a, low + 0.04, high - 0.04);
                skin = skin.mark_both(&Prism::side(&pane, 0.5..=2.0), palette.glass);
            }
            if deck > 0 {
                let pane = rect(-1.05, 1.05, low, high);
                skin = skin.mark(&Prism::front(&pane, -0.8..=0.1), palette.trim);
                let pane = rect(-1.0, 1.0, low + 0.05, high - 0.05);
                skin = skin.mark(&Prism::front(&pane, -0.8..=0.1), palette.glass);
            }
        }
        let door_top = self.decks[0].1;
        for &(from, width) in self.doors_m {
            let frame = rect(-from - width, -from, FLOOR_M + 0.06, door_top);
            skin = skin.mark(&Prism::side(&frame, door_side.clone()), palette.trim);
            for k in 0..2 {
                let a = from + 0.05 + k as f32 * width / 2.0;
                let pane = rect(-a - width / 2.0 + 0.09, -a, FLOOR_M + 0.2, door_top - 0.1);
                skin = skin.mark(&Prism::side(&pane, door_side.clone()), palette.glass);
            }
        }
        // Flaps along the skirt.
        let mut s = 1.4;
        while s < self.length_m - 0.6 {
            let seam = rect(-s - 0.008, -s, FLOOR_M + 0.05, self.decks[0].0 - 0.05);
            skin = skin.mark_both(&Prism::side(&seam, 0.5..=2.0), palette.seam);
            s += 1.45;
        }
        let line = rect(-self.length_m + 0.2, -0.4, 0.78, 0.79);
        skin.mark_both(&Prism::side(&line, 0.5..=2.0), palette.seam)
    }

    fn front(&self, skin: Shape, palette: &Palette) -> Shape {
        let front = |polygon: &[Vec2]| Prism::front(polygon, -0.62..=0.1);
        let half = self.width_m / 2.0;
        let high = self.decks[0].1 + 0.05;
        let pane = |m: f32| rect(-half + 0.08 + m, half - 0.08 - m, self.front_low_m + m, high - m);
        let mut skin = skin.mark(&front(&pane(0.0)), palette.trim).mark(&front(&pane(0.05)), palette.glass);
        skin = skin.mark(&front(&rect(-0.012, 0.012, self.front_low_m, high)), palette.trim);
        // Destination above the windscreen.
        let sign = high + 0.03;
        let room = if self.decks.len() > 1 { 0.36 } else { (self.height_m - 0.2 - sign).min(0.34) };
        if room > 0.12 {
            skin = skin.mark(&front(&rect(-half * 0.75, half * 0.75, sign, sign + room)), palette.seam);
            for k in 0..7 {
                let y = -half * 0.55 + 0.16 * k as f32 * half;
                let letter = rect(y, y + 0.1, sign + room * 0.25, sign + room * 0.75);
                skin = skin.mark(&front(&letter), palette.amber);
            }
        }
        skin.mark(&front(&rect(-half, half, FLOOR_M, FLOOR_M + 0.12)), palette.trim)
            .mark_both(&front(&rect(half * 0.6, half * 0.92, 0.62, 0.76)), palette.lamp)
            .mark_both(&front(&rect(half * 0.92, half * 0.99, 0.6, 0.78)), palette.amber)
            .mark(&front(&rect(-half * 0.5, half * 0.5, 0.6, 0.74)), palette.trim)
            .mark(&front(&rect(-0.26, 0.26, 0.44, 0.55)), palette.plate)
    }

    fn back(&self, skin: Shape, palette: &Palette) -> Shape {
        let back = |polygon: &[Vec2]| Prism::front(polygon, -self.length_m - 0.1..=-self.length_m + 0.45);
        let half = self.width_m / 2.0;
        let mut skin = skin;
        for &(low, high) in self.decks {
            let low = low.max(1.6);
            if high > low + 0.3 {
                skin = skin.mark(&back(&rect(-half * 0.75, half * 0.75, low, high)), palette.trim);
                skin = skin.mark(&back(&rect(-half * 0.71, half * 0.71, low + 0.05, high - 0.05)), palette.glass);
            }
        }
        for k in 0..6 {
            let z = 0.95 + 0.07 * k as f32;
            skin = skin.mark(&back(&rect(-half * 0.6, half * 0.6, z, z + 0.035)), palette.seam);
        }
        skin.mark(&back(&rect(-half, half, FLOOR_M, FLOOR_M + 0.2)), palette.trim)
            .mark_both(&back(&rect(half * 0.8, half * 0.97, 0.85, 1.15)), palette.red)
            .mark_both(&back(&rect(half * 0.8, half * 0.97, 1.18, 1.3)), palette.amber)
            .mark_both(&back(&rect(half * 0.82, half * 0.95, self.height_m - 0.55, self.height_m - 0.45)), palette.red)
            .mark(&back(&rect(-0.26, 0.26, 0.66, 0.78)), palette.plate)
    }

    /// Cuts the arches out of the skin and puts wheels into them.
    fn wheels(&self, skin: &mut Shape, palette: &Palette) -> Shape {
        let half = self.width_m / 2.0;
        let radius = WHEEL_M + 0.09;
        let mut parts = Vec::new();
        for (i, &axle) in self.axles_m.iter().enumerate() {
            let cut = Prism::round_side(vec2(-axle, WHEEL_M), radius, 32, half - 0.4..=2.0);
            *skin = std::mem::take(skin).without(&cut).without(&cut.mirrored());
            let row = |y: f32| -> Vec<Vec3> {
                let angles = (0..=20).map(|k| -0.32 + (TAU / 2.0 + 0.64) * k as f32 / 20.0);
                angles.map(|a| vec3(-axle + a.cos() * radius, y, WHEEL_M + a.sin() * radius)).collect()
            };
            let well = Shape::sheet(&[row(half - 0.62), row(half - 0.004)]);
            let wall =
                Shape::block(vec3(radius * 2.0, 0.02, radius * 1.6)).moved(vec3(-axle, half - 0.63, WHEEL_M + 0.12));
            parts.push(well.and(wall).slot(palette.seam).both_sides());
            let rim = if i == 0 { Rim::Steel } else { Rim::DeepSteel };
            let tyre = wheel(palette, WHEEL_M, 0.28, rim).moved(vec3(-axle, half - 0.19, WHEEL_M));
            parts.push(tyre.both_sides());
        }
        Shape::join(parts)
    }

    fn interior(&self, palette: &Palette) -> Shape {
        let half = self.width_m / 2.0 - 0.1;
        let (from, to) = (0.7, self.length_m - 0.3);
        let mut parts = Vec::new();
        let mut bars = Vec::new();
        for (deck, &(low, high)) in self.decks.iter().enumerate() {
            let floor = if deck == 0 { low - 0.45 } else { low - 0.4 };
            let plate = Shape::block(vec3(to - from, half * 2.0, 0.06));
            parts.push(plate.clone().moved(vec3(-(from + to) / 2.0, 0.0, floor)));
            parts.push(plate.moved(vec3(-(from + to) / 2.0, 0.0, high + 0.12)));
            let mut s = from + if deck == 0 { 2.4 } else { 0.8 };
            while s < to - 0.5 {
                for y in [half - 0.45, -half + 0.45] {
                    parts.push(Shape::rounded_block(vec3(0.12, 0.86, 0.72), 0.05).moved(vec3(-s, y, low + 0.12)));
                    parts.push(Shape::rounded_block(vec3(0.42, 0.86, 0.12), 0.04).moved(vec3(
                        -s + 0.25,
                        y,
                        low - 0.12,
                    )));
                }
                let pole = Shape::tube(&[vec3(-s, half - 0.9, floor), vec3(-s, half - 0.9, high + 0.1)], 0.018, 6);
                bars.push(pole);
                s += 0.85;
            }
        }
        let low = self.decks[0].0;
        let seat = if self.doors_left { -0.6 } else { 0.6 };
        parts.push(Shape::rounded_block(vec3(0.35, half * 1.9, 0.25), 0.08).moved(vec3(
            -0.5,
            0.0,
            self.front_low_m - 0.12,
        )));
        parts.push(Shape::rounded_block(vec3(0.14, 0.5, 0.9), 0.05).moved(vec3(-1.5, seat, low + 0.1)));
        let ring: Vec<Vec3> = (0..=16).map(|i| Vec2::from_angle(TAU * i as f32 / 16.0).extend(0.0) * 0.23).collect();
        let steering = Shape::tube(&ring, 0.016, 6).turned(Quat::from_rotation_y(-0.5));
        parts.push(steering.moved(vec3(-0.85, seat, self.front_low_m + 0.1)));
        Shape::join(parts).slot(palette.interior).and(Shape::join(bars).slot(palette.amber))
    }

    /// Mirrors and what stands on the roof.
    fn fittings(&self, palette: &Palette) -> Shape {
        let (half, top) = (self.width_m / 2.0, self.height_m - 0.18);
        let z = self.decks[0].1;
        let arm = [vec3(-0.35, half - 0.12, z), vec3(-0.1, half + 0.05, z + 0.05), vec3(-0.02, half + 0.1, z - 0.15)];
        let mirror = Shape::tube(&arm, 0.02, 6).and(Shape::rounded_block(vec3(0.1, 0.2, 0.38), 0.04).moved(vec3(
            -0.02,
            half + 0.1,
            z - 0.32,
        )));
        let mut parts = vec![mirror.both_sides().slot(palette.trim)];
        let box_at = |s: f32, length: f32| {
            Shape::rounded_block(vec3(length, 1.7, 0.24), 0.07).moved(vec3(-s, 0.0, top + 0.06)).slot(palette.paint)
        };
        parts.push(box_at(self.length_m * 0.3, 2.2));
        if self.decks.len() == 1 {
            parts.push(box_at(self.length_m * 0.72, 1.6));
        }
        let wiper = |y: f32| {
            let low = self.front_low_m;
            Shape::tube(
                &[vec3(-0.0, y, low - 0.02), vec3(-0.03, y + 0.1, low + 0.5), vec3(-0.04, y + 0.12, low + 0.85)],
                0.012,
                5,
            )
        };
        parts.push(wiper(0.25).and(wiper(-0.75)).slot(palette.trim));
        Shape::join(parts)
    }
}

/// Two bodies with a bellows between them.
fn articulated(palette: &Palette) -> Shape {
    let front = BusPlan {
        length_m: 10.2,
        width_m: 2.5,
        height_m: 3.1,
        axles_m: &[2.7, 8.3],
        decks: &[(1.05, 2.5)],
        doors_m: &[(0.75, 1.25), (5.0, 1.25)],
        doors_left: false,
        front_low_m: 0.95,
    };
    let rear = BusPlan { length_m: 6.9, axles_m: &[4.2], doors_m: &[(1.6, 1.25)], ..front };
    let behind = vec3(-11.1, 0.0, 0.0);
    let mut head = front.skin([0.22, 0.0]).slot(palette.paint);
    head = front.front(front.windows(head, palette), palette);
    let mut tail = rear.skin([0.0, 0.08]).slot(palette.paint);
    tail = rear.back(rear.windows(tail, palette), palette);
    let folds: Vec<Vec<Vec3>> = (0..=16)
        .map(|i| {
            let inset = if i % 2 == 0 { 0.12 } else { 0.02 };
            let (x, h) = (-11.35 + 1.4 * i as f32 / 16.0, 1.23 - inset);
            let (low, high) = (0.45 + inset, 2.85 - inset);
            [(h, low), (h, high - 0.25), (h - 0.25, high), (-h + 0.25, high), (-h, high - 0.25), (-h, low)]
                .map(|(y, z)| vec3(x, y, z))
                .to_vec()
        })
        .collect();
    let bellows = Shape::loft(&folds).smooth(0.1).slot(palette.rubber);
    let wheels = front.wheels(&mut head, palette);
    let more = rear.wheels(&mut tail, palette).moved(behind);
    Shape::join([
        head,
        wheels,
        front.interior(palette),
        front.fittings(palette),
        bellows,
        tail.moved(behind),
        more,
        rear.interior(palette).moved(behind),
    ])
}

fn rect(x0: f32, x1: f32, z0: f32, z1: f32) -> [Vec2; 4] {
    [vec2(x0, z0), vec2(x1, z0), vec2(x1, z1), vec2(x0, z1)]
}

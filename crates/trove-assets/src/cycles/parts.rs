//! What cycles are made of, and their wheels.

use std::f32::consts::TAU;

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Material, Role};

use crate::shape::{Model, Shape};
use crate::vehicles::number_plate;

/// The slots of a cycle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parts {
    pub(crate) paint: u16,
    pub(crate) rubber: u16,
    pub(crate) steel: u16,
    pub(crate) black: u16,
    pub(crate) lamp: u16,
    pub(crate) red: u16,
    pub(crate) amber: u16,
    pub(crate) plate: u16,
    /// Boxes of plywood.
    pub(crate) wood: u16,
    /// Screens in front of riders.
    pub(crate) glass: u16,
    pub(crate) mirror: u16,
    /// Visors of helmets.
    pub(crate) visor: u16,
    /// Boxes and bags of those who deliver.
    pub(crate) case: u16,
}

const PAINTS: [Vec3; 9] = [
    vec3(0.012, 0.012, 0.013),
    vec3(0.012, 0.012, 0.013),
    vec3(0.09, 0.095, 0.1),
    vec3(0.6, 0.6, 0.6),
    vec3(0.42, 0.02, 0.02),
    vec3(0.02, 0.07, 0.3),
    vec3(0.03, 0.16, 0.07),
    vec3(0.55, 0.25, 0.02),
    vec3(0.1, 0.35, 0.38),
];

const CASES: [Vec3; 5] = [
    vec3(0.02, 0.3, 0.22),
    vec3(0.5, 0.09, 0.02),
    vec3(0.4, 0.015, 0.04),
    vec3(0.02, 0.02, 0.022),
    vec3(0.6, 0.42, 0.02),
];

impl Parts {
    pub(crate) fn new(model: &mut Model, id: &str) -> Self {
        let paint = Material { coat: 1.0, dirt: 0.35, ..Material::plain("paint", PAINTS[0], 0.4) };
        let steel = Material { metalness: 1.0, dirt: 0.4, ..Material::plain("steel", Vec3::splat(0.55), 0.28) };
        let lens = |name: &str, color: Vec3| Material { coat: 1.0, ..Material::plain(name, color, 0.2) };
        Self {
            paint: model.slot(paint, &PAINTS),
            rubber: model.slot(Material { dirt: 0.6, ..Material::plain("rubber", Vec3::splat(0.024), 0.8) }, &[]),
            steel: model.slot(steel, &[]),
            black: model.slot(Material::plain("black", Vec3::splat(0.018), 0.5), &[]),
            lamp: model.slot(Material { role: Some(Role::Headlamp), ..lens("lamp", vec3(0.75, 0.77, 0.8)) }, &[]),
            red: model.slot(Material { role: Some(Role::TailLamp), ..lens("reflector", vec3(0.5, 0.01, 0.01)) }, &[]),
            amber: model.slot(lens("blinker", vec3(0.6, 0.2, 0.01)), &[]),
            plate: model.slot(number_plate(id), &[]),
            wood: model.slot(Material::plain("plywood", vec3(0.38, 0.25, 0.13), 0.6), &[]),
            glass: model
                .slot(Material { transmission: 0.8, ..Material::plain("screen", vec3(0.25, 0.27, 0.28), 0.04) }, &[]),
            mirror: model.slot(Material { metalness: 1.0, ..Material::plain("mirror", Vec3::splat(0.85), 0.03) }, &[]),
            visor: model.slot(Material { coat: 1.0, ..Material::plain("visor", vec3(0.008, 0.009, 0.011), 0.06) }, &[]),
            case: model.slot(Material::plain("box", CASES[0], 0.5), &CASES),
        }
    }

    /// A wheel with wire spokes about the origin, turning about y; `knobs` on its tyre.
    pub(crate) fn wire_wheel(&self, radius_m: f32, tyre_m: f32, knobs: bool) -> Shape {
        let around = 40;
        let tyre: Vec<Vec2> = (0..=9)
            .map(|i| TAU * i as f32 / 9.0)
            .map(|a| vec2(radius_m - tyre_m + tyre_m * a.cos(), tyre_m * a.sin()))
            .collect();
        let bed = radius_m - tyre_m * 1.85;
        let deep = (0.5 * tyre_m).max(0.009);
        let rim = [(deep, 0.55), (0.0, 0.62), (-deep, 0.4), (-deep, -0.4), (0.0, -0.62), (deep, -0.55), (deep, 0.55)];
        let rim: Vec<Vec2> = rim.iter().map(|&(dr, y)| vec2(bed + dr, -y * tyre_m.min(0.02))).collect();
        let hub = [
            (0.0, -0.05),
            (0.012, -0.05),
            (0.012, -0.03),
            (0.024, -0.028),
            (0.013, -0.02),
            (0.013, 0.02),
            (0.024, 0.028),
            (0.012, 0.03),
            (0.012, 0.05),
            (0.0, 0.05),
        ];
        let spokes = (0..28).map(|i| {
            let side = if i % 2 == 0 { 0.028 } else { -0.028 };
            let crossed = if i % 4 < 2 { 1.9 } else { -1.9 };
            Shape::tube(
                &[on_circle((i as f32 + crossed) / 28.0, 0.022, side), on_circle(i as f32 / 28.0, bed, 0.0)],
                0.0013,
                3,
            )
        });
        let reflector = Shape::rounded_block(vec3(0.07, 0.008, 0.035), 0.003).moved(vec3(0.0, 0.0, radius_m * 0.6));
        let mut parts = vec![
            Shape::lathe(&tyre, around).upright().slot(self.rubber),
            Shape::lathe(&rim, around).upright().slot(self.steel),
            Shape::lathe(&hub.map(|(r, y)| vec2(r, y)), 12).upright().and(Shape::join(spokes)).slot(self.steel),
            reflector.slot(self.amber),
        ];
        if knobs {
            let knob = |i: usize| {
                let turn = Quat::from_rotation_y(-TAU * i as f32 / 54.0);
                let y = [-0.55, 0.0, 0.55][i % 3] * tyre_m;
                Shape::block(vec3(0.011, 0.014, 0.008))
                    .moved(vec3(0.0, y, radius_m - 0.002 - y.abs() * 0.25))
                    .turned(turn)
            };
            parts.push(Shape::join((0..54).map(knob)).slot(self.rubber));
        }
        Shape::join(parts)
    }

    /// A motorcycle's wheel about the origin, turning about y, with cast spokes and brake discs.
    pub(crate) fn cast_wheel(&self, radius_m: f32, tyre_m: f32, spokes: usize) -> Shape {
        let profile: Vec<Vec2> = (0..=11)
            .map(|i| TAU * i as f32 / 11.0)
            .map(|a| vec2(radius_m - tyre_m * 0.85 + tyre_m * 0.85 * a.cos(), tyre_m * a.sin()))
            .collect();
        let tyre = Shape::lathe(&profile, 32).upright().slot(self.rubber);
        // Grooves in the tread, slanting outwards.
        let grooves = (0..28).map(|i| {
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let at = |t: f32, y: f32, drop: f32| {
                on_circle((i as f32 + t) / 28.0, radius_m + 0.0005 - drop, side * y * tyre_m)
            };
            Shape::tube(&[at(0.0, 0.08, 0.0), at(0.8, 0.5, tyre_m * 0.115)], 0.0028, 3)
        });
        let bed = radius_m - tyre_m * 1.55;
        let rim = [(0.16, -0.75), (0.0, -0.8), (-0.12, -0.5), (-0.14, 0.0), (-0.12, 0.5), (0.0, 0.8), (0.16, 0.75)];
        let rim = Shape::lathe(&rim.map(|(dr, y)| vec2(bed + dr * tyre_m, y * tyre_m)), 28).plate(0.003).upright();
        let arms = (0..spokes).map(|i| {
            let angle = i as f32 / spokes as f32;
            let (from, to) = (on_circle(angle, 0.03, 0.0), on_circle(angle + 0.03, bed, 0.0));
            Shape::tapered_tube(&[(from, 0.02), (from.lerp(to, 0.6), 0.012), (to, 0.015)], 7)
        });
        let hub = Shape::tube(&[Vec3::Y * -0.075, Vec3::Y * 0.075], 0.036, 16);
        let ring = [(0.62, 0.0), (1.0, 0.0), (1.0, 0.005), (0.62, 0.005), (0.62, 0.0)]
            .map(|(r, y)| vec2(r * radius_m * 0.47, y));
        let disc = Shape::lathe(&ring, 32).upright().moved(Vec3::Y * 0.062);
        Shape::join([
            tyre,
            Shape::join(grooves).slot(self.black),
            rim.and(Shape::join(arms)).slot(self.black),
            hub.slot(self.steel),
            disc.both_sides().slot(self.steel),
        ])
    }
}

/// A point on a circle in the plane of a wheel.
pub(super) fn on_circle(turn: f32, radius_m: f32, y_m: f32) -> Vec3 {
    vec3((turn * TAU).cos() * radius_m, y_m, (turn * TAU).sin() * radius_m)
}

//! What cycles are made of, and their wheels.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::Material;

use crate::shape::{Model, Shape};

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

impl Parts {
    pub(crate) fn new(model: &mut Model) -> Self {
        let paint = Material { coat: 1.0, ..Material::plain("paint", PAINTS[0], 0.4) };
        let steel = Material { metalness: 1.0, ..Material::plain("steel", Vec3::splat(0.55), 0.28) };
        let lens = |name: &str, color: Vec3| Material { coat: 1.0, ..Material::plain(name, color, 0.2) };
        Self {
            paint: model.slot(paint, &PAINTS),
            rubber: model.slot(Material::plain("rubber", Vec3::splat(0.022), 0.8), &[]),
            steel: model.slot(steel, &[]),
            black: model.slot(Material::plain("black", Vec3::splat(0.018), 0.5), &[]),
            lamp: model.slot(lens("lamp", vec3(0.75, 0.77, 0.8)), &[]),
            red: model.slot(lens("reflector", vec3(0.5, 0.01, 0.01)), &[]),
            amber: model.slot(lens("blinker", vec3(0.6, 0.2, 0.01)), &[]),
            plate: model.slot(Material::plain("number plate", vec3(0.72, 0.72, 0.7), 0.5), &[]),
        }
    }

    /// A wheel with wire spokes about the origin, turning about y.
    pub(crate) fn wire_wheel(&self, radius_m: f32, tyre_m: f32) -> Shape {
        let ring = |radius: f32, thick: f32, around: usize| {
            let path: Vec<Vec3> = (0..=36).map(|i| on_circle(i as f32 / 36.0, radius, 0.0)).collect();
            Shape::tube(&path, thick, around)
        };
        let hub = Shape::tube(&[Vec3::Y * -0.035, Vec3::Y * 0.035], 0.02, 10);
        let spokes = (0..20).map(|i| {
            let side = if i % 2 == 0 { 0.025 } else { -0.025 };
            Shape::tube(
                &[on_circle(i as f32 / 20.0, 0.018, side), on_circle((i as f32 + 0.6) / 20.0, radius_m - tyre_m, 0.0)],
                0.0016,
                3,
            )
        });
        Shape::join([
            ring(radius_m - tyre_m, tyre_m, 8).slot(self.rubber),
            ring(radius_m - tyre_m * 2.1, 0.009, 6).slot(self.steel),
            hub.and(Shape::join(spokes)).slot(self.steel),
        ])
    }

    /// A motorcycle's wheel about the origin, turning about y, with cast spokes and brake discs.
    pub(crate) fn cast_wheel(&self, radius_m: f32, tyre_m: f32) -> Shape {
        let torus: Vec<Vec2> = (0..=12)
            .map(|i| TAU * i as f32 / 12.0)
            .map(|a| vec2(radius_m - tyre_m + tyre_m * a.cos(), tyre_m * 1.05 * a.sin()))
            .collect();
        let tyre = crate::vehicles::upright(Shape::lathe(&torus, 32)).slot(self.rubber);
        let rim = [(-0.7, 1.55), (0.7, 1.55), (0.7, 2.0), (-0.7, 2.0), (-0.7, 1.55)];
        let rim: Vec<Vec2> = rim.iter().map(|&(y, d)| vec2(radius_m - tyre_m * d, y * tyre_m)).collect();
        let rim = crate::vehicles::upright(Shape::lathe(&rim, 32));
        let spokes = (0..6).map(|i| {
            let (from, to) =
                (on_circle(i as f32 / 6.0, 0.03, 0.0), on_circle((i as f32 + 0.2) / 6.0, radius_m - tyre_m * 1.8, 0.0));
            Shape::tapered_tube(&[(from, 0.018), (to, 0.012)], 6)
        });
        let hub = Shape::tube(&[Vec3::Y * -0.07, Vec3::Y * 0.07], 0.035, 12);
        let disc = crate::vehicles::upright(Shape::cylinder(radius_m * 0.48, 0.006, 24)).moved(Vec3::Y * 0.06);
        Shape::join([tyre, rim.slot(self.black), Shape::join(spokes).slot(self.black), hub.and(disc).slot(self.steel)])
    }
}

/// A point on a circle in the plane of a wheel.
fn on_circle(turn: f32, radius_m: f32, y_m: f32) -> Vec3 {
    vec3((turn * TAU).cos() * radius_m, y_m, (turn * TAU).sin() * radius_m)
}

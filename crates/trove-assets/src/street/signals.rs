//! Traffic signals; their lamps look along x.

use glam::{Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Material};

use super::finish::{bar, galvanised, painted, plastic, polygon, post, upright};
use crate::shape::{Model, Shape};

pub(super) fn assets() -> Vec<Asset> {
    vec![
        on_pole("signal/pole-red", Lamp::Red),
        on_pole("signal/pole-green", Lamp::Green),
        on_arm("signal/arm-red", Lamp::Red),
        on_arm("signal/arm-green", Lamp::Green),
    ]
}

#[derive(Clone, Copy, PartialEq)]
enum Lamp {
    Red,
    Amber,
    Green,
}

impl Lamp {
    fn color(self) -> Vec3 {
        match self {
            Self::Red => vec3(0.6, 0.02, 0.012),
            Self::Amber => vec3(0.6, 0.27, 0.01),
            Self::Green => vec3(0.01, 0.45, 0.28),
        }
    }

    fn material(self, lit: bool) -> Material {
        // A lit signal outshines a sunlit white wall about twofold.
        let color = self.color();
        if lit {
            Material { emission: color * 4.0, ..plastic(color) }
        } else {
            Material::plain("unlit lamp", color * 0.12 + 0.012, 0.2)
        }
    }
}

struct Slots {
    black: u16,
    lamps: [u16; 3],
    rim: u16,
}

impl Slots {
    fn new(model: &mut Model, lit: Lamp) -> Self {
        let black = model.slot(painted(Vec3::splat(0.022)), &[]);
        let rim = model.slot(painted(vec3(0.5, 0.5, 0.48)), &[]);
        let lamps = [Lamp::Red, Lamp::Amber, Lamp::Green].map(|lamp| model.slot(lamp.material(lamp == lit), &[]));
        Self { black, lamps, rim }
    }
}

/// Three lamps under hoods before a board, the middle one at a point.
fn head(model: &mut Model, slots: &Slots, at: Vec3) {
    let board = upright(Shape::extruded(&super::finish::rounded(vec2(0.62, 1.32), 0.08), 0.012));
    let rim = upright(Shape::extruded(&super::finish::rounded(vec2(0.66, 1.36), 0.1), 0.006));
    model.add(slots.rim, rim.moved(at + vec3(-0.012, 0.0, 0.0)));
    model.add(slots.black, board.moved(at + vec3(-0.004, 0.0, 0.0)));
    model.add(slots.black, bar(at + vec3(-0.02, 0.0, 0.0), vec3(0.22, 0.33, 1.02)));
    for (i, &lamp) in slots.lamps.iter().enumerate() {
        let centre = at + vec3(0.09, 0.0, 0.32 * (1.0 - i as f32));
        let lens = upright(Shape::lathe(&[vec2(0.105, 0.0), vec2(0.075, 0.02), vec2(0.0, 0.032)], 24));
        model.add(lamp, lens.moved(centre));
        let ring = upright(Shape::extruded(&polygon(24, 0.12, 0.0), 0.01));
        model.add(slots.black, ring.moved(centre - Vec3::X * 0.008));
        // The hood covers the upper three quarters and slants forward.
        let row = |x: f32, radius: f32| -> Vec<Vec3> {
            (0..=14)
                .map(|k| {
                    let angle = -0.7 + (std::f32::consts::PI + 1.4) * k as f32 / 14.0;
                    let reach = x * (0.55 + 0.45 * angle.sin().max(-0.6));
                    centre + vec3(reach, radius * angle.cos(), radius * angle.sin())
                })
                .collect()
        };
        model.add(slots.black, Shape::sheet(&[row(0.24, 0.118), row(0.0, 0.122)]));
    }
}

fn foot(model: &mut Model, steel: u16, radius_m: f32, height_m: f32) {
    let path = [(Vec3::ZERO, radius_m), (Vec3::Z * height_m, radius_m * 0.8)];
    model.add(steel, Shape::tapered_tube(&path, 16));
    model.add(steel, bar(vec3(0.0, 0.0, 0.015), vec3(0.34, 0.34, 0.03)));
}

/// On a pole of its own, with a push button.
fn on_pole(id: &str, lit: Lamp) -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let slots = Slots::new(&mut model, lit);
    foot(&mut model, steel, 0.06, 3.3);
    for z in [2.45, 3.05] {
        model.add(steel, bar(vec3(0.08, 0.0, z), vec3(0.14, 0.05, 0.05)));
    }
    head(&mut model, &slots, vec3(0.22, 0.0, 2.75));
    let amber = model.slot(plastic(vec3(0.55, 0.33, 0.02)), &[]);
    model.add(amber, bar(vec3(0.09, 0.0, 1.1), vec3(0.09, 0.12, 0.2)));
    model.asset(id, Kind::TrafficSignal, Class::TrafficSign)
}

/// On an arm over the road towards −y (to the left of who drives towards it), with a second head on the pole.
fn on_arm(id: &str, lit: Lamp) -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let slots = Slots::new(&mut model, lit);
    foot(&mut model, steel, 0.12, 6.2);
    let bend = |t: f32| vec3(0.0, -0.5 - 5.0 * t, 5.95 + 0.35 * (t * 1.6).sin());
    let arm: Vec<(Vec3, f32)> = std::iter::once((vec3(0.0, 0.0, 5.75), 0.075))
        .chain((0..=8).map(|i| i as f32 / 8.0).map(|t| (bend(t), 0.07 - 0.025 * t)))
        .collect();
    model.add(steel, Shape::tapered_tube(&arm, 12));
    for t in [0.5, 0.97] {
        let at = bend(t);
        model.add(steel, bar(at + vec3(0.07, 0.0, 0.0), vec3(0.14, 0.06, 0.06)));
        head(&mut model, &slots, at + vec3(0.18, 0.0, 0.0));
    }
    model.add(steel, bar(vec3(0.12, 0.0, 2.75), vec3(0.14, 0.05, 0.05)));
    head(&mut model, &slots, vec3(0.26, 0.0, 2.75));
    model.add(steel, post(vec3(0.0, 0.0, 6.2), 0.1, 0.03, 16));
    model.asset(id, Kind::TrafficSignal, Class::TrafficSign)
}

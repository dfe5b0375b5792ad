//! Cows that stand about streets: zebus, with a hump, a dewlap, horns and hanging ears.

use glam::{Quat, Vec3, vec2, vec3};
use trove_model::{Asset, Material};

use super::animals::{animal, coat};
use crate::countries::met_in;
use crate::shape::{Blend, Limb, Model, Prism, Shape};

/// White, grey, brown, black; a colour as often as it is common.
const COATS: [Vec3; 8] = [
    vec3(0.47, 0.44, 0.38),
    vec3(0.41, 0.38, 0.33),
    vec3(0.32, 0.31, 0.29),
    vec3(0.2, 0.195, 0.19),
    vec3(0.24, 0.12, 0.055),
    vec3(0.33, 0.19, 0.09),
    vec3(0.12, 0.06, 0.03),
    vec3(0.022, 0.018, 0.016),
];

/// One that stands and looks ahead.
pub(super) fn cow() -> Asset {
    let mut model = Model::default();
    let fur = model.slot(coat(COATS[0]), &COATS);
    let dark = model.slot(Material::plain("muzzle", vec3(0.03, 0.026, 0.025), 0.5), &[]);
    let horn = model.slot(Material::plain("horn", vec3(0.1, 0.085, 0.07), 0.45), &[]);
    let udder = model.slot(Material::plain("udder", vec3(0.4, 0.24, 0.2), 0.6), &[]);
    let hooves = Prism::between(vec3(-2.0, -1.0, -1.0), vec3(2.0, 1.0, 0.055));
    model.add_marked(body().slot(fur).mark(&hooves, horn));
    model.add_marked(head(fur, dark));
    let horns = [
        (vec3(0.9, 0.07, 1.36), 0.03),
        (vec3(0.89, 0.14, 1.41), 0.028),
        (vec3(0.89, 0.19, 1.48), 0.022),
        (vec3(0.92, 0.2, 1.56), 0.013),
        (vec3(0.95, 0.185, 1.61), 0.004),
    ];
    model.add(horn, Shape::tapered_tube(&horns, 8).both_sides());
    let teats = Limb::new(vec3(-0.36, 0.0, 0.63), vec3(-0.47, 0.0, 0.62), 0.1, 0.11).wide(Vec3::Z, 0.8);
    model.add(udder, Blend::new(vec![teats], 0.02).surface(0.035));
    let tail = [
        (vec3(-0.72, 0.0, 1.15), 0.045),
        (vec3(-0.82, 0.0, 1.13), 0.034),
        (vec3(-0.875, 0.0, 1.03), 0.026),
        (vec3(-0.89, 0.02, 0.8), 0.02),
        (vec3(-0.86, 0.03, 0.58), 0.016),
    ];
    model.add(fur, Shape::tapered_tube(&tail, 8));
    let tuft = [
        (vec3(-0.86, 0.03, 0.62), 0.012),
        (vec3(-0.86, 0.035, 0.52), 0.036),
        (vec3(-0.855, 0.035, 0.42), 0.034),
        (vec3(-0.855, 0.035, 0.33), 0.008),
    ];
    model.add(dark, Shape::tapered_tube(&tuft, 8));
    Asset { countries: met_in("cow"), ..animal(model, "cow", 1.5) }
}

/// Joints of a leg.
#[derive(Clone, Copy)]
struct Leg {
    /// Elbow or stifle.
    upper: Vec3,
    /// Knee or hock.
    lower: Vec3,
    foot: Vec3,
}

const LEGS: [Leg; 4] = [
    Leg { upper: vec3(0.3, 0.15, 0.72), lower: vec3(0.4, 0.14, 0.43), foot: vec3(0.43, 0.14, 0.0) },
    Leg { upper: vec3(0.3, -0.15, 0.72), lower: vec3(0.36, -0.14, 0.43), foot: vec3(0.33, -0.14, 0.0) },
    Leg { upper: vec3(-0.5, 0.18, 0.74), lower: vec3(-0.79, 0.15, 0.51), foot: vec3(-0.75, 0.15, 0.0) },
    Leg { upper: vec3(-0.5, -0.18, 0.74), lower: vec3(-0.73, -0.15, 0.5), foot: vec3(-0.64, -0.15, 0.0) },
];

impl Leg {
    /// From the elbow or stifle down.
    fn limbs(self) -> [Limb; 4] {
        let fetlock = self.foot + vec3(-0.015, 0.0, 0.13);
        [
            Limb::new(self.upper, self.lower, 0.1, 0.056),
            Limb::new(self.lower, fetlock, 0.046, 0.038),
            Limb::new(fetlock, self.foot + vec3(0.025, 0.0, 0.06), 0.046, 0.04),
            Limb::new(self.foot + vec3(0.01, 0.0, 0.03), self.foot + vec3(0.075, 0.0, 0.015), 0.046, 0.036),
        ]
    }
}

/// Trunk, hump, dewlap, neck, shoulders and thighs.
fn body() -> Shape {
    let limb = Limb::new;
    let mut limbs = vec![
        limb(vec3(0.3, 0.0, 0.9), vec3(-0.1, 0.0, 0.9), 0.28, 0.3).wide(Vec3::Y, 0.84),
        limb(vec3(-0.08, 0.0, 0.87), vec3(-0.34, 0.0, 0.9), 0.3, 0.27).wide(Vec3::Y, 0.97),
        limb(vec3(0.44, 0.0, 0.92), vec3(0.38, 0.0, 0.84), 0.2, 0.22).wide(Vec3::Y, 0.95),
        limb(vec3(-0.3, 0.0, 1.0), vec3(-0.6, 0.0, 1.02), 0.19, 0.19).wide(Vec3::Y, 1.05),
        // The backbone.
        limb(vec3(0.2, 0.0, 1.15), vec3(-0.68, 0.0, 1.17), 0.06, 0.055),
        // Hump.
        limb(vec3(0.36, 0.0, 1.2), vec3(0.26, 0.0, 1.25), 0.12, 0.085).wide(Vec3::Y, 0.72),
        // Neck and dewlap.
        limb(vec3(0.42, 0.0, 1.03), vec3(0.84, 0.0, 1.22), 0.2, 0.115).wide(Vec3::Y, 0.66),
        limb(vec3(0.5, 0.0, 0.7), vec3(0.62, 0.0, 0.8), 0.13, 0.15).wide(Vec3::Y, 0.42),
        limb(vec3(0.62, 0.0, 0.8), vec3(0.88, 0.0, 1.08), 0.15, 0.075).wide(Vec3::Y, 0.42),
    ];
    for (leg, side) in LEGS.iter().zip([1.0, -1.0, 1.0, -1.0]) {
        limbs.extend(leg.limbs());
        if leg.lower.x > 0.0 {
            limbs.push(limb(vec3(0.36, side * 0.15, 1.02), leg.upper, 0.12, 0.11).wide(Vec3::Y, 0.72));
        } else {
            // Hooks and pins of the hips stand out.
            limbs.push(limb(vec3(-0.44, side * 0.165, 1.11), vec3(-0.54, side * 0.13, 1.07), 0.055, 0.09));
            limbs.push(limb(vec3(-0.78, side * 0.09, 1.06), vec3(-0.7, side * 0.1, 1.0), 0.05, 0.08));
            limbs.push(limb(vec3(-0.6, side * 0.13, 0.98), leg.upper, 0.16, 0.12).wide(Vec3::Y, 0.75));
            limbs.push(limb(vec3(-0.72, side * 0.13, 0.92), leg.lower + Vec3::Z * 0.06, 0.1, 0.04));
        }
    }
    let mut body = Blend::new(limbs, 0.06);
    body.floor_m = 0.0;
    body.surface(0.0425)
}

/// A long face, and ears that hang.
fn head(fur: u16, dark: u16) -> Shape {
    let limb = Limb::new;
    let skull = vec![
        limb(vec3(0.8, 0.0, 1.2), vec3(0.88, 0.0, 1.25), 0.105, 0.1).wide(Vec3::Y, 0.72),
        limb(vec3(0.91, 0.0, 1.32), vec3(0.98, 0.0, 1.24), 0.085, 0.1).wide(Vec3::Y, 0.95),
        limb(vec3(0.98, 0.0, 1.22), vec3(1.17, 0.0, 1.03), 0.09, 0.062).wide(Vec3::Y, 0.9),
        limb(vec3(0.95, 0.0, 1.15), vec3(1.12, 0.0, 1.0), 0.06, 0.045).wide(Vec3::Y, 0.8),
    ];
    let muzzle = [vec2(1.1, 0.9), vec2(1.205, 1.1), vec2(1.4, 1.1), vec2(1.4, 0.9)];
    let skull = Blend::new(skull, 0.04).surface(0.027).slot(fur).mark(&Prism::side(&muzzle, -1.0..=1.0), dark);
    let ear = Shape::ellipsoid(vec3(0.05, 0.125, 0.018), 14).bent(|p| p - Vec3::Z * p.y * p.y * 1.4);
    let ear = ear.turned(Quat::from_euler(glam::EulerRot::XYZ, -0.75, 0.5, 0.0)).moved(vec3(0.87, 0.18, 1.24));
    let eye = Shape::ellipsoid(vec3(0.026, 0.016, 0.02), 10).moved(vec3(0.985, 0.084, 1.26));
    Shape::join([skull, ear.both_sides().slot(fur), eye.both_sides().slot(dark)])
}

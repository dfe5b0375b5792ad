//! Animals that run about streets: dogs, cats, pigeons; cattle have a file of their own.

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Kind, Material};

use crate::shape::{Blend, Limb, Model, Shape};

pub(super) fn assets() -> Vec<Asset> {
    vec![
        dog("dog", 1.0, 2.0),
        dog("dog-small", 0.62, 1.5).tagged(["dog", "small"]),
        cat(),
        pigeon("pigeon", 0.0),
        pigeon("pigeon-pecking", 0.95).tagged(["pigeon"]),
    ]
}

pub(super) fn animal(model: Model, name: &str, commonness: f32) -> Asset {
    let asset = model.asset(&format!("animal/{name}"), Kind::Animal, Kind::Animal.class());
    Asset { commonness, ..asset }.tagged([name])
}

/// Hair or feathers of a colour.
pub(super) fn coat(color: Vec3) -> Material {
    Material { sheen: 0.6, ..Material::plain("coat", color, 0.9) }
}

const COATS: [Vec3; 6] = [
    vec3(0.25, 0.13, 0.06),
    vec3(0.018, 0.015, 0.013),
    vec3(0.42, 0.33, 0.21),
    vec3(0.3, 0.29, 0.28),
    vec3(0.12, 0.06, 0.03),
    vec3(0.3, 0.19, 0.09),
];

/// A walking dog: deep chest, tucked belly, bent hocks, hanging ears, collar.
fn dog(name: &str, scale: f32, commonness: f32) -> Asset {
    let mut model = Model::default();
    let fur = model.slot(coat(COATS[0]), &COATS);
    let dark = model.slot(Material::plain("nose", Vec3::splat(0.012), 0.35), &[]);
    let collar = model.slot(Material::plain("collar", vec3(0.3, 0.02, 0.02), 0.5), &[]);
    let limb = Limb::new;
    let mut limbs = vec![
        limb(vec3(0.14, 0.0, 0.43), vec3(0.2, 0.0, 0.42), 0.118, 0.115).wide(Vec3::Y, 0.82),
        limb(vec3(-0.18, 0.0, 0.475), vec3(0.1, 0.0, 0.45), 0.08, 0.1).wide(Vec3::Y, 0.85),
        limb(vec3(-0.22, 0.0, 0.47), vec3(-0.19, 0.0, 0.47), 0.092, 0.09).wide(Vec3::Y, 0.85),
        limb(vec3(0.2, 0.0, 0.5), vec3(0.34, 0.0, 0.65), 0.085, 0.058),
        limb(vec3(0.355, 0.0, 0.685), vec3(0.4, 0.0, 0.685), 0.072, 0.066).wide(Vec3::Y, 0.95),
        limb(vec3(0.43, 0.0, 0.665), vec3(0.54, 0.0, 0.64), 0.04, 0.029),
        limb(vec3(0.42, 0.0, 0.64), vec3(0.5, 0.0, 0.618), 0.03, 0.02),
        limb(vec3(-0.27, 0.0, 0.51), vec3(-0.37, 0.0, 0.56), 0.03, 0.024),
        limb(vec3(-0.37, 0.0, 0.56), vec3(-0.43, 0.0, 0.67), 0.024, 0.012),
    ];
    for (i, side) in [1.0, -1.0].into_iter().enumerate() {
        let swing = if i == 0 { 0.1 } else { -0.08 };
        let y = side * 0.07;
        let elbow = vec3(0.15 + swing * 0.3, y, 0.27);
        let wrist = vec3(0.19 + swing * 0.8, y, 0.11);
        limbs.push(limb(vec3(0.19, y * 0.95, 0.42), elbow, 0.058, 0.034));
        limbs.push(limb(elbow, wrist, 0.031, 0.021));
        limbs.push(limb(wrist, vec3(0.195 + swing, y, 0.03), 0.02, 0.02));
        limbs.push(limb(vec3(0.195 + swing, y, 0.022), vec3(0.24 + swing, y, 0.02), 0.026, 0.022).wide(Vec3::Y, 1.1));
        let knee = vec3(-0.14 - swing * 0.3, y, 0.3);
        let hock = vec3(-0.28 - swing * 0.6, y, 0.19);
        limbs.push(limb(vec3(-0.21, y * 0.9, 0.44), knee, 0.078, 0.048).wide(Vec3::Y, 0.8));
        limbs.push(limb(knee, hock, 0.044, 0.023));
        limbs.push(limb(hock, vec3(-0.25 - swing, y, 0.03), 0.021, 0.019));
        limbs.push(limb(vec3(-0.25 - swing, y, 0.022), vec3(-0.2 - swing, y, 0.02), 0.025, 0.021).wide(Vec3::Y, 1.1));
        limbs.push(
            limb(vec3(0.36, side * 0.055, 0.735), vec3(0.35, side * 0.082, 0.66), 0.017, 0.02).wide(Vec3::X, 1.6),
        );
    }
    let mut blend = Blend::new(limbs, 0.03);
    blend.floor_m = 0.0;
    let size = Vec3::splat(scale);
    model.add(fur, blend.surface(0.018).scaled(size));
    model.add(dark, Shape::ellipsoid(vec3(0.015, 0.018, 0.014), 10).moved(vec3(0.565, 0.0, 0.65)).scaled(size));
    for side in [1.0, -1.0] {
        model.add(dark, Shape::ellipsoid(Vec3::splat(0.0095), 8).moved(vec3(0.447, side * 0.04, 0.706)).scaled(size));
    }
    let ring = [vec2(0.074, -0.012), vec2(0.079, -0.01), vec2(0.077, 0.012), vec2(0.07, 0.012)];
    let band = Shape::lathe(&ring, 20).turned(Quat::from_rotation_y(0.75)).moved(vec3(0.275, 0.0, 0.585));
    model.add(collar, band.scaled(size));
    animal(model, name, commonness)
}

/// A cat that walks with its tail up.
fn cat() -> Asset {
    let mut model = Model::default();
    let fur = model.slot(coat(COATS[1]), &[COATS[1], vec3(0.28, 0.14, 0.05), COATS[3], vec3(0.45, 0.42, 0.38)]);
    let dark = model.slot(Material::plain("nose", vec3(0.05, 0.02, 0.02), 0.4), &[]);
    let eye = model.slot(Material::plain("eye", vec3(0.2, 0.24, 0.03), 0.1), &[]);
    let limb = Limb::new;
    let mut limbs = vec![
        limb(vec3(-0.13, 0.0, 0.205), vec3(0.11, 0.0, 0.2), 0.06, 0.057).wide(Vec3::Y, 0.85),
        limb(vec3(0.12, 0.0, 0.22), vec3(0.17, 0.0, 0.26), 0.047, 0.036),
        limb(vec3(0.19, 0.0, 0.285), vec3(0.205, 0.0, 0.283), 0.043, 0.041).wide(Vec3::Y, 1.1),
        limb(vec3(0.23, 0.0, 0.27), vec3(0.24, 0.0, 0.268), 0.02, 0.018),
        limb(vec3(-0.18, 0.0, 0.23), vec3(-0.24, 0.0, 0.31), 0.02, 0.016),
        limb(vec3(-0.24, 0.0, 0.31), vec3(-0.235, 0.0, 0.42), 0.016, 0.014),
        limb(vec3(-0.235, 0.0, 0.42), vec3(-0.265, 0.0, 0.465), 0.014, 0.011),
    ];
    for (i, side) in [1.0, -1.0].into_iter().enumerate() {
        let swing = if i == 0 { 0.04 } else { -0.04 };
        let y = side * 0.036;
        limbs.push(limb(vec3(0.1, y, 0.19), vec3(0.095 + swing * 0.4, y, 0.1), 0.032, 0.018));
        limbs.push(limb(vec3(0.095 + swing * 0.4, y, 0.1), vec3(0.11 + swing, y, 0.016), 0.017, 0.014));
        limbs.push(limb(vec3(0.115 + swing, y, 0.014), vec3(0.13 + swing, y, 0.013), 0.017, 0.015));
        limbs.push(limb(vec3(-0.13, y, 0.19), vec3(-0.1 - swing * 0.4, y, 0.115), 0.044, 0.027));
        limbs.push(limb(vec3(-0.1 - swing * 0.4, y, 0.115), vec3(-0.165 - swing, y, 0.075), 0.025, 0.015));
        limbs.push(limb(vec3(-0.165 - swing, y, 0.075), vec3(-0.145 - swing, y, 0.014), 0.014, 0.013));
        limbs.push(limb(vec3(-0.145 - swing, y, 0.013), vec3(-0.12 - swing, y, 0.013), 0.016, 0.014));
        limbs.push(limb(vec3(0.185, side * 0.024, 0.317), vec3(0.182, side * 0.03, 0.345), 0.015, 0.003));
    }
    let mut blend = Blend::new(limbs, 0.016);
    blend.floor_m = 0.0;
    model.add(fur, blend.surface(0.01));
    model.add(dark, Shape::ellipsoid(vec3(0.005, 0.007, 0.005), 8).moved(vec3(0.259, 0.0, 0.274)));
    for side in [1.0, -1.0] {
        model.add(eye, Shape::ellipsoid(Vec3::splat(0.0075), 8).moved(vec3(0.236, side * 0.019, 0.293)));
    }
    animal(model, "cat", 0.7)
}

/// A pigeon on its feet; `bow_rad` brings its beak to the ground.
fn pigeon(name: &str, bow_rad: f32) -> Asset {
    let mut model = Model::default();
    let grey = vec3(0.16, 0.17, 0.2);
    let body = model.slot(coat(grey), &[grey, vec3(0.09, 0.095, 0.12), vec3(0.3, 0.29, 0.29), vec3(0.17, 0.1, 0.07)]);
    let bar = model.slot(coat(Vec3::splat(0.03)), &[]);
    let neck = model.slot(Material { coat: 0.6, ..coat(vec3(0.05, 0.11, 0.1)) }, &[]);
    let pink = model.slot(Material::plain("foot", vec3(0.36, 0.1, 0.08), 0.6), &[]);
    let limb = Limb::new;
    let hip = vec3(0.0, 0.0, 0.12);
    let bow = |shape: Shape| shape.moved(-hip).turned(Quat::from_rotation_y(bow_rad)).moved(hip);
    let trunk = Blend::new(
        vec![
            limb(vec3(-0.05, 0.0, 0.12), vec3(0.055, 0.0, 0.14), 0.046, 0.056),
            limb(vec3(-0.07, 0.0, 0.115), vec3(-0.165, 0.0, 0.085), 0.032, 0.016).wide(Vec3::Y, 1.8),
        ],
        0.03,
    );
    model.add(body, bow(trunk.surface(0.0075)));
    let head = Blend::new(
        vec![
            limb(vec3(0.075, 0.0, 0.155), vec3(0.095, 0.0, 0.215), 0.041, 0.025),
            limb(vec3(0.1, 0.0, 0.235), vec3(0.108, 0.0, 0.236), 0.024, 0.022),
        ],
        0.02,
    );
    model.add(neck, bow(head.surface(0.007)));
    model.add(bar, bow(Shape::tapered_tube(&[(vec3(0.125, 0.0, 0.236), 0.008), (vec3(0.15, 0.0, 0.229), 0.002)], 7)));
    for side in [1.0, -1.0] {
        let wing = Shape::ellipsoid(vec3(0.105, 0.016, 0.042), 18).turned(Quat::from_rotation_y(0.16));
        model.add(body, bow(wing.moved(vec3(-0.035, side * 0.046, 0.135))));
        for x in [-0.05, -0.085] {
            let stripe = Shape::ellipsoid(vec3(0.008, 0.013, 0.034), 10).turned(Quat::from_rotation_y(-0.5));
            model.add(bar, bow(stripe.moved(vec3(x, side * 0.052, 0.128))));
        }
        model.add(bar, bow(Shape::ellipsoid(Vec3::splat(0.0045), 8).moved(vec3(0.112, side * 0.02, 0.242))));
        let foot = vec3(0.01, side * 0.022, 0.003);
        model.add(pink, Shape::tube(&[vec3(0.0, side * 0.022, 0.09), foot + Vec3::Z * 0.01], 0.005, 6));
        for toe in [Vec2::new(0.03, 0.012), Vec2::new(0.034, 0.0), Vec2::new(0.03, -0.012), Vec2::new(-0.02, 0.0)] {
            model.add(pink, Shape::tube(&[foot + Vec3::Z * 0.005, foot + toe.extend(0.001)], 0.0035, 5));
        }
    }
    animal(model, name, 0.6)
}

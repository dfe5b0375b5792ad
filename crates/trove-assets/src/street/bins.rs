//! Litter bins.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Material};

use super::finish::{
    bar, board, concrete, dark, galvanised, painted, plastic, post, rounded, rust_at_foot, stainless, timber,
};
use crate::shape::{Model, Shape};

pub(super) fn assets() -> Vec<Asset> {
    vec![round_bin(), post_bin(), steel_bin(), timber_bin(), bag_ring(), recycling()]
}

fn bin(model: Model, name: &str) -> Asset {
    model.asset(&format!("bin/{name}"), Kind::Bin, Class::Void).tagged([name])
}

/// A steel drum of slats with a dark opening under a lid.
fn round_bin() -> Asset {
    let mut model = Model::default();
    let green = vec3(0.03, 0.06, 0.045);
    let frame = model.slot(painted(green), &[green, Vec3::splat(0.05), vec3(0.1, 0.1, 0.1)]);
    let liner = model.slot(plastic(Vec3::splat(0.03)), &[]);
    model.add(liner, post(vec3(0.0, 0.0, 0.06), 0.235, 0.72, 24));
    for k in 0..20 {
        let turn = Quat::from_rotation_z(TAU * k as f32 / 20.0);
        model.add(frame, bar(vec3(0.265, 0.0, 0.42), vec3(0.014, 0.05, 0.74)).turned(turn));
        if k % 5 == 0 {
            model.add(frame, bar(vec3(0.25, 0.0, 0.87), vec3(0.02, 0.03, 0.2)).turned(turn));
        }
    }
    for z in [0.05, 0.78] {
        let ring = [vec2(0.25, z), vec2(0.28, z), vec2(0.28, z + 0.04), vec2(0.25, z + 0.04), vec2(0.25, z)];
        model.add(frame, Shape::lathe(&ring, 28));
    }
    let lid = [(0.0, 0.95), (0.29, 0.95), (0.29, 0.97), (0.2, 1.03), (0.0, 1.06)];
    model.add(frame, Shape::lathe(&lid.map(|(r, z)| vec2(r, z)), 28));
    model.add(frame, post(Vec3::ZERO, 0.2, 0.06, 20));
    bin(model, "round")
}

/// A box on a post.
fn post_bin() -> Asset {
    let mut model = Model::default();
    let orange = vec3(0.5, 0.2, 0.03);
    let body = model.slot(plastic(orange), &[orange, vec3(0.05, 0.15, 0.08), Vec3::splat(0.1)]);
    let black = model.slot(dark(), &[]);
    let steel = model.slot(galvanised(), &[]);
    model.add(steel, post(vec3(-0.2, 0.0, 0.0), 0.035, 1.2, 14));
    model.add(body, Shape::rounded_block(vec3(0.34, 0.42, 0.72), 0.05).moved(vec3(0.0, 0.0, 0.72)));
    model.add(body, Shape::rounded_block(vec3(0.37, 0.45, 0.07), 0.03).moved(vec3(0.01, 0.0, 1.08)));
    model.add(black, bar(vec3(0.168, 0.0, 0.95), vec3(0.012, 0.3, 0.11)));
    model.add(steel, bar(vec3(-0.17, 0.0, 0.5), vec3(0.05, 0.1, 0.05)));
    bin(model, "post")
}

/// A brushed drum with a domed hood, a slot in it and an ashtray.
fn steel_bin() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(stainless(), &[]);
    let black = model.slot(dark(), &[]);
    let body = [
        (0.0, 0.0),
        (0.2, 0.0),
        (0.2, 0.03),
        (0.21, 0.05),
        (0.21, 0.72),
        (0.215, 0.73),
        (0.215, 0.76),
        (0.205, 0.77),
        (0.0, 0.77),
    ];
    model.add(steel, Shape::lathe(&body.map(|(r, z)| vec2(r, z)), 32));
    let hood = [(0.215, 0.78), (0.215, 1.0), (0.2, 1.05), (0.15, 1.1), (0.08, 1.125), (0.0, 1.13)];
    model.add(steel, Shape::lathe(&hood.map(|(r, z)| vec2(r, z)), 32));
    model.add(black, Shape::rounded_block(vec3(0.06, 0.26, 0.09), 0.015).moved(vec3(0.18, 0.0, 0.9)));
    model.add(black, post(Vec3::Z * 1.115, 0.055, 0.022, 16));
    bin(model, "steel")
}

/// A box clad with boards under a steel lid.
fn timber_bin() -> Asset {
    let mut model = Model::default();
    let wood = model.slot(timber(), &[Vec3::ONE, vec3(0.8, 0.75, 0.7)]);
    let steel = model.slot(painted(Vec3::splat(0.045)), &[]);
    let black = model.slot(dark(), &[]);
    model.add(steel, bar(vec3(0.0, 0.0, 0.45), vec3(0.42, 0.42, 0.82)));
    for k in 0..4 {
        let turn = Quat::from_rotation_z(FRAC_PI_2 * k as f32);
        for i in -2..=2 {
            let plank = board(vec3(0.222, 0.092 * i as f32, 0.43 + 0.001 * k as f32), vec3(0.022, 0.084, 0.78));
            model.add(wood, plank.turned(turn));
        }
    }
    model.add(black, Shape::rounded_block(vec3(0.36, 0.36, 0.06), 0.02).moved(Vec3::Z * 0.9));
    for (x, y) in [(0.19, 0.19), (-0.19, 0.19), (-0.19, -0.19), (0.19, -0.19)] {
        model.add(steel, bar(vec3(x, y, 0.97), vec3(0.03, 0.03, 0.16)));
        model.add(steel, bar(vec3(x, y, 0.02), vec3(0.05, 0.05, 0.04)));
    }
    model.add(steel, Shape::rounded_block(vec3(0.5, 0.5, 0.04), 0.015).moved(Vec3::Z * 1.06));
    bin(model, "timber")
}

/// A sack that hangs from a ring on a post, half full.
fn bag_ring() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let film = Vec3::splat(0.025);
    let sack =
        model.slot(Material::plain("plastic film", film, 0.3), &[film, vec3(0.25, 0.32, 0.36), vec3(0.45, 0.3, 0.03)]);
    model.add(steel, post(vec3(-0.26, 0.0, 0.0), 0.028, 1.1, 12));
    let ring: Vec<Vec3> =
        (0..=24).map(|i| TAU * i as f32 / 24.0).map(|a| vec3(0.19 * a.cos(), 0.19 * a.sin(), 0.95)).collect();
    model.add(steel, Shape::tube(&ring, 0.011, 8));
    model.add(steel, bar(vec3(-0.22, 0.0, 0.95), vec3(0.08, 0.05, 0.03)));
    let profile = [
        (0.0, 0.16),
        (0.13, 0.15),
        (0.19, 0.22),
        (0.21, 0.36),
        (0.19, 0.52),
        (0.16, 0.7),
        (0.18, 0.86),
        (0.2, 0.95),
        (0.205, 0.9),
        (0.21, 0.84),
    ];
    let hung = Shape::lathe(&profile.map(|(r, z)| vec2(r, z)), 34).bent(|p| {
        let angle = p.y.atan2(p.x);
        let fold = 1.0
            + 0.09 * (angle * 6.0 + p.z * 11.0).sin() * f32::from(p.z < 0.9)
            + 0.04 * (angle * 13.0 - p.z * 29.0).sin();
        vec3(p.x * fold, p.y * fold, p.z)
    });
    model.add(sack, hung);
    rust_at_foot(&mut model, steel, 0.1);
    bin(model, "bag")
}

/// Three bins in a row for paper, glass and the rest.
fn recycling() -> Asset {
    let mut model = Model::default();
    let shell = model.slot(painted(vec3(0.1, 0.105, 0.11)), &[]);
    let black = model.slot(dark(), &[]);
    let foot = model.slot(concrete(), &[]);
    model.add(foot, Shape::rounded_block(vec3(0.5, 1.56, 0.06), 0.01).moved(Vec3::Z * 0.03));
    for (i, color) in [vec3(0.03, 0.12, 0.4), vec3(0.04, 0.25, 0.06), vec3(0.6, 0.38, 0.02)].into_iter().enumerate() {
        let y = 0.5 * (i as f32 - 1.0);
        let lid = model.slot(plastic(color), &[]);
        model.add(shell, Shape::rounded_block(vec3(0.44, 0.46, 0.86), 0.025).moved(vec3(0.0, y, 0.5)));
        model.add(lid, Shape::rounded_block(vec3(0.46, 0.48, 0.14), 0.04).moved(vec3(0.0, y, 0.99)));
        let mouth: Vec<Vec2> = if i == 0 { rounded(vec2(0.3, 0.07), 0.02) } else { rounded(vec2(0.17, 0.17), 0.08) };
        model.add(
            black,
            Shape::extruded(&mouth, 0.01).turned(Quat::from_rotation_z(FRAC_PI_2)).moved(vec3(0.0, y, 1.055)),
        );
        model.add(lid, bar(vec3(0.221, y, 0.68), vec3(0.004, 0.24, 0.16)));
        model.add(black, bar(vec3(0.223, y + 0.19, 0.5), vec3(0.008, 0.02, 0.06)));
    }
    bin(model, "recycling")
}

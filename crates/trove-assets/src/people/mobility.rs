//! People with wheels: prams, wheelchairs, kick scooters, skateboards.

use std::f32::consts::TAU;

use glam::{Quat, Vec3, vec3};
use trove_model::{Asset, Kind, Material};

use super::{Figure, Hair, Outfit, Physique, Pose, Wardrobe};
use crate::shape::{Blend, Limb, Model, Shape};

/// Everyone with wheels.
pub(crate) fn assets() -> Vec<Asset> {
    let [scooters, boards] = [
        Outfit::CASUAL.in_all_weathers("person/kick-scooter", kick_scooter),
        Outfit::CASUAL.in_all_weathers("person/skateboard", skateboard),
    ];
    [scooters, boards, vec![stroller(), wheelchair()]].concat()
}

struct Metal {
    steel: u16,
    black: u16,
    cloth: u16,
}

fn start(body: Physique, pose: Pose, outfit: &Outfit) -> (Model, Metal, Figure) {
    let mut model = Model::default();
    let steel = Material { metalness: 1.0, ..Material::plain("steel", Vec3::splat(0.5), 0.3) };
    let cloths = [vec3(0.02, 0.02, 0.024), vec3(0.03, 0.06, 0.16), vec3(0.3, 0.03, 0.04), vec3(0.12, 0.13, 0.13)];
    let metal = Metal {
        steel: model.slot(steel, &[]),
        black: model.slot(Material::plain("rubber", Vec3::splat(0.02), 0.7), &[]),
        cloth: model.slot(Material::plain("cloth", cloths[0], 0.85), &cloths),
    };
    let figure = Figure::new(body, pose);
    let slots = Wardrobe::new(&mut model, &[], &[]);
    model.add_marked(figure.dressed(outfit, &slots));
    model.shows(figure.keypoints());
    (model, metal, figure)
}

fn ring(radius_m: f32, thick_m: f32) -> Shape {
    let path: Vec<Vec3> =
        (0..=28).map(|i| TAU * i as f32 / 28.0).map(|a| vec3(a.cos(), 0.0, a.sin()) * (radius_m - thick_m)).collect();
    Shape::tube(&path, thick_m, 8)
}

/// A small solid wheel.
fn roller(radius_m: f32, width_m: f32) -> Shape {
    Shape::cylinder(radius_m, width_m, 20).upright().moved(Vec3::Y * -width_m / 2.0)
}

fn kick_scooter(id: &str, outfit: &Outfit) -> Asset {
    let body = Physique::MAN;
    let deck = 0.16;
    let h = body.height_m;
    let foot = |x: f32, side: f32| vec3(x, side * 0.05, deck + 0.045 * h);
    let pose = Pose {
        hips: vec3(0.02, 0.0, deck + 0.515 * h),
        lean_rad: 0.08,
        ankles: [foot(0.12, 1.0), foot(-0.2, -1.0)],
        toes_rad: [0.0; 2],
        wrists: [vec3(0.44, 0.24, 1.12), vec3(0.44, -0.24, 1.12)],
    };
    let (mut model, metal, _) = start(body, pose, outfit);
    model.add(metal.black, Shape::rounded_block(vec3(0.72, 0.17, 0.06), 0.025).moved(vec3(0.05, 0.0, deck - 0.03)));
    let stem = [vec3(0.62, 0.0, 0.12), vec3(0.52, 0.0, 1.14)];
    model.add(metal.steel, Shape::tube(&stem, 0.024, 10));
    model.add(metal.steel, Shape::tube(&[vec3(0.42, 0.0, deck - 0.02), vec3(0.6, 0.0, 0.3)], 0.026, 10));
    model.add(
        metal.black,
        Shape::tube(&[vec3(0.49, -0.27, 1.13), vec3(0.52, 0.0, 1.14), vec3(0.49, 0.27, 1.13)], 0.016, 8),
    );
    for x in [-0.42, 0.64] {
        model.add(metal.black, ring(0.11, 0.028).and(roller(0.07, 0.04)).moved(vec3(x, 0.0, 0.11)));
    }
    model.asset(id, Kind::PersonalMobility, Kind::PersonalMobility.class())
}

fn skateboard(id: &str, outfit: &Outfit) -> Asset {
    let body = Physique { height_m: 1.72, ..Physique::MAN };
    let (deck, h) = (0.12, body.height_m);
    let pose = Pose {
        hips: vec3(0.0, 0.0, deck + 0.48 * h),
        lean_rad: 0.18,
        ankles: [vec3(0.24, 0.03, deck + 0.045 * h), vec3(-0.24, -0.03, deck + 0.045 * h)],
        toes_rad: [0.0; 2],
        wrists: [vec3(0.3, 0.42, 1.05), vec3(-0.22, -0.44, 1.0)],
    };
    let (mut model, metal, _) = start(body, pose, outfit);
    model.add(metal.cloth, Shape::rounded_block(vec3(0.6, 0.2, 0.02), 0.009).moved(vec3(0.0, 0.0, deck - 0.01)));
    for side in [1.0, -1.0] {
        let kick = Shape::rounded_block(vec3(0.16, 0.19, 0.02), 0.009).turned(Quat::from_rotation_y(-0.4 * side));
        model.add(metal.cloth, kick.moved(vec3(0.36 * side, 0.0, deck + 0.02)));
        model.add(metal.steel, Shape::rounded_block(vec3(0.06, 0.12, 0.05), 0.01).moved(vec3(0.2 * side, 0.0, 0.065)));
        for y in [0.08, -0.08] {
            model.add(metal.black, roller(0.03, 0.035).moved(vec3(0.2 * side, y, 0.03)));
        }
    }
    model.asset(id, Kind::PersonalMobility, Kind::PersonalMobility.class())
}

fn stroller() -> Asset {
    let body = Physique::WOMAN;
    let mut pose = Pose::walking(&body, 0.3, true);
    pose.wrists = [vec3(0.36, 0.2, 1.02), vec3(0.36, -0.2, 1.02)];
    pose.lean_rad = 0.12;
    let (mut model, metal, _) = start(body, pose, &Outfit { hair: Hair::Tail, ..Outfit::JACKET });
    // Frame and wheels.
    for side in [1.0, -1.0] {
        let y = 0.24 * side;
        let handle = [vec3(0.42, y, 1.02), vec3(0.55, y, 0.85), vec3(1.25, y, 0.12)];
        model.add(metal.steel, Shape::tube(&handle, 0.013, 8));
        model.add(metal.steel, Shape::tube(&[vec3(0.62, y, 0.13), vec3(1.0, y, 0.6)], 0.013, 8));
        for (x, r) in [(0.6, 0.14), (1.27, 0.11)] {
            model.add(metal.black, ring(r, 0.022).and(roller(r * 0.55, 0.02)).moved(vec3(x, y * 1.1, r)));
        }
    }
    model.add(metal.black, Shape::capsule(vec3(0.42, -0.25, 1.02), vec3(0.42, 0.25, 1.02), 0.018, 8));
    // Seat, hood and basket.
    let limb = Limb::new;
    let seat = Blend::new(
        vec![
            limb(vec3(0.72, 0.0, 0.85), vec3(0.86, 0.0, 0.52), 0.09, 0.1).wide(Vec3::Y, 2.2),
            limb(vec3(0.86, 0.0, 0.5), vec3(1.12, 0.0, 0.48), 0.09, 0.07).wide(Vec3::Y, 2.4),
            limb(vec3(1.12, 0.0, 0.46), vec3(1.2, 0.0, 0.28), 0.05, 0.04).wide(Vec3::Y, 3.0),
        ],
        0.05,
    );
    model.add(metal.cloth, seat.surface(0.04));
    let hood: Vec<Vec<Vec3>> = (0..=6)
        .map(|i| {
            let a = 0.35 + 1.75 * i as f32 / 6.0;
            (0..=8)
                .map(|k| {
                    let b = TAU / 2.0 * k as f32 / 8.0;
                    vec3(0.86 + 0.3 * b.sin() * a.cos(), 0.24 * b.cos(), 0.82 + 0.3 * b.sin() * a.sin())
                })
                .collect()
        })
        .collect();
    model.add(metal.cloth, Shape::sheet(&hood).inside_out().plate(0.012));
    model.add(metal.black, Shape::rounded_block(vec3(0.5, 0.4, 0.14), 0.05).moved(vec3(0.88, 0.0, 0.26)));
    model.asset("person/stroller", Kind::Stroller, Kind::Stroller.class())
}

fn wheelchair() -> Asset {
    let body = Physique { height_m: 1.7, ..Physique::MAN };
    let pose = Pose {
        hips: vec3(0.0, 0.0, 0.6),
        lean_rad: -0.08,
        ankles: [vec3(0.55, 0.1, 0.2), vec3(0.55, -0.1, 0.2)],
        toes_rad: [-0.15; 2],
        wrists: [vec3(0.22, 0.27, 0.72), vec3(0.22, -0.27, 0.72)],
    };
    let (mut model, metal, _) = start(body, pose, &Outfit::JACKET);
    model.add(metal.cloth, Shape::rounded_block(vec3(0.46, 0.44, 0.07), 0.025).moved(vec3(0.1, 0.0, 0.5)));
    let back = Shape::rounded_block(vec3(0.04, 0.42, 0.46), 0.015).turned(Quat::from_rotation_y(-0.08));
    model.add(metal.cloth, back.moved(vec3(-0.16, 0.0, 0.74)));
    for side in [1.0, -1.0] {
        let y = 0.25 * side;
        let spokes = (0..10).map(|i| {
            let a = TAU * i as f32 / 10.0;
            Shape::tube(&[Vec3::ZERO, vec3(a.cos(), 0.0, a.sin()) * 0.29], 0.002, 3)
        });
        let big = vec3(0.0, y + 0.05 * side, 0.31);
        model.add(metal.black, ring(0.31, 0.016).moved(big));
        model.add(metal.steel, ring(0.27, 0.009).moved(big + Vec3::Y * 0.03 * side));
        model.add(metal.steel, Shape::join(spokes).and(roller(0.03, 0.06)).moved(big));
        model.add(metal.black, roller(0.07, 0.025).moved(vec3(0.42, y * 0.9, 0.07)));
        let frame = [
            vec3(-0.24, y, 0.98),
            vec3(-0.16, y, 0.9),
            vec3(-0.12, y, 0.5),
            vec3(0.36, y, 0.5),
            vec3(0.52, y * 0.8, 0.14),
        ];
        model.add(metal.steel, Shape::tube(&frame, 0.013, 8));
        model.add(
            metal.steel,
            Shape::tube(
                &[vec3(-0.12, y, 0.5), vec3(0.0, y, 0.31), vec3(0.42, y * 0.9, 0.14), vec3(0.42, y * 0.9, 0.07)],
                0.012,
                8,
            ),
        );
        model.add(metal.black, Shape::rounded_block(vec3(0.3, 0.05, 0.03), 0.012).moved(vec3(0.06, y, 0.7)));
        model.add(metal.black, Shape::rounded_block(vec3(0.16, 0.14, 0.015), 0.005).moved(vec3(0.6, 0.1 * side, 0.11)));
        model.add(metal.black, Shape::capsule(vec3(-0.24, y, 0.98), vec3(-0.33, y, 0.97), 0.015, 8));
    }
    model.asset("person/wheelchair", Kind::Wheelchair, Kind::Wheelchair.class())
}

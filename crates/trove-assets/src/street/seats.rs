//! Benches.

use glam::{Quat, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind};

use super::finish::{bar, board, galvanised, painted, timber};
use crate::shape::{Model, Shape};
use crate::surfaces;

pub(super) fn assets() -> Vec<Asset> {
    vec![slatted_bench(), mesh_bench(), granite_bench()]
}

fn slatted_bench() -> Asset {
    let mut model = Model::default();
    let wood = model.slot(timber(), &[Vec3::ONE, vec3(0.75, 0.7, 0.65), vec3(0.35, 0.45, 0.33)]);
    let iron = model.slot(painted(Vec3::splat(0.03)), &[]);
    for i in 0..5 {
        model.add(wood, board(vec3(0.17 - 0.095 * i as f32, 0.0, 0.445), vec3(0.075, 1.8, 0.035)));
    }
    let lean = Quat::from_rotation_y(-0.22);
    for i in 0..3 {
        let slat = board(vec3(0.0, 0.0, 0.12 + 0.115 * i as f32), vec3(0.03, 1.8, 0.085)).turned(lean);
        model.add(wood, slat.moved(vec3(-0.25, 0.0, 0.44)));
    }
    for y in [-0.75, 0.0, 0.75] {
        model.add(iron, bar(vec3(0.0, y, 0.415), vec3(0.46, 0.05, 0.025)));
        model.add(iron, bar(vec3(0.17, y, 0.2), vec3(0.045, 0.05, 0.42)));
        model.add(iron, bar(vec3(-0.2, y, 0.2), vec3(0.045, 0.05, 0.42)));
        model.add(iron, bar(vec3(0.0, 0.0, 0.2), vec3(0.02, 0.05, 0.48)).turned(lean).moved(vec3(-0.265, y, 0.43)));
        if y != 0.0 {
            model.add(iron, bar(vec3(-0.02, y, 0.65), vec3(0.42, 0.05, 0.03)));
            model.add(iron, bar(vec3(0.17, y, 0.54), vec3(0.03, 0.05, 0.2)));
        }
    }
    model.asset("bench/slatted", Kind::Bench, Class::Void).tagged(["slatted"])
}

/// A seat of steel rods on two frames, its back bent from the same rods.
fn mesh_bench() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(painted(vec3(0.08, 0.085, 0.09)), &[vec3(0.08, 0.085, 0.09), vec3(0.03, 0.09, 0.05)]);
    let zinc = model.slot(galvanised(), &[]);
    let curve = [
        vec2(0.24, 0.42),
        vec2(0.22, 0.45),
        vec2(0.05, 0.435),
        vec2(-0.14, 0.43),
        vec2(-0.2, 0.47),
        vec2(-0.27, 0.68),
        vec2(-0.31, 0.86),
    ];
    for i in 0..=36 {
        let y = -0.9 + 0.05 * i as f32;
        let path: Vec<Vec3> = curve.iter().map(|p| vec3(p.x, y, p.y)).collect();
        model.add(steel, Shape::tube(&path, if i % 18 == 0 { 0.016 } else { 0.005 }, 6));
    }
    for p in [curve[1], curve[3], curve[6]] {
        model.add(steel, Shape::tube(&[vec3(p.x, -0.9, p.y), vec3(p.x, 0.9, p.y)], 0.014, 8));
    }
    for y in [-0.6, 0.6] {
        model.add(zinc, bar(vec3(0.0, y, 0.22), vec3(0.07, 0.07, 0.42)));
        model.add(zinc, bar(vec3(-0.01, y, 0.41), vec3(0.4, 0.05, 0.03)));
        model.add(zinc, bar(vec3(0.0, y, 0.008), vec3(0.3, 0.14, 0.016)));
    }
    model.asset("bench/steel", Kind::Bench, Class::Void).tagged(["steel"])
}

/// A block of granite.
fn granite_bench() -> Asset {
    let mut model = Model::default();
    let stone = model.slot(surfaces::set("stone/granite"), &[]);
    model.add(stone, Shape::rounded_block(vec3(0.5, 1.9, 0.36), 0.012).moved(vec3(0.0, 0.0, 0.27)));
    model.add(stone, Shape::rounded_block(vec3(0.4, 1.7, 0.1), 0.008).moved(vec3(0.0, 0.0, 0.05)));
    model.asset("bench/granite", Kind::Bench, Class::Void).tagged(["granite"])
}

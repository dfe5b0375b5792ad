//! Trees with one straight stem: conifers and palms.

use std::f32::consts::TAU;

use glam::{Quat, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Seed};

use super::growth::{Foliage, limb};
use super::leaves::{Sprig, bark, material};
use super::trees::{SHADES, direction};
use crate::shape::{Model, Shape};

pub(super) fn assets() -> Vec<Asset> {
    vec![
        conifer("tree/spruce", 12.5, 2.7, 0.9, -0.35),
        conifer("tree/pine", 10.5, 2.6, 3.2, 0.25),
        palm("tree/palm", 8.0, 22, 3.3),
        palm("tree/palm-low", 4.6, 16, 2.5),
    ]
}

/// Whorls of branches on a straight trunk, shorter towards the top; `lift` is their slope.
fn conifer(id: &str, height_m: f32, reach_m: f32, clear_m: f32, lift: f32) -> Asset {
    let seed = Seed(12).child(id);
    let mut random = seed.random();
    let mut model = Model::default();
    let wood = model.slot(bark(&format!("{id}-bark"), vec3(0.125, 0.085, 0.06), 7), &[]);
    let green = vec3(0.06, 0.11, 0.045);
    let leaves = model.slot(material(&format!("{id}-leaves"), Sprig::Needles, green, seed.0), &SHADES);
    let radius = |z: f32| 0.02 + 0.17 * (1.0 - z / height_m);
    let trunk: Vec<(Vec3, f32)> = (0..=16)
        .map(|i| height_m * i as f32 / 16.0)
        .map(|z| (vec3(0.04 * (z * 0.8).sin(), 0.04 * (z * 0.6).cos(), z), radius(z)))
        .collect();
    model.add(wood, limb(&trunk));
    let mut foliage = Foliage::default();
    let mut z = clear_m;
    while z < height_m - 0.25 {
        let up = (z - clear_m) / (height_m - clear_m);
        let reach = reach_m * (1.0 - up).powf(0.8) * (0.45 + 0.55 * (up * 5.0).min(1.0)) + 0.25;
        let count = 5 + random.index(3);
        let first = random.range(0.0, f64::from(TAU)) as f32;
        for k in 0..count {
            let turn = first + TAU * k as f32 / count as f32 + random.range(-0.3, 0.3) as f32;
            let reach = reach * random.range(0.72, 1.12) as f32;
            let out = vec3(turn.cos(), turn.sin(), 0.0);
            let slope = lift + 0.5 * up;
            let at = |t: f32| {
                // The branch hangs and its end turns up.
                Vec3::Z * z + out * reach * t + Vec3::Z * reach * (slope * t + 0.22 * t * t - 0.1 * t)
            };
            let path: Vec<(Vec3, f32)> =
                (0..=4).map(|i| i as f32 / 4.0).map(|t| (at(t), 0.005 + 0.03 * (1.0 - up) * (1.0 - t))).collect();
            model.add(wood, limb(&path));
            let sprigs = 3 + (reach * 4.2) as usize;
            for i in 0..sprigs {
                let t = 0.18 + 0.82 * (i as f32 + 0.5) / sprigs as f32;
                let side = if i % 2 == 0 { 0.8 } else { -0.8 };
                let fan = Quat::from_rotation_z(side * (1.15 - t)) * out;
                for tilt in [-0.1, 0.3] {
                    let along = fan + Vec3::Z * (0.15 * lift + tilt) + direction(&mut random) * 0.25;
                    let face = Vec3::Z + direction(&mut random) * 0.45;
                    let outward = (out + Vec3::Z * 0.55).normalize_or(Vec3::Z);
                    foliage.card(at(t), along, face, 0.62 * random.range(0.8, 1.2) as f32, outward);
                }
            }
        }
        z += 0.36 + 0.12 * random.unit() as f32;
    }
    foliage.card(Vec3::Z * (height_m - 0.5), Vec3::Z, Vec3::X, 0.7, Vec3::Z);
    foliage.card(Vec3::Z * (height_m - 0.5), Vec3::Z, Vec3::Y, 0.7, Vec3::Z);
    model.add(leaves, foliage.into_shape());
    model.asset(id, Kind::Tree, Class::Tree)
}

/// A ringed trunk with a head of arching fronds.
fn palm(id: &str, trunk_m: f32, fronds: usize, frond_m: f32) -> Asset {
    let seed = Seed(13).child(id);
    let mut random = seed.random();
    let mut model = Model::default();
    let wood = model.slot(bark(&format!("{id}-bark"), vec3(0.2, 0.175, 0.14), 9), &[]);
    let green = vec3(0.105, 0.161, 0.045);
    let leaves = model.slot(material(&format!("{id}-leaves"), Sprig::Frond, green, seed.0), &SHADES);
    let lean = vec2(0.5, 0.2) * trunk_m / 8.0;
    let axis = |z: f32| (lean * (z / trunk_m).powi(2)).extend(z);
    let rings = (trunk_m / 0.16) as usize;
    let trunk: Vec<(Vec3, f32)> = (0..=rings)
        .map(|i| {
            let z = trunk_m * i as f32 / rings as f32;
            let swell = 0.13 + 0.1 * (-z / 0.4).exp() + if i % 2 == 0 { 0.007 } else { -0.004 };
            (axis(z), swell)
        })
        .collect();
    model.add(wood, limb(&trunk));
    // The bright green shaft that the leaves come out of.
    let shaft = model.slot(trove_model::Material::plain("crown shaft", vec3(0.09, 0.13, 0.05), 0.5), &[]);
    let top = axis(trunk_m);
    let profile = [vec2(0.12, -0.1), vec2(0.15, 0.1), vec2(0.12, 0.5), vec2(0.05, 0.8), vec2(0.0, 0.85)];
    model.add(shaft, Shape::lathe(&profile, 12).moved(top));
    for k in 0..fronds {
        let t = k as f32 / fronds as f32;
        let turn = k as f32 * 2.399_963 + random.range(-0.2, 0.2) as f32;
        let length = frond_m * random.range(0.85, 1.1) as f32;
        let pitch = 1.25 - 1.55 * t;
        model.add(leaves, frond(top + Vec3::Z * 0.65, turn, pitch, length));
    }
    model.asset(id, Kind::Tree, Class::Tree)
}

/// A frond that leaves at a pitch and bows under its weight; its two halves hang from the rib.
fn frond(foot: Vec3, turn: f32, pitch: f32, length_m: f32) -> Shape {
    const STEPS: usize = 9;
    let out = vec3(turn.cos(), turn.sin(), 0.0);
    let across = vec3(-turn.sin(), turn.cos(), 0.0);
    let mut at = foot;
    let mut shape = Shape::default();
    for i in 0..=STEPS {
        let t = i as f32 / STEPS as f32;
        let angle = pitch - 1.5 * t * t;
        let up = Vec3::Z * angle.cos() - out * angle.sin();
        for (u, side) in [(0.0, -1.0), (0.5, 0.0), (1.0, 1.0f32)] {
            let hang = 0.65 * side.abs();
            shape.positions.push(at + (across * side * 0.85 - up * hang) * length_m * 0.25);
            shape.normals.push((up + across * side * 0.35 + out * 0.3).normalize_or(Vec3::Z));
            shape.uvs.push(vec2(u, t));
        }
        at += (out * angle.cos() + Vec3::Z * angle.sin()) * length_m / STEPS as f32;
    }
    for i in 0..STEPS as u32 {
        for half in 0..2 {
            let a = 3 * i + half;
            shape.triangles.extend([[a, a + 4, a + 1], [a, a + 3, a + 4]]);
            shape.slots.extend([0, 0]);
        }
    }
    shape
}

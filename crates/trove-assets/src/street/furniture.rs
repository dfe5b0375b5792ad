//! Bollards, hydrants, bicycle racks and shelters.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind};

use super::finish::{bar, board, galvanised, glass, grey_timber, painted, post, reflective, rubber, stainless, timber};
use crate::shape::{Model, Shape};

pub(super) fn assets() -> Vec<Asset> {
    vec![
        hydrant("pillar", vec3(0.42, 0.03, 0.02)),
        hydrant("yellow", vec3(0.52, 0.34, 0.02)),
        timber_bollard(),
        rack(true),
        rack(false),
        shelter(),
    ]
}

fn timber_bollard() -> Asset {
    let mut model = Model::default();
    let wood = model.slot(grey_timber(), &[]);
    let tape = model.slot(reflective(vec3(0.66, 0.66, 0.62)), &[]);
    let section =
        |z: f32, side: f32| super::finish::rounded(vec2(side, side), 0.018).iter().map(|p| p.extend(z)).collect();
    let rings: Vec<Vec<Vec3>> =
        [(0.0, 0.16), (0.93, 0.16), (0.945, 0.155), (0.99, 0.07)].map(|(z, side)| section(z, side)).to_vec();
    model.add(wood, Shape::loft(&rings).laid(Vec3::Z, vec2(0.3, 0.7)));
    model.add(tape, bar(vec3(0.0, 0.0, 0.82), vec3(0.163, 0.163, 0.06)));
    model.asset("bollard/timber", Kind::Bollard, Class::TrafficSign).tagged(["timber"])
}

fn hydrant(name: &str, color: Vec3) -> Asset {
    let mut model = Model::default();
    let red = model.slot(painted(color), &[]);
    let cap = model.slot(painted(color * 0.8), &[]);
    let profile = [
        (0.0, 0.0),
        (0.16, 0.0),
        (0.16, 0.04),
        (0.1, 0.05),
        (0.1, 0.5),
        (0.13, 0.52),
        (0.13, 0.56),
        (0.11, 0.58),
        (0.1, 0.66),
        (0.05, 0.73),
        (0.03, 0.74),
        (0.03, 0.79),
        (0.0, 0.8),
    ];
    model.add(red, Shape::lathe(&profile.map(|(r, z)| vec2(r, z)), 24));
    let nozzle = |radius: f32, length: f32| {
        let points =
            [(0.0, 0.0), (radius, 0.0), (radius, length), (radius * 1.3, length), (radius * 1.3, length + 0.05)];
        Shape::lathe(&points.into_iter().chain([(0.0, length + 0.05)]).map(|(r, z)| vec2(r, z)).collect::<Vec<_>>(), 16)
            .turned(Quat::from_rotation_y(PI / 2.0))
    };
    for (turn, radius) in [(0.0, 0.06), (PI / 2.0, 0.045), (-PI / 2.0, 0.045)] {
        model.add(cap, nozzle(radius, 0.14).turned(Quat::from_rotation_z(turn)).moved(vec3(0.0, 0.0, 0.42)));
    }
    for k in 0..8 {
        let at = Quat::from_rotation_z(TAU * k as f32 / 8.0) * vec3(0.135, 0.0, 0.04);
        model.add(cap, post(at, 0.012, 0.02, 6));
    }
    model.asset(&format!("hydrant/{name}"), Kind::Hydrant, Class::TrafficSign).tagged([name])
}

/// Hoops along x, with bicycles leaning on most of them or empty.
fn rack(used: bool) -> Asset {
    let mut model = Model::default();
    let steel = model.slot(stainless(), &[]);
    let blue = vec3(0.02, 0.07, 0.2);
    let frames = [blue, vec3(0.25, 0.02, 0.02), Vec3::splat(0.03), vec3(0.4, 0.4, 0.38)]
        .map(|color| model.slot(painted(color), &[]));
    let tyres = model.slot(rubber(), &[]);
    let metal = model.slot(galvanised(), &[]);
    for i in 0..6 {
        let x = (i as f32 - 2.5) * 1.0;
        let arc = (0..=8).map(|k| PI * k as f32 / 8.0).map(|a| vec3(x, -0.38 * a.cos(), 0.55 + 0.28 * a.sin()));
        let path: Vec<Vec3> = std::iter::once(vec3(x, -0.38, 0.0)).chain(arc).chain([vec3(x, 0.38, 0.0)]).collect();
        model.add(steel, Shape::tube(&path, 0.024, 10));
        if used && i != 3 {
            let lean = Quat::from_rotation_y(0.07);
            let turn = Quat::from_rotation_z(PI / 2.0 * if i % 2 == 0 { 1.0 } else { -1.0 });
            for (slot, part) in bicycle(frames[i % 4], tyres, metal) {
                model.add(slot, part.turned(turn).turned(lean).moved(vec3(x + 0.09, 0.0, 0.01)));
            }
        }
    }
    let name = if used { "hoops" } else { "empty" };
    model.asset(&format!("bicycle-rack/{name}"), Kind::BicycleRack, Class::Void).tagged([name])
}

/// A parked bicycle along x: wheels, frame, saddle, handlebar.
fn bicycle(frame: u16, tyres: u16, metal: u16) -> Vec<(u16, Shape)> {
    let (rear, front, radius) = (vec3(-0.52, 0.0, 0.34), vec3(0.52, 0.0, 0.34), 0.34);
    let (crank, seat, head) = (vec3(-0.08, 0.0, 0.29), vec3(-0.22, 0.0, 0.82), vec3(0.38, 0.0, 0.83));
    let mut parts = Vec::new();
    for hub in [rear, front] {
        let ring: Vec<Vec3> = (0..=28)
            .map(|i| TAU * i as f32 / 28.0)
            .map(|a| hub + vec3(a.cos(), 0.0, a.sin()) * (radius - 0.018))
            .collect();
        parts.push((tyres, Shape::tube(&ring, 0.018, 6)));
        for k in 0..9 {
            let a = PI * k as f32 / 9.0;
            let reach = vec3(a.cos(), 0.0, a.sin()) * (radius - 0.03);
            parts.push((metal, Shape::tube(&[hub - reach, hub + reach], 0.0015, 3)));
        }
    }
    for (a, b) in [(crank, seat), (crank, head), (seat, head), (rear, crank), (rear, seat), (front, head)] {
        parts.push((frame, Shape::tube(&[a, b], 0.016, 7)));
    }
    parts.push((metal, Shape::tube(&[seat, seat + vec3(-0.04, 0.0, 0.13)], 0.013, 7)));
    parts.push((tyres, Shape::ellipsoid(vec3(0.13, 0.07, 0.03), 12).moved(seat + vec3(-0.03, 0.0, 0.15))));
    let bar = [vec3(0.3, -0.27, 1.0), vec3(0.4, -0.1, 0.98), vec3(0.4, 0.1, 0.98), vec3(0.3, 0.27, 1.0)];
    parts.push((metal, Shape::tube(&bar, 0.012, 7)));
    parts.push((metal, Shape::tube(&[head, vec3(0.4, 0.0, 0.98)], 0.013, 7)));
    parts.push((metal, Shape::cylinder(0.085, 0.01, 16).turned(Quat::from_rotation_x(PI / 2.0)).moved(crank)));
    parts
}

/// A bus stop: glass at the back and one side, a roof, a bench; it opens towards x.
fn shelter() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(painted(vec3(0.1, 0.105, 0.11)), &[]);
    let pane = model.slot(glass(), &[]);
    let roof = model.slot(painted(vec3(0.32, 0.33, 0.34)), &[]);
    let wood = model.slot(timber(), &[]);
    let poster = super::posters::poster(0);
    let poster = model.slot(poster, &[]);
    for (x, y) in [(-0.65, -1.9), (-0.65, 0.0), (-0.65, 1.9), (0.5, 1.9), (0.5, -1.9)] {
        model.add(steel, bar(vec3(x, y, 1.22), vec3(0.08, 0.08, 2.44)));
    }
    for y in [-0.95, 0.95] {
        model.add(pane, Shape::block(vec3(0.01, 1.7, 1.9)).moved(vec3(-0.65, y, 1.25)));
        model.add(steel, bar(vec3(-0.65, y, 0.28), vec3(0.05, 1.82, 0.05)));
        model.add(steel, bar(vec3(-0.65, y, 2.24), vec3(0.05, 1.82, 0.06)));
    }
    model.add(pane, Shape::block(vec3(0.95, 0.01, 1.9)).moved(vec3(-0.08, -1.9, 1.25)));
    model.add(steel, bar(vec3(-0.08, 1.9, 1.25), vec3(1.05, 0.1, 1.95)));
    for turn in [0.0, PI] {
        let face = super::signs::face(vec2(0.95, 1.75)).turned(Quat::from_rotation_z(PI / 2.0));
        model.add(
            poster,
            face.moved(vec3(0.0, 0.053, 0.0)).turned(Quat::from_rotation_z(turn)).moved(vec3(-0.08, 1.9, 1.28)),
        );
    }
    model.add(roof, bar(vec3(0.05, 0.0, 2.5), vec3(1.75, 4.3, 0.1)));
    model.add(steel, bar(vec3(0.05, 0.0, 2.43), vec3(1.6, 4.1, 0.05)));
    for i in 0..3 {
        model.add(wood, board(vec3(-0.42 + 0.11 * i as f32, -0.3, 0.47), vec3(0.09, 2.2, 0.035)));
    }
    for y in [-1.2, 0.6] {
        model.add(steel, bar(vec3(-0.32, y, 0.23), vec3(0.3, 0.05, 0.44)));
    }
    model.asset("shelter/bus-stop", Kind::Shelter, Class::Void).tagged(["bus-stop"])
}

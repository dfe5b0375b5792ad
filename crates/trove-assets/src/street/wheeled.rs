//! What is pushed and pulled on wheels.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Material};

use super::finish::{bar, board, cardboard, cloth, galvanised, grey_timber, painted, plastic, rounded, rubber, rusty};
use crate::shape::{Model, Shape};
use crate::surfaces;

pub(super) fn assets() -> Vec<Asset> {
    vec![hand_truck(), shopping_trolley(), market_cart(), dumpster(), wheelbarrow(), kick_scooter()]
}

fn pushed(model: Model, name: &str) -> Asset {
    model.asset(&format!("cart/{name}"), Kind::PushablePullable, Class::Void).tagged([name])
}

/// A wheel about the y axis: tyre and rim.
fn wheel(model: &mut Model, [tyre, rim]: [u16; 2], at: Vec3, radius_m: f32, width_m: f32) {
    let (r, w) = (radius_m, width_m / 2.0);
    let section = [(r * 0.68, -w), (r * 0.92, -w), (r, -w * 0.5), (r, w * 0.5), (r * 0.92, w), (r * 0.68, w)];
    let lay = |shape: Shape| shape.turned(Quat::from_rotation_x(-FRAC_PI_2)).moved(at);
    model.add(tyre, lay(Shape::lathe(&section.map(|(r, z)| vec2(r, z)), 24)));
    let half = [(0.0, w * 0.9), (r * 0.2, w * 0.9), (r * 0.3, w * 0.4), (r * 0.68, w * 0.5)];
    let disc: Vec<_> =
        half.iter().map(|&(r, z)| vec2(r, -z)).chain(half.iter().rev().map(|&(r, z)| vec2(r, z))).collect();
    model.add(rim, lay(Shape::lathe(&disc, 20)));
}

/// Two wheels, a blade, a ladder of tubes, boxes on it.
fn hand_truck() -> Asset {
    let mut model = Model::default();
    let red = vec3(0.4, 0.03, 0.02);
    let frame = model.slot(painted(red), &[red, vec3(0.03, 0.1, 0.3), Vec3::splat(0.3)]);
    let wheels = [model.slot(rubber(), &[]), model.slot(galvanised(), &[])];
    let card = model.slot(cardboard(), &[]);
    for y in [-0.19, 0.19] {
        let path = [vec3(0.0, y, 0.08), vec3(0.0, y, 1.0), vec3(-0.04, y, 1.12), vec3(-0.16, y, 1.2)];
        model.add(frame, Shape::tube(&path, 0.014, 9));
        model.add(wheels[0], Shape::tube(&[vec3(-0.1, y, 1.16), vec3(-0.2, y, 1.228)], 0.019, 9));
        model.add(frame, Shape::tube(&[vec3(0.0, y, 0.42), vec3(-0.12, y, 0.13)], 0.011, 7));
        wheel(&mut model, wheels, vec3(-0.12, y * 1.32, 0.13), 0.13, 0.05);
    }
    for z in [0.2, 0.5, 0.8] {
        model.add(frame, Shape::tube(&[vec3(0.0, -0.19, z), vec3(0.03, 0.0, z), vec3(0.0, 0.19, z)], 0.01, 7));
    }
    model.add(frame, Shape::tube(&[vec3(-0.12, -0.25, 0.13), vec3(-0.12, 0.25, 0.13)], 0.01, 8));
    model.add(frame, bar(vec3(0.13, 0.0, 0.035), vec3(0.27, 0.4, 0.008)));
    for (z, size, turn) in
        [(0.2, vec3(0.33, 0.45, 0.31), 0.03), (0.49, vec3(0.3, 0.42, 0.26), -0.06), (0.74, vec3(0.26, 0.36, 0.22), 0.1)]
    {
        model.add(card, bar(Vec3::ZERO, size).turned(Quat::from_rotation_z(turn)).moved(vec3(0.185, 0.0, z)));
    }
    pushed(model, "hand-truck")
}

/// A basket of wire on castors.
fn shopping_trolley() -> Asset {
    let mut model = Model::default();
    let wire = model.slot(galvanised(), &[]);
    let wheels = [model.slot(rubber(), &[]), model.slot(plastic(Vec3::splat(0.3)), &[])];
    let red = vec3(0.4, 0.03, 0.03);
    let grip = model.slot(plastic(red), &[red, vec3(0.03, 0.1, 0.3), vec3(0.6, 0.35, 0.02)]);
    // The basket narrows to the front and to the bottom.
    let rim = |v: f32| -> [Vec3; 4] {
        let (back, front) = (-0.4 + 0.06 * (1.0 - v), 0.42 - 0.1 * (1.0 - v));
        let (half_b, half_f) = (0.2 + 0.06 * v, 0.15 + 0.05 * v);
        let (zb, zf) = (0.5 + 0.48 * v, 0.55 + 0.36 * v);
        [vec3(back, -half_b, zb), vec3(front, -half_f, zf), vec3(front, half_f, zf), vec3(back, half_b, zb)]
    };
    for i in 0..=8 {
        let mut ring = rim(i as f32 / 8.0).to_vec();
        ring.push(ring[0]);
        model.add(wire, Shape::tube(&ring, if i == 8 { 0.006 } else { 0.003 }, 5));
    }
    let (low, high) = (rim(0.0), rim(1.0));
    for side in 0..4 {
        let count = if side % 2 == 0 { 14 } else { 8 };
        for i in 0..count {
            let at = |r: &[Vec3; 4]| r[side].lerp(r[(side + 1) % 4], i as f32 / count as f32);
            model.add(wire, Shape::tube(&[at(&low), at(&high)], 0.0025, 4));
        }
    }
    for i in 0..=10 {
        let t = i as f32 / 10.0;
        model.add(wire, Shape::tube(&[low[0].lerp(low[3], t), low[1].lerp(low[2], t)], 0.0025, 4));
    }
    for side in [-1.0f32, 1.0] {
        let y = |half: f32| side * half;
        let leg =
            [vec3(-0.42, y(0.26), 1.0), vec3(-0.36, y(0.23), 0.5), vec3(-0.3, y(0.23), 0.2), vec3(0.36, y(0.16), 0.16)];
        model.add(wire, Shape::tube(&leg, 0.011, 8));
        for (x, half) in [(-0.3, 0.23), (0.34, 0.16)] {
            wheel(&mut model, wheels, vec3(x, y(half), 0.062), 0.062, 0.03);
            model.add(wire, bar(vec3(x, y(half), 0.13), vec3(0.05, 0.045, 0.06)));
        }
    }
    model.add(grip, Shape::tube(&[vec3(-0.47, -0.27, 1.01), vec3(-0.47, 0.27, 1.01)], 0.016, 10));
    pushed(model, "shopping-trolley")
}

/// A hawker's cart: a chest on two wheels under an awning with lappets.
fn market_cart() -> Asset {
    let mut model = Model::default();
    let red = vec3(0.45, 0.04, 0.03);
    let chest = model.slot(painted(red), &[red, vec3(0.04, 0.16, 0.3), vec3(0.05, 0.2, 0.1), Vec3::splat(0.45)]);
    let top = model.slot(super::finish::stainless(), &[]);
    let wood = model.slot(grey_timber(), &[]);
    let steel = model.slot(galvanised(), &[]);
    let awning = vec3(0.62, 0.5, 0.3);
    let dyed = Material { translucency: 0.2, ..cloth(awning) };
    let cloths = [
        model.slot(dyed, &[awning, vec3(0.5, 0.05, 0.04), vec3(0.05, 0.2, 0.3)]),
        model.slot(cloth(Vec3::splat(0.6)), &[]),
    ];
    let wheels = [model.slot(rubber(), &[]), model.slot(rusty(), &[])];
    model.add(chest, Shape::rounded_block(vec3(1.3, 0.72, 0.46), 0.02).moved(vec3(0.0, 0.0, 0.68)));
    model.add(top, Shape::rounded_block(vec3(1.36, 0.78, 0.03), 0.008).moved(vec3(0.0, 0.0, 0.925)));
    for y in [-0.365, 0.365] {
        for x in [-0.32, 0.32] {
            model.add(chest, Shape::rounded_block(vec3(0.58, 0.015, 0.38), 0.006).moved(vec3(x, y, 0.68)));
        }
        wheel(&mut model, wheels, vec3(0.12, y * 1.14, 0.3), 0.3, 0.06);
        model.add(wood, board(vec3(-0.85, y * 0.8, 0.8), vec3(0.55, 0.05, 0.05)));
        model.add(wood, board(vec3(-0.55, y * 0.8, 0.24), vec3(0.05, 0.05, 0.48)));
        for x in [-0.6, 0.6] {
            model.add(steel, Shape::tube(&[vec3(x, y, 0.93), vec3(x, y, 1.98)], 0.014, 8));
        }
    }
    model.add(wood, board(vec3(-1.1, 0.0, 0.8), vec3(0.045, 0.62, 0.045)));
    // Stripes across, each a slightly hanging sheet with a lappet at either side.
    for i in 0..10 {
        let [x0, x1] = [i, i + 1].map(|k| -0.78 + 0.156 * k as f32);
        let half = [(0.0, 2.12), (0.28, 2.06), (0.56, 1.94), (0.56, 1.76)];
        let across = half.iter().rev().map(|&(y, z)| (-y, z)).chain(half.into_iter().skip(1));
        let across: Vec<(f32, f32)> = across.collect();
        let row = |x: f32| across.iter().map(|&(y, z)| vec3(x, y, z + 0.008 * (x * 20.0 + y * 9.0).sin())).collect();
        let sheet = Shape::sheet(&[row(x1), row(x0)]);
        model.add(cloths[i % 2], sheet.clone().and(sheet.inside_out()));
    }
    for (x, y, size) in [(-0.4, 0.1, 0.28), (0.0, -0.12, 0.22), (0.36, 0.08, 0.32)] {
        model.add(top, Shape::rounded_block(vec3(size, size, 0.2), 0.02).moved(vec3(x, y, 1.04)));
    }
    pushed(model, "market")
}

/// A bin for a house, on four castors, with a domed lid.
fn dumpster() -> Asset {
    let mut model = Model::default();
    let green = vec3(0.03, 0.15, 0.06);
    let paints = [green, vec3(0.06, 0.065, 0.07), vec3(0.04, 0.1, 0.28), vec3(0.5, 0.34, 0.03)];
    let shell = model.slot(plastic(green), &paints);
    let lid = model.slot(plastic(green * 0.8), &paints.map(|c| c * 0.85));
    let wheels = [model.slot(rubber(), &[]), model.slot(galvanised(), &[])];
    let section = |(length, width, z): (f32, f32, f32)| {
        rounded(vec2(width, length), 0.08).into_iter().map(|p| p.extend(z)).collect()
    };
    let body = [
        (1.1, 0.72, 0.18),
        (1.16, 0.78, 0.21),
        (1.3, 0.98, 1.05),
        (1.34, 1.02, 1.07),
        (1.34, 1.02, 1.14),
        (1.3, 0.98, 1.15),
    ];
    model.add(shell, Shape::loft(&body.map(section)));
    let dome = |x: f32| 1.15 + 0.2 * (1.0 - (x / 0.5).powi(2)).max(0.0).powf(0.4);
    let rows: Vec<Vec<Vec3>> = (0..=14)
        .map(|i| 0.5 * (PI * i as f32 / 14.0).cos())
        .map(|x| {
            [-0.66, -0.63, 0.63, 0.66].map(|y: f32| vec3(x, y, if y.abs() > 0.64 { 1.145 } else { dome(x) })).to_vec()
        })
        .collect();
    model.add(lid, Shape::sheet(&rows));
    for y in [-0.4f32, 0.0, 0.4] {
        let path: Vec<Vec3> = (0..=8).map(|i| 0.46 - 0.115 * i as f32).map(|x| vec3(x, y, dome(x))).collect();
        model.add(lid, Shape::tube(&path, 0.02, 8));
        let rib = Shape::rounded_block(vec3(0.06, 0.07, 0.7), 0.02).turned(Quat::from_rotation_y(0.12));
        model.add(shell, rib.moved(vec3(0.44, y, 0.62)));
    }
    for side in [-1.0f32, 1.0] {
        let lug = Shape::cylinder(0.03, 0.12, 12).turned(Quat::from_rotation_x(-side * FRAC_PI_2));
        model.add(wheels[1], lug.moved(vec3(0.0, side * 0.64, 0.98)));
        for x in [-0.26, 0.26] {
            wheel(&mut model, wheels, vec3(x, side * 0.42, 0.09), 0.09, 0.045);
            model.add(wheels[1], bar(vec3(x, side * 0.42, 0.17), vec3(0.09, 0.08, 0.03)));
        }
    }
    let bow = [vec3(0.47, -0.4, 1.0), vec3(0.56, -0.36, 1.0), vec3(0.56, 0.36, 1.0), vec3(0.47, 0.4, 1.0)];
    model.add(shell, Shape::tube(&bow, 0.018, 8));
    pushed(model, "dumpster")
}

/// A barrow with sand in it.
fn wheelbarrow() -> Asset {
    let mut model = Model::default();
    let green = vec3(0.05, 0.16, 0.08);
    let tray = model.slot(painted(green), &[green, vec3(0.3, 0.3, 0.3), vec3(0.5, 0.2, 0.03)]);
    let steel = model.slot(galvanised(), &[]);
    let wheels = [model.slot(rubber(), &[]), model.slot(rusty(), &[])];
    let sand = model.slot(surfaces::set("soil/sand"), &[]);
    let section = |(length, width, z, x): (f32, f32, f32, f32)| {
        rounded(vec2(length, width), 0.07).into_iter().map(|p| vec3(p.x + x, p.y, z)).collect()
    };
    let sections =
        [(0.45, 0.35, 0.32, 0.0), (0.9, 0.62, 0.6, 0.06), (0.94, 0.66, 0.61, 0.06), (0.94, 0.66, 0.63, 0.06)];
    model.add(tray, Shape::loft(&sections.map(section)));
    let heap = Shape::ellipsoid(vec3(0.42, 0.28, 0.14), 20)
        .bent(|p| p + Vec3::Z * 0.02 * (p.x * 17.0).sin() * (p.y * 23.0).cos());
    model.add(sand, heap.moved(vec3(0.06, 0.0, 0.63)));
    for side in [-1.0f32, 1.0] {
        let tube = [(0.68, 0.06, 0.2), (0.2, 0.2, 0.3), (-0.35, 0.27, 0.4), (-0.78, 0.29, 0.62)];
        model.add(steel, Shape::tube(&tube.map(|(x, y, z)| vec3(x, side * y, z)), 0.016, 9));
        let grip = [vec3(-0.68, side * 0.286, 0.569), vec3(-0.8, side * 0.291, 0.63)];
        model.add(wheels[0], Shape::tube(&grip, 0.021, 9));
        let leg = [(-0.3, 0.26, 0.39), (-0.34, 0.25, 0.03), (-0.22, 0.25, 0.02), (-0.1, 0.24, 0.36)];
        model.add(steel, Shape::tube(&leg.map(|(x, y, z)| vec3(x, side * y, z)), 0.013, 8));
    }
    wheel(&mut model, wheels, vec3(0.66, 0.0, 0.19), 0.19, 0.08);
    pushed(model, "wheelbarrow")
}

/// An electric kick scooter on its stand.
fn kick_scooter() -> Asset {
    let mut model = Model::default();
    let green = vec3(0.1, 0.42, 0.12);
    let shell = model.slot(painted(green), &[green, vec3(0.75, 0.2, 0.03), Vec3::splat(0.5), vec3(0.3, 0.05, 0.35)]);
    let black = model.slot(rubber(), &[]);
    let lens = model.slot(plastic(Vec3::splat(0.7)), &[]);
    let wheels = [black, model.slot(galvanised(), &[])];
    for x in [-0.45, 0.47] {
        wheel(&mut model, wheels, vec3(x, 0.0, 0.12), 0.12, 0.05);
        let guard = |y: f32| -> Vec<Vec3> {
            let angle = |i: usize| if x < 0.0 { 0.5 } else { 0.2 } + 0.25 * i as f32;
            (0..=8).map(angle).map(|a| vec3(x + 0.14 * a.cos(), y, 0.12 + 0.14 * a.sin())).collect()
        };
        let sheet = Shape::sheet(&[guard(0.035), guard(-0.035)]);
        model.add(shell, sheet.clone().and(sheet.inside_out()));
    }
    model.add(shell, Shape::rounded_block(vec3(0.66, 0.15, 0.06), 0.025).moved(vec3(-0.06, 0.0, 0.13)));
    model.add(black, Shape::rounded_block(vec3(0.56, 0.13, 0.01), 0.004).moved(vec3(-0.07, 0.0, 0.163)));
    model.add(shell, Shape::tube(&[vec3(0.25, 0.0, 0.14), vec3(0.34, 0.0, 0.22), vec3(0.42, 0.0, 0.36)], 0.028, 10));
    model.add(shell, Shape::tube(&[vec3(0.44, 0.0, 0.24), vec3(0.3, 0.0, 1.1)], 0.024, 12));
    let half = [(0.12, 1.12, 0.29), (0.26, 1.08, 0.24)];
    for side in [-1.0, 1.0] {
        model.add(shell, Shape::tube(&[vec3(0.44, side * 0.035, 0.28), vec3(0.47, side * 0.035, 0.12)], 0.012, 8));
        let bow: Vec<Vec3> = half.iter().map(|&(y, z, x)| vec3(x, side * y, z)).collect();
        model.add(black, Shape::tube(&[vec3(0.29, 0.0, 1.12), bow[0], bow[1]], 0.014, 9));
        model.add(black, Shape::tube(&[vec3(0.26, side * 0.2, 1.098), vec3(0.235, side * 0.27, 1.08)], 0.019, 9));
    }
    model.add(wheels[1], Shape::tube(&[vec3(-0.1, 0.07, 0.11), vec3(-0.06, 0.16, 0.005)], 0.008, 6));
    model.add(lens, Shape::ellipsoid(vec3(0.02, 0.03, 0.03), 10).moved(vec3(0.345, 0.0, 0.98)));
    model.asset("kick-scooter/parked", Kind::StreetFurniture, Class::Void).tagged(["kick-scooter", "parked"])
}

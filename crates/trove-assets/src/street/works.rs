//! What stands about where people build: a toilet, a skip, scaffolding, a drum of cable, pallets, sand.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Material};

use super::finish::{bar, board, cloth, dark, galvanised, grey_timber, painted, plastic, reflective, rubber, rusty};
use super::finish::{tarpaulin, upright};
use crate::shape::{Model, Shape};
use crate::surfaces::{self, hash};

pub(super) fn assets() -> Vec<Asset> {
    vec![toilet(), skip(), cable_drum(), pallets(), sandbags(), rubble(), covered_heap(), a_board(), generator()]
        .into_iter()
        .chain([2, 3, 4, 5, 6].into_iter().flat_map(|lifts| [scaffolding(lifts, false), scaffolding(lifts, true)]))
        .collect()
}

fn works(model: Model, name: &str) -> Asset {
    model.asset(&format!("works/{name}"), Kind::StreetFurniture, Class::Void).tagged(["works", name])
}

fn debris(model: Model, name: &str) -> Asset {
    model.asset(&format!("debris/{name}"), Kind::Debris, Class::Void).tagged([name])
}

/// A cabin of ribbed plastic with a bowed, pale roof.
fn toilet() -> Asset {
    let mut model = Model::default();
    let blue = vec3(0.03, 0.14, 0.36);
    let shell = model.slot(plastic(blue), &[blue, vec3(0.03, 0.24, 0.16), vec3(0.5, 0.1, 0.05), Vec3::splat(0.4)]);
    let pale = model.slot(plastic(Vec3::splat(0.72)), &[]);
    let black = model.slot(dark(), &[]);
    let wood = model.slot(grey_timber(), &[]);
    model.add(pale, Shape::rounded_block(vec3(1.16, 1.16, 0.12), 0.03).moved(vec3(0.0, 0.0, 0.15)));
    for y in [-0.42, 0.0, 0.42] {
        model.add(wood, board(vec3(0.0, y, 0.05), vec3(1.15, 0.1, 0.1)));
    }
    model.add(shell, Shape::rounded_block(vec3(1.06, 1.06, 1.95), 0.05).moved(vec3(0.0, 0.0, 1.18)));
    // Ribs on three sides, a door with a frame on the fourth.
    for k in 1..4 {
        let turn = Quat::from_rotation_z(FRAC_PI_2 * k as f32);
        for i in -3..=3 {
            let rib = Shape::rounded_block(vec3(0.03, 0.07, 1.55), 0.014).moved(vec3(0.53, 0.135 * i as f32, 1.12));
            model.add(shell, rib.turned(turn));
        }
        for i in 0..3 {
            let vent = bar(vec3(0.534, 0.0, 1.98 + 0.05 * i as f32), vec3(0.006, 0.5, 0.02));
            model.add(black, vent.turned(turn));
        }
    }
    model.add(shell, Shape::rounded_block(vec3(0.03, 0.78, 1.78), 0.012).moved(vec3(0.535, 0.0, 1.12)));
    model.add(shell, Shape::rounded_block(vec3(0.02, 0.6, 0.65), 0.009).moved(vec3(0.552, 0.0, 0.75)));
    model.add(shell, Shape::rounded_block(vec3(0.02, 0.6, 0.65), 0.009).moved(vec3(0.552, 0.0, 1.55)));
    model.add(black, bar(vec3(0.56, 0.3, 1.13), vec3(0.03, 0.05, 0.16)));
    for z in [0.4, 1.15, 1.9] {
        model.add(black, bar(vec3(0.55, -0.4, z), vec3(0.02, 0.04, 0.1)));
    }
    let roof: Vec<Vec<Vec3>> = (0..=10)
        .map(|i| {
            let t = i as f32 / 10.0;
            let (x, up) = (0.58 * (2.0 * t - 1.0), (PI * t).sin().sqrt() * 0.16);
            super::finish::rounded(vec2(0.05, 1.16), 0.02).iter().map(|p| vec3(x, -p.y, 2.13 + up + p.x)).collect()
        })
        .collect();
    model.add(pale, Shape::loft(&roof));
    model.add(pale, Shape::cylinder(0.045, 0.25, 12).moved(vec3(-0.35, 0.3, 2.25)));
    works(model, "toilet")
}

/// An open container with sloping ends that lorries lift, half full of rubble.
fn skip() -> Asset {
    let mut model = Model::default();
    let yellow = vec3(0.6, 0.34, 0.02);
    let steel =
        model.slot(painted(yellow), &[yellow, vec3(0.05, 0.12, 0.25), vec3(0.35, 0.04, 0.025), vec3(0.05, 0.16, 0.07)]);
    let worn = model.slot(rusty(), &[]);
    let load = model.slot(Material { base_color: vec3(0.95, 0.9, 0.85), ..surfaces::set("soil/earth-dry") }, &[]);
    let (half_y, top) = (0.85, 1.25);
    let outline = |inset: f32| {
        [
            vec2(-1.75 + inset, top),
            vec2(-1.0 + inset * 0.6, 0.12 + inset),
            vec2(1.0 - inset * 0.6, 0.12 + inset),
            vec2(1.75 - inset, top),
        ]
    };
    let [a, b, c, d] = outline(0.0);
    // Walls as plates: the floor and the ends, then the sides with ribs.
    for (p, q) in [(a, b), (b, c), (c, d)] {
        let row = |y: f32| vec![vec3(p.x, y, p.y), vec3(q.x, y, q.y)];
        let sheet = Shape::sheet(&[row(half_y), row(-half_y)]);
        model.add(worn, sheet.clone().inside_out().moved(Vec3::Z * 0.004));
        model.add(steel, sheet);
    }
    for side in [-1.0f32, 1.0] {
        let wall = super::finish::swept(&[b, c, d, a], 0.03);
        model.add(steel, wall.moved(Vec3::Y * side * half_y));
        for x in [-0.95, -0.32, 0.32, 0.95] {
            model.add(steel, bar(vec3(x, side * (half_y + 0.035), 0.68), vec3(0.09, 0.06, 1.05)));
        }
        model.add(steel, bar(vec3(0.0, side * (half_y + 0.03), top), vec3(3.5, 0.11, 0.09)));
        for x in [-1.0, 1.0] {
            let lug = Shape::cylinder(0.045, 0.14, 14).turned(Quat::from_rotation_x(FRAC_PI_2));
            model.add(worn, lug.moved(vec3(x, side * (half_y + 0.1) + 0.07, 0.95)));
        }
        model.add(worn, bar(vec3(0.0, side * 0.5, 0.06), vec3(2.2, 0.12, 0.12)));
    }
    for x in [-1.75, 1.75] {
        model.add(steel, bar(vec3(x, 0.0, top), vec3(0.09, 1.8, 0.09)));
    }
    let rows: Vec<Vec<Vec3>> = (0..=10)
        .map(|i| {
            let y = -half_y + 2.0 * half_y * i as f32 / 10.0;
            let height = |k: i32| 0.82 + 0.28 * (1.0 - ((k - 10) as f32 / 10.0).powi(2)) + 0.16 * (hash(k, i, 9) - 0.5);
            (0..=20).map(|k| vec3(-1.5 + 0.15 * k as f32, y, height(k))).collect()
        })
        .collect();
    model.add(load, Shape::sheet(&rows));
    let wood = model.slot(grey_timber(), &[]);
    for (i, turn) in [0.3f32, -0.5, 1.1].into_iter().enumerate() {
        let plank = board(vec3(0.0, 0.01 * i as f32, 0.0), vec3(1.5, 0.14, 0.03))
            .turned(Quat::from_rotation_y(-0.3) * Quat::from_rotation_z(turn * 0.4));
        model.add(wood, plank.moved(vec3(0.3 * i as f32 - 0.4, 0.25 * turn, 1.14)));
    }
    works(model, "skip")
}

/// Height of a lift of scaffolding, metres.
const LIFT_M: f32 = 2.0;

/// Two bays of tubes with decks of planks and rails; x is the side away from the house, with netting or without.
fn scaffolding(lifts: usize, netted: bool) -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let wood = model.slot(grey_timber(), &[]);
    let coupler = model.slot(rusty(), &[]);
    let tube = |a: Vec3, b: Vec3| Shape::tube(&[a, b], 0.024, 8);
    let decks: Vec<f32> = (1..=lifts).map(|lift| lift as f32 * LIFT_M).collect();
    let (half_x, ys, height) = (0.45, [-2.2, 0.0, 2.2], lifts as f32 * LIFT_M + 1.1);
    for y in ys {
        for x in [-half_x, half_x] {
            model.add(steel, tube(vec3(x, y, 0.03), vec3(x, y, height)));
            model.add(steel, Shape::rounded_block(vec3(0.15, 0.15, 0.012), 0.004).moved(vec3(x, y, 0.006)));
            for z in &decks {
                model.add(coupler, bar(vec3(x, y + 0.03, *z), vec3(0.08, 0.09, 0.07)));
            }
        }
        for z in decks.iter().copied().chain([0.25]) {
            model.add(steel, tube(vec3(-half_x - 0.12, y + 0.05, z - 0.05), vec3(half_x + 0.12, y + 0.05, z - 0.05)));
        }
    }
    let along = |x: f32, z: f32| tube(vec3(x + 0.05, -2.35, z), vec3(x + 0.05, 2.35, z));
    for x in [-half_x, half_x] {
        model.add(steel, along(x, 0.25));
    }
    for (lift, z) in decks.iter().copied().enumerate() {
        for x in [-half_x, half_x] {
            model.add(steel, along(x, z));
            let (from, to) = (z - LIFT_M, z - 0.05);
            let way = if lift % 2 == 0 { -2.2 * x.signum() } else { 2.2 * x.signum() };
            model.add(steel, tube(vec3(x, way, from + 0.2), vec3(x, 0.0, to)));
        }
        for rail_m in [0.5, 1.0] {
            model.add(steel, along(half_x, z + rail_m));
        }
        for i in 0..4 {
            model.add(wood, board(vec3(-0.33 + 0.22 * i as f32, 0.02 * i as f32, z + 0.03), vec3(0.21, 4.6, 0.035)));
        }
        model.add(wood, board(vec3(half_x + 0.02, 0.0, z + 0.13), vec3(0.03, 4.5, 0.15)));
    }
    let number = format!("lifts-{lifts}");
    // Labelled sets count it as part of the house.
    let scaffolding = |model: Model, kind: &str| {
        let id = format!("works/scaffolding-{number}-{kind}");
        let asset = model.asset(&id, Kind::StreetFurniture, Class::Building);
        asset.tagged(["works", "scaffolding", number.as_str(), kind])
    };
    if !netted {
        return scaffolding(model, "bare");
    }
    // It hangs before the first deck and up, drawn in between its ties.
    let white = Vec3::splat(0.5);
    let net = Material { translucency: 0.35, ..Material::plain("netting", white, 0.9) };
    let net = model.slot(net, &[white, vec3(0.03, 0.2, 0.09), vec3(0.04, 0.12, 0.32)]);
    let row = |i: usize| -> Vec<Vec3> {
        let z = LIFT_M - 0.3 + (height - LIFT_M + 0.3) * i as f32 / (4 * lifts) as f32;
        let at = |k: usize| k as f32 / 16.0;
        let sag = |k: usize| 0.05 * (at(k) * 4.0 * PI).sin().abs() * (z * PI / LIFT_M).sin().abs();
        (0..=16).map(|k| vec3(half_x + 0.13 - sag(k), -2.34 + 4.68 * at(k), z)).collect()
    };
    let sheet = Shape::sheet(&(0..=4 * lifts).map(row).collect::<Vec<_>>());
    model.add(net, sheet.both_sides());
    scaffolding(model, "netted")
}

/// A wooden drum with cable on it.
fn cable_drum() -> Asset {
    let mut model = Model::default();
    let wood = model.slot(grey_timber(), &[]);
    let black = model.slot(rubber(), &[]);
    let iron = model.slot(rusty(), &[]);
    let disc = |radius: f32, thick: f32| {
        Shape::cylinder(radius, thick, 36).laid(Vec3::X, Vec2::ZERO).turned(Quat::from_rotation_x(FRAC_PI_2))
    };
    for y in [-0.36, 0.42] {
        model.add(wood, disc(0.65, 0.06).moved(vec3(0.0, y, 0.65)));
        for x in [-0.4, 0.0, 0.4] {
            model.add(
                wood,
                board(vec3(x, y - 0.03 + 0.05 * f32::signum(y), 0.65), vec3(0.12, 0.03, 1.02 - 0.4 * f32::abs(x))),
            );
        }
    }
    let layers: Vec<Vec2> =
        (0..=56).map(|i| vec2(0.45 + 0.012 * (i as f32 * FRAC_PI_2).sin(), -0.36 + 0.72 * i as f32 / 56.0)).collect();
    model.add(black, Shape::lathe(&layers, 32).turned(Quat::from_rotation_x(FRAC_PI_2)).moved(vec3(0.0, 0.0, 0.65)));
    model.add(iron, disc(0.05, 0.95).moved(vec3(0.0, 0.475, 0.65)));
    works(model, "cable-drum")
}

/// Pallets on a pile, the top one askew.
fn pallets() -> Asset {
    let mut model = Model::default();
    let wood = model.slot(grey_timber(), &[Vec3::ONE, vec3(1.0, 0.9, 0.75)]);
    for level in 0..4 {
        let mut parts = Vec::new();
        let z = 0.144 * level as f32;
        for i in 0..7 {
            parts.push(board(vec3(-0.54 + 0.18 * i as f32, 0.0, z + 0.133), vec3(0.11, 0.8, 0.02)));
        }
        for y in [-0.36, 0.0, 0.36] {
            parts.push(board(vec3(0.0, y, z + 0.112), vec3(1.2, 0.1, 0.02)));
            parts.push(board(vec3(0.0, y, z + 0.011), vec3(1.2, 0.1, 0.02)));
            for x in [-0.53, 0.0, 0.53] {
                parts.push(board(vec3(x, y, z + 0.062), vec3(0.14, 0.1, 0.08)));
            }
        }
        let turn = [0.0, 0.02, -0.03, 0.13][level];
        model.add(wood, Shape::join(parts).turned(Quat::from_rotation_z(turn)));
    }
    debris(model, "pallets")
}

/// A filled sack lying flat.
fn sack(turn: f32, at: Vec3, salt: f32) -> Shape {
    let lying = Shape::ellipsoid(vec3(0.33, 0.2, 0.085), 22).bent(|p| {
        let square = |v: f32, half: f32| v.signum() * half * (v / half).abs().min(1.0).powf(0.72);
        let fold = 0.012 * (p.x * 19.0 + salt).sin() + 0.01 * (p.y * 31.0 - p.x * 9.0 + salt).sin();
        vec3(square(p.x, 0.33), square(p.y, 0.2), p.z + fold - 0.03 * (p.x * 4.0).cos() * f32::from(p.z < 0.0))
    });
    lying.turned(Quat::from_rotation_z(turn)).moved(at)
}

/// Sacks of sand, two on three.
fn sandbags() -> Asset {
    let mut model = Model::default();
    let white = vec3(0.6, 0.57, 0.5);
    let bag = model.slot(cloth(white), &[white, vec3(0.42, 0.36, 0.26), vec3(0.2, 0.32, 0.2)]);
    for (i, (x, y, z, turn)) in [
        (0.0, -0.42, 0.09, 0.1),
        (0.05, 0.0, 0.09, -0.08),
        (-0.03, 0.43, 0.09, 0.2),
        (0.03, -0.2, 0.23, 0.3),
        (0.0, 0.24, 0.24, -0.2),
    ]
    .into_iter()
    .enumerate()
    {
        model.add(bag, sack(turn, vec3(x, y, z), i as f32 * 2.1));
    }
    debris(model, "sandbags")
}

/// Broken concrete and bricks on a heap of earth.
fn rubble() -> Asset {
    let mut model = Model::default();
    let earth = model.slot(surfaces::set("soil/earth-dry"), &[]);
    let stone = model.slot(surfaces::set("concrete/weathered"), &[Vec3::ONE, vec3(0.9, 0.85, 0.78)]);
    let red = model.slot(Material { base_color: vec3(0.32, 0.12, 0.07), ..surfaces::set("plastic/scuffed") }, &[]);
    let heap: Vec<Vec2> = [(0.8, 0.0), (0.72, 0.05), (0.55, 0.16), (0.35, 0.3), (0.15, 0.37), (0.0, 0.39)]
        .map(|(r, z)| vec2(r, z))
        .to_vec();
    let lumpy = |p: Vec3| {
        let angle = p.y.atan2(p.x);
        let r = 1.0 + 0.12 * (3.0 * angle).sin() + 0.07 * (7.0 * angle + 1.0).sin();
        vec3(p.x * r, p.y * r, p.z * (1.0 + 0.2 * (p.x * 7.0).sin() * (p.y * 6.0).cos()))
    };
    model.add(earth, Shape::lathe(&heap, 40).bent(lumpy));
    for i in 0..40 {
        let drawn = |salt: u32| hash(i, 3, salt);
        let angle = TAU * drawn(1);
        let r = 0.85 * drawn(2).sqrt();
        let size = vec3(0.06 + 0.2 * drawn(3) * drawn(4), 0.05 + 0.1 * drawn(5), 0.04 + 0.06 * drawn(6));
        let turn = Quat::from_rotation_z(TAU * drawn(7))
            * Quat::from_rotation_x(drawn(8) - 0.5)
            * Quat::from_rotation_y(0.8 * drawn(9) - 0.4);
        let chunk = if i % 3 == 0 {
            Shape::rounded_block(vec3(0.21, 0.1, 0.065), 0.006)
        } else {
            Shape::rounded_block(size, 0.02).bent(|p| p * (1.0 + 0.25 * (p.x * 40.0 + p.y * 31.0).sin()))
        };
        let z = 0.4 * (1.0 - r / 0.85).max(0.0) + 0.03;
        model.add(
            if i % 3 == 0 { red } else { stone },
            chunk.turned(turn).moved(vec3(r * angle.cos(), r * angle.sin(), z)),
        );
    }
    debris(model, "rubble")
}

/// Something under a tarpaulin that is weighed down with planks.
fn covered_heap() -> Asset {
    let mut model = Model::default();
    let blue = vec3(0.04, 0.16, 0.42);
    let cover = model.slot(tarpaulin(blue), &[blue, vec3(0.03, 0.17, 0.09), vec3(0.5, 0.21, 0.05), Vec3::splat(0.35)]);
    let wood = model.slot(grey_timber(), &[]);
    let (n, m) = (44, 30);
    let rows: Vec<Vec<Vec3>> = (0..=m)
        .map(|i| {
            let v = 2.0 * i as f32 / m as f32 - 1.0;
            (0..=n)
                .map(|k| {
                    let u = 2.0 * k as f32 / n as f32 - 1.0;
                    let edge = (1.0 - u.abs().max(v.abs())).max(0.0);
                    // Three things below, the cloth hung between them.
                    let bump = |cu: f32, cv: f32, wide: f32, high: f32| {
                        high * (-((u - cu) / wide).powi(6) - ((v - cv) / wide).powi(6)).exp()
                    };
                    let below =
                        bump(-0.35, 0.0, 0.45, 0.85).max(bump(0.4, 0.2, 0.42, 0.62)).max(bump(0.3, -0.35, 0.4, 0.5));
                    let folds = 0.03
                        * (1.0 - (below / 0.9).min(1.0))
                        * ((u * 17.0 + v * 3.0).sin() * (v * 15.0 - u * 4.0).sin() + (9.0 * u - 11.0 * v).sin());
                    vec3(
                        1.0 * u * (1.0 - 0.06 * below),
                        0.75 * v * (1.0 - 0.08 * below),
                        (0.012 + below + folds * (edge * 9.0).min(1.0)).max(0.008),
                    )
                })
                .collect()
        })
        .collect();
    let cloth = Shape::sheet(&rows);
    model.add(cover, cloth.clone().and(cloth.inside_out()));
    for (x, y, turn) in [(0.85, 0.1, 1.5), (-0.1, -0.68, 0.06), (-0.2, 0.66, -0.1)] {
        let plank = board(Vec3::ZERO, vec3(1.2, 0.12, 0.04)).turned(Quat::from_rotation_z(turn));
        model.add(wood, plank.moved(vec3(x, y, 0.075)));
    }
    debris(model, "covered")
}

/// A folding board before a shop.
fn a_board() -> Asset {
    let mut model = Model::default();
    let wood = model.slot(super::finish::timber(), &[]);
    let poster = model.slot(super::posters::poster(4), &[]);
    for side in [-1.0f32, 1.0] {
        let lean = |shape: Shape| {
            shape.turned(Quat::from_rotation_y(-0.2)).moved(vec3(0.2, 0.0, 0.0)).scaled(vec3(side, side, 1.0))
        };
        for y in [-0.3, 0.3] {
            model.add(wood, lean(board(vec3(0.0, y, 0.55), vec3(0.025, 0.05, 1.1))));
        }
        for z in [0.14, 1.06] {
            model.add(wood, lean(board(vec3(0.0, 0.0, z), vec3(0.024, 0.6, 0.05))));
        }
        model.add(wood, lean(board(vec3(-0.002, 0.0, 0.6), vec3(0.012, 0.56, 0.88))));
        model.add(poster, lean(super::signs::face(vec2(0.54, 0.86)).moved(vec3(0.006, 0.0, 0.6))));
    }
    model.asset("advertising/board", Kind::StreetFurniture, Class::Void).tagged(["advertising", "board"])
}

/// A generator on a trailer's wheels under a ribbed hood.
fn generator() -> Asset {
    let mut model = Model::default();
    let yellow = vec3(0.62, 0.4, 0.03);
    let hood = model.slot(painted(yellow), &[yellow, Vec3::splat(0.5), vec3(0.4, 0.05, 0.03)]);
    let black = model.slot(dark(), &[]);
    let tyre = model.slot(rubber(), &[]);
    let steel = model.slot(galvanised(), &[]);
    let band = model.slot(reflective(vec3(0.7, 0.7, 0.66)), &[]);
    model.add(hood, Shape::rounded_block(vec3(1.9, 0.95, 0.85), 0.07).moved(vec3(0.0, 0.0, 0.95)));
    model.add(hood, Shape::rounded_block(vec3(1.75, 0.9, 0.2), 0.04).moved(vec3(0.0, 0.0, 0.5)));
    for side in [-1.0f32, 1.0] {
        for i in 0..8 {
            model.add(black, bar(vec3(0.35 + 0.06 * i as f32, side * 0.474, 1.0), vec3(0.03, 0.01, 0.4)));
        }
        model.add(hood, Shape::rounded_block(vec3(0.8, 0.02, 0.55), 0.009).moved(vec3(-0.35, side * 0.478, 1.0)));
        model.add(black, bar(vec3(-0.02, side * 0.492, 1.0), vec3(0.1, 0.02, 0.05)));
        model.add(band, bar(vec3(0.0, side * 0.478, 0.62), vec3(1.6, 0.006, 0.05)));
        let wheel = [(0.1, 0.0), (0.26, 0.0), (0.29, 0.03), (0.29, 0.15), (0.26, 0.18), (0.1, 0.17)];
        let round = Shape::lathe(&wheel.map(|(r, z)| vec2(r, z)), 28).turned(Quat::from_rotation_x(FRAC_PI_2));
        model.add(tyre, round.moved(vec3(-0.1, side * 0.62 + 0.09, 0.29)));
        let hub = upright(Shape::cylinder(0.13, 0.1, 20)).turned(Quat::from_rotation_z(side * FRAC_PI_2));
        model.add(steel, hub.moved(vec3(-0.1, side * 0.58, 0.29)));
        let guard: Vec<Vec<Vec3>> = [side * 0.51, side * 0.74]
            .map(|y| {
                (0..=10)
                    .map(|i| PI * i as f32 / 10.0)
                    .map(|a| vec3(-0.1 + 0.36 * a.cos(), y, 0.32 + 0.34 * a.sin()))
                    .collect()
            })
            .to_vec();
        let guard = Shape::sheet(&guard);
        model.add(steel, guard.clone().and(guard.inside_out()));
    }
    model.add(steel, Shape::tube(&[vec3(0.9, 0.0, 0.45), vec3(1.7, 0.0, 0.45)], 0.04, 10));
    model.add(steel, Shape::tube(&[vec3(1.45, 0.0, 0.62), vec3(1.45, 0.0, 0.0)], 0.025, 10));
    model.add(steel, Shape::tube(&[vec3(-0.6, 0.15, 1.35), vec3(-0.6, 0.15, 1.55), vec3(-0.68, 0.15, 1.62)], 0.03, 10));
    works(model, "generator")
}

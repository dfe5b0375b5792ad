//! What else stands on sidewalks: letter boxes, cabinets, parking meters, advertising, plants in tubs, tables.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Material, Seed};

use super::finish::{bar, board, concrete, galvanised, glass, painted, plastic, post, rubber, stainless, timber};
use super::posters::poster;
use crate::shape::{Model, Shape};

pub(super) fn assets() -> Vec<Asset> {
    vec![
        us_mailbox(),
        post_box("yellow", vec3(0.6, 0.38, 0.01)),
        post_box("red", vec3(0.4, 0.015, 0.02)),
        post_box("green", vec3(0.02, 0.12, 0.06)),
        cabinet("slim", vec3(0.75, 0.32, 1.15)),
        cabinet("wide", vec3(1.3, 0.36, 1.3)),
        news_box(),
        meter(),
        pay_station(),
        advertising_column(),
        planter("round", true),
        planter("trough", false),
        table(true),
        table(false),
        picnic_table(),
        telephone(),
        flagpole(),
    ]
}

fn furniture(model: Model, what: &str, name: &str) -> Asset {
    model.asset(&format!("{what}/{name}"), Kind::StreetFurniture, Class::Void).tagged([what, name])
}

/// A blue steel box with a rounded top on four legs.
fn us_mailbox() -> Asset {
    let mut model = Model::default();
    let blue = model.slot(painted(vec3(0.012, 0.045, 0.19)), &[]);
    let white = model.slot(plastic(vec3(0.6, 0.6, 0.58)), &[]);
    let arc = (0..=12).map(|i| PI * i as f32 / 12.0).map(|a| vec2(0.24 * a.cos(), 1.02 + 0.24 * a.sin()));
    let profile: Vec<_> = [vec2(-0.24, 0.2), vec2(0.24, 0.2)].into_iter().chain(arc).collect();
    model.add(blue, super::finish::swept(&profile, 0.52));
    for (x, y) in [(-0.2, -0.22), (0.2, -0.22), (-0.2, 0.22), (0.2, 0.22)] {
        model.add(blue, bar(vec3(x, y, 0.11), vec3(0.05, 0.05, 0.22)));
    }
    model.add(blue, bar(vec3(0.235, 0.0, 1.08), vec3(0.06, 0.44, 0.04)));
    model.add(white, bar(vec3(0.242, 0.0, 0.72), vec3(0.004, 0.3, 0.18)));
    furniture(model, "mailbox", "blue")
}

/// A box on a stand.
fn post_box(name: &str, color: Vec3) -> Asset {
    let mut model = Model::default();
    let paint = model.slot(painted(color), &[]);
    let dark = model.slot(rubber(), &[]);
    let white = model.slot(plastic(vec3(0.6, 0.6, 0.58)), &[]);
    model.add(paint, Shape::rounded_block(vec3(0.36, 0.5, 0.72), 0.03).moved(vec3(0.0, 0.0, 1.02)));
    model.add(paint, bar(vec3(0.02, 0.0, 1.4), vec3(0.42, 0.54, 0.04)));
    model.add(dark, bar(vec3(0.181, 0.0, 1.25), vec3(0.01, 0.36, 0.04)));
    model.add(white, bar(vec3(0.181, 0.0, 0.95), vec3(0.004, 0.2, 0.14)));
    for y in [-0.16, 0.16] {
        model.add(paint, bar(vec3(-0.05, y, 0.34), vec3(0.06, 0.05, 0.68)));
    }
    model.add(dark, bar(vec3(-0.05, 0.0, 0.02), vec3(0.24, 0.5, 0.04)));
    furniture(model, "mailbox", name)
}

/// A cabinet of cables or switches with two doors, stickers on it.
fn cabinet(name: &str, size: Vec3) -> Asset {
    let mut model = Model::default();
    let grey = vec3(0.33, 0.335, 0.32);
    let body = model
        .slot(Material { dirt: 0.8, ..painted(grey) }, &[grey, grey, vec3(0.22, 0.24, 0.21), vec3(0.05, 0.11, 0.075)]);
    let foot = model.slot(concrete(), &[]);
    let dark = model.slot(rubber(), &[]);
    let (width, depth, height) = (size.x, size.y, size.z);
    model.add(foot, bar(vec3(0.0, 0.0, 0.05), vec3(depth + 0.02, width + 0.02, 0.1)));
    model.add(body, bar(vec3(0.0, 0.0, height / 2.0 + 0.05), vec3(depth, width, height - 0.1)));
    model.add(body, bar(vec3(0.0, 0.0, height + 0.02), vec3(depth + 0.05, width + 0.05, 0.05)));
    for y in [-0.24, 0.24] {
        model.add(body, bar(vec3(depth / 2.0, y * width, height * 0.52), vec3(0.016, width * 0.45, height * 0.8)));
        for i in 0..4 {
            let z = height * 0.84 - 0.03 * i as f32;
            model.add(dark, bar(vec3(depth / 2.0 + 0.008, y * width, z), vec3(0.004, width * 0.25, 0.008)));
        }
    }
    model.add(dark, bar(vec3(depth / 2.0 + 0.015, 0.03 * width, height * 0.55), vec3(0.02, 0.03, 0.1)));
    // Left by passers-by.
    let mut random = Seed(11).child(&format!("cabinet/{name}")).random();
    for color in [vec3(0.5, 0.5, 0.46), vec3(0.45, 0.05, 0.05), vec3(0.05, 0.12, 0.35), vec3(0.5, 0.4, 0.05)] {
        let sticker = model.slot(plastic(color), &[]);
        let [y, z] = [random.range(-0.38, 0.38) as f32 * width, random.range(0.25, 0.75) as f32 * height];
        let turn = Quat::from_rotation_x(random.range(-0.3, 0.3) as f32);
        let patch = Shape::block(vec3(0.002, random.range(0.06, 0.13) as f32, random.range(0.05, 0.1) as f32));
        model.add(sticker, patch.turned(turn).moved(vec3(depth / 2.0 + 0.011, y, z)));
    }
    furniture(model, "cabinet", name)
}

/// A row of newspaper boxes.
fn news_box() -> Asset {
    let mut model = Model::default();
    let pane = model.slot(glass(), &[]);
    let paper = model.slot(Material::plain("paper", vec3(0.55, 0.54, 0.5), 0.8), &[]);
    for (i, color) in [vec3(0.02, 0.06, 0.25), vec3(0.4, 0.03, 0.03), vec3(0.5, 0.3, 0.02)].into_iter().enumerate() {
        let y = (i as f32 - 1.0) * 0.5;
        let body = model.slot(plastic(color), &[]);
        model.add(body, bar(vec3(0.0, y, 0.16), vec3(0.3, 0.36, 0.32)));
        model.add(body, Shape::rounded_block(vec3(0.4, 0.46, 0.7), 0.03).moved(vec3(0.0, y, 0.66)));
        model.add(paper, bar(vec3(0.195, y, 0.76), vec3(0.012, 0.32, 0.3)));
        model.add(pane, Shape::block(vec3(0.004, 0.36, 0.34)).moved(vec3(0.206, y, 0.76)));
    }
    furniture(model, "news-box", "row")
}

/// A parking meter on a pole.
fn meter() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let body = model.slot(painted(vec3(0.09, 0.1, 0.11)), &[]);
    let face = model.slot(plastic(vec3(0.04, 0.09, 0.2)), &[]);
    model.add(steel, post(Vec3::ZERO, 0.03, 1.15, 12));
    model.add(body, Shape::rounded_block(vec3(0.13, 0.16, 0.26), 0.03).moved(vec3(0.0, 0.0, 1.26)));
    model.add(body, Shape::ellipsoid(vec3(0.065, 0.08, 0.08), 16).moved(vec3(0.0, 0.0, 1.39)));
    for turn in [0.0, PI] {
        let plate = bar(vec3(0.064, 0.0, 1.36), vec3(0.012, 0.1, 0.07));
        model.add(face, plate.turned(Quat::from_rotation_z(turn)));
    }
    furniture(model, "parking-meter", "single")
}

fn pay_station() -> Asset {
    let mut model = Model::default();
    let body = model.slot(painted(vec3(0.12, 0.125, 0.13)), &[]);
    let blue = model.slot(plastic(vec3(0.018, 0.075, 0.3)), &[]);
    let white = model.slot(plastic(vec3(0.6, 0.6, 0.58)), &[]);
    model.add(body, Shape::rounded_block(vec3(0.26, 0.32, 1.5), 0.03).moved(vec3(0.0, 0.0, 0.75)));
    model.add(white, bar(vec3(0.131, 0.0, 1.22), vec3(0.006, 0.22, 0.26)));
    model.add(body, post(vec3(0.0, 0.0, 1.45), 0.03, 0.6, 10));
    model.add(blue, bar(vec3(0.0, 0.0, 2.1), vec3(0.04, 0.36, 0.36)));
    for turn in [0.0, PI] {
        let letter = [
            bar(vec3(0.022, -0.06, 2.1), vec3(0.004, 0.04, 0.24)),
            bar(vec3(0.022, 0.0, 2.2), vec3(0.004, 0.12, 0.04)),
            bar(vec3(0.022, 0.0, 2.1), vec3(0.004, 0.12, 0.04)),
            bar(vec3(0.022, 0.05, 2.15), vec3(0.004, 0.04, 0.14)),
        ];
        model.add(white, Shape::join(letter).turned(Quat::from_rotation_z(turn)));
    }
    furniture(model, "parking-meter", "station")
}

/// A thick column with posters all around.
fn advertising_column() -> Asset {
    let mut model = Model::default();
    let body = model.slot(concrete(), &[]);
    let green = model.slot(painted(vec3(0.03, 0.07, 0.05)), &[]);
    let posters = [1, 2, 3].map(|which| model.slot(poster(which), &[]));
    model.add(body, post(Vec3::ZERO, 0.62, 0.35, 32));
    model.add(body, post(Vec3::Z * 0.35, 0.58, 2.5, 32));
    let cap = [(0.0, 2.85), (0.68, 2.85), (0.68, 2.97), (0.45, 3.1), (0.2, 3.3), (0.0, 3.38)];
    model.add(green, Shape::lathe(&cap.map(|(r, z)| vec2(r, z)), 32));
    for (k, poster) in posters.into_iter().enumerate() {
        let (from, to) = (k as f32 / 3.0 + 0.02, (k + 1) as f32 / 3.0 - 0.02);
        let row = |z: f32| -> Vec<Vec3> {
            (0..=10)
                .map(|i| TAU * (from + (to - from) * i as f32 / 10.0))
                .map(|a| vec3(0.584 * a.cos(), 0.584 * a.sin(), z))
                .collect()
        };
        model.add(poster, Shape::sheet(&[row(0.5), row(2.7)]));
    }
    furniture(model, "advertising", "column")
}

/// A tub with a bush in it.
fn planter(name: &str, round: bool) -> Asset {
    let mut model = Model::default();
    let tub = model.slot(concrete(), &[]);
    let soil = model.slot(Material::plain("soil", vec3(0.07, 0.045, 0.03), 0.95), &[]);
    let leaf = vec3(0.035, 0.085, 0.02);
    let leaves = model
        .slot(Material { translucency: 0.2, ..Material::plain("leaves", leaf, 0.6) }, &[leaf, vec3(0.05, 0.1, 0.03)]);
    if round {
        let profile = [(0.0, 0.0), (0.38, 0.0), (0.5, 0.5), (0.5, 0.56), (0.44, 0.56), (0.43, 0.5), (0.0, 0.5)];
        model.add(tub, Shape::lathe(&profile.map(|(r, z)| vec2(r, z)), 24));
    } else {
        model.add(tub, bar(vec3(0.0, 0.0, 0.25), vec3(0.5, 1.4, 0.5)));
        model.add(soil, bar(vec3(0.0, 0.0, 0.49), vec3(0.4, 1.3, 0.04)));
    }
    // Leaves one by one around a few middles.
    let mut random = Seed(23).child(&format!("planter/{name}")).random();
    let middles: &[f32] = if round { &[0.0] } else { &[-0.45, 0.0, 0.45] };
    for &y in middles {
        for _ in 0..220 {
            let turn = Quat::from_rotation_z(random.range(0.0, std::f64::consts::TAU) as f32)
                * Quat::from_rotation_y(random.range(-1.5, 0.4) as f32);
            let reach = random.range(0.1, 0.42) as f32;
            let size = random.range(0.05, 0.09) as f32;
            let blade = Shape::flat(&[
                vec2(0.0, -0.3 * size),
                vec2(size, -0.1 * size),
                vec2(1.4 * size, 0.1 * size),
                vec2(0.3 * size, 0.35 * size),
            ]);
            let both = blade.clone().and(blade.inside_out());
            model.add(leaves, both.moved(Vec3::X * reach).turned(turn).moved(vec3(0.0, y, 0.55)));
        }
    }
    furniture(model, "planter", name)
}

/// A round table with two chairs, with a parasol or without.
fn table(parasol: bool) -> Asset {
    let mut model = Model::default();
    let metal = model.slot(stainless(), &[]);
    let wood = model.slot(timber(), &[]);
    model.add(metal, post(Vec3::ZERO, 0.03, 0.72, 10));
    model.add(metal, post(Vec3::ZERO, 0.22, 0.03, 20));
    model.add(wood, post(Vec3::Z * 0.72, 0.35, 0.03, 28).laid(Vec3::X, Vec2::ZERO));
    for turn in [0.35, 0.35 + PI] {
        let mut chair = vec![board(vec3(0.62, 0.0, 0.45), vec3(0.4, 0.42, 0.03))];
        for (x, y) in [(0.45, -0.18), (0.45, 0.18), (0.79, -0.18), (0.79, 0.18)] {
            let top_m = if x > 0.6 { 0.85 } else { 0.45 };
            chair.push(Shape::tube(&[vec3(x, y, 0.0), vec3(x, y, top_m)], 0.012, 7));
        }
        for z in [0.62, 0.72, 0.82] {
            chair.push(board(vec3(0.79, 0.0, z), vec3(0.02, 0.4, 0.06)));
        }
        model.add(wood, Shape::join(chair).turned(Quat::from_rotation_z(turn)));
    }
    if parasol {
        let cream = vec3(0.5, 0.46, 0.36);
        let cloth = Material { translucency: 0.3, ..Material::plain("awning", cream, 0.85) };
        let cloth = model.slot(cloth, &[cream, vec3(0.35, 0.03, 0.03), vec3(0.03, 0.1, 0.06), vec3(0.5, 0.48, 0.45)]);
        model.add(metal, post(Vec3::Z * 0.7, 0.02, 1.75, 10));
        let shade = Shape::lathe(&[vec2(1.15, 2.1), vec2(0.6, 2.32), vec2(0.0, 2.45)], 8);
        model.add(cloth, shade.clone().and(shade.inside_out()));
    }
    furniture(model, "cafe", if parasol { "parasol" } else { "table" })
}

fn picnic_table() -> Asset {
    let mut model = Model::default();
    let wood = model.slot(timber(), &[]);
    for i in 0..5 {
        model.add(wood, board(vec3(-0.3 + 0.15 * i as f32, 0.0, 0.74), vec3(0.135, 1.8, 0.04)));
    }
    for x in [-0.68, -0.55, 0.55, 0.68] {
        model.add(wood, board(vec3(x, 0.0, 0.44), vec3(0.12, 1.8, 0.04)));
    }
    for y in [-0.6, 0.6] {
        model.add(wood, board(vec3(0.0, y, 0.38), vec3(1.5, 0.05, 0.1)));
        for lean in [-0.45f32, 0.45] {
            let leg = board(vec3(0.0, 0.0, 0.0), vec3(0.09, 0.05, 0.82));
            model.add(wood, leg.turned(Quat::from_rotation_y(lean)).moved(vec3(lean, y, 0.375)));
        }
    }
    furniture(model, "picnic-table", "timber")
}

/// A telephone under a hood on a pillar.
fn telephone() -> Asset {
    let mut model = Model::default();
    let frame = model.slot(stainless(), &[]);
    let magenta = model.slot(painted(vec3(0.4, 0.02, 0.14)), &[vec3(0.4, 0.02, 0.14), vec3(0.03, 0.1, 0.3)]);
    let black = model.slot(rubber(), &[]);
    model.add(frame, bar(vec3(-0.1, 0.0, 1.05), vec3(0.16, 0.3, 2.1)));
    model.add(magenta, bar(vec3(0.02, 0.0, 2.15), vec3(0.5, 0.6, 0.22)));
    model.add(black, bar(vec3(0.03, 0.0, 1.35), vec3(0.12, 0.24, 0.4)));
    model.add(frame, bar(vec3(0.06, 0.0, 1.05), vec3(0.3, 0.3, 0.03)));
    furniture(model, "telephone", "pillar")
}

fn flagpole() -> Asset {
    let mut model = Model::default();
    let white = model.slot(painted(vec3(0.55, 0.55, 0.54)), &[]);
    model.add(white, Shape::tapered_tube(&[(Vec3::ZERO, 0.07), (Vec3::Z * 9.0, 0.04)], 14));
    model.add(white, Shape::ellipsoid(Vec3::splat(0.08), 14).moved(Vec3::Z * 9.05));
    model.add(white, post(Vec3::ZERO, 0.14, 0.12, 16));
    furniture(model, "flagpole", "plain")
}

//! What shops put out: crates of fruit on trestles, with a roof of cloth over them or without. x is the front.

use glam::{Quat, Vec3, vec3};
use trove_model::{Asset, Class, Kind, Material};

use super::finish::{board, cardboard, galvanised, plastic, timber};
use crate::shape::{Model, Shape};
use crate::surfaces::hash;

/// Oranges, apples, lemons, tomatoes, greens and aubergines, linear RGB.
const FRUITS: [Vec3; 6] = [
    vec3(0.62, 0.2, 0.02),
    vec3(0.3, 0.02, 0.02),
    vec3(0.62, 0.45, 0.03),
    vec3(0.48, 0.05, 0.02),
    vec3(0.1, 0.2, 0.03),
    vec3(0.035, 0.012, 0.03),
];
const CRATES: usize = 4;
const CRATE_M: Vec3 = vec3(0.36, 0.5, 0.13);

pub(super) fn assets() -> Vec<Asset> {
    vec![goods(false), goods(true)]
}

/// Two rows of crates that lean to the front.
fn goods(roofed: bool) -> Asset {
    let mut model = Model::default();
    let wood = model.slot(timber(), &[]);
    let card = model.slot(cardboard(), &[]);
    let green = vec3(0.03, 0.16, 0.06);
    let crates = model.slot(plastic(green), &[green, Vec3::splat(0.03), vec3(0.03, 0.08, 0.25)]);
    let fruits = FRUITS.map(|color| model.slot(Material { sheen: 0.1, ..Material::plain("fruit", color, 0.45) }, &[]));
    let length_m = CRATES as f32 * (CRATE_M.y + 0.03);
    for row in 0..2i32 {
        let (x, z) = (0.22 - 0.4 * row as f32, 0.5 + 0.24 * row as f32);
        let lean = Quat::from_rotation_y(0.3);
        model.add(wood, board(Vec3::ZERO, vec3(0.38, length_m, 0.03)).turned(lean).moved(vec3(x, 0.0, z)));
        for end in [-0.45, 0.0, 0.45] {
            model.add(wood, board(vec3(x - 0.12, end * length_m, z / 2.0), vec3(0.05, 0.05, z)));
        }
        for i in 0..CRATES {
            let kind = (hash(i as i32, row, 11) * FRUITS.len() as f32) as usize % FRUITS.len();
            let at = vec3(x, (i as f32 + 0.5) * (CRATE_M.y + 0.03) - length_m / 2.0, z);
            let put = |shape: Shape| shape.moved(Vec3::Z * 0.02).turned(lean).moved(at);
            let slot = if (i + row as usize).is_multiple_of(3) { card } else { crates };
            let (half, high) = (CRATE_M / 2.0, CRATE_M.z);
            for side in [-1.0, 1.0] {
                let long = Shape::block(vec3(0.012, CRATE_M.y, high)).moved(vec3(side * half.x, 0.0, half.z));
                let short = Shape::block(vec3(CRATE_M.x, 0.012, high)).moved(vec3(0.0, side * half.y, half.z));
                model.add(slot, put(long.and(short)));
            }
            for (k, l) in (0..4).flat_map(|k| (0..5).map(move |l| (k, l))) {
                let jitter = |salt: u32| hash(k + 7 * row, l + 5 * i as i32, salt) - 0.5;
                let middle = vec3(-0.125 + 0.083 * k as f32, -0.2 + 0.1 * l as f32, high - 0.01)
                    + 0.02 * vec3(jitter(1), jitter(2), jitter(3));
                model.add(fruits[kind], put(Shape::ellipsoid(vec3(0.043, 0.047, 0.042), 8).moved(middle)));
            }
        }
    }
    if !roofed {
        return furniture(model, &["goods", "open"]);
    }
    let steel = model.slot(galvanised(), &[]);
    let white = vec3(0.55, 0.53, 0.48);
    let cloth = Material { translucency: 0.3, ..Material::plain("awning", white, 0.85) };
    let cloth = model.slot(cloth, &[white, vec3(0.04, 0.12, 0.07), vec3(0.4, 0.03, 0.03), vec3(0.05, 0.1, 0.26)]);
    let (half_x, half_y) = (0.75, length_m / 2.0 + 0.15);
    for (x, y) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)].map(|(x, y)| (x * half_x, y * half_y)) {
        model.add(steel, Shape::tube(&[vec3(x, y, 0.0), vec3(x, y, 2.15)], 0.019, 8));
    }
    // A ridge along y, and a valance all around.
    let edge = |x: f32, z: f32| vec![vec3(x, -half_y - 0.08, z), vec3(x, half_y + 0.08, z)];
    let rows = [edge(0.83, 1.92), edge(0.83, 2.13), edge(0.0, 2.5), edge(-0.83, 2.13), edge(-0.83, 1.92)];
    model.add(cloth, Shape::sheet(&rows).both_sides());
    for y in [-half_y - 0.08, half_y + 0.08] {
        let gable = [vec3(-0.83, y, 2.13), vec3(0.83, y, 2.13)];
        model.add(cloth, Shape::sheet(&[gable.to_vec(), vec![vec3(0.0, y, 2.5); 2]]).both_sides());
        model.add(cloth, Shape::sheet(&[gable.map(|p| p - 0.21 * Vec3::Z).to_vec(), gable.to_vec()]).both_sides());
    }
    furniture(model, &["goods", "stall"])
}

fn furniture(model: Model, tags: &[&str]) -> Asset {
    model.asset(&tags.join("/"), Kind::StreetFurniture, Class::Void).tagged(tags)
}

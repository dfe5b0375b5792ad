//! Broadleaved trees: a crown of lobes, branches grown into them, sprigs on the twigs.

use glam::{Vec3, vec3};
use trove_model::{Asset, Class, Kind, Random, Seed};

use super::growth::{Foliage, Growth, Node, PIPE_EXPONENT, branches};
use super::leaves::{Sprig, bark, material};
use crate::shape::Model;

/// No two plants are of quite one green: factors on the leaves' picture.
pub(super) const SHADES: [Vec3; 4] = [Vec3::ONE, vec3(1.12, 1.05, 0.92), vec3(0.86, 0.93, 1.0), vec3(1.05, 0.95, 0.9)];

/// A kind of tree.
struct Habit {
    id: &'static str,
    /// Height at which branches begin.
    clear_m: f32,
    /// Middle and half axes of the crown.
    middle_m: f32,
    crown_m: Vec3,
    /// Clumps that the crown consists of, and their size as a share of the crown's.
    lobes: usize,
    lobe: f32,
    /// The lowest lobes' height in the crown, −1 to 1: near 1 gives an umbrella.
    lowest: f32,
    points: usize,
    growth: Growth,
    sprig: Sprig,
    green: Vec3,
    card_m: f32,
    /// Sprigs on a twig's joint.
    cards: usize,
    bark: Vec3,
}

pub(super) fn assets() -> Vec<Asset> {
    let growth = Growth { step_m: 0.34, kill_m: 0.55, lift: 0.06, trunk_radius_m: 0.26 };
    [
        Habit {
            id: "tree/plane",
            clear_m: 2.8,
            middle_m: 6.9,
            crown_m: vec3(3.9, 3.9, 4.0),
            lobes: 17,
            lobe: 0.42,
            lowest: -0.75,
            points: 2400,
            growth,
            sprig: Sprig::Broad,
            green: vec3(0.112, 0.165, 0.045),
            card_m: 0.72,
            cards: 3,
            bark: vec3(0.19, 0.165, 0.125),
        },
        Habit {
            id: "tree/oak",
            clear_m: 3.4,
            middle_m: 9.0,
            crown_m: vec3(4.9, 4.7, 5.2),
            lobes: 24,
            lobe: 0.38,
            lowest: -0.85,
            points: 2800,
            growth: Growth { step_m: 0.42, kill_m: 0.68, lift: 0.03, trunk_radius_m: 0.38 },
            sprig: Sprig::Broad,
            green: vec3(0.083, 0.137, 0.039),
            card_m: 0.85,
            cards: 3,
            bark: vec3(0.115, 0.09, 0.065),
        },
        Habit {
            id: "tree/rain-tree",
            clear_m: 3.6,
            middle_m: 8.4,
            crown_m: vec3(8.6, 8.3, 3.4),
            lobes: 34,
            lobe: 0.3,
            lowest: 0.0,
            points: 3600,
            growth: Growth { step_m: 0.5, kill_m: 0.8, lift: 0.02, trunk_radius_m: 0.5 },
            sprig: Sprig::Feathered,
            green: vec3(0.09, 0.151, 0.041),
            card_m: 1.05,
            cards: 3,
            bark: vec3(0.1, 0.085, 0.07),
        },
        Habit {
            id: "tree/young",
            clear_m: 1.9,
            middle_m: 3.7,
            crown_m: vec3(1.35, 1.3, 1.9),
            lobes: 10,
            lobe: 0.45,
            lowest: -0.8,
            points: 700,
            growth: Growth { step_m: 0.2, kill_m: 0.32, lift: 0.12, trunk_radius_m: 0.065 },
            sprig: Sprig::Broad,
            green: vec3(0.128, 0.182, 0.053),
            card_m: 0.46,
            cards: 2,
            bark: vec3(0.15, 0.125, 0.095),
        },
        Habit {
            id: "tree/street",
            clear_m: 2.8,
            middle_m: 5.4,
            crown_m: vec3(2.5, 2.5, 2.9),
            lobes: 13,
            lobe: 0.42,
            lowest: -0.6,
            points: 1700,
            growth: Growth { step_m: 0.28, kill_m: 0.44, lift: 0.08, trunk_radius_m: 0.14 },
            sprig: Sprig::Feathered,
            green: vec3(0.105, 0.168, 0.048),
            card_m: 0.68,
            cards: 3,
            bark: vec3(0.14, 0.115, 0.09),
        },
        Habit {
            id: "tree/tall",
            clear_m: 5.2,
            middle_m: 11.6,
            crown_m: vec3(3.6, 3.5, 5.6),
            lobes: 20,
            lobe: 0.4,
            lowest: -0.8,
            points: 2400,
            growth: Growth { step_m: 0.42, kill_m: 0.66, lift: 0.1, trunk_radius_m: 0.33 },
            sprig: Sprig::Broad,
            green: vec3(0.093, 0.147, 0.045),
            card_m: 0.82,
            cards: 3,
            bark: vec3(0.16, 0.14, 0.115),
        },
        Habit {
            id: "tree/linden",
            clear_m: 2.9,
            middle_m: 7.2,
            crown_m: vec3(3.1, 3.0, 4.7),
            lobes: 20,
            lobe: 0.4,
            lowest: -0.85,
            points: 2400,
            growth: Growth { step_m: 0.34, kill_m: 0.55, lift: 0.1, trunk_radius_m: 0.22 },
            sprig: Sprig::Broad,
            green: vec3(0.098, 0.158, 0.042),
            card_m: 0.7,
            cards: 3,
            bark: vec3(0.125, 0.11, 0.09),
        },
        Habit {
            id: "tree/birch",
            clear_m: 3.2,
            middle_m: 7.6,
            crown_m: vec3(2.2, 2.2, 4.4),
            lobes: 15,
            lobe: 0.36,
            lowest: -0.8,
            points: 1500,
            growth: Growth { step_m: 0.32, kill_m: 0.52, lift: 0.05, trunk_radius_m: 0.13 },
            sprig: Sprig::Feathered,
            green: vec3(0.125, 0.172, 0.052),
            card_m: 0.55,
            cards: 3,
            bark: vec3(0.52, 0.5, 0.46),
        },
        Habit {
            id: "tree/cypress",
            clear_m: 0.5,
            middle_m: 5.0,
            crown_m: vec3(0.75, 0.75, 5.0),
            lobes: 24,
            lobe: 0.3,
            lowest: -0.92,
            points: 1500,
            growth: Growth { step_m: 0.24, kill_m: 0.38, lift: 0.6, trunk_radius_m: 0.15 },
            sprig: Sprig::Needles,
            green: vec3(0.055, 0.088, 0.035),
            card_m: 0.5,
            cards: 5,
            bark: vec3(0.12, 0.1, 0.08),
        },
    ]
    .iter()
    .map(tree)
    .collect()
}

/// A random unit vector.
pub(super) fn direction(random: &mut Random) -> Vec3 {
    let z = random.range(-1.0, 1.0) as f32;
    let turn = random.range(0.0, std::f64::consts::TAU) as f32;
    let r = (1.0 - z * z).sqrt();
    vec3(r * turn.cos(), r * turn.sin(), z)
}

fn tree(habit: &Habit) -> Asset {
    let seed = Seed(11).child(habit.id);
    let nodes = skeleton(habit, seed);
    let mut model = Model::default();
    let bark = model.slot(bark(&format!("{}-bark", habit.id), habit.bark, seed.0 as u32 & 0xffff), &[]);
    model.add(bark, branches(&nodes, 0.0085));
    let leaves = material(&format!("{}-leaves", habit.id), habit.sprig, habit.green, seed.0);
    let leaves = model.slot(leaves, &SHADES);
    model.add(leaves, foliage(habit, &nodes, seed));
    model.asset(habit.id, Kind::Tree, Class::Tree)
}

/// Trunk and branches.
fn skeleton(habit: &Habit, seed: Seed) -> Vec<Node> {
    let mut random = seed.child("crown").random();
    let middle = Vec3::Z * habit.middle_m;
    // Lobes stand on a spiral over the crown's surface, some way in.
    let lobes: Vec<Vec3> = (0..habit.lobes)
        .map(|i| {
            let z = habit.lowest + (0.95 - habit.lowest) * (i as f32 + 0.5) / habit.lobes as f32;
            let turn = i as f32 * 2.399_963 + random.range(-0.4, 0.4) as f32;
            let r = (1.0 - z * z).max(0.0).sqrt();
            // An umbrella has lobes under its middle too.
            let inwards = if habit.lowest >= 0.0 { random.range(0.2, 0.85).sqrt() } else { random.range(0.5, 0.75) };
            middle + vec3(r * turn.cos(), r * turn.sin(), z) * habit.crown_m * inwards as f32
        })
        .collect();
    let points: Vec<Vec3> = (0..habit.points)
        .map(|i| {
            let lobe = lobes[i % lobes.len()];
            let out = direction(&mut random) * (random.unit() as f32).powf(0.45);
            let squash = if habit.lowest >= 0.0 { 1.6 } else { 1.0 };
            lobe + out * habit.crown_m * habit.lobe * vec3(1.0, 1.0, squash * 0.8)
        })
        .filter(|p| p.z > habit.clear_m * 0.9)
        .collect();
    let lean = direction(&mut random) * vec3(0.05, 0.05, 0.0);
    let joints = (habit.clear_m / habit.growth.step_m).ceil() as usize;
    let trunk: Vec<Vec3> = (0..=joints)
        .map(|i| {
            let z = habit.clear_m * i as f32 / joints as f32;
            vec3(0.05 * (z * 1.3).sin(), 0.05 * (z * 0.9 + 1.0).sin(), 0.0) * z.min(1.0) + lean * z + Vec3::Z * z
        })
        .collect();
    habit.growth.grow(&trunk, points, &mut random)
}

/// Sprigs on thin wood, facing up and out.
fn foliage(habit: &Habit, nodes: &[Node], seed: Seed) -> crate::shape::Shape {
    let mut random = seed.child("leaves").random();
    let mut foliage = Foliage::default();
    let middle = Vec3::Z * (habit.middle_m - 0.35 * habit.crown_m.z);
    // Wood that carries up to six tips has leaves.
    let tip_m = nodes.iter().map(|n| n.radius_m).fold(f32::INFINITY, f32::min);
    let thin = tip_m * 6f32.powf(1.0 / PIPE_EXPONENT);
    for node in nodes.iter().skip(1).filter(|n| n.radius_m < thin && n.at.z > habit.clear_m) {
        let outward = ((node.at - middle) / habit.crown_m).normalize_or(Vec3::Z);
        let cards = if node.tip { habit.cards + 1 } else { habit.cards - 1 };
        for _ in 0..cards {
            let along = node.along * 0.5 + direction(&mut random) * 0.9 + outward * 0.55 - Vec3::Z * 0.12;
            let face = Vec3::Z * 0.8 + outward * 0.4 + direction(&mut random) * 0.75;
            let size = habit.card_m * random.range(0.75, 1.2) as f32;
            let back = along.normalize_or(Vec3::Z) * size * 0.12;
            foliage.card(node.at - back, along, face, size, outward);
        }
    }
    foliage.into_shape()
}

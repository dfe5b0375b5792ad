//! Trees with one straight stem: spruces and palms.

use std::f32::consts::TAU;

use glam::{Quat, Vec3, vec2, vec3};
use trove_model::{Asset, Climate, Kind, LeafType, Material, Mesh, Random, Seed};

use super::bark::{Bark, bark};
use super::growth::limb;
use super::individual::{Card, Foliage, Individual, Level, direction, varied};
use super::leaves::{Sprig, material};
use super::tones::{Tones, Year};
use super::trees::plant;
use crate::shape::Shape;
use Climate::{Arid, Cold, Mediterranean, Subtropical, Temperate, Tropical};

const EVERGREEN: Tones<'_> = Tones { green: vec3(0.06, 0.094, 0.046), year: &Year::Evergreen };
const PALM: Tones<'_> = Tones { green: vec3(0.1, 0.142, 0.052), year: &Year::Evergreen };

pub(super) fn assets() -> Vec<Asset> {
    let mut assets = Vec::new();
    let wood = bark("tree/spruce-bark", Bark::Plates, vec3(0.13, 0.1, 0.08), 7);
    let leaves = material("tree/spruce-leaves", Sprig::Needles, 512, 12);
    for (name, height_m, reach_m) in [("1", 13.0, 2.7), ("2", 11.0, 2.5), ("young", 4.2, 1.35)] {
        assets.push(spruce(&format!("tree/spruce-{name}"), [height_m, reach_m], wood.clone(), leaves.clone()));
    }
    let wood = bark("tree/palm-bark", Bark::Ringed, vec3(0.21, 0.19, 0.165), 9);
    for (kind, sprig, individuals) in [
        (Head::Feathers, Sprig::Feather, [("1", 8.2, 3.2), ("2", 6.4, 3.0), ("young", 2.6, 2.4)]),
        (Head::Fans, Sprig::Fan, [("1", 8.8, 1.7), ("2", 6.2, 1.6), ("young", 1.9, 1.4)]),
    ] {
        let leaves = material(&format!("tree/{}-leaves", kind.name()), sprig, 512, 13);
        for (name, trunk_m, frond_m) in individuals {
            let id = format!("tree/{}-{name}", kind.name());
            assets.push(palm(&id, kind, [trunk_m, frond_m], wood.clone(), leaves.clone()));
        }
    }
    assets
}

/// Whorls of branches on a straight trunk, shorter towards the top.
fn spruce(id: &str, [height_m, reach_m]: [f32; 2], wood: Material, leaves: Material) -> Asset {
    let mut random = Seed(12).child(id).random();
    let clear_m = 0.07 * height_m;
    let radius = |z: f32| 0.012 + 0.0145 * height_m * (1.0 - z / height_m);
    let axis = |z: f32| vec3(0.04 * (z * 0.8).sin(), 0.04 * ((z * 0.6).cos() - 1.0), z);
    let heights = (0..=16).map(|i| height_m * i as f32 / 16.0);
    let trunk: Vec<(Vec3, f32)> = heights.map(|z| (axis(z), radius(z) * (1.0 + 0.5 * (-z / 0.3).exp()))).collect();
    let mut paths = Vec::new();
    let mut cards = Vec::new();
    let mut z = clear_m;
    while z < height_m - 0.25 {
        let up = (z - clear_m) / (height_m - clear_m);
        let whole = reach_m * (1.0 - up).powf(0.85) * (0.55 + 0.45 * (up * 6.0).min(1.0)) + 0.2;
        let count = 5 + random.index(3);
        let first = random.range(0.0, f64::from(TAU)) as f32;
        for k in 0..count {
            let turn = first + TAU * k as f32 / count as f32 + random.range(-0.3, 0.3) as f32;
            let reach = whole * random.range(0.7, 1.1) as f32;
            let out = vec3(turn.cos(), turn.sin(), 0.0);
            let slope = -0.42 + 0.75 * up;
            // The branch hangs and its end turns up.
            let at = |t: f32| {
                let p = axis(z) + out * reach * t + Vec3::Z * reach * (slope * t + 0.24 * t * t - 0.1 * t);
                p.max(vec3(f32::MIN, f32::MIN, 0.26))
            };
            let steps = (0..=4).map(|i| i as f32 / 4.0);
            paths.push(steps.map(|t| (at(t), 0.004 + 0.03 * (1.0 - up) * (1.0 - t))).collect::<Vec<_>>());
            let sprigs = 3 + (reach * 5.0) as usize;
            for i in 0..sprigs {
                let t = 0.14 + 0.86 * (i as f32 + 0.5) / sprigs as f32;
                let side = if i % 2 == 0 { 0.8 } else { -0.8 };
                let fan = Quat::from_rotation_z(side * (1.15 - t)) * out;
                for tilt in [-0.75, -0.15, 0.25] {
                    let along = fan + Vec3::Z * tilt + direction(&mut random) * 0.25;
                    let face = Vec3::Z * 0.8 + out * 0.4 + direction(&mut random) * 0.45;
                    let outward = (out + Vec3::Z * 0.55).normalize_or(Vec3::Z);
                    let size_m = (0.24 + 0.13 * reach) * random.range(0.8, 1.2) as f32;
                    let tint = varied(&mut random, 0.16) * (0.78 + 0.3 * t);
                    cards.push(Card { foot: at(t), along, face, size_m, outward, tint });
                }
            }
        }
        z += (0.3 + 0.12 * random.unit() as f32) * (0.4 + 0.05 * height_m);
    }
    for face in [Vec3::X, Vec3::Y] {
        let (foot, size_m) = (axis(height_m - 0.45), 0.6);
        cards.push(Card { foot, along: Vec3::Z, face, size_m, outward: Vec3::Z, tint: Vec3::ONE });
    }
    let foliage = Foliage { cards, bent: false, floor_m: 0.25, most: 4.0 };
    let mut model = Individual::default();
    let wood = model.slot(wood, &[]);
    model.add_shape(wood, |level| {
        let branches = if level == Level::Near { paths.as_slice() } else { &[] };
        let sides = [if level == Level::Far { 5 } else { 10 }, 5, 3];
        Shape::join(branches.iter().map(|path| limb(path, sides))).and(limb(&trunk, sides))
    });
    let leaf = model.slot(leaves, &EVERGREEN.summer());
    model.add(leaf, |level| foliage.mesh(level));
    let habitat = [(Tropical, 0.0), (Arid, 0.0), (Subtropical, 0.05), (Mediterranean, 0.1), (Temperate, 0.06)];
    let genera = ["picea", "spruce", "abies", "larix", "pseudotsuga"];
    model.asset(id, Kind::Tree, plant("spruce", LeafType::Needle, &genera, &habitat, &EVERGREEN, leaf))
}

/// What a palm carries on its trunk.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Head {
    /// Arching feathers out of a green shaft: royal palms.
    Feathers,
    /// Fans on stalks, the dead ones hanging below: washingtonias.
    Fans,
}

impl Head {
    fn name(self) -> &'static str {
        match self {
            Self::Feathers => "palm",
            Self::Fans => "fan-palm",
        }
    }
}

/// A ringed trunk with a head of leaves.
fn palm(id: &str, head: Head, [trunk_m, frond_m]: [f32; 2], wood: Material, leaves: Material) -> Asset {
    let seed = Seed(13).child(id);
    let mut random = seed.random();
    let lean = vec2(0.045, 0.02) * trunk_m * random.range(0.3, 1.6) as f32;
    let axis = |z: f32| (lean * (z / trunk_m).powi(2)).extend(z);
    let thick = if head == Head::Feathers { 0.155 } else { 0.19 };
    let radius = |t: f32| thick * (1.0 + 0.25 * (t * 3.0).sin()) * (1.0 - 0.35 * t) + 0.12 * (-t * trunk_m / 0.3).exp();
    let rings = (trunk_m / 0.2).ceil() as usize;
    let trunk = |every: usize| -> Vec<(Vec3, f32)> {
        (0..=rings)
            .step_by(every)
            .chain([rings])
            .map(|i| i as f32 / rings as f32)
            .map(|t| (axis(t * trunk_m), radius(t)))
            .collect()
    };
    let mut model = Individual::default();
    let wood = model.slot(wood, &[]);
    model.add_shape(wood, |level| match level {
        Level::Near => limb(&trunk(1), [14, 10, 8]),
        Level::Middle => limb(&trunk(4), [8, 6, 5]),
        Level::Far => limb(&trunk(rings), [5, 5, 4]),
    });
    let top = axis(trunk_m);
    if head == Head::Feathers {
        // The smooth shaft that the leaves come out of.
        let shaft = model.slot(Material::plain("crown shaft", vec3(0.1, 0.13, 0.055), 0.5), &[]);
        let profile = [vec2(0.1, -0.12), vec2(0.125, 0.1), vec2(0.1, 0.55), vec2(0.045, 0.85), vec2(0.0, 0.9)];
        model.add_shape(shaft, |level| Shape::lathe(&profile, if level == Level::Near { 12 } else { 6 }).moved(top));
    }
    let leaf = model.slot(leaves, &PALM.summer());
    let fronds: Vec<Frond> = (0..if head == Head::Feathers { 22 } else { 46 })
        .map(|k| Frond::drawn(head, k, top, frond_m, &mut random))
        .collect();
    model.add(leaf, |level| {
        let mut mesh = Mesh::default();
        let every = if level == Level::Far { 2 } else { 1 };
        fronds.iter().step_by(every).for_each(|frond| frond.add_to(&mut mesh, head, level));
        mesh
    });
    let (habitat, genera): (_, &[&str]) = match head {
        Head::Feathers => (
            [(Tropical, 0.9), (Subtropical, 0.5), (Mediterranean, 0.7), (Arid, 0.8), (Temperate, 0.0), (Cold, 0.0)],
            &["roystonea", "cocos", "phoenix", "archontophoenix", "ptychosperma", "syagrus", "areca", "palm"],
        ),
        Head::Fans => (
            [(Tropical, 0.3), (Subtropical, 0.4), (Mediterranean, 0.9), (Arid, 1.0), (Temperate, 0.0), (Cold, 0.0)],
            &["washingtonia", "trachycarpus", "livistona", "sabal", "chamaerops", "palm"],
        ),
    };
    model.asset(id, Kind::Tree, plant(head.name(), LeafType::Frond, genera, &habitat, &PALM, leaf))
}

/// One leaf of a palm.
struct Frond {
    foot: Vec3,
    turn: f32,
    /// Above the horizon where it leaves the trunk, radians.
    pitch: f32,
    length_m: f32,
    tint: Vec3,
}

impl Frond {
    fn drawn(head: Head, k: usize, top: Vec3, frond_m: f32, random: &mut Random) -> Self {
        let count = if head == Head::Feathers { 22.0 } else { 46.0 };
        let t = k as f32 / count;
        let turn = k as f32 * 2.399_963 + random.range(-0.2, 0.2) as f32;
        let length_m = frond_m * random.range(0.85, 1.1) as f32;
        let tint = varied(random, 0.12);
        match head {
            Head::Feathers => Self { foot: top + Vec3::Z * 0.65, turn, pitch: 1.3 - 1.5 * t, length_m, tint },
            // The last ones are dead and hang around the trunk.
            Head::Fans => {
                let dead = t > 0.72;
                let pitch = if dead { -1.25 - 0.2 * random.unit() as f32 } else { 1.45 - 2.5 * t };
                let drop = if dead { 0.25 + 0.9 * (t - 0.72) / 0.28 } else { 0.0 };
                let tint = if dead { tint * vec3(1.7, 1.15, 1.1) } else { tint };
                Self { foot: top - Vec3::Z * drop, turn, pitch, length_m, tint }
            }
        }
    }

    /// Bows under its weight; its two halves hang from the rib.
    fn add_to(&self, mesh: &mut Mesh, head: Head, level: Level) {
        let steps: u32 = match level {
            Level::Near => 10,
            Level::Middle => 5,
            Level::Far => 3,
        };
        let out = vec3(self.turn.cos(), self.turn.sin(), 0.0);
        let across = vec3(-self.turn.sin(), self.turn.cos(), 0.0);
        let (half, sag, fold) = match head {
            Head::Feathers => (0.22, 1.5, 0.65),
            Head::Fans => (0.5, 0.7, 0.3),
        };
        let base = mesh.positions.len() as u32;
        let mut at = self.foot;
        for i in 0..=steps {
            let t = i as f32 / steps as f32;
            let angle = (self.pitch - sag * t * t).max(-1.5);
            let up = Vec3::Z * angle.cos() - out * angle.sin();
            for (u, side) in [(0.0, 1.0), (0.5, 0.0), (1.0, -1.0f32)] {
                let hang = fold * side.abs();
                let p = at + (across * side - up * hang) * self.length_m * half;
                mesh.positions.push(p.max(vec3(f32::MIN, f32::MIN, 0.25)));
                mesh.normals.push((up + across * side * 0.35 + out * 0.3).normalize_or(Vec3::Z));
                mesh.uvs.push(vec2(u, t));
                mesh.tints.push(self.tint);
            }
            at += (out * angle.cos() + Vec3::Z * angle.sin()) * self.length_m / steps as f32;
        }
        for i in 0..steps {
            for half in 0..2 {
                let a = base + 3 * i + half;
                mesh.triangles.extend([[a, a + 1, a + 4], [a, a + 4, a + 3]]);
            }
        }
    }
}

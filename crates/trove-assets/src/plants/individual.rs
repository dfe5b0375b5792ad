//! A plant put together: wood and leaves in three levels of detail.

use std::sync::Arc;

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Coarser, Kind, Material, Mesh, Plant, Random, Slot};

use crate::shape::Shape;

/// How finely a plant is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Level {
    Near,
    Middle,
    Far,
}

impl Level {
    pub(super) const ALL: [Self; 3] = [Self::Near, Self::Middle, Self::Far];

    /// Distances from which the level is seen, for plants of a height, metres.
    fn begins_m(self, height_m: f64) -> f64 {
        let reach_m = height_m.sqrt();
        match self {
            Self::Near => 0.0,
            Self::Middle => 9.0 * reach_m,
            Self::Far => 25.0 * reach_m,
        }
    }

    /// Of how many of `count` cards one is kept, and how much larger it becomes, so that they cover about as much,
    /// but at most `most` times as large.
    fn thinned(self, count: usize, most: f32) -> (usize, f32) {
        let every = match self {
            Self::Near => 1,
            Self::Middle => (count / 900).clamp(2, 4),
            Self::Far => (count / 200).clamp(4, 18),
        };
        let every = every.min((most * most * 1.3) as usize).max(1);
        (every, if every == 1 { 1.0 } else { 0.88 * (every as f32).sqrt() })
    }
}

/// A plant under construction.
#[derive(Default)]
pub(super) struct Individual {
    levels: [Mesh; 3],
    slots: Vec<Slot>,
}

impl Individual {
    /// A slot with a material and the colours that it is seen in.
    pub(super) fn slot(&mut self, material: Material, paints: &[Vec3]) -> u16 {
        self.slots.push(Slot::new(material, paints.to_vec()));
        self.slots.len() as u16 - 1
    }

    /// Adds something to each level.
    pub(super) fn add(&mut self, slot: u16, mesh: impl Fn(Level) -> Mesh) {
        for (level, whole) in Level::ALL.into_iter().zip(&mut self.levels) {
            let part = mesh(level);
            if !part.triangles.is_empty() {
                whole.append(&part, slot);
            }
        }
    }

    /// Adds a shape to each level.
    pub(super) fn add_shape(&mut self, slot: u16, shape: impl Fn(Level) -> Shape) {
        self.add(slot, |level| shape(level).into_mesh());
    }

    /// The asset, standing on the ground: a tree on its trunk, anything else on the middle of its bounds.
    pub(super) fn asset(self, id: &str, kind: Kind, plant: Plant) -> Asset {
        let [mut near, middle, far] = self.levels;
        let (low, high) = near.bounds().unwrap_or_default();
        let centre = if kind == Kind::Tree { Vec3::ZERO } else { (low + high) / 2.0 };
        let origin = vec3(centre.x, centre.y, low.z);
        let moved = |mesh: &mut Mesh| mesh.positions.iter_mut().for_each(|p| *p -= origin);
        moved(&mut near);
        let height_m = f64::from(high.z - low.z);
        let coarser = [(Level::Middle, middle), (Level::Far, far)]
            .map(|(level, mut mesh)| {
                moved(&mut mesh);
                Coarser { from_m: level.begins_m(height_m), mesh: Arc::new(mesh) }
            })
            .to_vec();
        let asset = Asset::new(id, kind, kind.class(), near, self.slots, crate::licence::LICENCE);
        let species = plant.species.clone();
        Asset { coarser, plant: Some(plant), ..asset }.tagged(species)
    }
}

/// A square that a sprig is painted on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Card {
    pub(super) foot: Vec3,
    /// Where it grows.
    pub(super) along: Vec3,
    /// Where its face is turned.
    pub(super) face: Vec3,
    pub(super) size_m: f32,
    /// Normal of the crown there: light falls on the card as on the crown's surface.
    pub(super) outward: Vec3,
    /// What its colour is multiplied by.
    pub(super) tint: Vec3,
}

/// Cards that leaves are painted on.
#[derive(Clone, Debug, Default)]
pub(super) struct Foliage {
    pub(super) cards: Vec<Card>,
    /// Near cards bow under their weight; else all are flat.
    pub(super) bent: bool,
    /// Nothing of it reaches below this, metres.
    pub(super) floor_m: f32,
    /// Farther away cards become at most so many times as large.
    pub(super) most: f32,
}

impl Foliage {
    /// The cards of a level; coarser ones have fewer and larger.
    pub(super) fn mesh(&self, level: Level) -> Mesh {
        let (every, larger) = level.thinned(self.cards.len(), self.most);
        let mut mesh = Mesh::default();
        for card in self.cards.iter().step_by(every) {
            // It grows about its middle, so that the crown keeps its outline.
            let middle = card.foot + card.along.normalize_or(Vec3::Z) * card.size_m * 0.5;
            let size_m = card.size_m * larger;
            let inwards = card.outward * card.size_m * (larger - 1.0) * 0.3;
            let foot = middle - card.along.normalize_or(Vec3::Z) * size_m * 0.5 - inwards;
            self.card(&mut mesh, &Card { foot, size_m, ..*card }, self.bent && level == Level::Near);
        }
        mesh
    }

    fn card(&self, mesh: &mut Mesh, card: &Card, bent: bool) {
        let along = card.along.normalize_or(Vec3::Z);
        let across = along.cross(card.face).normalize_or(along.any_orthonormal_vector());
        let normal = across.cross(along);
        let shade = (card.outward * 0.75 + normal * 0.45).normalize_or(card.outward);
        let base = mesh.positions.len() as u32;
        let rows = if bent { 2 } else { 1 };
        for row in 0..=rows {
            let v = row as f32 / rows as f32;
            // The tip hangs, and the normal follows.
            let droop = if bent { 0.22 * v * v } else { 0.0 };
            for u in [0.0, 1.0f32] {
                let p = card.foot + (across * (u - 0.5) + along * v - Vec3::Z * droop) * card.size_m;
                mesh.positions.push(p.max(vec3(f32::MIN, f32::MIN, self.floor_m)));
                let bow = across * (u - 0.5) * 0.35 + along * if bent { 0.45 * (v - 0.4) } else { 0.0 };
                mesh.normals.push((shade + bow).normalize_or(shade));
                mesh.uvs.push(vec2(u, v));
                mesh.tints.push(card.tint);
            }
        }
        for row in 0..rows {
            let a = base + 2 * row;
            mesh.triangles.extend([[a, a + 1, a + 3], [a, a + 3, a + 2]]);
        }
    }
}

/// Between two sprigs of a plant: lighter or darker, and a little towards yellow or blue.
pub(super) fn varied(random: &mut Random, spread: f64) -> Vec3 {
    let tone = 1.0 + random.range(-spread, spread) as f32;
    let hue = random.range(-0.4 * spread, 0.4 * spread) as f32;
    tone * vec3(1.0 + hue, 1.0, 1.0 - hue)
}

/// A random unit vector.
pub(super) fn direction(random: &mut Random) -> Vec3 {
    let z = random.range(-1.0, 1.0) as f32;
    let turn = Vec2::from_angle(random.range(0.0, std::f64::consts::TAU) as f32);
    (turn * (1.0 - z * z).sqrt()).extend(z)
}

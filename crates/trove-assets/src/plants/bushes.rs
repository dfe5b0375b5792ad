//! Shrubs, hedges and planted strips: dark insides, stems, sprigs over a clumpy or clipped surface.

use glam::{Vec2, Vec3, vec2, vec3};
use rayon::prelude::*;
use trove_model::{
    Asset, Foliage as SeasonalFoliage, Kind, LeafType, Material, Plant, PlantForm, Random, Season, Seed,
};

use super::bark::{Bark, bark};
use super::growth::limb;
use super::individual::{Card, Foliage, Individual, Level, direction, varied};
use super::leaves::{BARE, Sprig, material, paint};
use super::plan::{PlantPlans, RowPlan, ShrubPlan, climates, offered, species};
use super::tones::TWIGS;
use super::trees::plant;
use crate::shape::Shape;

/// The shrubs, hedges and beds of these plans.
pub(super) fn assets(plans: &PlantPlans) -> Vec<Asset> {
    let shrubs = plans.shrubs.par_iter().flat_map_iter(|plan| {
        let leaves = material(&format!("{}-leaves", plan.id), plan.sprig, 256, 14);
        ["1", "2"].map(|name| bush(plan, &format!("{}-{name}", plan.id), leaves.clone()))
    });
    let hedges = plans.hedges.par_iter().flat_map_iter(|plan| pieces(plan, "hedge-", PlantForm::Hedge, hedge));
    let beds = plans.beds.par_iter().flat_map_iter(|plan| pieces(plan, "bed-", PlantForm::Bed, bed));
    shrubs.chain(hedges).chain(beds).collect()
}

/// Maps name no species of bushes.
const NO_GENERA: &[&str] = &[];

/// What is seen between leaves: twigs in the dark.
fn inside() -> Material {
    Material::plain("bush/inside", vec3(0.026, 0.028, 0.015), 0.95)
}

fn bush(plan: &ShrubPlan, id: &str, leaves: Material) -> Asset {
    let mut random = Seed(14).child(id).random();
    let half = Vec3::from_array(plan.half_m) * vec3(1.0, 1.0, random.range(0.9, 1.1) as f32);
    let clumps = clumps(plan, half, &mut random);
    let mut model = Individual::default();
    let foliage = if plan.from_ground {
        stalks(plan, &clumps, half, &mut random)
    } else {
        let dark = model.slot(inside(), &[]);
        model.add_shape(dark, |level| core(&clumps, level));
        let wood = model.slot(bark("bush/bark", Bark::Furrowed(0.03), vec3(0.11, 0.09, 0.065), 13), &[]);
        let stems: Vec<[(Vec3, f32); 3]> = clumps.iter().map(|(middle, _)| stem(*middle)).collect();
        model.add_shape(wood, |level| match level {
            Level::Near => Shape::join(stems.iter().map(|path| limb(path, [5, 5, 4]))),
            _ => Shape::default(),
        });
        skin(plan, &clumps, half, &mut random)
    };
    let leaf = model.slot(leaves, &plan.tones().summer());
    model.add(leaf, |level| foliage.mesh(level));
    let habitat = climates(&plan.habitat);
    let known = plant(species(&plan.id), LeafType::Broad, NO_GENERA, &habitat, &plan.tones(), leaf);
    offered(model.asset(id, Kind::Bush, known), &plan.tags, plan.commonness)
}

/// Middles and half axes of the clumps, which fill the lower and outer parts of the whole.
fn clumps(plan: &ShrubPlan, half: Vec3, random: &mut Random) -> Vec<(Vec3, Vec3)> {
    if plan.clumps == 1 {
        return vec![(Vec3::Z * half.z, half)];
    }
    (0..plan.clumps)
        .map(|i| {
            let t = (i as f32 + 0.5) / plan.clumps as f32;
            let size = plan.clump * random.range(0.8, 1.2) as f32;
            let axes = half * vec3(size, size, (size * 1.25).min(1.0));
            let turn = Vec2::from_angle(i as f32 * 2.399_963 + random.range(-0.4, 0.4) as f32);
            // Higher towards the middle.
            let out = t.sqrt() * (1.0 - size);
            let top = 2.0 * half.z * (1.0 - 0.55 * t * t) * random.range(0.82, 1.0) as f32;
            let z = (top - axes.z).max(axes.z * 0.75);
            ((turn * out).extend(0.0) * half + Vec3::Z * z, axes)
        })
        .collect()
}

/// From the foot into a clump.
fn stem(middle: Vec3) -> [(Vec3, f32); 3] {
    let r = 0.01 + 0.012 * middle.z;
    let bend = middle * vec3(0.45, 0.45, 0.5);
    [(middle * vec3(0.15, 0.15, 0.0), r), (bend, r * 0.8), (middle, r * 0.4)]
}

/// Dark ellipsoids inside the clumps, down to the ground.
fn core(clumps: &[(Vec3, Vec3)], level: Level) -> Shape {
    let around = if level == Level::Near { 10 } else { 6 };
    let every = if level == Level::Far { 2 } else { 1 };
    Shape::join(clumps.iter().step_by(every).map(|(middle, axes)| {
        let half_m = (middle.z + 0.55 * axes.z) / 2.0;
        // Under a high clump there are but stems.
        let slim = 0.7 * (1.3 * axes.z / half_m).min(1.0);
        Shape::ellipsoid(vec3(axes.x * slim, axes.y * slim, half_m), around).moved(vec3(middle.x, middle.y, half_m))
    }))
}

/// Sprigs over the clumps' common surface.
fn skin(plan: &ShrubPlan, clumps: &[(Vec3, Vec3)], half: Vec3, random: &mut Random) -> Foliage {
    let mut cards = Vec::new();
    let weight: f32 = clumps.iter().map(|(_, a)| a.x * a.y + a.x * a.z + a.y * a.z).sum();
    for &(middle, axes) in clumps {
        let share = (axes.x * axes.y + axes.x * axes.z + axes.y * axes.z) / weight;
        for _ in 0..(plan.cards as f32 * 1.5 * share) as usize {
            let out = direction(random);
            let deep = 1.0 - 0.3 * (random.unit() as f32).powi(2);
            let at = middle + out * axes * deep;
            let inner = clumps.iter().any(|(m, a)| (*m, *a) != (middle, axes) && ((at - *m) / *a).length() < 0.8);
            if inner || at.z < 0.02 || cards.len() >= plan.cards {
                continue;
            }
            let own = (out / axes).normalize_or(Vec3::Z);
            let whole = ((at - Vec3::Z * 0.5 * half.z) / half).normalize_or(Vec3::Z);
            let outward = (own * 0.6 + whole * 0.6 + Vec3::Z * 0.25).normalize_or(Vec3::Z);
            let along = own * 0.75 + direction(random) * 0.9 + Vec3::Z * 0.35;
            let size_m = plan.card_m * random.range(0.7, 1.2) as f32;
            let foot = (at - along.normalize_or(Vec3::Z) * size_m * 0.55).max(vec3(f32::MIN, f32::MIN, 0.0));
            let face = own + direction(random) * 0.75;
            // Low and inner leaves are older and dustier.
            let tint = varied(random, 0.16) * (0.75 + 0.3 * (at.z / (2.0 * half.z)).clamp(0.0, 1.0));
            cards.push(Card { foot, along, face, size_m, outward, tint });
        }
    }
    Foliage { cards, bent: false, floor_m: 0.0, most: 4.0 }
}

/// Leaves on stalks out of the ground, arching apart.
fn stalks(plan: &ShrubPlan, clumps: &[(Vec3, Vec3)], half: Vec3, random: &mut Random) -> Foliage {
    let cards = (0..plan.cards).map(|i| {
        let (middle, axes) = clumps[i % clumps.len()];
        let out = Vec2::from_angle(random.range(0.0, std::f64::consts::TAU) as f32);
        let reach = random.unit().sqrt() as f32;
        let foot = (middle.truncate() * 0.8 + out * axes.truncate() * reach * 0.6).extend(0.0);
        let rise = half.z * random.range(0.0, 1.1) as f32 * (1.0 - 0.6 * reach);
        let outer = (foot.truncate() / half.truncate() + out * 0.45).extend(0.0);
        let along =
            outer * random.range(0.3, 1.2) as f32 + Vec3::Z * random.range(0.3, 1.3) as f32 + direction(random) * 0.35;
        let size_m = plan.card_m * random.range(0.65, 1.1) as f32;
        let face = Vec3::Z + out.extend(0.0) * 0.4 + direction(random) * 0.4;
        let outward = (outer + Vec3::Z * 0.8).normalize_or(Vec3::Z);
        let tint = varied(random, 0.15) * (0.8 + 0.3 * rise / half.z);
        Card { foot: foot + Vec3::Z * rise, along, face, size_m, outward, tint }
    });
    Foliage { cards: cards.collect(), bent: true, floor_m: 0.0, most: 4.0 }
}

/// Two pieces of a row; `kind` is what its id has before its species.
fn pieces(
    plan: &RowPlan,
    kind: &str,
    form: PlantForm,
    grow: fn(&RowPlan, &str, Material, &mut Random) -> (Individual, u16),
) -> [Asset; 2] {
    let leaves = material(&format!("{}-leaves", plan.id), plan.sprig, 256, 15);
    let name = species(&plan.id);
    let name = name.strip_prefix(kind).unwrap_or(name);
    let habitat = climates(&plan.habitat);
    ["1", "2"].map(|piece| {
        let id = format!("{}-{piece}", plan.id);
        let (model, leaf) = grow(plan, &id, leaves.clone(), &mut Seed(15).child(&id).random());
        let mut known = plant(name, LeafType::Broad, NO_GENERA, &habitat, &plan.tones(), leaf);
        // In winter heads are gone and their stalks stand.
        known.seasons.extend((1..=plan.flowers.len() as u16).map(|k| SeasonalFoliage {
            season: Season::Winter,
            slot: leaf + k,
            paints: vec![paint(TWIGS)],
            alpha_cutoff: BARE,
        }));
        offered(model.asset(&id, Kind::Bush, Plant { form, ..known }), &plan.tags, plan.commonness)
    })
}

/// A clipped piece, two metres long, whose ends are flush.
fn hedge(plan: &RowPlan, _: &str, leaves: Material, random: &mut Random) -> (Individual, u16) {
    let half = vec3(1.0, 0.36, 0.5);
    let mut model = Individual::default();
    let dark = model.slot(inside(), &[]);
    // Shorter than the piece, lest the cores of two pieces share a face.
    let core = Shape::block(vec3(1.84, 0.56, 0.88)).moved(Vec3::Z * 0.44);
    model.add_shape(dark, |_| core.clone());
    let faces = [(Vec3::Z, 1.5), (Vec3::Y, 2.0), (-Vec3::Y, 2.0), (Vec3::X, 1.0), (-Vec3::X, 1.0)];
    let mut cards = Vec::new();
    for _ in 0..plan.cards {
        let outward = random.weighted(faces.map(|f| f.1)).map_or(Vec3::Z, |i| faces[i].0);
        let spread = Vec3::from_array(std::array::from_fn(|_| random.range(-1.0, 1.0) as f32));
        // Shears leave waves.
        let wave = 0.02 * (spread.x * 5.0).sin() + 0.015 * (spread.z * 4.0 + spread.x * 3.0).sin();
        let deep = 0.97 - 0.1 * (random.unit() as f32).powi(2) + wave;
        let p = (spread * (1.0 - outward.abs()) + outward * deep) * half + Vec3::Z * half.z;
        // The upper edges are rounded off.
        let edge = ((p.z - 0.86).max(0.0) * 2.0).min(0.25);
        let p = vec3(p.x, p.y * (1.0 - edge * 0.6), p.z);
        let along = outward * 0.6 + direction(random) + Vec3::Z * 0.3;
        let size_m = plan.card_m * random.range(0.7, 1.2) as f32;
        let foot = (p - along.normalize_or(Vec3::Z) * size_m * 0.6).max(vec3(-1.06, -0.42, 0.0));
        let tint = varied(random, 0.15) * (0.78 + 0.25 * p.z);
        let face = outward + direction(random) * 0.7;
        let shade = (outward + Vec3::Z * 0.35).normalize();
        cards.push(Card { foot, along, face, size_m, outward: shade, tint });
    }
    let foliage = Foliage { cards, bent: false, floor_m: 0.0, most: 4.0 };
    let leaf = model.slot(leaves, &plan.tones().summer());
    model.add(leaf, |level| foliage.mesh(level));
    (model, leaf)
}

/// A strip of two metres by one: leaves, and heads above them.
fn bed(plan: &RowPlan, id: &str, leaves: Material, random: &mut Random) -> (Individual, u16) {
    let mut model = Individual::default();
    let place = |random: &mut Random| vec2(random.range(-0.96, 0.96) as f32, random.range(-0.42, 0.42) as f32);
    let mut cards = Vec::new();
    for _ in 0..plan.cards {
        let at = place(random).extend(0.1 * random.unit() as f32);
        let out = direction(random) * vec3(1.0, 1.0, 0.0);
        let along = out * 0.7 + Vec3::Z * random.range(0.4, 1.2) as f32;
        let size_m = plan.card_m * random.range(0.7, 1.25) as f32;
        let (face, outward) = (Vec3::Z + direction(random) * 0.5, (Vec3::Z + out * 0.4).normalize());
        cards.push(Card { foot: at, along, face, size_m, outward, tint: varied(random, 0.16) });
    }
    let foliage = Foliage { cards, bent: false, floor_m: 0.0, most: 4.0 };
    let leaf = model.slot(leaves, &plan.tones().summer());
    model.add(leaf, |level| foliage.mesh(level));
    for (k, color) in plan.flowers.iter().enumerate() {
        // Each sort has its own part of the strip.
        let heads = material(&format!("{id}-heads"), Sprig::Flowers, 256, 16 + k as u64);
        let slot = model.slot(heads, &[Vec3::from_array(*color) * 1.8]);
        let part = 2.0 / plan.flowers.len() as f32;
        let cards = (0..70).map(|_| {
            let at = place(random);
            let x = -1.0 + part * (k as f32 + 0.5 + (at.x * 0.62));
            let along = Vec3::Z + direction(random) * 0.25;
            let face = direction(random) * vec3(1.0, 1.0, 0.3);
            let foot = vec3(x.clamp(-0.95, 0.95), at.y, 0.04);
            let size_m = 0.34 * random.range(0.75, 1.2) as f32;
            Card { foot, along, face, size_m, outward: Vec3::Z, tint: varied(random, 0.12) }
        });
        let heads = Foliage { cards: cards.collect(), bent: false, floor_m: 0.0, most: 4.0 };
        model.add(slot, |level| heads.mesh(level));
    }
    (model, leaf)
}

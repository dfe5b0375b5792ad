//! Broadleaved trees, pines and cypresses: a crown of lobes, branches grown into them, sprigs on the twigs.

use glam::{Vec3, vec3};
use rayon::prelude::*;
use trove_model::{Asset, Climate, Foliage as SeasonalFoliage, Kind, LeafType, Material, Plant, Seed};

use super::bark::bark;
use super::growth::{Growth, Node, PIPE_EXPONENT, branches};
use super::individual::{Card, Foliage, Individual, direction, varied};
use super::leaves::material;
use super::plan::{TreePlan, climates, offered, species};
use super::tones::Tones;
use crate::shape::Curve;

/// How one individual differs from its species.
struct Individuality {
    name: &'static str,
    /// Of the species' height and width.
    size: f32,
    /// Narrower than its species.
    slim: f32,
    /// Height at which branches begin, as a share of its species'.
    clear: f32,
    /// Points that branches grow to, as a share.
    dense: f32,
}

const INDIVIDUALS: [Individuality; 3] = [
    Individuality { name: "1", size: 1.0, slim: 1.0, clear: 1.0, dense: 1.0 },
    // As trees of streets are cut: over a lane nothing hangs.
    Individuality { name: "2", size: 0.95, slim: 0.92, clear: 1.75, dense: 0.85 },
    Individuality { name: "young", size: 0.46, slim: 0.8, clear: 1.15, dense: 0.4 },
];

pub(super) fn assets(plans: &[TreePlan]) -> Vec<Asset> {
    plans.par_iter().flat_map_iter(individuals).collect()
}

fn individuals(plan: &TreePlan) -> Vec<Asset> {
    let id = &plan.id;
    let seed = Seed(11).child(id);
    let wood = bark(&format!("{id}-bark"), plan.bark, Vec3::from_array(plan.bark_color), seed.0 as u32 & 0xffff);
    let leaves = material(&format!("{id}-leaves"), plan.sprig, 512, seed.0);
    let grow = |i: &Individuality| tree(plan, i, &format!("{id}-{}", i.name), wood.clone(), leaves.clone());
    INDIVIDUALS.iter().map(grow).collect()
}

fn tree(plan: &TreePlan, individual: &Individuality, id: &str, wood: Material, leaves: Material) -> Asset {
    let seed = Seed(11).child(id);
    let crown = Crown::new(plan, individual);
    let nodes = crown.skeleton(plan, individual, seed);
    let mut model = Individual::default();
    let wood = model.slot(wood, &[]);
    let leaf = model.slot(leaves, &plan.tones().summer());
    model.add_shape(wood, |level| branches(&nodes, 0.008, plan.roots, level));
    let foliage = crown.foliage(plan, individual, &nodes, seed);
    model.add(leaf, |level| foliage.mesh(level));
    let habitat = climates(&plan.habitat);
    let known = plant(species(&plan.id), plan.leaves.into(), &plan.genera, &habitat, &plan.tones(), leaf);
    offered(model.asset(id, Kind::Tree, known), &plan.tags, plan.commonness)
}

/// What is known of a plant; `leaf` is the slot that the seasons change.
pub(super) fn plant(
    name: &str,
    leaves: LeafType,
    genera: &[impl AsRef<str>],
    habitat: &[(Climate, f32)],
    tones: &Tones<'_>,
    leaf: u16,
) -> Plant {
    let seasons: Vec<SeasonalFoliage> = tones.seasons(leaf);
    Plant {
        species: Some(name.into()),
        leaves,
        genera: genera.iter().map(|g| g.as_ref().into()).collect(),
        habitat: habitat.to_vec(),
        seasons,
        ..Plant::default()
    }
}

/// Where the leaves of an individual are.
struct Crown {
    clear_m: f32,
    height_m: f32,
    radius_m: f32,
    /// Radius as a share of the largest over the height in the crown, 0 to 1.
    profile: Curve,
}

impl Crown {
    fn new(plan: &TreePlan, individual: &Individuality) -> Self {
        let height_m = plan.height_m * individual.size;
        Self {
            clear_m: height_m * (plan.clear * individual.clear).min(0.6),
            height_m,
            radius_m: plan.radius_m * individual.size * individual.slim,
            profile: Curve::new(&plan.crown),
        }
    }

    fn depth_m(&self) -> f32 {
        self.height_m - self.clear_m
    }

    /// Normal of the crown's surface as light falls on it.
    fn outward(&self, p: Vec3) -> Vec3 {
        let middle = Vec3::Z * (self.clear_m + 0.38 * self.depth_m());
        ((p - middle) / vec3(self.radius_m, self.radius_m, 0.6 * self.depth_m())).normalize_or(Vec3::Z)
    }

    /// Trunk and branches.
    fn skeleton(&self, plan: &TreePlan, individual: &Individuality, seed: Seed) -> Vec<Node> {
        let mut random = seed.child("crown").random();
        let count = ((plan.lobes as f32) * (0.5 + 0.5 * individual.dense)) as usize;
        // Lobes stand on a spiral, near the crown's surface.
        let lobes: Vec<(Vec3, f32)> = (0..count)
            .map(|i| {
                let up = (i as f32 + 0.5 + random.range(-0.3, 0.3) as f32) / count as f32;
                let radius = self.radius_m * self.profile.at(up);
                let size = (plan.lobe * self.radius_m).min(0.75 * radius + 0.15).max(0.2 * self.radius_m);
                let turn = i as f32 * 2.399_963 + random.range(-0.5, 0.5) as f32;
                let out = (radius - size).max(0.0) * random.range(0.45, 1.0).sqrt() as f32;
                let z = self.clear_m + up * self.depth_m();
                let top = self.height_m - 0.8 * size;
                (vec3(out * turn.cos(), out * turn.sin(), z.min(top)), size * random.range(0.8, 1.15) as f32)
            })
            .collect();
        let points = (plan.points as f32 * individual.dense) as usize;
        let points: Vec<Vec3> = (0..points)
            .map(|i| {
                let (middle, size) = lobes[i % lobes.len()];
                middle + direction(&mut random) * (random.unit() as f32).powf(0.42) * size * vec3(1.0, 1.0, plan.flat)
            })
            .filter(|p| p.z > self.clear_m * 0.92)
            .collect();
        // Slender crowns need finer wood.
        let step_m = ((self.radius_m * 0.5 + self.depth_m() * 0.25).sqrt() * 0.19).min(0.2 * self.radius_m);
        let growth = Growth {
            step_m,
            kill_m: step_m * 1.65,
            lift: plan.lift,
            trunk_radius_m: plan.trunk_m * individual.size.powf(1.15),
        };
        let leader_m = self.clear_m + plan.leader * self.depth_m();
        let joints = (leader_m / step_m).ceil() as usize;
        let (lean, sway) = (direction(&mut random) * vec3(0.035, 0.035, 0.0), random.range(0.0, 6.0) as f32);
        let trunk: Vec<Vec3> = (0..=joints)
            .map(|i| {
                let z = leader_m * i as f32 / joints as f32;
                let bend =
                    vec3((z * 0.9 + sway).sin() - sway.sin(), (z * 0.7 + 2.0 * sway).sin() - (2.0 * sway).sin(), 0.0);
                bend * 0.014 * self.radius_m + lean * z + Vec3::Z * z
            })
            .collect();
        growth.grow(&trunk, points, &mut random)
    }

    /// Sprigs on thin wood, facing up and out.
    fn foliage(&self, plan: &TreePlan, individual: &Individuality, nodes: &[Node], seed: Seed) -> Foliage {
        let mut random = seed.child("leaves").random();
        // Wood that carries up to six tips has leaves.
        let tip_m = nodes.iter().map(|n| n.radius_m).fold(f32::INFINITY, f32::min);
        let thin = tip_m * 6f32.powf(1.0 / PIPE_EXPONENT);
        let leafy: Vec<&Node> = nodes.iter().skip(1).filter(|n| n.radius_m < thin && n.at.z > self.clear_m).collect();
        let card_m = plan.card_m * individual.size.powf(0.4);
        // As many leaves over a square metre of ground as its species has.
        let wanted = plan.cards as f32 * (individual.size * individual.slim * plan.card_m / card_m).powi(2);
        // The share of the crown's cards that a joint bears, whole ones by chance.
        let each = wanted / leafy.iter().map(|n| if n.tip { 1.6 } else { 1.0 }).sum::<f32>().max(1.0);
        let mut cards = Vec::new();
        for node in leafy {
            let outward = self.outward(node.at);
            let count = each * if node.tip { 1.6 } else { 1.0 } + random.unit() as f32;
            // Leaves inside get less sun and are older.
            let flat = node.at.truncate().length() / self.radius_m;
            let deep = flat.max((node.at.z - self.clear_m) / self.depth_m()).clamp(0.0, 1.0);
            for _ in 0..count as usize {
                let along = node.along * 0.5 + direction(&mut random) * 0.9 + outward * 0.5 + Vec3::Z * plan.hang;
                let face = Vec3::Z * 0.8 + outward * 0.4 + direction(&mut random) * 0.75;
                let size_m = card_m * random.range(0.75, 1.2) as f32;
                let foot = node.at - along.normalize_or(Vec3::Z) * size_m * 0.12;
                let tint = varied(&mut random, 0.17) * (0.88 + 0.18 * deep);
                cards.push(Card { foot, along, face, size_m, outward, tint });
            }
        }
        Foliage { cards, bent: true, floor_m: 0.25, most: (1.5 * self.radius_m / card_m).max(2.0) }
    }
}

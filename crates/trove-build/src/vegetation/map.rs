//! Vegetation as the map has it.

use glam::DVec2;
use trove_model::{FurnitureKind, Kind, LandKind, Polygon, Random, Seed};

use super::{Wish, species_group};
use crate::surroundings::Surroundings;

/// How densely a piece of land is planted.
struct Planting {
    /// Distance of neighbouring trees, metres; 0: none.
    trees_m: f64,
    /// Share of the trees' places that carry one.
    tree_share: f64,
    /// Distance of neighbouring bushes, metres; 0: none.
    bushes_m: f64,
    /// Share of the bushes' places that carry one.
    bush_share: f64,
    /// Trees' heights, metres.
    heights_m: [f64; 2],
}

fn planting(kind: LandKind) -> Option<Planting> {
    let planting = |trees_m, tree_share, bushes_m, bush_share, heights_m| {
        Some(Planting { trees_m, tree_share, bushes_m, bush_share, heights_m })
    };
    match kind {
        LandKind::Wood => planting(5.0, 0.9, 4.0, 0.4, [8.0, 14.0]),
        LandKind::Park => planting(11.0, 0.55, 9.0, 0.15, [6.0, 12.0]),
        LandKind::Garden => planting(9.0, 0.4, 3.5, 0.3, [4.0, 8.0]),
        LandKind::Grass => planting(13.0, 0.35, 8.0, 0.12, [5.0, 10.0]),
        LandKind::Scrub => planting(14.0, 0.3, 2.2, 0.6, [3.5, 6.0]),
        LandKind::Residential => planting(18.0, 0.3, 12.0, 0.2, [5.0, 9.0]),
        _ => None,
    }
}

/// Mapped trees first, then plants scattered over green land.
pub(super) fn wishes(around: &Surroundings, seed: Seed) -> Vec<Wish> {
    let Some(map) = around.map else { return Vec::new() };
    let mut wishes = Vec::new();
    for tree in map.furniture.iter().filter(|f| f.kind == FurnitureKind::Tree && around.bounds.contains(f.position)) {
        let seed = seed.child("tree").nth(tree.id as u64);
        let height_m = seed.random().range(5.5, 10.0);
        let group = species_group(seed.child("kind"), tree.position);
        wishes.push(Wish { kind: Kind::Tree, position: tree.position, height_m, group, radius_m: Some(1.0) });
    }
    for land in &map.land {
        let Some(planting) = planting(land.kind) else { continue };
        let Some(bounds) = land.polygon.bounds().filter(|b| b.overlaps(&around.bounds)) else { continue };
        let seed = seed.child("land").nth(land.id as u64);
        let low = bounds.min.max(around.bounds.min);
        let high = bounds.max.min(around.bounds.max);
        let mut random = seed.random();
        for (kind, step_m, share) in
            [(Kind::Tree, planting.trees_m, planting.tree_share), (Kind::Bush, planting.bushes_m, planting.bush_share)]
        {
            let [least_m, most_m] = if kind == Kind::Tree { planting.heights_m } else { [0.6, 1.6] };
            for position in jittered(&land.polygon, low, high, step_m, &mut random) {
                if random.chance(share) {
                    let group = species_group(seed, position);
                    let height_m = random.range(least_m, most_m);
                    wishes.push(Wish { kind, position, height_m, group, radius_m: None });
                }
            }
        }
    }
    wishes
}

/// One position in every square of a grid, those in the polygon.
fn jittered(polygon: &Polygon, low: DVec2, high: DVec2, step_m: f64, random: &mut Random) -> Vec<DVec2> {
    let count = ((high - low) / step_m).ceil().max(DVec2::ZERO);
    let mut positions = Vec::new();
    for y in 0..count.y as usize {
        for x in 0..count.x as usize {
            let p = low + (DVec2::new(x as f64, y as f64) + DVec2::new(random.unit(), random.unit())) * step_m;
            if polygon.contains(p) {
                positions.push(p);
            }
        }
    }
    positions
}

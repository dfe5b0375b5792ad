//! Vegetation as the map has it.

use trove_model::{Bounds, FurnitureKind, Kind, LandKind, LineKind, Seed};

use super::blue_noise::BlueNoise;
use super::hedges::hedge;
use super::wish::{Form, Wish, species_group};
use crate::surroundings::Surroundings;

/// How densely a piece of land is planted.
struct Planting {
    /// Least distance of neighbouring trees, metres.
    trees_m: f64,
    /// Share of the trees' places that carry one.
    tree_share: f64,
    /// Least distance of neighbouring bushes, metres.
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
        LandKind::Wood => planting(4.2, 0.9, 3.4, 0.4, [8.0, 15.0]),
        LandKind::Park => planting(9.2, 0.55, 7.5, 0.15, [6.0, 13.0]),
        LandKind::Garden => planting(7.5, 0.4, 2.9, 0.3, [4.0, 8.0]),
        LandKind::Grass => planting(11.0, 0.35, 6.7, 0.12, [5.0, 10.0]),
        LandKind::Scrub => planting(11.8, 0.3, 1.8, 0.6, [3.5, 6.0]),
        LandKind::Residential => planting(15.0, 0.3, 10.0, 0.2, [5.0, 9.0]),
        _ => None,
    }
}

/// Mapped trees and hedges first, then plants scattered over green land.
pub(super) fn wishes(around: &Surroundings, blue_noise: &BlueNoise, seed: Seed) -> Vec<Wish> {
    let Some(map) = around.place.map else { return Vec::new() };
    let mut wishes = Vec::new();
    for tree in
        map.furniture.iter().filter(|f| f.kind == FurnitureKind::Tree && around.place.bounds.contains(f.position))
    {
        let seed = seed.child("tree").nth(tree.id as u64);
        let drawn_m = seed.random().range(5.5, 10.0);
        wishes.push(Wish {
            kind: Kind::Tree,
            position: tree.position,
            height_m: tree.height_m.unwrap_or(drawn_m).clamp(2.0, 30.0),
            group: species_group(seed.child("kind"), tree.position),
            mapped: tree.plant(),
            radius_m: Some(1.0),
            form: Form::Free,
            paved: true,
        });
    }
    for line in map.lines.iter().filter(|l| l.kind == LineKind::Hedge) {
        let seed = seed.child("hedge").nth(line.id as u64);
        let height_m = line.height_m.unwrap_or(seed.random().range(0.9, 1.8)).clamp(0.4, 4.0);
        wishes.extend(hedge(&line.line, height_m, seed).filter(|w| around.place.bounds.contains(w.position)));
    }
    for land in &map.land {
        let Some(planting) = planting(land.kind) else { continue };
        let Some(bounds) = land.polygon.bounds().filter(|b| b.overlaps(&around.place.bounds)) else { continue };
        let seed = seed.child("land").nth(land.id as u64);
        let inside =
            Bounds { min: bounds.min.max(around.place.bounds.min), max: bounds.max.min(around.place.bounds.max) };
        let mut random = seed.random();
        for (kind, least_m, share) in
            [(Kind::Tree, planting.trees_m, planting.tree_share), (Kind::Bush, planting.bushes_m, planting.bush_share)]
        {
            let [low_m, high_m] = if kind == Kind::Tree { planting.heights_m } else { [0.6, 1.6] };
            for position in blue_noise.over(inside, least_m, seed.child("places")) {
                let [keep, size] = std::array::from_fn(|_| random.unit());
                if keep < share && land.polygon.contains(position) {
                    let group = species_group(seed, position);
                    let height_m = low_m + (high_m - low_m) * size;
                    wishes.push(Wish::new(kind, position, height_m, group));
                }
            }
        }
    }
    wishes
}

//! Fallen leaves, under trees and in the gutters beside them.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{Bounds, CoverKind, GroundCover, Kind, LeafType, Random};

use super::sower::{Lay, Sower, class_of};
use crate::pieces::Piece;
use crate::pieces::Scenery;
use crate::roads::Footing;

/// Leaves are seen this far from the driven path, metres.
const LEAVES_M: f64 = 24.0;
/// Patches lie at least this far apart, metres.
const LEAST_M: f64 = 0.52;
/// Half the side of what must be level under a patch, metres.
const HALF_M: f64 = 0.24;
/// On a lawn leaves lie on the blades, metres.
const ON_GRASS_M: f64 = 0.02;
/// Leaves fall beyond the crown, as a share of its radius.
const BEYOND: f64 = 1.25;
/// Gutters collect the leaves of trees this near, metres, and fill up more than the ground under them.
const GUTTER_M: f64 = 9.0;
const GUTTER: f64 = 1.8;
/// Share of what would lie there that wheels and sweepers leave on the carriageway and brooms on sidewalks.
const ROAD: f64 = 0.06;
const SIDEWALK: f64 = 0.45;

/// Scatters leaves around every broadleaved tree near the driven path.
pub(super) fn leaves(sower: &Sower, plants: &[Scenery]) -> Vec<Piece> {
    let [cover, age] = sower.conditions.litter();
    let is_broadleaved = |s: &Scenery| s.asset.plant.as_ref().is_none_or(|p| p.leaves == LeafType::Broad);
    let trees: Vec<(DVec2, f64)> = plants
        .iter()
        .filter(|s| s.asset.kind == Kind::Tree && is_broadleaved(s))
        .map(|s| (s.foot_world.truncate(), (s.asset.size_m * s.scale).truncate().max_element() / 2.0))
        .filter(|(foot, radius_m)| sower.path_distance_m(*foot) < LEAVES_M + radius_m)
        .collect();

    // Where crowns overlap there lies what falls from the nearer one: all trees choose among the same points.
    let mut shares: BTreeMap<[i64; 2], (DVec2, f64)> = BTreeMap::new();
    for (foot, radius_m) in &trees {
        let reach_m = radius_m * BEYOND;
        for p in sower.blue_noise.over(Bounds::square(*foot, 2.0 * reach_m), LEAST_M, sower.seed.child("leaves")) {
            let share = 1.0 - (p.distance(*foot) / reach_m).powi(2);
            let known = shares.entry((p * 100.0).round().as_i64vec2().to_array()).or_insert((p, 0.0));
            known.1 = known.1.max(share);
        }
    }
    let swept = |p: DVec2| match sower.footing(p) {
        Footing::Carriageway => ROAD,
        Footing::Sidewalk => SIDEWALK,
        Footing::Land => 1.0,
        Footing::Water => 0.0,
    };
    let under = shares.into_values().map(|(p, share)| (p, cover * share * swept(p)));
    let gutters = sower.around.kerbs.runs.iter().flatten().map(|kerb| {
        let shaded = trees.iter().any(|(foot, _)| foot.distance(kerb.position) < GUTTER_M);
        let share = if shaded { cover * GUTTER } else { cover * 0.25 };
        (kerb.position - kerb.outward * (HALF_M + 0.13), share)
    });

    let sorts = sower.covers(CoverKind::Leaves);
    let mut random = sower.seed.child("fallen").random();
    let near = |(p, _): &(DVec2, f64)| sower.path_distance_m(*p) < LEAVES_M;
    under
        .chain(gutters)
        .filter(near)
        .filter_map(|(p, share)| scatter(sower, &sorts, p, share, age, &mut random))
        .collect()
}

/// A patch, with a probability, where the ground is level and free.
fn scatter(
    sower: &Sower,
    sorts: &[&GroundCover],
    middle: DVec2,
    share: f64,
    age: f64,
    random: &mut Random,
) -> Option<Piece> {
    let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let footing = sower.footing(middle);
    let is_level = || corners.iter().all(|&(x, y)| sower.footing(middle + DVec2::new(x, y) * HALF_M) == footing);
    let [keep, turn, old] = std::array::from_fn(|_| random.unit());
    let cover = random.pick(sorts)?;
    if keep >= share || sower.clearance.building_distance_m(middle) < HALF_M || !is_level() {
        return None;
    }
    let lay = Lay {
        middle,
        yaw_rad: std::f64::consts::TAU * turn,
        scale: [1.0, 1.0],
        class: class_of(footing),
        shade: age + 0.7 * (old - 0.5),
        lift_m: if sower.is_lawn(middle) { ON_GRASS_M } else { 0.0 },
    };
    Some(sower.piece(cover, &lay, random))
}

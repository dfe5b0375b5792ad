//! What people plant along their walls, and beds in gardens.

use glam::DVec2;
use trove_model::{Kind, LandKind, Seed};

use super::blue_noise::BlueNoise;
use super::hedges::{bed, hedge};
use super::wish::Wish;
use crate::surroundings::Surroundings;

/// Shares of the walls with a flower bed, a hedge and single shrubs in front.
const BED_SHARE: f64 = 0.14;
const HEDGE_SHARE: f64 = 0.1;
const SHRUB_SHARE: f64 = 0.22;
/// Shorter walls are left alone, metres.
const LEAST_WALL_M: f64 = 3.5;
/// Rows stand this far from the wall, and end before its corners by as much, metres.
const OFF_WALL_M: f64 = 1.2;
/// Shrubs stand this far from each other, metres.
const SHRUB_SPACING_M: [f64; 2] = [1.3, 2.4];
/// Beds in gardens lie at least this far apart and are so long, metres.
const GARDEN_BED_M: f64 = 9.0;
const GARDEN_BED_LENGTH_M: [f64; 2] = [2.0, 7.0];

/// Rows along walls, where there is a lawn before them, and beds in gardens.
pub(super) fn wishes(around: &Surroundings, blue_noise: &BlueNoise, seed: Seed) -> Vec<Wish> {
    let Some(map) = around.place.map else { return Vec::new() };
    let mut wishes = Vec::new();
    for building in &map.buildings {
        let seed = seed.child("building").nth(building.id as u64);
        for (i, (a, b)) in building.footprint.edges().enumerate() {
            if a.distance(b) >= LEAST_WALL_M && around.place.bounds.contains(a) && around.place.bounds.contains(b) {
                along_wall([a, b], seed.nth(i as u64), &mut wishes);
            }
        }
    }
    for land in map.land.iter().filter(|l| matches!(l.kind, LandKind::Garden | LandKind::Park)) {
        let Some(bounds) = land.polygon.bounds().filter(|b| b.overlaps(&around.place.bounds)) else { continue };
        let seed = seed.child("garden").nth(land.id as u64);
        for (i, middle) in blue_noise.over(bounds, GARDEN_BED_M, seed).enumerate() {
            let seed = seed.nth(i as u64);
            let mut random = seed.random();
            let share = if land.kind == LandKind::Garden { 0.5 } else { 0.12 };
            let half = DVec2::from_angle(random.range(0.0, std::f64::consts::PI))
                * random.range(GARDEN_BED_LENGTH_M[0], GARDEN_BED_LENGTH_M[1])
                / 2.0;
            let line = [middle - half, middle + half];
            if random.chance(share) && line.iter().all(|p| land.polygon.contains(*p)) {
                wishes.extend(bed(&line, random.range(0.35, 0.55), seed));
            }
        }
    }
    wishes
}

/// One of the rows, or nothing, before a wall whose building lies to the left of it.
fn along_wall([a, b]: [DVec2; 2], seed: Seed, wishes: &mut Vec<Wish>) {
    let mut random = seed.random();
    let along = (b - a).normalize_or_zero();
    let off = -along.perp() * OFF_WALL_M;
    let line = [a + along * OFF_WALL_M + off, b - along * OFF_WALL_M + off];
    let [what, height] = std::array::from_fn(|_| random.unit());
    if what < BED_SHARE {
        wishes.extend(bed(&line, 0.35 + 0.25 * height, seed));
    } else if what < BED_SHARE + HEDGE_SHARE {
        wishes.extend(hedge(&line, 0.6 + 0.7 * height, seed));
    } else if what < BED_SHARE + HEDGE_SHARE + SHRUB_SHARE {
        let (length_m, mut at_m) = (line[0].distance(line[1]), random.range(0.0, 1.0));
        while at_m < length_m {
            let height_m = (0.6 + 0.8 * height) * random.range(0.8, 1.2);
            // Wide shrubs stand farther out.
            let position = line[0] + along * at_m + off * 0.35 * height_m;
            wishes.push(Wish { radius_m: Some(0.5), ..Wish::new(Kind::Bush, position, height_m, seed.0) });
            at_m += random.range(SHRUB_SPACING_M[0], SHRUB_SPACING_M[1]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_before_the_wall_and_not_behind_it() {
        let mut wishes = Vec::new();
        // The building lies north of a wall that runs east.
        (0..60).for_each(|i| along_wall([DVec2::ZERO, DVec2::new(9.0, 0.0)], Seed(i), &mut wishes));
        assert!(wishes.len() > 60);
        assert!(wishes.iter().all(|w| w.position.y < -0.5 && (0.0..=9.0).contains(&w.position.x)));
    }
}

//! Tables before shops, where the sidewalk leaves room to pass.

use glam::DVec2;
use trove_model::{Kind, Report, Seed};

use super::yard::{Source, Wish, Yard};
use crate::geometry::segments::SegmentIndex;

/// Share of the mapped shops that put tables out, and whose tables have parasols.
const SHARE: f64 = 0.35;
const PARASOL_SHARE: f64 = 0.4;
/// Tables stand this far from the wall and from each other, metres.
const OFF_WALL_M: f64 = 1.15;
const STEP_M: f64 = 2.4;
/// At most so many.
const TABLES: usize = 4;
/// From the wall to the carriageway at least this much is left, metres.
const SIDEWALK_M: f64 = 3.4;
/// Further from the driven path than this no one sees them, metres.
const SEEN_M: f64 = 100.0;

/// Tables along the wall of a shop that looks at a sidewalk.
pub(super) fn place(yard: &mut Yard<'_, '_, '_>, seed: Seed, report: &Report) {
    let around = yard.around;
    let path: Vec<DVec2> =
        around.place.drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let path = SegmentIndex::new([path.as_slice()]);
    let shops = around.place.map.iter().flat_map(|m| &m.buildings).filter(|b| b.shop);
    for shop in shops {
        let mut random = seed.nth(shop.id as u64).random();
        let (wanted, parasols) = (random.chance(SHARE), random.chance(PARASOL_SHARE));
        let footprint = shop.footprint.clone().oriented();
        if !wanted || path.nearest(footprint.centroid(), SEEN_M).is_none() {
            continue;
        }
        let tags: &[&str] = if parasols { &["cafe", "parasol"] } else { &["cafe", "table"] };
        let looks_at_sidewalk = |&(a, b): &(DVec2, DVec2)| {
            let outward = -(b - a).normalize_or_zero().perp();
            let road_m = yard.clearance.road_distance_m((a + b) / 2.0 + outward * 0.5);
            a.distance(b) > 2.0 * STEP_M && (SIDEWALK_M..12.0).contains(&road_m)
        };
        let Some((a, b)) = footprint.edges().find(looks_at_sidewalk) else { continue };
        let along = (b - a).normalize_or_zero();
        let outward = -along.perp();
        let first_m = random.range(1.2, STEP_M);
        for i in 0..TABLES {
            let at_m = first_m + STEP_M * i as f64;
            if at_m < a.distance(b) - 1.2 {
                let position = a + along * at_m + outward * OFF_WALL_M;
                let yaw_rad = outward.to_angle() + random.range(-0.4, 0.4);
                // A shop's own tables may stand before its own wall.
                let wish = Wish { kind: Kind::StreetFurniture, tags, position, yaw_rad, source: Source::Mapped };
                if !yard.in_sight(position, 1.0) {
                    yard.place(&wish, report);
                }
            }
        }
    }
}

//! Scaffolding before houses that are being painted or repaired.

use trove_model::{BuildingKind, Kind, Outcome, Report, Seed};

use super::fronts::fronts;
use super::yard::{Source, Wish, Yard};

/// Share of the houses at a street that stand in scaffolding, and of those that are being built.
const SHARE: f64 = 0.03;
const BUILT_SHARE: f64 = 0.7;
/// From the wall to the carriageway at least this much is left, metres.
const SIDEWALK_M: f64 = 2.6;
/// Its middle stands so far before the wall, metres.
const OFF_WALL_M: f64 = 0.8;
/// How long and high its pieces are, metres, and how many lifts the models have.
const PIECE_M: f64 = 4.7;
const LIFT_M: f64 = 2.0;
const LIFTS: [usize; 2] = [2, 6];
/// A storey, where the map counts them, metres.
const STOREY_M: f64 = 3.0;
/// Cameras stay as far from it as from what is so wide to each side, metres.
const WIDE_M: f64 = 2.4;

/// Puts scaffolding before some houses from end to end.
pub(super) fn place(yard: &mut Yard<'_, '_, '_>, seed: Seed, report: &Report) {
    if !yard.has(Kind::StreetFurniture, &["scaffolding"]) {
        return;
    }
    for front in fronts(yard, SIDEWALK_M) {
        let building = front.building;
        let mut random = seed.nth(building.id as u64).random();
        let share = if building.kind == Some(BuildingKind::Construction) { BUILT_SHARE } else { SHARE };
        if !random.chance(share) {
            continue;
        }
        let roof_m = building.roof_height_m.unwrap_or(0.0);
        let eaves_m = building.levels.map(|n| n * STOREY_M).or(building.height_m.map(|top_m| top_m - roof_m));
        let lifts = ((eaves_m.unwrap_or(0.0) / LIFT_M) as usize).clamp(LIFTS[0], LIFTS[1]);
        let (high, cover) = (format!("lifts-{lifts}"), if random.chance(0.5) { "netted" } else { "bare" });
        let tags = ["scaffolding", high.as_str(), cover];
        let pieces = (front.length_m / PIECE_M) as usize;
        let first_m = (front.length_m - pieces as f64 * PIECE_M + PIECE_M) / 2.0;
        let mut placed = 0;
        for along_m in (0..pieces).map(|i| first_m + PIECE_M * i as f64) {
            let position = front.at(along_m, OFF_WALL_M);
            let yaw_rad = front.outward().to_angle();
            let wish = Wish { kind: Kind::StreetFurniture, tags: &tags, position, yaw_rad, source: Source::Mapped };
            placed += usize::from(!yard.in_sight(position, WIDE_M) && yard.place(&wish, report));
        }
        if placed > 0 {
            report.note(Outcome::Guessed, "scaffolding before a house", format_args!("osm {}", building.id));
        }
    }
}

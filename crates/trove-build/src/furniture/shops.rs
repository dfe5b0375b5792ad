//! What shops put out where the sidewalk leaves room to pass: tables, goods, and a board that folds.

use trove_model::{Kind, Report, Seed};

use super::fronts::fronts;
use super::yard::{Source, Wish, Yard};

/// Of the mapped shops these shares put out tables and goods, and half of the latter under a roof of cloth; others nothing.
const TABLES_SHARE: f64 = 0.35;
const GOODS_SHARE: f64 = 0.2;
const PARASOL_SHARE: f64 = 0.4;
/// Of all of them this share has a board.
const BOARD_SHARE: f64 = 0.4;
/// Tables stand this far from the wall and from each other, goods and boards from the wall, metres.
const OFF_WALL_M: f64 = 1.15;
const STEP_M: f64 = 2.4;
/// So far from the end of the wall a board stands, metres.
const BOARD_M: f64 = 0.7;
/// At most so many tables.
const TABLES: usize = 4;
/// From the wall to the carriageway at least this much is left, metres.
const SIDEWALK_M: f64 = 3.4;

/// Furnishes the walls of shops that look at a sidewalk.
pub(super) fn place(yard: &mut Yard<'_, '_, '_>, seed: Seed, report: &Report) {
    for front in fronts(yard, SIDEWALK_M).into_iter().filter(|front| front.building.shop) {
        let mut random = seed.nth(front.building.id as u64).random();
        let (draw, roofed) = (random.unit(), random.chance(PARASOL_SHARE));
        let yaw_rad = front.outward().to_angle();
        // A shop's own things may stand before its own wall.
        let mut put = |tags: &[&str], along_m: f64, yaw_rad: f64| {
            let position = front.at(along_m, OFF_WALL_M);
            let wish = Wish { kind: Kind::StreetFurniture, tags, position, yaw_rad, source: Source::Mapped };
            if !yard.in_sight(position, 1.0) {
                yard.place(&wish, report);
            }
        };
        if draw < TABLES_SHARE {
            let tags: &[&str] = if roofed { &["cafe", "parasol"] } else { &["cafe", "table"] };
            let first_m = random.range(1.2, STEP_M);
            let fitting = (0..TABLES).map(|i| first_m + STEP_M * i as f64);
            for along_m in fitting.take_while(|along_m| *along_m < front.length_m - 1.2) {
                put(tags, along_m, yaw_rad + random.range(-0.4, 0.4));
            }
        } else if draw < TABLES_SHARE + GOODS_SHARE {
            put(&["goods", if roofed { "stall" } else { "open" }], front.length_m * random.range(0.3, 0.6), yaw_rad);
        }
        if random.chance(BOARD_SHARE) {
            put(&["advertising", "board"], front.length_m - BOARD_M, yaw_rad + std::f64::consts::FRAC_PI_2);
        }
    }
}

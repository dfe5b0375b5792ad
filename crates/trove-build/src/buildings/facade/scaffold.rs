//! A scaffold with nets before a building that goes up.

use glam::{DVec2, DVec3};
use trove_model::Random;

use super::ink::Ink;
use crate::buildings::shell::Slot;

const BAY_M: f64 = 2.5;
const LIFT_M: f64 = 2.0;
/// Its inner and outer rows of posts, metres before the wall.
const ROWS_M: [f64; 2] = [0.35, 1.15];

/// Posts, ledgers, planks, braces, and nets on most bays.
pub(super) fn scaffold(ink: &mut Ink<'_>, [foot, top]: [f64; 2], random: &mut Random) {
    let length_m = ink.frame.length_m;
    let bays = (length_m / BAY_M).round().max(1.0) as usize;
    let lifts = ((top - foot) / LIFT_M).round().max(1.0) as usize;
    let x = |i: usize| length_m * i as f64 / bays as f64;
    let y = |k: usize| foot + LIFT_M * k as f64;
    for i in 0..=bays {
        for z in ROWS_M {
            ink.bar(Slot::Zinc, DVec3::new(x(i), foot - 0.6, z), DVec3::new(x(i), y(lifts) + 1.0, z), 0.05);
        }
    }
    for k in 1..=lifts {
        ink.solid(Slot::Plank, DVec3::new(0.0, y(k) - 0.05, 0.4), DVec3::new(length_m, y(k), 1.1));
        for up in [0.5, 1.0] {
            let at = |x: f64| DVec3::new(x, y(k) + up, ROWS_M[1] + 0.05);
            ink.bar(Slot::Zinc, at(0.0), at(length_m), 0.045);
        }
    }
    for i in 0..bays {
        for k in 0..lifts {
            if (i + k).is_multiple_of(4) {
                let z = ROWS_M[1] + 0.1;
                ink.bar(Slot::Zinc, DVec3::new(x(i), y(k), z), DVec3::new(x(i + 1), y(k + 1), z), 0.045);
            }
        }
        if random.chance(0.75) {
            let (low, high) = (DVec2::new(x(i) + 0.01, y(0) + 1.8), DVec2::new(x(i + 1) - 0.01, y(lifts) + 1.0));
            ink.pane(Slot::Net, low, high, ROWS_M[1] + 0.14, true);
        }
    }
}

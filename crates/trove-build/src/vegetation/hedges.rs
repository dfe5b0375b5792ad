//! Hedges and flower beds: pieces side by side along a line.

use glam::DVec2;
use trove_model::{Kind, MappedPlant, PlantForm, Seed};

use super::wish::{Form, Wish};

/// Length of a piece, about, and the widths of hedges and of beds, metres.
const PIECE_M: f64 = 2.0;
const WIDTH_M: f64 = 0.7;
const BED_WIDTH_M: f64 = 0.9;
/// Pieces reach into each other by this, metres.
const OVERLAP_M: f64 = 0.12;

/// The pieces of a hedge along a line.
pub(super) fn hedge(line: &[DVec2], height_m: f64, seed: Seed) -> impl Iterator<Item = Wish> + '_ {
    pieces(PlantForm::Hedge, line, [WIDTH_M * (0.8 + 0.3 * height_m).min(1.6), height_m], seed)
}

/// The pieces of a flower bed along a line.
pub(super) fn bed(line: &[DVec2], height_m: f64, seed: Seed) -> impl Iterator<Item = Wish> + '_ {
    pieces(PlantForm::Bed, line, [BED_WIDTH_M, height_m], seed)
}

fn pieces(
    planted: PlantForm,
    line: &[DVec2],
    [width_m, height_m]: [f64; 2],
    seed: Seed,
) -> impl Iterator<Item = Wish> + '_ {
    line.windows(2).enumerate().flat_map(move |(i, pair)| {
        let (from, along) = (pair[0], pair[1] - pair[0]);
        let count = (along.length() / PIECE_M).round().max(1.0);
        (0..count as usize).map(move |k| {
            let vary = 1.0 + seed.nth(i as u64).nth(k as u64).random().range(-0.03, 0.03);
            Wish {
                kind: Kind::Bush,
                position: from + along * ((k as f64 + 0.5) / count),
                height_m: height_m * vary,
                group: seed.0,
                mapped: MappedPlant::default(),
                // Its neighbours touch it.
                radius_m: Some(0.0),
                form: Form::Row {
                    planted,
                    yaw_rad: along.y.atan2(along.x),
                    length_m: along.length() / count + OVERLAP_M,
                    width_m,
                },
                paved: false,
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_join_and_cover_the_line_from_end_to_end() {
        let line = [DVec2::ZERO, DVec2::new(7.0, 0.0), DVec2::new(7.0, 1.2)];
        let pieces: Vec<Wish> = hedge(&line, 1.2, Seed(1)).collect();
        assert_eq!(pieces.len(), 5);
        let ends: Vec<[f64; 2]> = pieces
            .iter()
            .filter(|w| w.position.y == 0.0)
            .map(|w| {
                let Form::Row { length_m, .. } = w.form else { unreachable!() };
                [w.position.x - length_m / 2.0, w.position.x + length_m / 2.0]
            })
            .collect();
        assert!(ends[0][0] <= 0.0 && ends[3][1] >= 7.0);
        assert!(ends.windows(2).all(|pair| pair[1][0] < pair[0][1]));
    }
}

//! The open squares that street trees stand in where the ground is paved.

use glam::DVec2;
use trove_model::{Class, CoverKind, Kind};

use super::sower::{Lay, Sower};
use crate::pieces::Piece;
use crate::pieces::Scenery;
use crate::roads::Footing;

/// A tree's kerb is looked for within this, metres.
const KERB_M: f64 = 5.0;
/// A pit is made smaller to this where the sidewalk is narrow.
const LEAST: f64 = 0.6;

/// A pit for every tree in paving, along its kerb.
pub(super) fn pits(sower: &Sower, plants: &[Scenery]) -> Vec<Piece> {
    let sorts = sower.covers(CoverKind::TreePit);
    let mut random = sower.seed.child("pits").random();
    let mut pieces = Vec::new();
    for tree in plants.iter().filter(|s| s.asset.kind == Kind::Tree) {
        let middle = tree.foot_world.truncate();
        // A street's pits are alike.
        let street = (middle / 150.0).floor().as_i64vec2();
        let alike = sower.seed.child("pit").nth(street.x as u64).nth(street.y as u64);
        let Some(&cover) = alike.random().pick(&sorts) else { return pieces };
        let is_paved = |p: DVec2| match sower.footing(p) {
            Footing::Sidewalk => true,
            Footing::Land => !sower.is_lawn(p),
            Footing::Carriageway | Footing::Water => false,
        };
        if !sower.bounds.contains(middle) || !is_paved(middle) {
            continue;
        }
        let along = sower.around.kerbs.near(middle, KERB_M).first().map_or(DVec2::X, |kerb| kerb.outward);
        let fits = |scale: f64| {
            let half = along.rotate(DVec2::splat(cover.side_m / 2.0 * scale + 0.02));
            [half, half.perp(), -half, -half.perp()].iter().all(|c| is_paved(middle + *c))
        };
        let Some(scale) = [1.0, 0.8, LEAST].into_iter().find(|s| fits(*s)) else { continue };
        let lay = Lay {
            middle,
            yaw_rad: along.y.atan2(along.x),
            scale: [scale, 1.0],
            class: Class::Ground,
            shade: 0.0,
            lift_m: 0.0,
        };
        pieces.push(sower.piece(cover, &lay, &mut random));
    }
    pieces
}

//! Weeds where no mower comes: along the edges of lawns, at fences and walls.

use glam::DVec2;
use trove_model::{Class, CoverKind, LineKind, Random};

use super::sower::{Lay, Sower};
use crate::ground::noise;
use crate::pieces::Piece;
use crate::roads::Footing;

/// Weeds are sought this far from the driven path, metres.
const WEEDS_M: f64 = 24.0;
/// One place for a tuft after another, metres.
const STEP_M: f64 = 0.32;
/// Tufts stand this far inside a lawn's edge, metres.
const INSIDE_M: f64 = 0.09;
/// Swarms of weeds and stretches that someone has weeded, metres.
const SWARM_M: f64 = 5.0;

/// Tufts along everything that weeds grow at.
pub(super) fn weeds(sower: &Sower) -> Vec<Piece> {
    let mut random = sower.seed.child("weeds").random();
    let mut pieces = Vec::new();
    for (a, b) in sower.around.stand.surfaces.lawns.iter().flat_map(|polygon| polygon.edges()) {
        // Lawns lie to the left of their edges; where another lawn lies beyond, there is no edge.
        let inward = (b - a).perp().normalize_or_zero();
        let place = |p: DVec2| (!sower.is_lawn(p - inward * 0.25)).then_some(p + inward * INSIDE_M);
        along(sower, [a, b], 0.55, place, &mut random, &mut pieces);
    }
    let lines = sower.around.place.map.iter().flat_map(|m| &m.lines);
    for line in lines.filter(|l| matches!(l.kind, LineKind::Fence | LineKind::Wall)) {
        for pair in line.line.windows(2) {
            let side = (pair[1] - pair[0]).perp().normalize_or_zero() * 0.12;
            for side in [side, -side] {
                let place = |p: DVec2| (sower.footing(p + side) == Footing::Land).then_some(p + side);
                along(sower, [pair[0], pair[1]], 0.6, place, &mut random, &mut pieces);
            }
        }
    }
    pieces
}

/// Tufts along a line, in swarms; `place` says where a position's stands.
fn along(
    sower: &Sower,
    [a, b]: [DVec2; 2],
    share: f64,
    place: impl Fn(DVec2) -> Option<DVec2>,
    random: &mut Random,
    pieces: &mut Vec<Piece>,
) {
    let sorts = sower.covers(CoverKind::Weeds);
    let steps = (a.distance(b) / STEP_M) as usize;
    for i in 0..steps {
        let p = a.lerp(b, (i as f64 + random.unit()) / steps as f64);
        if sower.path_distance_m(p) > WEEDS_M {
            continue;
        }
        let swarm = noise(sower.seed.child("weed swarm"), p, SWARM_M);
        let [keep, turn] = std::array::from_fn(|_| random.unit());
        let Some(middle) = place(p).filter(|_| keep < share * ((swarm - 0.35) / 0.3)) else { continue };
        let Some(&cover) = random.pick(&sorts) else { return };
        let size = random.range(0.45, 0.75) + 0.5 * swarm * random.unit();
        let lay = Lay {
            middle,
            yaw_rad: std::f64::consts::TAU * turn,
            scale: [size, size],
            class: Class::Ground,
            shade: sower.lawn.dryness(middle) + random.range(-0.15, 0.2),
            lift_m: 0.0,
        };
        pieces.push(sower.piece(cover, &lay, random));
    }
}

//! Flat roofs behind a parapet, and roofs of one slope.

use glam::DVec2;
use trove_model::{Polygon, Random};

use crate::buildings::shell::{Shell, Slot};
use crate::geometry::plane::grown;
use crate::geometry::rings;

/// Thickness of a parapet.
const PARAPET_THICK_M: f64 = 0.3;
/// A body this high has a parapet that keeps people from falling.
const WALKED_ON_M: f64 = 6.0;

/// A deck behind a parapet, which goes on above the storeys' walls: its areas and its level; none where there is no room
/// for a parapet and the deck lies on the walls.
pub(super) fn flat(
    shell: &mut Shell,
    footprint: &Polygon,
    bottom: f64,
    top: f64,
    random: &mut Random,
) -> Option<(Vec<Polygon>, f64)> {
    let parapet_m = if top - bottom > WALKED_ON_M { random.range(0.4, 1.0) } else { random.range(0.15, 0.3) };
    let deck = top - parapet_m;
    let inner = grown(std::slice::from_ref(footprint), -PARAPET_THICK_M);
    if inner.is_empty() || deck <= bottom {
        shell.cover(Slot::FlatRoof, std::slice::from_ref(footprint), |_| top, true);
        return None;
    }
    // The coping: the footprint less the deck, ring by ring so that walls and coping share their vertices.
    let reversed = inner.iter().flat_map(Polygon::rings).map(|r| r.iter().rev().copied().collect());
    let coping = rings::polygons(footprint.rings().cloned().chain(reversed).collect());
    shell.cover(Slot::Trim, &coping, |_| top, true);
    let reversed = inner.iter().flat_map(Polygon::edges).map(|(a, b)| (b, a));
    for (a, b) in footprint.edges().chain(reversed) {
        shell.slope(Slot::Gable, &[a.extend(deck), b.extend(deck), b.extend(top), a.extend(top)]);
    }
    shell.cover(Slot::FlatRoof, &inner, |_| deck, true);
    Some((inner, deck))
}

/// A plane that falls towards `falls`, or across the longest edge, with the walls' wedges below it.
pub(super) fn skillion(shell: &mut Shell, footprint: &Polygon, falls: Option<f64>, eaves: f64, top: f64) {
    let longest = footprint.edges().max_by(|a, b| (a.1 - a.0).length().total_cmp(&(b.1 - b.0).length()));
    let across = || longest.map_or(DVec2::X, |(a, b)| (b - a).normalize_or(DVec2::X).perp());
    let rises = falls.map_or_else(across, |heading| -DVec2::from_angle(heading));
    let along = footprint.exterior.iter().map(|p| p.dot(rises));
    let (from, to) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let level = |p: DVec2| eaves + (top - eaves) * ((p.dot(rises) - from) / (to - from).max(0.1)).clamp(0.0, 1.0);
    shell.cover(Slot::PitchedRoof, std::slice::from_ref(footprint), level, true);
    for (a, b) in footprint.edges() {
        // What does not rise is left out; its triangle may be all there is.
        let mut wedge = vec![a.extend(eaves), b.extend(eaves)];
        wedge.extend([b, a].into_iter().filter(|&p| level(p) > eaves).map(|p| p.extend(level(p))));
        shell.slope(Slot::Gable, &wedge);
    }
}

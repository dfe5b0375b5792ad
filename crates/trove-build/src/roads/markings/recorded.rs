//! Lanes of the dataset's map at junctions, which the map tells no road for: stop lines and arrows.

use glam::DVec2;
use trove_model::{Drive, Lane, MarkingCustoms, Polygon, Turns};

use super::approaches::{Control, shared_out};
use super::crossings::Crossing;
use super::symbols::{arrow, laid};
use crate::geometry::path::Path;
use crate::geometry::plane::{intersection, strip};

/// A lane that starts this near to another one's end, and not behind it, can follow it; datasets may leave out the
/// lanes within junctions.
const FOLLOWS_M: f64 = 38.0;
/// Straight on, no further aside than this.
const ASIDE_M: f64 = 6.0;
/// Lanes whose directions differ by less than this run straight on.
const STRAIGHT_RAD: f64 = 0.5;
/// Shorter lanes have no arrows.
const SHORTEST_M: f64 = 12.0;
/// A lane whose end lies this near beside another's is its neighbour.
const BESIDE_M: f64 = 6.0;
/// A crossing this far before the end of a lane is the junction's.
const CROSSING_REACH_M: f64 = 12.0;

/// Arrows stand in the last so many metres of a lane, this far from each other.
const ARROW_REACH_M: f64 = 60.0;
const ARROW_PERIOD_M: f64 = 22.0;

/// What is painted at the ends of recorded lanes; all white.
pub(super) fn at_junctions(
    drive: &Drive,
    control: &Control,
    crossings: &[Crossing],
    customs: &MarkingCustoms,
) -> Vec<Polygon> {
    let Some(map) = &drive.lane_map else { return Vec::new() };
    let lanes: Vec<(&Lane, Path<'_>)> =
        map.lanes.iter().filter(|l| l.centreline.len() > 1).map(|l| (l, Path::new(&l.centreline))).collect();
    let starts: Vec<(DVec2, DVec2)> = lanes.iter().map(|(_, p)| p.at(0.0)).collect();
    let ends: Vec<(DVec2, DVec2)> = lanes.iter().map(|(_, p)| p.at(p.length_m())).collect();
    let mut paint = Vec::new();
    for ((lane, path), &(end, along)) in lanes.iter().zip(&ends) {
        // Lanes beside it that end with it, from the left to the right.
        let beside = |other: &&(DVec2, DVec2)| {
            let from = other.0 - end;
            from.length() < 4.0 * BESIDE_M && from.dot(along).abs() < BESIDE_M && other.1.dot(along) > 0.9
        };
        let mut rank: Vec<f64> = ends.iter().filter(beside).map(|(p, _)| (*p - end).dot(along.perp())).collect();
        rank.sort_by(|a, b| b.total_cmp(a));
        let place = rank.iter().position(|&aside| aside == 0.0).unwrap_or(0);
        let turns = turns(end, along, &starts);
        if !(turns.left || turns.right) || path.length_m() < SHORTEST_M {
            continue;
        }
        let crossed = |i: &usize| {
            let p = path.at(path.length_m() - *i as f64 * 0.5).0;
            crossings.iter().any(|c| c.is_near(p) && c.area.iter().any(|a| a.contains(p)))
        };
        let steps = (CROSSING_REACH_M.min(path.length_m()) * 2.0) as usize;
        let stop_m = (0..steps).rfind(crossed).map_or(0.3, |i| i as f64 * 0.5 + customs.setback_m);
        // Datasets that map stop lines map all of them.
        if map.stop_lines.is_empty() && (control.is_signalised(end + along * 12.0) || control.stops(end)) {
            let (at, ahead) = path.at(path.length_m() - stop_m - customs.stop_line_m / 2.0);
            let half = ahead.perp() * 4.0;
            let bar = strip(&[at - half, at + half], customs.stop_line_m / 2.0);
            paint.extend(intersection(&bar, std::slice::from_ref(&lane.polygon)));
        }
        let Some(&turns) = shared_out(turns, rank.len()).get(place).filter(|_| rank.len() > 1) else { continue };
        let symbol = arrow(turns, customs.arrow_m);
        let mut before_m = stop_m + 3.0 + customs.arrow_m;
        while before_m < ARROW_REACH_M.min(path.length_m() - 2.0) {
            let (at, ahead) = path.at(path.length_m() - before_m);
            paint.extend(laid(&symbol, at, ahead));
            before_m += ARROW_PERIOD_M;
        }
    }
    paint
}

/// Where traffic can go on from a lane's end, by where other lanes start.
fn turns(end: DVec2, along: DVec2, starts: &[(DVec2, DVec2)]) -> Turns {
    let mut turns = Turns::default();
    for &(start, ahead) in starts {
        let from = start - end;
        let (forward_m, left_m) = (from.dot(along), from.dot(along.perp()));
        if from.length() > FOLLOWS_M || forward_m < -1.0 {
            continue;
        }
        match along.angle_to(ahead) {
            a if a.abs() < STRAIGHT_RAD => turns.through |= left_m.abs() < ASIDE_M,
            // Round the corner lies on that side.
            a if a > 0.0 && a < 2.4 => turns.left |= left_m > -1.0 && forward_m > 1.0,
            a if a < 0.0 && a > -2.4 => turns.right |= left_m < 1.0 && forward_m > 1.0,
            _ => {}
        }
    }
    turns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_lead_where_others_start() {
        let far = |x: f64, y: f64, angle: f64| (DVec2::new(x, y), DVec2::from_angle(angle));
        let found = |starts: &[(DVec2, DVec2)]| turns(DVec2::ZERO, DVec2::X, starts);
        assert!(found(&[far(8.0, 9.0, 1.5)]).left && found(&[far(8.0, -9.0, -1.5)]).right);
        let on = found(&[far(30.0, 2.0, 0.1), far(-20.0, 2.0, 1.5), far(10.0, 3.0, 3.1)]);
        assert_eq!(on, Turns { through: true, ..Turns::default() });
    }
}

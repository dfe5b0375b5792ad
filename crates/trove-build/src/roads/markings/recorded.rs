//! Lanes of the dataset's map at junctions, which the map tells no road for: stop lines and arrows.

use glam::DVec2;
use trove_model::{Drive, Lane, Polygon, Turns};

use super::approaches::Control;
use super::crossings::Crossing;
use super::symbols::{arrow, laid};
use crate::plane::{intersection, strip};
use crate::roads::customs::Customs;
use crate::roads::path::Path;

/// A lane that starts this near to another one's end follows it.
const FOLLOWS_M: f64 = 1.0;
/// Lanes that turn less than this over their length go straight on.
const STRAIGHT_RAD: f64 = 0.5;
/// Shorter lanes have no arrows.
const SHORTEST_M: f64 = 12.0;
/// A lane whose end lies this near beside another's is its neighbour.
const BESIDE_M: f64 = 6.0;
/// A crossing this far before the end of a lane is the junction's.
const CROSSING_REACH_M: f64 = 12.0;

/// What is painted at the ends of recorded lanes; all white.
pub(super) fn at_junctions(
    drive: &Drive,
    control: &Control<'_>,
    crossings: &[Crossing],
    customs: &Customs,
) -> Vec<Polygon> {
    let Some(map) = &drive.lane_map else { return Vec::new() };
    let lanes: Vec<(&Lane, Path<'_>)> =
        map.lanes.iter().filter(|l| l.centreline.len() > 1).map(|l| (l, Path::new(&l.centreline))).collect();
    let mut paint = Vec::new();
    for (lane, path) in &lanes {
        let (end, along) = path.at(path.length_m());
        let followers = lanes.iter().filter(|(_, p)| {
            let (start, ahead) = p.at(0.0);
            start.distance(end) < FOLLOWS_M && ahead.dot(along) > 0.7
        });
        let turns: Vec<Turns> = followers.map(|(_, p)| turn(p)).collect();
        let decides = turns.len() > 1 || turns.iter().any(|t| !t.through);
        if !decides || path.length_m() < SHORTEST_M {
            continue;
        }
        let crossed = |i: &usize| {
            let p = path.at(path.length_m() - *i as f64 * 0.5).0;
            crossings.iter().any(|c| c.area.iter().any(|a| a.contains(p)))
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
        let beside =
            |other: &DVec2| (0.5..BESIDE_M).contains(&other.distance(end)) && (*other - end).dot(along).abs() < 4.0;
        let neighbours = lanes.iter().filter(|(_, p)| {
            let (other, ahead) = p.at(p.length_m());
            beside(&other) && ahead.dot(along) > 0.9
        });
        if neighbours.count() == 0 {
            continue;
        }
        let all = turns.iter().fold(Turns::default(), |a, b| Turns {
            left: a.left || b.left,
            through: a.through || b.through,
            right: a.right || b.right,
            reverse: a.reverse || b.reverse,
        });
        let symbol = arrow(all, customs.arrow_m);
        let mut before_m = stop_m + 3.0 + customs.arrow_m;
        while before_m < 45.0_f64.min(path.length_m() - 2.0) {
            let (at, ahead) = path.at(path.length_m() - before_m);
            paint.extend(laid(&symbol, at, ahead));
            before_m += 20.0;
        }
    }
    paint
}

/// How a lane leads through a junction.
fn turn(path: &Path<'_>) -> Turns {
    let (start, end) = (path.at(0.0).1, path.at(path.length_m()).1);
    let mut turns = Turns::default();
    match start.angle_to(end) {
        a if a.abs() > 2.6 => turns.reverse = true,
        a if a > STRAIGHT_RAD => turns.left = true,
        a if a < -STRAIGHT_RAD => turns.right = true,
        _ => turns.through = true,
    }
    turns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lane_turns_by_its_directions_at_both_ends() {
        let corner = |y: f64| [DVec2::ZERO, DVec2::new(5.0, 0.0), DVec2::new(8.0, y * 0.4), DVec2::new(8.5, y)];
        let (left, right) = (corner(8.0), corner(-8.0));
        assert!(turn(&Path::new(&left)).left && turn(&Path::new(&right)).right);
        assert!(turn(&Path::new(&[DVec2::ZERO, DVec2::X * 20.0])).through);
    }
}

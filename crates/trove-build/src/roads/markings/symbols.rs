//! Signs painted on the road: arrows, triangles, words, bicycles. They stand on the origin and point along y.

use glam::DVec2;
use trove_model::{Polygon, Turns};

use crate::geometry::plane::{strip, union};

/// Half of the width of an arrow's shaft.
const SHAFT_M: f64 = 0.09;
/// Letters on a road are drawn out, for they are seen from low above it.
const LETTER_M: [f64; 2] = [0.42, 1.8];
const LETTER_STROKE_M: f64 = 0.07;
const LETTER_GAP_M: f64 = 0.2;

/// A symbol laid on the road: `along` is the way of who reads it.
pub(super) fn laid(symbol: &[Polygon], at: DVec2, along: DVec2) -> Vec<Polygon> {
    let place = |p: &DVec2| at - along.perp() * p.x + along * p.y;
    let ring = |ring: &Vec<DVec2>| ring.iter().map(place).collect();
    let polygon = |p: &Polygon| Polygon { exterior: ring(&p.exterior), holes: p.holes.iter().map(ring).collect() };
    symbol.iter().map(|p| polygon(p).oriented()).collect()
}

fn polygon(points: &[[f64; 2]]) -> Polygon {
    Polygon::simple(points.iter().copied().map(DVec2::from_array).collect())
}

/// An arrow of some length for where a lane leads; nothing where it leads nowhere.
pub(super) fn arrow(turns: Turns, length_m: f64) -> Vec<Polygon> {
    let l = length_m;
    let mut parts = Vec::new();
    if turns.through {
        parts.push(polygon(&[[-SHAFT_M, 0.0], [SHAFT_M, 0.0], [SHAFT_M, 0.66 * l], [-SHAFT_M, 0.66 * l]]));
        parts.push(polygon(&[[-0.34, 0.62 * l], [0.34, 0.62 * l], [0.0, l]]));
    }
    for (turns_off, side) in [(turns.left, -1.0), (turns.right, 1.0)] {
        if !turns_off {
            continue;
        }
        // A branch leaves the shaft lower down where the shaft goes on.
        let y = if turns.through { 0.22 * l } else { 0.42 * l };
        let shaft = [[-SHAFT_M, 0.0], [SHAFT_M, 0.0], [SHAFT_M, y + 0.12 * l], [-SHAFT_M, y + 0.12 * l]];
        parts.push(polygon(&shaft));
        let (base, tip) = (y + 0.17 * l, 0.95);
        parts.push(polygon(&[[0.0, y], [side * 0.5, base], [side * 0.5, base + 0.1 * l], [0.0, y + 0.12 * l]]));
        let head = [[side * 0.42, base - 0.1 * l], [side * tip, base + 0.07 * l], [side * 0.42, base + 0.22 * l]];
        parts.push(polygon(&head));
    }
    if turns.reverse {
        let side = if turns.right && !turns.left { 1.0 } else { -1.0 };
        let arc = (0..=8).map(|i| f64::from(i) / 8.0 * std::f64::consts::PI);
        let bend = arc.map(|a| DVec2::new(side * 0.35 * (1.0 - a.cos()), 0.6 * l + 0.35 * a.sin()));
        let hook: Vec<DVec2> = [DVec2::ZERO].into_iter().chain(bend).chain([DVec2::new(side * 0.7, 0.5 * l)]).collect();
        parts.extend(strip(&hook, SHAFT_M));
        parts.push(polygon(&[[side * 0.42, 0.52 * l], [side * 0.98, 0.52 * l], [side * 0.7, 0.25 * l]]));
    }
    union(&parts)
}

/// A row of triangles that point at who gives way, from one offset across the lane to another.
pub(super) fn triangles(from_m: f64, to_m: f64) -> Vec<Polygon> {
    const BASE_M: f64 = 0.5;
    const PERIOD_M: f64 = 0.8;
    let count = ((to_m - from_m) / PERIOD_M).floor().max(0.0) as usize;
    let first_m = from_m + ((to_m - from_m) - count as f64 * PERIOD_M) / 2.0 + PERIOD_M / 2.0;
    let triangle = |i: usize| {
        let x = first_m + i as f64 * PERIOD_M;
        polygon(&[[x - BASE_M / 2.0, 0.7], [x, 0.0], [x + BASE_M / 2.0, 0.7]])
    };
    (0..count).map(triangle).collect()
}

/// A bicycle seen from its side, on its back wheel's left.
pub(super) fn bicycle() -> Vec<Polygon> {
    let wheel = |x: f64| -> Vec<DVec2> {
        let angle = |i: u32| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 14.0);
        (0..=14).map(|i| DVec2::new(x, 0.32) + angle(i) * DVec2::new(0.24, 0.32)).collect()
    };
    let frame: [&[[f64; 2]]; 4] = [
        &[[-0.36, 0.32], [-0.14, 0.8], [0.2, 0.8], [-0.04, 0.34], [-0.36, 0.32]],
        &[[-0.04, 0.34], [-0.17, 0.98]],
        &[[0.36, 0.32], [0.17, 1.02], [0.3, 1.06]],
        &[[-0.27, 0.98], [-0.08, 0.98]],
    ];
    let lines = frame.iter().map(|l| l.iter().copied().map(DVec2::from_array).collect::<Vec<_>>());
    let strokes = [wheel(-0.36), wheel(0.36)].into_iter().chain(lines);
    union(&strokes.flat_map(|line| strip(&line, 0.035)).collect::<Vec<_>>())
}

/// A word, its middle on the origin; letters that the table lacks are left out.
pub(super) fn word(text: &str) -> Vec<Polygon> {
    let step_m = LETTER_M[0] + LETTER_GAP_M;
    let width_m = text.chars().count() as f64 * step_m - LETTER_GAP_M;
    let letter = |(i, c): (usize, char)| {
        let low = DVec2::new(i as f64 * step_m - width_m / 2.0, 0.0);
        let strokes = strokes(c).iter();
        strokes
            .map(|stroke| {
                let point = |&(x, y): &(u8, u8)| {
                    low + DVec2::new(f64::from(x) / 2.0, f64::from(y) / 4.0) * DVec2::from_array(LETTER_M)
                };
                stroke.iter().map(point).collect::<Vec<_>>()
            })
            .flat_map(|line| strip(&line, LETTER_STROKE_M))
            .collect::<Vec<_>>()
    };
    union(&text.chars().enumerate().flat_map(letter).collect::<Vec<_>>())
}

/// The strokes of a letter on a grid from (0, 0) to (2, 4).
fn strokes(letter: char) -> &'static [&'static [(u8, u8)]] {
    match letter {
        '0' | 'O' => &[&[(0, 0), (2, 0), (2, 4), (0, 4), (0, 0)]],
        '1' => &[&[(0, 3), (1, 4), (1, 0)]],
        '2' => &[&[(0, 4), (2, 4), (2, 2), (0, 2), (0, 0), (2, 0)]],
        '3' => &[&[(0, 4), (2, 4), (2, 0), (0, 0)], &[(0, 2), (2, 2)]],
        '4' => &[&[(0, 4), (0, 2), (2, 2)], &[(2, 4), (2, 0)]],
        '5' | 'S' => &[&[(2, 4), (0, 4), (0, 2), (2, 2), (2, 0), (0, 0)]],
        '6' => &[&[(2, 4), (0, 4), (0, 0), (2, 0), (2, 2), (0, 2)]],
        '7' => &[&[(0, 4), (2, 4), (1, 0)]],
        '8' => &[&[(0, 2), (2, 2), (2, 0), (0, 0), (0, 4), (2, 4), (2, 2)]],
        '9' => &[&[(0, 0), (2, 0), (2, 4), (0, 4), (0, 2), (2, 2)]],
        'L' => &[&[(0, 4), (0, 0), (2, 0)]],
        'N' => &[&[(0, 0), (0, 4), (2, 0), (2, 4)]],
        'P' => &[&[(0, 0), (0, 4), (2, 4), (2, 2), (0, 2)]],
        'T' => &[&[(0, 4), (2, 4)], &[(1, 4), (1, 0)]],
        'W' => &[&[(0, 4), (0, 0), (1, 2), (2, 0), (2, 4)]],
        'Y' => &[&[(0, 4), (1, 2), (2, 4)], &[(1, 2), (1, 0)]],
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn middle_x(symbol: &[Polygon]) -> f64 {
        let area: f64 = symbol.iter().map(Polygon::area_m2).sum();
        symbol.iter().map(|p| p.centroid().x * p.area_m2()).sum::<f64>() / area
    }

    #[test]
    fn arrows_point_where_their_lane_leads() {
        let left = arrow(Turns { left: true, ..Turns::default() }, 4.0);
        let right = arrow(Turns { right: true, ..Turns::default() }, 4.0);
        let through = arrow(Turns { through: true, ..Turns::default() }, 4.0);
        assert!(middle_x(&left) < -0.1 && middle_x(&right) > 0.1 && middle_x(&through).abs() < 0.01);
        let all = arrow(Turns { left: true, through: true, right: true, reverse: true }, 4.0);
        assert_eq!(all.len(), 1, "one piece");
        assert!(arrow(Turns::default(), 4.0).is_empty());
        for arrow in [left, right, through, all] {
            let bounds = trove_model::Bounds::around(arrow.iter().flat_map(|p| p.exterior.iter().copied())).unwrap();
            assert!(bounds.min.y > -0.01 && bounds.max.y < 4.01 && bounds.max.x < 1.0 && bounds.min.x > -1.0);
        }
    }

    #[test]
    fn a_symbol_lies_in_front_of_who_reads_it() {
        let laid = laid(&arrow(Turns { right: true, ..Turns::default() }, 4.0), DVec2::new(10.0, 0.0), DVec2::Y);
        // Towards north, right is east.
        assert!(middle_x(&laid) > 10.1);
        assert!(laid.iter().flat_map(|p| &p.exterior).all(|p| p.y > -0.01));
    }

    #[test]
    fn words_are_as_wide_as_their_letters() {
        let stop = word("STOP");
        let bounds = trove_model::Bounds::around(stop.iter().flat_map(|p| p.exterior.iter().copied())).unwrap();
        assert_eq!(stop.len(), 4);
        assert!((bounds.size_m().x - (4.0 * 0.42 + 3.0 * 0.2 + 2.0 * LETTER_STROKE_M)).abs() < 0.05);
    }
}

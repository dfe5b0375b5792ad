//! The paper's test for a rectangular base.

use glam::DVec2;
use trove_model::Polygon;

/// Bins of the histogram of edge orientations over [0, π): 5° each.
const BINS: usize = 36;
/// Share of the edges' length that the best pair of orientations must explain.
const EXPLAINED: f64 = 0.9;

/// A footprint that runs along two directions at right angles, and the box around it in these directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Base {
    pub centre: DVec2,
    /// Direction of the longer side.
    pub axis: DVec2,
    /// Longer side, shorter side, metres.
    pub size_m: DVec2,
    /// Share of the box that the footprint covers.
    pub filled: f64,
}

/// The box of a footprint whose edges run along two directions at right angles; `None` for any other.
///
/// A histogram of edge orientations is weighted by edge length; of all pairs of bins about π/2 apart the one with
/// most length is taken; it must explain nearly all of it. An L passes: it is for `filled` to turn it away where the
/// whole box is wanted.
pub(super) fn base(footprint: &Polygon) -> Option<Base> {
    let mut histogram = [0.0; BINS];
    let mut total = 0.0;
    for (a, b) in footprint.edges() {
        let length_m = a.distance(b);
        histogram[bin(orientation(b - a))] += length_m;
        total += length_m;
    }
    // A direction may fall on the border of two bins: each takes in its neighbours.
    let wide = |i: usize| histogram[(i + BINS - 1) % BINS] + histogram[i] + histogram[(i + 1) % BINS];
    let best = (0..BINS / 2).max_by(|&i, &j| {
        let pair = |k: usize| wide(k) + wide(k + BINS / 2);
        pair(i).total_cmp(&pair(j)).then(histogram[i].total_cmp(&histogram[j]))
    })?;
    if total <= 0.0 || wide(best) + wide(best + BINS / 2) < EXPLAINED * total {
        return None;
    }
    let axis = DVec2::from_angle(mean_orientation(footprint, best));
    let extent = |d: DVec2| {
        let along = footprint.exterior.iter().map(|p| p.dot(d));
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let ((u0, u1), (v0, v1)) = (extent(axis), extent(axis.perp()));
    let (length, width) = (u1 - u0, v1 - v0);
    if length.min(width) <= 0.0 {
        return None;
    }
    let centre = axis * (u0 + u1) / 2.0 + axis.perp() * (v0 + v1) / 2.0;
    let filled = footprint.area_m2() / (length * width);
    let (axis, size_m) =
        if length >= width { (axis, DVec2::new(length, width)) } else { (axis.perp(), DVec2::new(width, length)) };
    Some(Base { centre, axis, size_m, filled })
}

fn orientation(direction: DVec2) -> f64 {
    direction.y.atan2(direction.x).rem_euclid(std::f64::consts::PI)
}

fn bin(orientation_rad: f64) -> usize {
    ((orientation_rad / std::f64::consts::PI * BINS as f64) as usize).min(BINS - 1)
}

/// The mean orientation of the edges that the pair of bins explains, those across turned by a right angle.
fn mean_orientation(footprint: &Polygon, best: usize) -> f64 {
    let middle = (best as f64 + 0.5) / BINS as f64 * std::f64::consts::PI;
    // Orientations repeat after a quarter turn here: angles are averaged four times as large.
    let sum: DVec2 = footprint
        .edges()
        .map(|(a, b)| (orientation(b - a), a.distance(b)))
        .filter(|(angle, _)| (4.0 * (angle - middle)).cos() > 0.5)
        .map(|(angle, length)| DVec2::from_angle(4.0 * angle) * length)
        .sum();
    sum.y.atan2(sum.x) / 4.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(points: &[(f64, f64)], angle: f64) -> Polygon {
        Polygon::simple(points.iter().map(|&(x, y)| DVec2::from_angle(angle).rotate(DVec2::new(x, y))).collect())
    }

    #[test]
    fn a_rectangle_is_found_at_any_angle() {
        for i in 0..90 {
            let angle = f64::from(i).to_radians() * 2.0;
            let found = base(&turned(&[(0., 0.), (20., 0.), (20., 8.), (0., 8.)], angle)).unwrap();
            assert!((found.size_m - DVec2::new(20.0, 8.0)).length() < 1e-6, "{found:?} at {angle}");
            assert!(found.axis.perp_dot(DVec2::from_angle(angle)).abs() < 1e-9);
            assert!((found.filled - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn an_l_runs_along_two_directions_and_does_not_fill_its_box() {
        let l = turned(&[(0., 0.), (20., 0.), (20., 8.), (8., 8.), (8., 20.), (0., 20.)], 0.4);
        let found = base(&l).unwrap();
        assert!(found.filled < 0.7, "{}", found.filled);
    }

    #[test]
    fn triangles_and_round_houses_are_no_rectangles() {
        assert_eq!(base(&turned(&[(0., 0.), (10., 0.), (5., 9.)], 0.0)), None);
        let circle: Vec<(f64, f64)> = (0..24).map(|i| (f64::from(i) * 15f64.to_radians()).sin_cos()).collect();
        assert_eq!(base(&turned(&circle, 0.1)), None);
        assert_eq!(base(&Polygon::default()), None);
    }
}

//! Boxes as the camera sees them.

use glam::{DMat3, DVec2, DVec3};
use trove_model::{Distortion, Lens, PixelBox};

/// What lies nearer than this is cut off before it is projected, metres.
const NEAR_M: f64 = 0.05;

/// Pairs of corners that the edges of a box join; corners are numbered as in [`trove_model::Cuboid::corners_world`].
const EDGES: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

/// Curved edges are followed so that neighbouring points are at most this far apart, pixels, …
const STEP_PX: f64 = 8.0;
/// … and halved at least and at most so often.
const MIN_HALVINGS: u32 = 3;
const MAX_HALVINGS: u32 = 12;
/// Points that stand for a lens's rim.
const RIM_POINTS: i32 = 64;

/// Pixel positions along the edges of the part of a box that the camera can see, whose hull is the box's outline; empty
/// where there is none.
///
/// A lens that sees less than a half-space cuts the box in front of the camera. What lies outside a lens's reach is
/// drawn in to its rim.
pub(super) fn project(lens: &Lens, corners_camera: &[DVec3; 8]) -> Vec<DVec2> {
    let is_straight = lens.distortion == Distortion::None;
    let sees_behind = lens.distortion.sees_behind();
    let mut points = Vec::new();
    for [i, j] in EDGES {
        let whole = [corners_camera[i], corners_camera[j]];
        let Some(ends) = (if sees_behind { Some(whole) } else { before_camera(whole) }) else { continue };
        let pixels = ends.map(|p| lens.project_onto_rim(p));
        points.extend(pixels);
        if !is_straight {
            follow(lens, ends, pixels, MAX_HALVINGS, &mut points);
        }
    }
    if sees_behind && is_crossed_behind(corners_camera) {
        // Its edges do not go around all that it covers, for it goes on behind the camera.
        let rim = |i: i32| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / f64::from(RIM_POINTS));
        points.extend((0..RIM_POINTS).map(|i| lens.project_onto_rim((rim(i) * 1e-9).extend(-1.0))));
    }
    points
}

/// The part of an edge in front of the camera.
fn before_camera([a, b]: [DVec3; 2]) -> Option<[DVec3; 2]> {
    let cut = |a: DVec3, b: DVec3| {
        if a.z >= NEAR_M { a } else { a.lerp(b, (NEAR_M - a.z) / (b.z - a.z)).with_z(NEAR_M) }
    };
    (a.z >= NEAR_M || b.z >= NEAR_M).then(|| [cut(a, b), cut(b, a)])
}

/// Adds points between the ends of an edge.
fn follow(lens: &Lens, [a, b]: [DVec3; 2], [pixel_a, pixel_b]: [DVec2; 2], halvings: u32, points: &mut Vec<DVec2>) {
    if halvings == 0 || (MAX_HALVINGS - halvings >= MIN_HALVINGS && pixel_a.distance(pixel_b) <= STEP_PX) {
        return;
    }
    let middle = a.midpoint(b);
    let pixel = lens.project_onto_rim(middle);
    follow(lens, [a, middle], [pixel_a, pixel], halvings - 1, points);
    points.push(pixel);
    follow(lens, [middle, b], [pixel, pixel_b], halvings - 1, points);
}

/// Whether the viewing axis meets a box behind the camera.
fn is_crossed_behind(corners_camera: &[DVec3; 8]) -> bool {
    let [corner, x, y, z] = [0, 1, 3, 4].map(|i| corners_camera[i]);
    let box_from_camera = DMat3::from_cols(x - corner, y - corner, z - corner).inverse();
    let (start, way) = (box_from_camera * -corner, box_from_camera * DVec3::NEG_Z);
    // In coordinates in which the box is the unit cube.
    let (to_low, to_high) = (-start / way, (1.0 - start) / way);
    let (enters, leaves) = (to_low.min(to_high).max_element().max(0.0), to_low.max(to_high).min_element());
    box_from_camera.is_finite() && enters <= leaves
}

/// The pixels whose centres lie in the smallest rectangle around some points; `None` outside the image.
pub(super) fn pixels_around(lens: &Lens, points: &[DVec2]) -> Option<PixelBox> {
    let low = points.iter().copied().reduce(DVec2::min)?;
    let high = points.iter().copied().reduce(DVec2::max)?;
    let size = DVec2::new(f64::from(lens.width_px), f64::from(lens.height_px));
    let min = (low - 0.5).ceil().max(DVec2::ZERO);
    let max = (high - 0.5).floor().min(size - 1.0);
    (min.cmple(max).all()).then(|| PixelBox { min: min.as_uvec2().to_array(), max: max.as_uvec2().to_array() })
}

/// Share of the convex hull of some points that lies outside the image; 0 for a hull without area.
pub(super) fn truncation(lens: &Lens, points: Vec<DVec2>) -> f64 {
    let hull = convex_hull(points);
    let whole = area(&hull);
    if whole <= 0.0 {
        return 0.0;
    }
    let size = DVec2::new(f64::from(lens.width_px), f64::from(lens.height_px));
    let inside = [0, 1].into_iter().fold(hull, |hull, axis| {
        let hull = clip(&hull, |p| p[axis]);
        clip(&hull, |p| size[axis] - p[axis])
    });
    (1.0 - area(&inside) / whole).clamp(0.0, 1.0)
}

/// The part of a convex polygon where `height`, a linear function, is not negative (Sutherland, Hodgman 1974).
fn clip(polygon: &[DVec2], height: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &b) in polygon.iter().enumerate() {
        let a = polygon[(i + polygon.len() - 1) % polygon.len()];
        let (height_a, height_b) = (height(a), height(b));
        if (height_a < 0.0) != (height_b < 0.0) {
            kept.push(a.lerp(b, height_a / (height_a - height_b)));
        }
        if height_b >= 0.0 {
            kept.push(b);
        }
    }
    kept
}

/// Counter-clockwise in axes x right, y up (Andrew's monotone chain, 1979).
fn convex_hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut hull: Vec<DVec2> = Vec::new();
    // Lower side from left to right, then upper side back.
    for side in [points.clone(), points.into_iter().rev().collect()] {
        let start = hull.len();
        for p in side {
            while hull.len() >= start + 2 {
                let (a, b) = (hull[hull.len() - 2], hull[hull.len() - 1]);
                if (b - a).perp_dot(p - a) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop();
    }
    hull
}

fn area(polygon: &[DVec2]) -> f64 {
    let twice = |i: usize| polygon[i].perp_dot(polygon[(i + 1) % polygon.len()]);
    (0..polygon.len()).map(twice).sum::<f64>().abs() * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENS: Lens = Lens {
        width_px: 100,
        height_px: 80,
        fx_px: 50.0,
        fy_px: 50.0,
        cx_px: 50.0,
        cy_px: 40.0,
        distortion: Distortion::None,
    };

    fn cube(centre: DVec3, side: f64) -> [DVec3; 8] {
        let signs =
            [[1, 1, -1], [-1, 1, -1], [-1, -1, -1], [1, -1, -1], [1, 1, 1], [-1, 1, 1], [-1, -1, 1], [1, -1, 1]];
        signs.map(|s| centre + DVec3::new(s[0] as f64, s[1] as f64, s[2] as f64) * side * 0.5)
    }

    #[test]
    fn a_box_half_over_the_border_is_half_truncated() {
        // Its nearest face is 20 px wide, and the image's left border runs through its middle.
        let points = project(&LENS, &cube(DVec3::new(-5.0, 0.0, 6.0), 2.0));
        let near: Vec<DVec2> = points.iter().copied().filter(|p| (p.y - 40.0).abs() > 9.9).collect();
        assert!((truncation(&LENS, near) - 0.5).abs() < 1e-9);
        assert_eq!(truncation(&LENS, project(&LENS, &cube(DVec3::Z * 6.0, 2.0))), 0.0);
        assert!(truncation(&LENS, points) > 0.3);
    }

    #[test]
    fn a_box_around_the_camera_fills_the_image_and_one_behind_it_is_not_seen() {
        let around = project(&LENS, &cube(DVec3::ZERO, 3.0));
        assert_eq!(pixels_around(&LENS, &around), Some(PixelBox { min: [0, 0], max: [99, 79] }));
        assert!(truncation(&LENS, around) > 0.9);
        assert!(project(&LENS, &cube(DVec3::Z * -6.0, 2.0)).is_empty());
        assert_eq!(pixels_around(&LENS, &[]), None);
    }

    #[test]
    fn a_fisheyes_outline_holds_all_of_a_box_wherever_it_is() {
        let fisheye = Distortion::kannala_brandt(&[-0.02, -0.002]).unwrap();
        let lens = Lens { width_px: 200, height_px: 200, cx_px: 100.0, cy_px: 100.0, distortion: fisheye, ..LENS };
        for i in 0..60u32 {
            let (angle, turn) = (f64::from(i) * 0.05, f64::from(i) * 2.4);
            let across = DVec2::from_angle(turn) * angle.sin();
            let corners = cube(across.extend(angle.cos()) * 3.0, 2.5);
            let points = project(&lens, &corners);
            let (low, high) = (points.iter().copied().reduce(DVec2::min), points.iter().copied().reduce(DVec2::max));
            let (low, high) = (low.unwrap() - 0.1, high.unwrap() + 0.1);
            for (j, k, l) in (0..8u32).flat_map(|j| (0..64u32).map(move |k| (j, k / 8, k % 8))) {
                let share = DVec3::new(f64::from(j), f64::from(k), f64::from(l)) / 7.0;
                let Some(p) = lens.project(corners[0] + (corners[6] - corners[0]) * share) else { continue };
                assert!(p.cmpge(low).all() && p.cmple(high).all(), "{i}: {p} outside {low} {high}");
            }
        }
    }

    #[test]
    fn a_hull_keeps_the_outer_points_only() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0], [1.0, 0.0], [2.0, 2.0]];
        let hull = convex_hull(square.map(DVec2::from_array).to_vec());
        assert_eq!((hull.len(), area(&hull)), (4, 4.0));
    }
}

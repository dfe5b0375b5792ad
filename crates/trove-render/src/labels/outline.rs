//! Boxes as the camera sees them.

use glam::{DVec2, DVec3};
use trove_model::{Lens, PixelBox};

/// What lies nearer than this is cut off before it is projected, metres.
const NEAR_M: f64 = 0.05;

/// Pairs of corners that the edges of a box join; corners are numbered as in [`trove_model::Cuboid::corners_world`].
const EDGES: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

/// Pixel positions of the corners of the part of a box that lies in front of the camera; empty where none does.
pub(super) fn project(lens: &Lens, corners_camera: &[DVec3; 8]) -> Vec<DVec2> {
    let kept = corners_camera.iter().copied().filter(|p| p.z >= NEAR_M);
    let cut = EDGES.iter().filter_map(|&[i, j]| {
        let (a, b) = (corners_camera[i], corners_camera[j]);
        ((a.z < NEAR_M) != (b.z < NEAR_M)).then(|| a.lerp(b, (NEAR_M - a.z) / (b.z - a.z)).with_z(NEAR_M))
    });
    kept.chain(cut).filter_map(|p| lens.project(p)).collect()
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

    const LENS: Lens = Lens { width_px: 100, height_px: 80, fx_px: 50.0, fy_px: 50.0, cx_px: 50.0, cy_px: 40.0 };

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
    fn a_hull_keeps_the_outer_points_only() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0], [1.0, 0.0], [2.0, 2.0]];
        let hull = convex_hull(square.map(DVec2::from_array).to_vec());
        assert_eq!((hull.len(), area(&hull)), (4, 4.0));
    }
}

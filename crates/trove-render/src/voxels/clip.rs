//! Convex polygons cut to slabs.

use glam::DVec3;

/// A triangle that is cut by the six faces of a cube has at most nine corners.
const MOST: usize = 10;

/// A convex polygon in a plane.
#[derive(Clone, Copy)]
pub(super) struct Polygon {
    corners: [DVec3; MOST],
    len: usize,
}

impl Polygon {
    pub(super) fn triangle(corners: [DVec3; 3]) -> Self {
        let mut all = [DVec3::ZERO; MOST];
        all[..3].copy_from_slice(&corners);
        Self { corners: all, len: 3 }
    }

    pub(super) fn corners(&self) -> &[DVec3] {
        &self.corners[..self.len]
    }

    /// Smallest and largest coordinates; nothing of an empty one lies between them.
    pub(super) fn bounds(&self) -> [DVec3; 2] {
        let empty = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        self.corners().iter().fold(empty, |[low, high], &p| [low.min(p), high.max(p)])
    }

    /// The part whose coordinate along an axis is from `low` to `high` (Sutherland and Hodgman 1974).
    pub(super) fn slab(&self, axis: usize, low: f64, high: f64) -> Self {
        self.half(axis, low, 1.0).half(axis, high, -1.0)
    }

    fn half(&self, axis: usize, limit: f64, sign: f64) -> Self {
        let mut cut = Self { corners: [DVec3::ZERO; MOST], len: 0 };
        let corners = self.corners();
        let mut add = |p: DVec3| {
            // Rounding may make one more corner, which adds nothing.
            if cut.len < MOST {
                cut.corners[cut.len] = p;
                cut.len += 1;
            }
        };
        for (i, &b) in corners.iter().enumerate() {
            let a = corners[if i == 0 { corners.len() - 1 } else { i - 1 }];
            let (inside_a, inside_b) = ((a[axis] - limit) * sign, (b[axis] - limit) * sign);
            if (inside_a < 0.0) != (inside_b < 0.0) {
                let mut p = a.lerp(b, inside_a / (inside_a - inside_b));
                p[axis] = limit;
                add(p);
            }
            if inside_b >= 0.0 {
                add(b);
            }
        }
        cut
    }

    /// Its area.
    pub(super) fn area(&self) -> f64 {
        self.fan().map(|[a, b, c]| (b - a).cross(c - a)).sum::<DVec3>().length() / 2.0
    }

    /// Triangles that it is made of.
    pub(super) fn fan(&self) -> impl Iterator<Item = [DVec3; 3]> {
        self.corners().get(1..).unwrap_or_default().windows(2).map(|pair| [self.corners[0], pair[0], pair[1]])
    }
}

/// Shares of a triangle's corners at a point of its plane.
pub(super) fn barycentric([a, b, c]: [DVec3; 3], p: DVec3) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let normal = ab.cross(ac);
    let whole = normal.length_squared();
    let v = ap.cross(ac).dot(normal) / whole;
    let w = ab.cross(ap).dot(normal) / whole;
    DVec3::new(1.0 - v - w, v, w)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cells_of_a_triangle_share_its_area() {
        let corners = [DVec3::new(0.3, 0.2, 0.1), DVec3::new(5.1, 1.7, 2.2), DVec3::new(1.4, 4.9, -1.6)];
        let triangle = Polygon::triangle(corners);
        let mut area = 0.0;
        for x in 0..6 {
            for y in 0..6 {
                for z in -3..4 {
                    let [x, y, z] = [x, y, z].map(f64::from);
                    let cell = triangle.slab(0, x, x + 1.0).slab(1, y, y + 1.0).slab(2, z, z + 1.0);
                    let [low, high] = cell.bounds();
                    assert!(cell.corners().is_empty() || (low - DVec3::new(x, y, z)).min_element() > -1e-12);
                    assert!(cell.corners().is_empty() || (DVec3::new(x, y, z) + 1.0 - high).min_element() > -1e-12);
                    area += cell.area();
                }
            }
        }
        assert!((area - triangle.area()).abs() < 1e-9, "{area} {}", triangle.area());
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        assert!((barycentric(corners, middle) - DVec3::splat(1.0 / 3.0)).length() < 1e-12);
        assert!((barycentric(corners, corners[2]) - DVec3::Z).length() < 1e-12);
    }
}

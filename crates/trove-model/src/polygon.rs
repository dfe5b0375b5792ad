//! Plane polygons.

use glam::DVec2;

/// Axis-aligned rectangle in World's plane, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// South-west corner.
    pub min: DVec2,
    /// North-east corner.
    pub max: DVec2,
}

impl Bounds {
    /// The smallest rectangle around some points; `None` without any.
    pub fn around(points: impl IntoIterator<Item = DVec2>) -> Option<Self> {
        points.into_iter().fold(None, |bounds: Option<Self>, p| {
            Some(bounds.map_or(Self { min: p, max: p }, |b| Self { min: b.min.min(p), max: b.max.max(p) }))
        })
    }

    /// A square around a centre.
    pub fn square(centre: DVec2, side_m: f64) -> Self {
        Self { min: centre - side_m / 2.0, max: centre + side_m / 2.0 }
    }

    /// With `margin_m` added on every side.
    pub fn grown(&self, margin_m: f64) -> Self {
        Self { min: self.min - margin_m, max: self.max + margin_m }
    }

    /// Whether a point lies in the rectangle or on its edge.
    pub fn contains(&self, p: DVec2) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// Whether two rectangles share a point.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Width and height, metres.
    pub fn size_m(&self) -> DVec2 {
        self.max - self.min
    }

    /// The middle.
    pub fn centre(&self) -> DVec2 {
        (self.min + self.max) / 2.0
    }
}

/// A polygon in World's plane, metres; rings are open (the last vertex is not the first again).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon {
    /// Outer ring, counter-clockwise after [`Polygon::oriented`].
    pub exterior: Vec<DVec2>,
    /// Inner rings, clockwise after [`Polygon::oriented`].
    pub holes: Vec<Vec<DVec2>>,
}

impl Polygon {
    /// Without holes.
    pub fn simple(exterior: Vec<DVec2>) -> Self {
        Self { exterior, holes: Vec::new() }
    }

    /// Outer ring counter-clockwise, inner rings clockwise.
    pub fn oriented(mut self) -> Self {
        if signed_ring_area_m2(&self.exterior) < 0.0 {
            self.exterior.reverse();
        }
        for hole in &mut self.holes {
            if signed_ring_area_m2(hole) > 0.0 {
                hole.reverse();
            }
        }
        self
    }

    /// Area without the holes.
    pub fn area_m2(&self) -> f64 {
        let holes: f64 = self.holes.iter().map(|h| signed_ring_area_m2(h).abs()).sum();
        signed_ring_area_m2(&self.exterior).abs() - holes
    }

    /// Whether a point lies inside (even-odd over all rings; points on an edge may fall either way).
    pub fn contains(&self, p: DVec2) -> bool {
        self.rings().fold(false, |inside, ring| inside ^ ring_contains(ring, p))
    }

    /// All rings, the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &Vec<DVec2>> {
        std::iter::once(&self.exterior).chain(&self.holes)
    }

    /// All edges of all rings.
    pub fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        self.rings().flat_map(|ring| (0..ring.len()).map(move |i| (ring[i], ring[(i + 1) % ring.len()])))
    }

    /// Distance of a point to the nearest edge, metres; infinite for an empty polygon.
    pub fn edge_distance_m(&self, p: DVec2) -> f64 {
        self.edges().map(|(a, b)| segment_distance_m(p, a, b)).fold(f64::INFINITY, f64::min)
    }

    /// Smallest rectangle around the outer ring; `None` where it is empty.
    pub fn bounds(&self) -> Option<Bounds> {
        Bounds::around(self.exterior.iter().copied())
    }

    /// Centre of area of the outer ring; the mean of its vertices where it has no area.
    pub fn centroid(&self) -> DVec2 {
        let Some(&origin) = self.exterior.first() else { return DVec2::ZERO };
        let (mut sum, mut area) = (DVec2::ZERO, 0.0);
        for i in 0..self.exterior.len() {
            let a = self.exterior[i] - origin;
            let b = self.exterior[(i + 1) % self.exterior.len()] - origin;
            let cross = a.perp_dot(b);
            sum += (a + b) * cross;
            area += cross;
        }
        if area.abs() < 1e-9 {
            return self.exterior.iter().sum::<DVec2>() / self.exterior.len() as f64;
        }
        origin + sum / (3.0 * area)
    }
}

/// Area of a ring, positive where it runs counter-clockwise.
fn signed_ring_area_m2(ring: &[DVec2]) -> f64 {
    (0..ring.len()).map(|i| ring[i].perp_dot(ring[(i + 1) % ring.len()])).sum::<f64>() / 2.0
}

fn ring_contains(ring: &[DVec2], p: DVec2) -> bool {
    let Some(&(mut a)) = ring.last() else { return false };
    let mut inside = false;
    for &b in ring {
        if (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x {
            inside = !inside;
        }
        a = b;
    }
    inside
}

/// Distance of `p` to the segment from `a` to `b`, metres.
pub(crate) fn segment_distance_m(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let ab = b - a;
    let t = if ab.length_squared() > 0.0 { ((p - a).dot(ab) / ab.length_squared()).clamp(0.0, 1.0) } else { 0.0 };
    (a + ab * t).distance(p)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(side: f64) -> Vec<DVec2> {
        vec![DVec2::ZERO, DVec2::new(side, 0.0), DVec2::splat(side), DVec2::new(0.0, side)]
    }

    #[test]
    fn a_hole_is_outside() {
        let hole = square(2.0).iter().map(|p| *p + 4.0).collect();
        let polygon = Polygon { exterior: square(10.0), holes: vec![hole] };
        assert!(polygon.contains(DVec2::splat(1.0)));
        assert!(!polygon.contains(DVec2::splat(5.0)));
        assert_eq!(polygon.area_m2(), 96.0);
        assert_eq!(polygon.centroid(), DVec2::splat(5.0));
        assert_eq!(polygon.edge_distance_m(DVec2::splat(5.0)), 1.0);
    }

    #[test]
    fn orienting_turns_a_clockwise_ring_round() {
        let mut ring = square(1.0);
        ring.reverse();
        assert!(signed_ring_area_m2(&Polygon::simple(ring).oriented().exterior) > 0.0);
    }
}

//! Triangles between given points.

use glam::DVec2;

/// Triangles that fill a simple ring (counter-clockwise), as indices into it, by cutting off ears.
///
/// Unlike a general tessellator it uses every point, those within a straight side too, so that faces that share an
/// outline share its points. What cannot be cut, because the ring crosses itself, is left out.
pub(super) fn triangles(ring: &[DVec2]) -> Vec<[usize; 3]> {
    let mut left: Vec<usize> = (0..ring.len()).collect();
    let mut found = Vec::with_capacity(ring.len().saturating_sub(2));
    while left.len() > 3 {
        let n = left.len();
        let corners = |i: usize| [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
        // The roundest ear first, so that no slivers are left for the end.
        let best = (0..n).filter_map(|i| Some((i, ear(ring, &left, corners(i))?))).max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((i, _)) = best else { return found };
        found.push(corners(i));
        left.remove(i);
    }
    if let [a, b, c] = left[..]
        && (ring[b] - ring[a]).perp_dot(ring[c] - ring[a]) > 0.0
    {
        found.push([a, b, c]);
    }
    found
}

/// How round an ear is; `None` where it is none.
fn ear(ring: &[DVec2], left: &[usize], corners: [usize; 3]) -> Option<f64> {
    let [a, b, c] = corners.map(|i| ring[i]);
    let area = (b - a).perp_dot(c - a);
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    if area <= 1e-9 * longest {
        return None;
    }
    let within = |p: DVec2| {
        let side = |a: DVec2, b: DVec2| (b - a).perp_dot(p - a) >= -1e-12 * longest;
        p != a && p != b && p != c && side(a, b) && side(b, c) && side(c, a)
    };
    (!left.iter().any(|&i| !corners.contains(&i) && within(ring[i]))).then_some(area / longest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_is_used_and_the_area_kept() {
        let comb = [(0., 0.), (3., 0.), (6., 0.), (6., 5.), (5., 5.), (5., 2.), (3., 2.), (3., 5.), (0., 5.), (0., 2.)];
        let ring = comb.map(|(x, y)| DVec2::new(x, y));
        let found = triangles(&ring);
        let area: f64 = found.iter().map(|&[a, b, c]| (ring[b] - ring[a]).perp_dot(ring[c] - ring[a]) / 2.0).sum();
        assert_eq!((found.len(), area), (8, 24.0));
        assert!((0..10).all(|i| found.iter().flatten().any(|&j| j == i)));
    }
}

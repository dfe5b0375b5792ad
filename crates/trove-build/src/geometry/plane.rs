//! Set operations on plane areas: the only place that knows `geo`.
//!
//! An area is a list of oriented polygons that do not overlap. All results are rounded to [`GRID_M`], so that areas
//! that were cut from each other share their vertices exactly.

use geo::algorithm::buffer::{BufferStyle, LineCap, LineJoin};
use geo::algorithm::unary_union;
use geo::bool_ops::FillRule;
use geo::{BooleanOps, Buffer, Simplify, TriangulateEarcut};
use glam::DVec2;
use trove_model::{Bounds, Polygon};

use super::rings::clipped;

/// A millimetre, as a power of two.
const GRID_M: f64 = 1.0 / 1024.0;
/// Smaller than this is rounding, m².
const SPECK_M2: f64 = 1e-3;
/// Chords of round corners, radians.
const ARC_RAD: f64 = 0.35;
/// Edges that are moved keep their course to this, metres: each move would double the vertices of bends.
const COURSE_M: f64 = 2.0 * GRID_M;

/// Everything that lies in any of the polygons, which may overlap, cross themselves and run either way.
pub(crate) fn union(polygons: &[Polygon]) -> Vec<Polygon> {
    // A ring that crosses itself is mended first, alone: its lobes count whichever way round they run.
    let sound: Vec<geo::MultiPolygon> = polygons
        .iter()
        .map(|p| to_geo(std::slice::from_ref(p)))
        .map(|p| p.union_with_fill_rule(&geo::MultiPolygon::new(Vec::new()), FillRule::EvenOdd))
        .collect();
    from_geo(unary_union(sound.iter()))
}

/// What lies in `a` and not in `b`.
pub(crate) fn difference(a: &[Polygon], b: &[Polygon]) -> Vec<Polygon> {
    // What lies apart from the other is not looked at: operations cost as much as all that takes part in them.
    let Some(reach) = reach(b) else { return a.to_vec() };
    let (near, mut left): (Vec<Polygon>, Vec<Polygon>) =
        a.iter().cloned().partition(|p| p.bounds().is_some_and(|p| p.overlaps(&reach)));
    let Some(window) = self::reach(&near) else { return left };
    left.extend(from_geo(to_geo(&near).difference(&to_geo(&clipped(b, window)))));
    left
}

/// What lies in both.
pub(crate) fn intersection(a: &[Polygon], b: &[Polygon]) -> Vec<Polygon> {
    let (Some(of_a), Some(of_b)) = (reach(a), reach(b)) else { return Vec::new() };
    let (a, b) = (clipped(a, of_b), clipped(b, of_a));
    from_geo(to_geo(&a).intersection(&to_geo(&b)))
}

/// A rectangle around an area, with room for rounding; `None` for an empty one.
fn reach(area: &[Polygon]) -> Option<Bounds> {
    Bounds::around(area.iter().flat_map(|p| p.exterior.iter().copied())).map(|b| b.grown(0.01))
}

/// Everything within `distance_m` of an area, with round corners; negative: everything further than that inside it.
pub(crate) fn grown(area: &[Polygon], distance_m: f64) -> Vec<Polygon> {
    let style = BufferStyle::new(distance_m).line_join(LineJoin::Round(ARC_RAD));
    from_geo(to_geo(area).buffer_with_style(style).simplify(COURSE_M))
}

/// With gaps narrower than twice `radius_m` closed and corners inside it as round.
pub(crate) fn closed(area: &[Polygon], radius_m: f64) -> Vec<Polygon> {
    grown(&grown(area, radius_m), -radius_m)
}

/// Everything within `radius_m` of a point.
pub(crate) fn disc(centre: DVec2, radius_m: f64) -> Polygon {
    let corners = (std::f64::consts::TAU / ARC_RAD).ceil();
    let corner = |i: f64| centre + DVec2::from_angle(i * std::f64::consts::TAU / corners) * radius_m;
    Polygon::simple((0..corners as usize).map(|i| corner(i as f64)).collect())
}

/// A strip of a line, `half_width_m` to each side, with blunt ends.
pub(crate) fn strip(line: &[DVec2], half_width_m: f64) -> Vec<Polygon> {
    let mut points: Vec<DVec2> = line.to_vec();
    points.dedup_by(|a, b| a.distance(*b) < 0.01);
    if points.len() < 2 {
        return Vec::new();
    }
    let line: geo::LineString = points.iter().map(|p| (p.x, p.y)).collect::<Vec<_>>().into();
    let style = BufferStyle::new(half_width_m).line_cap(LineCap::Butt).line_join(LineJoin::Round(ARC_RAD));
    from_geo(line.buffer_with_style(style))
}

/// A rectangle as an area.
pub(crate) fn rectangle(bounds: Bounds) -> Polygon {
    let (a, b) = (bounds.min, bounds.max);
    Polygon::simple(vec![a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)])
}

/// Triangles that fill a polygon, counter-clockwise.
pub(crate) fn triangles(polygon: &Polygon) -> Vec<[DVec2; 3]> {
    let raw = geo_polygon(polygon).earcut_triangles_raw();
    let vertex = |i: usize| DVec2::from_array(raw.vertices[i]);
    raw.triangle_indices
        .chunks_exact(3)
        .map(|t| [vertex(t[0]), vertex(t[1]), vertex(t[2])])
        .map(|[a, b, c]| if (b - a).perp_dot(c - a) < 0.0 { [a, c, b] } else { [a, b, c] })
        .collect()
}

fn ring_to_geo(ring: &[DVec2]) -> geo::LineString {
    ring.iter().map(|p| (p.x, p.y)).collect::<Vec<_>>().into()
}

fn geo_polygon(polygon: &Polygon) -> geo::Polygon {
    geo::Polygon::new(ring_to_geo(&polygon.exterior), polygon.holes.iter().map(|h| ring_to_geo(h)).collect())
}

fn to_geo(area: &[Polygon]) -> geo::MultiPolygon {
    let sound = |p: &&Polygon| p.exterior.len() > 2 && p.rings().flatten().all(|v| v.is_finite());
    geo::MultiPolygon::new(area.iter().filter(sound).map(geo_polygon).collect())
}

fn from_geo(area: geo::MultiPolygon) -> Vec<Polygon> {
    let ring = |line: &geo::LineString| -> Vec<DVec2> {
        let mut points: Vec<DVec2> = line.coords().map(|c| (DVec2::new(c.x, c.y) / GRID_M).round() * GRID_M).collect();
        points.dedup();
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        points
    };
    let large = |ring: &Vec<DVec2>| ring.len() > 2 && Polygon::simple(ring.clone()).area_m2() > SPECK_M2;
    area.iter()
        .map(|p| Polygon {
            exterior: ring(p.exterior()),
            holes: p.interiors().iter().map(ring).filter(large).collect(),
        })
        .filter(|p| large(&p.exterior))
        .map(Polygon::oriented)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Polygon {
        rectangle(Bounds { min: DVec2::new(x, y), max: DVec2::new(x + side, y + side) })
    }

    fn area_m2(area: &[Polygon]) -> f64 {
        area.iter().map(Polygon::area_m2).sum()
    }

    #[test]
    fn bends_that_are_moved_there_and_back_keep_few_vertices() {
        let corner = |i: i32| DVec2::from_angle(f64::from(i).to_radians() * 4.0) * 20.0;
        let round = vec![Polygon::simple((0..90).map(corner).collect())];
        let moved = (0..3).fold(round.clone(), |area, _| closed(&area, 0.4));
        assert!((area_m2(&moved) - area_m2(&round)).abs() < 0.3, "{}", area_m2(&moved) - area_m2(&round));
        assert!(moved[0].exterior.len() <= 100, "{}", moved[0].exterior.len());
    }

    #[test]
    fn areas_add_up() {
        let (a, b) = ([square(0.0, 0.0, 10.0)], [square(4.0, 4.0, 2.0)]);
        assert_eq!(area_m2(&union(&[a[0].clone(), b[0].clone(), square(8.0, 0.0, 4.0)])), 100.0 + 8.0);
        assert_eq!(area_m2(&difference(&a, &b)), 96.0);
        assert_eq!(area_m2(&intersection(&a, &b)), 4.0);
        assert!((area_m2(&grown(&a, 1.0)) - (140.0 + std::f64::consts::PI)).abs() < 0.2);
        assert!((area_m2(&strip(&[DVec2::ZERO, DVec2::X * 10.0], 2.0)) - 40.0).abs() < 0.1);
    }

    #[test]
    fn a_bow_tie_becomes_its_two_lobes() {
        let bow = Polygon::simple([(0., 0.), (4., 4.), (4., 0.), (0., 4.)].map(|(x, y)| DVec2::new(x, y)).into());
        assert!((area_m2(&union(&[bow])) - 8.0).abs() < 0.01);
    }
}

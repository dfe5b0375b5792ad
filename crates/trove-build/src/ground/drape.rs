//! Surfaces that lie on the ground.
//!
//! The ground is one piecewise plane surface: every cell of the height field is two triangles. Areas are cut along
//! all creases of it, so each piece lies in one plane, neighbours meet without gaps, and a marking a few
//! millimetres above a road is that much above it everywhere.

use glam::{DVec2, UVec2, Vec2, Vec3};
use trove_model::{Bounds, HeightField, Mesh, Polygon};

use super::rings::{self, Line, Ring};
use crate::plane;

/// Below this a triangle is rounding, m².
const SLIVER_M2: f64 = 1e-7;
/// Above this many cells the two halves of an area are cut by two threads.
const PARALLEL_CELLS: u32 = 2048;

/// The ground's triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drape<'a> {
    field: &'a HeightField,
}

/// A rectangle of cells: from `min` to `max`, which is not included.
#[derive(Clone, Copy)]
struct Cells {
    min: UVec2,
    max: UVec2,
}

impl<'a> Drape<'a> {
    pub(crate) fn new(field: &'a HeightField) -> Self {
        Self { field }
    }

    /// Where the field ends.
    pub(crate) fn bounds(&self) -> Bounds {
        let last = UVec2::new(self.field.nodes.width - 1, self.field.nodes.height - 1);
        Bounds { min: self.field.origin, max: self.field.origin + last.as_dvec2() * self.field.cell_m }
    }

    /// Height of the triangle under a point, metres; outside the field the nearest edge's.
    pub(crate) fn height_m(&self, p: DVec2) -> f64 {
        let nodes = &self.field.nodes;
        let limit = UVec2::new(nodes.width - 1, nodes.height - 1);
        let g = ((p - self.field.origin) / self.field.cell_m).clamp(DVec2::ZERO, limit.as_dvec2());
        let cell = g.floor().as_uvec2().min(limit - 1);
        let f = g - cell.as_dvec2();
        let z = |dx, dy| f64::from(*nodes.at(cell.x + dx, cell.y + dy));
        if f.x >= f.y {
            z(0, 0) + f.x * (z(1, 0) - z(0, 0)) + f.y * (z(1, 1) - z(1, 0))
        } else {
            z(0, 0) + f.y * (z(0, 1) - z(0, 0)) + f.x * (z(1, 1) - z(0, 1))
        }
    }

    /// The surface of an area, `lift_m` above the ground; texture coordinates are World's x and y in metres.
    ///
    /// The polygons are oriented, do not overlap, and lie within the field.
    pub(crate) fn surface(&self, area: &[Polygon], lift_m: f64) -> Mesh {
        let rings: Vec<Ring> = area.iter().flat_map(|p| p.rings().cloned()).collect();
        let nodes = UVec2::new(self.field.nodes.width, self.field.nodes.height);
        let mut triangles = Vec::new();
        self.cut(rings, Cells { min: UVec2::ZERO, max: nodes - 1 }, &mut triangles);
        let mut mesh = Mesh::default();
        for [a, b, c] in triangles {
            if (b - a).perp_dot(c - a) < 2.0 * SLIVER_M2 {
                continue;
            }
            let first = mesh.positions.len() as u32;
            for p in [a, b, c] {
                mesh.positions.push(p.extend(self.height_m(p) + lift_m).as_vec3());
                mesh.normals.push(self.field.normal(p).as_vec3());
                mesh.uvs.push(p.as_vec2());
            }
            mesh.triangles.push([first, first + 1, first + 2]);
        }
        welded(&mesh)
    }

    /// Vertical faces along the edges of an area, from `bottom_m` to `top_m` above the ground, seen from inside the
    /// area; u runs along the edge and v up, in metres. Edges for which `skip` holds get none.
    pub(crate) fn faces(
        &self,
        area: &[Polygon],
        bottom_m: f64,
        top_m: f64,
        skip: impl Fn(DVec2, DVec2) -> bool,
    ) -> Mesh {
        let mut mesh = Mesh::default();
        for ring in area.iter().flat_map(Polygon::rings) {
            let mut along_m = 0.0;
            for i in 0..ring.len() {
                let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
                if skip(a, b) {
                    continue;
                }
                let inward = (b - a).perp().normalize_or_zero().extend(0.0).as_vec3();
                for pair in self.cut_segment(a, b).windows(2) {
                    let [p, q] = [pair[0], pair[1]];
                    let first = mesh.positions.len() as u32;
                    let u = [along_m, along_m + p.distance(q)];
                    for (p, u, lift) in [(p, u[0], bottom_m), (q, u[1], bottom_m), (q, u[1], top_m), (p, u[0], top_m)] {
                        mesh.positions.push(p.extend(self.height_m(p) + lift).as_vec3());
                        mesh.normals.push(inward);
                        mesh.uvs.push(Vec2::new(u as f32, (lift - bottom_m) as f32));
                    }
                    mesh.triangles.extend([[first, first + 2, first + 1], [first, first + 3, first + 2]]);
                    along_m = u[1];
                }
            }
        }
        mesh
    }

    /// The ground beyond the field out to `reach_m`, at the height of the field's edge.
    pub(crate) fn apron(&self, reach_m: f64, lift_m: f64) -> Mesh {
        let cell_m = self.field.cell_m;
        let last = UVec2::new(self.field.nodes.width - 1, self.field.nodes.height - 1);
        let coordinate = |origin: f64, last: u32| -> Vec<f64> {
            let inside = (0..=last).map(|i| origin + f64::from(i) * cell_m);
            let far = origin + f64::from(last) * cell_m + reach_m;
            std::iter::once(origin - reach_m).chain(inside).chain(std::iter::once(far)).collect()
        };
        let (xs, ys) = (coordinate(self.field.origin.x, last.x), coordinate(self.field.origin.y, last.y));
        let mut mesh = Mesh::default();
        for (j, y) in ys.windows(2).enumerate() {
            for (i, x) in xs.windows(2).enumerate() {
                let inside = (1..=last.x as usize).contains(&i) && (1..=last.y as usize).contains(&j);
                if inside {
                    continue;
                }
                let first = mesh.positions.len() as u32;
                for p in [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])].map(|(x, y)| DVec2::new(x, y)) {
                    mesh.positions.push(p.extend(self.height_m(p) + lift_m).as_vec3());
                    mesh.normals.push(Vec3::Z);
                    mesh.uvs.push(p.as_vec2());
                }
                mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            }
        }
        mesh
    }

    /// Halves the cells until one is left, cuts that along its diagonal and triangulates what lies there.
    fn cut(&self, rings: Vec<Ring>, cells: Cells, triangles: &mut Vec<[DVec2; 3]>) {
        if rings.is_empty() {
            return;
        }
        let size = cells.max - cells.min;
        let (origin, cell_m) = (self.field.origin, self.field.cell_m);
        if size == UVec2::ONE {
            let corner = origin + cells.min.as_dvec2() * cell_m;
            let diagonal = Line { normal: DVec2::new(1.0, -1.0), offset: corner.x - corner.y };
            let (left, right) = rings::split(rings, diagonal);
            triangulate(left, triangles);
            triangulate(right, triangles);
            return;
        }
        let middle = (cells.min + cells.max) / 2;
        let (line, before, after) = if size.x >= size.y {
            let line = Line { normal: DVec2::X, offset: origin.x + f64::from(middle.x) * cell_m };
            (line, UVec2::new(middle.x, cells.max.y), UVec2::new(middle.x, cells.min.y))
        } else {
            let line = Line { normal: DVec2::Y, offset: origin.y + f64::from(middle.y) * cell_m };
            (line, UVec2::new(cells.max.x, middle.y), UVec2::new(cells.min.x, middle.y))
        };
        let (left, right) = rings::split(rings, line);
        let (low, high) = (Cells { max: before, ..cells }, Cells { min: after, ..cells });
        if size.element_product() > PARALLEL_CELLS {
            let (mut more, ()) = rayon::join(
                || {
                    let mut more = Vec::new();
                    self.cut(right, high, &mut more);
                    more
                },
                || self.cut(left, low, triangles),
            );
            triangles.append(&mut more);
        } else {
            self.cut(left, low, triangles);
            self.cut(right, high, triangles);
        }
    }

    /// A segment with a vertex at every crease.
    fn cut_segment(&self, a: DVec2, b: DVec2) -> Vec<DVec2> {
        let (origin, cell_m) = (self.field.origin, self.field.cell_m);
        let mut points = vec![a, b];
        let diagonal = DVec2::new(1.0, -1.0);
        for normal in [DVec2::X, DVec2::Y, diagonal] {
            let at = |p: DVec2| normal.dot(p - origin) / cell_m;
            let (low, high) = (at(a).min(at(b)), at(a).max(at(b)));
            for k in low.ceil() as i64..=high.floor() as i64 {
                let line = Line { normal, offset: normal.dot(origin) + k as f64 * cell_m };
                if line.is_left(a) != line.is_left(b) {
                    points.push(line.crossing(a, b));
                }
            }
        }
        points.sort_by(|p, q| p.distance_squared(a).total_cmp(&q.distance_squared(a)));
        points.dedup();
        points
    }
}

fn triangulate(rings: Vec<Ring>, triangles: &mut Vec<[DVec2; 3]>) {
    // Nearly all are the halves of whole cells.
    if let [ring] = rings.as_slice()
        && let [a, b, c] = ring[..]
    {
        triangles.push([a, b, c]);
        return;
    }
    for polygon in rings::polygons(rings) {
        triangles.extend(plane::triangles(&polygon));
    }
}

/// The same mesh with equal vertices made one.
fn welded(mesh: &Mesh) -> Mesh {
    let key = |i: u32| mesh.positions[i as usize].to_array().map(f32::to_bits);
    let mut order: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    order.sort_unstable_by_key(|&i| (key(i), i));
    let mut first_of = vec![0u32; order.len()];
    for run in order.chunk_by(|&a, &b| key(a) == key(b)) {
        for &i in run {
            first_of[i as usize] = run[0];
        }
    }
    let mut index = vec![u32::MAX; order.len()];
    let mut out = Mesh::default();
    for triangle in &mesh.triangles {
        let corners = triangle.map(|i| {
            let i = first_of[i as usize] as usize;
            if index[i] == u32::MAX {
                index[i] = out.positions.len() as u32;
                out.positions.push(mesh.positions[i]);
                out.normals.push(mesh.normals[i]);
                out.uvs.push(mesh.uvs[i]);
            }
            index[i]
        });
        out.triangles.push(corners);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Raster;

    fn hilly() -> HeightField {
        let nodes = Raster::from_fn(21, 21, |x, y| ((x * 7 + y * 13) % 5) as f32 * 0.1);
        HeightField { origin: DVec2::splat(-20.0), cell_m: 2.0, nodes }
    }

    fn rectangle(bounds: Bounds) -> Vec<DVec2> {
        let (a, b) = (bounds.min, bounds.max);
        vec![a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)]
    }

    #[test]
    fn a_draped_area_keeps_its_area_faces_up_and_lies_on_the_ground_everywhere() {
        let field = hilly();
        let drape = Drape::new(&field);
        let hole = rectangle(Bounds::square(DVec2::new(1.0, 2.0), 7.3)).into_iter().rev().collect();
        let turned = rectangle(Bounds::square(DVec2::ZERO, 20.0)).into_iter().map(|p| p.rotate(DVec2::from_angle(0.3)));
        let polygon = Polygon { exterior: turned.collect(), holes: vec![hole] };
        let mesh = drape.surface(std::slice::from_ref(&polygon), 0.1);
        assert_eq!(mesh.defect(), None);
        let mut area = 0.0;
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize].as_dvec3());
            let normal = (b - a).cross(c - a);
            assert!(normal.z > 0.0);
            area += normal.z / 2.0;
            let centre = (a + b + c) / 3.0;
            assert!((centre.z - drape.height_m(centre.truncate()) - 0.1).abs() < 1e-4);
        }
        assert!((area - polygon.area_m2()).abs() < 0.01, "{area} of {}", polygon.area_m2());
    }

    #[test]
    fn wheels_stand_on_the_mesh_where_the_ground_is_smooth() {
        let nodes = Raster::from_fn(51, 51, |x, y| (x as f32 * 0.1).sin() * 0.5 + (y as f32 * 0.08).cos() * 0.5);
        let field = HeightField { origin: DVec2::ZERO, cell_m: 2.0, nodes };
        let drape = Drape::new(&field);
        for i in 0..500 {
            let p = DVec2::new(f64::from(i) * 0.19, f64::from(i * 37 % 500) * 0.19);
            assert!((drape.height_m(p) - field.height_m(p)).abs() < 0.02);
        }
    }

    #[test]
    fn faces_stand_on_every_edge_and_look_inwards() {
        let field = hilly();
        let polygon = Polygon::simple(rectangle(Bounds::square(DVec2::ZERO, 10.0)));
        let mesh = Drape::new(&field).faces(&[polygon], 0.0, 0.1, |_, _| false);
        assert_eq!(mesh.defect(), None);
        let mut area = 0.0;
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            let normal = (b - a).cross(c - a);
            assert!(normal.dot((a + b + c) / 3.0 * Vec3::new(1.0, 1.0, 0.0)) < 0.0);
            area += normal.length() / 2.0;
        }
        assert!((area - 4.0).abs() < 0.2, "{area}");
    }

    #[test]
    fn the_apron_goes_on_where_the_field_ends() {
        let field = hilly();
        let mesh = Drape::new(&field).apron(100.0, 0.0);
        let area: f32 = mesh
            .triangles
            .iter()
            .map(|t| t.map(|i| mesh.positions[i as usize].truncate()))
            .map(|[a, b, c]| (b - a).perp_dot(c - a) / 2.0)
            .sum();
        assert!((area - (240.0 * 240.0 - 40.0 * 40.0)).abs() < 1.0);
    }
}

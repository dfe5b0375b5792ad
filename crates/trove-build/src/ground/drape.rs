//! Surfaces that lie on the ground.
//!
//! The ground is one piecewise plane surface: every cell of the height field is two triangles. Areas are cut along
//! all creases of it, so each piece lies in one plane, neighbours meet without gaps, and a marking a few
//! millimetres above a road is that much above it everywhere.

use glam::{DVec2, UVec2, Vec2};
use trove_model::{Bounds, HeightField, Mesh, Polygon};

use super::blocks::{Blocks, middle};
use super::ramps::{PARTS, Ramps};
use crate::geometry::plane;
use crate::geometry::rings::{self, Line, Ring};

/// Below this a triangle is rounding, m².
const SLIVER_M2: f64 = 1e-7;
/// Heights that differ less are one plane, metres.
const EVEN_M: f64 = 1e-4;
/// Above this many cells the two halves of an area are cut by two threads.
const PARALLEL_CELLS: u32 = 2048;

/// The ground's triangles.
#[derive(Clone, Debug)]
pub(crate) struct Drape<'a> {
    field: &'a HeightField,
    ramps: Option<&'a Ramps>,
    blocks: Blocks,
}

/// How finely a surface is cut.
#[derive(Clone, Copy)]
struct Cut<'a> {
    ramps: Option<&'a Ramps>,
    /// Even blocks stay whole.
    in_blocks: bool,
}

/// A rectangle of cells: from `min` to `max`, which is not included.
#[derive(Clone, Copy)]
struct Cells {
    min: UVec2,
    max: UVec2,
}

impl<'a> Drape<'a> {
    /// With as few triangles as the ground's shape allows.
    pub(crate) fn new(field: &'a HeightField) -> Self {
        Self { field, ramps: None, blocks: Blocks::new(field, |_| false) }
    }

    /// With ramps, where heights above the ground are less.
    pub(crate) fn with_ramps(field: &'a HeightField, ramps: &'a Ramps) -> Self {
        Self { field, ramps: Some(ramps), blocks: Blocks::new(field, |cell| ramps.has(cell.as_ivec2())) }
    }

    /// What it lies on.
    pub(super) fn field(&self) -> &HeightField {
        self.field
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
        self.mesh(area, Cut { ramps: None, in_blocks: true }, |_| lift_m)
    }

    /// The surface of an area that comes down where there are ramps, else as [`Drape::surface`].
    pub(crate) fn raised(&self, area: &[Polygon], lift_m: f64) -> Mesh {
        self.mesh(area, Cut { ramps: self.ramps, in_blocks: true }, |p| lift_m * self.ramp(p))
    }

    /// As [`Drape::raised`], with vertices in every cell for what changes from place to place.
    pub(crate) fn raised_in_cells(&self, area: &[Polygon], lift_m: f64) -> Mesh {
        self.mesh(area, Cut { ramps: self.ramps, in_blocks: false }, |p| lift_m * self.ramp(p))
    }

    /// The ramps' factor at a point.
    fn ramp(&self, p: DVec2) -> f64 {
        self.ramps.map_or(1.0, |r| r.at(p))
    }

    fn mesh(&self, area: &[Polygon], cut: Cut<'_>, lift_m: impl Fn(DVec2) -> f64) -> Mesh {
        let rings: Vec<Ring> = area.iter().flat_map(|p| p.rings().cloned()).collect();
        let nodes = UVec2::new(self.field.nodes.width, self.field.nodes.height);
        let mut triangles = Vec::new();
        self.cut(rings, Cells { min: UVec2::ZERO, max: nodes - 1 }, cut, &mut triangles);
        let mut mesh = Mesh::default();
        for [a, b, c] in triangles {
            if (b - a).perp_dot(c - a) < 2.0 * SLIVER_M2 {
                continue;
            }
            let first = mesh.positions.len() as u32;
            for p in [a, b, c] {
                mesh.positions.push(p.extend(self.height_m(p) + lift_m(p)).as_vec3());
                mesh.normals.push(self.field.normal(p).as_vec3());
                mesh.uvs.push(p.as_vec2());
            }
            mesh.triangles.push([first, first + 1, first + 2]);
        }
        welded(&mesh)
    }

    /// Steep faces along the edges of an area, seen from inside it, down to `bottom_m` above the ground. The profile
    /// is a row of points from the bottom to the top: how far each lies inside the edge, and how high above the
    /// ground, which ramps make less. u runs along the edge and v up the profile, in metres. Edges for which `skip`
    /// holds get none.
    pub(crate) fn faces(&self, area: &[Polygon], profile: &[DVec2], skip: impl Fn(DVec2, DVec2) -> bool) -> Mesh {
        let mut mesh = Mesh::default();
        for ring in area.iter().flat_map(Polygon::rings) {
            let n = ring.len();
            let inward = |i: usize| (ring[(i + 1) % n] - ring[i % n]).perp().normalize_or_zero();
            // At a corner points lie on the bisector; sharp ones are cut short.
            let mitre = |i: usize| {
                let (before, after) = (inward(i + n - 1), inward(i));
                let sum = before + after;
                (sum * 2.0 / sum.length_squared().max(0.5), (before, after))
            };
            let mut along_m = 0.0;
            for i in 0..n {
                let (a, b) = (ring[i], ring[(i + 1) % n]);
                if skip(a, b) {
                    continue;
                }
                let (from, to) = (mitre(i).0, mitre(i + 1).0);
                let points = self.cut_segment(a, b);
                for pair in points.windows(2) {
                    let length_m = a.distance(b);
                    let ends = [pair[0], pair[1]].map(|p| {
                        let t = p.distance(a) / length_m;
                        (p, from.lerp(to, t), along_m + p.distance(a))
                    });
                    self.face(&mut mesh, ends, inward(i), profile);
                }
                along_m += a.distance(b);
            }
        }
        mesh
    }

    /// One piece of an edge's faces: its two ends as (position, way inwards, metres along the edge).
    fn face(&self, mesh: &mut Mesh, ends: [(DVec2, DVec2, f64); 2], inward: DVec2, profile: &[DVec2]) {
        let mut v_m = 0.0;
        for steps in profile.windows(2) {
            let (low, high) = (steps[0], steps[1]);
            let across = high - low;
            let normal = (inward * across.y).extend(-across.x).normalize_or_zero().as_vec3();
            let first = mesh.positions.len() as u32;
            let corners = [(ends[0], low, v_m), (ends[1], low, v_m), (ends[1], high, 0.0), (ends[0], high, 0.0)];
            for (k, ((p, inwards, u), step, v)) in corners.into_iter().enumerate() {
                let lift_m = step.y * if step.y > 0.0 { self.ramp(p) } else { 1.0 };
                mesh.positions.push((p + inwards * step.x).extend(self.height_m(p) + lift_m).as_vec3());
                mesh.normals.push(normal);
                let v = if k < 2 { v } else { v_m + across.length() };
                mesh.uvs.push(Vec2::new(u as f32, v as f32));
            }
            mesh.triangles.extend([[first, first + 2, first + 1], [first, first + 3, first + 2]]);
            v_m += across.length();
        }
    }

    /// Halves the cells until an even block is left, cuts that along its diagonal and triangulates what lies there.
    fn cut(&self, rings: Vec<Ring>, cells: Cells, how: Cut<'_>, triangles: &mut Vec<[DVec2; 3]>) {
        if rings.is_empty() {
            return;
        }
        let size = cells.max - cells.min;
        let (origin, cell_m) = (self.field.origin, self.field.cell_m);
        let (even, ramped) = self.blocks.at(cells.min, size).unwrap_or((false, true));
        let has_ramps = how.ramps.is_some() && ramped;
        if size == UVec2::ONE || (even && how.in_blocks && !has_ramps) {
            let corner = origin + cells.min.as_dvec2() * cell_m;
            if has_ramps {
                cut_parts(rings, corner, cell_m, PARTS, triangles);
            } else {
                cut_diagonally(rings, corner, triangles);
            }
            return;
        }
        let (line, before, after) = if size.x >= size.y {
            let at = middle(cells.min.x, cells.max.x);
            let line = Line { normal: DVec2::X, offset: origin.x + f64::from(at) * cell_m };
            (line, UVec2::new(at, cells.max.y), UVec2::new(at, cells.min.y))
        } else {
            let at = middle(cells.min.y, cells.max.y);
            let line = Line { normal: DVec2::Y, offset: origin.y + f64::from(at) * cell_m };
            (line, UVec2::new(cells.max.x, at), UVec2::new(cells.min.x, at))
        };
        let (left, right) = rings::split(rings, line);
        let (low, high) = (Cells { max: before, ..cells }, Cells { min: after, ..cells });
        if size.element_product() > PARALLEL_CELLS {
            let (mut more, ()) = rayon::join(
                || {
                    let mut more = Vec::new();
                    self.cut(right, high, how, &mut more);
                    more
                },
                || self.cut(left, low, how, triangles),
            );
            triangles.append(&mut more);
        } else {
            self.cut(left, low, how, triangles);
            self.cut(right, high, how, triangles);
        }
    }

    /// A segment with a vertex at every crease.
    fn cut_segment(&self, a: DVec2, b: DVec2) -> Vec<DVec2> {
        let origin = self.field.origin;
        let ramps = self.ramps.filter(|r| r.touches(a, b));
        let cell_m = self.field.cell_m / if ramps.is_some() { f64::from(PARTS) } else { 1.0 };
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
        // Creases of even ground are none.
        let shape = |p: DVec2| DVec2::new(self.height_m(p), self.ramp(p));
        let mut kept = vec![points[0]];
        for pair in points.windows(2).skip(1) {
            let (from, at, to) = (kept[kept.len() - 1], pair[0], pair[1]);
            let t = from.distance(at) / from.distance(to);
            if (shape(from).lerp(shape(to), t) - shape(at)).abs().max_element() > EVEN_M {
                kept.push(at);
            }
        }
        kept.extend(points.last().filter(|_| points.len() > 1));
        kept
    }
}

/// Cuts what lies on a square along its diagonal and triangulates both halves.
fn cut_diagonally(rings: Vec<Ring>, corner: DVec2, triangles: &mut Vec<[DVec2; 3]>) {
    let diagonal = Line { normal: DVec2::new(1.0, -1.0), offset: corner.x - corner.y };
    let (left, right) = rings::split(rings, diagonal);
    triangulate(left, triangles);
    triangulate(right, triangles);
}

/// Cuts what lies on a cell into its parts, `parts` along each side.
fn cut_parts(mut rings: Vec<Ring>, corner: DVec2, cell_m: f64, parts: i32, triangles: &mut Vec<[DVec2; 3]>) {
    let part_m = cell_m / f64::from(parts);
    for y in 0..parts {
        let north = corner.y + f64::from(y + 1) * part_m;
        let (mut row, rest) = rings::split(rings, Line { normal: DVec2::Y, offset: north });
        rings = rest;
        for x in 0..parts {
            let east = corner.x + f64::from(x + 1) * part_m;
            let (part, rest) = rings::split(row, Line { normal: DVec2::X, offset: east });
            row = rest;
            cut_diagonally(part, corner + DVec2::new(f64::from(x), f64::from(y)) * part_m, triangles);
        }
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
    use glam::Vec3;
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
        let profile = [DVec2::ZERO, DVec2::new(0.0, 0.1)];
        let mesh = Drape::new(&field).faces(&[polygon], &profile, |_, _| false);
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
}

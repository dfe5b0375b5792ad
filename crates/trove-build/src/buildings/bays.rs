//! Models of buildings that grow by whole bays and storeys.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};
use trove_model::{Asset, Mesh};

/// Nothing is repeated more often.
const MOST: u32 = 40;
/// What lies this near to a plane lies on it, metres.
const ON_PLANE_M: f32 = 1e-4;

/// How often the bays along x and y and the storeys of a model stand there; 1 where it has none to repeat.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Bays(pub [u32; 3]);

impl Bays {
    /// Those that bring a model of some size nearest to another.
    pub(super) fn for_size(asset: &Asset, own_m: DVec3, size_m: DVec3) -> Self {
        let axis = |i: usize| {
            let Some([from_m, to_m]) = asset.repeats[i] else { return 1 };
            let fitting = 1.0 + (size_m[i] - own_m[i]) / (to_m - from_m);
            // A model keeps one of them at least.
            if fitting.is_finite() { (fitting.round() as i64).clamp(1, i64::from(MOST)) as u32 } else { 1 }
        };
        Self([0, 1, 2].map(axis))
    }

    /// What so many of them add to a model's size.
    pub(super) fn more_m(self, asset: &Asset) -> DVec3 {
        let more = |i: usize| asset.repeats[i].map_or(0.0, |[from, to]| f64::from(self.0[i] - 1) * (to - from));
        DVec3::new(more(0), more(1), more(2))
    }

    /// A model's mesh with so many of them, in the middle as the model's own is.
    pub(super) fn mesh(self, asset: &Asset) -> Arc<Mesh> {
        let mut mesh = Arc::clone(&asset.mesh);
        for (axis, count) in self.0.into_iter().enumerate().filter(|(_, count)| *count > 1) {
            if let Some(slab) = asset.repeats[axis] {
                mesh = Arc::new(repeated(&mesh, axis, slab.map(|m| m as f32), count));
            }
        }
        mesh
    }
}

/// A mesh in which what lies between two planes across an axis stands `count` times; across x and y it stays where its
/// middle was.
fn repeated(mesh: &Mesh, axis: usize, [from, to]: [f32; 2], count: u32) -> Mesh {
    let step = to - from;
    let grown = step * (count - 1) as f32;
    let start = if axis == 2 { 0.0 } else { -grown / 2.0 };
    let mut copy = Copy { mesh, axis, to: Mesh::default() };
    copy.add([f32::NEG_INFINITY, from], start);
    for k in 0..count {
        copy.add([from, to], start + step * k as f32);
    }
    copy.add([to, f32::INFINITY], start + grown);
    copy.to
}

struct Copy<'m> {
    mesh: &'m Mesh,
    axis: usize,
    to: Mesh,
}

/// A vertex with all that it carries.
#[derive(Clone, Copy)]
struct Vertex {
    /// Its index in the mesh, where it is one of it.
    index: Option<u32>,
    position: Vec3,
    normal: Vec3,
    uv: Vec2,
    tint: Vec3,
}

impl Copy<'_> {
    /// Adds what of the mesh lies between two places along the axis, moved along it.
    fn add(&mut self, between: [f32; 2], by: f32) {
        // Only looked up.
        let mut known: HashMap<u32, u32> = HashMap::new();
        for (i, triangle) in self.mesh.triangles.iter().enumerate() {
            let corners = triangle.map(|index| self.vertex(index)).to_vec();
            let above = self.cut(corners, between[0], 1.0);
            let part = self.cut(above, between[1], -1.0);
            // A face in the plane of a cut belongs to the side that it is the surface of.
            let is_at = |plane: f32| part.iter().all(|v| (v.position[self.axis] - plane).abs() <= ON_PLANE_M);
            let faces_up = self.normal(*triangle)[self.axis] > 0.0;
            if part.len() < 3 || is_at(between[0]) && faces_up || is_at(between[1]) && !faces_up {
                continue;
            }
            let indices: Vec<u32> = part.iter().map(|v| self.put(v, by, &mut known)).collect();
            for k in 1..indices.len() - 1 {
                self.to.triangles.push([indices[0], indices[k], indices[k + 1]]);
                if !self.mesh.slots.is_empty() {
                    self.to.slots.push(self.mesh.slots[i]);
                }
            }
        }
    }

    fn normal(&self, triangle: [u32; 3]) -> Vec3 {
        let [a, b, c] = triangle.map(|i| self.mesh.positions[i as usize]);
        (b - a).cross(c - a)
    }

    fn vertex(&self, index: u32) -> Vertex {
        let i = index as usize;
        Vertex {
            index: Some(index),
            position: self.mesh.positions[i],
            normal: self.mesh.normals.get(i).copied().unwrap_or_default(),
            uv: self.mesh.uvs.get(i).copied().unwrap_or_default(),
            tint: self.mesh.tints.get(i).copied().unwrap_or_default(),
        }
    }

    /// The part of a convex polygon on one side of a plane across the axis.
    fn cut(&self, polygon: Vec<Vertex>, at: f32, sign: f32) -> Vec<Vertex> {
        if at.is_infinite() {
            return polygon;
        }
        let side = |v: &Vertex| {
            let side = sign * (v.position[self.axis] - at);
            if side.abs() <= ON_PLANE_M { 0.0 } else { side }
        };
        if polygon.iter().all(|v| side(v) >= 0.0) {
            return polygon;
        }
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (i, a) in polygon.iter().enumerate() {
            let b = &polygon[(i + 1) % polygon.len()];
            let (sa, sb) = (side(a), side(b));
            if sa >= 0.0 {
                kept.push(*a);
            }
            if sa * sb < 0.0 {
                // From the same end for both triangles of an edge, so that they meet exactly.
                let (p, q, t) = if sa < 0.0 { (a, b, sa / (sa - sb)) } else { (b, a, sb / (sb - sa)) };
                let mut position = p.position.lerp(q.position, t);
                position[self.axis] = at;
                kept.push(Vertex {
                    index: None,
                    position,
                    normal: p.normal.lerp(q.normal, t).normalize_or(p.normal),
                    uv: p.uv.lerp(q.uv, t),
                    tint: p.tint.lerp(q.tint, t),
                });
            }
        }
        kept
    }

    fn put(&mut self, vertex: &Vertex, by: f32, known: &mut HashMap<u32, u32>) -> u32 {
        if let Some(&index) = vertex.index.and_then(|i| known.get(&i)) {
            return index;
        }
        let index = self.to.positions.len() as u32;
        if let Some(own) = vertex.index {
            known.insert(own, index);
        }
        let mut position = vertex.position;
        position[self.axis] += by;
        self.to.positions.push(position);
        let carried = |all: usize| all > 0;
        if carried(self.mesh.normals.len()) {
            self.to.normals.push(vertex.normal);
        }
        if carried(self.mesh.uvs.len()) {
            self.to.uvs.push(vertex.uv);
        }
        if carried(self.mesh.tints.len()) {
            self.to.tints.push(vertex.tint);
        }
        index
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use trove_model::Kind;

    /// The volume within a closed mesh: the divergence theorem.
    fn volume_m3(mesh: &Mesh) -> f64 {
        let tetrahedron = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize].as_dvec3());
            a.dot(b.cross(c)) / 6.0
        };
        mesh.triangles.iter().map(tetrahedron).sum()
    }

    fn house() -> Asset {
        let mut house = testing::asset("house", Kind::Building, [20.0, 12.0, 10.0]);
        let sides = [[0, 1, 5], [0, 5, 4], [1, 3, 7], [1, 7, 5], [3, 2, 6], [3, 6, 7], [2, 0, 4], [2, 4, 6]];
        Arc::make_mut(&mut house.mesh).triangles.extend(sides);
        Asset { repeats: [Some([-2.0, 1.0]), None, Some([3.0, 6.0])], ..house }
    }

    #[test]
    fn a_model_grows_by_whole_bays_and_storeys_and_stays_closed() {
        let house = house();
        let bays = Bays::for_size(&house, house.size_m, DVec3::new(26.5, 30.0, 18.6));
        assert_eq!(bays, Bays([3, 1, 4]));
        assert_eq!(bays.more_m(&house), DVec3::new(6.0, 0.0, 9.0));
        let mesh = bays.mesh(&house);
        let (low, high) = mesh.bounds().unwrap();
        assert_eq!((low, high), (Vec3::new(-13.0, -6.0, 0.0), Vec3::new(13.0, 6.0, 19.0)));
        assert!((volume_m3(&mesh) - 26.0 * 12.0 * 19.0).abs() < 0.05, "{}", volume_m3(&mesh));
        assert_eq!(mesh.defect(), None);
    }

    #[test]
    fn what_begins_where_a_bay_ends_is_not_repeated_with_it() {
        let mut house = house();
        // A box on the roof, from the end of the bay on.
        let sheets: Vec<Mesh> = [0.0, 1.0]
            .iter()
            .map(|up| Mesh {
                positions: [[1.0, -2.0], [4.0, -2.0], [4.0, 2.0], [1.0, 2.0]]
                    .map(|[x, y]| Vec3::new(x, y, 10.0 + up))
                    .into(),
                triangles: if *up > 0.0 { vec![[0, 1, 2], [0, 2, 3]] } else { vec![[0, 2, 1], [0, 3, 2]] },
                ..Mesh::default()
            })
            .collect();
        let on_roof = Arc::make_mut(&mut house.mesh);
        let first = on_roof.positions.len() as u32;
        for sheet in &sheets {
            let from = on_roof.positions.len() as u32;
            on_roof.positions.extend(&sheet.positions);
            on_roof.triangles.extend(sheet.triangles.iter().map(|t| t.map(|i| i + from)));
        }
        for i in 0..4 {
            let [a, b] = [first + i, first + (i + 1) % 4];
            on_roof.triangles.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
        }
        let mesh = Bays([4, 1, 1]).mesh(&house);
        let expected = 29.0 * 12.0 * 10.0 + 3.0 * 4.0;
        assert!((volume_m3(&mesh) - expected).abs() < 0.05, "{}", volume_m3(&mesh));
        let ends = mesh.triangles.iter().filter(|t| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            (b - a).cross(c - a).normalize_or_zero().x < -0.9 && a.z > 9.9 && b.z > 9.9 && c.z > 9.9
        });
        assert_eq!(ends.count(), 2, "the box has one end");
    }

    #[test]
    fn a_model_that_is_large_enough_stays_as_it_is() {
        let house = house();
        let bays = Bays::for_size(&house, house.size_m, DVec3::new(8.0, 12.0, f64::NAN));
        assert_eq!(bays, Bays([1; 3]));
        assert_eq!(bays.mesh(&house), house.mesh);
    }

    #[test]
    fn windows_of_a_bay_come_again_with_their_texture() {
        let mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X * 3.0, Vec3::new(3.0, 0.0, 3.0)],
            uvs: vec![Vec2::ZERO, Vec2::X * 3.0, Vec2::splat(3.0)],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        let twice = repeated(&mesh, 0, [1.0, 2.0], 2);
        // Moved to the left by half of what was added; u goes on from the left, and again in the second bay.
        for (position, uv) in twice.positions.iter().zip(&twice.uvs) {
            let x = position.x + 0.5;
            assert!([x, x - 1.0].iter().any(|u| (u - uv.x).abs() < 1e-6), "{position} {uv}");
            assert!((position.z - uv.y).abs() < 1e-6);
        }
        assert!(twice.uvs.iter().filter(|uv| uv.x == 2.0).count() >= 2);
    }
}

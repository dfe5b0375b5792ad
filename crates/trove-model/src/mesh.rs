//! Triangles.

use glam::{Vec2, Vec3};

/// Triangles, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Mesh {
    /// Vertex positions, metres.
    #[cfg_attr(feature = "serde", serde(with = "crate::flat"))]
    pub positions: Vec<Vec3>,
    /// Unit shading normals, one a vertex; empty: every triangle is flat.
    #[cfg_attr(feature = "serde", serde(with = "crate::flat"))]
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one a vertex; empty: the mesh's materials have no maps. v runs up the picture.
    #[cfg_attr(feature = "serde", serde(with = "crate::flat"))]
    pub uvs: Vec<Vec2>,
    /// What the material's base colour is multiplied by, linear RGB from 0, one a vertex; empty: 1 everywhere.
    #[cfg_attr(feature = "serde", serde(with = "crate::flat"))]
    pub tints: Vec<Vec3>,
    /// Indices of vertices.
    #[cfg_attr(feature = "serde", serde(with = "crate::flat"))]
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle the slot of its material; empty: all in slot 0.
    #[cfg_attr(feature = "serde", serde(with = "crate::flat"))]
    pub slots: Vec<u16>,
}

impl Mesh {
    /// Smallest corner and largest corner; `None` without vertices.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let first = *self.positions.first()?;
        Some(self.positions.iter().fold((first, first), |(lo, hi), &p| (lo.min(p), hi.max(p))))
    }

    /// The slot of a triangle.
    pub fn slot(&self, triangle: usize) -> u16 {
        self.slots.get(triangle).copied().unwrap_or(0)
    }

    /// The number of slots that it needs (at least one).
    pub fn slot_count(&self) -> usize {
        self.slots.iter().map(|&s| usize::from(s) + 1).max().unwrap_or(1)
    }

    /// What is wrong with it; `None` where nothing is: lengths that do not match, indices that do not exist,
    /// numbers that are not finite.
    pub fn defect(&self) -> Option<String> {
        let n = self.positions.len();
        for (what, len) in [("normals", self.normals.len()), ("uvs", self.uvs.len()), ("tints", self.tints.len())] {
            if len != 0 && len != n {
                return Some(format!("{len} {what} for {n} positions"));
            }
        }
        if !self.slots.is_empty() && self.slots.len() != self.triangles.len() {
            return Some(format!("{} slots for {} triangles", self.slots.len(), self.triangles.len()));
        }
        if let Some(t) = self.triangles.iter().flatten().find(|&&i| i as usize >= n) {
            return Some(format!("index {t} of {n} positions"));
        }
        let finite = self.positions.iter().chain(&self.normals).all(|p| p.is_finite())
            && self.uvs.iter().all(|uv| uv.is_finite())
            && self.tints.iter().all(|tint| tint.is_finite());
        (!finite).then(|| "a number is not finite".into())
    }

    /// Adds another mesh, its slots moved up by `slot_offset`. Both have normals and uvs, or neither has, or the
    /// missing ones are filled with flat normals and zeros; missing tints are 1.
    pub fn append(&mut self, other: &Self, slot_offset: u16) {
        let base = self.positions.len() as u32;
        if self.slots.is_empty() {
            self.slots = vec![0; self.triangles.len()];
        }
        if !other.normals.is_empty() && self.normals.is_empty() {
            self.normals = self.flat_normals();
        }
        if !other.uvs.is_empty() && self.uvs.is_empty() {
            self.uvs = vec![Vec2::ZERO; self.positions.len()];
        }
        if !self.normals.is_empty() || (self.positions.is_empty() && !other.normals.is_empty()) {
            self.normals.extend(if other.normals.is_empty() { other.flat_normals() } else { other.normals.clone() });
        }
        if !self.uvs.is_empty() || (self.positions.is_empty() && !other.uvs.is_empty()) {
            let zeros = || vec![Vec2::ZERO; other.positions.len()];
            self.uvs.extend(if other.uvs.is_empty() { zeros() } else { other.uvs.clone() });
        }
        if !self.tints.is_empty() || !other.tints.is_empty() {
            self.tints.resize(self.positions.len(), Vec3::ONE);
            self.tints.extend(&other.tints);
            self.tints.resize(self.positions.len() + other.positions.len(), Vec3::ONE);
        }
        self.positions.extend(&other.positions);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + base)));
        self.slots.extend((0..other.triangles.len()).map(|t| other.slot(t) + slot_offset));
    }

    /// One normal a vertex, of some triangle at that vertex.
    fn flat_normals(&self) -> Vec<Vec3> {
        let mut normals = vec![Vec3::Z; self.positions.len()];
        for t in &self.triangles {
            let [a, b, c] = t.map(|i| self.positions[i as usize]);
            let n = (b - a).cross(c - a).try_normalize().unwrap_or(Vec3::Z);
            for &i in t {
                normals[i as usize] = n;
            }
        }
        normals
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Mesh {
        Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() }
    }

    #[test]
    fn appended_meshes_keep_their_slots_and_stay_sound() {
        let mut mesh = triangle();
        let smooth = Mesh { normals: vec![Vec3::Z; 3], uvs: vec![Vec2::ZERO; 3], ..triangle() };
        mesh.append(&smooth, 3);
        assert_eq!(mesh.defect(), None);
        assert_eq!((mesh.slot(0), mesh.slot(1), mesh.slot_count()), (0, 3, 4));
        assert_eq!(mesh.triangles[1], [3, 4, 5]);
        assert_eq!(mesh.normals.len(), 6);
    }

    #[test]
    fn tints_stay_with_their_vertices_and_others_become_white() {
        let mut mesh = triangle();
        mesh.append(&Mesh { tints: vec![Vec3::splat(0.5); 3], ..triangle() }, 0);
        mesh.append(&triangle(), 0);
        assert_eq!(mesh.defect(), None);
        assert_eq!([0, 3, 6].map(|i| mesh.tints[i].x), [1.0, 0.5, 1.0]);
    }

    #[test]
    fn a_mesh_with_a_dangling_index_is_defective() {
        let mesh = Mesh { triangles: vec![[0, 1, 3]], ..triangle() };
        assert!(mesh.defect().is_some());
    }
}

//! What every model format is read into.

use std::collections::BTreeMap;

use glam::{Mat3, Mat4, Vec2, Vec3};
use trove_model::{Material, Mesh, Outcome};

use super::fault::Fault;
use trove_files::{Budget, Exceeded};

/// More triangles than this are refused, whatever the file's size; fewer than this and more than
/// [`super::repair::BUDGET`] are thinned out.
const MOST_TRIANGLES: usize = 30_000_000;
/// Position, normal, texture coordinates and tint.
const VERTEX_BYTES: usize = 44;

/// A model in the axes and units of its file.
#[derive(Debug, Default)]
pub(super) struct Model {
    /// Posed and flattened: y up in files that say so.
    pub(super) mesh: Mesh,
    /// Material of each of the mesh's slots.
    pub(super) materials: Vec<Material>,
    /// Where the named pieces are.
    pub(super) marks: Vec<Mark>,
    /// Whether the format or the file says which way is up and how long a unit is: y and metres then.
    pub(super) declared: bool,
    /// What the file says of its licence and author.
    pub(super) licence: Option<String>,
    pub(super) author: Option<String>,
    pub(super) source: Option<String>,
    /// What was left out, replaced or is doubtful: what of which.
    pub(super) notices: Vec<(Outcome, &'static str, String)>,
}

/// A piece whose name may say which end is which.
#[derive(Clone, Debug)]
pub(super) struct Mark {
    /// Name of a node or of a material.
    pub(super) name: String,
    /// Mean of its vertices in the file's axes.
    pub(super) centre: Vec3,
}

/// A list of triangles with one material.
#[derive(Debug, Default)]
pub(super) struct Piece {
    pub(super) positions: Vec<Vec3>,
    /// As many as positions, or none.
    pub(super) normals: Vec<Vec3>,
    /// As many as positions, or none; v runs up the picture.
    pub(super) uvs: Vec<Vec2>,
    /// As many as positions, or none.
    pub(super) tints: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
}

const SIMPLIFY: &str = "simplify it: `gltfpack -i model.glb -o smaller.glb -si 0.01 -noq`";

/// More content than a file of its size has.
pub(super) fn too_large(place: &str, exceeded: Exceeded) -> Fault {
    Fault::new(place, exceeded.expected(), "more", SIMPLIFY)
}

impl Model {
    /// Notes something that was repaired, left out or replaced.
    pub(super) fn notice(&mut self, outcome: Outcome, what: &'static str, example: impl Into<String>) {
        self.notices.push((outcome, what, example.into()));
    }

    /// Adds triangles, moved by `file_from_piece`; what mirrors keeps its outside outside.
    pub(super) fn add(
        &mut self,
        name: &str,
        mut piece: Piece,
        file_from_piece: Mat4,
        slot: usize,
        two_sided_light: bool,
        budget: &Budget,
    ) -> Result<(), Fault> {
        // Before pieces are joined, or what is broken in one would lead into the next.
        let (corners, all) = (piece.positions.len() as u32, piece.triangles.len());
        piece.triangles.retain(|t| t.iter().all(|&i| i < corners));
        if piece.triangles.len() < all {
            let dropped = all - piece.triangles.len();
            self.notice(Outcome::Dropped, "triangles with invalid vertices were dropped", format!("{name}: {dropped}"));
        }
        let slot = u16::try_from(slot).map_err(|_| {
            Fault::new(name, "at most 65,535 materials", "more", "merge the model's materials in a 3D program")
        })?;
        for p in &mut piece.positions {
            *p = file_from_piece.transform_point3(*p);
        }
        // Normals follow the cofactors, whatever the scale; where it mirrors, corners change their order.
        let linear = Mat3::from_mat4(file_from_piece);
        let cofactors = Mat3::from_cols(
            linear.y_axis.cross(linear.z_axis),
            linear.z_axis.cross(linear.x_axis),
            linear.x_axis.cross(linear.y_axis),
        );
        let mirrored = linear.determinant() < 0.0;
        let sign = if mirrored { -1.0 } else { 1.0 };
        for n in &mut piece.normals {
            *n = (cofactors * *n * sign).normalize_or_zero();
        }
        if mirrored {
            piece.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        if two_sided_light {
            let n = piece.positions.len() as u32;
            let back: Vec<[u32; 3]> = piece.triangles.iter().map(|t| [t[0] + n, t[2] + n, t[1] + n]).collect();
            piece.positions.extend_from_within(..);
            piece.normals.extend_from_within(..);
            piece.uvs.extend_from_within(..);
            piece.tints.extend_from_within(..);
            piece.normals.iter_mut().skip(n as usize).for_each(|n| *n = -*n);
            piece.triangles.extend(back);
        }
        let all = self.mesh.triangles.len() + piece.triangles.len();
        if all > MOST_TRIANGLES {
            return Err(Fault::new(name, format!("at most {MOST_TRIANGLES} triangles"), format!("{all}"), SIMPLIFY));
        }
        budget.take(piece.positions.len(), VERTEX_BYTES).map_err(|e| too_large(name, e))?;
        budget.take(piece.triangles.len(), size_of::<[u32; 3]>()).map_err(|e| too_large(name, e))?;
        if !piece.positions.is_empty() {
            let centre = piece.positions.iter().fold(Vec3::ZERO, |sum, p| sum + *p) / piece.positions.len() as f32;
            self.marks.push(Mark { name: name.to_owned(), centre });
        }
        let Piece { positions, normals, uvs, tints, triangles } = piece;
        // A missing normal is zero until it is computed; `Mesh::append` would make flat ones.
        let normals = if normals.len() == positions.len() { normals } else { vec![Vec3::ZERO; positions.len()] };
        let uvs = if uvs.len() == positions.len() { uvs } else { vec![Vec2::ZERO; positions.len()] };
        self.mesh.append(&Mesh { positions, normals, uvs, tints, triangles, slots: Vec::new() }, slot);
        Ok(())
    }

    /// Adds where each material is to the marks, once all pieces are in.
    pub(super) fn mark_materials(&mut self) {
        let mut sums: BTreeMap<u16, (Vec3, f32)> = BTreeMap::new();
        for (t, triangle) in self.mesh.triangles.iter().enumerate() {
            let Some(&p) = self.mesh.positions.get(triangle[0] as usize) else { continue };
            let sum = sums.entry(self.mesh.slot(t)).or_default();
            *sum = (sum.0 + p, sum.1 + 1.0);
        }
        for (slot, (sum, count)) in sums {
            let name = self.materials.get(usize::from(slot)).map_or("", |m| m.name.as_str());
            self.marks.push(Mark { name: name.to_owned(), centre: sum / count });
        }
    }
}

//! What rays are traced among.

use glam::Affine3A;

use crate::pair::Pair;
use crate::sheared::Corners;

/// A mesh's triangles under their hierarchy.
#[derive(Clone, Copy)]
pub struct Mesh<'a> {
    /// At most [`DEPTH`](crate::DEPTH) from the root to a leaf.
    pub pairs: &'a [Pair],
    /// In the order of the leaves.
    pub corners: &'a [Corners],
    /// The hierarchy's first child.
    pub root: u32,
}

/// Meshes, each of them placed any number of times.
pub trait Tables {
    /// The hierarchy over the instances in World, at most [`DEPTH`](crate::DEPTH) deep, and its first child. Its leaves are
    /// of one place.
    fn top(&self) -> (&[Pair], u32);

    /// The instance at a place of the top hierarchy's leaves; its mesh has triangles.
    fn instance(&self, place: u32) -> u32;

    /// What an instance shows.
    fn mesh(&self, instance: u32) -> Mesh<'_>;

    /// Takes World to an instance's mesh at a ray's time.
    fn mesh_from_world(&self, instance: u32, time: f32) -> Affine3A;
}

//! One static part of the built place.

use std::sync::Arc;

use glam::DAffine3;
use trove_model::{Class, Kind, Material, Mesh};

/// A mesh that stands still: a surface of the street, a building.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// Shape; surfaces and extruded buildings are already in World, assets in their own frame.
    pub mesh: Arc<Mesh>,
    /// Identity for what is already in World.
    pub world_from_mesh: DAffine3,
    /// What its pixels are.
    pub class: Class,
    /// One a slot of the mesh.
    pub materials: Vec<Material>,
    /// What it is, for an object with an id of its own; `None` for stuff.
    pub kind: Option<Kind>,
    /// Id of the asset that stands for it; empty for what was built for this place.
    pub asset: Option<String>,
}

impl Piece {
    /// A surface that is no object of its own, in World.
    pub(crate) fn stuff(mesh: Mesh, class: Class, material: Material) -> Self {
        Self {
            mesh: Arc::new(mesh),
            world_from_mesh: DAffine3::IDENTITY,
            class,
            materials: vec![material],
            kind: None,
            asset: None,
        }
    }
}

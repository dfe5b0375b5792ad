//! How an actor is at a moment.

use glam::{DAffine3, DVec3};
use trove_model::{Cuboid, Keypoints, Posture};

use super::movement::Movement;
use super::postures::{Bend, Posed};

/// An actor at one moment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ActorPose {
    /// Placement of its mesh.
    pub world_from_mesh: DAffine3,
    /// Its box as placed.
    pub cuboid: Cuboid,
    /// Its shape.
    pub(super) posed: Posed,
    /// How far parts of it have moved.
    pub(super) bend: Bend,
    /// Index of its asset among the actor's.
    pub(super) asset: usize,
    /// Points of the person whom it shows, World.
    pub keypoints_world: Option<Keypoints<DVec3>>,
    /// What the person does whom it shows.
    pub posture: Option<Posture>,
    /// How it moves.
    pub movement: Movement,
}

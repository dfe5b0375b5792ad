//! The virtual scene: what is where, and how it is lit.

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};

use crate::{Class, Keypoints, Kind, Light, Material, Mesh, State};

/// An object's number, unique in a scene over all its keyframes and views; 0 is no object (stuff).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct InstanceId(pub u32);

/// Everything that a picture of one moment needs.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Shapes, shared by instances (and by the scenes of other moments).
    pub meshes: Vec<Arc<Mesh>>,
    /// Materials.
    pub materials: Vec<Material>,
    /// What stands where.
    pub instances: Vec<Instance>,
    /// Who is there at the previous keyframe, or at the next one, and not now: placed as then, and without neighbours.
    pub others: [Vec<Instance>; 2],
    /// From the previous keyframe to this one and from this one to the next, seconds, more than 0; infinite where there is
    /// none.
    pub keyframes_apart_s: [f64; 2],
    /// Sky.
    pub light: Light,
    /// Where it came from.
    pub provenance: Vec<Provenance>,
}

/// A mesh somewhere in World.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Number in the labels; 0 for stuff.
    pub id: InstanceId,
    /// What its pixels are.
    pub class: Class,
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Index into [`Scene::materials`] for each slot of the mesh.
    pub materials: Vec<usize>,
    /// Placement, with scale.
    pub world_from_mesh: DAffine3,
    /// Where and in which shape it was at the previous keyframe: the same for what stands still, `None` where it was not
    /// there.
    pub previous: Option<Placement>,
    /// The same at the next keyframe.
    pub next: Option<Placement>,
    /// What it is, for the frame's table; `None` for stuff.
    pub object: Option<Arc<SceneObject>>,
}

/// An instance at a neighbouring keyframe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Index into [`Scene::meshes`]: the same mesh, or one of the same triangles and slots, whose vertices are the same
    /// points of the thing, such as of a person in another posture.
    pub mesh: usize,
    /// Takes that mesh's points to World, with scale.
    pub world_from_mesh: DAffine3,
}

impl Instance {
    /// Where and in which shape it is now.
    pub fn now(&self) -> Placement {
        Placement { mesh: self.mesh, world_from_mesh: self.world_from_mesh }
    }

    /// The same instance, which stands still from the previous keyframe to the next.
    pub fn at_rest(self) -> Self {
        let now = Some(self.now());
        Self { previous: now, next: now, ..self }
    }
}

/// A countable thing.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneObject {
    /// What it is.
    pub kind: Kind,
    /// How it comes to be in the scene.
    pub origin: Origin,
    /// The asset's id; `None` for what was built for this place.
    pub asset: Option<String>,
    /// Its box as placed: the annotated size where there is one, else the mesh's.
    pub cuboid: crate::Cuboid,
    /// Velocity in World; `None` where unknown.
    pub velocity_mps: Option<DVec3>,
    /// How fast its heading turns, radians per second, to the left; `None` where unknown.
    pub yaw_rate_radps: Option<f64>,
    /// What it does, in the order of [`State::ALL`]; empty where nothing is known.
    pub states: Vec<State>,
    /// Its paint, linear RGB: the base colour of the largest of its parts that are painted one colour or another; `None`
    /// where there are none.
    pub paint: Option<Vec3>,
    /// Points of the person that it is or carries, World; `None` where they are not known.
    pub keypoints_world: Option<Keypoints<DVec3>>,
}

/// How an object comes to be in a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The dataset annotated it.
    Recorded {
        /// The dataset's token of its track.
        track_token: String,
        /// The dataset's token of the annotation at this moment.
        annotation_token: String,
        /// The dataset's category.
        category: String,
    },
    /// The vehicle that carried the cameras, which no dataset annotates.
    Carrier,
    /// A road user whom nobody recorded.
    Added,
    /// What stands still at its place: buildings, plants, street furniture.
    Scenery,
}

impl Origin {
    /// Its name in files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Recorded { .. } => "recorded",
            Self::Carrier => "carrier",
            Self::Added => "added",
            Self::Scenery => "scenery",
        }
    }

    /// The dataset's token of its track; `None` for what the dataset did not annotate.
    pub fn track_token(&self) -> Option<&str> {
        match self {
            Self::Recorded { track_token, .. } => Some(track_token),
            Self::Carrier | Self::Added | Self::Scenery => None,
        }
    }

    /// Whether it is a road user other than the vehicle that carried the cameras.
    pub fn is_road_user(&self) -> bool {
        matches!(self, Self::Recorded { .. } | Self::Added)
    }
}

/// A source and its licence.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Provenance {
    /// What (`nuscenes scene-0103`, `boston-seaport.osm`, `asset library procedural`).
    pub source: String,
    /// Under which licence.
    pub licence: String,
}

//! Where the point of a pixel is in the picture of a neighbouring keyframe.

use glam::{DAffine3, DVec2, DVec3};
use trove_model::{Camera, Lens, Pose, Shot, World};

use crate::PreparedScene;
use crate::prepare::PreparedInstance;

/// Flow that is not defined.
pub(super) const NONE: [f32; 2] = [f32::NAN; 2];

/// The next or the previous keyframe.
pub(super) struct Neighbour {
    lens: Lens,
    /// `None`: the camera has no such keyframe.
    camera_from_world: Option<Pose<Camera, World>>,
    /// By index of the instance.
    motions: Vec<Motion>,
}

/// Where an instance's points go.
enum Motion {
    Stays,
    /// Takes points of World now to points of World then.
    Moves(DAffine3),
    IsNotThere,
}

impl Neighbour {
    /// From the camera's pose and the instances' placements then.
    pub(super) fn new(
        scene: &PreparedScene,
        shot: &Shot,
        world_from_camera: Option<Pose<World, Camera>>,
        world_from_mesh: impl Fn(&PreparedInstance) -> Option<DAffine3>,
    ) -> Self {
        let motion = |instance: &PreparedInstance| match world_from_mesh(instance) {
            None => Motion::IsNotThere,
            Some(then) if then == instance.world_from_mesh.middle => Motion::Stays,
            Some(then) => Motion::Moves(then * instance.world_from_mesh.middle.inverse()),
        };
        let camera_from_world = world_from_camera.map(|pose| pose.inverse());
        Self { lens: shot.lens, camera_from_world, motions: scene.instances.iter().map(motion).collect() }
    }

    /// Pixels from `centre` to where the instance carries `point`.
    pub(super) fn flow(&self, centre: DVec2, instance: u32, point: DVec3) -> [f32; 2] {
        let then = match &self.motions[instance as usize] {
            Motion::Stays => point,
            Motion::Moves(then_from_now) => then_from_now.transform_point3(point),
            Motion::IsNotThere => return NONE,
        };
        self.camera_from_world.map_or(NONE, |camera| self.to(centre, camera.point(then)))
    }

    /// The same for a point infinitely far away, which only the camera's rotation moves.
    pub(super) fn flow_of_sky(&self, centre: DVec2, direction: DVec3) -> [f32; 2] {
        self.camera_from_world.map_or(NONE, |camera| self.to(centre, camera.vector(direction)))
    }

    fn to(&self, centre: DVec2, point_camera: DVec3) -> [f32; 2] {
        self.lens.project(point_camera).map_or(NONE, |pixel| (pixel - centre).as_vec2().to_array())
    }
}

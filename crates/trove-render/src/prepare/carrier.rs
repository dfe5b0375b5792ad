//! The object that carries a sensor: its rays pass through it, and through glass where labels tell what is behind.

use glam::{Affine3A, Vec3A};
use trove_model::{GlassLabels, InstanceId, Shot};

use super::PreparedScene;
use crate::motion::{MIDDLE, Motion};
use crate::ray::{Beside, Ray};

/// Rays that leave the carrier's box lower than this above its bottom may have met the ground in it.
const ABOVE_GROUND_M: f32 = 0.3;

/// What carries a sensor.
pub(crate) struct Carrier {
    id: Option<InstanceId>,
    around: Option<Around>,
    through_glass: bool,
}

/// Its box.
struct Around {
    /// The way of the box's coordinates.
    world_from_box: Motion,
    /// At the moment of the labels.
    box_from_world: Affine3A,
    low: Vec3A,
    high: Vec3A,
}

impl Around {
    fn box_from_world(&self, time: f32) -> Affine3A {
        if time == MIDDLE { self.box_from_world } else { self.world_from_box.at(time).inverse() }
    }
}

impl Carrier {
    pub(crate) fn new(scene: &PreparedScene, id: Option<InstanceId>) -> Self {
        Self::at(scene, None, id)
    }

    /// What carries the camera of a shot's labels, now or at a keyframe beside.
    pub(crate) fn of_labels(scene: &PreparedScene, beside: Option<Beside>, shot: &Shot) -> Self {
        let through_glass = shot.labels.glass == GlassLabels::Behind;
        Self { through_glass, ..Self::at(scene, beside, shot.carrier) }
    }

    fn at(scene: &PreparedScene, beside: Option<Beside>, id: Option<InstanceId>) -> Self {
        let id = id.filter(|id| id.0 != 0);
        let around = id.and_then(|id| {
            let mut parts = scene.all(beside).filter(|p| p.id == id).peekable();
            let world_from_box = parts.peek()?.world_from_mesh;
            let box_from_world = world_from_box.middle.inverse();
            let points = parts.flat_map(|p| {
                let box_from_mesh = box_from_world * p.at(MIDDLE).0;
                p.mesh.positions.iter().map(move |&p| box_from_mesh.transform_point3a(p.into()))
            });
            let empty = [Vec3A::INFINITY, Vec3A::NEG_INFINITY];
            let [low, high] = points.fold(empty, |[low, high], p| [low.min(p), high.max(p)]);
            Some(Around { world_from_box, box_from_world, low, high })
        });
        Self { id, around, through_glass: false }
    }

    /// The ray as it passes through the carrier: without its way there, as far as that can be known without tracing it.
    pub(crate) fn past(&self, ray: Ray) -> Ray {
        let ray = Ray { past: self.id, through_glass: self.through_glass, ..ray };
        let Some(around) = &self.around else { return ray };
        let (Around { low, high, .. }, box_from_world) = (around, around.box_from_world(ray.time));
        let origin = box_from_world.transform_point3a(ray.origin.into());
        if !(origin.cmpgt(*low) & origin.cmplt(*high)).all() {
            return ray;
        }
        let direction = box_from_world.transform_vector3a(ray.direction.into());
        let wall = Vec3A::select(direction.cmpge(Vec3A::ZERO), *high, *low);
        let t = ((wall - origin) / direction).min_element();
        let is_high = origin.z + t * direction.z > low.z + ABOVE_GROUND_M;
        Ray { t_min: if is_high && t > 0.0 { t * (1.0 - 1e-4) } else { ray.t_min }, ..ray }
    }
}

//! A scene made ready for rays: checked, its textures filtered, its acceleration structure built.

mod carrier;
mod check;

use std::sync::Arc;

use glam::{DAffine3, Vec3};
use trove_model::{Class, Scene, SceneObject};

use crate::RenderError;
use crate::accel::{Accel, Coherence, Kernel, Shapes};
use crate::light::{LastSurroundings, Lights};
use crate::material::PreparedMaterial;
use crate::motion::Motion;
use crate::placed::Placed;
use crate::ray::{Hit, Ray};
use crate::surface::Surface;
use crate::texture::Textures;

pub(crate) use carrier::Carrier;

/// A scene that can be rendered: from here on nothing can fail.
pub struct PreparedScene {
    pub(crate) shapes: Arc<Shapes>,
    pub(crate) instances: Vec<PreparedInstance>,
    pub(crate) materials: Vec<PreparedMaterial>,
    pub(crate) lights: Lights,
    accel: Box<dyn Accel>,
}

/// What labels tell of an instance.
pub(crate) struct PreparedInstance {
    pub(crate) class: Class,
    /// In the model's precision.
    pub(crate) world_from_mesh: Motion<DAffine3>,
    /// At the neighbouring keyframes, for flow.
    pub(crate) world_from_mesh_previous: Option<DAffine3>,
    pub(crate) world_from_mesh_next: Option<DAffine3>,
    /// What it is; `None` for stuff.
    pub(crate) object: Option<Arc<SceneObject>>,
}

impl PreparedScene {
    pub(crate) fn new(
        scene: &Scene,
        kernel: &dyn Kernel,
        textures: &Textures,
        last: &LastSurroundings,
    ) -> Result<Self, RenderError> {
        check::check(scene)?;
        textures.make_all(&scene.materials);
        let (materials, opacities) = scene.materials.iter().map(|m| PreparedMaterial::new(m, textures)).unzip();
        let instances: Vec<_> = scene.instances.iter().map(|i| PreparedInstance::new(scene, i)).collect();
        let feet_z: Vec<f32> = scene.meshes.iter().map(|m| m.bounds().map_or(0.0, |(low, _)| low.z)).collect();
        let place = |(i, prepared): (&trove_model::Instance, &PreparedInstance)| {
            let materials = i.materials.iter().map(|&m| m as u32).collect();
            Placed::new(i.id, scene.meshes[i.mesh].clone(), feet_z[i.mesh], materials, &prepared.world_from_mesh)
        };
        let placed = scene.instances.iter().zip(&instances).map(place).collect();
        let shapes = Arc::new(Shapes { placed, opacities });
        let (accel, lights) = rayon::join(|| kernel.build(&shapes), || Lights::new(scene, last));
        Ok(Self { shapes, instances, materials, lights, accel: accel? })
    }

    /// The shape of an instance.
    pub(crate) fn placed(&self, instance: u32) -> &Placed {
        &self.shapes.placed[instance as usize]
    }

    /// The nearest surfaces, as [`Accel::closest`] finds them.
    pub(crate) fn closest(&self, rays: &[Ray], coherence: Coherence, hits: &mut [Option<Hit>]) {
        self.accel.closest(rays, coherence, hits);
    }

    /// What passes of the light along rays, as [`Accel::any`] finds it.
    pub(crate) fn any(&self, rays: &[Ray], coherence: Coherence, light: &mut [Vec3]) {
        self.accel.any(rays, coherence, light);
    }

    /// Which of some rays meet an instance, if nothing else were there.
    pub(crate) fn meets(&self, instance: u32, rays: &[Ray]) -> Vec<bool> {
        let mut hits = vec![None; rays.len()];
        self.accel.closest_on(instance, rays, &mut hits);
        hits.iter().map(Option::is_some).collect()
    }

    /// The kernel, to be measured.
    pub(crate) fn accel(&self) -> &dyn Accel {
        &*self.accel
    }

    /// The surface at a ray's hit, and its material.
    pub(crate) fn surface(&self, hit: &Hit, ray: &Ray) -> (Surface, &PreparedMaterial) {
        let placed = self.placed(hit.instance);
        (Surface::new(placed, hit, ray), &self.materials[placed.material(hit)])
    }
}

impl PreparedInstance {
    fn new(scene: &Scene, instance: &trove_model::Instance) -> Self {
        let neighbours = [instance.world_from_mesh_previous, instance.world_from_mesh_next];
        Self {
            class: instance.class,
            world_from_mesh: Motion::new(instance.world_from_mesh, neighbours, scene.keyframes_apart_s),
            world_from_mesh_previous: instance.world_from_mesh_previous,
            world_from_mesh_next: instance.world_from_mesh_next,
            object: instance.object.clone(),
        }
    }
}

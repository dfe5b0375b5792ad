//! A scene made ready for rays: checked, its textures filtered, its acceleration structure built.

mod carrier;
mod check;
mod surface;

use std::sync::Arc;

use glam::{Affine3A, DAffine3, Mat3A, Vec3, Vec3A};
use trove_model::{Class, InstanceId, Mesh, Scene, SceneObject};

use crate::RenderError;
use crate::accel::{Accel, Hit, Kernel, MIDDLE, Motion, PACKET, Placed, Ray};
use crate::light::{LastSurroundings, Lights};
use crate::material::PreparedMaterial;
use crate::texture::Textures;

pub(crate) use carrier::Carrier;
pub(crate) use surface::Surface;

/// A scene that can be rendered: from here on nothing can fail.
pub struct PreparedScene {
    pub(crate) instances: Vec<PreparedInstance>,
    pub(crate) materials: Vec<PreparedMaterial>,
    pub(crate) lights: Lights,
    accel: Accel,
}

/// An instance in the renderer's precision.
pub(crate) struct PreparedInstance {
    pub(crate) id: InstanceId,
    pub(crate) class: Class,
    pub(crate) mesh: Arc<Mesh>,
    /// Lowest z of the mesh, its own metres.
    pub(crate) foot_z: f32,
    /// Index into the scene's materials for each slot.
    pub(crate) materials: Vec<u32>,
    world_from_mesh: Motion,
    /// As `world_from_normal` gives it at the moment of the labels.
    world_from_normal: Mat3A,
    /// For flow, in the model's precision.
    pub(crate) world_from_mesh_f64: DAffine3,
    pub(crate) world_from_mesh_previous: Option<DAffine3>,
    pub(crate) world_from_mesh_next: Option<DAffine3>,
    /// What it is; `None` for stuff.
    pub(crate) object: Option<Arc<SceneObject>>,
}

impl PreparedScene {
    pub(crate) fn new(
        scene: &Scene,
        kernel: &Kernel,
        textures: &Textures,
        last: &LastSurroundings,
    ) -> Result<Self, RenderError> {
        check::check(scene)?;
        textures.make_all(&scene.materials);
        let materials: Vec<_> = scene.materials.iter().map(|m| PreparedMaterial::new(m, textures)).collect();
        let feet_z: Vec<f32> = scene.meshes.iter().map(|m| m.bounds().map_or(0.0, |(low, _)| low.z)).collect();
        let instances: Vec<_> = scene.instances.iter().map(|i| PreparedInstance::new(scene, &feet_z, i)).collect();
        let placed: Vec<_> = instances
            .iter()
            .map(|i| Placed {
                mesh: i.mesh.clone(),
                world_from_mesh: i.world_from_mesh,
                tested: i
                    .materials
                    .iter()
                    .any(|&m| materials[m as usize].is_pane() || materials[m as usize].has_cutout()),
            })
            .collect();
        let (accel, lights) = rayon::join(|| kernel.build(&placed), || Lights::new(scene, last));
        Ok(Self { instances, materials, lights, accel })
    }

    /// The nearest surface; cut-out holes are not there.
    pub(crate) fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.accel.intersect(ray, &mut |_, hit| self.is_there(hit))
    }

    /// The same as if the carrier were not there.
    pub(crate) fn intersect_past(&self, ray: &Ray, carrier: &Carrier) -> Option<Hit> {
        let mut ray = *ray;
        loop {
            let hit = self.intersect(&ray)?;
            if !carrier.is_hit(self, &hit) {
                return Some(hit);
            }
            ray.t_min = hit.t * (1.0 + 1e-6) + 1e-6;
        }
    }

    /// The nearest surface of one instance, as if nothing else were there.
    pub(crate) fn intersect_instance(&self, ray: &Ray, instance: u32) -> Option<Hit> {
        self.accel.intersect_instance(ray, instance, &mut |_, hit| self.is_there(hit))
    }

    /// The nearest surfaces of rays that run alike, as if the carrier were not there.
    pub(crate) fn intersect_packet(&self, rays: &[Ray], carrier: &Carrier, hits: &mut [Option<Hit>; PACKET]) {
        self.accel.intersect_packet(rays, hits, &mut |_, hit| self.is_there(hit));
        for (ray, hit) in rays.iter().zip(hits) {
            if hit.is_some_and(|h| carrier.is_hit(self, &h)) {
                *hit = self.intersect_past(ray, carrier);
            }
        }
    }

    /// What passes along rays that run alike: light is multiplied by 0 behind anything opaque, tinted behind thin glass.
    pub(crate) fn shade_packet(&self, rays: &[Ray], light: &mut [Vec3]) {
        let mut blocked = [false; PACKET];
        self.accel.occluded_packet(rays, &mut blocked, &mut |lane, hit| {
            self.is_there(hit) && {
                light[lane] *= self.straight_through(hit, &rays[lane]);
                light[lane] == Vec3::ZERO
            }
        });
        for (light, blocked) in light.iter_mut().zip(blocked) {
            if blocked {
                *light = Vec3::ZERO;
            }
        }
    }

    /// The nearest triangle, with nothing asked.
    pub(crate) fn intersect_bare(&self, ray: &Ray) -> Option<Hit> {
        self.accel.intersect_bare(ray)
    }

    /// Whether a ray meets any triangle, with nothing asked.
    pub(crate) fn is_blocked_bare(&self, ray: &Ray) -> bool {
        self.accel.occluded_bare(ray)
    }

    /// The share of light that passes along a ray: 0 behind anything opaque, tinted behind thin glass.
    pub(crate) fn transmittance(&self, ray: &Ray) -> Vec3 {
        let mut share = Vec3::ONE;
        let blocked = self.accel.occluded(ray, &mut |_, hit| {
            self.is_there(hit) && {
                share *= self.straight_through(hit, ray);
                share == Vec3::ZERO
            }
        });
        if blocked { Vec3::ZERO } else { share }
    }

    /// The share of light that a surface lets straight through.
    fn straight_through(&self, hit: &Hit, ray: &Ray) -> Vec3 {
        let material = self.material_of(hit);
        if !material.is_pane() {
            return Vec3::ZERO;
        }
        material.straight_through(self.geometric_normal(hit, ray.time).dot(ray.direction))
    }

    /// Material at a hit.
    pub(crate) fn material_of(&self, hit: &Hit) -> &PreparedMaterial {
        let instance = &self.instances[hit.instance as usize];
        let slot = instance.mesh.slot(hit.triangle as usize);
        &self.materials[instance.materials[usize::from(slot)] as usize]
    }

    /// Unit normal of the triangle in World at a ray's time, on the side from which its corners run counter-clockwise.
    fn geometric_normal(&self, hit: &Hit, time: f32) -> Vec3 {
        let instance = &self.instances[hit.instance as usize];
        let [a, b, c] = instance.mesh.triangles[hit.triangle as usize].map(|i| instance.mesh.positions[i as usize]);
        let normal_mesh = (b - a).cross(c - a);
        let (_, world_from_normal) = instance.at(time);
        (world_from_normal * Vec3A::from(normal_mesh)).normalize_or(Vec3A::Z).into()
    }

    fn is_there(&self, hit: &Hit) -> bool {
        let material = self.material_of(hit);
        !material.has_cutout() || material.covers(surface::uv(&self.instances[hit.instance as usize].mesh, hit))
    }
}

impl PreparedInstance {
    fn new(scene: &Scene, feet_z: &[f32], instance: &trove_model::Instance) -> Self {
        let m = instance.world_from_mesh;
        let neighbours = [instance.world_from_mesh_previous, instance.world_from_mesh_next];
        let world_from_mesh = Motion::new(m, neighbours, scene.keyframes_apart_s);
        // Here in the model's precision.
        let cofactor = m.matrix3.inverse().transpose() * m.matrix3.determinant().signum();
        Self {
            id: instance.id,
            class: instance.class,
            mesh: scene.meshes[instance.mesh].clone(),
            foot_z: feet_z[instance.mesh],
            materials: instance.materials.iter().map(|&m| m as u32).collect(),
            world_from_mesh,
            world_from_normal: Mat3A::from_cols(
                cofactor.x_axis.as_vec3a(),
                cofactor.y_axis.as_vec3a(),
                cofactor.z_axis.as_vec3a(),
            ),
            world_from_mesh_f64: m,
            world_from_mesh_previous: instance.world_from_mesh_previous,
            world_from_mesh_next: instance.world_from_mesh_next,
            object: instance.object.clone(),
        }
    }

    /// Takes the mesh's points to World at a ray's time, and its normals: the inverse transpose, not normalised, turned so
    /// that outside stays outside.
    pub(crate) fn at(&self, time: f32) -> (Affine3A, Mat3A) {
        if self.world_from_mesh.ends.is_none() || time == MIDDLE {
            return (self.world_from_mesh.middle, self.world_from_normal);
        }
        let m = self.world_from_mesh.at(time);
        (m, m.matrix3.inverse().transpose() * m.matrix3.determinant().signum())
    }
}

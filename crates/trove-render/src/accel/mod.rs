//! Which surface a ray meets: one interface over the kernels.
//!
//! A kernel finds (instance, triangle, u, v); everything else about the hit is derived elsewhere, from the mesh, so
//! that all kernels shade alike.

mod embree;
mod embree_api;
mod motion;
mod obvhs;
mod watertight;

use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec3;
use trove_model::Mesh;

use crate::RenderError;

pub(crate) use motion::{MIDDLE, Motion, ray_time};

/// Which ray-tracing kernel to use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KernelChoice {
    /// Embree where it is installed, else the built-in one.
    #[default]
    Auto,
    /// Embree 4, loaded at run time; an error where it is missing.
    Embree,
    /// The built-in kernel: the same bytes on every machine.
    Obvhs,
}

/// A ray in World; distances are in lengths of `direction`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    pub(crate) origin: Vec3,
    pub(crate) direction: Vec3,
    pub(crate) t_min: f32,
    pub(crate) t_max: f32,
    /// As `ray_time` gives it.
    pub(crate) time: f32,
}

impl Ray {
    /// From a point to infinity, at the moment of the labels.
    pub(crate) fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, t_min: 0.0, t_max: f32::INFINITY, time: MIDDLE }
    }

    /// Another ray of the same time, to infinity.
    pub(crate) fn then(&self, origin: Vec3, direction: Vec3) -> Self {
        Self { time: self.time, ..Self::new(origin, direction) }
    }
}

/// Where a ray meets a triangle: the point is (1 − u − v)·a + u·b + v·c.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hit {
    pub(crate) t: f32,
    /// Index into the scene's instances.
    pub(crate) instance: u32,
    /// Index into the mesh's triangles.
    pub(crate) triangle: u32,
    pub(crate) u: f32,
    pub(crate) v: f32,
}

/// Decides whether a hit on a tested instance counts, given the index of the ray among those traced together; called in
/// no particular order, perhaps twice for one hit.
pub(crate) type Accept<'a> = &'a mut dyn FnMut(usize, &Hit) -> bool;

/// Most rays that are traced together.
pub(crate) const PACKET: usize = 16;

/// What the kernel must know of an instance.
#[derive(Clone)]
pub(crate) struct Placed {
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) world_from_mesh: Motion,
    /// Its hits are put to `accept`; hits on others always count.
    pub(crate) tested: bool,
}

/// A kernel without a scene; it remembers what it built of every mesh.
pub(crate) enum Kernel {
    Embree(embree::Kernel),
    Obvhs(obvhs::Kernel),
}

/// A kernel's two-level scene.
pub(crate) enum Accel {
    Embree(embree::Accel),
    Obvhs(obvhs::Accel),
}

impl Kernel {
    /// The chosen kernel; `search` are folders or files in which to look for Embree.
    pub(crate) fn new(choice: KernelChoice, search: &[PathBuf]) -> Result<Self, RenderError> {
        let embree = || embree::Kernel::load(search).map(Self::Embree);
        match choice {
            KernelChoice::Obvhs => Ok(Self::Obvhs(obvhs::Kernel::default())),
            KernelChoice::Embree => embree(),
            KernelChoice::Auto => embree().or_else(|problem| {
                tracing::info!(%problem, "using the built-in kernel");
                Ok(Self::Obvhs(obvhs::Kernel::default()))
            }),
        }
    }

    /// Name and version, for people.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Embree(kernel) => kernel.name(),
            Self::Obvhs(_) => "obvhs 0.4 (built in)".into(),
        }
    }

    /// Builds the two-level scene; the order of `placed` gives the instances' indices.
    pub(crate) fn build(&self, placed: &[Placed]) -> Accel {
        match self {
            Self::Embree(kernel) => Accel::Embree(kernel.build(placed)),
            Self::Obvhs(kernel) => Accel::Obvhs(kernel.build(placed)),
        }
    }
}

impl Accel {
    /// The nearest hit that counts.
    pub(crate) fn intersect(&self, ray: &Ray, accept: Accept<'_>) -> Option<Hit> {
        match self {
            Self::Embree(accel) => accel.intersect(ray, accept),
            Self::Obvhs(accel) => accel.intersect(ray, accept),
        }
    }

    /// The nearest hit if all count: the kernel as its makers deliver it, to measure against.
    pub(crate) fn intersect_bare(&self, ray: &Ray) -> Option<Hit> {
        match self {
            Self::Embree(accel) => accel.intersect_bare(ray),
            Self::Obvhs(accel) => accel.intersect(ray, &mut |_, _| true),
        }
    }

    /// Whether there is any hit if all count.
    pub(crate) fn occluded_bare(&self, ray: &Ray) -> bool {
        match self {
            Self::Embree(accel) => accel.occluded_bare(ray),
            Self::Obvhs(accel) => accel.occluded(ray, &mut |_, _| true),
        }
    }

    /// The nearest hits of up to [`PACKET`] rays that start and run alike, in `hits`.
    pub(crate) fn intersect_packet(&self, rays: &[Ray], hits: &mut [Option<Hit>; PACKET], accept: Accept<'_>) {
        match self {
            Self::Embree(accel) => accel.intersect_packet(rays, hits, accept),
            Self::Obvhs(accel) => {
                for (lane, (ray, hit)) in rays.iter().zip(hits).enumerate() {
                    *hit = accel.intersect(ray, &mut |_, hit| accept(lane, hit));
                }
            }
        }
    }

    /// Whether any hit counts, for each of up to [`PACKET`] rays that run alike, in `occluded`.
    pub(crate) fn occluded_packet(&self, rays: &[Ray], occluded: &mut [bool; PACKET], accept: Accept<'_>) {
        match self {
            Self::Embree(accel) => accel.occluded_packet(rays, occluded, accept),
            Self::Obvhs(accel) => {
                for (lane, (ray, occluded)) in rays.iter().zip(occluded).enumerate() {
                    *occluded = accel.occluded(ray, &mut |_, hit| accept(lane, hit));
                }
            }
        }
    }

    /// Whether any hit counts.
    pub(crate) fn occluded(&self, ray: &Ray, accept: Accept<'_>) -> bool {
        match self {
            Self::Embree(accel) => accel.occluded(ray, accept),
            Self::Obvhs(accel) => accel.occluded(ray, accept),
        }
    }

    /// The nearest hit that counts on one instance, as if nothing else were there, at the moment of the labels.
    pub(crate) fn intersect_instance(&self, ray: &Ray, instance: u32, accept: Accept<'_>) -> Option<Hit> {
        match self {
            Self::Embree(accel) => accel.intersect_instance(ray, instance, accept),
            Self::Obvhs(accel) => accel.intersect_instance(ray, instance, accept),
        }
    }
}

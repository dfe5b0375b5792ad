//! The built-in kernel: obvhs's binary hierarchy over instances, and one over each mesh's triangles.

use std::sync::Arc;
use std::time::Duration;

use glam::{Affine3A, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::{build_bvh2, build_bvh2_from_tris};
use obvhs::ray::RayHit;
use obvhs::triangle::Triangle;
use trove_model::Mesh;

use super::kernel::{Accel, Coherence, Kernel};
use super::shapes::Shapes;
use super::watertight::Sheared;
use crate::RenderError;
use crate::cache::Cache;
use crate::motion::MIDDLE;
use crate::placed::Placed;
use crate::ray::{Hit, Ray};

/// What was built of the meshes so far.
#[derive(Default)]
pub(super) struct Obvhs {
    built: Cache<Mesh, Bottom>,
}

/// A mesh's hierarchy with its triangles in the order of the leaves.
struct Bottom {
    bvh: Bvh2,
    triangles: Vec<[Vec3; 3]>,
}

/// A mesh's hierarchy where it stands.
pub(super) struct Top {
    bottom: Arc<Bottom>,
    /// At the moment of the labels.
    mesh_from_world: Affine3A,
    judged: bool,
}

/// A two-level scene.
struct Scene {
    shapes: Arc<Shapes>,
    bvh: Bvh2,
    /// By index of the instance.
    tops: Vec<Top>,
}

impl Kernel for Obvhs {
    fn name(&self) -> String {
        "obvhs 0.4 (built in)".into()
    }

    fn is_same_everywhere(&self) -> bool {
        true
    }

    fn build(&self, shapes: &Arc<Shapes>) -> Result<Box<dyn Accel>, RenderError> {
        let placed = &shapes.placed;
        self.built.make_all(placed.iter().map(|p| &p.mesh), Bottom::new);
        let top = |p: &Placed| Top::new(shapes, p, self.built.get(&p.mesh, Bottom::new));
        let tops: Vec<Top> = placed.iter().map(top).collect();
        let boxes: Vec<Aabb> = placed.iter().map(box_world).collect();
        let bvh = build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut Duration::default());
        Ok(Box::new(Scene { shapes: shapes.clone(), bvh, tops }))
    }
}

/// Box around a placed mesh wherever it moves; an empty mesh gets an empty box, which no ray meets.
fn box_world(placed: &Placed) -> Aabb {
    let at = |m: Affine3A| placed.mesh.positions.iter().map(move |&p| m.transform_point3a(p.into()));
    let points = placed.world_from_mesh.corners().flat_map(at);
    let mut bounds: Option<Aabb> = None;
    for p in points {
        bounds.get_or_insert(Aabb::from_point(p)).extend(p);
    }
    // A hair larger, because rays are moved to the mesh's coordinates and triangles are not moved to World.
    bounds.map_or(Aabb::new(Vec3A::ZERO, Vec3A::ZERO), |b| {
        let margin = (b.max.abs().max(b.min.abs()) * 1e-6).max(Vec3A::splat(1e-6));
        Aabb::new(b.min - margin, b.max + margin)
    })
}

impl Bottom {
    fn new(mesh: &Mesh) -> Self {
        let corners = |t: &[u32; 3]| t.map(|i| mesh.positions[i as usize]);
        let all: Vec<[Vec3; 3]> = mesh.triangles.iter().map(corners).collect();
        let boxed: Vec<_> =
            all.iter().map(|&[a, b, c]| Triangle { v0: a.into(), v1: b.into(), v2: c.into() }).collect();
        let bvh = build_bvh2_from_tris(&boxed, BvhBuildParams::medium_build(), &mut Duration::default());
        let triangles = bvh.primitive_indices.iter().map(|&i| all[i as usize]).collect();
        Self { bvh, triangles }
    }
}

impl Top {
    fn new(shapes: &Shapes, placed: &Placed, bottom: Arc<Bottom>) -> Self {
        Self { bottom, mesh_from_world: placed.world_from_mesh.middle.inverse(), judged: shapes.lets_pass(placed) }
    }

    /// Of one instance that nobody has built anything for.
    pub(super) fn alone(shapes: &Shapes, instance: u32) -> Self {
        let placed = &shapes.placed[instance as usize];
        Self::new(shapes, placed, Arc::new(Bottom::new(&placed.mesh)))
    }

    /// The nearest hit that is no hole.
    pub(super) fn closest(&self, shapes: &Shapes, ray: &Ray, instance: u32) -> Option<Hit> {
        let is_seen = &mut |hit: &Hit| shapes.is_seen(hit, ray.through_glass);
        self.intersect(shapes, ray, instance, ray.t_max, false, is_seen)
    }

    /// The nearest hit before `t_max`; `stop_at_any` ends at the first that counts.
    fn intersect(
        &self,
        shapes: &Shapes,
        ray: &Ray,
        instance: u32,
        t_max: f32,
        stop_at_any: bool,
        counts: &mut impl FnMut(&Hit) -> bool,
    ) -> Option<Hit> {
        if self.bottom.triangles.is_empty() {
            return None;
        }
        let motion = &shapes.placed[instance as usize].world_from_mesh;
        let moved = motion.ends.is_some() && ray.time != MIDDLE;
        let mesh_from_world = if moved { motion.at(ray.time).inverse() } else { self.mesh_from_world };
        let origin = mesh_from_world.transform_point3(ray.origin);
        let direction = mesh_from_world.transform_vector3(ray.direction);
        let sheared = Sheared::new(origin, direction);
        let mut nearest: Option<Hit> = None;
        let mut meet = |ray: &obvhs::ray::Ray, index: usize| {
            let Some((t, u, v)) = sheared.intersect(&self.bottom.triangles[index], ray.tmin, ray.tmax) else {
                return f32::INFINITY;
            };
            let hit = Hit { t, instance, triangle: self.bottom.bvh.primitive_indices[index], u, v };
            if self.judged && !counts(&hit) {
                return f32::INFINITY;
            }
            nearest = Some(hit);
            t
        };
        let local = obvhs::ray::Ray::new(origin.into(), direction.into(), ray.t_min, t_max);
        if stop_at_any {
            self.bottom.bvh.ray_traverse_miss(local, &mut meet);
        } else {
            self.bottom.bvh.ray_traverse(local, &mut RayHit::none(), &mut meet);
        }
        nearest
    }
}

impl Scene {
    /// The nearest hit that counts, on an instance that does.
    fn intersect(&self, ray: &Ray, enters: impl Fn(u32) -> bool, mut counts: impl FnMut(&Hit) -> bool) -> Option<Hit> {
        let mut nearest = None;
        let meet = |world: &obvhs::ray::Ray, index: usize| {
            let instance = self.bvh.primitive_indices[index];
            if !enters(instance) {
                return f32::INFINITY;
            }
            let top = &self.tops[instance as usize];
            let hit = top.intersect(&self.shapes, ray, instance, world.tmax, false, &mut counts);
            let t = hit.map_or(f32::INFINITY, |hit| hit.t);
            nearest = hit.or(nearest);
            t
        };
        self.bvh.ray_traverse(in_world(ray), &mut RayHit::none(), meet);
        nearest
    }

    fn is_blocked(&self, ray: &Ray, enters: impl Fn(u32) -> bool, mut counts: impl FnMut(&Hit) -> bool) -> bool {
        let meet = |_: &obvhs::ray::Ray, index: usize| {
            let instance = self.bvh.primitive_indices[index];
            if !enters(instance) {
                return f32::INFINITY;
            }
            let top = &self.tops[instance as usize];
            let hit = top.intersect(&self.shapes, ray, instance, ray.t_max, true, &mut counts);
            hit.map_or(f32::INFINITY, |hit| hit.t)
        };
        !self.bvh.ray_traverse_miss(in_world(ray), meet)
    }
}

/// Rays are traced one by one, coherent or not.
impl Accel for Scene {
    fn closest(&self, rays: &[Ray], _: Coherence, hits: &mut [Option<Hit>]) {
        let shapes = &self.shapes;
        for (ray, hit) in rays.iter().zip(hits) {
            let enters = |instance| !shapes.is_passed(ray, instance);
            *hit = self.intersect(ray, enters, |hit| shapes.is_seen(hit, ray.through_glass));
        }
    }

    fn blocked(&self, rays: &[Ray], _: Coherence, blocked: &mut [bool]) {
        let shapes = &self.shapes;
        for (ray, blocked) in rays.iter().zip(blocked) {
            let enters = |instance| !shapes.is_passed(ray, instance);
            *blocked = self.is_blocked(ray, enters, |hit| shapes.is_seen(hit, ray.through_glass));
        }
    }

    fn any(&self, rays: &[Ray], _: Coherence, light: &mut [Vec3]) {
        for (ray, light) in rays.iter().zip(light) {
            if self.is_blocked(ray, |_| true, |hit| self.shapes.blocks(hit, ray, light)) {
                *light = Vec3::ZERO;
            }
        }
    }

    fn closest_on(&self, instance: u32, rays: &[Ray], hits: &mut [Option<Hit>]) {
        let top = &self.tops[instance as usize];
        rays.iter().zip(hits).for_each(|(ray, hit)| *hit = top.closest(&self.shapes, ray, instance));
    }

    fn bare_closest(&self, rays: &[Ray]) -> usize {
        rays.iter().filter(|ray| self.intersect(ray, |_| true, |_| true).is_some()).count()
    }

    fn bare_any(&self, rays: &[Ray]) -> usize {
        rays.iter().filter(|ray| self.is_blocked(ray, |_| true, |_| true)).count()
    }
}

fn in_world(ray: &Ray) -> obvhs::ray::Ray {
    obvhs::ray::Ray::new(ray.origin.into(), ray.direction.into(), ray.t_min, ray.t_max)
}

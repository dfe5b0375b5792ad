//! The built-in kernel: obvhs's hierarchies, one over instances and one over each mesh's triangles, traced through by
//! `trove_trace`.

use std::sync::Arc;

use glam::{Affine3A, Vec3, Vec3A};
use obvhs::aabb::Aabb;
use trove_model::Mesh;
use trove_trace::{Corners, Pair, Tables};

use super::hierarchy::Hierarchy;
use super::kernel::{Accel, Coherence, Kernel};
use super::shapes::Shapes;
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
pub(super) struct Bottom {
    pub(super) pairs: Vec<Pair>,
    pub(super) corners: Vec<Corners>,
    pub(super) root: u32,
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
    /// Over the boxes of instances, whose indices are in the order of the leaves; `None` where nothing is.
    over: Option<Hierarchy>,
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
        Ok(Box::new(Scene { shapes: shapes.clone(), over: over(placed), tops }))
    }
}

/// The hierarchy over all instances that have triangles, whose indices are its order; `None` without any.
pub(super) fn over(placed: &[Placed]) -> Option<Hierarchy> {
    let (boxed, boxes): (Vec<u32>, Vec<Aabb>) = (0..).zip(placed).filter_map(|(i, p)| Some((i, box_world(p)?))).unzip();
    (!boxes.is_empty()).then(|| {
        let mut over = Hierarchy::over_boxes(&boxes);
        over.order.iter_mut().for_each(|place| *place = boxed[*place as usize]);
        over
    })
}

/// Box around a placed mesh wherever it moves; `None` without triangles.
fn box_world(placed: &Placed) -> Option<Aabb> {
    if placed.mesh.triangles.is_empty() {
        return None;
    }
    let at = |m: Affine3A| placed.mesh.positions.iter().map(move |&p| m.transform_point3a(p.into()));
    let points = placed.world_from_mesh.corners().flat_map(at);
    let mut bounds: Option<Aabb> = None;
    for p in points {
        bounds.get_or_insert(Aabb::from_point(p)).extend(p);
    }
    // A hair larger, because rays are moved to the mesh's coordinates and triangles are not moved to World.
    bounds.map(|b| {
        let margin = (b.max.abs().max(b.min.abs()) * 1e-6).max(Vec3A::splat(1e-6));
        Aabb::new(b.min - margin, b.max + margin)
    })
}

impl Bottom {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let corners = |t: &[u32; 3]| t.map(|i| mesh.positions[i as usize]);
        let all: Vec<[Vec3; 3]> = mesh.triangles.iter().map(corners).collect();
        if all.is_empty() {
            return Self { pairs: Vec::new(), corners: Vec::new(), root: 0 };
        }
        let Hierarchy { pairs, root, order } = Hierarchy::over_triangles(&all);
        Self { pairs, corners: order.iter().map(|&i| Corners::new(all[i as usize], i)).collect(), root }
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
        if self.bottom.corners.is_empty() {
            return None;
        }
        let one = One { top: self, placed: &shapes.placed[instance as usize] };
        let is_seen = |hit: &Hit| !self.judged || shapes.is_seen(hit, ray.through_glass);
        trove_trace::closest_on(&one, &ray.plain(), instance, is_seen)
    }

    fn mesh(&self) -> trove_trace::Mesh<'_> {
        let Bottom { pairs, corners, root } = &*self.bottom;
        trove_trace::Mesh { pairs, corners, root: *root }
    }

    /// At a ray's time, as `placed` moves.
    fn mesh_from_world(&self, placed: &Placed, time: f32) -> Affine3A {
        let motion = &placed.world_from_mesh;
        let moved = motion.ends.is_some() && time != MIDDLE;
        if moved { motion.at(time).inverse() } else { self.mesh_from_world }
    }
}

/// One instance without a hierarchy over it.
struct One<'a> {
    top: &'a Top,
    placed: &'a Placed,
}

impl Tables for One<'_> {
    fn top(&self) -> (&[Pair], u32) {
        (&[], 0)
    }

    fn instance(&self, place: u32) -> u32 {
        place
    }

    fn mesh(&self, _: u32) -> trove_trace::Mesh<'_> {
        self.top.mesh()
    }

    fn mesh_from_world(&self, _: u32, time: f32) -> Affine3A {
        self.top.mesh_from_world(self.placed, time)
    }
}

/// A scene in which something is.
struct All<'a> {
    scene: &'a Scene,
    over: &'a Hierarchy,
}

impl Tables for All<'_> {
    #[inline(always)]
    fn top(&self) -> (&[Pair], u32) {
        (&self.over.pairs, self.over.root)
    }

    #[inline(always)]
    fn instance(&self, place: u32) -> u32 {
        self.over.order[place as usize]
    }

    #[inline(always)]
    fn mesh(&self, instance: u32) -> trove_trace::Mesh<'_> {
        self.scene.tops[instance as usize].mesh()
    }

    #[inline(always)]
    fn mesh_from_world(&self, instance: u32, time: f32) -> Affine3A {
        self.scene.tops[instance as usize].mesh_from_world(&self.scene.shapes.placed[instance as usize], time)
    }
}

impl Scene {
    fn all(&self) -> Option<All<'_>> {
        self.over.as_ref().map(|over| All { scene: self, over })
    }

    /// The nearest hit that counts, on an instance that does.
    fn nearest(&self, ray: &Ray, enters: impl Fn(u32) -> bool, counts: impl Fn(&Hit) -> bool) -> Option<Hit> {
        let counts = |hit: &Hit| !self.tops[hit.instance as usize].judged || counts(hit);
        trove_trace::closest(&self.all()?, &ray.plain(), enters, counts)
    }

    fn is_blocked(&self, ray: &Ray, enters: impl Fn(u32) -> bool, mut counts: impl FnMut(&Hit) -> bool) -> bool {
        let counts = |hit: &Hit| !self.tops[hit.instance as usize].judged || counts(hit);
        self.all().is_some_and(|all| trove_trace::any(&all, &ray.plain(), enters, counts).is_some())
    }
}

/// Rays are traced one by one, coherent or not.
impl Accel for Scene {
    fn closest(&self, rays: &[Ray], _: Coherence, hits: &mut [Option<Hit>]) {
        let shapes = &self.shapes;
        for (ray, hit) in rays.iter().zip(hits) {
            let enters = |instance| !shapes.is_passed(ray, instance);
            *hit = self.nearest(ray, enters, |hit| shapes.is_seen(hit, ray.through_glass));
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
        rays.iter().filter(|ray| self.nearest(ray, |_| true, |_| true).is_some()).count()
    }

    fn bare_any(&self, rays: &[Ray]) -> usize {
        rays.iter().filter(|ray| self.is_blocked(ray, |_| true, |_| true)).count()
    }
}

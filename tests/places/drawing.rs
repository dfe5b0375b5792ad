//! A place drawn with parallel rays: everything that each ray meets, in order.

use glam::{DVec2, DVec3};
use trove_model::{Bounds, Class, Scene};

/// A triangle of a scene in World.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    pub(crate) corners: [DVec3; 3],
    /// Index into the scene's instances.
    pub(crate) instance: usize,
    /// Index into the scene's materials.
    pub(crate) material: usize,
}

impl Triangle {
    /// Unit, out of the front.
    pub(crate) fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a).normalize_or_zero()
    }
}

/// The triangles of the instances that are wanted.
pub(crate) fn triangles(scene: &Scene, wanted: impl Fn(usize) -> bool) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for (index, instance) in scene.instances.iter().enumerate().filter(|(i, _)| wanted(*i)) {
        let mesh = &scene.meshes[instance.mesh];
        for (i, t) in mesh.triangles.iter().enumerate() {
            let corner = |i: u32| instance.world_from_mesh.transform_point3(mesh.positions[i as usize].as_dvec3());
            let material = instance.materials[usize::from(mesh.slot(i))];
            triangles.push(Triangle { corners: t.map(corner), instance: index, material });
        }
    }
    triangles
}

/// Whether an instance is part of the built place: what lies on the ground, and buildings.
pub(crate) fn is_built(scene: &Scene, index: usize) -> bool {
    let instance = &scene.instances[index];
    let is_stuff = instance.object.is_none() && scene.meshes[instance.mesh].triangles.len() > 1;
    (is_stuff && instance.world_from_mesh == glam::DAffine3::IDENTITY) || instance.class == Class::Building
}

/// What a ray meets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    pub(crate) pixel: u32,
    /// Along the ray, metres.
    pub(crate) depth_m: f64,
    /// Index into the drawn triangles.
    pub(crate) triangle: u32,
    pub(crate) from_front: bool,
}

/// All hits of a grid of parallel rays.
pub(crate) struct Drawing {
    pub(crate) cell_m: f64,
    pub(crate) width: u32,
    /// By pixel, then by depth.
    pub(crate) hits: Vec<Hit>,
    origin: DVec2,
    axes: [DVec3; 2],
}

/// So far beyond an area things are drawn, metres.
pub(crate) const BEYOND_M: f64 = 50.0;

impl Drawing {
    /// Draws what lies in `area` along the unit vector `towards`, one ray a cell; rows of rays from above run along
    /// `row`, a unit vector.
    pub(crate) fn new(triangles: &[Triangle], area: Bounds, (towards, row): (DVec3, DVec3), cell_m: f64) -> Self {
        let right = if towards.z.abs() > 0.9 { row } else { towards.cross(DVec3::Z).normalize() };
        let up = right.cross(towards);
        // Rays off every round coordinate, so that none runs along an edge.
        let plane = |p: DVec3| DVec2::new(p.dot(right), p.dot(up)) / cell_m + DVec2::new(0.3717, 0.6113);
        let reach = area.grown(BEYOND_M);
        let near: Vec<(usize, &Triangle)> = triangles
            .iter()
            .enumerate()
            .filter(|(_, t)| t.corners.iter().all(|c| reach.contains(c.truncate())))
            .collect();
        let corners = || near.iter().flat_map(|(_, t)| t.corners).map(plane);
        let origin = corners().fold(DVec2::INFINITY, DVec2::min).floor();
        let width = (corners().fold(DVec2::NEG_INFINITY, DVec2::max).x - origin.x).ceil().max(1.0) as u32;
        let mut hits = Vec::new();
        for &(index, t) in &near {
            let p = t.corners.map(|c| plane(c) - origin);
            let area = (p[1] - p[0]).perp_dot(p[2] - p[0]);
            if area.abs() < 1e-9 {
                continue;
            }
            let depth = t.corners.map(|c| c.dot(towards));
            let (low, high) = (p[0].min(p[1]).min(p[2]).ceil(), p[0].max(p[1]).max(p[2]).floor());
            for y in low.y as i64..=high.y as i64 {
                for x in low.x as i64..=high.x as i64 {
                    let at = DVec2::new(x as f64, y as f64);
                    let share = |i: usize, j: usize| (p[i] - at).perp_dot(p[j] - at) / area;
                    let weights = [share(1, 2), share(2, 0), share(0, 1)];
                    if weights.iter().all(|&w| w >= 0.0) {
                        hits.push(Hit {
                            pixel: y as u32 * width + x as u32,
                            depth_m: (0..3).map(|i| weights[i] * depth[i]).sum(),
                            triangle: index as u32,
                            from_front: t.normal().dot(towards) < 0.0,
                        });
                    }
                }
            }
        }
        hits.sort_by(|a, b| a.pixel.cmp(&b.pixel).then(a.depth_m.total_cmp(&b.depth_m)));
        Self { cell_m, width, hits, origin, axes: [right, up] }
    }

    /// The hits of each ray that meets anything.
    pub(crate) fn rays(&self) -> impl Iterator<Item = &[Hit]> {
        self.hits.chunk_by(|a, b| a.pixel == b.pixel)
    }

    /// A point on a ray, in the plane through World's origin across all of them.
    pub(crate) fn position(&self, pixel: u32) -> DVec3 {
        let cell = DVec2::new(f64::from(pixel % self.width), f64::from(pixel / self.width)) + self.origin;
        let p = (cell - DVec2::new(0.3717, 0.6113)) * self.cell_m;
        self.axes[0] * p.x + self.axes[1] * p.y
    }

    /// The point of a hit in World.
    pub(crate) fn point(&self, hit: &Hit, towards: DVec3) -> DVec3 {
        self.position(hit.pixel) + towards * hit.depth_m
    }
}

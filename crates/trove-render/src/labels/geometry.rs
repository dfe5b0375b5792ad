//! Where exactly a ray meets the triangle that the kernel found.

use glam::DVec3;

use crate::PreparedScene;
use crate::accel::Hit;

/// A point of a surface.
pub(super) struct Seen {
    /// In lengths of the ray's direction.
    pub(super) depth_m: f64,
    /// Unit normal of the triangle in World, on the side that the ray comes from.
    pub(super) normal: DVec3,
}

/// The hit in double precision.
pub(super) fn seen(scene: &PreparedScene, hit: &Hit, origin: DVec3, direction: DVec3) -> Seen {
    let instance = &scene.instances[hit.instance as usize];
    let corner = |i: u32| instance.world_from_mesh_f64.transform_point3(instance.mesh.positions[i as usize].as_dvec3());
    let [a, b, c] = instance.mesh.triangles[hit.triangle as usize].map(|i| corner(i) - origin);
    let normal = (b - a).cross(c - a).normalize_or(-direction.normalize());
    let facing = if normal.dot(direction) > 0.0 { -normal } else { normal };
    // A triangle seen edge-on does not pin the depth down; its corners still bound it.
    let along = |p: DVec3| p.dot(direction) / direction.length_squared();
    let (nearest, farthest) = (along(a).min(along(b)).min(along(c)), along(a).max(along(b)).max(along(c)));
    let depth = a.dot(normal) / normal.dot(direction);
    let depth_m = if depth.is_finite() { depth.clamp(nearest, farthest) } else { f64::from(hit.t) };
    Seen { depth_m, normal: facing }
}

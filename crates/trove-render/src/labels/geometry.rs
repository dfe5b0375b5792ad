//! Where exactly a ray meets the triangle that the kernel found.

use glam::DVec3;

use crate::PreparedScene;
use crate::accel::Hit;

/// A point of a surface.
pub(super) struct Seen {
    /// From the ray's origin.
    pub(super) range_m: f64,
    /// Unit normal of the triangle in World, on the side that the ray comes from.
    pub(super) normal: DVec3,
}

/// The hit of a ray with a unit direction in double precision.
pub(super) fn seen(scene: &PreparedScene, hit: &Hit, origin: DVec3, direction: DVec3) -> Seen {
    let instance = &scene.instances[hit.instance as usize];
    let corner = |i: u32| instance.world_from_mesh_f64.transform_point3(instance.mesh.positions[i as usize].as_dvec3());
    let [a, b, c] = instance.mesh.triangles[hit.triangle as usize].map(|i| corner(i) - origin);
    let normal = (b - a).cross(c - a).normalize_or(-direction);
    let facing = if normal.dot(direction) > 0.0 { -normal } else { normal };
    // A triangle seen edge-on does not pin the range down; its corners still bound it.
    let along = |p: DVec3| p.dot(direction);
    let (nearest, farthest) = (along(a).min(along(b)).min(along(c)), along(a).max(along(b)).max(along(c)));
    let range = a.dot(normal) / normal.dot(direction);
    let range_m = if range.is_finite() { range.clamp(nearest, farthest) } else { f64::from(hit.t) };
    Seen { range_m, normal: facing }
}

//! What a sensor's rays meet first, and where exactly.
//!
//! A ray finds the surface in the renderer's precision; where on it is then derived in the model's, from the triangle's own
//! corners. Holes of cut-outs are not there, nor is what carries the sensor. A pane of glass is what is met, not what lies
//! behind it, unless labels are asked for as if there were none.

use glam::DVec3;
use trove_model::SensorRay;

use crate::PreparedScene;
use crate::accel::{Coherence, PACKET};
use crate::motion::ray_time;
use crate::prepare::Carrier;
use crate::ray::{Hit, Ray};

/// A point of a surface.
pub(crate) struct Seen {
    pub(crate) hit: Hit,
    /// The ray that found it.
    pub(crate) ray: Ray,
    /// From the ray's origin.
    pub(crate) range_m: f64,
    /// Unit normal of the triangle in World, on the side that the ray comes from.
    pub(crate) normal: DVec3,
}

/// The ray in the renderer's precision, through nothing.
pub(crate) fn single(ray: &SensorRay) -> Ray {
    Ray { time: ray_time(ray.time_s), ..Ray::new(ray.origin.as_vec3(), ray.direction.as_vec3()) }
}

/// What up to [`PACKET`] rays that run alike meet, in their order.
pub(crate) fn seen(scene: &PreparedScene, carrier: &Carrier, rays: &[SensorRay]) -> [Option<Seen>; PACKET] {
    let (past, hits) = packet(scene, carrier, rays);
    std::array::from_fn(|i| hits[i].map(|hit| exactly(scene, hit, past[i], &rays[i])))
}

/// The same in the renderer's precision alone.
pub(crate) fn hits(scene: &PreparedScene, carrier: &Carrier, rays: &[SensorRay]) -> [Option<Hit>; PACKET] {
    packet(scene, carrier, rays).1
}

fn packet(scene: &PreparedScene, carrier: &Carrier, rays: &[SensorRay]) -> ([Ray; PACKET], [Option<Hit>; PACKET]) {
    let mut past = [Ray::new(glam::Vec3::ZERO, glam::Vec3::Z); PACKET];
    past.iter_mut().zip(rays).for_each(|(past, ray)| *past = carrier.past(single(ray)));
    let mut hits = [None; PACKET];
    scene.closest(&past[..rays.len()], Coherence::Coherent, &mut hits[..rays.len()]);
    (past, hits)
}

/// What one ray meets.
pub(crate) fn seen_by_one(scene: &PreparedScene, carrier: &Carrier, ray: &SensorRay) -> Option<Seen> {
    let past = carrier.past(single(ray));
    let mut hits = [None];
    scene.closest(&[past], Coherence::Incoherent, &mut hits);
    hits[0].map(|hit| exactly(scene, hit, past, ray))
}

/// A hit in double precision.
pub(crate) fn exactly(scene: &PreparedScene, hit: Hit, ray: Ray, exact: &SensorRay) -> Seen {
    let (mesh, direction) = (&scene.placed(hit.instance).mesh, exact.direction);
    let world_from_mesh = scene.instances[hit.instance as usize].world_from_mesh.at(ray.time);
    let corner = |i: u32| world_from_mesh.transform_point3(mesh.positions[i as usize].as_dvec3());
    let [a, b, c] = mesh.triangles[hit.triangle as usize].map(|i| corner(i) - exact.origin);
    let normal = (b - a).cross(c - a).normalize_or(-direction);
    let facing = if normal.dot(direction) > 0.0 { -normal } else { normal };
    // A triangle seen edge-on does not pin the range down; its corners still bound it.
    let along = |p: DVec3| p.dot(direction);
    let (nearest, farthest) = (along(a).min(along(b)).min(along(c)), along(a).max(along(b)).max(along(c)));
    let range = a.dot(normal) / normal.dot(direction);
    let range_m = if range.is_finite() { range.clamp(nearest, farthest) } else { f64::from(hit.t) };
    Seen { hit, ray, range_m, normal: facing }
}

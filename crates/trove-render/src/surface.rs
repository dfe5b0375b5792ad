//! What a ray finds at a hit, derived from the mesh in one way for all kernels.

use trove_trace::{Surface, Triangle};

use crate::placed::Placed;
use crate::ray::{Hit, Ray};

/// Where a ray hits what is placed, in the open where no snow lies.
pub(crate) fn surface(placed: &Placed, hit: &Hit, ray: &Ray) -> Surface {
    let mesh = &*placed.mesh;
    let corners = mesh.triangles[hit.triangle as usize].map(|i| i as usize);
    let triangle = Triangle {
        positions: corners.map(|i| mesh.positions[i]),
        normals: (!mesh.normals.is_empty()).then(|| corners.map(|i| mesh.normals[i])),
        uvs: (!mesh.uvs.is_empty()).then(|| corners.map(|i| mesh.uvs[i])),
        tints: (!mesh.tints.is_empty()).then(|| corners.map(|i| mesh.tints[i])),
        foot_z: placed.foot_z,
    };
    let (world_from_mesh, world_from_normal) = placed.at(ray.time);
    Surface::new(&triangle, hit, ray.direction, world_from_mesh, world_from_normal)
}

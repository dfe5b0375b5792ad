//! Meshes where they stand: what kernels, surfaces and labels know of an instance's shape.

use std::sync::Arc;

use glam::{Affine3A, DAffine3, Mat3A, Vec2, Vec3, Vec3A};
use trove_model::{InstanceId, Mesh};

use crate::motion::{MIDDLE, Motion};
use crate::ray::Hit;

/// What an instance is to rays that do not meet everything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sort {
    /// Part of the recording vehicle, through which most cameras look.
    Carrier,
    /// Too loose, or too soon elsewhere, to keep off what falls: plants and people.
    Loose,
    /// All else.
    Solid,
}

impl Sort {
    /// Whether it keeps rain and snow off what is below.
    pub(crate) fn shelters(self) -> bool {
        self != Self::Loose
    }
}

/// A mesh somewhere in World.
pub(crate) struct Placed {
    /// The object that it is part of; 0 for stuff.
    pub(crate) id: InstanceId,
    pub(crate) mesh: Arc<Mesh>,
    /// Index into the scene's materials for each slot.
    pub(crate) materials: Vec<u32>,
    /// Lowest z of the mesh, its own metres.
    pub(crate) foot_z: f32,
    pub(crate) world_from_mesh: Motion,
    /// Whether it stands at the previous and at the next keyframe as it stands now.
    pub(crate) stays: [bool; 2],
    pub(crate) sort: Sort,
    /// As `at` gives it at the moment of the labels.
    world_from_normal: Mat3A,
}

impl Placed {
    pub(crate) fn new(
        id: InstanceId,
        mesh: Arc<Mesh>,
        foot_z: f32,
        materials: Vec<u32>,
        way: &Motion<DAffine3>,
        stays: [bool; 2],
        sort: Sort,
    ) -> Self {
        // Here in the model's precision.
        let cofactor = way.middle.matrix3.inverse().transpose() * way.middle.matrix3.determinant().signum();
        Self {
            id,
            mesh,
            foot_z,
            materials,
            stays,
            sort,
            world_from_mesh: way.single(),
            world_from_normal: Mat3A::from_cols(
                cofactor.x_axis.as_vec3a(),
                cofactor.y_axis.as_vec3a(),
                cofactor.z_axis.as_vec3a(),
            ),
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

    /// Index of the material at a hit.
    pub(crate) fn material(&self, hit: &Hit) -> usize {
        self.materials[usize::from(self.mesh.slot(hit.triangle as usize))] as usize
    }

    /// Unit normal of the triangle in World at a ray's time, on the side from which its corners run counter-clockwise.
    pub(crate) fn normal(&self, hit: &Hit, time: f32) -> Vec3 {
        let [a, b, c] = self.mesh.triangles[hit.triangle as usize].map(|i| self.mesh.positions[i as usize]);
        let normal_mesh = (b - a).cross(c - a);
        let (_, world_from_normal) = self.at(time);
        (world_from_normal * Vec3A::from(normal_mesh)).normalize_or(Vec3A::Z).into()
    }

    /// Texture coordinates at a hit; zero where the mesh has none.
    pub(crate) fn uv(&self, hit: &Hit) -> Vec2 {
        if self.mesh.uvs.is_empty() {
            return Vec2::ZERO;
        }
        let [a, b, c] = self.mesh.triangles[hit.triangle as usize].map(|i| self.mesh.uvs[i as usize]);
        a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v
    }
}

//! What a ray finds at a hit, derived from the mesh in one way for all kernels.

use glam::{Vec2, Vec3, Vec3A};

use crate::placed::Placed;
use crate::ray::{Hit, Ray};

/// What comes down on a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Exposure {
    /// Whether nothing solid is above it; not asked for walls, which the wind reaches.
    pub(crate) is_open: bool,
    /// Share of it that snow covers, were it level, as it fell.
    pub(crate) snow: f32,
    /// Share of that snow that wheels and feet have left.
    pub(crate) left: f32,
    /// How fast that share grows along World's x and y, per metre: across tracks of wheels.
    pub(crate) left_grows: Vec2,
    /// Whether it lies on what moves on, and so where that is.
    pub(crate) moves: bool,
    /// Millimetres of rain an hour on what is level.
    pub(crate) rain_mm_h: f32,
    /// When this is, seconds.
    pub(crate) moment_s: f32,
}

impl Exposure {
    /// In the open where no snow lies.
    pub(crate) const BARE: Self = Self {
        is_open: true,
        snow: 0.0,
        left: 1.0,
        left_grows: Vec2::ZERO,
        moves: false,
        rain_mm_h: 0.0,
        moment_s: 0.0,
    };
}

/// A point on a surface, in World, seen from where the ray came.
pub(crate) struct Surface {
    pub(crate) point: Vec3,
    /// The same in the mesh's own coordinates.
    pub(crate) point_mesh: Vec3,
    /// Above the mesh's lowest corner, metres along its z.
    pub(crate) above_foot_m: f32,
    /// Unit, towards the ray's origin.
    pub(crate) wo: Vec3,
    /// Unit normal of the triangle, on the side of `wo`.
    pub(crate) geometric: Vec3,
    /// Unit interpolated normal, on the side of the triangle's normal.
    pub(crate) shading: Vec3,
    /// Whether the ray came from outside (the side from which corners run counter-clockwise).
    pub(crate) is_front: bool,
    /// Texture coordinates before the material's scale.
    pub(crate) uv: Vec2,
    /// Directions in which u and v grow fastest, per unit of uv; `None` where the mesh has no useful uvs.
    pub(crate) uv_axes: Option<[Vec3; 2]>,
    /// What the material's base colour is multiplied by.
    pub(crate) tint: Vec3,
    pub(crate) exposure: Exposure,
}

impl Surface {
    /// A point of something in the open that stands in its own coordinates, seen along its normal.
    #[cfg(test)]
    pub(crate) fn plain(point: Vec3, normal: Vec3) -> Self {
        Self {
            point,
            point_mesh: point,
            above_foot_m: point.z,
            wo: normal,
            geometric: normal,
            shading: normal,
            is_front: true,
            uv: Vec2::ZERO,
            uv_axes: None,
            tint: Vec3::ONE,
            exposure: Exposure::BARE,
        }
    }

    /// Where a ray hits what is placed.
    pub(crate) fn new(placed: &Placed, hit: &Hit, ray: &Ray) -> Self {
        let mesh = &*placed.mesh;
        let corners = mesh.triangles[hit.triangle as usize];
        let [a, b, c] = corners.map(|i| Vec3A::from(mesh.positions[i as usize]));
        let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];

        // The point lies on the triangle, not on the ray: the ray's error grows with distance.
        let point_mesh = a * weights[0] + b * weights[1] + c * weights[2];
        let (world_from_mesh, world_from_normal) = placed.at(ray.time);
        let point = world_from_mesh.transform_point3a(point_mesh);
        let (edge_b, edge_c) = (b - a, c - a);
        let outside = (world_from_normal * edge_b.cross(edge_c)).normalize_or(Vec3A::Z);

        let wo = -Vec3A::from(ray.direction).normalize();
        let is_front = outside.dot(wo) >= 0.0;
        let side = if is_front { 1.0 } else { -1.0 };

        let shading = if mesh.normals.is_empty() {
            outside
        } else {
            let [na, nb, nc] = corners.map(|i| Vec3A::from(mesh.normals[i as usize]));
            let normal = world_from_normal * (na * weights[0] + nb * weights[1] + nc * weights[2]);
            // A normal that contradicts its triangle is the model's mistake.
            let normal = normal.normalize_or(outside);
            if normal.dot(outside) < 0.0 { -normal } else { normal }
        };

        let (mut uv, mut uv_axes) = (Vec2::ZERO, None);
        if !mesh.uvs.is_empty() {
            let [ta, tb, tc] = corners.map(|i| mesh.uvs[i as usize]);
            uv = ta * weights[0] + tb * weights[1] + tc * weights[2];
            let (db, dc) = (tb - ta, tc - ta);
            let det = db.perp_dot(dc);
            if det.abs() > 1e-12 {
                let along_u = (edge_b * dc.y - edge_c * db.y) / det;
                let along_v = (edge_c * db.x - edge_b * dc.x) / det;
                let world = |v: Vec3A| Vec3::from(world_from_mesh.transform_vector3a(v));
                uv_axes = Some([world(along_u), world(along_v)]);
            }
        }
        let tint = if mesh.tints.is_empty() {
            Vec3::ONE
        } else {
            let [ta, tb, tc] = corners.map(|i| mesh.tints[i as usize]);
            ta * weights[0] + tb * weights[1] + tc * weights[2]
        };
        Self {
            point: point.into(),
            point_mesh: point_mesh.into(),
            above_foot_m: point_mesh.z - placed.foot_z,
            wo: wo.into(),
            geometric: (outside * side).into(),
            shading: (shading * side).into(),
            is_front,
            uv,
            uv_axes,
            tint,
            exposure: Exposure::BARE,
        }
    }

    /// Cosine of the outer side's slope: 1 faces up.
    pub(crate) fn outward_z(&self) -> f32 {
        if self.is_front { self.shading.z } else { -self.shading.z }
    }

    /// Where a ray in direction `wi` starts so that it does not meet its own surface again.
    pub(crate) fn leave(&self, wi: Vec3) -> Vec3 {
        let gap_m = gap_m(self.point);
        self.point + self.geometric * if wi.dot(self.geometric) >= 0.0 { gap_m } else { -gap_m }
    }
}

/// How far off surfaces may be near a point: single precision, with room for the two transforms that they went through.
pub(crate) fn gap_m(point: Vec3) -> f32 {
    2e-5 + point.abs().max_element() * 1e-6
}

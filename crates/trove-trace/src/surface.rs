//! What a ray finds where it meets a triangle.

use glam::{Affine3A, Mat3A, Vec2, Vec3, Vec3A};

use crate::math::unit_or;
use crate::ray::Hit;

/// What comes down on a point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Exposure {
    /// Share of it that snow covers, were it level, as it fell.
    pub snow: f32,
    /// Share of that snow that wheels and feet have left.
    pub left: f32,
    /// How fast that share grows along World's x and y, per metre: across tracks of wheels.
    pub left_grows: Vec2,
    /// Millimetres of rain an hour on what is level.
    pub rain_mm_h: f32,
    /// When this is, seconds.
    pub moment_s: f32,
    /// Whether nothing solid is above it; not asked for walls, which the wind reaches.
    pub is_open: bool,
    /// Whether it lies on what moves on, and so where that is.
    pub moves: bool,
}

impl Exposure {
    /// In the open where no snow lies.
    pub const BARE: Self = Self {
        snow: 0.0,
        left: 1.0,
        left_grows: Vec2::ZERO,
        rain_mm_h: 0.0,
        moment_s: 0.0,
        is_open: true,
        moves: false,
    };
}

/// What a mesh says of a triangle: of each corner, in the mesh's own coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// Metres.
    pub positions: [Vec3; 3],
    /// Of any length; without them the triangle is flat.
    pub normals: Option<[Vec3; 3]>,
    /// Texture coordinates.
    pub uvs: Option<[Vec2; 3]>,
    /// What base colours are multiplied by.
    pub tints: Option<[Vec3; 3]>,
    /// Lowest z of the whole mesh, metres.
    pub foot_z: f32,
}

/// A point on a surface, in World, seen from where the ray came.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Surface {
    /// Where it is.
    pub point: Vec3,
    /// The same in the mesh's own coordinates.
    pub point_mesh: Vec3,
    /// Above the mesh's lowest corner, metres along its z.
    pub above_foot_m: f32,
    /// Unit, towards the ray's origin.
    pub wo: Vec3,
    /// Unit normal of the triangle, on the side of `wo`.
    pub geometric: Vec3,
    /// Unit interpolated normal, on the side of `wo`.
    pub shading: Vec3,
    /// Texture coordinates before the material's scale.
    pub uv: Vec2,
    /// Directions in which u and v grow fastest, per unit of uv; both zero where the mesh has no useful uvs.
    pub uv_axes: [Vec3; 2],
    /// What the material's base colour is multiplied by.
    pub tint: Vec3,
    /// What comes down on it.
    pub exposure: Exposure,
    /// Whether the ray came from outside (the side from which corners run counter-clockwise).
    pub is_front: bool,
}

impl Surface {
    /// A point of something in the open that stands in its own coordinates, seen along its normal.
    pub fn plain(point: Vec3, normal: Vec3) -> Self {
        Self {
            point,
            point_mesh: point,
            above_foot_m: point.z,
            wo: normal,
            geometric: normal,
            shading: normal,
            uv: Vec2::ZERO,
            uv_axes: [Vec3::ZERO; 2],
            tint: Vec3::ONE,
            exposure: Exposure::BARE,
            is_front: true,
        }
    }

    /// Where a ray of some direction hits a triangle; normals are taken to World by the inverse transpose.
    #[inline]
    pub fn new(
        triangle: &Triangle,
        hit: &Hit,
        direction: Vec3,
        world_from_mesh: Affine3A,
        world_from_normal: Mat3A,
    ) -> Self {
        let [a, b, c] = triangle.positions.map(Vec3A::from);
        let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
        let mixed = |[a, b, c]: [Vec3A; 3]| a * weights[0] + b * weights[1] + c * weights[2];

        // The point lies on the triangle, not on the ray: the ray's error grows with distance.
        let point_mesh = mixed([a, b, c]);
        let point = world_from_mesh.transform_point3a(point_mesh);
        let (edge_b, edge_c) = (b - a, c - a);
        let outside = unit_or((world_from_normal * edge_b.cross(edge_c)).into(), Vec3::Z);

        let wo = -unit_or(direction, Vec3::Z);
        let is_front = outside.dot(wo) >= 0.0;
        let side = if is_front { 1.0 } else { -1.0 };

        let shading = triangle.normals.map_or(outside, |normals| {
            let normal = world_from_normal * mixed(normals.map(Vec3A::from));
            // A normal that contradicts its triangle is the model's mistake.
            let normal = unit_or(normal.into(), outside);
            if normal.dot(outside) < 0.0 { -normal } else { normal }
        });

        let (mut uv, mut uv_axes) = (Vec2::ZERO, [Vec3::ZERO; 2]);
        if let Some([ta, tb, tc]) = triangle.uvs {
            uv = ta * weights[0] + tb * weights[1] + tc * weights[2];
            let (db, dc) = (tb - ta, tc - ta);
            let det = db.perp_dot(dc);
            if det.abs() > 1e-12 {
                let along_u = (edge_b * dc.y - edge_c * db.y) / det;
                let along_v = (edge_c * db.x - edge_b * dc.x) / det;
                uv_axes = [along_u, along_v].map(|v| world_from_mesh.transform_vector3a(v).into());
            }
        }
        Self {
            point: point.into(),
            point_mesh: point_mesh.into(),
            above_foot_m: point_mesh.z - triangle.foot_z,
            wo,
            geometric: outside * side,
            shading: shading * side,
            uv,
            uv_axes,
            tint: triangle.tints.map_or(Vec3::ONE, |tints| mixed(tints.map(Vec3A::from)).into()),
            exposure: Exposure::BARE,
            is_front,
        }
    }

    /// Cosine of the outer side's slope: 1 faces up.
    #[inline]
    pub fn outward_z(&self) -> f32 {
        if self.is_front { self.shading.z } else { -self.shading.z }
    }

    /// Where a ray in direction `wi` starts so that it does not meet its own surface again.
    #[inline]
    pub fn leave(&self, wi: Vec3) -> Vec3 {
        let gap_m = gap_m(self.point);
        self.point + self.geometric * if wi.dot(self.geometric) >= 0.0 { gap_m } else { -gap_m }
    }
}

/// How far off surfaces may be near a point: single precision, with room for the two transforms that they went through.
#[inline]
pub fn gap_m(point: Vec3) -> f32 {
    2e-5 + point.abs().max_element() * 1e-6
}

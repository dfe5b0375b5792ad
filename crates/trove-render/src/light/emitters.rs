//! Triangles that shine.

use std::f32::consts::PI;

use glam::{DVec3, Vec2, Vec3};
use trove_model::Scene;

use super::cdf::Cdf;
use super::luminance;

/// How far light of the outermost emitters reaches, roughly.
const MARGIN_M: f32 = 20.0;

/// All shining triangles of a scene, drawn in proportion to their power.
pub(super) struct Emitters {
    triangles: Vec<Emitter>,
    by_power: Cdf,
}

struct Emitter {
    /// Indices of instance and triangle; the list is sorted by it.
    key: (u32, u32),
    corner: Vec3,
    edges: [Vec3; 2],
    /// Twice the area, along the normal.
    cross: Vec3,
    radiance: Vec3,
}

/// A point on a shining triangle.
pub(super) struct EmitterPoint {
    pub(super) point: Vec3,
    pub(super) radiance: Vec3,
    /// Density over solid angle with which it was drawn; infinite seen edge-on.
    pub(super) pdf: f32,
}

impl Emitters {
    /// `None` where nothing shines. Cut-out materials are left out: rays that meet them by chance still count them.
    pub(super) fn new(scene: &Scene) -> Option<Self> {
        let mut triangles = Vec::new();
        for (i, instance) in scene.instances.iter().enumerate() {
            let material = |slot: u16| &scene.materials[instance.materials[usize::from(slot)]];
            if !instance.materials.iter().any(|&m| scene.materials[m].is_emitter()) {
                continue;
            }
            let mesh = &scene.meshes[instance.mesh];
            for (t, corners) in mesh.triangles.iter().enumerate() {
                let material = material(mesh.slot(t));
                if !material.is_emitter() || material.alpha_cutoff > 0.0 {
                    continue;
                }
                let at = |c: u32| instance.world_from_mesh.transform_point3(mesh.positions[c as usize].as_dvec3());
                let [a, b, c]: [DVec3; 3] = corners.map(at);
                let cross = (b - a).cross(c - a).as_vec3();
                if cross.length() > 0.0 {
                    let edges = [(b - a).as_vec3(), (c - a).as_vec3()];
                    let key = (i as u32, t as u32);
                    triangles.push(Emitter { key, corner: a.as_vec3(), edges, cross, radiance: material.emission });
                }
            }
        }
        let power = |e: &Emitter| f64::from(e.cross.length() * luminance(e.radiance));
        let powers: Vec<f64> = triangles.iter().map(power).collect();
        (!triangles.is_empty()).then(|| Self { triangles, by_power: Cdf::new(&powers) })
    }

    /// Irradiance of a surface among the emitters: all their light, spread over the ground that they stand on.
    pub(super) fn typical_irradiance(&self) -> f32 {
        let flux: f32 = self.triangles.iter().map(|e| PI * 0.5 * e.cross.length() * luminance(e.radiance)).sum();
        let corners = || self.triangles.iter().map(|e| e.corner.truncate());
        let (low, high) = (corners().fold(Vec2::INFINITY, Vec2::min), corners().fold(-Vec2::INFINITY, Vec2::max));
        flux / (high - low + MARGIN_M).element_product()
    }

    /// A point on some triangle, for a surface at `from` that is lit from the side of `normal` (both if it is 0).
    pub(super) fn draw(&self, from: Vec3, _normal: Vec3, u: [f32; 3]) -> Option<EmitterPoint> {
        let (index, _) = self.by_power.draw(u[0]);
        let emitter = &self.triangles[index];
        // Even over the triangle's area.
        let root = u[1].sqrt();
        let (b, c) = (root * (1.0 - u[2]), root * u[2]);
        let point = emitter.corner + emitter.edges[0] * b + emitter.edges[1] * c;
        Some(EmitterPoint { point, radiance: emitter.radiance, pdf: self.density(index, from, point) })
    }

    /// Density over solid angle, seen from `from`, with which that point of a triangle is drawn; 0 where it never is.
    pub(super) fn pdf(&self, key: (u32, u32), from: Vec3, _normal: Vec3, point: Vec3) -> f32 {
        let found = self.triangles.binary_search_by_key(&key, |e| e.key);
        found.map_or(0.0, |index| self.density(index, from, point))
    }

    fn density(&self, index: usize, from: Vec3, point: Vec3) -> f32 {
        let to_light = point - from;
        // d² / (area · |cos|), with area · cos = |cross · to_light| / 2d.
        let distance = to_light.length();
        self.by_power.probability(index) * 2.0 * distance.powi(3) / self.triangles[index].cross.dot(to_light).abs()
    }
}

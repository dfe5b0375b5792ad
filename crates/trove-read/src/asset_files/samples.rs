//! Points on a model's surface, spread evenly, to judge its shape by.

use glam::{Mat3, Vec3};

use super::looks;
use super::model::Model;

/// How many points a model gets.
const COUNT: usize = 16_000;

/// A point on a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) at: Vec3,
    /// Unit normal of its triangle, by the order of its corners.
    pub(super) normal: Vec3,
    /// Linear RGB of the base colour.
    pub(super) color: Vec3,
}

/// Points at equal steps of area, the same at every call.
pub(super) fn samples(model: &Model) -> Vec<Sample> {
    let mesh = &model.mesh;
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        f64::from((b - a).cross(c - a).length())
    };
    let total: f64 = mesh.triangles.iter().map(area).sum();
    if !total.is_finite() || total <= 0.0 {
        return Vec::new();
    }
    let step = total / COUNT as f64;
    let (mut passed, mut next) = (0.0, step / 2.0);
    let mut samples = Vec::with_capacity(COUNT);
    for (i, t) in mesh.triangles.iter().enumerate() {
        passed += area(t);
        if next > passed {
            continue;
        }
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let material = model.materials.get(usize::from(mesh.slot(i)));
        while next <= passed && samples.len() < COUNT {
            // The R2 sequence (Roberts 2018) fills the triangle evenly.
            let n = samples.len() as f64;
            let (mut u, mut v) = ((0.5 + n * 0.754_877_666) % 1.0, (0.5 + n * 0.569_840_291) % 1.0);
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let (u, v) = (u as f32, v as f32);
            let mix = |a: f32, b: f32, c: f32| a * (1.0 - u - v) + b * u + c * v;
            let uv = |k: usize| mesh.uvs.get(t[k] as usize).copied().unwrap_or_default();
            let map = material.and_then(|m| m.base_color_map.as_deref());
            let texel = map.map_or(Vec3::ONE, |map| {
                let uv = uv(0) * (1.0 - u - v) + uv(1) * u + uv(2) * v;
                looks::look_up(map, uv).truncate()
            });
            let at = Vec3::new(mix(a.x, b.x, c.x), mix(a.y, b.y, c.y), mix(a.z, b.z, c.z));
            let color = texel * material.map_or(Vec3::ONE, |m| m.base_color);
            samples.push(Sample { at, normal, color });
            next += step;
        }
    }
    samples
}

/// Samples in other axes, moved and scaled into a box from 0 to 1 of the height: x and y around the middle of the
/// box, z from 0.
pub(super) fn in_heights(samples: &[Sample], turn: Mat3) -> Vec<Sample> {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for s in samples {
        let at = turn * s.at;
        (low, high) = (low.min(at), high.max(at));
    }
    let origin = Vec3::new((low.x + high.x) / 2.0, (low.y + high.y) / 2.0, low.z);
    let scale = 1.0 / (high.z - low.z).max(1e-9);
    samples.iter().map(|s| Sample { at: (turn * s.at - origin) * scale, normal: turn * s.normal, ..*s }).collect()
}

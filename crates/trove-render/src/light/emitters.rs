//! Triangles that shine.

use std::f32::consts::PI;
use std::sync::Arc;

use glam::{DVec3, Mat3, Vec2, Vec3};
use trove_model::{Beam, Scene};

use super::luminance::luminance;
use super::tree::{Tree, TreeEntry};

/// How far light of the outermost emitters reaches, roughly.
const MARGIN_M: f32 = 20.0;

/// What a beam is taken to give at least, where lamps are compared.
const LEAST_SHARE: f32 = 1e-3;

/// All shining triangles of a scene, drawn by what they give to the place that asks.
///
/// They are sampled on the side from which their corners run counter-clockwise, since lamps are closed bodies.
pub(super) struct Emitters {
    triangles: Vec<Emitter>,
    tree: Tree,
}

struct Emitter {
    /// Indices of instance and triangle; the list is sorted by it.
    key: (u32, u32),
    corner: Vec3,
    edges: [Vec3; 2],
    /// Twice the area, along the normal.
    cross: Vec3,
    radiance: Vec3,
    /// By which the radiance differs between directions, and the way to them from World's.
    beam: Option<(Arc<Beam>, Mat3)>,
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
            let mesh_from_world = instance.world_from_mesh.matrix3.inverse().as_mat3();
            // A mirrored instance turns its triangles inside out.
            let side = instance.world_from_mesh.matrix3.determinant().signum() as f32;
            for (t, corners) in mesh.triangles.iter().enumerate() {
                let material = material(mesh.slot(t));
                if !material.is_emitter() || material.alpha_cutoff > 0.0 {
                    continue;
                }
                let at = |c: u32| instance.world_from_mesh.transform_point3(mesh.positions[c as usize].as_dvec3());
                let [a, b, c]: [DVec3; 3] = corners.map(at);
                let cross = (b - a).cross(c - a).as_vec3() * side;
                if cross.length() > 0.0 {
                    let edges = [(b - a).as_vec3(), (c - a).as_vec3()];
                    let key = (i as u32, t as u32);
                    let radiance = material.emission;
                    let beam = material.beam.clone().map(|beam| (beam, mesh_from_world));
                    triangles.push(Emitter { key, corner: a.as_vec3(), edges, cross, radiance, beam });
                }
            }
        }
        let entries: Vec<TreeEntry> = triangles.iter().map(Emitter::entry).collect();
        (!triangles.is_empty()).then(|| Self { triangles, tree: Tree::new(&entries) })
    }

    /// Irradiance of a surface among the emitters: all their light, spread over the ground that they stand on.
    pub(super) fn typical_irradiance(&self) -> f32 {
        let flux: f32 = self.triangles.iter().map(|e| PI * e.power()).sum();
        let corners = || self.triangles.iter().map(|e| e.corner.truncate());
        let (low, high) = (corners().fold(Vec2::INFINITY, Vec2::min), corners().fold(-Vec2::INFINITY, Vec2::max));
        flux / (high - low + MARGIN_M).element_product()
    }

    /// A point on some triangle, for a surface at `from` that is lit from the side of `normal` (both if it is 0); `None`
    /// where no triangle shines on that.
    pub(super) fn draw(&self, from: Vec3, normal: Vec3, u: [f32; 3]) -> Option<EmitterPoint> {
        let weight = |index: u32| self.triangles[index as usize].weight(from);
        let (index, probability) = self.tree.draw(from, normal, u[0], weight)?;
        let emitter = &self.triangles[index as usize];
        // Even over the triangle's area.
        let root = u[1].sqrt();
        let (b, c) = (root * (1.0 - u[2]), root * u[2]);
        let point = emitter.corner + emitter.edges[0] * b + emitter.edges[1] * c;
        let radiance = emitter.radiance * emitter.share(from - point);
        Some(EmitterPoint { point, radiance, pdf: probability * emitter.density(from, point) })
    }

    /// Density over solid angle, seen from `from`, with which that point of a triangle is drawn; 0 where it never is.
    pub(super) fn pdf(&self, key: (u32, u32), from: Vec3, normal: Vec3, point: Vec3) -> f32 {
        let Ok(index) = self.triangles.binary_search_by_key(&key, |e| e.key) else { return 0.0 };
        let weight = |index: u32| self.triangles[index as usize].weight(from);
        let probability = self.tree.probability(index as u32, from, normal, weight);
        if probability > 0.0 { probability * self.triangles[index].density(from, point) } else { 0.0 }
    }
}

impl Emitter {
    fn centre(&self) -> Vec3 {
        self.corner + (self.edges[0] + self.edges[1]) / 3.0
    }

    /// Share of the radiance that leaves into a direction, World.
    fn share(&self, direction: Vec3) -> f32 {
        self.beam.as_ref().map_or(1.0, |(beam, mesh_from_world)| beam.share(*mesh_from_world * direction))
    }

    /// Area times brightness, in all directions together.
    fn power(&self) -> f32 {
        let share = self.beam.as_ref().map_or(1.0, |(beam, _)| beam.flux_share());
        0.5 * self.cross.length() * luminance(self.radiance) * share
    }

    fn entry(&self) -> TreeEntry {
        let corners = [self.corner, self.corner + self.edges[0], self.corner + self.edges[1]];
        TreeEntry {
            low: corners[0].min(corners[1]).min(corners[2]),
            high: corners[0].max(corners[1]).max(corners[2]),
            centre: self.centre(),
            axis: self.cross.normalize(),
            power: self.power(),
        }
    }

    /// What it gives to a place, roughly; 0 exactly where that is behind it.
    fn weight(&self, from: Vec3) -> f32 {
        let to_place = from - self.centre();
        // Near a triangle its own size counts, not the distance to its middle.
        let square = to_place.length_squared().max(0.25 * self.cross.length());
        // Never nothing: another point of it may shine there.
        let share = self.share(to_place).max(LEAST_SHARE);
        luminance(self.radiance) * share * self.cross.dot(to_place).max(0.0) / (square * square.sqrt())
    }

    /// Density over solid angle of a point that is drawn evenly from the triangle.
    fn density(&self, from: Vec3, point: Vec3) -> f32 {
        let to_light = point - from;
        // d² / (area · |cos|), with area · cos = |cross · to_light| / 2d.
        2.0 * to_light.length().powi(3) / self.cross.dot(to_light).abs()
    }
}

#[cfg(test)]
mod tests {
    use trove_model::Seed;

    use super::*;
    use crate::light::cdf::Cdf;

    /// Lamps along a street, 300 of them on both sides: boxes that shine on all sides, some a hundred times as bright.
    fn street() -> Emitters {
        let mut triangles = Vec::new();
        for i in 0..300u32 {
            let at = Vec3::new((i / 2) as f32 * 6.0, if i % 2 == 0 { -8.0 } else { 8.0 }, 5.0 + (i % 3) as f32);
            let radiance = Vec3::splat(if i % 7 == 0 { 100.0 } else { 1.0 + (i % 5) as f32 });
            for (t, axis) in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z].into_iter().enumerate() {
                let (a, b) = axis.any_orthonormal_pair();
                let (a, b) = if a.cross(b).dot(axis) > 0.0 { (a, b) } else { (b, a) };
                for half in 0..2 {
                    let edges = if half == 0 { [a * 0.3, b * 0.3] } else { [-a * 0.3, -b * 0.3] };
                    let corner = at + axis * 0.15 - (a + b) * if half == 0 { 0.15 } else { -0.15 };
                    let cross = edges[0].cross(edges[1]);
                    let key = (i, 2 * t as u32 + half);
                    triangles.push(Emitter { key, corner, edges, cross, radiance, beam: None });
                }
            }
        }
        let entries: Vec<TreeEntry> = triangles.iter().map(Emitter::entry).collect();
        Emitters { triangles, tree: Tree::new(&entries) }
    }

    /// Places on the road and on a wall beside it.
    fn places() -> Vec<(Vec3, Vec3)> {
        let x = |i: usize| 3.0 + 90.0 * i as f32;
        (0..10).flat_map(|i| [(Vec3::new(x(i), 1.0, 0.0), Vec3::Z), (Vec3::new(x(i), 12.0, 3.0), -Vec3::Y)]).collect()
    }

    /// What one sample brings.
    fn brought(drawn: &EmitterPoint, (from, normal): (Vec3, Vec3)) -> f64 {
        let cos = (drawn.point - from).normalize().dot(normal).max(0.0);
        f64::from(drawn.radiance.x * cos / drawn.pdf)
    }

    #[test]
    fn many_lamps_are_sampled_with_far_less_noise_than_by_power_and_without_bias() {
        let street = street();
        let powers: Vec<f64> = street.triangles.iter().map(|e| f64::from(e.power())).collect();
        let by_power = Cdf::new(&powers);
        let mut random = Seed(5).random();
        let mut unit = || random.unit() as f32;
        let (mut noise, mut noise_by_power) = (0.0, 0.0);
        for place in places() {
            // All lamps, finely: those in view, from the side that faces the place.
            let mut truth = 0.0;
            for e in &street.triangles {
                let n = 8;
                for k in 0..n * n {
                    let (s, t) = (((k / n) as f32 + 0.5) / n as f32, ((k % n) as f32 + 0.5) / n as f32);
                    let root = s.sqrt();
                    let point = e.corner + e.edges[0] * root * (1.0 - t) + e.edges[1] * root * t;
                    if e.cross.dot(place.0 - point) > 0.0 {
                        let pdf = e.density(place.0, point);
                        let drawn = EmitterPoint { point, radiance: e.radiance, pdf };
                        truth += brought(&drawn, place) / f64::from(n * n);
                    }
                }
            }
            let draws = 4000;
            let (mut sum, mut squares, mut squares_by_power) = (0.0, 0.0, 0.0);
            for _ in 0..draws {
                let u = [unit(), unit(), unit()];
                let part = street.draw(place.0, place.1, u).map_or(0.0, |drawn| brought(&drawn, place));
                sum += part;
                squares += part * part;
                let (index, _) = by_power.draw(u[0]);
                let e = &street.triangles[index];
                let root = u[1].sqrt();
                let point = e.corner + e.edges[0] * root * (1.0 - u[2]) + e.edges[1] * root * u[2];
                let pdf = by_power.probability(index) * e.density(place.0, point);
                let drawn = EmitterPoint { point, radiance: e.radiance, pdf };
                let is_lit = e.cross.dot(place.0 - point) > 0.0;
                squares_by_power += if is_lit { brought(&drawn, place).powi(2) } else { 0.0 };
            }
            let n = f64::from(draws);
            let (mean, variance) = (sum / n, squares / n - (sum / n).powi(2));
            assert!((mean - truth).abs() < 4.5 * (variance / n).sqrt(), "{place:?}: {mean} instead of {truth}");
            noise += variance.max(0.0) / (truth * truth);
            noise_by_power += (squares_by_power / n - truth * truth) / (truth * truth);
        }
        assert!(noise * 20.0 < noise_by_power, "{noise} {noise_by_power}");
    }

    #[test]
    fn triangles_are_drawn_with_the_probability_that_is_claimed() {
        let street = street();
        let mut random = Seed(6).random();
        let place = places()[3];
        let draws = 100_000;
        let mut drawn = vec![0.0; 300];
        for _ in 0..draws {
            let u = [random.unit() as f32, random.unit() as f32, random.unit() as f32];
            let Some(point) = street.draw(place.0, place.1, u) else { continue };
            let near = |e: &&Emitter| {
                let above = e.cross.normalize().dot(point.point - e.corner).abs();
                above < 1e-4 && (point.point - e.centre()).length() < 0.3
            };
            let e = street.triangles.iter().filter(near).min_by(|a, b| {
                let claimed = |e: &Emitter| (street.pdf(e.key, place.0, place.1, point.point) / point.pdf - 1.0).abs();
                claimed(a).total_cmp(&claimed(b))
            });
            let e = e.unwrap();
            assert!((street.pdf(e.key, place.0, place.1, point.point) / point.pdf - 1.0).abs() < 1e-3);
            drawn[e.key.0 as usize] += 1.0;
        }
        let weight = |e: &Emitter| street.pdf(e.key, place.0, place.1, e.centre()) / e.density(place.0, e.centre());
        let mut expected = vec![0.0; 300];
        for e in &street.triangles {
            expected[e.key.0 as usize] += f64::from(weight(e)) * f64::from(draws);
        }
        let total: f64 = expected.iter().sum();
        assert!((total / f64::from(draws) - 1.0).abs() < 1e-3, "{total}");
        // Rare ones together.
        let (mut chi2, mut degrees, mut rest) = (0.0, -1.0f64, (0.0, 0.0));
        for (n, e) in drawn.iter().zip(&expected) {
            if *e > 10.0 {
                chi2 += (n - e).powi(2) / e;
                degrees += 1.0;
            } else {
                rest = (rest.0 + n, rest.1 + e);
            }
        }
        chi2 += (rest.0 - rest.1).powi(2) / rest.1.max(1e-9);
        let limit = degrees + 1.0 + 3.3 * (2.0 * (degrees + 1.0)).sqrt() + 5.0;
        assert!(chi2 < limit, "χ² = {chi2} of {degrees}");
    }
}

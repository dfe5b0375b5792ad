//! What is below, around and inside: answers from a scene's triangles.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use trove_model::{Class, Instance, Scene};

use crate::drawing::{Triangle, is_built, triangles};

/// Side of a bucket, metres.
const BUCKET_M: f64 = 4.0;
/// A body is what of a thing lies between these heights above its foot, metres.
const BODY_M: [f64; 2] = [0.05, 1.6];
/// The same of a tree.
const TRUNK_M: [f64; 2] = [0.05, 0.5];

/// Triangles by where they lie in the plane.
struct Buckets {
    triangles: Vec<Triangle>,
    // Only ever looked up, so the order inside does not reach a result.
    by_place: HashMap<[i64; 2], Vec<usize>>,
}

impl Buckets {
    fn new(triangles: Vec<Triangle>) -> Self {
        let mut by_place: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
        for (i, t) in triangles.iter().enumerate() {
            let p = t.corners.map(|c| c.truncate());
            let (low, high) = (bucket(p[0].min(p[1]).min(p[2])), bucket(p[0].max(p[1]).max(p[2])));
            // The ground beyond the place is no ground that things stand on.
            if high[0] - low[0] > 300 || high[1] - low[1] > 300 {
                continue;
            }
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    by_place.entry([x, y]).or_default().push(i);
                }
            }
        }
        Self { triangles, by_place }
    }

    /// Heights at which the vertical line through a point meets triangles, with the triangles.
    fn crossings(&self, p: DVec2) -> impl Iterator<Item = (f64, &Triangle)> {
        self.by_place.get(&bucket(p)).into_iter().flatten().filter_map(move |&i| {
            let t = &self.triangles[i];
            let [a, b, c] = t.corners;
            let area = (b - a).truncate().perp_dot((c - a).truncate());
            let share = |i: DVec3, j: DVec3| (i.truncate() - p).perp_dot(j.truncate() - p) / area;
            let weights = [share(b, c), share(c, a), share(a, b)];
            let inside = area.abs() > 1e-12 && weights.iter().all(|&w| w >= -1e-9);
            inside.then(|| (weights[0] * a.z + weights[1] * b.z + weights[2] * c.z, t))
        })
    }
}

fn bucket(p: DVec2) -> [i64; 2] {
    let cell = (p / BUCKET_M).floor();
    [cell.x as i64, cell.y as i64]
}

/// Everything that lies on the ground, without the grass.
pub(crate) struct Ground<'a> {
    scene: &'a Scene,
    buckets: Buckets,
}

impl<'a> Ground<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Self {
        let lies = |i: usize| is_built(scene, i) && scene.instances[i].class != Class::Building;
        Self { scene, buckets: Buckets::new(triangles(scene, lies)) }
    }

    /// Height of the surface that is nearest to a foot, straight above or below it or a hand beside it: a shoe may stand
    /// over the kerb's edge.
    pub(crate) fn height_near_m(&self, foot: DVec3) -> Option<f64> {
        const HAND_M: f64 = 0.12;
        let around = [DVec3::ZERO, DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y];
        let heights = around.iter().filter_map(|d| self.nearest(foot + *d * HAND_M));
        heights.map(|(z, _)| z).min_by(|a, b| (a - foot.z).abs().total_cmp(&(b - foot.z).abs()))
    }

    /// Class of that surface.
    pub(crate) fn class_near(&self, p: DVec3) -> Option<Class> {
        self.nearest(p).map(|(_, t)| self.scene.instances[t.instance].class)
    }

    fn nearest(&self, p: DVec3) -> Option<(f64, &Triangle)> {
        self.buckets.crossings(p.truncate()).min_by(|a, b| (a.0 - p.z).abs().total_cmp(&(b.0 - p.z).abs()))
    }
}

/// The buildings, as bodies.
pub(crate) struct Solids {
    buckets: Buckets,
}

impl Solids {
    pub(crate) fn new(scene: &Scene) -> Self {
        Self { buckets: Buckets::new(triangles(scene, |i| scene.instances[i].class == Class::Building)) }
    }

    /// Whether a point lies deeper than `depth_m` in a building, as far as the plane goes.
    pub(crate) fn is_inside(&self, p: DVec3, depth_m: f64) -> bool {
        let around = [DVec2::ZERO, DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y];
        around.iter().all(|d| self.is_within(p + (*d * depth_m).extend(0.0)))
    }

    /// Whether the vertical line leaves a building above the point more often than it enters one.
    fn is_within(&self, p: DVec3) -> bool {
        let up = |t: &Triangle| if t.normal().z > 0.0 { 1 } else { -1 };
        self.buckets.crossings(p.truncate()).filter(|(z, _)| *z > p.z).map(|(_, t)| up(t)).sum::<i32>() > 0
    }
}

/// The convex outline of an object's body seen from above, counter-clockwise; a tree's is its trunk's foot.
pub(crate) fn foot_outline(scene: &Scene, instance: &Instance) -> Vec<DVec2> {
    let body_m = if instance.class == Class::Tree { TRUNK_M } else { BODY_M };
    let foot_m = instance.world_from_mesh.translation.z;
    let mesh = &scene.meshes[instance.mesh];
    let mut points = Vec::new();
    for t in &mesh.triangles {
        let corners = t.map(|i| instance.world_from_mesh.transform_point3(mesh.positions[i as usize].as_dvec3()));
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i], corners[j])) {
            let [low, high] = body_m.map(|z| ((foot_m + z - a.z) / (b.z - a.z)).clamp(0.0, 1.0));
            let touches = |t: f64| (body_m[0] - 1e-6..=body_m[1] + 1e-6).contains(&(a.z + t * (b.z - a.z) - foot_m));
            points.extend([low, high].into_iter().filter(|&t| touches(t)).map(|t| a.lerp(b, t).truncate()));
        }
    }
    hull(points)
}

/// Andrew's monotone chain (1979).
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for p in points {
            while chain.len() > 1 && {
                let [a, b] = [chain[chain.len() - 2], chain[chain.len() - 1]];
                (b - a).perp_dot(p - a) <= 0.0
            } {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut ring = half(&mut points.iter().copied());
    ring.extend(half(&mut points.iter().rev().copied()));
    ring
}

/// How far one of two convex outlines must move to leave the other, metres; 0 where they are apart.
pub(crate) fn overlap_m(a: &[DVec2], b: &[DVec2]) -> f64 {
    let span = |ring: &[DVec2], axis: DVec2| {
        ring.iter().map(|p| p.dot(axis)).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), d| (l.min(d), h.max(d)))
    };
    let mut least = f64::INFINITY;
    for ring in [a, b] {
        for i in 0..ring.len() {
            let Some(axis) = (ring[(i + 1) % ring.len()] - ring[i]).perp().try_normalize() else { continue };
            let ((a0, a1), (b0, b1)) = (span(a, axis), span(b, axis));
            least = least.min((a1 - b0).min(b1 - a0));
        }
    }
    least.max(0.0)
}

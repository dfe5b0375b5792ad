//! Shading normals.

use std::collections::HashMap;

use glam::Vec3;

use super::Shape;

/// Vertices nearer than this are one.
const WELD_M: f32 = 2e-5;

impl Shape {
    /// Normals made anew: faces that meet at less than `angle_rad` share one; triangles without area go.
    pub(crate) fn smooth(self, angle_rad: f32) -> Self {
        let cos_limit = angle_rad.cos();
        let mut weld: HashMap<[i32; 3], usize> = HashMap::new();
        let spots: Vec<usize> = self
            .positions
            .iter()
            .map(|&p| {
                let next = weld.len();
                *weld.entry((p / WELD_M).round().to_array().map(|x| x as i32)).or_insert(next)
            })
            .collect();

        // At every spot the faces that meet there, weighted with their angle.
        let mut meeting: Vec<Vec<(Vec3, f32)>> = vec![Vec::new(); weld.len()];
        let mut faces = Vec::with_capacity(self.triangles.len());
        for t in &self.triangles {
            let corner = t.map(|i| self.positions[i as usize]);
            let normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).try_normalize();
            let distinct = spots[t[0] as usize] != spots[t[1] as usize]
                && spots[t[1] as usize] != spots[t[2] as usize]
                && spots[t[2] as usize] != spots[t[0] as usize];
            let normal = normal.filter(|_| distinct);
            if let Some(normal) = normal {
                for k in 0..3 {
                    let (a, b) = (corner[(k + 1) % 3] - corner[k], corner[(k + 2) % 3] - corner[k]);
                    meeting[spots[t[k] as usize]].push((normal, a.angle_between(b)));
                }
            }
            faces.push(normal);
        }

        let mut made: HashMap<(u32, [i16; 3]), u32> = HashMap::new();
        let mut shape = Self::default();
        for ((t, &slot), face) in self.triangles.iter().zip(&self.slots).zip(&faces) {
            let Some(face) = face else { continue };
            let corners = t.map(|i| {
                let sum: Vec3 = meeting[spots[i as usize]]
                    .iter()
                    .filter(|(n, _)| n.dot(*face) >= cos_limit)
                    .map(|(n, weight)| *n * *weight)
                    .sum();
                let normal = sum.normalize_or(*face);
                let key = (i, (normal * 2000.0).round().to_array().map(|x| x as i16));
                *made
                    .entry(key)
                    .or_insert_with(|| shape.vertex(self.positions[i as usize], normal, self.uvs[i as usize]))
            });
            shape.triangles.push(corners);
            shape.slots.push(slot);
        }
        shape
    }
}

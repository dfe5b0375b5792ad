//! Ray against triangle without gaps between neighbours (Woop, Benthin, Wald 2013).

use glam::Vec3;

/// A ray sheared so that it runs along +z from the origin.
pub(super) struct Sheared {
    origin: Vec3,
    axes: [usize; 3],
    shear: Vec3,
}

impl Sheared {
    pub(super) fn new(origin: Vec3, direction: Vec3) -> Self {
        let kz = direction.abs().max_position();
        let (mut kx, mut ky) = ((kz + 1) % 3, (kz + 2) % 3);
        if direction[kz] < 0.0 {
            std::mem::swap(&mut kx, &mut ky);
        }
        let shear = Vec3::new(direction[kx] / direction[kz], direction[ky] / direction[kz], 1.0 / direction[kz]);
        Self { origin, axes: [kx, ky, kz], shear }
    }

    /// (t, u, v) where the ray meets the triangle between `t_min` and `t_max`, from either side.
    pub(super) fn intersect(&self, triangle: &[Vec3; 3], t_min: f32, t_max: f32) -> Option<(f32, f32, f32)> {
        let [kx, ky, kz] = self.axes;
        let [a, b, c] = triangle.map(|p| {
            let p = p - self.origin;
            Vec3::new(p[kx] - self.shear.x * p[kz], p[ky] - self.shear.y * p[kz], self.shear.z * p[kz])
        });
        let mut w = [c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x];
        // On an edge single precision cannot tell the side.
        if w.contains(&0.0) {
            let cross = |p: Vec3, q: Vec3| (f64::from(p.x) * f64::from(q.y) - f64::from(p.y) * f64::from(q.x)) as f32;
            w = [cross(c, b), cross(a, c), cross(b, a)];
        }
        if w.iter().any(|&e| e < 0.0) && w.iter().any(|&e| e > 0.0) {
            return None;
        }
        let det = w[0] + w[1] + w[2];
        if det == 0.0 {
            return None;
        }
        let t = (w[0] * a.z + w[1] * b.z + w[2] * c.z) / det;
        (t >= t_min && t < t_max).then(|| (t, w[1] / det, w[2] / det))
    }
}

//! Ray against triangle without gaps between neighbours (Woop, Benthin, Wald 2013).

use glam::Vec3;

/// A triangle: its corners in its mesh's metres and its number there.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(16))]
pub struct Corners {
    pub(crate) a: Vec3,
    pub(crate) triangle: u32,
    pub(crate) b: Vec3,
    b_end: u32,
    pub(crate) c: Vec3,
    c_end: u32,
}

impl Corners {
    /// Of the mesh's triangle of that number.
    pub fn new([a, b, c]: [Vec3; 3], triangle: u32) -> Self {
        Self { a, triangle, b, c, ..Self::default() }
    }
}

/// A ray sheared so that it runs along +z from the origin.
#[derive(Clone, Copy)]
pub(crate) struct Sheared {
    origin: Vec3,
    axes: [u32; 3],
    shear: Vec3,
}

impl Sheared {
    #[inline(always)]
    pub(crate) fn new(origin: Vec3, direction: Vec3) -> Self {
        let size = direction.abs();
        let kz = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let after = |k: u32| if k == 2 { 0 } else { k + 1 };
        let (mut kx, mut ky) = (after(kz), after(after(kz)));
        let along = |k| pick(direction, k);
        if along(kz) < 0.0 {
            core::mem::swap(&mut kx, &mut ky);
        }
        let shear = Vec3::new(along(kx) / along(kz), along(ky) / along(kz), 1.0 / along(kz));
        Self { origin, axes: [kx, ky, kz], shear }
    }

    /// (t, u, v) where the ray meets the triangle between `t_min` and `t_max`, from either side.
    #[inline(always)]
    pub(crate) fn intersect(&self, triangle: &Corners, t_min: f32, t_max: f32) -> Option<(f32, f32, f32)> {
        let [kx, ky, kz] = self.axes;
        let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|p| {
            let p = p - self.origin;
            let [x, y, z] = [pick(p, kx), pick(p, ky), pick(p, kz)];
            Vec3::new(x - self.shear.x * z, y - self.shear.y * z, self.shear.z * z)
        });
        let mut w = [c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x];
        // On an edge single precision cannot tell the side.
        if w.contains(&0.0) {
            w = [precise(c, b), precise(a, c), precise(b, a)];
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

fn precise(p: Vec3, q: Vec3) -> f32 {
    (f64::from(p.x) * f64::from(q.y) - f64::from(p.y) * f64::from(q.x)) as f32
}

/// A coordinate; on a card an index would send the vector to memory.
#[inline(always)]
fn pick(p: Vec3, axis: u32) -> f32 {
    match axis {
        0 => p.x,
        1 => p.y,
        _ => p.z,
    }
}

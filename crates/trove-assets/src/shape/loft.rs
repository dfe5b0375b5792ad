//! Surfaces swept through cross sections.

use std::f32::consts::TAU;

use glam::{Quat, Vec2, Vec3, vec2, vec3};

use super::form::{SMOOTH_RAD, Shape};

impl Shape {
    /// A skin over closed cross sections of equal length, each counter-clockwise seen from where the sweep goes to;
    /// closed at both ends. u runs around, v along, both 0 to 1.
    pub(crate) fn loft(rings: &[Vec<Vec3>]) -> Self {
        let closed: Vec<Vec<Vec3>> = rings.iter().map(|r| r.iter().chain(r.first()).copied().collect()).collect();
        let mut shape = Self::sheet(&closed);
        for (ring, is_start) in [(rings.first(), true), (rings.last(), false)] {
            let Some(ring) = ring else { continue };
            let middle = ring.iter().sum::<Vec3>() / ring.len() as f32;
            let centre = shape.vertex(middle, Vec3::Z, Vec2::ZERO);
            let rim: Vec<u32> = ring.iter().map(|&p| shape.vertex(p, Vec3::Z, Vec2::ZERO)).collect();
            for (i, &a) in rim.iter().enumerate() {
                let b = rim[(i + 1) % rim.len()];
                if is_start { shape.triangle(centre, b, a) } else { shape.triangle(centre, a, b) }
            }
        }
        shape.smooth(SMOOTH_RAD)
    }

    /// A skin over open rows of equal length, seen from where rows run to the right and the sweep goes up.
    pub(crate) fn sheet(rows: &[Vec<Vec3>]) -> Self {
        let mut shape = Self::default();
        let columns = rows.first().map_or(0, Vec::len);
        for (i, row) in rows.iter().enumerate() {
            for (j, &p) in row.iter().enumerate() {
                let uv = vec2(j as f32 / (columns - 1).max(1) as f32, i as f32 / (rows.len() - 1).max(1) as f32);
                shape.vertex(p, Vec3::Z, uv);
            }
        }
        for i in 1..rows.len() {
            for j in 1..columns {
                let (c, a) = ((i * columns + j) as u32, ((i - 1) * columns + j) as u32);
                shape.triangle(a - 1, a, c);
                shape.triangle(a - 1, c, c - 1);
            }
        }
        shape.smooth(SMOOTH_RAD)
    }

    /// A profile of (radius, z) points turned about the z axis, outside on the right when walking along it upwards;
    /// open where its ends are off the axis.
    pub(crate) fn lathe(profile: &[Vec2], around: usize) -> Self {
        let rows: Vec<Vec<Vec3>> = profile
            .iter()
            .map(|p| {
                (0..=around)
                    .map(|i| {
                        let angle = TAU * (i % around) as f32 / around as f32;
                        vec3(p.x * angle.cos(), p.x * angle.sin(), p.y)
                    })
                    .collect()
            })
            .collect();
        Self::sheet(&rows)
    }

    /// A closed cylinder along z from 0 to `height_m`.
    pub(crate) fn cylinder(radius_m: f32, height_m: f32, around: usize) -> Self {
        Self::lathe(&[vec2(0.0, 0.0), vec2(radius_m, 0.0), vec2(radius_m, height_m), vec2(0.0, height_m)], around)
    }

    /// A tube of one radius along a path, with flat ends.
    pub(crate) fn tube(path: &[Vec3], radius_m: f32, around: usize) -> Self {
        let path: Vec<(Vec3, f32)> = path.iter().map(|&p| (p, radius_m)).collect();
        Self::tapered_tube(&path, around)
    }

    /// A tube along a path with a radius for every point, with flat ends.
    pub(crate) fn tapered_tube(path: &[(Vec3, f32)], around: usize) -> Self {
        let direction = |i: usize| {
            let before = path[i.saturating_sub(1)].0;
            let after = path[(i + 1).min(path.len() - 1)].0;
            (after - before).normalize_or(Vec3::Z)
        };
        let mut along = direction(0);
        let mut side = along.any_orthonormal_vector();
        let rings: Vec<Vec<Vec3>> = (0..path.len())
            .map(|i| {
                // The side vector turns no more than the path itself, so that the tube does not twist.
                side = Quat::from_rotation_arc(along, direction(i)) * side;
                along = direction(i);
                let up = along.cross(side);
                let (centre, radius) = path[i];
                (0..around)
                    .map(|k| {
                        let angle = TAU * k as f32 / around as f32;
                        centre + (side * angle.cos() + up * angle.sin()) * radius
                    })
                    .collect()
            })
            .collect();
        Self::loft(&rings)
    }

    /// A bar with rounded ends between two points.
    pub(crate) fn capsule(from: Vec3, to: Vec3, radius_m: f32, around: usize) -> Self {
        let along = (to - from).normalize_or(Vec3::Z) * radius_m;
        let end = |centre: Vec3, sign: f32, angle: f32| (centre + along * sign * angle.sin(), radius_m * angle.cos());
        let angles = [1.5, 1.0, 0.5, 0.0];
        let path: Vec<(Vec3, f32)> =
            angles.iter().map(|&a| end(from, -1.0, a)).chain(angles.iter().rev().map(|&a| end(to, 1.0, a))).collect();
        Self::tapered_tube(&path, around)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn swept_solids_face_outwards_and_have_their_volume() {
        let bent = [vec3(0.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0), vec3(0.5, 0.0, 1.5), vec3(1.5, 0.0, 1.5)];
        for (shape, volume, tolerance) in [
            (Shape::cylinder(0.5, 2.0, 64), 1.571, 0.01),
            (Shape::tube(&[Vec3::ZERO, Vec3::X * 2.0], 0.5, 64), 1.571, 0.01),
            (Shape::tube(&bent, 0.1, 32), 0.085, 0.01),
            (Shape::capsule(Vec3::ZERO, Vec3::Y * 2.0, 0.5, 64), 2.094, 0.05),
        ] {
            assert!((shape.volume_m3() - volume).abs() < tolerance, "{} for {volume}", shape.volume_m3());
            assert_eq!(shape.into_mesh().defect(), None);
        }
    }

    #[test]
    fn a_cylinder_is_smooth_around_and_sharp_at_its_ends() {
        let cylinder = Shape::cylinder(1.0, 1.0, 24);
        for (p, n) in cylinder.positions.iter().zip(&cylinder.normals) {
            let radial = vec3(p.x, p.y, 0.0).normalize_or_zero();
            assert!(n.dot(radial) > 0.999 || n.z.abs() > 0.999, "{p} {n}");
        }
    }
}

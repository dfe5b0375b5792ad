//! What large surfaces of vehicles and loads are covered with: panels, canvas, boards, slats, gravel.

use std::sync::LazyLock;

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::Material;

use crate::shape::Shape;
use crate::surfaces::{Canvas, Noise, Texel, hash, step};

/// Plates 1.2 m wide with riveted seams, runs of dirt below every rivet.
pub(super) static PANEL: LazyLock<Material> = LazyLock::new(|| {
    let size = Vec2::splat(2.4);
    let (broad, runs) = (Noise::new(size, 0.6, 5), Noise::stretched(size, vec2(0.03, 1.2), 6));
    let canvas = Canvas::new([384, 384], size.to_array(), |p| {
        let x = (p.x + 0.6).rem_euclid(1.2) - 0.6;
        let mut texel = Texel::new(Vec3::splat(0.96), 0.32 + 0.08 * broad.fbm(p, 3));
        texel.tint(vec3(0.45, 0.42, 0.38), 0.16 * step(0.1, 0.9, runs.fbm(p, 2)) + 0.05 * broad.fbm(p, 3));
        if x.abs() < 0.0045 {
            texel.tint(Vec3::splat(0.2), 0.75);
        }
        let rivet = vec2(x.abs() - 0.03, (p.y + 0.05).rem_euclid(0.1) - 0.05).length();
        texel.height_m = 0.003 * step(0.009, 0.004, rivet) - 0.002 * step(0.006, 0.002, x.abs());
        texel
    });
    canvas.material("vehicle-panel", 2)
});

/// Coated cloth: wrinkles, creases from folding, stains.
pub(super) static CANVAS: LazyLock<Material> = LazyLock::new(|| {
    let size = Vec2::splat(2.0);
    let (folds, fine) = (Noise::stretched(size, vec2(0.22, 0.6), 15), Noise::new(size, 0.12, 16));
    let stains = Noise::new(size, 0.5, 17);
    let canvas = Canvas::new([384, 384], size.to_array(), |p| {
        let mut texel = Texel::new(Vec3::splat(0.92), 0.5);
        texel.tint(vec3(0.3, 0.27, 0.22), 0.28 * step(0.0, 0.9, stains.fbm(p, 4)));
        let crease = (folds.fbm(p, 3)).abs();
        texel.tint(Vec3::splat(0.55), 0.25 * step(0.06, 0.0, crease));
        texel.height_m = 0.02 * folds.fbm(p, 2) + 0.006 * fine.fbm(p, 2) - 0.002 * step(0.05, 0.0, crease);
        // Welded seams between the widths of cloth.
        let seam = (p.x.rem_euclid(1.0) - 0.5).abs();
        texel.height_m += 0.002 * step(0.03, 0.025, seam);
        texel
    });
    canvas.material("vehicle-canvas", 2)
});

/// Planks 14 cm wide along x.
pub(super) static BOARDS: LazyLock<Material> = LazyLock::new(|| {
    let size = vec2(1.68, 0.84);
    let grain = Noise::stretched(size, vec2(0.6, 0.012), 25);
    let canvas = Canvas::new([256, 128], size.to_array(), |p| {
        let plank = (p.y / 0.14).floor();
        let tone = 0.75 + 0.4 * hash(plank as i32, 3, 9) + 0.25 * grain.fbm(p, 3);
        let edge = (p.y.rem_euclid(0.14) - 0.07).abs();
        let mut texel = Texel::new(vec3(0.17, 0.12, 0.08) * tone, 0.8);
        texel.tint(Vec3::splat(0.01), step(0.064, 0.07, edge));
        texel.height_m = -0.006 * step(0.062, 0.07, edge);
        texel
    });
    canvas.material("vehicle-boards", 2)
});

/// Slats 6 cm high.
pub(super) static SLATS: LazyLock<Material> = LazyLock::new(|| {
    let size = Vec2::splat(0.48);
    let canvas = Canvas::new([64, 128], size.to_array(), |p| {
        let t = p.y.rem_euclid(0.06) / 0.06;
        let mut texel = Texel::new(Vec3::splat(0.52), 0.4);
        texel.tint(Vec3::splat(0.05), step(0.1, 0.0, t) + step(0.93, 1.0, t));
        texel.height_m = 0.008 * (1.0 - (2.0 * t - 1.0).powi(4));
        texel
    });
    canvas.material("vehicle-slats", 1)
});

/// Stones of a few centimetres.
pub(super) static GRAVEL: LazyLock<Material> = LazyLock::new(|| {
    let size = Vec2::splat(1.0);
    let (stones, broad) = (Noise::new(size, 0.035, 35), Noise::new(size, 0.25, 36));
    let canvas = Canvas::new([256, 256], size.to_array(), |p| {
        let near = stones.near(p);
        let mut texel = Texel::new(Vec3::splat(0.55 + 0.4 * near.id + 0.1 * broad.fbm(p, 2)), 0.9);
        texel.tint(Vec3::splat(0.12), 0.8 * step(0.18, 0.0, near.second - near.first));
        texel.height_m = 0.02 * (1.0 - near.first).max(0.0);
        texel
    });
    canvas.material("vehicle-gravel", 2)
});

/// A shape whose uvs are metres along whichever two axes each place faces least: x or y across, z up; x and y on top.
pub(crate) fn metric(mut shape: Shape) -> Shape {
    for ((uv, n), p) in shape.uvs.iter_mut().zip(&shape.normals).zip(&shape.positions) {
        let n = n.abs();
        *uv = if n.z > n.x.max(n.y) {
            vec2(p.x, p.y)
        } else if n.y > n.x {
            vec2(p.x, p.z)
        } else {
            vec2(p.y, p.z)
        };
    }
    shape
}

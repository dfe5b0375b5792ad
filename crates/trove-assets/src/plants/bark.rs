//! Bark: colour and relief; the uvs of branches are metres, half a metre of it goes around and a metre up.

use glam::{Vec3, vec2, vec3};
use serde::Deserialize;
use trove_model::Material;

use crate::surfaces::{Canvas, Noise, Texel, step};

/// How bark breaks up as the trunk grows.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Bark {
    /// Ridges with furrows between, so far apart in metres.
    Furrowed(f32),
    /// Thin scales fall off and leave patches of several colours: planes.
    Patches,
    /// White and peeling, with dark cross marks: birches.
    Birch,
    /// Thick plates between cracks: pines.
    Plates,
    /// Smooth and glossy with cross bands: cherries.
    Bands,
    /// Scars of fallen leaves: palms.
    Ringed,
    /// Long thin strips: cypresses.
    Strips,
}

/// The material of a trunk whose bark is of a colour (reflectance, linear).
pub(super) fn bark(name: &str, kind: Bark, color: Vec3, seed: u32) -> Material {
    let size = vec2(0.5, 1.0);
    let noise = |across: f32, up: f32, layer: u32| Noise::stretched(size, vec2(across, up), seed + layer);
    let (grain, moss) = (noise(0.02, 0.03, 1), noise(0.3, 0.3, 2));
    let wide = match kind {
        Bark::Furrowed(width) => width,
        Bark::Strips => 0.03,
        _ => 0.1,
    };
    let (ridges, bends) = (noise(wide, wide * 5.0, 3), noise(0.15, 0.15, 4));
    let cells = match kind {
        Bark::Patches => noise(0.08, 0.13, 5),
        _ => noise(0.055, 0.14, 5),
    };
    let marks = match kind {
        Bark::Birch => noise(0.07, 0.008, 6),
        _ => noise(0.12, 0.014, 6),
    };
    let scars = noise(0.25, 0.2, 7);
    let canvas = Canvas::new([192, 384], size.to_array(), |p| {
        let (fine, bend) = (grain.fbm(p, 2), bends.fbm(p, 2));
        let warped = p + vec2(bend, 0.5 * bend) * 0.02;
        let mut texel = Texel::new(color * (1.0 + 0.16 * fine), 0.92);
        match kind {
            Bark::Furrowed(_) | Bark::Strips => {
                // The zeros of noise are winding lines: furrows.
                let furrow = step(0.26, 0.02, ridges.fbm(warped, 2).abs());
                texel.albedo *= 1.08 - 0.62 * furrow;
                texel.height_m = wide * 0.22 * (1.0 - furrow) + 0.002 * fine;
            }
            Bark::Patches => {
                let near = cells.near(warped + vec2(bend, -bend) * 0.03);
                let shed = [vec3(1.0, 1.0, 1.0), vec3(1.75, 1.8, 1.6), vec3(1.35, 1.25, 1.0), vec3(0.75, 0.78, 0.68)];
                texel.albedo *= shed[((near.id * 4.0) as usize).min(3)];
                texel.height_m = 0.0025 * near.id + 0.0006 * fine;
            }
            Bark::Birch => {
                let mark = step(0.34, 0.5, marks.at(p));
                let scar = step(0.3, 0.55, scars.fbm(warped, 3));
                texel.albedo = texel.albedo.lerp(vec3(0.05, 0.045, 0.04), (0.85 * mark).max(0.95 * scar));
                texel.albedo *= vec3(1.0, 0.97, 0.92).lerp(Vec3::ONE, 0.5 + bend);
                texel.height_m = 0.0015 * (mark + 2.0 * scar);
            }
            Bark::Plates => {
                let near = cells.near(warped);
                let crack = step(0.22, 0.04, near.second - near.first);
                texel.albedo *= (0.75 + 0.5 * near.id) * (1.0 - 0.7 * crack);
                texel.tint(vec3(0.24, 0.11, 0.055), 0.35 * near.id * (1.0 - crack));
                texel.height_m = 0.014 * (1.0 - crack) + 0.003 * near.id + 0.002 * fine;
            }
            Bark::Bands => {
                let band = step(0.2, 0.5, marks.at(p));
                texel.albedo *= 1.0 + 0.7 * band;
                texel.roughness = 0.55 + 0.3 * band;
                texel.height_m = 0.003 * band + 0.001 * fine;
            }
            Bark::Ringed => {
                let scar = (std::f32::consts::TAU * (p.y + 0.004 * bend) * 9.0).sin();
                let ring = step(0.75, 1.0, scar);
                texel.albedo *= (1.0 + 0.12 * ridges.fbm(p, 2)) * (1.0 - 0.45 * ring);
                texel.height_m = 0.005 * (1.0 - ring) + 0.002 * fine;
            }
        }
        // Algae on the weather side, lichen in spots.
        let green = if matches!(kind, Bark::Birch | Bark::Ringed) { 0.2 } else { 0.4 };
        texel.tint(vec3(0.085, 0.095, 0.06), green * step(0.05, 0.6, moss.fbm(p, 3)));
        texel
    });
    canvas.material(name, 2)
}

//! What people's clothes and hair are made of.

use glam::{Vec2, Vec3, vec2};
use trove_model::{Mapping, Material};

use crate::surfaces::{Canvas, Noise, Texel};

/// Kinds of cloth, their textures made once for everyone.
#[derive(Clone, Debug)]
pub(super) struct Fabrics {
    /// Smooth cloth with small creases.
    pub(super) woven: Material,
    pub(super) denim: Material,
    pub(super) knit: Material,
    /// Horizontal stripes.
    pub(super) striped: Material,
    pub(super) checked: Material,
    /// Flowers and leaves.
    pub(super) printed: Material,
    pub(super) hair: Material,
}

const SIZE_M: [f32; 2] = [0.6, 0.6];

/// Creases as cloth has them that hangs: long ridges that lean and run out.
fn creases(p: Vec2) -> f32 {
    let size = Vec2::from_array(SIZE_M);
    let bend = vec2(Noise::new(size, 0.2, 3).at(p), Noise::new(size, 0.15, 4).at(p)) * 0.035;
    let ridges = Noise::stretched(size, vec2(0.05, 0.15), 5).at(p + bend).abs();
    let small = Noise::stretched(size, vec2(0.04, 0.025), 6).fbm(p + bend * 0.6, 2);
    0.007 * (1.0 - ridges).powi(2) + 0.0022 * small
}

fn cloth(name: &str, sheen: f32, texel: impl Fn(Vec2, &mut Texel)) -> Material {
    let canvas = Canvas::new([256, 256], SIZE_M, |p| {
        let mut t = Texel::new(Vec3::splat(0.92), 0.9);
        t.height_m = creases(p);
        texel(p, &mut t);
        t
    });
    Material { mapping: Mapping::Triplanar, sheen, orm_map: None, roughness: 0.88, ..canvas.material(name, 1) }
}

impl Fabrics {
    pub(super) fn new() -> Self {
        let size = Vec2::from_array(SIZE_M);
        let mottle = Noise::new(size, 0.05, 9);
        let denim = Noise::stretched(size, vec2(0.004, 0.02), 10);
        let folds = |p: Vec2| creases(p) / 0.009;
        let wave = |x: f32, per_m: f32| (x * per_m * std::f32::consts::TAU).sin();
        let flowers = Noise::new(size, 0.05, 14);
        let woven = cloth("woven", 0.4, |p, t| t.albedo *= 0.97 + 0.05 * mottle.at(p));
        let plain = |name: &str| Material { name: name.into(), ..woven.clone() };
        let coloured = |name: &str, texel: &dyn Fn(Vec2, &mut Texel)| {
            // The relief is everyone's.
            Material { normal_map: woven.normal_map.clone(), ..cloth(name, 0.4, texel) }
        };
        // Strands run along v; at its foot they end one by one.
        let hair = Canvas::new([128, 128], [1.0, 1.0], |p| {
            let strand = Noise::stretched(Vec2::ONE, vec2(0.03, 1.0), 31).fbm(p, 3);
            let mut t = Texel::new(Vec3::splat((0.72 + 0.5 * strand).clamp(0.25, 1.0)), 0.45);
            t.height_m = 0.012 * strand;
            let end = 0.09 + 0.16 * Noise::stretched(Vec2::ONE, vec2(0.025, 1.0), 33).fbm(p, 2);
            t.alpha = if p.y > end { 1.0 } else { 0.0 };
            t
        });
        Self {
            denim: coloured("denim", &|p, t| {
                t.albedo *= 0.82 + 0.16 * denim.at(p) + 0.25 * (folds(p) - 0.5) + 0.12 * mottle.at(p);
            }),
            knit: coloured("knit", &|p, t| t.albedo *= 0.9 + 0.1 * wave(p.x, 90.0) * wave(p.y, 60.0)),
            striped: coloured("striped", &|p, t| {
                if wave(p.y, 1.0 / 0.05) > 0.1 {
                    t.albedo *= 0.16;
                }
            }),
            checked: coloured("checked", &|p, t| {
                let line = |x: f32| 0.55 + 0.45 * (wave(x, 1.0 / 0.06) * 3.0).clamp(-1.0, 1.0);
                t.albedo *= Vec3::new(line(p.x), 0.7 * line(p.x) * line(p.y) + 0.1, line(p.y));
            }),
            printed: coloured("printed", &|p, t| {
                let near = flowers.near(p);
                if near.first < 0.32 {
                    t.albedo *= if near.id > 0.5 { Vec3::new(0.9, 0.35, 0.3) } else { Vec3::new(0.35, 0.5, 0.3) };
                }
            }),
            hair: Material { orm_map: None, roughness: 0.42, alpha_cutoff: 0.5, ..hair.material("hair", 1) },
            woven: plain("woven"),
        }
    }
}

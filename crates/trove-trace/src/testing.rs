//! What tests share.

use std::sync::LazyLock;
use std::vec::Vec;

use glam::{IVec3, Vec2, Vec3};

use crate::lookups::{Lookups, NOISE_SIDE};
use crate::material::{Material, random3};
use crate::ray::NONE;
use crate::texture::{Map, Texture};

/// No texture.
pub(crate) struct NoMap;

impl Map for NoMap {
    fn texture(&self) -> Option<Texture<'_>> {
        None
    }
}

/// A white material without textures.
pub(crate) fn plain() -> Material<NoMap> {
    Material {
        base_color: Vec3::ONE,
        roughness: 1.0,
        metalness: 0.0,
        f0: 0.04,
        coat: 0.0,
        flakes: 0.0,
        sheen: 0.0,
        subsurface: 0.0,
        transmission: 0.0,
        translucency: 0.0,
        dirt: 0.0,
        wetness: 0.0,
        height_m: 0.0,
        height_of_mesh: 0.0,
        emission: Vec3::ZERO,
        beam: NONE,
        scale: Vec2::ONE,
        base_color_map: NoMap,
        orm_map: NoMap,
        normal_map: NoMap,
        height_map: NoMap,
        emission_map: NoMap,
        is_triplanar: false,
        is_stochastic: false,
    }
}

/// With octaves of smooth noise, its bytes evenly spread.
pub(crate) static LOOKUPS: LazyLock<Lookups> = LazyLock::new(|| {
    let octave = |i: usize, nodes: usize| {
        let cells = NOISE_SIDE / nodes;
        let (x, y) = (i % NOISE_SIDE, i / NOISE_SIDE);
        let node = |x: usize, y: usize| random3(IVec3::new((x % nodes) as i32, (y % nodes) as i32, nodes as i32)).x;
        let (cx, cy) = (x / cells, y / cells);
        let [tx, ty] = [x % cells, y % cells].map(|part| part as f32 / cells as f32);
        let row = |y: usize| node(cx, y) + (node(cx + 1, y) - node(cx, y)) * tx;
        row(cy) + (row(cy + 1) - row(cy)) * ty
    };
    let value = |i: usize| octave(i, 16) + 0.55 * octave(i, 32) + 0.3 * octave(i, 64) + 0.17 * octave(i, 128);
    let values: Vec<f32> = (0..NOISE_SIDE * NOISE_SIDE).map(value).collect();
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut noise = [0; NOISE_SIDE * NOISE_SIDE];
    order.iter().enumerate().for_each(|(rank, &i)| noise[i] = (rank / NOISE_SIDE) as u8);
    Lookups::new(core::array::from_fn(|i| (i as f32 / 255.0).powf(2.2)), noise)
});

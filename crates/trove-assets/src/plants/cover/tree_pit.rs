//! The square that is left open in the paving around a tree.

use std::sync::Arc;

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{CoverKind, GroundCover, Material, Slot};

use crate::shape::Shape;

/// Side of the square, and width of the stones around it, metres.
const SIDE_M: f32 = 1.3;
const STONE_M: f32 = 0.09;
/// Grates leave this much around the trunk, metres.
const HOLE_M: f32 = 0.3;

pub(super) fn covers() -> Vec<GroundCover> {
    vec![pit("tree-pit-soil", false), pit("tree-pit-grate", true)]
}

fn pit(name: &str, grated: bool) -> GroundCover {
    let slot = |name: &str, color: Vec3, roughness: f32| {
        Slot::new(Material { dirt: 0.6, ..Material::plain(name, color, roughness) }, Vec::new())
    };
    let inner_m = SIDE_M - 2.0 * STONE_M;
    let soil = soil(inner_m, if grated { 0.0 } else { 0.035 });
    let grate = if grated { grate(inner_m).slot(2) } else { Shape::default() };
    let mut mesh = soil.and(frame().slot(1)).and(grate).into_mesh();
    mesh.uvs.clear();
    let mut slots = vec![slot("pit soil", vec3(0.105, 0.075, 0.05), 0.95), slot("pit stone", Vec3::splat(0.27), 0.85)];
    if grated {
        slots.push(slot("pit grate", vec3(0.055, 0.05, 0.045), 0.6));
    }
    let (id, side_m) = (format!("cover/{name}"), f64::from(SIDE_M));
    GroundCover { id, kind: CoverKind::TreePit, side_m, mesh: Arc::new(mesh), slots }
}

/// Four flush stones.
fn frame() -> Shape {
    let stone = |size: Vec2, at: Vec2| Shape::block(size.extend(0.012)).moved(at.extend(0.006));
    let off = (SIDE_M - STONE_M) / 2.0;
    let (long, short) = (vec2(SIDE_M, STONE_M), vec2(STONE_M, SIDE_M - 2.0 * STONE_M));
    Shape::join([
        stone(long, vec2(0.0, off)),
        stone(long, vec2(0.0, -off)),
        stone(short, vec2(off, 0.0)),
        stone(short, vec2(-off, 0.0)),
    ])
}

/// Earth that rises to the trunk and is lumpy.
fn soil(side_m: f32, rise_m: f32) -> Shape {
    const CELLS: u32 = 12;
    let mut shape = Shape::default();
    for y in 0..=CELLS {
        for x in 0..=CELLS {
            let p = (vec2(x as f32, y as f32) / CELLS as f32 - 0.5) * side_m;
            let edge = 1.0 - (2.0 * p.abs().max_element() / side_m).powi(4);
            let lump = 0.006 * ((x * 7 + y * 13) % 5) as f32 / 4.0;
            let z = 0.004 + edge * (rise_m * (1.0 - p.length() / side_m).max(0.0) + lump * rise_m / 0.035);
            shape.positions.push(p.extend(z));
            shape.normals.push(Vec3::Z);
            shape.uvs.push(p);
        }
    }
    for y in 0..CELLS {
        for x in 0..CELLS {
            let a = y * (CELLS + 1) + x;
            shape.triangles.extend([[a, a + 1, a + CELLS + 2], [a, a + CELLS + 2, a + CELLS + 1]]);
            shape.slots.extend([0, 0]);
        }
    }
    shape.smooth(1.0)
}

/// Iron bars around the trunk's hole.
fn grate(side_m: f32) -> Shape {
    const BARS: usize = 18;
    let pitch = side_m / BARS as f32;
    let bar = |from: f32, to: f32, y: f32| {
        Shape::block(vec3(to - from, pitch * 0.62, 0.006)).moved(vec3((from + to) / 2.0, y, 0.009))
    };
    let half = side_m / 2.0;
    let mut bars = Vec::new();
    for i in 0..BARS {
        let y = (i as f32 + 0.5) * pitch - half;
        let hole = (HOLE_M * HOLE_M - y * y).max(0.0).sqrt();
        if hole > 0.0 {
            bars.extend([bar(-half, -hole, y), bar(hole, half, y)]);
        } else {
            bars.push(bar(-half, half, y));
        }
    }
    Shape::join(bars)
}

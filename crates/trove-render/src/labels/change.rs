//! Where two scenes differ that are looked at in the same way.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;
use trove_model::{Class, Material, Raster, Scene, Shot, Texture};

use super::{geometry, ray};
use crate::PreparedScene;
use crate::prepare::{Carrier, Surface};

/// Depths that differ by less than this share are those of the same surface.
const SAME_DEPTH: f64 = 1e-4;
/// The same for normals, texture coordinates and tints, which depend on how a surface is cut into triangles.
const SAME: f64 = 1e-3;

/// What a ray meets first.
struct Met {
    class: Class,
    range_m: f64,
    normal: DVec3,
    material: u32,
    uv: Vec2,
    tint: Vec3,
}

/// The pixels through whose centres the first surface of one scene differs from that of the other: in class, in range or
/// normal, in its material, or in the texture coordinates or tint by which the material varies. What only light changes
/// (shadows, reflections, what shines) is no difference.
pub(crate) fn changes([before, after]: [(&Scene, &PreparedScene); 2], shot: &Shot) -> Raster<bool> {
    let (width, height) = (shot.lens.width_px, shot.lens.height_px);
    let eye = shot.world_from_camera.translation.as_vec3();
    let carriers = [before.1, after.1].map(|scene| Carrier::new(scene, shot.carrier, eye));
    let row = |y: u32| {
        // Of two materials, by their indices, whether they look the same.
        let mut known: BTreeMap<[u32; 2], bool> = BTreeMap::new();
        let mut differs = |x: u32| {
            let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let Some(direction) = shot.lens.unproject(centre) else { return false };
            let direction = shot.world_from_camera.vector(direction);
            let [a, b] =
                match (met(before.1, &carriers[0], shot, direction), met(after.1, &carriers[1], shot, direction)) {
                    (Some(a), Some(b)) => [a, b],
                    (a, b) => return a.is_some() != b.is_some(),
                };
            let is_same = a.class == b.class
                && (a.range_m - b.range_m).abs() <= SAME_DEPTH * a.range_m
                && a.normal.dot(b.normal) >= 1.0 - SAME
                && a.tint.abs_diff_eq(b.tint, SAME as f32)
                && *known.entry([a.material, b.material]).or_insert_with(|| {
                    let [a, b] = [(before.0, a.material), (after.0, b.material)];
                    looks_like(&a.0.materials[a.1 as usize], &b.0.materials[b.1 as usize])
                })
                && (a.uv.abs_diff_eq(b.uv, SAME as f32) || !is_textured(after.0, b.material));
            !is_same
        };
        (0..width).map(&mut differs).collect::<Vec<bool>>()
    };
    let rows: Vec<Vec<bool>> = (0..height).into_par_iter().map(row).collect();
    Raster { width, height, data: rows.concat() }
}

fn met(scene: &PreparedScene, carrier: &Carrier, shot: &Shot, direction: DVec3) -> Option<Met> {
    let ray = carrier.past(ray(shot, direction));
    let hit = scene.intersect_past(&ray, carrier)?;
    let instance = &scene.instances[hit.instance as usize];
    let seen = geometry::seen(scene, &hit, shot.world_from_camera.translation, direction);
    let surface = Surface::new(scene, &hit, &ray);
    Some(Met {
        class: instance.class,
        range_m: seen.range_m,
        normal: seen.normal,
        material: instance.materials[usize::from(instance.mesh.slot(hit.triangle as usize))],
        uv: surface.uv,
        tint: surface.tint,
    })
}

fn is_textured(scene: &Scene, material: u32) -> bool {
    scene.materials[material as usize].textures().next().is_some()
}

/// Whether two materials are equal; textures are told apart by their names, which mean the same image everywhere.
fn looks_like(a: &Material, b: &Material) -> bool {
    let names = |m: &Material| {
        let name = |texture: &Option<std::sync::Arc<Texture>>| texture.as_ref().map(|t| t.name.clone());
        [&m.base_color_map, &m.orm_map, &m.normal_map, &m.height_map].map(name)
    };
    let bare = |m: &Material| Material {
        base_color_map: None,
        orm_map: None,
        normal_map: None,
        height_map: None,
        emission: Vec3::ZERO,
        ..m.clone()
    };
    names(a) == names(b) && bare(a) == bare(b)
}

//! Where two scenes differ that are looked at in the same way.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;
use trove_model::{Class, Mapping, Material, Raster, Scene, SensorRay, Shot, Texture, Tiling};

use crate::PreparedScene;
use crate::prepare::Carrier;
use crate::sight;

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
    let carriers = [before.1, after.1].map(|scene| Carrier::of_labels(scene, None, shot));
    let row = |y: u32| {
        // Of two materials, by their indices, whether they look the same.
        let mut known: BTreeMap<[u32; 2], bool> = BTreeMap::new();
        let mut differs = |x: u32| {
            let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let Some(direction) = shot.lens.unproject(centre) else { return false };
            let ray = shot.label_ray(direction);
            let [a, b] = match (met(before.1, &carriers[0], &ray), met(after.1, &carriers[1], &ray)) {
                (Some(a), Some(b)) => [a, b],
                (a, b) => return a.is_some() != b.is_some(),
            };
            let is_same = a.class == b.class
                && (a.range_m - b.range_m).abs() <= SAME_DEPTH * a.range_m
                && a.normal.dot(b.normal) >= 1.0 - SAME
                && a.tint.abs_diff_eq(b.tint, SAME as f32)
                && *known.entry([a.material, b.material]).or_insert_with(|| {
                    let [a, b] = [(before.0, a.material), (after.0, b.material)];
                    Look::of(&a.0.materials[a.1 as usize]) == Look::of(&b.0.materials[b.1 as usize])
                })
                && (a.uv.abs_diff_eq(b.uv, SAME as f32) || !is_textured(after.0, b.material));
            !is_same
        };
        (0..width).map(&mut differs).collect::<Vec<bool>>()
    };
    let rows: Vec<Vec<bool>> = (0..height).into_par_iter().map(row).collect();
    Raster { width, height, data: rows.concat() }
}

fn met(scene: &PreparedScene, carrier: &Carrier, ray: &SensorRay) -> Option<Met> {
    let seen = sight::seen_by_one(scene, carrier, ray)?;
    let (surface, _) = scene.surface(&seen.hit, &seen.ray);
    Some(Met {
        class: scene.instances[seen.hit.instance as usize].class,
        range_m: seen.range_m,
        normal: seen.normal,
        material: scene.placed(seen.hit.instance).material(&seen.hit) as u32,
        uv: surface.uv,
        tint: surface.tint,
    })
}

fn is_textured(scene: &Scene, material: u32) -> bool {
    scene.materials[material as usize].textures().next().is_some()
}

/// What of a material the eye can tell; two materials that agree in it look the same.
#[derive(PartialEq)]
struct Look<'a> {
    name: &'a str,
    /// By their names, which mean the same image everywhere.
    maps: [Option<&'a str>; 4],
    base_color: Vec3,
    numbers: [f32; 13],
    texturing: (Vec2, Mapping, Tiling),
}

impl<'a> Look<'a> {
    /// Takes the material apart whole: a new field does not compile until it is compared.
    fn of(material: &'a Material) -> Self {
        let Material {
            name,
            base_color,
            base_color_map,
            alpha_cutoff,
            roughness,
            metalness,
            orm_map,
            normal_map,
            height_map,
            height_m,
            ior,
            coat,
            flakes,
            sheen,
            subsurface,
            transmission,
            translucency,
            retroreflection: _,
            // Light alone is no difference.
            emission: _,
            emission_map: _,
            beam: _,
            dirt,
            wetness,
            uv_scale,
            mapping,
            tiling,
            // What it does is seen elsewhere, if at all.
            role: _,
        } = material;
        let image = |texture: &'a Option<Arc<Texture>>| texture.as_ref().map(|t| t.name.as_str());
        Self {
            name,
            maps: [base_color_map, orm_map, normal_map, height_map].map(image),
            base_color: *base_color,
            numbers: [
                *alpha_cutoff,
                *roughness,
                *metalness,
                *height_m,
                *ior,
                *coat,
                *flakes,
                *sheen,
                *subsurface,
                *transmission,
                *translucency,
                *dirt,
                *wetness,
            ],
            texturing: (*uv_scale, *mapping, *tiling),
        }
    }
}

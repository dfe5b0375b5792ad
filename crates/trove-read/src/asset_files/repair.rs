//! Models made fit to be rendered: what is broken goes, what is missing is computed, what is too much is thinned out.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};
use meshopt::{SimplifyOptions, VertexDataAdapter};
use trove_model::{Mesh, Outcome};

use super::fault::Fault;
use super::model::Model;

/// Triangles that an asset may have.
pub(super) const BUDGET: usize = 100_000;

/// The value, or a notice that it is left out.
pub(super) fn kept<T>(result: Result<T, String>, name: &str, model: &mut Model) -> Option<T> {
    match result {
        Ok(value) => Some(value),
        Err(found) => {
            model.notice(Outcome::Dropped, "a texture was left out", format!("{name}: {found}"));
            None
        }
    }
}

/// Drops triangles that cannot be drawn, computes missing normals, and keeps to the budget of triangles. A model
/// without a triangle is refused.
pub(super) fn repair(model: &mut Model) -> Result<(), Fault> {
    let (broken, flat) = drop_broken(&mut model.mesh);
    for (count, what) in
        [(broken, "triangles with invalid vertices were dropped"), (flat, "triangles without area were dropped")]
    {
        if count > 0 {
            model.notice(Outcome::Dropped, what, format!("{count}"));
        }
    }
    if model.mesh.triangles.is_empty() {
        let remedy = "export its meshes as triangles; points, lines and curves are not drawn";
        return Err(Fault::new("model", "at least one triangle", "none", remedy));
    }
    let before = model.mesh.triangles.len();
    if before > BUDGET {
        simplify(&mut model.mesh, BUDGET);
        model.notice(
            Outcome::Substituted,
            "a model was simplified",
            format!("{before} triangles became {}", model.mesh.triangles.len()),
        );
    }
    compact(&mut model.mesh);
    let sound =
        |values: &mut Vec<Vec2>| values.iter_mut().for_each(|v| *v = if v.is_finite() { *v } else { Vec2::ZERO });
    sound(&mut model.mesh.uvs);
    model.mesh.tints.iter_mut().for_each(|t| *t = if t.is_finite() { t.max(Vec3::ZERO) } else { Vec3::ONE });
    fill_normals(&mut model.mesh);
    if model.mesh.uvs.iter().all(|uv| *uv == Vec2::ZERO)
        && model.materials.iter().all(|m| m.textures().next().is_none())
    {
        model.mesh.uvs = Vec::new();
    }
    Ok(())
}

/// Leaves about `triangles` of a sound mesh.
pub(super) fn thinned(mesh: &mut Mesh, triangles: usize) {
    simplify(mesh, triangles);
    compact(mesh);
}

/// How many triangles had corners that are missing or no numbers, and how many had no area.
fn drop_broken(mesh: &mut Mesh) -> (usize, usize) {
    let (mut broken, mut flat) = (0, 0);
    let mut keep = Vec::with_capacity(mesh.triangles.len());
    for t in &mesh.triangles {
        let corners =
            t.map(|i| mesh.positions.get(i as usize).copied().filter(|p| p.is_finite() && p.abs().max_element() < 1e9));
        let [Some(a), Some(b), Some(c)] = corners else {
            broken += 1;
            keep.push(false);
            continue;
        };
        let area = (b - a).as_dvec3().cross((c - a).as_dvec3()).length_squared();
        flat += usize::from(area <= 0.0);
        keep.push(area > 0.0);
    }
    retain(mesh, &keep);
    (broken, flat)
}

fn retain(mesh: &mut Mesh, keep: &[bool]) {
    let mut flags = keep.iter();
    mesh.triangles.retain(|_| flags.next().copied().unwrap_or(false));
    let mut flags = keep.iter();
    mesh.slots.retain(|_| flags.next().copied().unwrap_or(false));
}

/// Collapses edges by their quadric error (Garland and Heckbert 1997), slot by slot; what resists is clustered.
fn simplify(mesh: &mut Mesh, budget: usize) {
    let all = mesh.triangles.len();
    let positions: Vec<[f32; 3]> =
        mesh.positions.iter().map(|p| if p.is_finite() { p.to_array() } else { [0.0; 3] }).collect();
    let bytes: Vec<u8> = positions.iter().flatten().flat_map(|v| v.to_ne_bytes()).collect();
    let Ok(vertices) = VertexDataAdapter::new(&bytes, 12, 0) else { return };
    let (mut triangles, mut slots) = (Vec::new(), Vec::new());
    for slot in 0..mesh.slot_count() as u16 {
        let corners: Vec<u32> = (0..all).filter(|&t| mesh.slot(t) == slot).flat_map(|t| mesh.triangles[t]).collect();
        // Each slot keeps its share, and a small one all of it.
        let target = (corners.len() * budget / all).max(corners.len().min(600)) / 3 * 3;
        let mut fewer = meshopt::simplify(&corners, &vertices, target, 0.05, SimplifyOptions::None, None);
        if fewer.len() > target * 3 / 2 {
            fewer = meshopt::simplify_sloppy(&corners, &vertices, target, 0.1, None);
        }
        slots.extend(std::iter::repeat_n(slot, fewer.len() / 3));
        triangles.extend(fewer.chunks_exact(3).map(|c| [c[0], c[1], c[2]]));
    }
    mesh.triangles = triangles;
    mesh.slots = slots;
}

/// Drops vertices that no triangle uses.
fn compact(mesh: &mut Mesh) {
    let mut new = vec![u32::MAX; mesh.positions.len()];
    let mut used = Vec::new();
    for i in mesh.triangles.iter_mut().flatten() {
        let entry = &mut new[*i as usize];
        if *entry == u32::MAX {
            *entry = used.len() as u32;
            used.push(*i as usize);
        }
        *i = *entry;
    }
    fn pick<T: Copy>(values: &mut Vec<T>, used: &[usize]) {
        if !values.is_empty() {
            *values = used.iter().map(|&i| values[i]).collect();
        }
    }
    pick(&mut mesh.positions, &used);
    pick(&mut mesh.normals, &used);
    pick(&mut mesh.uvs, &used);
    pick(&mut mesh.tints, &used);
}

/// Triangles that meet at less than this angle are parts of one curved surface, cosine of 35°.
const CREASE: f32 = 0.82;

/// Missing normals become the mean of the triangles' around them, by area, as far as those bend no more than a crease.
fn fill_normals(mesh: &mut Mesh) {
    let missing: Vec<bool> = mesh.normals.iter().map(|n| !n.is_finite() || n.length_squared() < 1e-6).collect();
    if missing.iter().any(|m| *m) {
        let faces: Vec<Vec3> = mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
                (b - a).cross(c - a)
            })
            .collect();
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); mesh.positions.len()];
        for (t, corners) in mesh.triangles.iter().enumerate() {
            corners.iter().filter(|&&i| missing[i as usize]).for_each(|&i| around[i as usize].push(t as u32));
        }
        // A vertex at a crease becomes several.
        let mut split: BTreeMap<(u32, [i32; 3]), u32> = BTreeMap::new();
        for t in 0..mesh.triangles.len() {
            let own = faces[t].normalize_or_zero();
            for k in 0..3 {
                let i = mesh.triangles[t][k];
                if around.get(i as usize).is_none_or(|a| a.is_empty()) {
                    continue;
                }
                let near = around[i as usize].iter().take(64).map(|&f| faces[f as usize]);
                let sum: Vec3 = near.filter(|n| n.normalize_or_zero().dot(own) > CREASE).sum();
                let normal = sum.try_normalize().unwrap_or(Vec3::Z);
                let key = (i, (normal * 500.0).round().as_ivec3().to_array());
                mesh.triangles[t][k] = *split.entry(key).or_insert_with(|| copy(mesh, i as usize, normal));
            }
        }
        compact(mesh);
    }
    mesh.normals.iter_mut().for_each(|n| *n = n.try_normalize().unwrap_or(Vec3::Z));
}

/// Adds a vertex like another, with a normal of its own.
fn copy(mesh: &mut Mesh, vertex: usize, normal: Vec3) -> u32 {
    mesh.positions.push(mesh.positions[vertex]);
    mesh.normals.push(normal);
    if let Some(&uv) = mesh.uvs.get(vertex) {
        mesh.uvs.push(uv);
    }
    if let Some(&tint) = mesh.tints.get(vertex) {
        mesh.tints.push(tint);
    }
    mesh.positions.len() as u32 - 1
}

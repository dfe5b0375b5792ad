//! FBX and Wavefront OBJ, by `ufbx`, which is hardened against damaged files.

mod material;

use std::collections::BTreeMap;
use std::path::Path;

use glam::{Mat4, Vec3, vec2, vec3};
use trove_files::{Folder, open_regular};
use trove_model::{Material, Outcome};

use super::fault::Fault;
use super::model::{Model, Piece};
use super::picture::Pictures;
use crate::ReadError;
use trove_files::Budget;

/// Reads a file's bytes; with `part` only the node of that name and what hangs on it. FBX files come in metres with y
/// up, by what they say of their units and axes; OBJ files say nothing and come as they are.
pub(super) fn read(path: &Path, bytes: &[u8], part: Option<&str>, pictures: &Pictures) -> Result<Model, ReadError> {
    let is_fbx = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("fbx"));
    let budget = Budget::of_file(bytes.len() as u64);
    let memory = budget.left() as usize;
    load(path, bytes, is_fbx, memory, &pictures.folder)
        .and_then(|scene| assemble(&scene, path, part, pictures, is_fbx, &budget))
        .map_err(|f| f.at(path))
}

fn load(path: &Path, bytes: &[u8], is_fbx: bool, memory: usize, library: &Folder) -> Result<ufbx::SceneRoot, Fault> {
    let name = path.to_string_lossy();
    let allocator = || ufbx::AllocatorOpts { memory_limit: memory, ..Default::default() };
    let mut materials = |name: &str, info: &ufbx::OpenFileInfo| {
        let file = Path::new(name);
        let wanted = info.type_ == ufbx::OpenFileType::ObjMtl && library.check(file).is_ok();
        wanted.then(|| open_regular(file).ok()).flatten().map(ufbx::Stream::File)
    };
    let mut options = ufbx::LoadOpts {
        temp_allocator: allocator(),
        result_allocator: allocator(),
        file_format: if is_fbx { ufbx::FileFormat::Fbx } else { ufbx::FileFormat::Obj },
        filename: (&*name).into(),
        // An OBJ's materials are a file of their own.
        load_external_files: !is_fbx,
        ignore_missing_external_files: true,
        open_file_cb: ufbx::OpenFileCb::Mut(&mut materials),
        obj_search_mtl_by_filename: true,
        evaluate_skinning: true,
        node_depth_limit: 512,
        ..Default::default()
    };
    if is_fbx {
        options.target_axes = ufbx::CoordinateAxes {
            right: ufbx::CoordinateAxis::PositiveX,
            up: ufbx::CoordinateAxis::PositiveY,
            front: ufbx::CoordinateAxis::PositiveZ,
        };
        options.target_unit_meters = 1.0;
    }
    let what = if is_fbx { "an FBX file" } else { "an OBJ file" };
    let fault = |e: ufbx::Error| Fault::damaged("content", what, e.description.to_string());
    let scene = ufbx::load_memory(bytes, options).map_err(fault)?;
    let idle = |stack: &&ufbx::AnimStack| {
        let name = stack.element.name.to_lowercase();
        name.contains("idle") || name.contains("stand")
    };
    let stacks = || scene.anim_stacks.iter().map(|s| &**s);
    let Some(stack) = stacks().find(idle).or_else(|| stacks().next()) else { return Ok(scene) };
    let options = ufbx::EvaluateOpts { evaluate_skinning: true, ..Default::default() };
    ufbx::evaluate_scene(&scene, &stack.anim, stack.time_begin, options).map_err(fault)
}

fn assemble(
    scene: &ufbx::Scene,
    path: &Path,
    part: Option<&str>,
    pictures: &Pictures,
    is_fbx: bool,
    budget: &Budget,
) -> Result<Model, Fault> {
    let mut model = Model { declared: is_fbx, ..Model::default() };
    let mut slots = BTreeMap::new();
    let mut any = false;
    for node in scene.nodes.iter() {
        let Some(mesh) = &node.mesh else { continue };
        if part.is_some_and(|part| !hangs_on(node, part)) || !node.visible {
            continue;
        }
        any = true;
        // Skinned positions are in the file's axes unless they say otherwise.
        let matrix = if mesh.skinned_is_local { matrix(&node.geometry_to_world) } else { Mat4::IDENTITY };
        for (material, piece) in pieces(mesh, &mut model) {
            let source = node.materials.iter().chain(mesh.materials.iter()).nth(material as usize);
            let key = source.map(|m| m.element.element_id);
            let slot = *slots.entry(key).or_insert_with(|| {
                let made = source.map_or_else(Material::default, |m| material::look(m, path, pictures, &mut model));
                model.materials.push(made);
                model.materials.len() - 1
            });
            model.add(&node.element.name, piece, matrix, slot, false, budget)?;
        }
    }
    if let (Some(part), false) = (part, any) {
        let names: Vec<&str> =
            scene.nodes.iter().map(|n| &*n.element.name).filter(|n| !n.is_empty()).take(20).collect();
        return Err(Fault::new(
            "nodes",
            format!("one named {part:?}"),
            names.join(", "),
            "correct `part` in library.toml",
        ));
    }
    model.mark_materials();
    Ok(model)
}

fn hangs_on(node: &ufbx::Node, part: &str) -> bool {
    &*node.element.name == part || node.parent.as_ref().is_some_and(|parent| hangs_on(parent, part))
}

fn matrix(m: &ufbx::Matrix) -> Mat4 {
    let column = |x: f64, y: f64, z: f64, w: f32| vec3(x as f32, y as f32, z as f32).extend(w);
    Mat4::from_cols(
        column(m.m00, m.m10, m.m20, 0.0),
        column(m.m01, m.m11, m.m21, 0.0),
        column(m.m02, m.m12, m.m22, 0.0),
        column(m.m03, m.m13, m.m23, 1.0),
    )
}

/// A mesh's triangles by the number of their material.
fn pieces(mesh: &ufbx::Mesh, model: &mut Model) -> BTreeMap<u32, Piece> {
    let mut pieces: BTreeMap<u32, (Piece, BTreeMap<[u32; 4], u32>)> = BTreeMap::new();
    let mut corners = Vec::new();
    let mut odd = 0;
    for (f, &face) in mesh.faces.iter().enumerate() {
        if face.num_indices < 3 {
            odd += 1;
            continue;
        }
        let count = ufbx::triangulate_face_vec(&mut corners, mesh, face) as usize;
        let material = mesh.face_material.get(f).copied().unwrap_or(0);
        let (piece, seen) = pieces.entry(material).or_default();
        for triangle in corners[..(3 * count).min(corners.len())].chunks_exact(3) {
            let mut new = |i: usize| {
                let index = triangle[i] as usize;
                *seen.entry(parts(mesh, index)).or_insert_with(|| vertex(mesh, index, piece))
            };
            let corners = [new(0), new(1), new(2)];
            piece.triangles.push(corners);
        }
    }
    if odd > 0 {
        model.notice(Outcome::Dropped, "points and lines are not drawn", format!("{odd} in {:?}", &*mesh.element.name));
    }
    pieces.into_iter().map(|(material, (piece, _))| (material, piece)).collect()
}

/// Which position, normal, texture coordinate and colour a corner has: corners that share all of them are one vertex.
fn parts(mesh: &ufbx::Mesh, index: usize) -> [u32; 4] {
    let [p, n, uv, c] = [
        &mesh.vertex_position.indices,
        &mesh.vertex_normal.indices,
        &mesh.vertex_uv.indices,
        &mesh.vertex_color.indices,
    ];
    [p, n, uv, c].map(|indices| indices.get(index).copied().unwrap_or(u32::MAX))
}

/// Adds a corner of a mesh to a piece.
fn vertex(mesh: &ufbx::Mesh, index: usize, piece: &mut Piece) -> u32 {
    fn at<T: Copy>(values: &[T], indices: &[u32], index: usize) -> Option<T> {
        values.get(*indices.get(index)? as usize).copied()
    }
    let vector = |v: Option<ufbx::Vec3>| v.map_or(Vec3::NAN, |v| vec3(v.x as f32, v.y as f32, v.z as f32));
    let positions = if mesh.skinned_position.exists { &mesh.skinned_position } else { &mesh.vertex_position };
    piece.positions.push(vector(at(&positions.values, &positions.indices, index)));
    let normals = if mesh.skinned_normal.exists { &mesh.skinned_normal } else { &mesh.vertex_normal };
    if normals.exists {
        piece.normals.push(vector(at(&normals.values, &normals.indices, index)));
    }
    if mesh.vertex_uv.exists {
        let uv = at(&mesh.vertex_uv.values, &mesh.vertex_uv.indices, index);
        piece.uvs.push(uv.map_or(vec2(0.0, 0.0), |uv| vec2(uv.x as f32, uv.y as f32)));
    }
    if mesh.vertex_color.exists {
        let c = at(&mesh.vertex_color.values, &mesh.vertex_color.indices, index);
        piece.tints.push(c.map_or(Vec3::ONE, |c| vec3(c.x as f32, c.y as f32, c.z as f32)));
    }
    piece.positions.len() as u32 - 1
}

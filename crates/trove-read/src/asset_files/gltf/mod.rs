//! glTF 2.0 and GLB.
//!
//! An own reader: the `gltf` crate lacks the clear coat, and its accessors trust counts and offsets.

mod accessor;
mod container;
mod json;
mod material;
mod packed;
mod pose;
mod primitive;
mod scene;
mod texture;

use std::path::Path;

use glam::{Mat4, Vec3};
use trove_model::Outcome;

use self::container::{Container, none};
use self::material::Looks;
use self::pose::Pose;
use self::primitive::Geometry;
use super::fault::Fault;
use super::model::{Model, Piece};
use super::picture::Pictures;
use crate::ReadError;

pub use self::scene::{FileCamera, FileNode, FileScene, read_scene};

/// Reads a file's bytes; with `part` only the node of that name and what hangs on it.
pub(super) fn read(path: &Path, bytes: &[u8], part: Option<&str>, pictures: &Pictures) -> Result<Model, ReadError> {
    let container = packed::open(path, bytes, &pictures.folder)?;
    assemble(&container, part, pictures).map_err(|fault| fault.at(path))
}

fn assemble(container: &Container, part: Option<&str>, pictures: &Pictures) -> Result<Model, Fault> {
    let mut model = Model { declared: true, ..Model::default() };
    let extra = |key: &str| container.root.asset.extras.get(key)?.as_str().map(str::to_owned);
    model.licence = extra("license").or_else(|| container.root.asset.copyright.clone());
    model.author = extra("author");
    model.source = extra("source");
    let pose = Pose::of(container)?;
    if let Some(repair) = &pose.repair {
        model.notice(Outcome::Substituted, "a loop in the tree of nodes was cut", repair.clone());
    }
    let mut looks = Looks::new(container, pictures);
    let wanted = part.map(|part| descendants(container, part)).transpose()?;
    for &(i, file_from_node) in &pose.placed {
        let node = &container.root.nodes[i];
        if node.mesh.is_some() && wanted.as_ref().is_none_or(|w| w.contains(&i)) {
            add_node(container, (i, file_from_node), &pose, &mut looks, &mut model)?;
        }
    }
    model.mark_materials();
    Ok(model)
}

/// Adds the mesh of a node; what has joints is moved by them alone.
fn add_node(
    container: &Container,
    (i, file_from_node): (usize, Mat4),
    pose: &Pose,
    looks: &mut Looks,
    model: &mut Model,
) -> Result<(), Fault> {
    let node = &container.root.nodes[i];
    let Some(mesh) = node.mesh else { return Ok(()) };
    let meshes = &container.root.meshes;
    let mesh_of = meshes.get(mesh).ok_or_else(|| none(&format!("nodes[{i}]"), "mesh", mesh, meshes.len()))?;
    let weights = pose.morphs.get(&i).unwrap_or(if node.weights.is_empty() { &mesh_of.weights } else { &node.weights });
    for (p, primitive) in mesh_of.primitives.iter().enumerate() {
        let place = format!("meshes[{mesh}].primitives[{p}]");
        let look = looks.of(primitive.material, model)?;
        let Some(mut geometry) = Geometry::read(container, primitive, look.uv_set, weights, &place)? else {
            model.notice(Outcome::Dropped, "points and lines are not drawn", place);
            continue;
        };
        let matrix = match node.skin {
            Some(skin) => skinned(container, skin, pose, &mut geometry)?,
            None => file_from_node,
        };
        let name = node.name.as_deref().unwrap_or_default();
        let uvs = geometry.uvs.iter().map(|&uv| look.uv(uv)).collect();
        let Geometry { positions, normals, tints, triangles, .. } = geometry;
        let piece = Piece { positions, normals, uvs, tints, triangles };
        model.add(name, piece, matrix, look.slot, look.two_sided_light, &container.budget)?;
    }
    Ok(())
}

/// The node of a name and everything below it.
fn descendants(container: &Container, part: &str) -> Result<std::collections::BTreeSet<usize>, Fault> {
    let nodes = &container.root.nodes;
    let Some(first) = nodes.iter().position(|n| n.name.as_deref() == Some(part)) else {
        let names: Vec<&str> = nodes.iter().filter_map(|n| n.name.as_deref()).take(20).collect();
        return Err(Fault::new(
            "nodes",
            format!("one named {part:?}"),
            names.join(", "),
            "correct `part` in library.toml",
        ));
    };
    let mut found = std::collections::BTreeSet::new();
    let mut stack = vec![first];
    while let Some(i) = stack.pop() {
        if found.insert(i) {
            stack.extend(nodes.get(i).map(|n| n.children.clone()).unwrap_or_default());
        }
    }
    Ok(found)
}

/// Moves vertices as their joints say, into the file's axes; the node itself then moves nothing (glTF 3.7.3.3).
fn skinned(container: &Container, skin: usize, pose: &Pose, geometry: &mut Geometry) -> Result<Mat4, Fault> {
    let place = format!("skins[{skin}]");
    let s = container.root.skins.get(skin).ok_or_else(|| none(&place, "skin", skin, container.root.skins.len()))?;
    let inverse = match s.inverse_bind_matrices {
        Some(accessor) => container.floats(accessor, 16, &place)?,
        None => Mat4::IDENTITY.to_cols_array().repeat(s.joints.len()),
    };
    let joints: Vec<Mat4> = s
        .joints
        .iter()
        .zip(inverse.chunks_exact(16))
        .map(|(&joint, m)| pose.of_node(joint) * Mat4::from_cols_slice(m))
        .collect();
    let all = geometry.joints.iter().zip(&geometry.weights);
    for (i, (which, weights)) in all.enumerate().take(geometry.positions.len()) {
        let sum: f32 = weights.iter().sum();
        if sum <= 1e-6 {
            continue;
        }
        let matrices = which.iter().map(|&j| joints.get(j as usize).copied().unwrap_or(Mat4::IDENTITY));
        let blend = matrices.zip(weights).fold(Mat4::ZERO, |blend, (m, w)| blend + m * (*w / sum));
        geometry.positions[i] = blend.transform_point3(geometry.positions[i]);
        if let Some(n) = geometry.normals.get_mut(i) {
            *n = blend.transform_vector3(*n).try_normalize().unwrap_or(Vec3::ZERO);
        }
    }
    Ok(Mat4::IDENTITY)
}

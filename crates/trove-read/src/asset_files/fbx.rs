//! FBX and Wavefront OBJ, by `ufbx`, which is hardened against damaged files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{Mat4, Vec3, vec2, vec3};
use trove_model::{ColorSpace, Material, Outcome, Texture};

use super::fault::Fault;
use super::looks::{self, Alpha};
use super::model::{Model, Piece};
use super::picture::{Pictures, Pixels, decode};
use super::repair::kept;
use crate::ReadError;

/// What a file may make the reader allocate, bytes.
const MOST_MEMORY: usize = 6 << 30;

/// Reads a file's bytes; with `part` only the node of that name and what hangs on it. FBX files come in metres with y
/// up, by what they say of their units and axes; OBJ files say nothing and come as they are.
pub(super) fn read(path: &Path, bytes: &[u8], part: Option<&str>, pictures: &Pictures) -> Result<Model, ReadError> {
    let is_fbx = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("fbx"));
    load(path, bytes, is_fbx).and_then(|scene| assemble(&scene, path, part, pictures, is_fbx)).map_err(|f| f.at(path))
}

fn load(path: &Path, bytes: &[u8], is_fbx: bool) -> Result<ufbx::SceneRoot, Fault> {
    let name = path.to_string_lossy();
    let allocator = || ufbx::AllocatorOpts { memory_limit: MOST_MEMORY, ..Default::default() };
    let mut options = ufbx::LoadOpts {
        temp_allocator: allocator(),
        result_allocator: allocator(),
        file_format: if is_fbx { ufbx::FileFormat::Fbx } else { ufbx::FileFormat::Obj },
        filename: (&*name).into(),
        // An OBJ's materials are a file of their own.
        load_external_files: !is_fbx,
        ignore_missing_external_files: true,
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
                let made = source.map_or_else(Material::default, |m| look(m, path, pictures, &mut model));
                model.materials.push(made);
                model.materials.len() - 1
            });
            model.add(&node.element.name, piece, matrix, slot, false)?;
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

/// ufbx maps the materials of all programs to those of a physically based one.
fn look(m: &ufbx::Material, path: &Path, pictures: &Pictures, model: &mut Model) -> Material {
    let number =
        |map: &ufbx::MaterialMap, otherwise: f32| if map.has_value { map.value_vec4.x as f32 } else { otherwise };
    let rgb = |map: &ufbx::MaterialMap, otherwise: Vec3| {
        let v = map.value_vec4;
        if map.has_value { vec3(v.x as f32, v.y as f32, v.z as f32) } else { otherwise }
    };
    let pbr = &m.pbr;
    let mut texture = |map: &ufbx::MaterialMap, color: ColorSpace| picture(map, color, path, pictures, model);
    let base_color_map = texture(&pbr.base_color, ColorSpace::Srgb);
    let normal_map = texture(&pbr.normal_map, ColorSpace::Linear);
    let maps = [&pbr.ambient_occlusion, &pbr.roughness, &pbr.metalness].map(|map| texture(map, ColorSpace::Linear));
    let opacity = texture(&pbr.opacity, ColorSpace::Linear);
    let orm_map = orm(&maps, pictures, model);
    let factor = number(&pbr.base_factor, 1.0);
    let mut material = Material {
        name: m.element.name.to_string(),
        base_color: if base_color_map.is_some() {
            Vec3::splat(factor)
        } else {
            rgb(&pbr.base_color, Vec3::splat(0.8)) * factor
        },
        roughness: if maps[1].is_some() { 1.0 } else { number(&pbr.roughness, 0.6) },
        metalness: if maps[2].is_some() { 1.0 } else { number(&pbr.metalness, 0.0) },
        ior: number(&pbr.specular_ior, 1.5),
        coat: number(&pbr.coat_factor, 0.0),
        sheen: number(&pbr.sheen_factor, 0.0),
        transmission: number(&pbr.transmission_factor, 0.0),
        base_color_map: covered(base_color_map, opacity, pictures, model),
        orm_map,
        normal_map,
        ..Material::default()
    };
    let emission = rgb(&pbr.emission_color, Vec3::ZERO) * number(&pbr.emission_factor, 1.0);
    material.emission = looks::radiance(emission);
    looks::apply_alpha(&mut material, Alpha::Blend, number(&pbr.opacity, 1.0));
    looks::clamp(&mut material);
    material
}

fn picture(
    map: &ufbx::MaterialMap,
    color_space: ColorSpace,
    path: &Path,
    pictures: &Pictures,
    model: &mut Model,
) -> Option<Arc<Texture>> {
    let texture = map.texture.as_ref().filter(|_| map.texture_enabled)?;
    let texture = texture.file_textures.iter().next().unwrap_or(texture);
    let (bytes, name) = if texture.content.is_empty() {
        let (bytes, file) = kept(beside(texture, path), &texture.relative_filename, model)?;
        (bytes, pictures.name_of(&file))
    } else {
        (texture.content.to_vec(), format!("{}#{}", pictures.name_of(path), texture.element.typed_id))
    };
    let suffix = if color_space == ColorSpace::Srgb { "" } else { ".linear" };
    let made = pictures.texture(&format!("{name}{suffix}"), color_space, || {
        let pixels = decode(&bytes, &name, pictures.limit)?;
        if let Some(notice) = &pixels.notice {
            model.notice(Outcome::Substituted, "a texture was scaled down", format!("{name}: {notice}"));
        }
        Ok(pixels)
    });
    kept(made, &name, model)
}

/// A texture's file where the model says, or by its name beside the model or in the folders where packs keep them:
/// models name the paths of their makers' machines.
fn beside(texture: &ufbx::Texture, path: &Path) -> Result<(Vec<u8>, PathBuf), String> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let relative = texture.relative_filename.replace('\\', "/");
    let named = [relative.as_str(), &texture.filename, &texture.absolute_filename].map(|n| n.replace('\\', "/"));
    let last = named.iter().filter_map(|n| n.rsplit('/').next()).find(|n| !n.is_empty()).unwrap_or_default().to_owned();
    if last.is_empty() {
        return Err("a texture without a file's name".into());
    }
    let mut places = vec![folder.join(&relative), folder.join(&last)];
    for around in [Some(folder), folder.parent()].into_iter().flatten() {
        places.extend(["textures", "Textures", "texture", "maps", "images", "tex"].map(|f| around.join(f).join(&last)));
    }
    let found = places.into_iter().filter(|p| p.is_file()).find_map(|p| Some((std::fs::read(&p).ok()?, p)));
    found.ok_or_else(|| "no such file; put it beside the model".into())
}

fn pixels(texture: &Texture) -> Pixels {
    Pixels { width: texture.width, height: texture.height, rgba: texture.rgba.clone(), notice: None }
}

/// Occlusion, roughness and metalness from three pictures.
fn orm(maps: &[Option<Arc<Texture>>; 3], pictures: &Pictures, model: &mut Model) -> Option<Arc<Texture>> {
    let name = |m: &Option<Arc<Texture>>| m.as_ref().map_or("", |t| t.name.as_str()).to_owned();
    let name = format!("{}+{}+{}.orm", name(&maps[0]), name(&maps[1]), name(&maps[2]));
    let packed = looks::packed(maps.each_ref().map(|m| m.as_ref().map(|t| (pixels(t), 0))), [255; 3])?;
    kept(pictures.texture(&name, ColorSpace::Linear, || Ok(packed)), &name, model)
}

/// The base colour with its coverage from a picture of its own, where there is one beside it.
fn covered(
    base: Option<Arc<Texture>>,
    opacity: Option<Arc<Texture>>,
    pictures: &Pictures,
    model: &mut Model,
) -> Option<Arc<Texture>> {
    let (Some(base), Some(opacity)) = (&base, opacity) else { return base };
    // The same picture: its alpha already is the coverage.
    if opacity.name.trim_end_matches(".linear") == base.name {
        return Some(base.clone());
    }
    let name = format!("{}+{}.opacity", base.name, opacity.name);
    let made = pictures.texture(&name, ColorSpace::Srgb, || Ok(looks::with_alpha(pixels(base), &pixels(&opacity))));
    kept(made, &name, model)
}

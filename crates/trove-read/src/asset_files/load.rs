//! A model's file → `Model`, by its ending.

use std::path::Path;

use super::fault::Fault;
use super::library_file::AssetEntry;
use super::model::Model;
use super::picture::Pictures;
use super::{fbx, gltf, material_names, repair};
use crate::ReadError;

/// Files above this are refused, bytes.
const MOST_BYTES: u64 = 2 << 30;

/// Reads and repairs an entry's model.
pub(super) fn load(folder: &Path, entry: &AssetEntry, pictures: &Pictures) -> Result<Model, ReadError> {
    let mut model = load_raw(folder, entry, pictures)?;
    repair::repair(&mut model).map_err(|fault| fault.at(&folder.join(&entry.file)))?;
    material_names::restore(&mut model);
    Ok(model)
}

/// Reads an entry's model as it stands in its file.
pub(super) fn load_raw(folder: &Path, entry: &AssetEntry, pictures: &Pictures) -> Result<Model, ReadError> {
    let path = folder.join(&entry.file);
    let io = |source| ReadError::io(&path, source);
    let length = std::fs::metadata(&path).map_err(io)?.len();
    if length > MOST_BYTES {
        let found = format!("{length} bytes");
        return Err(Fault::new("file", "a file of at most 2 GiB", found, "simplify or split the model").at(&path));
    }
    let bytes = std::fs::read(&path).map_err(io)?;
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    match ending.as_str() {
        "glb" | "gltf" => gltf::read(&path, &bytes, entry.part.as_deref(), pictures),
        "fbx" | "obj" => fbx::read(&path, &bytes, entry.part.as_deref(), pictures),
        _ => {
            let remedy = "export it as .glb";
            Err(Fault::new("name", "a .glb, .gltf, .fbx or .obj file", ending, remedy).at(&path))
        }
    }
}

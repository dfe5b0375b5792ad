//! A model's file → `Model`, by its ending.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::fault::Fault;
use super::library_file::AssetEntry;
use super::model::Model;
use super::picture::Pictures;
use super::{fbx, gltf, material_names, repair};
use crate::ReadError;

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
    let bytes = pictures.folder.read(folder, &entry.file).map_err(io)?;
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

/// What `read` makes of the model at a path; should it panic, that is an error of this file alone, and the others live.
pub(super) fn guarded<T>(path: &Path, read: impl FnOnce() -> Result<T, ReadError>) -> Result<T, ReadError> {
    catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|panic| {
        let why = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
        let remedy = "leave it out, and report the file as a fault of TRoVE";
        let found = why.unwrap_or("a panic").to_owned();
        Err(Fault::new("content", "a model that can be read", found, remedy).at(path))
    })
}

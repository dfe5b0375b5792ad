//! What lies in a folder.

use std::path::Path;

use trove_files::Folder;
use trove_model::{Outcome, Report};

use crate::ReadError;

/// Folders nested deeper than this are not looked into.
const DEEPEST: usize = 12;

/// Paths from the folder, with `/`, sorted.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub(super) models: Vec<String>,
    pub(super) pictures: Vec<String>,
    pub(super) licences: Vec<String>,
}

/// Looks through a folder and those in it; hidden ones are passed over.
pub(super) fn scan(folder: &Path, report: &Report) -> Result<Found, ReadError> {
    let library = Folder::new(folder);
    let mut found = Found::default();
    let mut folders = vec![(folder.to_owned(), String::new(), 0)];
    while let Some((path, relative, depth)) = folders.pop() {
        let entries = match std::fs::read_dir(&path) {
            Ok(entries) => entries,
            Err(source) if depth == 0 => return Err(ReadError::io(&path, source)),
            Err(source) => {
                report.note(Outcome::Dropped, "a folder that cannot be read", format!("{relative}: {source}"));
                continue;
            }
        };
        for entry in entries.flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.starts_with('.') {
                continue;
            }
            let child = if relative.is_empty() { name.clone() } else { format!("{relative}/{name}") };
            // Of links only those to files of this folder are followed: any other leads who knows where.
            let Ok(kind) = entry.file_type() else { continue };
            if kind.is_symlink() && library.check(&entry.path()).is_err() {
                report.note(Outcome::Dropped, "a link out of the folder, or to a folder", child);
            } else if kind.is_dir() && depth < DEEPEST {
                folders.push((entry.path(), child, depth + 1));
            } else if kind.is_file() || kind.is_symlink() {
                found.add(child, &name.to_lowercase());
            }
        }
    }
    found.models.sort();
    found.pictures.sort();
    found.licences.sort();
    Ok(found)
}

impl Found {
    fn add(&mut self, path: String, name: &str) {
        let (stem, ending) = name.rsplit_once('.').unwrap_or((name, ""));
        match ending {
            "glb" | "gltf" | "fbx" | "obj" => self.models.push(path),
            "png" | "jpg" | "jpeg" | "webp" | "bmp" | "tga" | "hdr" | "exr" => self.pictures.push(path),
            _ if ["license", "licence", "copying", "readme"].iter().any(|l| stem.starts_with(l)) => {
                self.licences.push(path);
            }
            _ => {}
        }
    }
}

/// The folder of a path with `/`; empty for the library's own.
pub(super) fn folder_of(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// A path's name without folder and ending.
pub(super) fn stem_of(path: &str) -> &str {
    let name = path.rsplit_once('/').map_or(path, |(_, name)| name);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

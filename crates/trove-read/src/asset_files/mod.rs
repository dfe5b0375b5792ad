//! Everyone's own models, textures and skies: a folder with a `library.toml` → `AssetLibrary`.
//!
//! [`import`] writes that file for a folder of downloads: it guesses what each model shows, which way is up and
//! forward and how long its unit is, and says how sure it is and why. [`read_library`] reads the models as the file
//! says. [`check`] looks for what is wrong with them. Models: glTF 2.0 and GLB (with Draco and meshopt), FBX, OBJ;
//! pictures: PNG, JPEG, WebP, BMP, TGA, Radiance HDR, OpenEXR. Skins and morphs are posed by the first frame of the
//! animation that stands idle, or else of the first animation; without animations by the rest pose.

mod asset;
mod axes;
mod check;
mod evidence;
mod fault;
mod fbx;
mod front;
mod gltf;
mod guess;
mod lamp;
mod library_file;
mod library_text;
mod licence;
mod load;
mod looks;
mod material_names;
mod model;
mod names;
mod picture;
mod profile;
mod repair;
mod samples;
mod scan;
mod sky;
mod subjects;
mod surface;
mod tags;
mod texture_set;
mod upright;
mod words;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;
use trove_files::{Folder, LARGEST_TEXT, read_text};
use trove_model::{Asset, AssetLibrary, Outcome, Report, Surface};

pub use self::axes::Axis;
pub use self::check::{Finding, check};
pub use self::gltf::{FileCamera, FileNode, FileScene, read_scene};
pub use self::library_file::{
    AssetEntry, EnvironmentEntry, FILE_NAME, Guess, LibraryFile, LightEntry, RepeatsEntry, SurfaceEntry,
};

use self::load::{guarded, load};
use self::picture::Pictures;
use crate::ReadError;

/// The largest side of a model's texture, pixels.
const TEXTURE_LIMIT: u32 = 2048;
/// The largest side of a surface's texture, pixels.
const SURFACE_LIMIT: u32 = 4096;
/// The largest side of a texture that is only looked at to find out which way a model stands, pixels.
const GLANCE_LIMIT: u32 = 256;

/// Looks through a folder, writes its `library.toml` or completes the one that is there, and returns what then stands
/// in it with the guesses. What cannot be read is reported and left out.
///
/// # Errors
/// A folder that cannot be listed, a `library.toml` that is damaged, or one that cannot be written.
pub fn import(folder: &Path, report: &Report) -> Result<LibraryFile, ReadError> {
    let found = scan::scan(folder, report)?;
    let path = folder.join(FILE_NAME);
    let text = match read_text(&path, LARGEST_TEXT) {
        Ok(text) => text,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => String::new(),
        Err(source) => return Err(ReadError::io(&path, source)),
    };
    let old = LibraryFile::parse(&text).map_err(|fault| fault.at(&path))?;
    let mut file = old.clone();
    for model in &found.models {
        if !old.assets.iter().any(|e| e.file == *model) {
            file.assets.push(AssetEntry { file: model.clone(), ..AssetEntry::default() });
        }
    }
    let terms = licence::terms(&Folder::new(folder), &found.licences);
    let sets = texture_set::sets(&found.pictures, &found.models, &terms);
    file.surfaces.extend(sets.into_iter().filter(|found| !texture_set::is_known(&old.surfaces, found)));
    let skies = found.pictures.iter().filter(|p| sky::is_sky(&folder.join(p)));
    for sky in skies.filter(|s| !old.environments.iter().any(|e| e.file == **s)) {
        let licence = licence::nearest(&terms, sky).map(|t| t.licence.clone()).filter(|_| file.licence.is_none());
        file.environments.push(EnvironmentEntry { file: sky.clone(), licence });
    }
    let pictures = Pictures::new("glance", folder, GLANCE_LIMIT);
    let kept = old.assets.len();
    let complete = |(i, mut entry): (usize, AssetEntry)| {
        let result = guarded(&folder.join(&entry.file), || {
            let model = load(folder, &entry, &pictures)?;
            let terms = licence::nearest(&terms, &entry.file).filter(|_| file.licence.is_none());
            guess::complete(&mut entry, &model, terms).map_err(|fault| fault.at(&path))
        });
        match result {
            Ok(()) => Some(entry),
            Err(e) => {
                report.note(Outcome::Dropped, "a model that cannot be read", e);
                (i < kept).then_some(entry)
            }
        }
    };
    file.assets = std::mem::take(&mut file.assets).into_par_iter().enumerate().filter_map(complete).collect();
    for entry in &file.assets {
        for guess in entry.guesses.iter().filter(|g| g.confidence < 0.7) {
            let example =
                format!("{}: {} = {} ({:.2}: {})", entry.file, guess.key, guess.value, guess.confidence, guess.reason);
            report.note(Outcome::Guessed, "a key of library.toml, with low confidence", example);
        }
    }
    let new = library_text::completed(&text, &old, &file);
    if new != text {
        library_text::write(folder, &new)?;
    }
    Ok(file)
}

/// Reads a folder with a `library.toml`. Ids are `<folder>/<file's stem>`, with `-<part>` for a part of a file, and
/// with the names of folders in between where stems are not unique. What the file leaves open is guessed and reported;
/// a model that cannot be read is reported and left out.
///
/// # Errors
/// A `library.toml` that is missing or damaged, or entries of which none can be used.
pub fn read_library(folder: &Path, report: &Report) -> Result<AssetLibrary, ReadError> {
    let file = LibraryFile::read(folder)?;
    let name = library_name(folder);
    let ids = ids(&name, &file.assets);
    let pictures = Pictures::new(&name, folder, TEXTURE_LIMIT);
    let read = |(entry, id): (&AssetEntry, &String)| {
        let asset = guarded(&folder.join(&entry.file), || read_asset(folder, &file, entry, id, &pictures, report));
        asset.map_err(|e| report.note(Outcome::Dropped, "a model that cannot be read", e)).ok().flatten()
    };
    let mut assets: Vec<Asset> = file.assets.par_iter().zip(&ids).filter_map(read).collect();
    assets.sort_by(|a, b| a.id.cmp(&b.id));
    let pictures = Pictures::new(&name, folder, SURFACE_LIMIT);
    let read = |entry: &SurfaceEntry| {
        let id = format!("{name}/{}", entry.name);
        let surface = surface::surface(entry, &id, &pictures, report);
        surface.map_err(|e| report.note(Outcome::Dropped, "a texture set that cannot be read", e)).ok().flatten()
    };
    let mut surfaces: Vec<Surface> = file.surfaces.par_iter().filter_map(read).collect();
    surfaces.sort_by(|a, b| a.id.cmp(&b.id));
    if assets.is_empty() && surfaces.is_empty() && !(file.assets.is_empty() && file.surfaces.is_empty()) {
        return Err(ReadError::Missing {
            path: folder.to_owned(),
            expected: "a model or a texture set that can be used".into(),
            found: format!("{} models and {} texture sets that cannot be used", file.assets.len(), file.surfaces.len()),
            remedy: "run `trove assets check FOLDER` for details".into(),
        });
    }
    Ok(AssetLibrary { assets, surfaces, ..AssetLibrary::default() })
}

fn read_asset(
    folder: &Path,
    file: &LibraryFile,
    entry: &AssetEntry,
    id: &str,
    pictures: &Pictures,
    report: &Report,
) -> Result<Option<Asset>, ReadError> {
    if entry.kind.as_deref() == Some("none") {
        return Ok(None);
    }
    let mut entry = entry.clone();
    let at = |fault: fault::Fault| fault.at(&folder.join(FILE_NAME));
    let model = load(folder, &entry, pictures)?;
    for (outcome, what, example) in &model.notices {
        report.note(*outcome, what, format!("{id}: {example}"));
    }
    entry.licence = entry.licence.or_else(|| file.licence.clone());
    entry.author = entry.author.or_else(|| file.author.clone());
    entry.source = entry.source.or_else(|| file.source.clone());
    guess::complete(&mut entry, &model, None).map_err(at)?;
    for guess in &entry.guesses {
        report.note(
            Outcome::Guessed,
            "a key that library.toml leaves open",
            format!("{id}: {} = {}", guess.key, guess.value),
        );
    }
    let light = entry.light.as_ref().map(|light| lamp::luminaire(folder, light, pictures)).transpose()?;
    let asset = asset::asset(id, &entry, model).map_err(at)?;
    Ok(asset.map(|asset| Asset { luminaire: light.map(Arc::new), ..asset }))
}

/// The name of a folder's library, which its ids begin with: the last one of its path.
pub fn library_name(folder: &Path) -> String {
    let whole = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    whole.file_name().map_or("library".into(), |n| n.to_string_lossy().into_owned())
}

fn ids(library: &str, entries: &[AssetEntry]) -> Vec<String> {
    let part = |e: &AssetEntry| e.part.as_deref().map_or(String::new(), |p| format!("-{p}"));
    let short = |e: &AssetEntry| format!("{}{}", scan::stem_of(&e.file), part(e));
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    entries.iter().for_each(|e| *counts.entry(short(e)).or_default() += 1);
    let mut taken = std::collections::BTreeSet::new();
    let id = |e: &AssetEntry| {
        let short = short(e);
        let own = if counts[&short] == 1 { short } else { format!("{}{}", e.file.replace('/', "-"), part(e)) };
        let mut id = format!("{library}/{own}");
        while !taken.insert(id.clone()) {
            id.push('+');
        }
        id
    };
    entries.iter().map(id).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[ignore = "needs TROVE_TEST_DATA"]
    fn real_models_that_end_early_are_refused() {
        let data = std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA");
        let folder = Path::new(&data).join("models");
        let found = scan::scan(&folder, &Report::default()).expect("a folder");
        assert!(found.models.len() > 10, "{}", found.models.len());
        let pictures = Pictures::new("test", &folder, 16);
        found.models.par_iter().for_each(|name| {
            let path = folder.join(name);
            let bytes = std::fs::read(&path).expect("a file");
            for length in (0..bytes.len()).step_by(100) {
                let error = gltf::read(&path, &bytes[..length], None, &pictures).expect_err("a file that ends early");
                assert!(error.to_string().contains(name), "{error}");
            }
        });
    }
}

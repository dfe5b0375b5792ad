//! Which files a run is made from, by their contents.

use std::path::{Path, PathBuf};

use anyhow::Result;
use trove_format::Inputs;

use crate::contents::{Contents, below};
use crate::recipe::Recipe;
use crate::sources::Sources;

/// What the inputs call each camera of a recipe's own rig, before its name; their values are its lens and pose.
pub(super) const CAMERA: &str = "views.rig: ";

/// The files that all scenes are made from: the dataset's tables, the maps and their relief, the skies and the customs. Asset libraries
/// are in the versions.
pub(super) fn of_run(recipe: &Recipe, sources: &Sources, contents: &mut Contents) -> Result<Inputs> {
    let mut files: Vec<(String, PathBuf)> = Vec::new();
    if let Some(section) = &recipe.drive {
        let root = recipe.at(&section.root);
        let name = |path: &PathBuf| format!("drive: {}", below(&root, path));
        files.extend(sources.tables().into_iter().map(|path| (name(&path), path)));
    }
    let mut add = |key: &str, path: &Path| files.push((format!("{key}: {}", path.display()), recipe.at(path)));
    recipe.map.osm.paths().iter().for_each(|path| add("map.osm", path));
    recipe.map.elevation.paths().iter().for_each(|path| add("map.elevation", path));
    recipe.map.locales.iter().for_each(|path| add("map.locales", path));
    for (name, sensor) in &recipe.sensors {
        sensor.file().into_iter().for_each(|path| add(&format!("sensors.{name}"), path));
    }
    for (name, grid) in &recipe.grids {
        let files = grid.files(|file| recipe.at(file));
        files.iter().for_each(|path| add(&format!("grids.{name}"), path));
    }
    if recipe.light.is_file() {
        add("light.environment", Path::new(&recipe.light.environment));
    }
    recipe.variations.light.environments().flatten().for_each(|path| add("variations.light.environments", &path));
    let (names, paths): (Vec<String>, Vec<PathBuf>) = files.into_iter().unzip();
    // Cameras one by one: a rig may grow.
    let cameras = sources.rig().into_iter().flatten();
    let cameras = cameras
        .map(|camera| (format!("{CAMERA}{}", camera.name), format!("{:?} {:?}", camera.lens, camera.ego_from_camera)));
    Ok(names.into_iter().zip(contents.of(&paths)?).chain(cameras).collect())
}

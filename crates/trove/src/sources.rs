//! What a recipe builds on: its drives, and the street map around each.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result, bail, ensure};
use trove_model::{Bounds, Drive, EnvironmentMap, MapProjection, Outcome, Report, StreetMap};
use trove_read::drive_source::DriveSource;
use trove_read::{ReadError, environment, osm};

use crate::recipe::Recipe;
use crate::{cache, place};

/// Opened sources of a recipe.
pub(crate) struct Sources<'a> {
    recipe: &'a Recipe,
    dataset: Option<Box<dyn DriveSource>>,
    /// The picture of the sky, where one is asked for.
    environment: Option<Arc<EnvironmentMap>>,
}

impl<'a> Sources<'a> {
    /// Opens the dataset and reads the sky; `report` takes what is wrong with the dataset as a whole.
    pub(crate) fn open(recipe: &'a Recipe, report: &Report) -> Result<Self> {
        let dataset = match &recipe.drive {
            Some(section) => Some(section.opener()?(&recipe.at(&section.root), cache::folder().as_deref(), report)?),
            None => None,
        };
        let environment = recipe.environment_file().map(|file| environment::read(&file)).transpose()?;
        let environment = environment.map(|map| Arc::new(map.turned(recipe.light.rotation_deg)));
        for file in recipe.variations.light.environments().flatten() {
            let file = recipe.at(&file);
            ensure!(
                file.is_file(),
                "variations.light.environments: expected the picture of a sky (.hdr or .exr), found no file {}",
                file.display()
            );
        }
        Ok(Self { recipe, dataset, environment })
    }

    pub(crate) fn recipe(&self) -> &'a Recipe {
        self.recipe
    }

    /// The recipe's picture of a sky.
    pub(crate) fn environment(&self) -> Result<Arc<EnvironmentMap>> {
        self.environment.clone().context("the recipe has no picture of a sky")
    }

    /// Another picture of a sky by its path in the recipe, turned counter-clockwise seen from above.
    pub(crate) fn picture(&self, file: &Path, rotation_deg: f64) -> Result<Arc<EnvironmentMap>> {
        Ok(Arc::new(environment::read(&self.recipe.at(file))?.turned(rotation_deg)))
    }

    /// Names of the scenes that the recipe asks for, with the number of their keyframes as far as it is known.
    pub(crate) fn scenes(&self) -> Result<Vec<(String, usize)>> {
        let (Some(dataset), Some(section)) = (&self.dataset, &self.recipe.drive) else {
            return Ok(vec![(place::NAME.to_owned(), place::KEYFRAMES_HINT)]);
        };
        let known = dataset.drives();
        let Some(names) = &section.scenes else {
            ensure!(!known.is_empty(), "{}: expected at least one scene, found none", section.root.display());
            return Ok(known.into_iter().map(|scene| (scene.name, scene.keyframes)).collect());
        };
        let mut chosen = Vec::new();
        for name in names {
            match known.iter().find(|scene| &scene.name == name) {
                Some(scene) => chosen.push((scene.name.clone(), scene.keyframes)),
                None => {
                    let nearest = known.iter().min_by_key(|s| strsim::damerau_levenshtein(&s.name, name));
                    let hint = nearest.map(|s| format!("; did you mean \"{}\"?", s.name)).unwrap_or_default();
                    bail!("drive.scenes: {} has no scene \"{name}\"{hint}", section.root.display());
                }
            }
        }
        chosen.sort();
        chosen.dedup();
        Ok(chosen)
    }

    /// One scene's drive and the map around it.
    pub(crate) fn drive(&self, scene: &str, report: &Report) -> Result<(Drive, Option<StreetMap>)> {
        let Some(dataset) = &self.dataset else { return place::drive(self.recipe, report) };
        let drive = dataset.read(scene, report)?;
        let area = trove_build::area(&drive).with_context(|| format!("{scene}: nothing was recorded"))?;
        let map = street_map(self.recipe, &drive.projection, area, report)?;
        if map.is_none() {
            report.note(Outcome::Warned, "no street map: only the dataset's own map is built", scene);
        }
        Ok((drive, map.map(|(_, map)| map)))
    }
}

/// The map around a place from the first of the recipe's extracts that covers it, and that extract's path as the recipe
/// has it; `None` if the recipe has none.
pub(crate) fn street_map<'r>(
    recipe: &'r Recipe,
    projection: &MapProjection,
    area: Bounds,
    report: &Report,
) -> Result<Option<(&'r Path, StreetMap)>> {
    let mut elsewhere = None;
    for path in recipe.map.osm.paths() {
        match osm::read(&recipe.at(path), projection, area, report) {
            Ok(map) => return Ok(Some((path, map))),
            Err(error @ ReadError::Elsewhere { .. }) => elsewhere = Some(error),
            Err(error) => return Err(error.into()),
        }
    }
    elsewhere.map_or(Ok(None), |error| Err(error.into()))
}

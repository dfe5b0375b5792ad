//! What a recipe builds on: its drives, and the street map around each.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, bail, ensure};
use trove_build::Timeline;
use trove_files::Folder;
use trove_model::{
    Bounds, Drive, EnvironmentMap, Exposure, Locale, MapProjection, Outcome, Provenance, Report, RigCamera, StreetMap,
};
use trove_read::drive_source::DriveSource;
use trove_read::environment;
use trove_read::locale::{self, Locales};
use trove_read::rig;

use crate::contents::Contents;
use crate::recipe::{OwnRig, Recipe};
use crate::street_map::{relief, street_map};
use crate::{cache, place};

/// Opened sources of a recipe.
pub(crate) struct Sources<'a> {
    recipe: &'a Recipe,
    dataset: Option<Box<dyn DriveSource>>,
    /// The picture of the sky, where one is asked for.
    environment: Option<Arc<EnvironmentMap>>,
    locales: Locales,
    /// The cameras in place of the recorded ones.
    rig: Option<Vec<RigCamera>>,
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
                "variations.light.environments: expected a sky image (.hdr or .exr), found no file {}",
                file.display()
            );
        }
        let locales = match &recipe.map.locales {
            Some(file) => Locales::with_file(&recipe.at(file))?,
            None => Locales::built_in(),
        };
        if let Some(code) = recipe.map.country()
            && locales.country(code).is_none()
        {
            let nearest = locales.codes().min_by_key(|known| strsim::damerau_levenshtein(known, &code.to_uppercase()));
            let hint = nearest.map(|known| format!("; did you mean {known:?}?")).unwrap_or_default();
            bail!("map.country: expected \"auto\" or the ISO 3166-1 code of a country, found {code:?}{hint}");
        }
        let rig = match recipe.own_rig() {
            Some(OwnRig::File(path)) => Some(rig::read(&path)?),
            Some(OwnRig::Preset(name)) => rig::preset(name),
            None => None,
        };
        Ok(Self { recipe, dataset, environment, locales, rig })
    }

    pub(crate) fn recipe(&self) -> &'a Recipe {
        self.recipe
    }

    /// The recipe's picture of a sky.
    pub(crate) fn environment(&self) -> Result<Arc<EnvironmentMap>> {
        self.environment.clone().context("the recipe has no sky image")
    }

    /// Another picture of a sky by its path in the recipe, turned counter-clockwise seen from above.
    pub(crate) fn picture(&self, file: &Path, rotation_deg: f64) -> Result<Arc<EnvironmentMap>> {
        Ok(Arc::new(environment::read(&self.recipe.at(file))?.turned(rotation_deg)))
    }

    /// Whose customs the recorded place follows: the recipe's country, else that which it lies in.
    pub(crate) fn locale(&self, lat_deg: f64, lon_deg: f64, report: &Report) -> Locale {
        let told = self.recipe.map.country().and_then(|code| self.locales.country(code));
        told.cloned().unwrap_or_else(|| self.locales.at(lat_deg, lon_deg, report))
    }

    /// Whose customs another place follows.
    pub(crate) fn locale_elsewhere(&self, lat_deg: f64, lon_deg: f64, report: &Report) -> Locale {
        self.locales.at(lat_deg, lon_deg, report)
    }

    /// Where the borders come from that tell the recorded place's country; `None` where the recipe does.
    pub(crate) fn borders(&self) -> Option<Provenance> {
        self.recipe.map.country().is_none().then(locale::provenance)
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

    /// The files that every drive is read from.
    pub(crate) fn tables(&self) -> Vec<PathBuf> {
        self.dataset.as_ref().map(|dataset| dataset.tables()).unwrap_or_default()
    }

    /// SHA-256 of the files that one scene's drive alone is read from; `None` where there are none.
    pub(crate) fn recording(&self, scene: &str, contents: &mut Contents) -> Result<Option<String>> {
        let (Some(dataset), Some(section)) = (&self.dataset, &self.recipe.drive) else { return Ok(None) };
        let mut files = dataset.recording(scene)?;
        if self.recipe.views.match_photographs {
            files.extend(self.photographs(&dataset.read(scene, &Report::default())?).into_values());
        }
        if files.is_empty() { Ok(None) } else { contents.of_all(&self.recipe.at(&section.root), &files).map(Some) }
    }

    /// The recorded pictures of a drive that are at hand, with their names in the dataset.
    pub(crate) fn photographs(&self, drive: &Drive) -> BTreeMap<String, PathBuf> {
        let Some(section) = &self.recipe.drive else { return BTreeMap::new() };
        let root = Folder::new(&self.recipe.at(&section.root));
        let named = drive.keyframes.iter().flat_map(|k| &k.exposures).filter_map(|e| e.file.clone());
        named.filter_map(|name| Some((name.clone(), root.file(root.path(), Path::new(&name)).ok()?))).collect()
    }

    /// Where one scene lies on earth, and the area that is built of it.
    pub(crate) fn area(&self, scene: &str, report: &Report) -> Result<(MapProjection, Bounds)> {
        let Some(dataset) = &self.dataset else {
            return Ok(place::area(self.recipe.place.as_ref().context("the recipe has no [place]")?));
        };
        let drive = self.laid(dataset.as_ref(), scene, report)?;
        ensure!(drive.is_georeferenced, "{scene}: expected a drive whose place on earth is known; set drive.at");
        let area = trove_build::area(&drive).with_context(|| format!("{scene}: nothing was recorded"))?;
        Ok((drive.projection, area))
    }

    /// One scene's drive, where the recipe lays it.
    fn laid(&self, dataset: &dyn DriveSource, scene: &str, report: &Report) -> Result<Drive> {
        let drive = dataset.read(scene, report)?;
        match self.recipe.drive.as_ref().and_then(|section| section.at) {
            Some(at) => at.lay(drive),
            None => Ok(drive),
        }
    }

    /// The cameras in place of the recorded ones; `None` where these are meant.
    pub(crate) fn rig(&self) -> Option<&[RigCamera]> {
        self.rig.as_deref()
    }

    /// One scene's drive, with the recipe's own rig where it has one and at all moments that it asks for, and the map around
    /// it.
    pub(crate) fn drive(&self, scene: &str, report: &Report) -> Result<(Timeline, Option<StreetMap>)> {
        let (mut drive, map) = self.recorded(scene, report)?;
        if let Some(rig) = &self.rig {
            carry(&mut drive, rig);
        }
        Ok((trove_build::between(drive, self.recipe.time.rate_hz, report), map))
    }

    fn recorded(&self, scene: &str, report: &Report) -> Result<(Drive, Option<StreetMap>)> {
        // What is guessed is reported when the place is built.
        let side = |lat_deg, lon_deg| self.locale(lat_deg, lon_deg, &Report::default()).driving_side;
        let Some(dataset) = &self.dataset else {
            let place = self.recipe.place.as_ref().context("the recipe has no [place]")?;
            return place::drive(self.recipe, place, side(place.lat_deg, place.lon_deg), report);
        };
        let drive = self.laid(dataset.as_ref(), scene, report)?;
        if !drive.is_georeferenced {
            report.note(Outcome::Warned, "unknown where on earth the drive lies: no street map is laid on it", scene);
            return Ok((drive, None));
        }
        let area = trove_build::area(&drive).with_context(|| format!("{scene}: nothing was recorded"))?;
        let MapProjection { origin_lat_deg, origin_lon_deg, .. } = drive.projection;
        let map = street_map(self.recipe, &drive.projection, area, side(origin_lat_deg, origin_lon_deg), report)?;
        if map.is_none() {
            report.note(Outcome::Warned, "no street map: only the dataset's own map is built", scene);
        }
        let mut map = map.map(|(_, map)| map);
        if let Some(relief) = relief(self.recipe, &drive.projection, area, report)? {
            map.get_or_insert_default().relief = Some(relief);
        }
        Ok((drive, map))
    }
}

/// Puts another rig on a drive's vehicle; all its cameras take their pictures at the time of the keyframe.
fn carry(drive: &mut Drive, rig: &[RigCamera]) {
    for keyframe in &mut drive.keyframes {
        let exposure = |(camera, mounted): (usize, &RigCamera)| Exposure {
            camera,
            time_ns: keyframe.time_ns,
            world_from_ego: keyframe.world_from_ego,
            lens: mounted.lens,
            ego_from_camera: mounted.ego_from_camera,
            token: None,
            file: None,
        };
        keyframe.exposures = rig.iter().enumerate().map(exposure).collect();
    }
    drive.rig = rig.to_vec();
}

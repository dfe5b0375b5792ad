//! A scene of a recipe, built as one of its variations.

use anyhow::Result;
use trove_build::{Seeds, Site, ViewSettings};
use trove_format::Factors;
use trove_model::{AssetLibrary, Drive, Locale, Report, Scene, Shot, StreetMap};

use crate::recipe::Recipe;
use crate::sources::Sources;
use crate::variation::Variation;

/// What stands and drives in a scene, and how it is photographed.
pub(crate) struct VirtualScene<'a> {
    /// The drive as it was recorded.
    pub(crate) drive: &'a Drive,
    pub(crate) site: Site,
    /// What the variation differs in, for the manifest.
    pub(crate) factors: Factors,
    /// Whose customs it follows.
    pub(crate) locale: Locale,
    views: ViewSettings,
    seeds: Seeds,
}

impl<'a> VirtualScene<'a> {
    /// Builds variation `number` of what was read; what was read stays as it is, for the other variations.
    pub(crate) fn build(
        sources: &Sources,
        (drive, map): (&'a Drive, Option<&StreetMap>),
        library: &AssetLibrary,
        number: u32,
        report: &Report,
    ) -> Result<Self> {
        let recipe = sources.recipe();
        let variation = Variation::draw(sources, drive, number, report)?;
        let settings = variation.build_settings(recipe, sources)?;
        let mut views = view_settings(recipe)?;
        variation.change(&mut views);
        let there = Drive { projection: variation.projection(drive.projection), ..drive.clone() };
        let site = trove_build::build(&there, map, library, &settings, report)?;
        let factors = variation.factors(recipe, &site);
        Ok(Self { drive, site, factors, locale: settings.locale, views, seeds: settings.seeds })
    }

    /// The scene at a keyframe.
    pub(crate) fn at(&self, keyframe: usize) -> Scene {
        self.site.scene(self.drive, keyframe)
    }

    /// The shots of a keyframe.
    pub(crate) fn shots(&self, keyframe: usize, report: &Report) -> Vec<Shot> {
        trove_build::shots(self.drive, &self.site, keyframe, &self.views, &self.seeds, report)
    }
}

/// The views that a recipe asks for.
fn view_settings(recipe: &Recipe) -> Result<ViewSettings> {
    Ok(ViewSettings {
        rig: recipe.camera_names(),
        other_vehicles: recipe.views.other_vehicles,
        size: recipe.render.picture_size(),
        lift_m: 0.0,
        pitch_rad: 0.0,
        spp: recipe.render.spp,
        noise: recipe.render.noise,
        lenses: recipe.camera.lenses()?,
        exposure_s: recipe.camera.exposure_s,
        readout_s: recipe.camera.readout_s,
        film: recipe.camera.film(),
    })
}

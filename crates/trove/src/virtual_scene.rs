//! A scene of a recipe, built as one of its variations.

use anyhow::Result;
use trove_build::{Moments, MountedLidar, Seeds, Site, Timeline, ViewPlan, ViewSettings};
use trove_format::Factors;
use trove_model::{AssetLibrary, Drive, LidarShot, Locale, Report, Scene, Shot, StreetMap};

use crate::recipe::{Recipe, SensorSection};
use crate::sources::Sources;
use crate::variation::Variation;

/// What stands and drives in a scene, and how it is photographed.
pub(crate) struct VirtualScene<'a> {
    /// The moments at which it can be seen.
    pub(crate) moments: Moments<'a>,
    pub(crate) site: Site,
    /// What the variation differs in, for the manifest.
    pub(crate) factors: Factors,
    /// Whose customs it follows.
    pub(crate) locale: Locale,
    views: ViewPlan,
    lidars: Vec<MountedLidar>,
    seeds: Seeds,
}

impl<'a> VirtualScene<'a> {
    /// Builds variation `number` of what was read; what was read stays as it is, for the other variations.
    pub(crate) fn build(
        sources: &Sources,
        (timeline, map): (&'a Timeline, Option<&StreetMap>),
        library: &AssetLibrary,
        number: u32,
        report: &Report,
    ) -> Result<Self> {
        let (recipe, drive, moments) = (sources.recipe(), &timeline.recorded, timeline.moments());
        let variation = Variation::draw(sources, drive, number, report)?;
        let settings = variation.build_settings(recipe, sources)?;
        let mut views = view_settings(recipe)?;
        variation.change(&mut views);
        let there = Drive { projection: variation.projection(drive.projection), ..drive.clone() };
        let site = trove_build::build_at(&there, moments, map, library, &settings, report)?;
        let factors = variation.factors(recipe, &site);
        let views = ViewPlan::new(moments.drive, &site, views, settings.seeds, report);
        let lidars = lidars(recipe, drive, report)?;
        Ok(Self { moments, site, factors, locale: settings.locale, views, lidars, seeds: settings.seeds })
    }

    /// The scene at a moment.
    pub(crate) fn at(&self, moment: usize) -> Scene {
        self.site.scene(self.moments.drive, moment)
    }

    /// The shots of a moment.
    pub(crate) fn shots(&self, moment: usize, report: &Report) -> Vec<Shot> {
        self.views.shots(self.moments.drive, &self.site, moment, report)
    }

    /// The LiDARs' sweeps of a moment.
    pub(crate) fn lidar_shots(&self, moment: usize) -> Vec<LidarShot> {
        trove_build::lidar_shots(self.moments.drive, &self.site, moment, &self.lidars, &self.seeds)
    }
}

/// The LiDARs that a recipe puts on the vehicle.
fn lidars(recipe: &Recipe, drive: &Drive, report: &Report) -> Result<Vec<MountedLidar>> {
    let mounted = |(name, sensor): (&String, &SensorSection)| {
        Ok(sensor.mounted(name, sensor.scanner(|file| recipe.at(file))?, drive, report))
    };
    recipe.sensors.iter().map(mounted).collect()
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
        labels: recipe.label_settings(),
    })
}

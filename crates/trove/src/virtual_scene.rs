//! A scene of a recipe, built as one of its variations.

use std::collections::BTreeMap;
use std::sync::Arc;

use anyhow::Result;
use trove_build::{Moments, MountedLidar, MountedRadar, Seeds, Site, Timeline, ViewPlan, ViewSettings};
use trove_format::Factors;
use trove_model::{
    AssetLibrary, Drive, GridFrame, GridPlan, GridShot, LidarShot, Locale, Looks, Outcome, RadarShot, Report, Scene,
    Shot, StreetMap, Viewpoint,
};

use crate::recipe::{GridSection, Recipe, SensorKind, SensorSection};
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
    radars: Vec<MountedRadar>,
    grids: Vec<(String, Arc<GridPlan>)>,
    seeds: Seeds,
    /// Stops on the exposure of recorded cameras, by their names.
    exposure_ev: BTreeMap<String, f64>,
    /// Contrast of recorded cameras, where photographs told it.
    contrast: Option<f64>,
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
        let mut site = trove_build::build_at(&there, moments, map, library, &settings, report)?;
        if !recipe.assets.textures {
            site.flatten();
        }
        let factors = variation.factors(recipe, &site);
        let views = ViewPlan::new(moments.drive, &site, views, settings.seeds, report);
        let (lidars, radars) = (lidars(recipe, drive, report)?, radars(recipe, drive, report)?);
        let grids = grids(recipe, drive, report)?;
        let (locale, seeds) = (settings.locale, settings.seeds);
        let (exposure_ev, contrast) = (BTreeMap::new(), None);
        Ok(Self { moments, site, factors, locale, views, lidars, radars, grids, seeds, exposure_ev, contrast })
    }

    /// The scene at a moment.
    pub(crate) fn at(&self, moment: usize) -> Scene {
        self.site.scene(self.moments.drive, moment)
    }

    /// The shots of a moment.
    pub(crate) fn shots(&self, moment: usize, report: &Report) -> Vec<Shot> {
        let mut shots = self.views.shots(self.moments.drive, &self.site, moment, report);
        for shot in &mut shots {
            let Viewpoint::Recording { camera } = shot.viewpoint else { continue };
            shot.film.contrast = self.contrast.unwrap_or(shot.film.contrast);
            let name = self.moments.drive.rig.get(camera).map(|camera| &camera.name);
            if let Some(more) = name.and_then(|name| self.exposure_ev.get(name)) {
                shot.film.exposure.brighten(*more);
            }
        }
        shots
    }

    /// Colours and exposes it otherwise.
    pub(crate) fn look_like(&mut self, looks: &Looks) {
        self.site.tint(looks);
        self.contrast = looks.contrast.or(self.contrast);
        for (camera, more) in &looks.exposure_ev {
            *self.exposure_ev.entry(camera.clone()).or_default() += more;
        }
    }

    /// The LiDARs' sweeps of a moment.
    pub(crate) fn lidar_shots(&self, moment: usize) -> Vec<LidarShot> {
        trove_build::lidar_shots(self.moments.drive, &self.site, moment, &self.lidars, &self.seeds)
    }

    /// The radars' cycles of a moment.
    pub(crate) fn radar_shots(&self, moment: usize) -> Vec<RadarShot> {
        trove_build::radar_shots(self.moments.drive, &self.site, moment, &self.radars, &self.seeds)
    }

    /// The grids of a moment, into which its shots and sweeps look.
    pub(crate) fn grid_shots(&self, moment: usize, shots: &[Shot], sweeps: &[LidarShot]) -> Vec<GridShot> {
        trove_build::grid_shots(self.moments.drive, &self.site, moment, &self.grids, shots, sweeps)
    }
}

/// The LiDARs that a recipe puts on the vehicle.
fn lidars(recipe: &Recipe, drive: &Drive, report: &Report) -> Result<Vec<MountedLidar>> {
    let mounted = |(name, sensor): (&String, &SensorSection)| {
        Ok(sensor.mounted(name, sensor.scanner(|file| recipe.at(file))?, drive, report))
    };
    of_kind(recipe, SensorKind::Lidar).map(mounted).collect()
}

/// The grids that a recipe lays around the vehicle, with their names.
fn grids(recipe: &Recipe, drive: &Drive, report: &Report) -> Result<Vec<(String, Arc<GridPlan>)>> {
    let plan = |(name, section): (&String, &GridSection)| {
        let plan = section.plan(|file| recipe.at(file))?;
        if plan.frame == GridFrame::Lidar && drive.lidars.is_empty() {
            let what = "axes of a LiDAR that the recording does not tell of, replaced by the vehicle's";
            report.note(Outcome::Substituted, what, format!("{} {name}", drive.id));
        }
        Ok((name.clone(), Arc::new(plan)))
    };
    recipe.grids.iter().map(plan).collect()
}

/// The radars.
fn radars(recipe: &Recipe, drive: &Drive, report: &Report) -> Result<Vec<MountedRadar>> {
    let mounted = |(name, sensor): (&String, &SensorSection)| {
        Ok(sensor.mounted_radar(name, sensor.radar(|file| recipe.at(file))?, drive, report))
    };
    of_kind(recipe, SensorKind::Radar).map(mounted).collect()
}

fn of_kind(recipe: &Recipe, kind: SensorKind) -> impl Iterator<Item = (&String, &SensorSection)> {
    recipe.sensors.iter().filter(move |(_, sensor)| sensor.kind == kind)
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
        cache: recipe.render.cache,
        lenses: recipe.camera.lenses()?,
        exposure_s: recipe.camera.exposure_s,
        readout_s: recipe.camera.readout_s,
        drops: recipe.camera.drops,
        film: recipe.camera.film(),
        labels: recipe.label_settings(),
    })
}

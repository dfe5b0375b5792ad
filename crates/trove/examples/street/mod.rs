//! A recorded street, built from the folder of real data, which is `TROVE_TEST_DATA`.

use std::path::PathBuf;

use anyhow::{Context, Result};
use trove_build::{
    BuildSettings, LightChoice, OnDisagreement, Site, SkyChoice, Traffic, ViewPlan, ViewSettings, Weather,
};
use trove_model::{Drive, MapProjection, Report, Scene, Seed, Shot};
use trove_read::{locale::Locales, nuscenes::NuScenes, osm};

pub(crate) struct Street {
    drive: Drive,
    site: Site,
    report: Report,
}

impl Street {
    /// A scene of nuScenes' with its map, both by name, of plain models.
    pub(crate) fn build(scene: &str, map: &str) -> Result<Self> {
        let data = PathBuf::from(std::env::var_os("TROVE_TEST_DATA").context("TROVE_TEST_DATA: expected a folder")?);
        let report = Report::default();
        let drive = NuScenes::open(&data.join("nuscenes"), "v1.0-mini", None, &report)?.drive(scene, &report)?;
        let area = trove_build::area(&drive).context("nothing was recorded")?;
        let MapProjection { origin_lat_deg, origin_lon_deg, .. } = drive.projection;
        let locale = Locales::built_in().at(origin_lat_deg, origin_lon_deg, &report);
        let map = osm::read(&data.join("osm").join(map), &drive.projection, area, locale.driving_side, &report)?;
        let library = trove_assets::library(&trove_assets::Ingredients::default());
        let settings = BuildSettings {
            seeds: Seed(7).into(),
            top_k: 3,
            traffic: Traffic::default(),
            light: LightChoice::Sky(SkyChoice::default()),
            weather: Weather::default(),
            on_disagreement: OnDisagreement::default(),
            invent: false,
            locale,
            borders: None,
        };
        let site = trove_build::build(&drive, Some(&map), &library, &settings, &report)?;
        Ok(Self { drive, site, report })
    }

    /// A keyframe's scene, and what its cameras see of it.
    pub(crate) fn at(&self, keyframe: usize, views: ViewSettings) -> (Scene, Vec<Shot>) {
        let Self { drive, site, report } = self;
        let plan = ViewPlan::new(drive, site, views, Seed(5).into(), report);
        (site.scene(drive, keyframe), plan.shots(drive, site, keyframe, report))
    }
}

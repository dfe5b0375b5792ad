//! How fast the renderer traces rays against bare Embree on the same rays: `make bench-rays`.
//!
//! CAM_FRONT of a keyframe of both sample scenes, one sample a pixel, one thread; the folder of real data is
//! `TROVE_TEST_DATA`.

use std::path::PathBuf;

use anyhow::{Context, Result};
use trove_build::{
    BuildSettings, LightChoice, OnDisagreement, PictureSize, SkyChoice, ViewPlan, ViewSettings, Weather,
};
use trove_model::{MapProjection, Report, Seed};
use trove_read::{locale::Locales, nuscenes::NuScenes, osm};
use trove_render::{Denoising, KernelChoice, RaySeconds, Renderer, RendererOptions};

fn main() -> Result<()> {
    let data = PathBuf::from(std::env::var_os("TROVE_TEST_DATA").context("TROVE_TEST_DATA: expected a folder")?);
    let report = Report::default();
    let dataset = NuScenes::open(&data.join("nuscenes"), "v1.0-mini", None, &report)?;
    let search = std::env::var_os("TROVE_EMBREE").map(PathBuf::from).into_iter().collect();
    let renderer =
        Renderer::new(&RendererOptions { kernel: KernelChoice::Embree, denoise: Denoising::None, threads: 1, search })?;
    let library = trove_assets::library(&trove_assets::Ingredients::default());
    for (name, place) in [("scene-0103", "boston-seaport.osm"), ("scene-0061", "singapore-onenorth.osm")] {
        let drive = dataset.drive(name, &report)?;
        let area = trove_build::area(&drive).context("nothing was recorded")?;
        let MapProjection { origin_lat_deg, origin_lon_deg, .. } = drive.projection;
        let locale = Locales::built_in().at(origin_lat_deg, origin_lon_deg, &report);
        let map = osm::read(&data.join("osm").join(place), &drive.projection, area, locale.driving_side, &report)?;
        let settings = BuildSettings {
            seeds: Seed(7).into(),
            top_k: 3,
            traffic: trove_build::Traffic::default(),
            light: LightChoice::Sky(SkyChoice::default()),
            weather: Weather::default(),
            on_disagreement: OnDisagreement::default(),
            locale,
            borders: None,
        };
        let site = trove_build::build(&drive, Some(&map), &library, &settings, &report)?;
        let (rig, size) = (Some(vec!["CAM_FRONT".into()]), PictureSize::Scaled(0.5));
        let views = ViewSettings { rig, size, spp: 1, ..ViewSettings::default() };
        let shots = ViewPlan::new(&drive, &site, views, Seed(5).into(), &report).shots(&drive, &site, 1, &report);
        let prepared = renderer.prepare(&site.scene(&drive, 1))?;
        // The first time warms the caches.
        renderer.ray_times(&prepared, &shots[0]);
        let times = renderer.ray_times(&prepared, &shots[0]);
        for (sort, RaySeconds { rays, renderer, bare, .. }) in
            [("camera", times.camera), ("bounce", times.bounce), ("shadow", times.shadow)]
        {
            let millions = |seconds: f64| rays as f64 / seconds * 1e-6;
            let (ours, bare) = (millions(renderer), millions(bare));
            println!("{name} {sort}: {ours:.2} million rays per second, bare {bare:.2}, share {:.2}", ours / bare);
        }
    }
    Ok(())
}

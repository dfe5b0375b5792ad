//! How long labels alone take, by both kernels: `make bench-labels`.
//!
//! All cameras of a keyframe of scene-0103 at 1600×900, on all cores; the folder of real data is `TROVE_TEST_DATA`. An
//! argument other than 1 scales the pictures.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result};
use trove_build::{
    BuildSettings, LightChoice, OnDisagreement, PictureSize, SkyChoice, ViewPlan, ViewSettings, Weather,
};
use trove_model::{MapProjection, Report, Seed};
use trove_read::{locale::Locales, nuscenes::NuScenes, osm};
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};

/// A keyframe with road users on all sides.
const KEYFRAME: usize = 10;
/// The best of so many rounds counts: other programs only slow things down.
const ROUNDS: usize = 3;

fn main() -> Result<()> {
    let data = PathBuf::from(std::env::var_os("TROVE_TEST_DATA").context("TROVE_TEST_DATA: expected a folder")?);
    let scale: f64 = std::env::args().nth(1).map_or(Ok(1.0), |text| text.parse()).context("expected a scale")?;
    let report = Report::default();
    let drive = NuScenes::open(&data.join("nuscenes"), "v1.0-mini", None, &report)?.drive("scene-0103", &report)?;
    let area = trove_build::area(&drive).context("nothing was recorded")?;
    let MapProjection { origin_lat_deg, origin_lon_deg, .. } = drive.projection;
    let locale = Locales::built_in().at(origin_lat_deg, origin_lon_deg, &report);
    let file = data.join("osm").join("boston-seaport.osm");
    let map = osm::read(&file, &drive.projection, area, locale.driving_side, &report)?;
    let library = trove_assets::library(&trove_assets::Ingredients::default());
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
    let views = ViewSettings { size: PictureSize::Scaled(scale), spp: 1, ..ViewSettings::default() };
    let shots = ViewPlan::new(&drive, &site, views, Seed(5).into(), &report).shots(&drive, &site, KEYFRAME, &report);
    let scene = site.scene(&drive, KEYFRAME);
    for kernel in [KernelChoice::Embree, KernelChoice::Obvhs] {
        let search = std::env::var_os("TROVE_EMBREE").map(PathBuf::from).into_iter().collect();
        let renderer = Renderer::new(&RendererOptions { kernel, denoise: Denoising::None, threads: 0, search })?;
        let prepared = renderer.prepare(&scene)?;
        let mut all_s = 0.0;
        for shot in &shots {
            let seconds = |_| {
                let started = Instant::now();
                renderer.render(&prepared, shot, false, &|_| false);
                started.elapsed().as_secs_f64()
            };
            let best_s = (0..ROUNDS).map(seconds).fold(f64::INFINITY, f64::min);
            println!("{kernel:?} {}: {best_s:.3} s", shot.view);
            all_s += best_s;
        }
        println!("{kernel:?} all {}: {all_s:.3} s", shots.len());
    }
    Ok(())
}

//! How fast a graphics card traces the renderer's rays, and whether it finds what the processor finds: `make bench-card`.
//!
//! CAM_FRONT of a keyframe of scene-0103, one sample a pixel; the folder of real data is `TROVE_TEST_DATA`. An argument
//! other than 1 scales the picture.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result};
use trove_build::{
    BuildSettings, LightChoice, OnDisagreement, PictureSize, SkyChoice, ViewPlan, ViewSettings, Weather,
};
use trove_model::{MapProjection, Report, Seed};
use trove_read::{locale::Locales, nuscenes::NuScenes, osm};
use trove_render::{Card, Denoising, KernelChoice, Renderer, RendererOptions};

/// A keyframe with road users on all sides.
const KEYFRAME: usize = 10;

fn main() -> Result<()> {
    let started = Instant::now();
    let card = Card::find().map_err(anyhow::Error::msg)?;
    println!("{}; opened and compiled for in {:.2} s", card.about(), started.elapsed().as_secs_f64());
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
    let (rig, size) = (Some(vec!["CAM_FRONT".into()]), PictureSize::Scaled(scale));
    let views = ViewSettings { rig, size, spp: 1, ..ViewSettings::default() };
    let shots = ViewPlan::new(&drive, &site, views, Seed(5).into(), &report).shots(&drive, &site, KEYFRAME, &report);
    let (kernel, denoise) = (KernelChoice::Obvhs, Denoising::None);
    let renderer = Renderer::new(&RendererOptions { kernel, denoise, threads: 0, search: Vec::new() })?;
    let prepared = renderer.prepare(&site.scene(&drive, KEYFRAME))?;
    let started = Instant::now();
    let rates = renderer.card_rates(&prepared, &shots[0], &card).map_err(anyhow::Error::msg)?;
    println!("built, sent, traced and compared in {:.1} s", started.elapsed().as_secs_f64());
    for rate in rates {
        let millions = |seconds: f64| rate.rays as f64 / seconds * 1e-6;
        println!(
            "{}: {} rays, {} meet something; {:.0} million a second on the card, {:.2} on one thread; {} answers differ, {} \
             elsewhere; {} registers, {} bytes, {} threads at once; scene {:.0} MB",
            rate.sort,
            rate.rays,
            rate.met,
            millions(rate.card_s),
            millions(rate.processor_s),
            rate.differ,
            rate.elsewhere,
            rate.takes[0],
            rate.takes[1],
            rate.at_once,
            rate.scene_bytes as f64 * 1e-6
        );
    }
    Ok(())
}

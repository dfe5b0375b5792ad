//! How fast a graphics card traces the renderer's rays, and whether it finds what the processor finds: `make bench-card`.
//!
//! CAM_FRONT of a keyframe of scene-0103, one sample a pixel; the folder of real data is `TROVE_TEST_DATA`. An argument
//! other than 1 scales the picture.

mod street;

use std::time::Instant;

use anyhow::{Context, Result};
use street::Street;
use trove_build::{PictureSize, ViewSettings};
use trove_render::{Card, Denoising, KernelChoice, Renderer, RendererOptions};

/// A keyframe with road users on all sides.
const KEYFRAME: usize = 10;

fn main() -> Result<()> {
    let started = Instant::now();
    let card = Card::open(0).map_err(anyhow::Error::msg)?;
    println!("{}; opened and compiled for in {:.2} s", card.about(), started.elapsed().as_secs_f64());
    let scale: f64 = std::env::args().nth(1).map_or(Ok(1.0), |text| text.parse()).context("expected a scale")?;
    let (rig, size) = (Some(vec!["CAM_FRONT".into()]), PictureSize::Scaled(scale));
    let views = ViewSettings { rig, size, spp: 1, ..ViewSettings::default() };
    let (scene, shots) = Street::build("scene-0103", "boston-seaport.osm")?.at(KEYFRAME, views);
    let (kernel, denoise) = (KernelChoice::Obvhs, Denoising::None);
    let renderer = Renderer::new(&RendererOptions { kernel, denoise, threads: 0, ..Default::default() })?;
    let prepared = renderer.prepare(&scene)?;
    let started = Instant::now();
    let (rates, scene_bytes) = renderer.card_rates(&prepared, &shots[0], &card).map_err(anyhow::Error::msg)?;
    let (seconds, scene_mb) = (started.elapsed().as_secs_f64(), scene_bytes as f64 * 1e-6);
    println!("built, sent, asked and compared in {seconds:.1} s; scene {scene_mb:.0} MB");
    for rate in rates {
        let millions = |seconds: f64| rate.asked as f64 / seconds * 1e-6;
        println!(
            "{}: {}, of which {} meet something; {:.0} million a second on the card, {:.2} on one thread; {} \
             answers differ; {} registers, {} bytes, {} threads at once",
            rate.sort,
            rate.asked,
            rate.met,
            millions(rate.card_s),
            millions(rate.processor_s),
            rate.differ,
            rate.takes[0],
            rate.takes[1],
            rate.at_once
        );
    }
    Ok(())
}

//! How long labels alone take, by both kernels: `make bench-labels`.
//!
//! All cameras of a keyframe of scene-0103 at 1600×900, on all cores; the folder of real data is `TROVE_TEST_DATA`. An
//! argument other than 1 scales the pictures.

mod street;

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result};
use street::Street;
use trove_build::{PictureSize, ViewSettings};
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};

/// A keyframe with road users on all sides.
const KEYFRAME: usize = 10;
/// The best of so many rounds counts: other programs only slow things down.
const ROUNDS: usize = 3;

fn main() -> Result<()> {
    let scale: f64 = std::env::args().nth(1).map_or(Ok(1.0), |text| text.parse()).context("expected a scale")?;
    let views = ViewSettings { size: PictureSize::Scaled(scale), spp: 1, ..ViewSettings::default() };
    let (scene, shots) = Street::build("scene-0103", "boston-seaport.osm")?.at(KEYFRAME, views);
    for kernel in [KernelChoice::Embree, KernelChoice::Obvhs] {
        let search = std::env::var_os("TROVE_EMBREE").map(PathBuf::from).into_iter().collect();
        let renderer = Renderer::new(&RendererOptions {
            kernel,
            denoise: Denoising::None,
            threads: 0,
            search,
            ..Default::default()
        })?;
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

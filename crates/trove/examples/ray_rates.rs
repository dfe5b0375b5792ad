//! How fast the renderer traces rays against bare Embree on the same rays: `make bench-rays`.
//!
//! CAM_FRONT of a keyframe of both sample scenes, one sample a pixel, one thread; the folder of real data is
//! `TROVE_TEST_DATA`.

mod street;

use std::path::PathBuf;

use anyhow::Result;
use street::Street;
use trove_build::{PictureSize, ViewSettings};
use trove_render::{Denoising, KernelChoice, RaySeconds, Renderer, RendererOptions};

fn main() -> Result<()> {
    let search = std::env::var_os("TROVE_EMBREE").map(PathBuf::from).into_iter().collect();
    let renderer = Renderer::new(&RendererOptions {
        kernel: KernelChoice::Embree,
        denoise: Denoising::None,
        threads: 1,
        search,
        ..Default::default()
    })?;
    for (name, map) in [("scene-0103", "boston-seaport.osm"), ("scene-0061", "singapore-onenorth.osm")] {
        let (rig, size) = (Some(vec!["CAM_FRONT".into()]), PictureSize::Scaled(0.5));
        let views = ViewSettings { rig, size, spp: 1, ..ViewSettings::default() };
        let (scene, shots) = Street::build(name, map)?.at(1, views);
        let prepared = renderer.prepare(&scene)?;
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

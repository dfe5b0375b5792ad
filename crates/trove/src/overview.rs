//! A picture of a built place from above.

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use glam::{DMat3, DQuat, DVec2, DVec3};
use trove_model::{Camera, Distortion, Lens, Pose, Scene, Seed, Shot, World};
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};
use trove_write::write_picture;

/// Side of the picture, pixels.
const SIDE_PX: u32 = 1200;
/// The camera is this many times as high as what it sees is wide: walls hide little ground.
const HEIGHT: f64 = 8.0;
/// Samples a pixel.
const SPP: u32 = 16;

/// A picture that is asked for beside a scene.
#[derive(Args)]
pub(crate) struct Overview {
    /// Also write a PNG of the place from above, north up.
    #[arg(long, value_name = "FILE.png")]
    overview: Option<PathBuf>,
    /// Side of the square that the overview shows, metres [default: the whole place].
    #[arg(long, value_name = "METRES", requires = "overview")]
    overview_size_m: Option<f64>,
    /// Centre of the overview, metres east and north of the drive's start [default: the centre of the place].
    #[arg(long, value_name = "X,Y", value_parser = position, allow_hyphen_values = true, requires = "overview")]
    overview_at: Option<DVec2>,
}

impl Overview {
    /// Takes and writes the picture, where one is asked for.
    pub(crate) fn write(&self, scene: &Scene, bounds: trove_model::Bounds, search: Vec<PathBuf>) -> Result<()> {
        let Some(path) = &self.overview else { return Ok(()) };
        let size_m = self.overview_size_m.unwrap_or(bounds.size_m().max_element());
        let shot = shot(self.overview_at.unwrap_or(bounds.centre()), size_m);
        take(scene, &shot, path, search)
    }
}

/// A camera that looks straight down at a square.
fn shot(middle: DVec2, size_m: f64) -> Shot {
    let side = f64::from(SIDE_PX);
    let focal_px = side * HEIGHT;
    let lens = Lens {
        width_px: SIDE_PX,
        height_px: SIDE_PX,
        fx_px: focal_px,
        fy_px: focal_px,
        cx_px: side / 2.0,
        cy_px: side / 2.0,
        distortion: Distortion::None,
    };
    let down = DQuat::from_mat3(&DMat3::from_cols(DVec3::X, -DVec3::Y, -DVec3::Z));
    let world_from_camera = Pose::<World, Camera>::new(down, middle.extend(size_m * HEIGHT));
    Shot { spp: SPP, seed: Seed(0), ..Shot::new("overview", lens, world_from_camera) }
}

fn take(scene: &Scene, shot: &Shot, path: &Path, search: Vec<PathBuf>) -> Result<()> {
    let renderer = Renderer::new(&RendererOptions {
        kernel: KernelChoice::Auto,
        denoise: Denoising::Best,
        threads: 0,
        search,
        ..Default::default()
    })?;
    let prepared = renderer.prepare(scene)?;
    let capture = renderer.render(&prepared, shot, true, &|_| false);
    if let Some(color) = capture.and_then(|capture| capture.color) {
        write_picture(path, &color.srgb)?;
    }
    Ok(())
}

fn position(text: &str) -> Result<DVec2, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y]) => Ok(DVec2::new(x, y)),
        _ => Err("expected metres east and north, such as 12.5,-40".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn north_is_up_and_the_square_fills_the_picture() {
        let shot = shot(DVec2::new(10.0, 20.0), 100.0);
        let pixel = |p: DVec3| shot.lens.project(shot.world_from_camera.inverse().point(p)).unwrap();
        let (north_west, middle) = (pixel(DVec3::new(-40.0, 70.0, 0.0)), pixel(DVec3::new(10.0, 20.0, 5.0)));
        assert!(north_west.length() < 1e-6, "{north_west}");
        assert!((middle - f64::from(SIDE_PX) / 2.0).length() < 1e-6, "{middle}");
    }

    #[test]
    fn a_position_is_two_numbers() {
        assert_eq!(position("12.5,-40"), Ok(DVec2::new(12.5, -40.0)));
        assert!(position("12.5").is_err() && position("a,b").is_err());
    }
}

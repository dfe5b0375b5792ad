//! A street of clay, for another renderer to agree on: `make bench-clay`.
//!
//! CAM_FRONT of a keyframe of scene-0103, whose surfaces are all matt and grey, with its sun and its sky. Writes
//! `scene.glb`, `sky.exr`, and, as floats, row by row, what two pictures show that differ by their noise alone, into a
//! folder. The folder of real data is `TROVE_TEST_DATA`.

mod street;

use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result};
use glam::{DVec3, Vec3};
use street::Street;
use trove_build::{PictureSize, ViewSettings};
use trove_model::{Environment, EnvironmentMap, Material, Scene, Seed, Shot};
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions, SUN_RADIUS_RAD, bake_sky};
use trove_write::gltf::{SunLight, write_environment, write_glb};
use trove_write::write_atomically;

const KEYFRAME: usize = 1;
/// Bright enough for light to be sent on, dark enough for the two renderers' last bounces not to count.
const ALBEDO: f32 = 0.3;

fn main() -> Result<()> {
    let mut words = std::env::args().skip(1);
    let [out, scale, spp] = std::array::from_fn(|_| words.next());
    let out = PathBuf::from(out.context("expected a folder, a scale and samples a pixel")?);
    let (scale, spp) = (scale.context("expected a scale")?.parse()?, spp.context("expected samples")?.parse()?);
    let rig = Some(vec!["CAM_FRONT".into()]);
    let views = ViewSettings { rig, size: PictureSize::Scaled(scale), spp, ..ViewSettings::default() };
    let (scene, shots) = Street::build("scene-0103", "boston-seaport.osm")?.at(KEYFRAME, views);
    std::fs::create_dir_all(&out)?;
    let scene = of_clay(scene, &shots, &out)?;

    let search = std::env::var_os("TROVE_EMBREE").map(PathBuf::from).into_iter().collect();
    let renderer = Renderer::new(&RendererOptions {
        kernel: KernelChoice::Auto,
        denoise: Denoising::None,
        threads: 0,
        search,
        ..Default::default()
    })?;
    let prepared = renderer.prepare(&scene)?;
    for seed in [1, 2] {
        let shot = Shot { seed: Seed(seed), ..shots[0].clone() };
        let taken = renderer.render(&prepared, &shot, true, &|_| false).and_then(|capture| capture.color);
        let radiance = taken.context("nothing was rendered")?.radiance;
        let bytes: Vec<u8> = radiance.data.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
        write_atomically(&out.join(format!("{seed}.f32")), &bytes)?;
    }
    Ok(())
}

/// Shapes as they are, opaque, matt and grey: what no two renderers should see differently. Writes them with sun and sky, and
/// returns them under a map of both, since before a map there is no haze, which other renderers do not have.
fn of_clay(mut scene: Scene, shots: &[Shot], out: &Path) -> Result<Scene> {
    let grey = Material { base_color: Vec3::splat(ALBEDO), roughness: 0.0, ior: 1.0, ..Material::default() };
    scene.materials.fill(grey);
    for mesh in scene.meshes.iter_mut().map(Arc::make_mut) {
        // Smooth normals that lean away from their triangle are a matter of taste, and files know no tint above 1.
        mesh.normals.clear();
        mesh.tints.iter_mut().for_each(|tint| *tint = tint.min(Vec3::ONE));
    }
    let Environment::Sky(sky) = &scene.light.environment else { anyhow::bail!("expected a computed sky") };
    let sky = bake_sky(sky);
    let mut map = sky.map.clone();
    let to_sun = put_sun(&mut map, sky.to_sun, sky.sun_irradiance);
    let sun = SunLight { to_sun, irradiance: sky.sun_irradiance, radius_rad: f64::from(SUN_RADIUS_RAD) };
    write_environment(&out.join("sky.exr"), &sky.map)?;
    write_glb(&out.join("scene.glb"), &scene, shots, Some(&sun))?;
    scene.light.environment = Environment::Map(Arc::new(map));
    Ok(scene)
}

/// Puts the sun into the texel of a map that it is in, and returns where that texel's middle is.
fn put_sun(map: &mut EnvironmentMap, to_sun: Vec3, irradiance: Vec3) -> DVec3 {
    let (width, height) = (f64::from(map.width), f64::from(map.height));
    let to_sun = to_sun.as_dvec3();
    let (azimuth, zenith) = (to_sun.y.atan2(to_sun.x), to_sun.z.acos());
    let (x, y) = (((0.5 - azimuth / TAU) * width).floor(), (zenith / PI * height).floor());
    let (azimuth, zenith) = (PI - TAU * (x + 0.5) / width, PI * (y + 0.5) / height);
    let solid_angle = TAU / width * 2.0 * (0.5 * PI / height).sin() * zenith.sin();
    let texel = &mut map.rgb[(y * width + x) as usize];
    *texel = (Vec3::from(*texel) + irradiance / solid_angle as f32).to_array();
    DVec3::new(zenith.sin() * azimuth.cos(), zenith.sin() * azimuth.sin(), zenith.cos())
}

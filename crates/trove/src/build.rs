//! `trove build`: the virtual scene alone.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use serde_json::json;
use trove_format::{EntryRow, ReportTable};
use trove_model::{Environment, Report};
use trove_render::{SUN_RADIUS_RAD, bake_sky};
use trove_write::gltf::{SunLight, write_environment, write_glb};

use crate::contents::Contents;
use crate::library;
use crate::overview::Overview;
use crate::recipe::Recipe;
use crate::run::fit_rows;
use crate::sources::Sources;
use crate::virtual_scene::VirtualScene;

/// Builds the recipe's first scene at one keyframe and writes it, with the recipe's cameras and the sun, as GLB; and
/// where they are asked for, its sky as OpenEXR and a picture from above; `search` is where Embree and the denoiser are
/// looked for.
pub(crate) fn run(
    recipe: &Recipe,
    out: &Path,
    keyframe: Option<usize>,
    environment: Option<&Path>,
    overview: &Overview,
    search: Vec<PathBuf>,
    as_json: bool,
) -> Result<()> {
    let report = Report::default();
    let sources = Sources::open(recipe, &report)?;
    let scenes = sources.scenes()?;
    let (name, _) = scenes.first().context("the recipe has no scene")?;
    let started = std::time::Instant::now();
    let (drive, map) = sources.drive(name, &report)?;
    report.measure("read.seconds", started.elapsed().as_secs_f64());
    let first = match &recipe.drive {
        Some(section) => section.keyframes.of(drive.keyframes.len())?[0],
        None => 0,
    };
    let keyframe = keyframe.unwrap_or(first);
    let count = drive.keyframes.len();
    ensure!(keyframe < count, "--keyframe: {name} has keyframes 0 to {}, found {keyframe}", count.saturating_sub(1));
    let started = Instant::now();
    let library = library::gather(recipe, &search, &mut Contents::open(), &report)?;
    report.measure("library.seconds", started.elapsed().as_secs_f64());
    let started = Instant::now();
    let built = VirtualScene::build(&sources, (&drive, map.as_ref()), &library, 0, &report)?;
    let scene = built.at(keyframe);
    report.measure("build.seconds", started.elapsed().as_secs_f64());
    let shots = built.shots(keyframe, &report);
    let sun = match &scene.light.environment {
        Environment::Sky(sky) => {
            let sky = bake_sky(sky);
            environment.map_or(Ok(()), |path| write_environment(path, &sky.map))?;
            let radius_rad = f64::from(SUN_RADIUS_RAD);
            let sun = SunLight { to_sun: sky.to_sun.as_dvec3(), irradiance: sky.sun_irradiance, radius_rad };
            Some(sun).filter(|sun| sun.irradiance.max_element() > 0.0)
        }
        Environment::Map(map) => {
            environment.map_or(Ok(()), |path| write_environment(path, map))?;
            None
        }
    };
    let stats = write_glb(out, &scene, &shots, sun.as_ref())?;
    let area = trove_build::area(&drive).with_context(|| format!("{name}: nothing was recorded"))?;
    overview.write(&scene, area, search)?;
    let report = ReportTable::from(&report);
    if as_json {
        let printed = json!({
            "out": out,
            "scene": name,
            "keyframe": keyframe,
            "bytes": stats.bytes,
            "meshes": stats.meshes,
            "instances": stats.instances,
            "triangles": stats.triangles,
            "report": report,
            "fits": fit_rows(built.site.fits()),
        });
        println!("{}", serde_json::to_string_pretty(&printed)?);
        return Ok(());
    }
    println!(
        "{}: {name} at keyframe {keyframe}, {} meshes, {} instances, {} triangles, {:.1} MB",
        out.display(),
        stats.meshes,
        stats.instances,
        stats.triangles,
        stats.bytes as f64 * 1e-6
    );
    for (measured, value) in &report.measurements {
        println!("  {measured} = {}", value.map_or("not a number".into(), |value| value.to_string()));
    }
    print_entries(&report, "  ");
    Ok(())
}

/// Prints what was dropped, substituted or guessed, a line a kind, behind an indentation.
pub(crate) fn print_entries(report: &ReportTable, indentation: &str) {
    for EntryRow { outcome, what, count, examples } in &report.entries {
        let example = examples.first().map_or("", String::as_str);
        println!("{indentation}{} {count}× {what}, such as {example}", outcome.name());
    }
}

//! `trove build`: the virtual scene alone.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde_json::json;
use trove_build::{BuildSettings, LightChoice};
use trove_model::{Report, Seed};
use trove_write::gltf::write_glb;

use crate::recipe::Recipe;
use crate::run::report_json;
use crate::sources::Sources;

/// Builds the recipe's first scene at one keyframe and writes it as GLB.
pub(crate) fn run(recipe: &Recipe, out: &Path, keyframe: Option<usize>, as_json: bool) -> Result<()> {
    let report = Report::default();
    let sources = Sources::open(recipe, &report)?;
    let scenes = sources.scenes()?;
    let (name, _) = scenes.first().context("the recipe has no scene")?;
    let (drive, map) = sources.drive(name, &report)?;
    let first = match &recipe.drive {
        Some(section) => section.keyframes.of(drive.keyframes.len())?[0],
        None => 0,
    };
    let keyframe = keyframe.unwrap_or(first);
    let count = drive.keyframes.len();
    ensure!(keyframe < count, "--keyframe: {name} has keyframes 0 to {}, found {keyframe}", count.saturating_sub(1));
    let settings = BuildSettings {
        seed: Seed(recipe.seed).child(name).nth(0),
        top_k: recipe.assets.top_k,
        light: sources.environment.clone().map_or(LightChoice::CaptureTime, LightChoice::Map),
    };
    let started = std::time::Instant::now();
    let site = trove_build::build(&drive, map.as_ref(), &trove_assets::library(), &settings, &report)?;
    let scene = site.scene(&drive, keyframe);
    report.measure("build.seconds", started.elapsed().as_secs_f64());
    let stats = write_glb(out, &scene)?;
    let report = report_json(&report);
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
    for (measured, value) in report["measurements"].as_object().into_iter().flatten() {
        println!("  {measured} = {value}");
    }
    for entry in report["entries"].as_array().into_iter().flatten() {
        println!("  {} {}× {}, such as {}", entry["outcome"], entry["count"], entry["what"], entry["examples"][0]);
    }
    Ok(())
}

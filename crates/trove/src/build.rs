//! `trove build`: the virtual scene alone.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde_json::json;
use trove_format::{EntryRow, ReportTable};
use trove_model::{Environment, Report};
use trove_render::{SUN_RADIUS_RAD, bake_sky};
use trove_write::gltf::{GlbStats, SunLight, write_environment, write_glb};

use crate::answer::Answer;
use crate::built_scene::BuiltScene;
use crate::overview::Overview;
use crate::recipe::Recipe;

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
) -> Result<Answer> {
    let report = Report::default();
    let built = BuiltScene::build(recipe, keyframe, &search, &report)?;
    let stats = write_scene(&built, out, environment)?;
    let BuiltScene { name, keyframe, timeline, scene, fits, .. } = built;
    let area = trove_build::area(&timeline.recorded).with_context(|| format!("{name}: nothing was recorded"))?;
    overview.write(&scene, area, search)?;
    let report = ReportTable::from(&report);
    let json = json!({
        "out": out.to_string_lossy(),
        "scene": name,
        "keyframe": keyframe,
        "bytes": stats.bytes,
        "meshes": stats.meshes,
        "instances": stats.instances,
        "triangles": stats.triangles,
        "report": report,
        "fits": fits,
    });
    let out = out.to_owned();
    Ok(Answer::new(as_json, json, move || {
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
    }))
}

/// Writes a scene with the recipe's cameras and the sun as GLB, and where it is asked for its sky as OpenEXR.
pub(crate) fn write_scene(built: &BuiltScene, out: &Path, environment: Option<&Path>) -> Result<GlbStats> {
    let BuiltScene { scene, shots, .. } = built;
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
    Ok(write_glb(out, scene, shots, sun.as_ref())?)
}

/// Prints what was dropped, substituted or guessed, a line a kind, behind an indentation.
pub(crate) fn print_entries(report: &ReportTable, indentation: &str) {
    for EntryRow { outcome, what, count, examples } in &report.entries {
        let example = examples.first().map_or("", String::as_str);
        println!("{indentation}{} {count}× {what}, such as {example}", outcome.name());
    }
}

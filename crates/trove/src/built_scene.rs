//! A recipe's first scene at one keyframe, without pictures.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use trove_build::Timeline;
use trove_format::FitRow;
use trove_model::{Report, Scene, Shot};
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};

use crate::contents::Contents;
use crate::library;
use crate::photographs::match_photographs;
use crate::recipe::Recipe;
use crate::run::fit_rows;
use crate::sources::Sources;
use crate::virtual_scene::VirtualScene;

/// What stands and drives at a moment, and the recipe's cameras.
pub(crate) struct BuiltScene {
    /// The scene's name.
    pub(crate) name: String,
    /// The recorded drive, and its moments.
    pub(crate) timeline: Timeline,
    /// Index of the moment.
    pub(crate) keyframe: usize,
    pub(crate) scene: Scene,
    pub(crate) shots: Vec<Shot>,
    /// Which asset stands for every track.
    pub(crate) fits: Vec<FitRow>,
}

impl BuiltScene {
    /// Builds variation 0 of the recipe's first scene at a moment, by default the recipe's first; `search` is where
    /// MakeHuman's body is looked for.
    pub(crate) fn build(recipe: &Recipe, keyframe: Option<usize>, search: &[PathBuf], report: &Report) -> Result<Self> {
        let sources = Sources::open(recipe, report)?;
        let scenes = sources.scenes()?;
        let (name, _) = scenes.first().context("the recipe has no scene")?;
        let started = Instant::now();
        let (timeline, map) = sources.drive(name, report)?;
        let moments = timeline.moments();
        report.measure("read.seconds", started.elapsed().as_secs_f64());
        let first = match &recipe.drive {
            Some(section) => moments.chosen(&section.keyframes.of(timeline.recorded.keyframes.len())?)[0],
            None => 0,
        };
        let keyframe = keyframe.unwrap_or(first);
        let count = moments.drive.keyframes.len();
        ensure!(keyframe < count, "keyframe: {name} has keyframes 0 to {}, found {keyframe}", count.saturating_sub(1));
        let started = Instant::now();
        let library = library::gather(recipe, search, &mut Contents::open(), report)?;
        report.measure("library.seconds", started.elapsed().as_secs_f64());
        let started = Instant::now();
        let mut built = VirtualScene::build(&sources, (&timeline, map.as_ref()), &library, 0, report)?;
        if recipe.views.match_photographs {
            let (denoise, threads) = (Denoising::None, recipe.render.threads);
            let options = RendererOptions {
                kernel: KernelChoice::Auto,
                denoise,
                threads,
                search: search.to_vec(),
                ..Default::default()
            };
            match_photographs(&mut built, &sources, &Renderer::new(&options)?, report)?;
        }
        let scene = built.at(keyframe);
        report.measure("build.seconds", started.elapsed().as_secs_f64());
        let shots = built.shots(keyframe, report);
        let fits = fit_rows(built.site.fits());
        Ok(Self { name: name.clone(), keyframe, scene, shots, fits, timeline })
    }
}

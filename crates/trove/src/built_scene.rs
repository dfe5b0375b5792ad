//! A recipe's first scene at one keyframe, without pictures.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use trove_format::FitRow;
use trove_model::{Drive, Report, Scene, Shot};

use crate::contents::Contents;
use crate::library;
use crate::recipe::Recipe;
use crate::run::fit_rows;
use crate::sources::Sources;
use crate::virtual_scene::VirtualScene;

/// What stands and drives at a moment, and the recipe's cameras.
pub(crate) struct BuiltScene {
    /// The recorded drive; its name is the scene's.
    pub(crate) name: String,
    pub(crate) drive: Drive,
    pub(crate) keyframe: usize,
    pub(crate) scene: Scene,
    pub(crate) shots: Vec<Shot>,
    /// Which asset stands for every track.
    pub(crate) fits: Vec<FitRow>,
}

impl BuiltScene {
    /// Builds variation 0 of the recipe's first scene at a keyframe, by default the recipe's first; `search` is where
    /// MakeHuman's body is looked for.
    pub(crate) fn build(recipe: &Recipe, keyframe: Option<usize>, search: &[PathBuf], report: &Report) -> Result<Self> {
        let sources = Sources::open(recipe, report)?;
        let scenes = sources.scenes()?;
        let (name, _) = scenes.first().context("the recipe has no scene")?;
        let started = Instant::now();
        let (drive, map) = sources.drive(name, report)?;
        report.measure("read.seconds", started.elapsed().as_secs_f64());
        let first = match &recipe.drive {
            Some(section) => section.keyframes.of(drive.keyframes.len())?[0],
            None => 0,
        };
        let keyframe = keyframe.unwrap_or(first);
        let count = drive.keyframes.len();
        ensure!(keyframe < count, "keyframe: {name} has keyframes 0 to {}, found {keyframe}", count.saturating_sub(1));
        let started = Instant::now();
        let library = library::gather(recipe, search, &mut Contents::open(), report)?;
        report.measure("library.seconds", started.elapsed().as_secs_f64());
        let started = Instant::now();
        let built = VirtualScene::build(&sources, (&drive, map.as_ref()), &library, 0, report)?;
        let scene = built.at(keyframe);
        report.measure("build.seconds", started.elapsed().as_secs_f64());
        let shots = built.shots(keyframe, report);
        let fits = fit_rows(built.site.fits());
        Ok(Self { name: name.clone(), keyframe, scene, shots, fits, drive })
    }
}

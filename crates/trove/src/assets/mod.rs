//! `trove assets`: what there is to build with.

mod check;
mod import;
mod list;
mod page;
mod sheet;
mod studio;

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Subcommand;
use trove_model::{AssetLibrary, Outcome, Report};

use crate::contents::Contents;
use crate::library::{self, Makings, user};

/// What to do with asset libraries.
#[derive(Subcommand)]
pub(crate) enum AssetsCommand {
    /// List models and materials.
    #[command(after_help = "Example:\n  trove assets list --json")]
    List {
        /// Folder with a library.toml or plans.toml [default: the built-in library].
        #[arg(long, value_name = "DIR")]
        library: Option<PathBuf>,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Import a folder of models, textures and skies: write its library.toml, guessing what nothing states.
    #[command(after_help = "Example:\n  trove assets import my-assets")]
    Import {
        /// Folder to import.
        dir: PathBuf,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Check a library; exits with 1 if something cannot be used.
    #[command(after_help = "Example:\n  trove assets check my-assets")]
    Check {
        /// Folder with a library.toml or plans.toml.
        dir: PathBuf,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Draw every model and material on one contact sheet, or page.
    #[command(
        after_help = "Example:\n  trove assets sheet --out sheet.png\n  trove assets sheet --out assets.html\n  trove assets sheet --only car/ --only bus/ --size 800x600 --each close-ups"
    )]
    Sheet(sheet::Sheet),
}

/// Runs it and returns the exit status; `search` is where Embree, the denoiser and people's bodies are looked for.
pub(crate) fn run(command: AssetsCommand, search: Vec<PathBuf>) -> Result<i32> {
    match command {
        AssetsCommand::List { library, json } => list::run(&open(library.as_deref(), &search)?, json).map(|()| 0),
        AssetsCommand::Sheet(sheet) => sheet.run(&open(sheet.library(), &search)?, search).map(|()| 0),
        AssetsCommand::Import { dir, json } => import::run(&dir, json).map(|()| 0),
        AssetsCommand::Check { dir, json } => check::run(&dir, json, &search),
    }
}

/// A folder's library, or the built-in one; what was wrong with it is told.
fn open(folder: Option<&Path>, search: &[PathBuf]) -> Result<AssetLibrary> {
    let report = Report::default();
    let library = match folder {
        Some(folder) => user::read(folder, search, &report)?,
        None => library::procedural(&Makings { texture_scale: 1, search }, &mut Contents::open(), &report)?,
    };
    for entry in report.entries().iter().filter(|entry| entry.outcome != Outcome::Guessed) {
        eprintln!("{} × {}, such as {}", entry.count, entry.what, entry.examples.join("; "));
    }
    Ok(library)
}

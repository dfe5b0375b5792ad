//! `trove assets`: what there is to build with.

mod list;
mod sheet;
mod studio;

use std::path::PathBuf;

use anyhow::Result;
use clap::Subcommand;
use trove_model::Report;

use crate::library::{self, Makings};

/// What to do with asset libraries.
#[derive(Subcommand)]
pub(crate) enum AssetsCommand {
    /// Lists models and materials.
    #[command(after_help = "Example:\n  trove assets list --json")]
    List {
        /// Prints JSON.
        #[arg(long)]
        json: bool,
    },
    /// Draws every model and material on one page.
    #[command(
        after_help = "Example:\n  trove assets sheet --out sheet.png\n  trove assets sheet --only car/ --only bus/ --size 800x600 --each close-ups"
    )]
    Sheet(sheet::Sheet),
}

/// Runs it; `search` is where Embree and the denoiser are looked for.
pub(crate) fn run(command: AssetsCommand, search: Vec<PathBuf>) -> Result<()> {
    let library = library::procedural(&Makings { texture_scale: 1, search: &search }, &Report::default());
    match command {
        AssetsCommand::List { json } => list::run(&library, json),
        AssetsCommand::Sheet(sheet) => sheet.run(&library, search),
    }
}

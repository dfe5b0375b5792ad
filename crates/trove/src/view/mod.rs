//! `trove view`: one page that shows a finished folder, a recipe's scene or a `.glb` file.

mod built;
mod chunks;
mod file;
mod folder;
mod page;
mod pictures;
mod pose;
mod scene;
mod serve;
mod shapes;
mod table;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use serde_json::json;
use trove_files::write_atomically;
use trove_format::Manifest;

use self::built::Builder;
use self::chunks::Chunks;
use self::page::html;
use self::table::Table;
use crate::answer::Answer;
use crate::message;
use crate::recipe::Recipe;
use crate::run::recipe_of;
use crate::watch::Watch;

/// `trove view`
#[derive(Args)]
pub(crate) struct View {
    /// A finished folder of trove generate; or, without images, a recipe (TOML), whose first scene is built, or a .glb file,
    /// such as trove build writes.
    input: PathBuf,
    /// The page to write; what does not fit into it comes to the folder PAGE.frames beside it.
    #[arg(long, value_name = "PAGE.html")]
    out: PathBuf,
    /// Megabytes of scenes and images that the page itself holds; where all take more, all lie beside it.
    #[arg(long, default_value_t = 25, value_name = "MB")]
    embed: u32,
    /// Scenes of a folder that are built again from its recipe to show their shapes, which takes some seconds each.
    #[arg(long, default_value_t = 2, value_name = "SCENES")]
    shapes: usize,
    /// Then serve the page to browsers on this machine, until Ctrl-C.
    #[arg(long)]
    serve: bool,
    /// Print a summary as JSON.
    #[arg(long)]
    json: bool,
}

impl View {
    pub(crate) fn run(self, search: Vec<PathBuf>, watch: &Watch) -> Result<Answer> {
        ensure!(!self.out.is_dir(), "{}: expected the name of a page to write, found a folder", self.out.display());
        watch.listen();
        let folder = self.out.with_extension("frames");
        let beside = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let mut table = Table::new(concat!("TRoVE ", env!("CARGO_PKG_VERSION")).into(), beside);
        let mut chunks = Chunks::new(self.embed as usize * 1_000_000, folder);
        let mut without_shapes = None;
        if self.input.is_dir() {
            without_shapes = self.show_folder(&mut table, &mut chunks, &search, watch)?;
        } else if self.input.extension().is_some_and(|ending| ending == "toml") {
            let recipe = Recipe::read(&self.input)?;
            Builder::open(&recipe, &search)?.first_scene(&recipe, &mut table, &mut chunks, watch)?;
        } else if self.input.extension().is_some_and(|ending| ending == "glb" || ending == "gltf") {
            file::add(&self.input, &mut table, &mut chunks)?;
        } else {
            bail!(
                "{}: expected a finished folder of trove generate, a recipe (.toml) or a scene (.glb), found neither",
                self.input.display()
            );
        }
        let named = self.input.canonicalize().unwrap_or_else(|_| self.input.clone());
        let page = html(&named.file_name().unwrap_or_default().to_string_lossy(), &table, &chunks)?;
        write_atomically(&self.out, page.as_bytes()).with_context(|| format!("{}", self.out.display()))?;
        let scenes = table.scenes.len();
        let frames: usize =
            table.scenes.iter().flat_map(|scene| &scene.moments).map(|moment| moment.frames.len()).sum();
        let beside = chunks.are_beside().then(|| chunks.folder().to_owned());
        if self.serve {
            serve::serve(&self.out, chunks.folder(), watch)?;
        }
        let json = json!({
            "page": self.out.to_string_lossy(),
            "bytes": page.len(),
            "scenes": scenes,
            "frames": frames,
            "beside": beside.as_ref().map(|folder| folder.to_string_lossy()),
            "without_shapes": without_shapes,
        });
        let out = self.out;
        Ok(Answer::new(self.json, json, move || {
            println!("{}: scenes {scenes}, cameras' frames {frames}", out.display());
            match &beside {
                Some(folder) => println!("  they lie in {}, which belongs beside it", folder.display()),
                None => println!("  it needs no other file"),
            }
            if let Some(why) = &without_shapes {
                println!("  boxes alone, no shapes: {why}");
            }
        }))
    }

    /// Frames of a folder; says why their scenes have no shapes, where they have none.
    fn show_folder(
        &self,
        table: &mut Table,
        chunks: &mut Chunks,
        search: &[PathBuf],
        watch: &Watch,
    ) -> Result<Option<String>> {
        let manifest = manifest(&self.input)?;
        let mut without_shapes = None;
        let recipe = if self.shapes == 0 { None } else { noted(recipe_of(&self.input), &mut without_shapes) };
        let builder = recipe.as_ref().and_then(|recipe| noted(Builder::open(recipe, search), &mut without_shapes));
        let wanted = if builder.is_some() { self.shapes } else { 0 };
        let shapes = |scene: &str, variation, moments: &[u32]| {
            noted(builder.as_ref()?.shapes(scene, variation, moments), &mut without_shapes)
        };
        folder::add(&self.input, &manifest, (wanted, shapes), (table, chunks), watch)?;
        Ok(without_shapes)
    }
}

/// What was made, or a note of why not: shapes are worth having, but the frames are there without them.
fn noted<T>(made: Result<T>, why: &mut Option<String>) -> Option<T> {
    made.map_err(|error| *why = Some(message::of(&error))).ok()
}

fn manifest(folder: &Path) -> Result<Manifest> {
    let found = Manifest::read(folder)?.with_context(|| {
        format!("{}: expected a finished folder of trove generate, found no manifest.json in it", folder.display())
    })?;
    ensure!(!found.frames.is_empty(), "{}: expected frames, found none", folder.display());
    Ok(found)
}

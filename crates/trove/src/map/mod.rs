//! `trove map`: the map that a recipe's drives or place need, by the Overpass API.

mod boxes;
mod extract;
mod overpass;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use serde_json::json;
use trove_files::write_atomically;
use trove_model::Report;
use trove_read::osm::GeoExtent;
use trove_write::sha256;

use self::boxes::{MapBox, merged, needed};
use self::extract::{largest, settled};
use self::overpass::{Patience, Server, query};
use crate::cache;
use crate::message::shown;
use crate::progress::Progress;
use crate::recipe::Recipe;
use crate::sources::Sources;
use crate::watch::Watch;

/// The public server with the most machines behind it; `--endpoint` names another one.
const ENDPOINT: &str = "https://overpass-api.de/api/interpreter";

/// What is fetched, and from where.
#[derive(Args)]
pub(crate) struct MapCommand {
    /// Recipe (TOML).
    recipe: PathBuf,
    /// The .osm file to write; where the scenes lie apart, FILE-1.osm, FILE-2.osm and so on.
    #[arg(long, value_name = "FILE.osm", required_unless_present = "dry_run")]
    out: Option<PathBuf>,
    /// Server of the Overpass API.
    #[arg(long, value_name = "URL", default_value = ENDPOINT)]
    endpoint: String,
    /// Print the bounding boxes, and fetch nothing.
    #[arg(long)]
    dry_run: bool,
    /// Fetch again what has been fetched before.
    #[arg(long)]
    refresh: bool,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// A box, and where its map was written.
struct Fetched<'b> {
    map_box: &'b MapBox,
    file: Option<PathBuf>,
}

impl MapCommand {
    pub(crate) fn run(&self) -> Result<()> {
        self.run_with(cache::folder().as_deref())
    }

    /// With the folder of what can be made again.
    fn run_with(&self, cache: Option<&Path>) -> Result<()> {
        let recipe = Recipe::read(&self.recipe)?;
        let boxes = boxes_of(&recipe)?;
        let Some(out) = self.out.as_ref().filter(|_| !self.dry_run) else {
            let unfetched: Vec<Fetched> = boxes.iter().map(|map_box| Fetched { map_box, file: None }).collect();
            return self.print(&recipe, &unfetched);
        };
        let server = Server::new(&self.endpoint, Patience::default())?;
        let cache = cache.map(|folder| folder.join("maps"));
        let progress = Progress::new(boxes.len(), &Watch::default());
        let mut fetched = Vec::new();
        for (map_box, file) in boxes.iter().zip(names(out, boxes.len())) {
            progress.say(&format!("fetching {}", map_box.extent));
            fetch(&server, map_box.extent, &file, cache.as_deref(), self.refresh)?;
            progress.frame_done();
            fetched.push(Fetched { map_box, file: Some(file) });
        }
        progress.finish();
        self.print(&recipe, &fetched)
    }

    fn print(&self, recipe: &Recipe, fetched: &[Fetched]) -> Result<()> {
        let files: Vec<String> = fetched.iter().filter_map(|f| f.file.as_deref()).map(|f| told(recipe, f)).collect();
        if self.json {
            let row = |Fetched { map_box, file }: &Fetched| {
                let GeoExtent { min_lat_deg, max_lat_deg, min_lon_deg, max_lon_deg } = map_box.extent;
                json!({
                    "scenes": map_box.scenes, "min_lat_deg": min_lat_deg, "min_lon_deg": min_lon_deg,
                    "max_lat_deg": max_lat_deg, "max_lon_deg": max_lon_deg, "km2": map_box.km2(),
                    "file": file.as_deref().map(std::path::Path::to_string_lossy),
                })
            };
            let rows: Vec<_> = fetched.iter().map(row).collect();
            println!("{}", serde_json::to_string_pretty(&json!({ "boxes": rows, "osm": files }))?);
            return Ok(());
        }
        for Fetched { map_box, file } in fetched {
            let file = file.as_ref().map(|file| format!(": {}", file.display())).unwrap_or_default();
            println!("{}, {:.1} km² for {}{file}", map_box.extent, map_box.km2(), shown(&map_box.told_scenes()));
        }
        match &files[..] {
            [] => {}
            [file] => println!("\n[map]\nosm = {}", toml::Value::from(file.as_str())),
            files => println!("\n[map]\nosm = {}", toml::Value::from(files.to_vec())),
        }
        if !files.is_empty() {
            println!(
                "\nThe map is © OpenStreetMap contributors, ODbL 1.0; the manifest of what you make of it says so."
            );
        }
        Ok(())
    }
}

/// The boxes of the recipe's scenes, those that overlap made one.
fn boxes_of(recipe: &Recipe) -> Result<Vec<MapBox>> {
    let report = Report::default();
    let sources = Sources::open(recipe, &report)?;
    let scenes = sources.scenes()?;
    let progress = Progress::new(scenes.len(), &Watch::default());
    progress.say("reading where the scenes are");
    let mut boxes = Vec::new();
    for (scene, _) in &scenes {
        let (projection, area) = sources.area(scene, &report)?;
        boxes.push(needed(scene, &projection, area)?);
        progress.frame_done();
    }
    progress.finish();
    merged(boxes)
}

/// The map of a box, from the cache or the server, under its name only when it is whole.
fn fetch(server: &Server, extent: GeoExtent, file: &Path, cache: Option<&Path>, refresh: bool) -> Result<()> {
    let query = query(extent);
    let kept = cache
        .map(|folder| folder.join(format!("{}.osm", sha256(format!("{}\n{query}", server.endpoint()).as_bytes()))));
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).with_context(|| format!("{}: expected a folder", folder.display()))?;
    }
    let known = kept.as_deref().filter(|_| !refresh).and_then(|kept| trove_files::read_regular(kept, largest()).ok());
    // A damaged cache is made anew.
    if known.is_some_and(|bytes| settled(&bytes, file).is_ok()) {
        return Ok(());
    }
    let bytes = server.fetch(&query)?;
    let from = || format!("the reply of {} for {extent}", server.endpoint());
    settled(&bytes, file).with_context(from)?;
    if let Some(kept) = kept {
        let keep =
            || std::fs::create_dir_all(cache.unwrap_or(Path::new(""))).and_then(|()| write_atomically(&kept, &bytes));
        if let Err(error) = keep() {
            tracing::debug!("{}: not kept: {error}", kept.display());
        }
    }
    Ok(())
}

/// The files of so many boxes.
fn names(out: &Path, count: usize) -> Vec<PathBuf> {
    if count == 1 {
        return vec![out.to_owned()];
    }
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    let ending = out.extension().map(|ending| format!(".{}", ending.to_string_lossy())).unwrap_or_default();
    (1..=count).map(|i| out.with_file_name(format!("{stem}-{i}{ending}"))).collect()
}

/// A file's path as the recipe would have it: from its own folder where it lies below.
fn told(recipe: &Recipe, file: &Path) -> String {
    let folder = if recipe.folder.as_os_str().is_empty() { Path::new(".") } else { &recipe.folder };
    let whole = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let (folder, file) = (whole(folder), whole(file));
    file.strip_prefix(&folder).unwrap_or(&file).to_string_lossy().replace('\\', "/")
}

#[cfg(test)]
mod tests;

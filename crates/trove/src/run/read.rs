//! What a scene was recorded as: the same for all its variations, so it is looked at once, for the first one that needs it.

use std::cell::OnceCell;

use anyhow::{Result, bail, ensure};
use trove_build::{ALL_CAMERAS, Timeline};
use trove_format::SiteFile;
use trove_model::{Drive, Report, StreetMap};
use trove_read::rig;

use crate::contents::Contents;
use crate::recipe::{Recipe, nearest};
use crate::sources::Sources;

/// A scene as it was recorded.
pub(super) struct Read<'a> {
    scene: &'a str,
    recording: OnceCell<Option<String>>,
    drive: OnceCell<(Timeline, Option<StreetMap>, Report)>,
}

impl<'a> Read<'a> {
    /// Nothing is read yet.
    pub(super) fn new(scene: &'a str) -> Self {
        Self { scene, recording: OnceCell::new(), drive: OnceCell::new() }
    }

    /// SHA-256 of the files that this scene alone is read from; `None` where there are none.
    pub(super) fn recording(&self, sources: &Sources, contents: &mut Contents) -> Result<&Option<String>> {
        once(&self.recording, || sources.recording(self.scene, contents))
    }

    /// An error where this scene was recorded otherwise when frames were made of it.
    pub(super) fn refuse_another(&self, known: &SiteFile, sources: &Sources, contents: &mut Contents) -> Result<()> {
        ensure!(
            &known.recording == self.recording(sources, contents)?,
            "{}: its recorded files have changed since its first frames were made; choose another --out",
            self.scene
        );
        Ok(())
    }

    /// The drive with all its moments, the map around it, and what was reported of both.
    pub(super) fn drive(&self, sources: &Sources) -> Result<&(Timeline, Option<StreetMap>, Report)> {
        once(&self.drive, || {
            let report = Report::default();
            let (drive, map) = sources.drive(self.scene, &report)?;
            check_cameras(sources.recipe(), &drive.recorded)?;
            Ok((drive, map, report))
        })
    }
}

/// What is in a cell, made where it is empty.
fn once<T>(cell: &OnceCell<T>, make: impl FnOnce() -> Result<T>) -> Result<&T> {
    if let Some(made) = cell.get() {
        return Ok(made);
    }
    let made = make()?;
    Ok(cell.get_or_init(|| made))
}

/// The cameras that the recipe names are cameras of the drive.
fn check_cameras(recipe: &Recipe, drive: &Drive) -> Result<()> {
    let in_views = recipe.camera_names().unwrap_or_default().into_iter().map(|name| ("views.rig", name));
    let with_lens = recipe.camera.lens.keys().filter(|name| *name != ALL_CAMERAS);
    for (key, name) in in_views.chain(with_lens.map(|name| ("camera.lens", name.clone()))) {
        if drive.rig.iter().all(|camera| camera.name != name) {
            let known: Vec<&str> = drive.rig.iter().map(|camera| camera.name.as_str()).collect();
            let others: Vec<&str> = rig::presets().filter(|_| key == "views.rig").collect();
            let hint = nearest(&name, &[&known[..], &others].concat());
            let or = if others.is_empty() {
                String::new()
            } else {
                format!(", a preset ({}) or a .toml file", others.join(", "))
            };
            bail!("{key}: expected cameras among {}{or}, found {name}{hint}", known.join(", "));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demo;

    #[test]
    fn a_scenes_files_are_listed_and_hashed_once_and_its_drive_is_read_once() {
        let folder = tempfile::tempdir().unwrap();
        let recipe = demo::recipe(folder.path()).unwrap();
        let sources = Sources::open(&recipe, &Report::default()).unwrap();
        let mut contents = Contents::open();
        let read = Read::new("demo-0001");
        let hash = read.recording(&sources, &mut contents).unwrap().clone();
        assert!(hash.is_some());
        let keyframes = read.drive(&sources).unwrap().0.recorded.keyframes.len();
        // Whoever looks again finds none of it.
        std::fs::remove_dir_all(folder.path()).unwrap();
        assert_eq!(read.recording(&sources, &mut contents).unwrap(), &hash);
        assert_eq!(read.drive(&sources).unwrap().0.recorded.keyframes.len(), keyframes);
        let again = Read::new("demo-0001");
        assert!(again.recording(&sources, &mut contents).is_err() && again.drive(&sources).is_err());
    }
}

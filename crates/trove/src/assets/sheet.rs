//! `trove assets sheet`: every model and material on one page.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, ensure};
use clap::Args;
use trove_files::OutputRoot;
use trove_model::{Asset, AssetLibrary, Environment, Raster};
use trove_read::environment;
use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};
use trove_write::{write_atomically, write_picture, write_sheet};

use super::page;
use super::studio::Studio;
use crate::progress::Progress;
use crate::watch::Watch;

/// What to draw, and how.
#[derive(Args)]
pub(crate) struct Sheet {
    /// PNG to write; or, where it ends in .html, a page that can be searched.
    #[arg(long, value_name = "FILE", required_unless_present = "each")]
    out: Option<PathBuf>,
    /// Also (or only) write one picture per item to this folder.
    #[arg(long, value_name = "DIR")]
    each: Option<PathBuf>,
    /// Folder with a library.toml or plans.toml [default: the built-in library].
    #[arg(long, value_name = "DIR")]
    library: Option<PathBuf>,
    /// Draw only ids with this prefix; may be given several times.
    #[arg(long, value_name = "ID")]
    only: Vec<String>,
    /// Size of each picture in pixels.
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "320x240")]
    size: [u32; 2],
    /// Samples per pixel.
    #[arg(long, default_value_t = 16)]
    spp: u32,
    /// Seed for paint, wear and load.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Degrees to turn models to the left, from a view of their front.
    #[arg(long, default_value_t = 35.0, allow_hyphen_values = true)]
    turn_deg: f64,
    /// Sky to render under, .hdr or .exr [default: a clear afternoon].
    #[arg(long, visible_alias = "hdri", value_name = "FILE")]
    environment: Option<PathBuf>,
}

impl Sheet {
    /// The folder to draw.
    pub(crate) fn library(&self) -> Option<&Path> {
        self.library.as_deref()
    }

    pub(crate) fn run(&self, library: &AssetLibrary, search: Vec<PathBuf>) -> Result<()> {
        let environment = match &self.environment {
            Some(path) => Some(Environment::Map(Arc::new(environment::read(path)?))),
            None => None,
        };
        let studio =
            Studio { size_px: self.size, spp: self.spp, seed: self.seed, turn_deg: self.turn_deg, environment };
        let renderer = Renderer::new(&RendererOptions {
            kernel: KernelChoice::Auto,
            denoise: Denoising::Best,
            threads: 0,
            search,
            ..RendererOptions::default()
        })?;
        let each = self.each.as_deref().map(OutputRoot::new);
        let subjects = self.chosen(library);
        ensure!(
            !subjects.is_empty(),
            "--only: no model or material has an id that begins with {}",
            self.only.join(" or ")
        );
        let progress = Progress::new(subjects.len(), &Watch::default());
        let mut drawn = Vec::new();
        for subject in subjects {
            let (id, (scene, shot)) = (subject.id(), studio.set(library, subject));
            let prepared = renderer.prepare(&scene).with_context(|| id.to_owned())?;
            let picture: Raster<[u8; 3]> = renderer
                .render(&prepared, &shot, true, &|share| {
                    progress.within(share);
                    false
                })
                .and_then(|capture| capture.color)
                .with_context(|| id.to_owned())?
                .srgb;
            if let Some(folder) = &each {
                let path = folder.at(&format!("{id}.png"))?;
                let parent = path.parent().context("below the folder")?;
                std::fs::create_dir_all(parent)
                    .with_context(|| format!("{}: expected a folder that can be created", parent.display()))?;
                write_picture(&path, &picture)?;
            }
            drawn.push((subject, picture));
            progress.frame_done();
        }
        progress.finish();
        if let Some(path) = &self.out {
            let count = drawn.len();
            if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("html")) {
                write_atomically(path, page::html(drawn)?.as_bytes())?;
            } else {
                let named = drawn.into_iter().map(|(subject, picture)| (subject.id().to_owned(), picture));
                write_sheet(path, &named.collect::<Vec<_>>())?;
            }
            println!("{}: {count} images", path.display());
        }
        Ok(())
    }

    /// Models, then materials; of a person one posture, unless some are asked for.
    fn chosen<'a>(&self, library: &'a AssetLibrary) -> Vec<super::studio::Subject<'a>> {
        use super::studio::Subject::{Model, Sample};
        let wanted = |id: &str| self.only.is_empty() || self.only.iter().any(|only| id.starts_with(only.as_str()));
        let mut people = BTreeSet::new();
        let mut is_new = |a: &&Asset| {
            let person = a.figure.as_ref().map(|figure| &figure.person);
            !self.only.is_empty() || person.is_none_or(|person| people.insert(person.clone()))
        };
        let models = library.assets.iter().filter(|a| wanted(&a.id) && is_new(a)).map(Model);
        models.chain(library.surfaces.iter().filter(|s| wanted(&s.id)).map(Sample)).collect()
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides: Option<Vec<u32>> =
        text.split('x').map(|side| side.parse().ok().filter(|s| (16..=8192).contains(s))).collect();
    match sides.as_deref() {
        Some(&[width, height]) => Ok([width, height]),
        _ => Err("expected width and height of 16 to 8192 pixels, such as 800x600".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_is_two_sides() {
        assert_eq!(size("800x600"), Ok([800, 600]));
        assert!(size("800").is_err() && size("0x10").is_err() && size("axb").is_err());
    }
}

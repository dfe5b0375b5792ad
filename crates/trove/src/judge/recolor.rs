//! `trove recolor`: pictures in the colours of others, and as sharp.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use serde_json::json;
use trove_judge::recolor::{Measures, Method, Recoloring, Settings, Space, recolor, report};
use trove_model::Raster;
use trove_write::{write_atomically, write_sheet};

use super::share;
use crate::answer::Answer;
use crate::class_maps::ClassMapChoice;
use crate::progress::Steps;
use crate::watch::Watch;

/// Pairs that the sheet shows.
const SHOWN: usize = 24;
/// Width of a picture on it, pixels.
const WIDTH_PX: u32 = 400;

/// What to recolour, and how.
#[derive(Args)]
pub(crate) struct Recolor {
    /// Output folder of `trove generate`, or any folder of images.
    dir: PathBuf,
    /// Images with the colours to match.
    #[arg(long, value_name = "IMAGES")]
    to: PathBuf,
    /// Output folder; images keep their relative paths [default: DIR-recolored].
    #[arg(long)]
    out: Option<PathBuf>,
    /// What to match: mean and deviation of the whole set, of each image, of each image paired with one of IMAGES, or
    /// histograms class by class.
    #[arg(long, value_enum, default_value = "set")]
    method: MethodName,
    /// Colour space to work in.
    #[arg(long, value_enum, default_value = "lab")]
    space: SpaceName,
    /// Strength, from 0 (no change) to 1 (full match).
    #[arg(long, default_value_t = 0.75, value_parser = share_f32)]
    strength: f32,
    /// Match sharpness too: how strong fine detail is beside coarser detail.
    #[arg(long)]
    detail: bool,
    /// Labels of IMAGES under the same names, for `--method classes`, and for classes on the page.
    #[arg(long, value_name = "LABELS", required_if_eq("method", "classes"))]
    to_labels: Option<PathBuf>,
    /// Class map of LABELS, a name or a FILE.toml (docs/judge.md); our own classes are mapped to it.
    #[arg(long, default_value = "trove20", value_name = "MAP")]
    to_classes: ClassMapChoice,
    /// HTML page to write: images before and after, mean colours by class, histograms.
    #[arg(long, value_name = "FILE.html")]
    page: Option<PathBuf>,
    /// Print a summary as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum MethodName {
    Picture,
    Paired,
    Set,
    Classes,
}

#[derive(Clone, Copy, ValueEnum)]
enum SpaceName {
    Lab,
    LAlphaBeta,
}

impl Recolor {
    pub(crate) fn run(&self, watch: &Watch) -> Result<Answer> {
        let out = match &self.out {
            Some(out) => out.clone(),
            None => {
                let whole = std::path::absolute(&self.dir)?;
                let name = whole.file_name().context("DIR: expected a folder with a name; name another with --out")?;
                whole.with_file_name(format!("{}-recolored", name.to_string_lossy()))
            }
        };
        let settings = Settings {
            method: match self.method {
                MethodName::Picture => Method::PerPicture,
                MethodName::Paired => Method::Paired,
                MethodName::Set => Method::PerSet,
                MethodName::Classes => Method::HistogramPerClass,
            },
            space: match self.space {
                SpaceName::Lab => Space::Lab,
                SpaceName::LAlphaBeta => Space::LAlphaBeta,
            },
            strength: self.strength,
            detail: self.detail,
            target_labels: match &self.to_labels {
                Some(labels) => Some((labels.clone(), self.to_classes.read()?)),
                None => None,
            },
        };
        let progress = Steps::new(watch);
        let done = recolor(&self.dir, &self.to, &out, &settings, &|done, total| progress.done(done, total))?;
        let sheet = out.join("before_after.png");
        write_sheet(&sheet, &self.pairs(&done)?)?;
        if let Some(page) = &self.page {
            write_atomically(page, report(&self.dir, &self.to, &settings, &done)?.as_bytes())?;
        }
        let told = |m: &Measures| {
            let sharpness = m.detail.sharpness();
            json!({ "mean": m.colors.mean(), "deviation": m.colors.deviation(), "sharpness": sharpness })
        };
        let [before, target, after] = &done.measures;
        let json = json!({
            "out": out.to_string_lossy(),
            "pictures": done.pictures.len(),
            "kept": done.kept,
            "before": told(before),
            "target": told(target),
            "after": told(after),
            "page": sheet.to_string_lossy(),
        });
        let shown = self.page.clone().unwrap_or(sheet);
        Ok(Answer::new(self.json, json, move || {
            let new = done.pictures.len() - done.kept;
            println!(
                "{} images, {new} of them new; means and deviations of the three channels, and sharpness:",
                done.pictures.len()
            );
            for (name, Measures { colors, detail }) in ["before", "target", "after"].iter().zip(&done.measures) {
                let sharpness = detail.sharpness().unwrap_or_default();
                println!("  {name:7} {:8.2?} ± {:6.2?}  {sharpness:4.2?}", colors.mean(), colors.deviation());
            }
            println!("see {}", shown.display());
        }))
    }

    /// Some pictures before and after, side by side.
    fn pairs(&self, done: &Recoloring) -> Result<Vec<(String, Raster<[u8; 3]>)>> {
        let step = done.pictures.len().div_ceil(SHOWN).max(1);
        let mut pairs = Vec::new();
        for (after, before) in done.pictures.iter().step_by(step) {
            let name = before.strip_prefix(&self.dir).unwrap_or(before).with_extension("");
            let sides = [before, after].map(|path| trove_judge::thumbnail(path, WIDTH_PX));
            let [before, after] = [sides[0].as_ref(), sides[1].as_ref()];
            let (Ok(before), Ok(after)) = (before, after) else { continue };
            let both = Raster::from_fn(2 * WIDTH_PX, before.height.min(after.height), |x, y| {
                if x < WIDTH_PX { *before.at(x, y) } else { *after.at(x - WIDTH_PX, y) }
            });
            pairs.push((name.to_string_lossy().into_owned(), both));
        }
        Ok(pairs)
    }
}

fn share_f32(text: &str) -> Result<f32, String> {
    share(text).map(|share| share as f32)
}

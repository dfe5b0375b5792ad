//! `trove curate`: which frames are worth training on.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use serde_json::json;
use trove_format::Curated;
use trove_judge::curate::{Curation, Rules, Split, curate, report};
use trove_model::{CLASSES, Seed};
use trove_write::write_atomically;

use super::share;
use super::weights::read_weights;
use crate::answer::Answer;
use crate::class_maps::ClassMapChoice;
use crate::progress::Steps;
use crate::watch::Watch;

/// What to select from, and how.
#[derive(Args)]
pub(crate) struct Curate {
    /// Output folder of `trove generate`; labels alone (`--labels-only`) are enough.
    dir: PathBuf,
    /// Number of frames to keep.
    #[arg(long, default_value_t = 5000)]
    count: usize,
    /// Class map whose classes count, a name or a FILE.toml (docs/judge.md); classes that it ignores add nothing.
    #[arg(long, default_value = "trove20", value_name = "MAP")]
    classes: ClassMapChoice,
    /// What each class is worth, TOML of `class = weight` as `python -m trove.train.doubt` writes it; others weigh 1.
    #[arg(long, value_name = "FILE.toml")]
    weights: Option<PathBuf>,
    /// Minimum number of classes in a frame.
    #[arg(long, default_value_t = 6)]
    min_classes: usize,
    /// Frames whose 64-bit perceptual hashes differ by at most this many bits are near-duplicates.
    #[arg(long, default_value_t = 2)]
    duplicate_bits: u32,
    /// Share of the kept frames for validation; no place is in both splits.
    #[arg(long, default_value_t = 0.1, value_parser = share)]
    val_share: f64,
    /// Seed for drawing the validation places.
    #[arg(long, default_value_t = 7)]
    seed: u64,
    /// List to write [default: DIR/curated.json].
    #[arg(long, value_name = "FILE.json")]
    out: Option<PathBuf>,
    /// HTML report to write [default: DIR/curated.html].
    #[arg(long, value_name = "FILE.html")]
    page: Option<PathBuf>,
    /// Print a summary as JSON.
    #[arg(long)]
    json: bool,
}

/// The frames of a list that trove curate wrote.
pub(crate) fn frames_of(list: &Path) -> Result<BTreeSet<String>> {
    let Curated { train, val, .. } = Curated::read(list)?;
    Ok(train.into_iter().chain(val).collect())
}

fn list_of(curation: &Curation) -> Curated {
    let of = |wanted: Split| {
        let kept = curation.selection.kept.iter().zip(&curation.splits);
        kept.filter(|(_, split)| **split == wanted).map(|(i, _)| curation.frames[*i].path.clone()).collect()
    };
    Curated { train: of(Split::Train), val: of(Split::Val), gap: of(Split::Gap) }
}

impl Curate {
    pub(crate) fn run(&self, watch: &Watch) -> Result<Answer> {
        let map = self.classes.read()?;
        let rules = Rules {
            count: self.count,
            classes: map.train_ids_of_ours(),
            weights: self.weights.as_deref().map_or(Ok([1.0; 20]), |path| read_weights(path, &map))?,
            min_classes: self.min_classes,
            duplicate_bits: self.duplicate_bits,
        };
        let progress = Steps::new(watch);
        let seed = Seed(self.seed);
        let curation = curate(&self.dir, rules, self.val_share, seed, &|done, total| progress.done(done, total))?;
        let list = list_of(&curation);
        let out = self.out.clone().unwrap_or_else(|| self.dir.join(Curated::NAME));
        let page = self.page.clone().unwrap_or_else(|| self.dir.join("curated.html"));
        write_atomically(&out, &list.to_json())?;
        write_atomically(&page, report(&self.dir, &curation)?.as_bytes())?;
        let selection = &curation.selection;
        let shares = |kept: bool| -> serde_json::Map<String, serde_json::Value> {
            let shares = curation.shares(kept);
            CLASSES.iter().zip(shares).map(|(row, share)| (row.name.to_owned(), json!(share))).collect()
        };
        let json = json!({
            "frames": curation.frames.len(),
            "kept": selection.kept.len(),
            "train": list.train.len(),
            "val": list.val.len(),
            "gap": list.gap.len(),
            "too_few_classes": selection.poor,
            "near_duplicates": selection.duplicates,
            "shares_before": shares(false),
            "shares_after": shares(true),
            "list": out.to_string_lossy(),
            "page": page.to_string_lossy(),
        });
        let min_classes = self.min_classes;
        Ok(Answer::new(self.json, json, move || {
            let selection = &curation.selection;
            println!(
                "{} of {} frames kept: {} for training, {} for validation, {} between both; {} have fewer than {} classes, \
                 {} are near-duplicates",
                selection.kept.len(),
                curation.frames.len(),
                list.train.len(),
                list.val.len(),
                list.gap.len(),
                selection.poor,
                min_classes,
                selection.duplicates,
            );
            println!(
                "see {}; trove generate RECIPE --out DIR --frames {} renders only these",
                page.display(),
                out.display()
            );
        }))
    }
}

//! `trove generate --dry-run`: how much a recipe will take, from a few frames of one moment.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use trove_format::{FrameRow, Manifest, RunReport, SiteFile};
use trove_model::Report;

use super::portions::{Portion, portions};
use super::{RenderedFrame, RunOptions, Share, Summary, generate, scenes};
use crate::recipe::Recipe;
use crate::sources::Sources;

/// Of the recorded resolution, at most, where light is followed; labels alone are cheap, and not in proportion to pixels.
const TRIAL_SCALE: f64 = 0.25;
/// Of a picture whose size is told, pixels at most, likewise.
const TRIAL_PX: f64 = 90_000.0;
/// Pictures on a contact sheet.
const SHEET_FRAMES: f64 = 24.0;
/// How a file grows with the pixels, as a power of them, by the end of its name: outlines grow with the side, noise and
/// slopes with the area, tables hardly. Means of two cameras of scene-0103 between 400×225 and 1600×900.
const GROWTH: [(&str, f64); 5] =
    [("rgb.png", 0.93), ("normal.exr", 0.73), (".png", 0.73), (".exr", 0.93), (".json", 0.06)];

/// What a recipe will take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Frames, sweeps, cycles and grids.
    pub frames: u64,
    /// Of the files, those in `.trove` left out.
    pub bytes: u64,
    /// On this machine, or of all machines together.
    pub seconds: f64,
    /// Until the last of so many machines like this one has ended; `None` where they were not asked for.
    pub last_machine_s: Option<f64>,
}

/// What a run costs, as one trial has told.
struct Costs {
    setup_s: f64,
    variation_s: f64,
    moment_s: f64,
    frame_s: f64,
    base_bytes: f64,
    /// Of the contact sheet, a picture.
    sheet_bytes: f64,
    /// Of the frames, those that are pictures.
    pictures: f64,
    variation_bytes: f64,
    frame_bytes: f64,
    /// Frames a moment.
    a_moment: f64,
    /// Frames of the variation that was tried by those that it was thought to have.
    correction: f64,
}

/// Renders frames of one moment in the temporary folder, small ones where light is followed, and says what the recipe, or
/// a share of it, will take: on this machine, and on so many like it.
///
/// # Errors
/// As [`generate`].
pub fn estimate(recipe: &Recipe, options: &RunOptions, machines: Option<u32>) -> Result<Estimate> {
    let folder = TrialFolder::new()?;
    let (small, ratio) = shrunk(recipe);
    let trial_options = RunOptions {
        recipe_file: None,
        kernel: options.kernel,
        device: options.device,
        search: options.search.clone(),
        frames: options.frames.clone(),
        share: None,
        adopt: Vec::new(),
        trial: true,
        watch: options.watch.clone(),
    };
    let summary = generate(&small, &folder.0, &trial_options)?;
    ensure!(!summary.interrupted, "ended before the trial frame was made");
    let report = Report::default();
    let sources = Sources::open(recipe, &report)?;
    let scenes = scenes(&sources, &report)?;
    let of_share = |share| portions(recipe, &scenes, options.frames.as_ref(), share);
    let costs = Costs::of(&summary, &folder.0, ratio, &scenes, &of_share(None), options.frames.is_some())?;
    let seconds_of = |share| costs.of_portions(&of_share(share)).2;
    let (frames, bytes, seconds) = costs.of_portions(&of_share(options.share));
    let last_machine_s = machines.map(|of| Share::all(of).map(|share| seconds_of(Some(share))).fold(0.0, f64::max));
    Ok(Estimate { frames: frames as u64, bytes: bytes as u64, seconds, last_machine_s })
}

impl Costs {
    fn of(
        summary: &Summary,
        folder: &Path,
        ratio: f64,
        scenes: &[(String, usize)],
        portions: &[Vec<Option<Portion>>],
        are_listed: bool,
    ) -> Result<Self> {
        let first = summary.rendered.first().context("the trial made no frame")?;
        let mut parts = first.path.split('/');
        let (scene, variation) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
        let site_folder = folder.join(scene).join(variation);
        let site = SiteFile::read(&site_folder)?.context("the trial built no scene")?;
        let manifest = Manifest::read(folder)?.context("the trial has no manifest")?;
        let threads = summary.timings.threads.max(1) as f64;
        let kinds = [
            (&site.frames, &manifest.frames, ratio),
            (&site.sweeps, &manifest.sweeps, 1.0),
            (&site.radars, &manifest.radars, 1.0),
            (&site.grids, &manifest.grids, 1.0),
        ];
        let (mut count, mut seconds, mut bytes, mut row_bytes) = (0.0, 0.0, 0.0, 0.0);
        for (planned, rows, ratio) in kinds {
            // Each that was tried stands for as many.
            let times = planned.len() as f64 / rows.len().max(1) as f64;
            for row in rows {
                let made = |frame: &&RenderedFrame| frame.path == row.path;
                let rendered = summary.rendered.iter().find(made).context("the trial has no times")?;
                let writing_s = summary.timings.writing_s.get(&row.path).copied().unwrap_or_default();
                count += times;
                seconds += times * ratio * (rendered.render_s + writing_s / threads);
                bytes += times * frame_bytes(&folder.join(&row.path), row, ratio)?;
                // Rows of the manifest are indented twice.
                let text = serde_json::to_string_pretty(row)?;
                let written = (text.len() + 4 * text.lines().count()) as f64;
                row_bytes += written;
                bytes += times * written;
            }
        }
        let planned = [&site.frames, &site.sweeps, &site.radars, &site.grids];
        let moments: BTreeSet<u32> = planned.into_iter().flatten().map(|(moment, _)| *moment).collect();
        let place = scenes.iter().position(|(name, _)| name == scene);
        let hint = place.and_then(|place| portions[place].iter().flatten().next()).map_or(1, |portion| portion.of_hint);
        let size = |name: &str| Ok::<f64, anyhow::Error>(std::fs::metadata(folder.join(name))?.len() as f64);
        let [cold_s, warm_s] = summary.timings.preparing_s;
        Ok(Self {
            setup_s: summary.timings.setup_s,
            variation_s: summary.timings.building_s + (cold_s - warm_s / threads).max(0.0),
            moment_s: warm_s / threads,
            frame_s: seconds / count,
            base_bytes: size(Manifest::NAME)? - row_bytes + size(RunReport::NAME)?,
            sheet_bytes: size("contact_sheet.png")? / manifest.frames.len().max(1) as f64,
            pictures: site.frames.len() as f64 / count,
            variation_bytes: folder_bytes(&site_folder)?,
            frame_bytes: bytes / count,
            a_moment: count / moments.len().max(1) as f64,
            // A list of frames is exact.
            correction: if are_listed { 1.0 } else { count / hint.max(1) as f64 },
        })
    }

    /// Frames, bytes and seconds.
    fn of_portions(&self, portions: &[Vec<Option<Portion>>]) -> (f64, f64, f64) {
        let (mut frames, mut variations) = (0.0, 0.0);
        for portion in portions.iter().flatten().flatten() {
            frames += (portion.frames_hint as f64 * self.correction).round();
            variations += 1.0;
        }
        let bytes = self.base_bytes
            + (frames * self.pictures).min(SHEET_FRAMES) * self.sheet_bytes
            + variations * self.variation_bytes
            + frames * self.frame_bytes;
        let moments = frames / self.a_moment;
        let seconds = self.setup_s + variations * self.variation_s + moments * self.moment_s + frames * self.frame_s;
        (frames, bytes, seconds)
    }
}

/// The recipe with small pictures, where light is followed, and how many pixels there are for one of theirs.
fn shrunk(recipe: &Recipe) -> (Recipe, f64) {
    let mut small = recipe.clone();
    small.output.formats.clear();
    if !recipe.follows_light() {
        return (small, 1.0);
    }
    let ratio = match recipe.render.size {
        Some([width, height]) => {
            let factor = (TRIAL_PX / (f64::from(width) * f64::from(height))).sqrt().min(1.0);
            let [w, h] = [width, height].map(|side| ((f64::from(side) * factor).round() as u32).max(1));
            small.render.size = Some([w, h]);
            f64::from(width) * f64::from(height) / (f64::from(w) * f64::from(h))
        }
        None => {
            let scale = recipe.render.scale.unwrap_or(1.0);
            small.render.scale = Some(scale.min(TRIAL_SCALE));
            (scale / scale.min(TRIAL_SCALE)).powi(2)
        }
    };
    (small, ratio)
}

/// What a frame's files take with so many times the pixels.
fn frame_bytes(folder: &Path, row: &FrameRow, ratio: f64) -> Result<f64> {
    let grown = |name: &String| {
        let power = GROWTH.iter().find(|(end, _)| name.ends_with(end)).map_or(1.0, |(_, power)| *power);
        Ok(std::fs::metadata(folder.join(name))?.len() as f64 * ratio.powf(power))
    };
    row.files.keys().map(grown).sum()
}

/// What the files of a folder itself take.
fn folder_bytes(folder: &Path) -> Result<f64> {
    let found = std::fs::read_dir(folder)?.flatten().filter_map(|entry| entry.metadata().ok());
    Ok(found.filter(|found| found.is_file()).map(|found| found.len() as f64).sum())
}

/// A folder that goes with it.
struct TrialFolder(PathBuf);

impl TrialFolder {
    fn new() -> Result<Self> {
        let folder = std::env::temp_dir().join(format!("trove-trial-{}", std::process::id()));
        std::fs::create_dir(&folder)
            .with_context(|| format!("{}: expected a folder that can be made", folder.display()))?;
        Ok(Self(folder))
    }
}

impl Drop for TrialFolder {
    fn drop(&mut self) {
        // What is left lies in the temporary folder.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

//! The command line.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Result;
use clap::{Args, Parser, Subcommand, ValueEnum};
use serde_json::json;
use tracing::Level;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;
use trove_render::{DeviceChoice, KernelChoice};

use crate::answer::Answer;
use crate::assets::{self, AssetsCommand};
use crate::drives::DatasetChoice;
use crate::export::Export;
use crate::judge::audit::LabelOptions;
use crate::judge::curate::{Curate, frames_of};
use crate::judge::evaluate::Evaluate;
use crate::judge::recolor::Recolor;
use crate::map::MapCommand;
use crate::overview::Overview;
use crate::progress::duration;
use crate::recipe::{MOST_THREADS, Recipe};
use crate::run::{Estimate, MOST_SHARES, RenderedFrame, RunOptions, Share, Summary, begun_with, estimate, generate};
use crate::view::View;
use crate::watch::Watch;
use crate::{build, demo, doctor, inspect, interrupt, libraries, message, status, verify};

/// Turn recordings of real roads into photorealistic virtual scenes with perfect labels.
#[derive(Parser)]
#[command(name = "trove", version, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run the whole pipeline on a built-in drive: six annotated cameras and a contact sheet.
    #[command(after_help = "Example:\n  trove demo --out demo-out")]
    Demo {
        /// Output folder; a demo already there is resumed.
        #[arg(long, default_value = "demo-out")]
        out: PathBuf,
        #[command(flatten)]
        machine: Machine,
        /// Print a summary as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Check this machine and explain how to install what is missing.
    #[command(after_help = "Example:\n  trove doctor --json")]
    Doctor {
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// List the drives in a dataset: place, keyframes, cameras, boxes by class, LiDAR, map.
    #[command(after_help = "Example:\n  trove inspect data/nuscenes --dataset nuscenes\n  trove inspect my-rig.toml")]
    Inspect {
        /// The dataset's root folder; or a rig: its TOML file, or the name of a preset.
        root: PathBuf,
        #[command(flatten)]
        dataset: DatasetChoice,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Write finished frames as another dataset (KITTI …), or the drives of a dataset in the plain form.
    #[command(
        after_help = "Example:\n  trove export out/boston --format kitti --out out/kitti\n  trove export data/nuscenes --format trove --out out/plain --scene scene-0103 --lidar"
    )]
    Export(Export),
    /// Build the virtual scene only and write it as binary glTF 2.0, with a report.
    #[command(after_help = "Example:\n  trove build recipe.toml --out scene.glb --keyframe 10")]
    Build {
        /// Recipe (TOML).
        recipe: PathBuf,
        /// The .glb file to write.
        #[arg(long)]
        out: PathBuf,
        /// Keyframe, or with time.rate_hz moment, whose road users are placed [default: the recipe's first].
        #[arg(long)]
        keyframe: Option<usize>,
        /// Also write the sky as a latitude-longitude .exr file, without the sun, which is in the .glb.
        #[arg(long)]
        environment: Option<PathBuf>,
        #[command(flatten)]
        overview: Overview,
        /// Print the report as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Fetch the street map that a recipe's drives or place need, by the Overpass API.
    #[command(
        after_help = "Example:\n  trove map recipe.toml --dry-run\n  trove map recipe.toml --out data/osm/boston.osm"
    )]
    Map(MapCommand),
    /// List, import, check or draw the models and materials to build with.
    #[command(after_help = "Example:\n  trove assets sheet --out sheet.png")]
    Assets {
        #[command(subcommand)]
        command: AssetsCommand,
    },
    /// Check that an output folder still holds what was written to it, or what a dataset's labels say.
    #[command(
        after_help = "Examples:\n  trove verify out/boston\n  trove verify out/boston --labels --page faults.html\n  trove verify cityscapes --labels --json"
    )]
    Verify {
        /// The output folder of trove generate; with --labels also a folder of Cityscapes, KITTI, COCO, nuScenes or CamVid.
        folder: PathBuf,
        #[command(flatten)]
        labels: LabelOptions,
        /// HTML page to write: what was checked, what is wrong, and with --labels the images that show it.
        #[arg(long, value_name = "FILE.html")]
        page: Option<PathBuf>,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Write one page that shows a finished folder, or a recipe's scene: shapes, boxes, tracks, cameras, images with labels.
    #[command(
        after_help = "Examples:\n  trove view out/boston --out boston.html\n  trove view recipe.toml --out scene.html"
    )]
    View(View),
    /// Select the frames most worth training on, from labels alone.
    #[command(
        after_help = "Example:\n  trove generate recipe.toml --labels-only --out out/labels\n  trove curate out/labels --count 600\n  trove generate recipe.toml --out out/chosen --frames out/labels/curated.json"
    )]
    Curate(Curate),
    /// Match the colours of images to real footage.
    #[command(after_help = "Example:\n  trove recolor out/boston --to camvid/images/train --out out/boston-recolored")]
    Recolor(Recolor),
    /// Score predicted labels against ground truth: IoU, accuracy, boundary IoU, panoptic quality, with intervals.
    #[command(
        after_help = "Examples:\n  trove evaluate predictions out\n  trove evaluate predictions labels --classes cityscapes --boundary --json"
    )]
    Evaluate(Evaluate),
    /// Generate a dataset. Rerun to resume; finished frames are kept.
    #[command(
        after_help = "Examples:\n  trove generate recipe.toml --out out/boston\n  trove generate recipe.toml --part 3/8 --out out/boston   # on the third of eight machines\n  trove generate recipe.toml --out out/boston              # once all have ended\n  trove generate recipe.toml --dry-run --machines 8"
    )]
    Generate {
        /// Recipe (TOML).
        recipe: PathBuf,
        /// Output folder.
        #[arg(long, required_unless_present = "dry_run")]
        out: Option<PathBuf>,
        /// Tell how many frames the recipe has, how many bytes they will take and how long, after frames of one moment.
        #[arg(long, conflicts_with = "out")]
        dry_run: bool,
        /// With --dry-run: also when the last of so many machines like this one will have ended.
        #[arg(long, value_name = "N", requires = "dry_run", value_parser = clap::value_parser!(u32).range(1..=MOST_SHARES))]
        machines: Option<u32>,
        /// Render the I-th of N shares of the frames, from 1, in a folder that all may have in common; a run without it
        /// merges them.
        #[arg(long, value_name = "I/N")]
        part: Option<Share>,
        #[command(flatten)]
        extent: Extent,
        #[command(flatten)]
        machine: Machine,
        /// Print a summary as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Merge folders that parts of a recipe were rendered in, and render what is missing.
    #[command(after_help = "Example:\n  trove merge part-1 part-2 part-3 --recipe recipe.toml --out out/boston")]
    Merge {
        /// Output folders of trove generate --part, in any order.
        #[arg(required = true, value_name = "DIR")]
        folders: Vec<PathBuf>,
        /// Recipe (TOML) [default: the one that the first folder was begun with, where it still lies there].
        #[arg(long)]
        recipe: Option<PathBuf>,
        /// Output folder; one of them may be it.
        #[arg(long)]
        out: PathBuf,
        #[command(flatten)]
        extent: Extent,
        #[command(flatten)]
        machine: Machine,
        /// Print a summary as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Tell how far a folder is that runs, or parts of one on other machines, are writing to.
    #[command(after_help = "Example:\n  trove status out/boston")]
    Status {
        /// Output folder of trove generate.
        folder: PathBuf,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
}

/// How much of a recipe to make.
#[derive(Args)]
struct Extent {
    /// Render only the frames in a list written by `trove curate`.
    #[arg(long, value_name = "FILE.json")]
    frames: Option<PathBuf>,
    /// Write labels without rendering images, whatever the recipe says: fast, and enough for `trove curate`.
    #[arg(long)]
    labels_only: bool,
}

impl Extent {
    fn read(&self, recipe: &Path) -> Result<(Recipe, Option<BTreeSet<String>>)> {
        let frames = self.frames.as_deref().map(frames_of).transpose()?;
        let mut recipe = Recipe::read(recipe)?;
        if self.labels_only {
            (recipe.render.light, recipe.render.radiance) = (false, false);
        }
        Ok((recipe, frames))
    }
}

/// How to use this machine.
#[derive(Args)]
struct Machine {
    /// Number of threads, overriding the recipe; 0 uses all.
    #[arg(long, value_parser = clap::value_parser!(u16).range(0..=MOST_THREADS))]
    threads: Option<u16>,
    /// Ray-tracing kernel; obvhs is built in and gives the same bytes on every machine.
    #[arg(long, value_enum, default_value = "auto")]
    kernel: Kernel,
    /// Who follows light: cpu, the NVIDIA card cuda:0 (or another number), or auto, the first card that can be used, else
    /// the processor; emulated is what a card runs, on the processor; labels are always the processor's.
    #[arg(long, value_parser = device, default_value = "cpu", value_name = "auto|cpu|cuda:N|emulated")]
    device: DeviceChoice,
}

fn device(text: &str) -> Result<DeviceChoice, String> {
    let number = |text: &str| text.strip_prefix("cuda:")?.parse().ok();
    match text {
        "auto" => Ok(DeviceChoice::Auto),
        "cpu" => Ok(DeviceChoice::Cpu),
        "emulated" => Ok(DeviceChoice::Emulated),
        _ => number(text)
            .map(DeviceChoice::Cuda)
            .ok_or_else(|| "expected auto, cpu, emulated, or cuda:0 or another number".into()),
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum Kernel {
    Auto,
    Embree,
    Obvhs,
}

impl Machine {
    fn options(&self, site_packages: &[PathBuf], watch: &Watch) -> RunOptions {
        let kernel = match self.kernel {
            Kernel::Auto => KernelChoice::Auto,
            Kernel::Embree => KernelChoice::Embree,
            Kernel::Obvhs => KernelChoice::Obvhs,
        };
        RunOptions {
            recipe_file: None,
            kernel,
            device: self.device,
            search: libraries::search(site_packages),
            frames: None,
            share: None,
            adopt: Vec::new(),
            trial: false,
            watch: watch.clone(),
        }
    }
}

/// Runs a command line, `args[0]` being the program's name, and returns the exit status: 0 done, 1 failed, 2 wrong
/// usage, 130 and 143 ended by Ctrl-C and SIGTERM. `site_packages` are the folders in which the calling Python keeps its packages.
pub fn main(args: impl IntoIterator<Item = OsString>, site_packages: &[PathBuf]) -> i32 {
    let cli = match Cli::try_parse_from(args) {
        Ok(cli) => cli,
        Err(error) => {
            let _ = error.print(); // nothing is left to tell it to
            return error.exit_code();
        }
    };
    interrupt::install();
    // A second call in one process (from Python) keeps the first one's subscriber.
    // Requests that an object store's library repeats are told of once it has given up.
    let told = Targets::new().with_default(Level::INFO).with_target("object_store", Level::ERROR);
    let written = tracing_subscriber::fmt().with_writer(std::io::stderr).with_target(false).without_time().finish();
    let _ = written.with(told).try_init();
    match run(cli.command, site_packages, &Watch::default()).and_then(Answer::print) {
        Ok(status) => status,
        Err(error) => {
            eprintln!("error: {}", message::of(&error));
            1
        }
    }
}

/// Runs a command line for another program and returns what it prints with `--json`; `null` of a command that prints by
/// itself. Signals stay the caller's own.
///
/// # Errors
/// The line that the command would end with, of wrong usage and of failure alike.
pub fn call(
    args: impl IntoIterator<Item = OsString>,
    site_packages: &[PathBuf],
    watch: &Watch,
) -> Result<String, String> {
    let cli = Cli::try_parse_from(args).map_err(|error| {
        let text = error.to_string();
        let said = text.split("\n\n").next().unwrap_or_default();
        said.strip_prefix("error: ").unwrap_or(said).to_owned()
    })?;
    let answer = run(cli.command, site_packages, watch).map_err(|error| message::of(&error))?;
    Ok(answer.json.to_string())
}

fn run(command: Command, site_packages: &[PathBuf], watch: &Watch) -> Result<Answer> {
    match command {
        Command::Doctor { json } => doctor::run(libraries::search(site_packages), json).map(|()| Answer::printed(0)),
        Command::Inspect { root, dataset, json } => inspect::run(&root, &dataset, json).map(Answer::printed),
        Command::Export(export) => export.run(watch),
        Command::Build { recipe, out, keyframe, environment, overview, json } => {
            let search = libraries::search(site_packages);
            let recipe = Recipe::read(&recipe)?;
            build::run(&recipe, &out, keyframe, environment.as_deref(), &overview, search, json)
        }
        Command::Map(map) => map.run().map(|()| Answer::printed(0)),
        Command::Assets { command } => assets::run(command, libraries::search(site_packages)).map(Answer::printed),
        Command::Demo { out, machine, json } => {
            let recipe = demo::recipe(&out)?;
            let recipe_file = Some(recipe.folder.join("recipe.toml"));
            let options = RunOptions { recipe_file, ..machine.options(site_packages, watch) };
            produce(recipe, &out, &machine, options, json)
        }
        Command::Generate { recipe, out, dry_run: _, machines, part, extent, machine, json } => {
            let recipe_file = Some(recipe.clone());
            let (recipe, frames) = extent.read(&recipe)?;
            let options = RunOptions { recipe_file, frames, share: part, ..machine.options(site_packages, watch) };
            match out {
                Some(out) => produce(recipe, &out, &machine, options, json),
                None => foretell(recipe, &machine, &options, machines, json),
            }
        }
        Command::Merge { folders, recipe, out, extent, machine, json } => {
            let recipe = recipe.map_or_else(|| begun_with(&folders[0]), Ok)?;
            let recipe_file = Some(recipe.clone());
            let (recipe, frames) = extent.read(&recipe)?;
            let adopt = folders.into_iter().filter(|folder| !is_same(folder, &out)).collect();
            let options = RunOptions { recipe_file, frames, adopt, ..machine.options(site_packages, watch) };
            produce(recipe, &out, &machine, options, json)
        }
        Command::Status { folder, json } => status::run(&folder, json),
        Command::Verify { folder, labels, page, json } if labels.are_wanted() => {
            labels.run(&folder, page.as_deref(), json, watch)
        }
        Command::Verify { folder, labels: _, page, json } => verify::run(&folder, page.as_deref(), json, watch),
        Command::View(view) => view.run(libraries::search(site_packages), watch),
        Command::Curate(curate) => curate.run(watch),
        Command::Recolor(recolor) => recolor.run(watch),
        Command::Evaluate(evaluate) => evaluate.run(watch),
    }
}

/// A recipe for a number of threads, and those that are not the renderer's.
fn threaded(mut recipe: Recipe, machine: &Machine) -> Result<(Recipe, rayon::ThreadPool)> {
    if let Some(threads) = machine.threads {
        recipe.render.threads = threads.into();
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(recipe.render.threads).build()?;
    Ok((recipe, pool))
}

fn foretell(
    recipe: Recipe,
    machine: &Machine,
    options: &RunOptions,
    machines: Option<u32>,
    json: bool,
) -> Result<Answer> {
    options.watch.listen();
    let (recipe, pool) = threaded(recipe, machine)?;
    let Estimate { frames, bytes, seconds, last_machine_s } = pool.install(|| estimate(&recipe, options, machines))?;
    let mut printed = json!({ "frames": frames, "bytes": bytes, "seconds": seconds });
    if let (Some(machines), Some(last_s)) = (machines, last_machine_s) {
        printed["machines"] = json!(machines);
        printed["last_machine_seconds"] = json!(last_s);
    }
    let tell = move || {
        println!("{frames} frames, {:.1} GB, {} on one machine like this", bytes as f64 / 1e9, duration(seconds));
        if let (Some(machines), Some(last_s)) = (machines, last_machine_s) {
            println!("{} on {machines} machines, the last of them", duration(last_s));
        }
    };
    Ok(Answer::new(json, printed, tell))
}

fn produce(recipe: Recipe, out: &Path, machine: &Machine, options: RunOptions, json: bool) -> Result<Answer> {
    options.watch.listen();
    let started = Instant::now();
    let (recipe, pool) = threaded(recipe, machine)?;
    let summary = pool.install(|| generate(&recipe, out, &options))?;
    let seconds = started.elapsed().as_secs_f64();
    let status = if summary.interrupted { interrupt::status() } else { 0 };
    let timing = |frame: &RenderedFrame| {
        let RenderedFrame { path, prepare_s, render_s } = frame;
        json!({ "path": path, "prepare_seconds": prepare_s, "render_seconds": render_s })
    };
    let timings: Vec<_> = summary.rendered.iter().map(timing).collect();
    let printed = json!({
        "out": out.to_string_lossy(),
        "frames": summary.frames,
        "rendered": summary.rendered.len(),
        "timings": timings,
        "interrupted": summary.interrupted,
        "seconds": seconds,
    });
    let (out, is_part) = (out.to_owned(), options.share.is_some());
    Ok(Answer::new(json, printed, move || tell(&summary, is_part, &out, seconds)).with_status(status))
}

/// Whether two paths are of one folder.
fn is_same(a: &Path, b: &Path) -> bool {
    a.canonicalize().ok().zip(b.canonicalize().ok()).is_some_and(|(a, b)| a == b)
}

fn tell(summary: &Summary, is_part: bool, out: &Path, seconds: f64) {
    if summary.interrupted {
        eprintln!(
            "interrupted after {} of {} frames; run the same command to resume",
            summary.rendered.len(),
            summary.frames
        );
    } else {
        let rate = if !summary.rendered.is_empty() {
            format!(", {} per frame", duration(seconds / summary.rendered.len() as f64))
        } else {
            String::new()
        };
        println!("{} frames, {} of them new, in {}{rate}", summary.frames, summary.rendered.len(), duration(seconds));
        if is_part {
            println!("without --part, and once all parts have ended, the same command merges them");
        } else {
            println!("see {}", out.join("contact_sheet.png").display());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn every_command_has_help_with_an_example() {
        let mut cli = Cli::command();
        cli.build();
        for command in cli.get_subcommands().filter(|command| command.get_name() != "help") {
            let example = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            assert!(example.contains(&format!("trove {}", command.get_name())), "{}", command.get_name());
        }
    }

    #[test]
    fn wrong_usage_is_2_failure_is_1_and_help_is_0() {
        for (args, status) in [
            (vec!["trove", "--help"], 0),
            (vec!["trove", "generate"], 2),
            (vec!["trove", "generate", "no-such-recipe.toml", "--out", "no-such-folder"], 1),
        ] {
            assert_eq!(main(args.iter().map(OsString::from), &[]), status, "{args:?}");
        }
    }
}

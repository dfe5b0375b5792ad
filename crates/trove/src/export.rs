//! `trove export`: finished frames as another dataset, or recorded drives in the plain form.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use serde_json::json;
use trove_format::{Curated, ReportTable};
use trove_model::{Drive, Outcome, Report};
use trove_read::drive_source::DriveSource;
use trove_write::{Choice, DatasetFormat, LabelPictures, PlainFiles, WriteError, export, write_plain_drive};

use crate::answer::Answer;
use crate::build::print_entries;
use crate::class_maps::ClassMapChoice;
use crate::drives::DatasetChoice;
use crate::interrupt;
use crate::progress::Steps;
use crate::recipe::nearest;
use crate::watch::Watch;

/// `trove export`
#[derive(Args)]
pub(crate) struct Export {
    /// A finished folder of trove generate; for --format trove the root folder of a dataset.
    source: PathBuf,
    /// The form to write (docs/export.md).
    #[arg(long, value_parser = form)]
    format: Form,
    /// Output folder; running again goes on where an earlier export ended.
    #[arg(long)]
    out: PathBuf,
    #[command(flatten)]
    frames: Frames,
    #[command(flatten)]
    drives: Drives,
    /// Print a summary as JSON.
    #[arg(long)]
    json: bool,
}

/// Of finished frames.
#[derive(Args)]
struct Frames {
    /// A list of trove curate: its frames alone, in their splits; without it all frames are for training.
    #[arg(long, value_name = "FILE.json")]
    split: Option<PathBuf>,
    /// Class map of the labels, as for trove evaluate [default: the form's own].
    #[arg(long, value_name = "MAP")]
    classes: Option<ClassMapChoice>,
}

/// Of drives.
#[derive(Args)]
struct Drives {
    #[command(flatten)]
    dataset: DatasetChoice,
    /// With --format trove: names of drives; without it all.
    #[arg(long = "scene", value_name = "NAME")]
    scenes: Vec<String>,
    /// With --format trove: also write LiDAR sweeps.
    #[arg(long)]
    lidar: bool,
    /// With --format trove: also link or copy the recorded pictures, and write the dataset's own labels of them where
    /// those lie inside its files (Waymo), in folders that `trove evaluate` reads.
    #[arg(long)]
    pictures: bool,
}

/// What to write.
#[derive(Clone, Copy)]
enum Form {
    /// Drives in TRoVE's own plain form: drive.jsonl (docs/plain-drive.md).
    Plain,
    /// Frames.
    Dataset(DatasetFormat),
}

/// The name of drives in the plain form.
const PLAIN: &str = "trove";

fn form(name: &str) -> Result<Form, String> {
    if name == PLAIN {
        return Ok(Form::Plain);
    }
    DatasetFormat::named(name).map(Form::Dataset).ok_or_else(|| {
        let names: Vec<&str> = DatasetFormat::all().map(DatasetFormat::name).chain([PLAIN]).collect();
        format!("expected one of {}{}", names.join(", "), nearest(name, &names))
    })
}

impl Export {
    /// Writes what was asked for; the status is 130 or 143 where a signal ended it.
    pub(crate) fn run(self, watch: &Watch) -> Result<Answer> {
        match self.format {
            Form::Plain => {
                ensure!(
                    self.frames.split.is_none(),
                    "--split is for finished frames; --format trove writes whole drives"
                );
                self.drives.write(&self.source, &self.out, self.json)
            }
            Form::Dataset(format) => {
                let Drives { scenes, lidar, pictures, .. } = &self.drives;
                ensure!(
                    scenes.is_empty() && !lidar && !pictures,
                    "--scene, --lidar and --pictures are for --format trove; choose frames with --split"
                );
                self.frames.write(&self.source, &self.out, format, self.json, watch)
            }
        }
    }
}

impl Frames {
    fn write(&self, source: &Path, out: &Path, format: DatasetFormat, as_json: bool, watch: &Watch) -> Result<Answer> {
        let curated = self.split.as_deref().map(Curated::read).transpose()?;
        let classes = self.classes.as_ref().map(ClassMapChoice::read).transpose()?;
        let choice = Choice { curated, classes };
        watch.listen();
        let progress = Steps::new(watch);
        let exported = export(source, out, format, &choice, &|done, total| progress.done(done, total))?;
        if exported.interrupted {
            eprintln!("interrupted; run the same command to go on");
            return Ok(Answer::printed(interrupt::status()));
        }
        let json = serde_json::to_value(&exported)?;
        let out = out.to_owned();
        Ok(Answer::new(as_json, json, move || {
            for (split, frames) in &exported.frames {
                println!("{split}: {frames} frames");
            }
            for (what, values) in &exported.clipped {
                println!("{values} {what}");
            }
            println!("{} in {}", format.name(), out.display());
        }))
    }
}

impl Drives {
    fn write(&self, root: &Path, out: &Path, as_json: bool) -> Result<Answer> {
        let report = Report::default();
        let source = self.dataset.open(root, &report)?;
        let known: Vec<String> = source.drives().into_iter().map(|drive| drive.name).collect();
        if let Some(unknown) = self.scenes.iter().find(|name| !known.contains(name)) {
            let nearest = known.iter().min_by_key(|name| strsim::damerau_levenshtein(name, unknown));
            let hint = nearest.map(|name| format!("; did you mean {name:?}?")).unwrap_or_default();
            bail!("--scene: {} has no drive {unknown:?}{hint}", root.display());
        }
        let chosen: Vec<&String> = known.iter().filter(|n| self.scenes.is_empty() || self.scenes.contains(n)).collect();
        let files = PlainFiles { lidar: self.lidar, pictures: self.pictures };
        let mut labels = 0;
        for name in &chosen {
            let drive = source.read(name, &report)?;
            let folder = out.join(name.as_str());
            write_plain_drive(&drive, root, &folder, files, &report).with_context(|| format!("{name}: not written"))?;
            if self.pictures {
                labels += write_labels(&*source, &drive, name, &folder.join("labels"), &report)
                    .with_context(|| format!("{name}: labels not written"))?;
            }
        }
        let report = ReportTable::from(&report);
        let json = json!({ "out": out.to_string_lossy(), "drives": chosen, "labels": labels, "report": report });
        let (drives, out) = (chosen.len(), out.to_owned());
        Ok(Answer::new(as_json, json, move || {
            println!("{drives} drives in {}", out.display());
            if labels > 0 {
                println!("{labels} label images in folders labels; trove evaluate PREDICTED DRIVE/labels reads them");
            }
            print_entries(&report, "");
        }))
    }
}

/// Writes the dataset's own labels of a drive's pictures; how many there are.
fn write_labels(source: &dyn DriveSource, drive: &Drive, name: &str, folder: &Path, report: &Report) -> Result<usize> {
    let (mut pictures, mut failed) = (LabelPictures::new(folder), None::<WriteError>);
    source.labels(name, report, &mut |picture| {
        let example = || format!("{name}: {} at {} ns", picture.camera, picture.time_ns);
        let Some(k) = drive.keyframes.iter().position(|keyframe| keyframe.time_ns == picture.time_ns) else {
            return report.note(Outcome::Dropped, "labels of no keyframe", example());
        };
        if failed.is_some() {
            return;
        }
        match pictures.write(&picture.camera, k, (picture.classes, picture.instance_divisor), &picture.png) {
            Ok(true) => {}
            Ok(false) => report.note(Outcome::Dropped, "labels with another divisor than the drive's first", example()),
            Err(error) => failed = Some(error),
        }
    })?;
    failed.map_or(Ok(pictures.written()), |error| Err(error.into()))
}

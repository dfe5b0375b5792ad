//! `trove verify --labels`: whether labels agree with themselves, with the image, and over views and times.

use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use trove_format::FrameFile;
use trove_judge::audit::{
    Audit, Check, Finding, FrameReader, LabelForm, LabelledFrame, LabelledSweep, audit, patches, picture, report,
    worst_in_turn,
};
use trove_write::{StoredFrame, StoredSweep, WriteError, encode_picture, write_atomically};

use crate::answer::Answer;
use crate::progress::Steps;
use crate::watch::Watch;

/// Pictures of findings that are written.
const WORST: usize = 10;
/// Findings of a check that are printed.
const PRINTED: usize = 3;

/// What to look at, and what to write.
#[derive(Args, Clone)]
pub(crate) struct LabelOptions {
    /// Check what the labels say instead: of each other, of the image, and over views and times.
    #[arg(long)]
    labels: bool,
    /// Form of the dataset [default: found out from its files].
    #[arg(long, value_enum, requires = "labels")]
    form: Option<FormChoice>,
    /// Folder for audit.json and pictures of the ten worst findings.
    #[arg(long, value_name = "DIR", requires = "labels")]
    out: Option<PathBuf>,
}

/// The forms of `--form`.
#[derive(Clone, Copy, ValueEnum)]
enum FormChoice {
    /// An output folder of trove generate.
    Trove,
    /// gtFine and leftImg8bit.
    Cityscapes,
    /// training/label_02 or label_2, calib, images.
    Kitti,
    /// annotations/*.json with instances, panoptic segments or keypoints.
    Coco,
    /// Folders v1.0-*, samples, sweeps.
    Nuscenes,
    /// Images with labels in CamVid's 32 colours.
    Camvid,
}

impl From<FormChoice> for LabelForm {
    fn from(choice: FormChoice) -> Self {
        match choice {
            FormChoice::Trove => Self::Trove,
            FormChoice::Cityscapes => Self::Cityscapes,
            FormChoice::Kitti => Self::Kitti,
            FormChoice::Coco => Self::Coco,
            FormChoice::Nuscenes => Self::NuScenes,
            FormChoice::Camvid => Self::CamVid,
        }
    }
}

impl LabelOptions {
    /// Whether labels are asked for.
    pub(crate) fn are_wanted(&self) -> bool {
        self.labels
    }

    /// Looks; the status is 1 where something is wrong.
    pub(crate) fn run(&self, folder: &Path, page: Option<&Path>, as_json: bool, watch: &Watch) -> Result<Answer> {
        if let Some(out) = &self.out {
            ensure!(
                !out.starts_with(folder),
                "--out {}: expected a folder outside of the dataset, found one in it; choose another",
                out.display()
            );
        }
        let progress = Steps::new(watch);
        let form = self.form.map(LabelForm::from);
        let (form, audit) = audit(folder, form, &Stored, &|done, total| progress.done(done, total))?;
        let json = told(form, &audit);
        if let Some(out) = &self.out {
            write(folder, out, &audit, &json)?;
        }
        if let Some(page) = page {
            write_atomically(page, report(folder, form, &audit)?.as_bytes())?;
        }
        let (is_sound, written) = (audit.is_sound(), page.or(self.out.as_deref()).map(Path::to_owned));
        let answer = Answer::new(as_json, json, move || print(form, &audit, written.as_deref()));
        Ok(answer.with_status(i32::from(!is_sound)))
    }
}

fn told(form: LabelForm, audit: &Audit) -> Value {
    let tallies = audit.tallies.iter().map(|(check, tally)| (check.name().to_owned(), json!(tally)));
    json!({
        "form": form.name(),
        "frames": audit.frames,
        "sound": audit.is_sound(),
        "checks": tallies.collect::<serde_json::Map<_, _>>(),
        "findings": audit.findings,
    })
}

fn print(form: LabelForm, audit: &Audit, written: Option<&Path>) {
    println!("{:<14}{:>10}{:>10}  rule", "check", "looked at", "findings");
    for check in Check::ALL {
        match audit.tallies.get(&check) {
            Some(tally) => {
                println!("{:<14}{:>10}{:>10}  {}", check.name(), tally.looked_at, tally.findings, check.rule());
            }
            None => println!("{:<14}{:>10}{:>10}  {}", check.name(), "-", "-", check.rule()),
        }
    }
    for check in Check::ALL {
        let found: Vec<&Finding> = audit.findings.iter().filter(|finding| finding.check == check).collect();
        for Finding { place, what, .. } in found.iter().take(PRINTED) {
            println!("{}: {place}: {what}", check.name());
        }
        if let Some(more @ 1..) = found.len().checked_sub(PRINTED) {
            println!("{}: and {more} more", check.name());
        }
    }
    let (frames, form) = (audit.frames, form.name());
    if audit.is_sound() {
        let see = written.map_or(String::new(), |written| format!("; see {}", written.display()));
        println!("{frames} frames ({form}): no fault found{see}");
    } else {
        let count: usize = audit.tallies.values().map(|tally| tally.findings).sum();
        let see = written.map_or("--page FILE.html or --out DIR shows the worst".into(), |written| {
            format!("see {}", written.display())
        });
        println!("{frames} frames ({form}): {count} findings; {see}");
    }
}

/// Writes the answer, and the worst of each check in turn until there are enough.
fn write(folder: &Path, out: &Path, audit: &Audit, json: &Value) -> Result<()> {
    std::fs::create_dir_all(out).map_err(|e| {
        anyhow::anyhow!("{}: expected a folder to write to, found \"{e}\"; choose another with --out", out.display())
    })?;
    write_atomically(&out.join("audit.json"), &serde_json::to_vec_pretty(json)?)?;
    let mut count = 0;
    for finding in worst_in_turn(audit) {
        if count == WORST {
            break;
        }
        // A damaged image cannot be shown.
        let Ok(Some(picture)) = picture(folder, finding) else { continue };
        count += 1;
        let name = format!("worst-{count:02}-{}.png", finding.check.name());
        write_atomically(&out.join(&name), &encode_picture(&name, &picture)?)?;
    }
    Ok(())
}

/// Reads what `trove generate` wrote.
struct Stored;

impl FrameReader for Stored {
    fn frame(&self, folder: &Path, place: &str) -> Result<LabelledFrame, String> {
        let frame = StoredFrame::open(folder).map_err(|e| e.to_string())?;
        let mut damage = Vec::new();
        let (mut read, patches) = (Reading { frame: &frame, damage: &mut damage }, patches(&frame.table));
        Ok(LabelledFrame {
            rgb: read.file(FrameFile::Rgb, StoredFrame::rgb),
            class: read.file(FrameFile::Class, StoredFrame::class),
            instance: read.file(FrameFile::Instance, StoredFrame::instance),
            depth_m: read.file(FrameFile::Depth, StoredFrame::depth_m),
            normal: read.file(FrameFile::Normal, |frame| frame.vectors_in(FrameFile::Normal, patches)),
            flow: [FrameFile::FlowForward, FrameFile::FlowBackward]
                .map(|file| read.file(file, |frame| frame.pairs_in(file, patches))),
            occluded: [
                read.file(FrameFile::OccludedForward, StoredFrame::occluded_forward),
                read.file(FrameFile::OccludedBackward, StoredFrame::occluded_backward),
            ],
            panoptic: read.file(FrameFile::Panoptic, StoredFrame::panoptic),
            part: read.file(FrameFile::Part, StoredFrame::part),
            range_m: read.file(FrameFile::Range, |frame| frame.numbers_in(FrameFile::Range, patches)),
            normal_world: read.file(FrameFile::NormalWorld, |frame| frame.vectors_in(FrameFile::NormalWorld, patches)),
            object_coordinates: read
                .file(FrameFile::ObjectCoordinates, |frame| frame.vectors_in(FrameFile::ObjectCoordinates, patches)),
            scene_flow: [FrameFile::SceneFlowForward, FrameFile::SceneFlowBackward]
                .map(|file| read.file(file, |frame| frame.vectors_in(file, patches))),
            place: place.to_owned(),
            table: frame.table.clone(),
            damage,
        })
    }

    fn sweep(&self, folder: &Path, place: &str) -> Result<LabelledSweep, String> {
        let sweep = StoredSweep::open(folder).map_err(|e| e.to_string())?;
        let points = sweep.points().map_err(|e| e.to_string())?;
        Ok(LabelledSweep { place: place.to_owned(), table: sweep.table, points })
    }
}

/// A frame whose files are read, and what is wrong with those that cannot be.
struct Reading<'a> {
    frame: &'a StoredFrame,
    damage: &'a mut Vec<String>,
}

impl Reading<'_> {
    /// What `read` gives of a file that is there; its size is that of the table.
    fn file<T>(&mut self, file: FrameFile, read: impl Fn(&StoredFrame) -> Result<T, WriteError>) -> Option<T> {
        if !self.frame.has(file) {
            return None;
        }
        read(self.frame).map_err(|e| self.damage.push(e.to_string())).ok()
    }
}

//! `trove evaluate`: what predictions are worth.

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use serde_json::{Map, Value, json};
use trove_format::ClassMapFile;
use trove_judge::Numbering;
use trove_judge::evaluate::{Estimate, Evaluation, Settings, evaluate, report};
use trove_model::Seed;
use trove_read::read_class_map;
use trove_write::write_atomically;

use crate::answer::Answer;
use crate::class_maps::ClassMapChoice;
use crate::progress::Steps;
use crate::watch::Watch;

/// What to compare.
#[derive(Args)]
pub(crate) struct Evaluate {
    /// Predicted labels: one PNG, or a folder of PNGs with the same relative paths as the ground truth.
    predicted: PathBuf,
    /// Ground-truth labels.
    truth: PathBuf,
    /// Class map to judge in, and of a side whose files do not tell their own: paper13, trove20, cityscapes,
    /// cityscapes-train, kitti-step, coco, camvid, waymo or a FILE.toml (docs/judge.md). Without it, that of the files,
    /// or paper13.
    #[arg(long, value_name = "MAP")]
    classes: Option<ClassMapChoice>,
    /// Class map of the predicted ids, where the files are not to decide.
    #[arg(long, value_name = "MAP")]
    predicted_classes: Option<ClassMapChoice>,
    /// Class map of the ground truth's ids, where the files are not to decide.
    #[arg(long, value_name = "MAP")]
    truth_classes: Option<ClassMapChoice>,
    /// Also compute boundary IoU.
    #[arg(long)]
    boundary: bool,
    /// Also compute panoptic quality, from instance.png beside class.png, Cityscapes' instanceIds or KITTI-STEP's panoptic maps.
    #[arg(long)]
    panoptic: bool,
    /// Seed of the bootstrap over images.
    #[arg(long, default_value_t = 7)]
    seed: u64,
    /// HTML page to write: scores by class, confusion matrix, and the images that came out worst.
    #[arg(long, value_name = "FILE.html")]
    page: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

impl Evaluate {
    pub(crate) fn run(&self, watch: &Watch) -> Result<Answer> {
        let settings = Settings {
            classes: self.classes.as_ref().map(ClassMapChoice::read).transpose()?,
            predicted: numbering(self.predicted_classes.as_ref(), "--predicted-classes", &self.predicted)?,
            truth: numbering(self.truth_classes.as_ref(), "--truth-classes", &self.truth)?,
            boundary: self.boundary,
            panoptic: self.panoptic,
            seed: Seed(self.seed),
        };
        let progress = Steps::new(watch);
        let found = evaluate(&self.predicted, &self.truth, &settings, &|done, total| progress.done(done, total))?;
        if let Some(page) = &self.page {
            write_atomically(page, report(&self.predicted, &found)?.as_bytes())?;
        }
        let page = self.page.clone();
        Ok(Answer::new(self.json, as_json(&found), move || {
            print(&found);
            page.iter().for_each(|page| println!("see {}", page.display()));
        }))
    }
}

/// The numbers of a side, where an option or a file in its folder names them.
fn numbering(chosen: Option<&ClassMapChoice>, option: &str, side: &Path) -> Result<Option<Numbering>> {
    if let Some(chosen) = chosen {
        return Ok(Some(Numbering { map: chosen.read()?, why: option.to_owned() }));
    }
    let folder = if side.is_file() { side.parent() } else { Some(side) };
    let file = folder.map(|folder| folder.join(ClassMapFile::NAME)).filter(|file| file.is_file());
    Ok(match file {
        Some(file) => {
            Some(Numbering { map: read_class_map(&file)?, why: format!("{} in its folder", ClassMapFile::NAME) })
        }
        None => None,
    })
}

fn as_json(found: &Evaluation) -> Value {
    let value = |e: &Option<Estimate>| e.map(|e| e.value);
    let interval = |e: &Option<Estimate>| e.map(|e| e.interval);
    let side = |side: &Numbering| json!({ "classes": side.map.name, "known_by": side.why });
    let classes = || found.classes.counted().enumerate();
    // Classes that are neither there nor predicted have no IoU.
    let by_class = |of: &dyn Fn(usize) -> Option<Value>| -> Map<String, Value> {
        classes().filter_map(|(i, class)| Some((class.name.to_owned(), of(i)?))).collect()
    };
    let mut printed = json!({
        "pictures": found.pictures,
        "unused_predictions": found.unused,
        "classes": found.classes.name,
        "predicted": side(&found.predicted),
        "truth": side(&found.truth),
        "miou": value(&found.miou),
        "miou_interval95": interval(&found.miou),
        "accuracy": value(&found.accuracy),
        "accuracy_interval95": interval(&found.accuracy),
        "iou": by_class(&|i| found.iou[i].map(|e| json!(e.value))),
        "iou_interval95": by_class(&|i| found.iou[i].map(|e| json!(e.interval))),
    });
    let confusion: Vec<Vec<u64>> = classes()
        .map(|(t, _)| (0..=found.classes.counted().count()).map(|p| found.counts.confusion.count(t, p)).collect())
        .collect();
    printed["confusion"] = json!({
        "rows": "truth, columns: prediction, the last one ignored ids",
        "names": classes().map(|(_, class)| &class.name).collect::<Vec<_>>(),
        "pixels": confusion,
    });
    if found.boundary_miou.is_some() {
        printed["boundary_miou"] = json!(value(&found.boundary_miou));
        printed["boundary_miou_interval95"] = json!(interval(&found.boundary_miou));
        printed["boundary_iou"] = json!(by_class(&|i| found.boundary_iou[i].map(|e| json!(e.value))));
        printed["boundary_iou_interval95"] = json!(by_class(&|i| found.boundary_iou[i].map(|e| json!(e.interval))));
    }
    if found.pq.is_some() {
        printed["pq"] = json!(value(&found.pq));
        printed["pq_interval95"] = json!(interval(&found.pq));
        printed["panoptic"] = json!(by_class(&|i| {
            let quality = found.counts.panoptic.quality(i)?;
            let interval = interval(&found.class_pq[i]);
            Some(json!({ "pq": quality.pq, "sq": quality.sq, "rq": quality.rq, "pq_interval95": interval }))
        }));
    }
    printed
}

fn print(found: &Evaluation) {
    let row = |name: &str, columns: [&Option<Estimate>; 3]| {
        let cell = |e: &Option<Estimate>| match e {
            Some(Estimate { value, interval: [low, high] }) => {
                format!("{:6.2} {:>15}", value * 100.0, format!("{:.1} to {:.1}", low * 100.0, high * 100.0))
            }
            None => String::new(),
        };
        println!(
            "{}",
            format!("{name:16} {:22}   {:22}   {:22}", cell(columns[0]), cell(columns[1]), cell(columns[2])).trim_end()
        );
    };
    let asked = |e: &Option<Estimate>, name| if e.is_some() { name } else { "" };
    let (boundary, panoptic) = (asked(&found.boundary_miou, "boundary IoU"), asked(&found.pq, "panoptic quality"));
    println!("{} images; percent, with 95 % intervals over images", found.pictures);
    let side = |side: &Numbering| format!("{} ({})", side.map.name, side.why);
    println!("classes: {}; predicted: {}; truth: {}", found.classes.name, side(&found.predicted), side(&found.truth));
    if found.unused > 0 {
        println!("{} predictions have no ground truth and were left out", found.unused);
    }
    println!("{}", format!("{:16} {:22}   {boundary:22}   {panoptic}", "", "IoU").trim_end());
    for (i, class) in found.classes.counted().enumerate() {
        row(&class.name, [&found.iou[i], &found.boundary_iou[i], &found.class_pq[i]]);
    }
    row("mean", [&found.miou, &found.boundary_miou, &found.pq]);
    row("pixel accuracy", [&found.accuracy, &None, &None]);
}

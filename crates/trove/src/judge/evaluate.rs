//! `trove evaluate`: what predictions are worth.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use serde_json::{Map, Value, json};
use trove_judge::LabelSet;
use trove_judge::evaluate::{Estimate, Evaluation, Settings, evaluate};
use trove_model::Seed;

use super::label_set;
use crate::progress::Steps;

/// What to compare.
#[derive(Args)]
pub(crate) struct Evaluate {
    /// Predicted labels: one PNG, or a folder of PNGs with the same relative paths as the ground truth.
    predicted: PathBuf,
    /// Ground-truth labels.
    truth: PathBuf,
    /// Label set of both sides; ids that it does not count (void) are ignored.
    #[arg(long, default_value = "trove13", value_parser = label_set)]
    classes: LabelSet,
    /// Also compute boundary IoU.
    #[arg(long)]
    boundary: bool,
    /// Also compute panoptic quality, from instance.png beside class.png, Cityscapes' instanceIds or KITTI-STEP's panoptic maps.
    #[arg(long)]
    panoptic: bool,
    /// Seed of the bootstrap over images.
    #[arg(long, default_value_t = 7)]
    seed: u64,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

impl Evaluate {
    pub(crate) fn run(&self) -> Result<()> {
        let settings = Settings {
            set: self.classes.clone(),
            boundary: self.boundary,
            panoptic: self.panoptic,
            seed: Seed(self.seed),
        };
        let progress = Steps::default();
        let found = evaluate(&self.predicted, &self.truth, &settings, &|done, total| progress.done(done, total))?;
        if self.json {
            println!("{}", serde_json::to_string_pretty(&as_json(&found))?);
        } else {
            print(&found);
        }
        Ok(())
    }
}

fn as_json(found: &Evaluation) -> Value {
    let value = |e: &Option<Estimate>| e.map(|e| e.value);
    let interval = |e: &Option<Estimate>| e.map(|e| e.interval);
    let classes = || found.set.classes.iter().enumerate();
    // Classes that are neither there nor predicted have no IoU.
    let by_class = |of: &dyn Fn(usize) -> Option<Value>| -> Map<String, Value> {
        classes().filter_map(|(i, class)| Some((class.name.to_owned(), of(i)?))).collect()
    };
    let mut printed = json!({
        "pictures": found.pictures,
        "unused_predictions": found.unused,
        "classes": found.set.name,
        "miou": value(&found.miou),
        "miou_interval95": interval(&found.miou),
        "accuracy": value(&found.accuracy),
        "accuracy_interval95": interval(&found.accuracy),
        "iou": by_class(&|i| found.iou[i].map(|e| json!(e.value))),
        "iou_interval95": by_class(&|i| found.iou[i].map(|e| json!(e.interval))),
    });
    let confusion: Vec<Vec<u64>> = classes()
        .map(|(t, _)| (0..=found.set.classes.len()).map(|p| found.counts.confusion.count(t, p)).collect())
        .collect();
    printed["confusion"] = json!({
        "rows": "truth, columns: prediction, the last one ignored ids",
        "names": classes().map(|(_, class)| class.name).collect::<Vec<_>>(),
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
    if found.unused > 0 {
        println!("{} predictions have no ground truth and were left out", found.unused);
    }
    println!("{}", format!("{:16} {:22}   {boundary:22}   {panoptic}", "", "IoU").trim_end());
    for (i, class) in found.set.classes.iter().enumerate() {
        row(class.name, [&found.iou[i], &found.boundary_iou[i], &found.class_pq[i]]);
    }
    row("mean", [&found.miou, &found.boundary_miou, &found.pq]);
    row("pixel accuracy", [&found.accuracy, &None, &None]);
}

//! `trove evaluate`: what predictions are worth.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use serde_json::{Map, Value, json};
use trove_judge::LabelSet;
use trove_judge::evaluate::{Estimate, Evaluation, Settings, evaluate};
use trove_model::Seed;

/// What to compare.
#[derive(Args)]
pub(crate) struct Evaluate {
    /// Predicted labels: a folder of PNGs, named as the truth's below its folder, or one file.
    predicted: PathBuf,
    /// True labels.
    truth: PathBuf,
    /// Numbering of both sides' ids; those that it does not count (void) are left out.
    #[arg(long, default_value = "trove13", value_parser = label_set)]
    classes: LabelSet,
    /// Boundary IoU too.
    #[arg(long)]
    boundary: bool,
    /// Panoptic quality too, from instance.png beside class.png or Cityscapes' instanceIds.
    #[arg(long)]
    panoptic: bool,
    /// Draws the bootstrap's pictures.
    #[arg(long, default_value_t = 7)]
    seed: u64,
    /// Prints JSON.
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
        let found = evaluate(&self.predicted, &self.truth, &settings)?;
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
        classes().filter_map(|(i, class)| Some((class.name.clone(), of(i)?))).collect()
    };
    let mut printed = json!({
        "pictures": found.pictures,
        "classes": found.set.name,
        "miou": value(&found.miou),
        "miou_interval95": interval(&found.miou),
        "accuracy": value(&found.accuracy),
        "accuracy_interval95": interval(&found.accuracy),
        "iou": by_class(&|i| found.iou[i].map(|e| json!(e.value))),
        "iou_interval95": by_class(&|i| found.iou[i].map(|e| json!(e.interval))),
    });
    let confusion: Vec<Vec<u64>> =
        classes().map(|(t, _)| (0..=found.set.classes.len()).map(|p| found.confusion.count(t, p)).collect()).collect();
    printed["confusion"] = json!({
        "rows": "truth, columns: prediction, the last one ignored ids",
        "names": classes().map(|(_, class)| &class.name).collect::<Vec<_>>(),
        "pixels": confusion,
    });
    if let Some(boundary) = &found.boundary {
        printed["boundary_iou"] = json!(by_class(&|i| boundary.iou(i).map(Value::from)));
    }
    if let Some(panoptic) = &found.panoptic {
        printed["pq"] = json!(panoptic.mean());
        printed["panoptic"] =
            json!(by_class(&|i| { panoptic.quality(i).map(|[pq, sq, rq]| json!({ "pq": pq, "sq": sq, "rq": rq })) }));
    }
    printed
}

fn print(found: &Evaluation) {
    let row = |name: &str, e: &Option<Estimate>, more: String| match e {
        Some(Estimate { value, interval: [low, high] }) => {
            println!("{name:16} {:6.2}  {:6.2} to {:6.2}{more}", value * 100.0, low * 100.0, high * 100.0);
        }
        None => println!("{name:16}      –"),
    };
    println!("{} pictures; percent, with 95 % intervals over pictures", found.pictures);
    row("mean IoU", &found.miou, String::new());
    row("pixel accuracy", &found.accuracy, String::new());
    for (i, class) in found.set.classes.iter().enumerate() {
        let boundary = found.boundary.as_ref().and_then(|b| b.iou(i));
        let quality = found.panoptic.as_ref().and_then(|p| p.quality(i)).map(|q| q[0]);
        let more =
            |name: &str, value: Option<f64>| value.map_or(String::new(), |v| format!("  {name} {:.2}", v * 100.0));
        row(&class.name, &found.iou[i], more("boundary", boundary) + &more("PQ", quality));
    }
    if let Some(mean) = found.panoptic.as_ref().and_then(|p| p.mean()) {
        println!("{:16} {:6.2}", "mean PQ", mean * 100.0);
    }
}

fn label_set(name: &str) -> Result<LabelSet, String> {
    LabelSet::named(name).ok_or_else(|| format!("expected one of {}", LabelSet::NAMES.join(", ")))
}

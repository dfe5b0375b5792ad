//! `manifest.json`, `report.json`, and the file that each built scene leaves for them.

use std::path::Path;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use trove_build::{AssetFit, ObjectFit};
use trove_model::{CLASSES, Drive, Outcome, Provenance, Report};
use trove_write::{WrittenFile, write_atomically};

/// Version of the manifest's form.
const FORMAT: u32 = 1;

/// What a scene of one variation is known by once it has been built: enough to go on after an interruption, and to
/// write the manifest and the report, without building it again.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct SiteFile {
    pub(super) drive: Value,
    pub(super) sources: Vec<Source>,
    pub(super) report: Value,
    /// What stands for which object, how well it fits, and what else would have.
    pub(super) fits: Value,
    /// What its variation differs in.
    pub(super) factors: Value,
    /// Frames as (keyframe, view).
    pub(super) frames: Vec<(usize, String)>,
}

/// Where something came from.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) struct Source {
    pub(super) source: String,
    pub(super) licence: String,
}

impl From<&Provenance> for Source {
    fn from(provenance: &Provenance) -> Self {
        Self { source: provenance.source.clone(), licence: provenance.licence.clone() }
    }
}

impl SiteFile {
    pub(super) const NAME: &str = "site.json";

    /// Reads it back; `None` where it is not there or is not whole.
    pub(super) fn read(folder: &Path) -> Option<Self> {
        serde_json::from_slice(&std::fs::read(folder.join(Self::NAME)).ok()?).ok()
    }

    pub(super) fn write(&self, folder: &Path) -> Result<()> {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("{}: expected a folder that can be made", folder.display()))?;
        Ok(write_atomically(&folder.join(Self::NAME), &pretty(self)?)?)
    }
}

/// A drive's row in the manifest.
pub(super) fn drive_row(drive: &Drive) -> Value {
    json!({
        "scene": drive.id,
        "dataset": drive.dataset,
        "place": drive.place,
        "keyframes": drive.keyframes.len(),
        "licence": drive.licence,
        "projection": {
            "kind": "equirectangular",
            "origin_lat_deg": drive.projection.origin_lat_deg,
            "origin_lon_deg": drive.projection.origin_lon_deg,
            "anchor_m": drive.projection.anchor_m.to_array(),
        },
    })
}

/// How well assets fit, an object a row.
pub(crate) fn fits_json(fits: &[ObjectFit]) -> Value {
    let asset = |fit: &AssetFit| json!({ "asset": fit.asset, "quality_m": fit.quality_m, "iou3d": fit.iou3d });
    let row = |fit: &ObjectFit| {
        json!({
            "track": fit.track_token,
            "kind": format!("{:?}", fit.kind),
            "size_m": fit.size_m.to_array(),
            "chosen": asset(&fit.chosen),
            "runners_up": fit.runners_up.iter().map(asset).collect::<Vec<_>>(),
        })
    };
    fits.iter().map(row).collect()
}

/// A frame's row in the manifest.
pub(super) fn frame_row(path: &str, key: &FrameKey, factors: &Value, files: &[WrittenFile]) -> Value {
    let hashes: serde_json::Map<String, Value> =
        files.iter().map(|file| (file.name.clone(), Value::String(file.sha256.clone()))).collect();
    json!({
        "path": path,
        "scene": key.scene,
        "variation": key.variation,
        "keyframe": key.keyframe,
        "view": key.view,
        "factors": factors,
        "files": hashes,
    })
}

/// Which frame it is.
#[derive(Clone, Debug)]
pub(super) struct FrameKey {
    pub(super) scene: String,
    pub(super) variation: u32,
    pub(super) keyframe: usize,
    pub(super) view: String,
}

impl FrameKey {
    /// Path of the frame's folder below the output folder.
    pub(super) fn path(&self) -> String {
        let folder = variation_folder(&self.scene, self.variation);
        format!("{folder}/k{:03}/{}", self.keyframe, self.view)
    }
}

/// Path of the folder of a scene's variation below the output folder.
pub(super) fn variation_folder(scene: &str, variation: u32) -> String {
    format!("{scene}/v{variation:02}")
}

/// Writes the manifest.
pub(super) fn write_manifest(path: &Path, identity: &Value, sites: &[SiteSummary], frames: Vec<Value>) -> Result<()> {
    let mut drives: Vec<Value> = Vec::new();
    let mut licences: Vec<&Source> = Vec::new();
    for site in sites {
        let mut row = site.file.drive.clone();
        row["sources"] = json!(site.file.sources);
        if !drives.contains(&row) {
            drives.push(row);
        }
        licences.extend(&site.file.sources);
    }
    licences.sort();
    licences.dedup();
    let manifest = json!({
        "format": FORMAT,
        "seed": identity["recipe"]["seed"],
        "recipe": identity["recipe"],
        "versions": identity["versions"],
        "classes": classes(),
        "drives": drives,
        "licences": licences,
        "frames": frames,
    });
    Ok(write_atomically(path, &pretty(&manifest)?)?)
}

/// A built scene of one variation.
pub(super) struct SiteSummary {
    pub(super) scene: String,
    pub(super) variation: u32,
    pub(super) file: SiteFile,
}

/// Writes the report: what concerns the run as a whole, and then each scene's.
pub(super) fn write_report(path: &Path, run: &Report, sites: &[SiteSummary]) -> Result<()> {
    let scenes: Vec<Value> = sites
        .iter()
        .map(|site| {
            let mut row = site.file.report.clone();
            row["scene"] = json!(site.scene);
            row["variation"] = json!(site.variation);
            row
        })
        .collect();
    let whole = json!({ "run": report_json(run), "scenes": scenes });
    Ok(write_atomically(path, &pretty(&whole)?)?)
}

/// A report as JSON: `entries` (outcome, what, count, examples) and `measurements` by name.
pub(crate) fn report_json(report: &Report) -> Value {
    let outcome = |outcome| match outcome {
        Outcome::Dropped => "dropped",
        Outcome::Substituted => "substituted",
        Outcome::Guessed => "guessed",
        Outcome::Warned => "warned",
    };
    let entries: Vec<Value> = report
        .entries()
        .iter()
        .map(|entry| {
            json!({
                "outcome": outcome(entry.outcome),
                "what": entry.what,
                "count": entry.count,
                "examples": entry.examples,
            })
        })
        .collect();
    let measurements: serde_json::Map<String, Value> =
        report.measurements().into_iter().map(|m| (m.name, json!(m.value))).collect();
    json!({ "entries": entries, "measurements": measurements })
}

fn classes() -> Vec<Value> {
    let row = |row: &trove_model::ClassRow| {
        json!({
            "id": row.class.id(),
            "name": row.name,
            "thing": row.thing,
            "rgb": row.rgb,
            "class13": row.class13 as u8,
            "cityscapes_id": row.cityscapes_id,
            "train_id": row.train_id,
            "coco_id": row.coco_id,
            "camvid_id": row.camvid_id,
        })
    };
    CLASSES.iter().map(row).collect()
}

fn pretty(value: &impl Serialize) -> Result<Vec<u8>> {
    let mut bytes = serde_json::to_vec_pretty(value)?;
    bytes.push(b'\n');
    Ok(bytes)
}

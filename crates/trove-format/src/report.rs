//! `report.json`: what was dropped, substituted or guessed, and what was measured.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use trove_model::{Outcome, Report};

use crate::{file, names};

/// A report: in `report.json`, in `site.json`, and printed by `trove build --json` and `trove inspect --json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ReportTable {
    /// What happened, ordered by outcome and `what`.
    pub entries: Vec<EntryRow>,
    /// Values by name, whose unit is the name's ending (`map.path_to_road_median_m`); null where a value is not a finite
    /// number.
    pub measurements: BTreeMap<String, Option<f64>>,
}

/// All events of one kind.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct EntryRow {
    /// Whether something was dropped, substituted, guessed, or used with a warning.
    #[serde(with = "names::outcome")]
    #[cfg_attr(test, schemars(schema_with = "names::outcome::schema"))]
    pub outcome: Outcome,
    /// To what it happened and why (`box of zero size`).
    pub what: String,
    /// How often.
    pub count: u64,
    /// The first few, in alphabetical order.
    pub examples: Vec<String>,
}

/// The whole of `report.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct RunReport {
    /// What concerns the run as a whole.
    pub run: ReportTable,
    /// What concerns each built scene.
    pub scenes: Vec<SceneReport>,
}

/// The report of one scene, built as one variation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SceneReport {
    /// The scene (`scene-0103`).
    pub scene: String,
    /// Number of the variation, from 0.
    pub variation: u32,
    /// Its report.
    #[serde(flatten)]
    pub report: ReportTable,
}

impl From<&Report> for ReportTable {
    fn from(report: &Report) -> Self {
        let entry = |entry: trove_model::Entry| EntryRow {
            outcome: entry.outcome,
            what: entry.what,
            count: entry.count,
            examples: entry.examples,
        };
        let finite = |m: trove_model::Measurement| (m.name, m.value.is_finite().then_some(m.value));
        Self {
            entries: report.entries().into_iter().map(entry).collect(),
            measurements: report.measurements().into_iter().map(finite).collect(),
        }
    }
}

impl RunReport {
    /// The file's name.
    pub const NAME: &str = "report.json";

    /// The file's bytes.
    pub fn to_json(&self) -> Vec<u8> {
        file::pretty(self)
    }
}

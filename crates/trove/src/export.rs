//! `trove export`: recorded drives of any dataset in another form.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use serde_json::json;
use trove_format::ReportTable;
use trove_model::Report;
use trove_write::{PlainFiles, write_plain_drive};

use crate::build::print_entries;
use crate::drives::DatasetChoice;

/// `trove export`
#[derive(Args)]
pub(crate) struct Export {
    /// The dataset's root folder.
    root: PathBuf,
    /// The form to write.
    #[arg(long, value_enum)]
    format: Format,
    /// Output folder; each drive gets a folder of its own in it.
    #[arg(long)]
    out: PathBuf,
    #[command(flatten)]
    dataset: DatasetChoice,
    /// Names of drives; without it all.
    #[arg(long = "scene", value_name = "NAME")]
    scenes: Vec<String>,
    /// Also write LiDAR sweeps.
    #[arg(long)]
    lidar: bool,
    /// Also link or copy the recorded pictures.
    #[arg(long)]
    pictures: bool,
    /// Print a summary as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    /// TRoVE's own plain form: drive.jsonl (docs/plain-drive.md).
    Trove,
}

impl Export {
    /// Writes the drives.
    pub(crate) fn run(self) -> Result<()> {
        let Format::Trove = self.format;
        let report = Report::default();
        let source = self.dataset.open(&self.root, &report)?;
        let known: Vec<String> = source.drives().into_iter().map(|drive| drive.name).collect();
        if let Some(unknown) = self.scenes.iter().find(|name| !known.contains(name)) {
            let nearest = known.iter().min_by_key(|name| strsim::damerau_levenshtein(name, unknown));
            let hint = nearest.map(|name| format!("; did you mean {name:?}?")).unwrap_or_default();
            bail!("--scene: {} has no drive {unknown:?}{hint}", self.root.display());
        }
        let chosen: Vec<&String> = known.iter().filter(|n| self.scenes.is_empty() || self.scenes.contains(n)).collect();
        let files = PlainFiles { lidar: self.lidar, pictures: self.pictures };
        for name in &chosen {
            let drive = source.read(name, &report)?;
            let folder = self.out.join(name.as_str());
            write_plain_drive(&drive, &self.root, &folder, files, &report)
                .with_context(|| format!("{name}: not written"))?;
        }
        let report = ReportTable::from(&report);
        if self.json {
            let printed = json!({ "out": self.out, "drives": chosen, "report": report });
            println!("{}", serde_json::to_string_pretty(&printed)?);
        } else {
            println!("{} drives in {}", chosen.len(), self.out.display());
            print_entries(&report, "");
        }
        Ok(())
    }
}

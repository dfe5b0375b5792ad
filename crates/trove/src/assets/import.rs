//! `trove assets import`.

use std::path::Path;

use anyhow::Result;
use serde_json::{Value, json};
use trove_model::{Outcome, Report};
use trove_read::asset_files::{self, AssetEntry, FILE_NAME};

use crate::message::shown;

/// Below it a guess is worth a look.
const UNSURE: f32 = 0.7;

/// Writes or completes a folder's `library.toml` and prints what it holds.
pub(crate) fn run(dir: &Path, as_json: bool) -> Result<()> {
    let report = Report::default();
    let file = asset_files::import(dir, &report)?;
    let written = dir.join(FILE_NAME);
    let dropped: Vec<_> = report.entries().into_iter().filter(|e| e.outcome == Outcome::Dropped).collect();
    if as_json {
        let assets: Vec<Value> = file.assets.iter().map(asset).collect();
        let left_out: Vec<Value> =
            dropped.iter().map(|e| json!({ "what": e.what, "count": e.count, "examples": e.examples })).collect();
        let printed = json!({
            "library": written,
            "assets": assets,
            "surfaces": file.surfaces.iter().map(|s| &s.name).collect::<Vec<_>>(),
            "environments": file.environments.iter().map(|e| &e.file).collect::<Vec<_>>(),
            "left_out": left_out,
        });
        println!("{}", serde_json::to_string_pretty(&printed)?);
        return Ok(());
    }
    for entry in &file.assets {
        let size = entry.size_m.map_or(String::new(), |s| format!("{:.2} × {:.2} × {:.2} m", s.x, s.y, s.z));
        let kind = entry.kind.as_deref().unwrap_or("?");
        let least = entry.guesses.iter().map(|g| g.confidence).fold(1.0, f32::min);
        println!("{:44} {kind:22} {size:26} {:3.0} % sure", shown(&entry.file), least * 100.0);
        for guess in entry.guesses.iter().filter(|g| g.confidence < UNSURE) {
            let guessed =
                format!("    {} = {} ({:.0} %: {})", guess.key, guess.value, guess.confidence * 100.0, guess.reason);
            println!("{}", shown(&guessed));
        }
    }
    for entry in dropped {
        println!("{} left out: {}, such as {}", entry.count, entry.what, entry.examples.join("; "));
    }
    println!(
        "{} models, {} texture sets, {} skies; correct what is wrong in {}",
        file.assets.len(),
        file.surfaces.len(),
        file.environments.len(),
        written.display()
    );
    Ok(())
}

fn asset(entry: &AssetEntry) -> Value {
    let guesses: Vec<Value> = entry
        .guesses
        .iter()
        .map(|g| json!({ "key": g.key, "value": g.value, "confidence": g.confidence, "reason": g.reason }))
        .collect();
    json!({
        "file": entry.file,
        "part": entry.part,
        "kind": entry.kind,
        "tags": entry.tags,
        "size_m": entry.size_m.map(|s| s.to_array()),
        "licence": entry.licence,
        "guesses": guesses,
    })
}

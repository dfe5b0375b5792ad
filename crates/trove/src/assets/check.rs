//! `trove assets check`.

use std::path::{Path, PathBuf};

use anyhow::Result;
use serde_json::{Value, json};

use crate::library::user;
use crate::message::shown;

/// Prints what is wrong with a library and returns the exit status; people's bodies are looked for in `search`.
pub(crate) fn run(dir: &Path, as_json: bool, search: &[PathBuf]) -> Result<i32> {
    let findings = user::check(dir, search);
    let severe = findings.iter().filter(|finding| finding.severe).count();
    if as_json {
        let rows: Vec<Value> = findings
            .iter()
            .map(|f| json!({ "file": f.file, "severe": f.severe, "what": f.what, "remedy": f.remedy }))
            .collect();
        println!("{}", serde_json::to_string_pretty(&json!({ "findings": rows, "severe": severe }))?);
    } else {
        for finding in &findings {
            let mark = if finding.severe { "error" } else { "warning" };
            println!("{}", shown(&format!("{mark}: {}: {}; {}", finding.file, finding.what, finding.remedy)));
        }
        println!("{} findings, {severe} of them about things that cannot be used", findings.len());
    }
    Ok(i32::from(severe > 0))
}

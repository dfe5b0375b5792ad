//! `trove verify`: whether an output folder still is as it was written.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::{Result, bail, ensure};
use rayon::prelude::*;
use serde::Serialize;
use trove_format::{FrameLine, Manifest, WrittenFile};
use trove_judge::page::{Column, Page, Table};
use trove_write::write_atomically;

use crate::answer::Answer;
use crate::progress::Progress;
use crate::run::{PRIVATE, is_whole};
use crate::watch::Watch;

/// What was found.
#[derive(Debug, Default, PartialEq, Serialize)]
struct Findings {
    /// Finished frames and sweeps.
    frames: usize,
    /// Their files.
    files: usize,
    /// Files that are missing or hold other bytes than were written, below the folder.
    damaged: Vec<String>,
    /// Frames that the manifest and the journal do not tell alike.
    unlisted: Vec<String>,
}

/// Reads every file of every finished frame; the status is 1 where one is not as it was written. Changes nothing, and
/// writes a page where one is named.
///
/// # Errors
/// A folder that no run has written, or whose manifest or journal cannot be read; a page that cannot be written.
pub(crate) fn run(folder: &Path, page: Option<&Path>, as_json: bool, watch: &Watch) -> Result<Answer> {
    let (findings, page) = (look(folder, watch)?, page.map(Path::to_owned));
    if let Some(page) = &page {
        write_atomically(page, report(folder, &findings).as_bytes())?;
    }
    let is_sound = findings.damaged.is_empty() && findings.unlisted.is_empty();
    let tell = move |findings: &Findings| {
        findings.damaged.iter().for_each(|file| println!("damaged: {file}"));
        findings.unlisted.iter().for_each(|frame| println!("not told alike by the manifest and the journal: {frame}"));
        if is_sound {
            println!("{} frames, {} files, all as they were written", findings.frames, findings.files);
        } else {
            println!("run trove generate on this folder again: it renders what is damaged");
        }
        page.iter().for_each(|page| println!("see {}", page.display()));
    };
    let json = serde_json::to_value(&findings)?;
    Ok(Answer::new(as_json, json, move || tell(&findings)).with_status(i32::from(!is_sound)))
}

/// A page about a folder, as HTML.
fn report(folder: &Path, findings: &Findings) -> String {
    let Findings { frames, files, damaged, unlisted } = findings;
    let name = folder.file_name().unwrap_or(folder.as_os_str()).to_string_lossy();
    let mut page = Page::new(&format!("Files of {name}"));
    let count = |name, count: usize, more: &str| (name, count.to_string(), more.to_owned());
    page.facts([
        count("Frames", *frames, "and sweeps, finished"),
        count("Files", *files, "read and hashed"),
        count("Damaged", damaged.len(), "files"),
        count("Unlisted", unlisted.len(), "frames"),
    ]);
    page.text(
        "Every file of every finished frame was compared with the length and the hash (SHA-256) that were written down for \
         it, and the manifest with the journal.",
    );
    if damaged.is_empty() && unlisted.is_empty() {
        page.text("All are as they were written.");
        return page.html();
    }
    page.text("trove generate on this folder renders again what is damaged.");
    page.section("Findings");
    let mut table = Table::new(["file or frame", "found"].map(Column::words));
    for path in damaged {
        let found = if folder.join(path).is_file() { "other bytes than were written" } else { "no file" };
        table.row([path, found].map(Into::into));
    }
    for frame in unlisted {
        table.row([frame, "not told alike by the manifest and the journal"].map(Into::into));
    }
    page.table("Findings", &table);
    page.html()
}

fn look(folder: &Path, watch: &Watch) -> Result<Findings> {
    let private = folder.join(PRIVATE);
    if !private.is_dir() {
        bail!("{}: expected an output folder of trove generate, found no {PRIVATE} in it", folder.display());
    }
    let journal = FrameLine::journal(&private)?;
    let progress = Progress::new(journal.len(), watch);
    let damaged = |(frame, files): (&String, &Vec<WrittenFile>)| -> Result<Vec<String>> {
        ensure!(!watch.stops(), "ended before every file was read");
        let wrong = files.iter().filter(|file| !is_whole(&folder.join(frame), file));
        let wrong = wrong.map(|file| format!("{frame}/{}", file.name)).collect();
        progress.frame_done();
        Ok(wrong)
    };
    let damaged: Vec<Vec<String>> = journal.par_iter().map(damaged).collect::<Result<_>>()?;
    progress.finish();
    // An unfinished run has no manifest yet.
    let manifest = Manifest::read(folder)?;
    let lists =
        manifest.iter().flat_map(|manifest| [&manifest.frames, &manifest.sweeps, &manifest.radars, &manifest.grids]);
    let rows: Vec<_> = lists.flatten().collect();
    let told_alike = |row: &&&trove_format::FrameRow| {
        let files = journal.get(&row.path).map_or(&[][..], Vec::as_slice);
        files.len() == row.files.len() && files.iter().all(|file| row.files.get(&file.name) == Some(&file.sha256))
    };
    let unlisted: BTreeSet<String> = rows.iter().filter(|row| !told_alike(row)).map(|row| row.path.clone()).collect();
    Ok(Findings {
        frames: journal.len(),
        files: journal.values().map(Vec::len).sum(),
        damaged: damaged.concat(),
        unlisted: unlisted.into_iter().collect(),
    })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use trove_format::JournalLine;

    #[test]
    fn a_file_that_is_missing_shorter_or_other_is_found() {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path();
        let look = |root: &Path| super::look(root, &Watch::default());
        assert!(look(root).unwrap_err().to_string().contains("expected an output folder"));
        fs::create_dir_all(root.join(PRIVATE)).unwrap();
        let frame = root.join("s/v00/k000/ego.A");
        fs::create_dir_all(&frame).unwrap();
        let files: Vec<WrittenFile> = ["a", "b", "c", "d"]
            .map(|name| {
                fs::write(frame.join(name), "abc").unwrap();
                let sha256 = trove_write::sha256_file(&frame.join(name)).unwrap();
                WrittenFile { name: name.into(), sha256, bytes: 3 }
            })
            .to_vec();
        let line = FrameLine { frame: "s/v00/k000/ego.A".into(), files };
        fs::write(root.join(PRIVATE).join(FrameLine::JOURNAL), JournalLine::Frame(line).to_json()).unwrap();
        let sound = Findings { frames: 1, files: 4, ..Findings::default() };
        assert_eq!(look(root).unwrap(), sound);
        fs::write(frame.join("a"), "ab").unwrap();
        fs::write(frame.join("b"), "abd").unwrap();
        fs::remove_file(frame.join("c")).unwrap();
        let damaged = ["a", "b", "c"].map(|name| format!("s/v00/k000/ego.A/{name}")).to_vec();
        assert_eq!(look(root).unwrap(), Findings { damaged, ..sound });
        let page = report(root, &look(root).unwrap());
        assert!(page.contains("<dt>Damaged</dt><dd>3</dd>"), "{page}");
        let row = |file: &str, found: &str| format!("ego.A/{file}</th><td class=\"words\">{found}</td>");
        assert!(
            page.contains(&row("b", "other bytes than were written")) && page.contains(&row("c", "no file")),
            "{page}"
        );
    }
}

//! The folder that a run writes to: one recipe, one run at a time, and which frames are finished.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};
use trove_write::{WrittenFile, sha256_file, write_atomically};

/// Holds what only trove reads: the run's identity, its lock and the journal of finished frames.
pub(crate) const PRIVATE: &str = ".trove";

/// An output folder that this process alone writes to.
pub(super) struct OutputFolder {
    root: PathBuf,
    journal: File,
    finished: BTreeMap<String, Vec<WrittenFile>>,
    _lock: File,
}

/// A line of the journal.
#[derive(Serialize, Deserialize)]
struct Row {
    frame: String,
    files: Vec<FileRow>,
}

#[derive(Serialize, Deserialize)]
struct FileRow {
    name: String,
    sha256: String,
    bytes: u64,
}

impl OutputFolder {
    /// Opens or makes the folder. `identity` is everything that decides the output's bytes: a folder that was begun
    /// with another one is refused, and so is one that holds something else, or that another run is writing to.
    pub(super) fn open(root: &Path, identity: &serde_json::Value) -> Result<Self> {
        let private = root.join(PRIVATE);
        refuse_foreign(root)?;
        std::fs::create_dir_all(&private)
            .with_context(|| format!("{}: expected a folder that can be made and written to", root.display()))?;
        let lock = lock(&private.join("lock"))?;
        check_identity(root, &private.join("run.json"), identity)?;
        let path = private.join("frames.jsonl");
        let finished = read_journal(&path)?;
        let mut journal = OpenOptions::new()
            .create(true)
            .append(true)
            .open(&path)
            .with_context(|| format!("{}: expected a file that can be written", path.display()))?;
        journal.write_all(b"\n")?; // ends a line that an interrupted run may have left torn
        Ok(Self { root: root.to_owned(), journal, finished, _lock: lock })
    }

    pub(super) fn root(&self) -> &Path {
        &self.root
    }

    /// The files of a frame that is finished, whole and on disk; `None` where it has to be rendered.
    pub(super) fn finished(&mut self, frame: &str, expected: &[&str]) -> Result<Option<Vec<WrittenFile>>> {
        let folder = self.root.join(frame);
        if !folder.is_dir() {
            return Ok(None);
        }
        if let Some(files) = self.finished.get(frame) {
            let whole = |file: &WrittenFile| {
                std::fs::metadata(folder.join(&file.name)).is_ok_and(|found| found.len() == file.bytes)
            };
            return Ok(files.iter().all(whole).then(|| files.clone()));
        }
        // The folder was put in place, but the run ended before it was written down.
        let mut files = Vec::new();
        for name in expected {
            let path = folder.join(name);
            let Ok(found) = std::fs::metadata(&path) else { return Ok(None) };
            files.push(WrittenFile { name: (*name).to_owned(), sha256: sha256_file(&path)?, bytes: found.len() });
        }
        files.sort_by(|a, b| a.name.cmp(&b.name));
        self.record(frame, &files)?;
        Ok(Some(files))
    }

    /// Writes down that a frame is finished.
    pub(super) fn record(&mut self, frame: &str, files: &[WrittenFile]) -> Result<()> {
        let row = |f: &WrittenFile| FileRow { name: f.name.clone(), sha256: f.sha256.clone(), bytes: f.bytes };
        let row = Row { frame: frame.to_owned(), files: files.iter().map(row).collect() };
        let line = serde_json::to_string(&row)? + "\n";
        self.journal
            .write_all(line.as_bytes())
            .with_context(|| format!("{}: the journal of finished frames cannot be written", self.root.display()))?;
        self.finished.insert(frame.to_owned(), files.to_vec());
        Ok(())
    }
}

/// An error where the folder holds something that is not of an earlier run.
pub(crate) fn refuse_foreign(root: &Path) -> Result<()> {
    if root.join(PRIVATE).exists() || !root.exists() {
        return Ok(());
    }
    let mut entries =
        std::fs::read_dir(root).with_context(|| format!("{}: expected a folder to write to", root.display()))?;
    ensure!(
        entries.next().is_none(),
        "{}: expected an empty folder or one of an earlier run, found other files; choose another --out",
        root.display()
    );
    Ok(())
}

fn lock(path: &Path) -> Result<File> {
    let file = OpenOptions::new()
        .create(true)
        .truncate(false)
        .write(true)
        .open(path)
        .with_context(|| format!("{}: expected a file that can be written", path.display()))?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => {
            bail!("{}: another run is writing to this folder; wait for it or choose another --out", path.display())
        }
        // Some network file systems have no locks; then it is on the user to run only one.
        Err(TryLockError::Error(error)) => {
            tracing::warn!("{}: cannot be locked ({error}); do not run twice on this folder", path.display());
            Ok(file)
        }
    }
}

fn check_identity(root: &Path, path: &Path, identity: &serde_json::Value) -> Result<()> {
    let text = serde_json::to_string_pretty(identity)?;
    match std::fs::read_to_string(path) {
        Err(_) => Ok(write_atomically(path, text.as_bytes())?),
        Ok(found) if found == text => Ok(()),
        Ok(found) => {
            let differs = found.lines().zip(text.lines()).find(|(a, b)| a != b);
            let (was, is) = differs.unwrap_or(("", ""));
            bail!(
                "{}: expected the recipe and program that this folder was begun with, found others (it was {}, it is \
                 {}); choose another --out",
                root.display(),
                was.trim().trim_end_matches(','),
                is.trim().trim_end_matches(',')
            )
        }
    }
}

/// Rows of the journal; a torn or foreign line is passed over, for its frame is then looked at on disk.
fn read_journal(path: &Path) -> Result<BTreeMap<String, Vec<WrittenFile>>> {
    if !path.exists() {
        return Ok(BTreeMap::new());
    }
    let bytes = std::fs::read(path).with_context(|| path.display().to_string())?;
    let rows = bytes.split(|&b| b == b'\n').filter_map(|line| serde_json::from_slice::<Row>(line).ok());
    let file = |f: FileRow| WrittenFile { name: f.name, sha256: f.sha256, bytes: f.bytes };
    Ok(rows.map(|row| (row.frame, row.files.into_iter().map(file).collect())).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_frame_that_was_put_in_place_but_not_written_down_is_finished() {
        let dir = tempfile::tempdir().unwrap();
        let mut out = OutputFolder::open(&dir.path().join("out"), &json!({"seed": 1})).unwrap();
        assert_eq!(out.finished("s/v00/k000/ego.A", &["a"]).unwrap().map(|f| f.len()), None);
        let folder = out.root().join("s/v00/k000/ego.A");
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("a"), "abc").unwrap();
        let files = out.finished("s/v00/k000/ego.A", &["a"]).unwrap().unwrap();
        assert!(files[0].sha256.starts_with("ba7816bf"), "SHA-256 of abc, FIPS 180-2");
        std::fs::write(folder.join("a"), "ab").unwrap();
        assert!(out.finished("s/v00/k000/ego.A", &["a"]).unwrap().is_none(), "a shortened file is not finished");
    }

    #[test]
    fn another_recipe_another_run_and_foreign_files_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path().join("out");
        let first = OutputFolder::open(&root, &json!({"seed": 1})).unwrap();
        let message = OutputFolder::open(&root, &json!({"seed": 1})).err().unwrap().to_string();
        assert!(message.contains("another run"), "{message}");
        drop(first);
        let message = OutputFolder::open(&root, &json!({"seed": 2})).err().unwrap().to_string();
        assert!(message.contains("\"seed\": 1") && message.contains("\"seed\": 2"), "{message}");
        assert!(OutputFolder::open(&root, &json!({"seed": 1})).is_ok());
        std::fs::write(dir.path().join("note.txt"), "mine").unwrap();
        assert!(OutputFolder::open(dir.path(), &json!({"seed": 1})).is_err());
    }
}

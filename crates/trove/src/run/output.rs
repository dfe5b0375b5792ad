//! The folder that a run writes to: one recipe, one run at a time, and which frames are finished.

use std::collections::BTreeSet;
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use trove_files::{FolderLock, OutputRoot};
use trove_format::{FrameLine, Journal, LanesFile, RunIdentity, SiteFile, TrajectoryFile, WrittenFile};
use trove_write::{sha256_file, write_atomically};

use super::identity::differences;

/// Holds what only trove reads: the run's identity, its lock and the journal of finished frames.
pub(crate) const PRIVATE: &str = ".trove";

/// An output folder that this process alone writes to.
pub(super) struct OutputFolder {
    root: OutputRoot,
    journal: File,
    finished: Journal,
    /// Finished frames whose files this run has read or written.
    verified: BTreeSet<String>,
    _lock: FolderLock,
}

impl OutputFolder {
    /// Opens or makes the folder. `identity` is everything that decides the output's bytes: a folder that was begun
    /// with another one is refused, and so is one that holds something else, or that another run is writing to.
    pub(super) fn open(root: &Path, identity: &RunIdentity) -> Result<Self> {
        let private = root.join(PRIVATE);
        refuse_foreign(root)?;
        std::fs::create_dir_all(&private)
            .with_context(|| format!("{}: expected a folder that can be created and written to", root.display()))?;
        let lock = lock(&private.join("lock"))?;
        check_identity(root, &private, identity)?;
        let path = private.join(FrameLine::JOURNAL);
        let finished = FrameLine::journal(&private)?;
        let mut journal = OpenOptions::new()
            .create(true)
            .append(true)
            .open(&path)
            .with_context(|| format!("{}: expected a file that can be written", path.display()))?;
        journal.write_all(b"\n")?; // ends a line that an interrupted run may have left torn
        Ok(Self { root: OutputRoot::new(root), journal, finished, verified: BTreeSet::new(), _lock: lock })
    }

    /// What was built for a variation of a scene by an earlier run; `None` where nothing was.
    pub(super) fn site(&self, folder: &str) -> Result<Option<SiteFile>> {
        Ok(SiteFile::read(&self.root.at(folder)?)?)
    }

    /// Writes down what was built for a variation of a scene, its lanes, and the way of the vehicle in it.
    pub(super) fn write_site(
        &self,
        folder: &str,
        site: &SiteFile,
        way: &TrajectoryFile,
        lanes: &LanesFile,
    ) -> Result<()> {
        let folder = self.root.at(folder)?;
        std::fs::create_dir_all(&folder)
            .with_context(|| format!("{}: expected a folder that can be created", folder.display()))?;
        write_atomically(&folder.join(TrajectoryFile::NAME), &way.to_json())?;
        write_atomically(&folder.join(LanesFile::NAME), &lanes.to_json())?;
        Ok(write_atomically(&folder.join(SiteFile::NAME), &site.to_json())?)
    }

    /// The files of a frame that is finished, whole and on disk; `None` where it has to be rendered.
    pub(super) fn finished(&mut self, frame: &str, expected: &[&str]) -> Result<Option<Vec<WrittenFile>>> {
        let folder = self.root.at(frame)?;
        if !folder.is_dir() {
            return Ok(None);
        }
        if let Some(files) = self.finished.get(frame) {
            let files = files.clone();
            // The recipe asks for more files now; what is there is replaced once the frame is rendered again.
            if !expected.iter().all(|name| files.iter().any(|file| file.name == *name)) {
                self.finished.remove(frame);
                return Ok(None);
            }
            // Bytes are read once a run; that nothing is missing is cheap to see.
            let whole = if self.verified.contains(frame) { has_length } else { is_whole };
            let damaged: Vec<&WrittenFile> = files.iter().filter(|file| !whole(&folder, file)).collect();
            if damaged.is_empty() {
                self.verified.insert(frame.to_owned());
                return Ok(Some(files));
            }
            for WrittenFile { name, .. } in damaged {
                tracing::warn!("{frame}/{name}: not as it was written; the frame is rendered again");
                // Without it the frame is one that is not finished, which is replaced once it is.
                if let Err(error) = std::fs::remove_file(folder.join(name))
                    && error.kind() != ErrorKind::NotFound
                {
                    bail!("{}: expected a file that can be replaced: {error}", folder.join(name).display());
                }
            }
            // Said once.
            self.finished.remove(frame);
            return Ok(None);
        }
        // The folder was put in place, but the run ended before it was written down.
        let mut files = Vec::new();
        for name in expected {
            let path = folder.join(name);
            let Ok(found) = std::fs::metadata(&path) else { return Ok(None) };
            files.push(WrittenFile { name: (*name).to_owned(), sha256: sha256_file(&path)?, bytes: found.len() });
        }
        files.sort_by(|a, b| a.name.cmp(&b.name));
        self.record(frame, files.clone())?;
        Ok(Some(files))
    }

    /// Writes down that a frame is finished.
    pub(super) fn record(&mut self, frame: &str, files: Vec<WrittenFile>) -> Result<()> {
        let line = FrameLine { frame: frame.to_owned(), files };
        self.journal.write_all(&line.to_json()).with_context(|| {
            format!("{}: the journal of finished frames cannot be written", self.root.path().display())
        })?;
        self.verified.insert(line.frame.clone());
        self.finished.insert(line.frame, line.files);
        Ok(())
    }
}

/// Whether a file of a frame holds the bytes that were written.
pub(crate) fn is_whole(folder: &Path, file: &WrittenFile) -> bool {
    has_length(folder, file) && sha256_file(&folder.join(&file.name)).is_ok_and(|found| found == file.sha256)
}

fn has_length(folder: &Path, file: &WrittenFile) -> bool {
    std::fs::metadata(folder.join(&file.name)).is_ok_and(|found| found.is_file() && found.len() == file.bytes)
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

fn lock(path: &Path) -> Result<FolderLock> {
    let lock = FolderLock::take(path).map_err(|error| match error.kind() {
        ErrorKind::WouldBlock => {
            anyhow!("{}: another run is writing to this folder; wait for it or choose another --out", path.display())
        }
        _ => anyhow!("{}: expected a file that can be written: {error}", path.display()),
    })?;
    if let Some(error) = &lock.unsupported {
        // Then it is on the user to run only one.
        tracing::warn!("{}: cannot be locked ({error}); do not run twice on this folder", path.display());
    }
    Ok(lock)
}

fn check_identity(root: &Path, private: &Path, identity: &RunIdentity) -> Result<()> {
    let path = private.join(RunIdentity::NAME);
    let found = RunIdentity::read(private).context("the folder cannot be resumed; choose another --out")?;
    match &found {
        Some(found) => {
            let differences = differences(found, identity);
            ensure!(
                differences.is_empty(),
                "{}: expected the recipe, inputs and program that this folder was started with, found others: {}; \
                 choose another --out",
                root.display(),
                differences.join("; ")
            );
        }
        None => ensure!(
            FrameLine::journal(private)?.is_empty(),
            "{}: expected the file beside {}, which says what these frames were made from, found none; \
             choose another --out",
            path.display(),
            FrameLine::JOURNAL
        ),
    }
    if found.as_ref() != Some(identity) {
        // It goes on with more frames.
        write_atomically(&path, &identity.to_json())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use trove_format::{Inputs, Versions};

    fn identity(seed: u64) -> RunIdentity {
        let versions = Versions {
            trove: "0".into(),
            build: "0".into(),
            assets: vec!["a".into()],
            kernel: "obvhs".into(),
            denoiser: None,
        };
        RunIdentity::new(json!({ "seed": seed }), versions, Inputs::new())
    }

    #[test]
    fn a_frame_that_was_put_in_place_but_not_written_down_is_finished() {
        let dir = tempfile::tempdir().unwrap();
        let mut out = OutputFolder::open(&dir.path().join("out"), &identity(1)).unwrap();
        assert_eq!(out.finished("s/v00/k000/ego.A", &["a"]).unwrap().map(|f| f.len()), None);
        let folder = dir.path().join("out/s/v00/k000/ego.A");
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("a"), "abc").unwrap();
        let files = out.finished("s/v00/k000/ego.A", &["a"]).unwrap().unwrap();
        assert!(files[0].sha256.starts_with("ba7816bf"), "SHA-256 of abc, FIPS 180-2");
        std::fs::write(folder.join("a"), "ab").unwrap();
        assert!(out.finished("s/v00/k000/ego.A", &["a"]).unwrap().is_none(), "a shortened file is not finished");
    }

    #[test]
    fn a_finished_frame_whose_bytes_have_changed_is_to_be_rendered_again() {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path().join("out");
        let folder = root.join("s/v00/k000/ego.A");
        for damage in ["ab", "abd"] {
            let mut out = OutputFolder::open(&root, &identity(1)).unwrap();
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(folder.join("a"), "abc").unwrap();
            std::fs::write(folder.join("b"), "b").unwrap();
            assert!(out.finished("s/v00/k000/ego.A", &["a", "b"]).unwrap().is_some());
            drop(out);
            std::fs::write(folder.join("a"), damage).unwrap();
            let mut out = OutputFolder::open(&root, &identity(1)).unwrap();
            assert!(out.finished("s/v00/k000/ego.A", &["a", "b"]).unwrap().is_none(), "{damage}");
            // What is left is in nobody's way.
            assert!(!folder.join("a").exists() && folder.join("b").exists());
        }
    }

    #[test]
    fn another_recipe_another_run_and_foreign_files_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path().join("out");
        let first = OutputFolder::open(&root, &identity(1)).unwrap();
        let message = OutputFolder::open(&root, &identity(1)).err().unwrap().to_string();
        assert!(message.contains("another run"), "{message}");
        drop(first);
        let message = OutputFolder::open(&root, &identity(2)).err().unwrap().to_string();
        assert!(message.contains("seed was 1, is 2"), "{message}");
        assert!(OutputFolder::open(&root, &identity(1)).is_ok());
        std::fs::write(root.join(PRIVATE).join(RunIdentity::NAME), r#"{"recipe": {}, "versions": {}}"#).unwrap();
        let message = format!("{:#}", OutputFolder::open(&root, &identity(1)).err().unwrap());
        assert!(message.contains("expected format 2, found none") && message.contains("--out"), "{message}");
        std::fs::write(dir.path().join("note.txt"), "mine").unwrap();
        assert!(OutputFolder::open(dir.path(), &identity(1)).is_err());
    }
}

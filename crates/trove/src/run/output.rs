//! The folder that a run writes to: one recipe, one run at a time or parts of one, and which frames are finished.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{Context, Result, anyhow, bail, ensure};
use rayon::prelude::*;
use trove_files::{FolderLock, LARGEST_TEXT, OutputRoot, read_text, write_new};
use trove_format::{FrameLine, JournalLine, LanesFile, PlanLine, RunIdentity, SiteFile, TrajectoryFile, WrittenFile};
use trove_write::{Maker, sha256_file, write_atomically};

use super::identity::differences;
use super::journals::{Journals, is_empty};
use super::share::Share;

/// Holds what only trove reads: the run's identity, its lock and the journal of finished frames.
pub(crate) const PRIVATE: &str = ".trove";
/// Below it, a folder a share: its lock and its journal.
const PARTS: &str = "parts";
/// And the path of the recipe, as this machine reaches it.
const RECIPE_FILE: &str = "recipe";

/// An output folder that this process alone writes to, or with other parts of the same run.
pub(super) struct OutputFolder {
    root: OutputRoot,
    journals: Journals,
    started_unix_s: u64,
    /// What was last written down of it.
    planned: Option<PlanLine>,
    /// What makes its frames.
    pub(super) maker: Maker,
    _locks: Vec<FolderLock>,
}

impl OutputFolder {
    /// Opens or makes the folder. `identity` is everything that decides the output's bytes: a folder that was begun
    /// with another one is refused, and so is one that holds something else, or that another run is writing to. A part
    /// shares the folder with the others; a whole run takes over what parts have finished.
    pub(super) fn open(root: &Path, identity: &RunIdentity, share: Option<Share>) -> Result<Self> {
        let private = root.join(PRIVATE);
        refuse_foreign(root)?;
        let made = |folder: &Path| {
            std::fs::create_dir_all(folder)
                .with_context(|| format!("{}: expected a folder that can be created and written to", root.display()))
        };
        made(&private)?;
        let whole = private.join("lock");
        let mut folder = private.clone();
        let (maker, locks) = match share {
            None => (Maker::Alone, vec![lock(&whole, FolderLock::take(&whole), "another run, or a part of one,")?]),
            Some(share) => {
                let shared = lock(&whole, FolderLock::share(&whole), "a run of all frames")?;
                folder = private.join(PARTS).join(share.folder());
                made(&folder)?;
                let part = folder.join("lock");
                let locks =
                    vec![shared, lock(&part, FolderLock::take(&part), &format!("another worker on part {share}"))?];
                // Where nobody can be held off, two workers on one part must not write into each other's files.
                let is_held_off = locks.iter().all(|lock| lock.unsupported.is_none());
                let worker = if is_held_off { String::new() } else { format!(".{}-{}", std::process::id(), now_ns()) };
                (Maker::Among(share.folder() + &worker), locks)
            }
        };
        check_identity(root, &private, identity)?;
        let journal = private.join(FrameLine::JOURNAL);
        let journals = match share {
            None => {
                let parts = part_folders(root)?;
                let mut journals = Journals::open(journal, Vec::new())?;
                adopt(&mut journals, &parts)?;
                journals
            }
            Some(_) => Journals::open(folder.join(FrameLine::JOURNAL), vec![journal])?,
        };
        let started_unix_s = now_ns() as u64 / 1_000_000_000;
        Ok(Self { root: OutputRoot::new(root), journals, started_unix_s, planned: None, maker, _locks: locks })
    }

    /// Writes down how many frames are going to be made, of how many of the whole recipe.
    pub(super) fn plan(&mut self, planned: u64, of: u64) -> Result<()> {
        let plan = PlanLine { planned, of, started_unix_s: self.started_unix_s };
        if self.planned != Some(plan) {
            self.planned = Some(plan);
            self.journals.write(JournalLine::Plan(plan))?;
        }
        Ok(())
    }

    /// Writes down where the recipe lies.
    pub(super) fn write_recipe_file(&self, recipe: &Path) -> Result<()> {
        let path = self.root.path().join(PRIVATE).join(RECIPE_FILE);
        // A path that is no text is not remembered.
        match std::path::absolute(recipe)?.to_str() {
            Some(recipe) if !path.exists() => Ok(write_atomically(&path, recipe.as_bytes())?),
            _ => Ok(()),
        }
    }

    /// A path below the folder.
    pub(super) fn at(&self, path: &str) -> Result<PathBuf> {
        Ok(self.root.at(path)?)
    }

    /// Whether a frame is written down with the same files.
    pub(super) fn knows(&mut self, line: &FrameLine) -> Result<bool> {
        Ok(self.journals.get(&line.frame)?.is_some_and(|(files, _)| files == line.files))
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

    /// Reads the files of those frames that have a line in a journal and were not looked at yet, several at once.
    pub(super) fn verify(&mut self, frames: &[String]) -> Result<()> {
        let mut unread = Vec::new();
        for frame in frames {
            if let Some((files, false)) = self.journals.get(frame)? {
                unread.push((frame, self.root.at(frame)?, files));
            }
        }
        let is_sound = |(frame, folder, files): &(&String, PathBuf, Vec<WrittenFile>)| {
            files.iter().all(|file| is_whole(folder, file)).then(|| (*frame).clone())
        };
        let sound: Vec<String> = unread.par_iter().filter_map(is_sound).collect();
        sound.iter().for_each(|frame| self.journals.verified(frame));
        Ok(())
    }

    /// The files of a frame that is finished, whole and on disk; `None` where it has to be rendered.
    pub(super) fn finished(&mut self, frame: &str, expected: &[&str]) -> Result<Option<Vec<WrittenFile>>> {
        let folder = self.root.at(frame)?;
        if !folder.is_dir() {
            return Ok(None);
        }
        if let Some((files, verified)) = self.journals.get(frame)? {
            // Bytes are read once a run; that nothing is missing is cheap to see.
            let whole = if verified { has_length } else { is_whole };
            let damaged: Vec<&WrittenFile> = files.iter().filter(|file| !whole(&folder, file)).collect();
            if !damaged.is_empty() {
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
                self.journals.forget(frame);
                return Ok(None);
            }
            if expected.iter().all(|name| files.iter().any(|file| file.name == *name)) {
                self.journals.verified(frame);
                if self.journals.is_elsewhere(frame) {
                    // A part's own journal tells how much of it is done.
                    self.record(frame, files.clone())?;
                }
                return Ok(Some(files));
            }
            // The recipe asks for more files now. Unless another part has made them since, what is there is replaced once
            // the frame is rendered again.
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
        self.journals.write(JournalLine::Frame(FrameLine { frame: frame.to_owned(), files }))
    }
}

/// The recipe that a folder was begun with.
pub(crate) fn begun_with(root: &Path) -> Result<PathBuf> {
    let path = root.join(PRIVATE).join(RECIPE_FILE);
    let found = read_text(&path, LARGEST_TEXT).ok().map(PathBuf::from).filter(|recipe| recipe.is_file());
    found.with_context(|| {
        format!(
            "{}: expected the path of the recipe that the folder was begun with, found none; give --recipe",
            path.display()
        )
    })
}

/// Nanoseconds since 1970 UTC.
fn now_ns() -> u128 {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos()
}

/// The folders of a run's parts, in the order of their numbers.
pub(crate) fn part_folders(root: &Path) -> Result<Vec<(Share, PathBuf)>> {
    let parts = root.join(PRIVATE).join(PARTS);
    let entries = match std::fs::read_dir(&parts) {
        Ok(entries) => entries,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => bail!("{}: expected a folder that can be read: {error}", parts.display()),
    };
    let part = |entry: std::fs::DirEntry| Some((Share::of_folder(entry.file_name().to_str()?)?, entry.path()));
    let mut found: Vec<_> = entries.flatten().filter_map(part).collect();
    found.sort();
    Ok(found)
}

/// Writes the lines of parts into the run's own journal; then their folders are not needed any more.
fn adopt(journals: &mut Journals, parts: &[(Share, PathBuf)]) -> Result<()> {
    for (_, part) in parts {
        let mut lines = Vec::new();
        FrameLine::each(&part.join(FrameLine::JOURNAL), |line, _| lines.push(line))?;
        for line in lines {
            if let JournalLine::Frame(FrameLine { frame, files }) = line {
                // A part's line is the later one.
                if journals.get(&frame)?.is_none_or(|(known, _)| known != files) {
                    journals.adopt(FrameLine { frame, files })?;
                }
            }
        }
    }
    journals.sync()?;
    if let Some(parts) = parts.first().and_then(|(_, part)| part.parent()) {
        std::fs::remove_dir_all(parts)
            .with_context(|| format!("{}: expected a folder that can be removed", parts.display()))?;
    }
    Ok(())
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

fn lock(path: &Path, lock: std::io::Result<FolderLock>, who: &str) -> Result<FolderLock> {
    let lock = lock.map_err(|error| match error.kind() {
        ErrorKind::WouldBlock => {
            anyhow!("{}: {who} is writing to this folder; wait for it or choose another --out", path.display())
        }
        _ => anyhow!("{}: expected a file that can be written: {error}", path.display()),
    })?;
    if let Some(error) = &lock.unsupported {
        // Then it is on the user to merge only once all have ended.
        tracing::warn!("{}: cannot be locked ({error}); do not run twice on this folder", path.display());
    }
    Ok(lock)
}

fn check_identity(root: &Path, private: &Path, identity: &RunIdentity) -> Result<()> {
    let path = private.join(RunIdentity::NAME);
    let read = || RunIdentity::read(private).context("the folder cannot be resumed; choose another --out");
    let mut found = read()?;
    if found.is_none() {
        ensure!(
            is_empty(&private.join(FrameLine::JOURNAL))?,
            "{}: expected the file beside {}, which says what these frames were made from, found none; \
             choose another --out",
            path.display(),
            FrameLine::JOURNAL
        );
        // Of parts that start at once, the first says what the folder is of.
        write_new(&path, &identity.to_json()).with_context(|| path.display().to_string())?;
        found = read()?;
    }
    let found = found.with_context(|| format!("{}: removed while the run started", path.display()))?;
    let differences = differences(&found, identity);
    ensure!(
        differences.is_empty(),
        "{}: expected the recipe, inputs, program and kind of machine that this folder was started with, found others: {}; \
         choose another --out",
        root.display(),
        differences.join("; ")
    );
    if &found != identity {
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
            device: None,
        };
        RunIdentity::new(json!({ "seed": seed }), versions, Inputs::new())
    }

    #[test]
    fn a_frame_that_was_put_in_place_but_not_written_down_is_finished() {
        let dir = tempfile::tempdir().unwrap();
        let mut out = OutputFolder::open(&dir.path().join("out"), &identity(1), None).unwrap();
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
            let mut out = OutputFolder::open(&root, &identity(1), None).unwrap();
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(folder.join("a"), "abc").unwrap();
            std::fs::write(folder.join("b"), "b").unwrap();
            assert!(out.finished("s/v00/k000/ego.A", &["a", "b"]).unwrap().is_some());
            drop(out);
            std::fs::write(folder.join("a"), damage).unwrap();
            let mut out = OutputFolder::open(&root, &identity(1), None).unwrap();
            assert!(out.finished("s/v00/k000/ego.A", &["a", "b"]).unwrap().is_none(), "{damage}");
            // What is left is in nobody's way.
            assert!(!folder.join("a").exists() && folder.join("b").exists());
        }
    }

    #[test]
    fn another_recipe_another_run_and_foreign_files_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path().join("out");
        let first = OutputFolder::open(&root, &identity(1), None).unwrap();
        let message = OutputFolder::open(&root, &identity(1), None).err().unwrap().to_string();
        assert!(message.contains("another run"), "{message}");
        drop(first);
        let message = OutputFolder::open(&root, &identity(2), None).err().unwrap().to_string();
        assert!(message.contains("seed was 1, is 2"), "{message}");
        assert!(OutputFolder::open(&root, &identity(1), None).is_ok());
        std::fs::write(root.join(PRIVATE).join(RunIdentity::NAME), r#"{"recipe": {}, "versions": {}}"#).unwrap();
        let message = format!("{:#}", OutputFolder::open(&root, &identity(1), None).err().unwrap());
        assert!(message.contains("expected format 2, found none") && message.contains("--out"), "{message}");
        std::fs::write(dir.path().join("note.txt"), "mine").unwrap();
        assert!(OutputFolder::open(dir.path(), &identity(1), None).is_err());
    }

    #[test]
    fn parts_share_a_folder_and_a_whole_run_takes_over_what_they_have() {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path().join("out");
        let open = |share: Option<&str>, seed| {
            OutputFolder::open(&root, &identity(seed), share.map(|share| share.parse().unwrap()))
        };
        let refused = |share, seed| open(share, seed).err().unwrap().to_string();
        let mut first = open(Some("1/2"), 1).unwrap();
        let mut second = open(Some("2/2"), 1).unwrap();
        assert!(refused(Some("2/2"), 1).contains("another worker on part 2/2"));
        assert!(refused(None, 1).contains("a part of one"));
        assert!(refused(Some("1/3"), 2).contains("seed was 1, is 2"));
        let written = |bytes| vec![WrittenFile { name: "a".into(), sha256: "0".repeat(64), bytes }];
        first.record("s/v00/k000/ego.A", written(1)).unwrap();
        second.record("s/v00/k001/ego.A", written(2)).unwrap();
        drop((first, second));
        let mut whole = open(None, 1).unwrap();
        assert!(refused(Some("1/2"), 1).contains("a run of all frames"));
        assert!(part_folders(&root).unwrap().is_empty());
        let journal = FrameLine::journal(&root.join(PRIVATE)).unwrap();
        assert_eq!(journal.into_values().collect::<Vec<_>>(), [written(1), written(2)]);
        // Nothing is believed that is not there.
        assert!(whole.finished("s/v00/k000/ego.A", &["a"]).unwrap().is_none());
        drop(whole);
        assert!(open(Some("1/2"), 1).is_ok(), "a part that comes late");
    }
}

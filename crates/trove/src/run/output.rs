//! The folder that a run writes to: one recipe, one run at a time or parts of one, and which frames are finished.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail, ensure};
use rayon::prelude::*;
use trove_files::{FolderLock, LARGEST_TEXT, OutputRoot, read_text, write_new};
use trove_format::{FrameLine, JournalLine, LanesFile, PlanLine, RunIdentity, SiteFile, TrajectoryFile, WrittenFile};
use trove_write::{FrameFolders, Maker, sha256_file, write_atomically};

use super::identity::differences;
use super::journals::{Journals, is_empty};
use super::private::{PARTS, PRIVATE, now_ns};
use super::share::Share;
use super::stored::StoredFolder;
use crate::recipe::Recipe;
use crate::store;

/// And the path of the recipe, as this machine reaches it.
const RECIPE_FILE: &str = "recipe";

/// An output folder that this process alone writes to, or with other parts of the same run.
pub(super) struct OutputFolder {
    /// Where finished frames are sent to, where that is no folder.
    stored: Option<StoredFolder>,
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
    pub(super) fn open(out: &Path, identity: &RunIdentity, share: Option<Share>) -> Result<Self> {
        let stored = store::address(out).map(|address| StoredFolder::open(address, share)).transpose()?;
        let root = stored.as_ref().map_or(out, StoredFolder::working);
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
        check_identity(out, &private, identity)?;
        if let Some(stored) = &stored
            && !stored.share_identity()?
        {
            check_identity(out, &private, identity)?;
            stored.send_identity()?;
        }
        let journal = private.join(FrameLine::JOURNAL);
        if share.is_none() {
            clear(root)?;
            clear(&private)?;
        }
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
        let root = OutputRoot::new(root);
        Ok(Self { stored, root, journals, started_unix_s, planned: None, maker, _locks: locks })
    }

    /// The folder that frames are written to, which is not where they are sent.
    pub(super) fn root(&self) -> &Path {
        self.root.path()
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
            Some(recipe) if self.stored.is_none() && !path.exists() => Ok(write_atomically(&path, recipe.as_bytes())?),
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
        if let Some(stored) = &self.stored {
            stored.bring_site(folder)?;
        }
        if self.maker == Maker::Alone {
            clear(&self.root.at(folder)?)?;
        }
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
        let path = self.root.at(folder)?;
        std::fs::create_dir_all(&path)
            .with_context(|| format!("{}: expected a folder that can be created", path.display()))?;
        write_atomically(&path.join(TrajectoryFile::NAME), &way.to_json())?;
        write_atomically(&path.join(LanesFile::NAME), &lanes.to_json())?;
        write_atomically(&path.join(SiteFile::NAME), &site.to_json())?;
        self.site_written(folder)
    }

    /// What was built for a variation of a scene lies in its folder now.
    pub(super) fn site_written(&self, folder: &str) -> Result<()> {
        self.stored.as_ref().map_or(Ok(()), |stored| stored.send_site(folder))
    }

    /// Reads the files of those frames that have a line in a journal and were not looked at yet, several at once.
    pub(super) fn verify(&mut self, frames: &[String]) -> Result<()> {
        if self.stored.is_some() {
            return Ok(()); // a store keeps what it has
        }
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
        if let Some(stored) = &mut self.stored {
            let told = self.journals.get(frame)?.map(|(files, _)| files);
            let found = stored.finished(frame, expected, told.clone())?;
            if let Some(files) = &found
                && (told.as_ref() != Some(files) || self.journals.is_elsewhere(frame))
            {
                self.write_down(FrameLine { frame: frame.to_owned(), files: files.clone() })?;
            }
            return Ok(found);
        }
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
                    self.write_down(FrameLine { frame: frame.to_owned(), files: files.clone() })?;
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
        self.write_down(FrameLine { frame: frame.to_owned(), files: files.clone() })?;
        Ok(Some(files))
    }

    /// Keeps a frame that was just finished.
    pub(super) fn record(&mut self, frame: &str, files: Vec<WrittenFile>) -> Result<()> {
        let line = FrameLine { frame: frame.to_owned(), files };
        let Some(stored) = &mut self.stored else { return self.write_down(line) };
        let arrived = stored.send(line)?;
        arrived.into_iter().try_for_each(|line| self.write_down(line))?;
        self.stored.as_mut().map_or(Ok(()), |stored| stored.journal(false))
    }

    /// Waits until every frame that was kept is where it belongs.
    pub(super) fn settle(&mut self) -> Result<()> {
        let Some(stored) = &mut self.stored else { return Ok(()) };
        let arrived = stored.arrived(0)?;
        arrived.into_iter().try_for_each(|line| self.write_down(line))?;
        self.stored.as_mut().map_or(Ok(()), |stored| stored.journal(true))
    }

    /// Brings the files of those frames that the contact sheet is made from, where they lie elsewhere.
    pub(super) fn bring(&mut self, frames: &[&String]) -> Result<()> {
        let Some(stored) = &self.stored else { return Ok(()) };
        let mut files = Vec::new();
        for frame in frames {
            let (written, _) = self.journals.get(frame)?.with_context(|| format!("{frame}: removed during the run"))?;
            let names = written.into_iter().map(|file| file.name).filter(|name| FrameFolders::is_in_sheet(name));
            files.extend(names.map(|name| format!("{frame}/{name}")));
        }
        stored.bring(files)
    }

    /// What sums the run up lies beside its frames now.
    pub(super) fn finish(&mut self) -> Result<()> {
        self.stored.as_mut().map_or(Ok(()), StoredFolder::finish)
    }

    fn write_down(&mut self, line: FrameLine) -> Result<()> {
        self.journals.write(JournalLine::Frame(line))
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

/// The recipe of a folder, as it was when the folder was begun.
pub(crate) fn recipe_of(root: &Path) -> Result<Recipe> {
    let private = root.join(PRIVATE);
    let identity = RunIdentity::read(&private)?.with_context(|| {
        format!("{}: expected a folder of trove generate, found no record of its recipe", private.display())
    })?;
    let mut recipe: Recipe = serde_json::from_value(identity.recipe).with_context(|| {
        format!("{}: expected a recipe of this version of trove", private.join(RunIdentity::NAME).display())
    })?;
    // Its relative paths start from where it lay.
    recipe.folder = begun_with(root)?.parent().unwrap_or(Path::new("")).to_owned();
    Ok(recipe)
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

/// Removes the hidden files of a folder that a killed run was writing.
fn clear(folder: &Path) -> Result<()> {
    let entries = match std::fs::read_dir(folder) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        entries => entries.with_context(|| format!("{}: expected a folder that can be read", folder.display()))?,
    };
    for path in entries.flatten().map(|entry| entry.path()).filter(|path| is_unfinished(path)) {
        std::fs::remove_file(&path)
            .with_context(|| format!("{}: expected a file that can be removed", path.display()))?;
    }
    Ok(())
}

/// Whether a path is a hidden file of [`write_atomically`], which a process that was killed has left.
fn is_unfinished(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).and_then(|name| name.strip_prefix('.'));
    let process = name.and_then(|name| name.strip_suffix(".partial")).and_then(|name| name.rsplit_once('.'));
    process.is_some_and(|(_, id)| !id.is_empty() && id.bytes().all(|digit| digit.is_ascii_digit())) && path.is_file()
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
    let entries = match std::fs::read_dir(root) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        entries => entries.with_context(|| format!("{}: expected a folder to write to", root.display()))?,
    };
    // Looked at once: a run that starts at the same time may make the folder between two looks.
    let names: Vec<_> = entries.flatten().map(|entry| entry.file_name()).collect();
    ensure!(
        names.is_empty() || names.iter().any(|name| name == PRIVATE),
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
            card: None,
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
    fn what_a_killed_run_was_writing_is_cleared_away() {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path().join("out");
        drop(OutputFolder::open(&root, &identity(1), None).unwrap());
        std::fs::create_dir_all(root.join("s/v00")).unwrap();
        let left = [".report.json.28076.partial", ".trove/.run.json.7.partial", "s/v00/.site.json.7.partial"];
        let kept = [".report.partial", ".report.json.a.partial", "report.json.7.partial"];
        left.iter().chain(&kept).for_each(|name| std::fs::write(root.join(name), "").unwrap());
        // Of several parts another may be writing it.
        drop(OutputFolder::open(&root, &identity(1), Some("1/2".parse().unwrap())).unwrap());
        assert!(left.iter().all(|name| root.join(name).exists()));
        let out = OutputFolder::open(&root, &identity(1), None).unwrap();
        out.site("s/v00").unwrap();
        assert_eq!(left.map(|name| root.join(name).exists()), [false; 3]);
        assert!(kept.iter().all(|name| root.join(name).exists()));
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
    fn a_folder_that_another_run_is_making_is_not_foreign() {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path().join("out");
        std::thread::scope(|scope| {
            let others = scope.spawn(|| {
                for _ in 0..5000 {
                    std::fs::create_dir_all(root.join(PRIVATE)).unwrap();
                    std::fs::remove_dir_all(&root).unwrap();
                }
            });
            while !others.is_finished() {
                refuse_foreign(&root).unwrap();
            }
        });
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

//! Frames of the same recipe from other folders.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use rayon::prelude::*;
use trove_files::{LARGEST_FILE, OutputRoot, read_regular};
use trove_format::{FrameLine, JournalLine, LanesFile, RunIdentity, SiteFile, TrajectoryFile};
use trove_write::{FrameFolders, write_atomically};

use super::identity::differences;
use super::output::{OutputFolder, part_folders};
use super::private::PRIVATE;
use crate::progress::Steps;
use crate::watch::Watch;

/// Frames that are read at once; what is known of them is in memory.
const AT_ONCE: usize = 1024;

/// Takes over the finished frames of another output folder, and what was built for them. What is not as it was written
/// there is left, to be rendered.
pub(super) fn adopt(
    folder: &Path,
    identity: &RunIdentity,
    output: &mut OutputFolder,
    folders: &FrameFolders,
    watch: &Watch,
) -> Result<()> {
    let private = folder.join(PRIVATE);
    let found = RunIdentity::read(&private)?.with_context(|| {
        format!("{}: expected a folder of trove generate, found no {PRIVATE}/{}", folder.display(), RunIdentity::NAME)
    })?;
    let differences = differences(&found, identity);
    ensure!(
        differences.is_empty(),
        "{}: expected frames of this recipe, its inputs, this program and this kind of machine, found others: {}; leave the \
         folder out, or merge with the program and on the kind of machine that made all of them",
        folder.display(),
        differences.join("; ")
    );
    let parts = part_folders(folder)?.into_iter().map(|(_, part)| part);
    let journals: Vec<PathBuf> =
        [private].into_iter().chain(parts).map(|folder| folder.join(FrameLine::JOURNAL)).collect();
    let mut total = 0;
    for journal in &journals {
        FrameLine::each(journal, |line, _| total += usize::from(matches!(line, JournalLine::Frame(_))))?;
    }
    let (root, steps) = (OutputRoot::new(folder), Steps::new(watch));
    let mut merge = Merge { root, output, folders, steps, total, done: 0, sites: BTreeSet::new() };
    for journal in &journals {
        let (mut lines, mut stopped) = (Vec::new(), Ok(()));
        FrameLine::each(journal, |line, _| {
            if let (JournalLine::Frame(line), Ok(())) = (line, &stopped) {
                lines.push(line);
                if lines.len() == AT_ONCE {
                    stopped = merge.take(std::mem::take(&mut lines));
                }
            }
        })?;
        stopped?;
        merge.take(lines)?;
    }
    // What is still on its way would be taken for missing.
    output.settle()
}

/// A folder that is being taken over.
struct Merge<'a> {
    root: OutputRoot,
    output: &'a mut OutputFolder,
    folders: &'a FrameFolders,
    steps: Steps<'a>,
    total: usize,
    done: usize,
    /// Folders of variations whose files have been taken over.
    sites: BTreeSet<String>,
}

impl Merge<'_> {
    /// Takes some frames over, several at once. Once an end was asked for, the rest is left to a later run.
    fn take(&mut self, lines: Vec<FrameLine>) -> Result<()> {
        let mut new = Vec::new();
        for line in lines {
            let variation: Vec<&str> = line.frame.splitn(3, '/').take(2).collect();
            let variation = variation.join("/");
            if !self.sites.contains(&variation) {
                self.site(&variation)?;
                self.sites.insert(variation);
            }
            if !self.output.knows(&line)? {
                new.push(line);
            } else if !self.step() {
                return Ok(());
            }
        }
        let adopt = |line: &FrameLine| -> Result<bool> {
            Ok(self.folders.adopt(&line.frame, &self.root.at(&line.frame)?, &line.files)?)
        };
        let taken: Vec<bool> = new.par_iter().map(adopt).collect::<Result<_>>()?;
        for (line, taken) in new.into_iter().zip(taken) {
            if taken {
                self.output.record(&line.frame, line.files)?;
            } else {
                let frame = self.root.at(&line.frame)?;
                tracing::warn!("{}: not as it was written; the frame is rendered again", frame.display());
            }
            if !self.step() {
                return Ok(());
            }
        }
        Ok(())
    }

    fn step(&mut self) -> bool {
        self.done += 1;
        self.steps.done(self.done, self.total)
    }

    /// Takes over what was built for a variation of a scene.
    fn site(&self, variation: &str) -> Result<()> {
        self.output.site(variation)?; // which brings what lies elsewhere
        let (from, to) = (self.root.at(variation)?, self.output.at(variation)?);
        std::fs::create_dir_all(&to)
            .with_context(|| format!("{}: expected a folder that can be made", to.display()))?;
        // The site last: a variation that has one has been built.
        for name in [TrajectoryFile::NAME, LanesFile::NAME, SiteFile::NAME] {
            let (source, target) = (from.join(name), to.join(name));
            // What is not there is built again.
            let Ok(bytes) = read_regular(&source, LARGEST_FILE) else { return Ok(()) };
            if !target.exists() {
                write_atomically(&target, &bytes)?;
                continue;
            }
            // Of a smaller recipe, more is built again.
            let [theirs, ours] = [SiteFile::read(&from)?, SiteFile::read(&to)?];
            let is_alike = theirs.zip(ours).is_some_and(|(theirs, ours)| theirs.planned == ours.planned);
            ensure!(
                !is_alike || read_regular(&target, LARGEST_FILE).is_ok_and(|known| known == bytes),
                "{}: expected the bytes of {}, found others: the machines that made them differ; leave its folder out",
                source.display(),
                target.display()
            );
        }
        self.output.site_written(variation)
    }
}

//! The journal of finished frames: where in the file each frame's line lies, so that memory does not grow with the files.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use trove_files::open_regular;
use trove_format::{FrameLine, JournalLine, WrittenFile};

/// The journal that this process writes, and those that it goes on from.
pub(super) struct Journals {
    /// The files, its own first.
    files: Vec<PathBuf>,
    /// To be read.
    opened: Vec<File>,
    /// To be written.
    own: File,
    lines: HashMap<String, Place>,
}

/// Where a frame's line lies, and whether its files have been read or written by this process.
struct Place {
    journal: usize,
    at: Range<u64>,
    verified: bool,
}

impl Journals {
    /// Opens a journal to go on with, and others to read, whose lines count less.
    pub(super) fn open(own: PathBuf, others: Vec<PathBuf>) -> Result<Self> {
        let unwritable = || format!("{}: expected a file that can be written", own.display());
        let mut file = OpenOptions::new().create(true).append(true).open(&own).with_context(unwritable)?;
        file.write_all(b"\n").with_context(unwritable)?; // ends a line that an interrupted run may have left torn
        let mut journals = Self { files: Vec::new(), opened: Vec::new(), own: file, lines: HashMap::new() };
        let others = others.into_iter().filter(|path| path.is_file());
        for (journal, path) in [own].into_iter().chain(others).enumerate() {
            let opened = open_regular(&path).with_context(|| path.display().to_string())?;
            let lines = &mut journals.lines;
            FrameLine::each(&path, |line, at| {
                let JournalLine::Frame(line) = line else { return };
                let is_known = lines.get(&line.frame).is_some_and(|known| known.journal < journal);
                if !is_known {
                    lines.insert(line.frame, Place { journal, at, verified: false });
                }
            })?;
            journals.files.push(path);
            journals.opened.push(opened);
        }
        Ok(journals)
    }

    /// The files of a frame, as its line tells them, and whether this process has verified them.
    pub(super) fn get(&mut self, frame: &str) -> Result<Option<(Vec<WrittenFile>, bool)>> {
        let Some(Place { journal, at, verified }) = self.lines.get(frame) else { return Ok(None) };
        let mut line = vec![0; (at.end - at.start) as usize];
        let file = &mut self.opened[*journal];
        let read = file.seek(SeekFrom::Start(at.start)).and_then(|_| file.read_exact(&mut line));
        read.with_context(|| format!("{}: a line cannot be read again", self.files[*journal].display()))?;
        // Where somebody has edited it meanwhile, the frame is looked at on the disk.
        match serde_json::from_slice(&line) {
            Ok(JournalLine::Frame(line)) if line.frame == frame => Ok(Some((line.files, *verified))),
            _ => Ok(None),
        }
    }

    /// Remembers that a frame's files are as they were written.
    pub(super) fn verified(&mut self, frame: &str) {
        if let Some(place) = self.lines.get_mut(frame) {
            place.verified = true;
        }
    }

    /// Whether a frame's line is in another journal.
    pub(super) fn is_elsewhere(&self, frame: &str) -> bool {
        self.lines.get(frame).is_some_and(|place| place.journal > 0)
    }

    /// Forgets a frame.
    pub(super) fn forget(&mut self, frame: &str) {
        self.lines.remove(frame);
    }

    /// Writes a line of a frame, or of what is planned, down.
    pub(super) fn write(&mut self, line: JournalLine) -> Result<()> {
        self.append(line, true)
    }

    /// Writes down a frame's line of another journal, whose files have to be read yet.
    pub(super) fn adopt(&mut self, line: FrameLine) -> Result<()> {
        self.append(JournalLine::Frame(line), false)
    }

    fn append(&mut self, line: JournalLine, verified: bool) -> Result<()> {
        let bytes = line.to_json();
        let end = self.own.write_all(&bytes).and_then(|()| self.own.stream_position());
        let end = end.with_context(|| self.unwritable())?;
        if let JournalLine::Frame(line) = line {
            let at = end - bytes.len() as u64..end;
            self.lines.insert(line.frame, Place { journal: 0, at, verified });
        }
        Ok(())
    }

    /// Makes what was written last through a power cut.
    pub(super) fn sync(&self) -> Result<()> {
        self.own.sync_all().with_context(|| self.unwritable())
    }

    fn unwritable(&self) -> String {
        format!("{}: the journal of finished frames cannot be written", self.files[0].display())
    }
}

/// Whether a journal has lines of frames.
pub(super) fn is_empty(path: &Path) -> Result<bool> {
    let mut empty = true;
    FrameLine::each(path, |line, _| empty &= !matches!(line, JournalLine::Frame(_)))?;
    Ok(empty)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_format::PlanLine;

    fn line(frame: &str, bytes: u64) -> JournalLine {
        let file = WrittenFile { name: "class.png".into(), sha256: "00".into(), bytes };
        JournalLine::Frame(FrameLine { frame: frame.into(), files: vec![file] })
    }

    #[test]
    fn a_frame_s_last_line_counts_and_one_s_own_before_others() {
        let dir = tempfile::tempdir().unwrap();
        let [own, other] = ["own", "other"].map(|name| dir.path().join(name));
        std::fs::write(&other, [line("a", 1), line("b", 1)].map(|line| line.to_json()).concat()).unwrap();
        let bytes = |journals: &mut Journals, frame| Some(journals.get(frame).unwrap()?.0[0].bytes);
        for run in 0..2 {
            let mut journals = Journals::open(own.clone(), vec![other.clone(), dir.path().join("missing")]).unwrap();
            assert_eq!(bytes(&mut journals, "a"), Some(1 + 2 * run), "{run}");
            journals.write(line("a", 2)).unwrap();
            journals.write(JournalLine::Plan(PlanLine { planned: 2, of: 2, started_unix_s: 0 })).unwrap();
            journals.write(line("a", 3)).unwrap();
            journals.write(line("c", 4)).unwrap();
            assert_eq!(["a", "b", "c", "d"].map(|f| bytes(&mut journals, f)), [Some(3), Some(1), Some(4), None]);
            assert!(journals.get("c").unwrap().unwrap().1 && !journals.get("b").unwrap().unwrap().1);
        }
        assert!(!is_empty(&own).unwrap() && is_empty(&dir.path().join("missing")).unwrap());
    }
}

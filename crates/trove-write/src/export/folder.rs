//! The folder that a dataset is written to: what it is, and which steps are finished.

use std::collections::{BTreeSet, HashMap};
use std::fs::{self, File, OpenOptions};
use std::io::{BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::Mutex;

use serde::{Deserialize, Serialize};
use trove_files::{FolderLock, LARGEST_FILE, OutputRoot, read_regular, write_atomically};

use super::unit::Written;
use crate::WriteError;

/// Holds what only trove reads, as in the folders of trove generate.
const PRIVATE: &str = ".trove";
const IDENTITY: &str = "export.json";
const JOURNAL: &str = "units.jsonl";

/// What decides a dataset's bytes beside its frames.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Identity {
    /// The form.
    pub format: String,
    /// The program's version.
    pub trove: String,
    /// The class map: its name and its fingerprint.
    pub classes: String,
}

#[derive(Serialize, Deserialize)]
struct Line {
    /// Name of the step: a hash of its frames and their numbers.
    unit: String,
    // Not flattened: serde would look at the rows, which are raw.
    written: Written,
}

/// A dataset's folder that this process alone writes to.
pub(crate) struct ExportFolder {
    root: OutputRoot,
    journal: Mutex<Journal>,
    _lock: FolderLock,
}

struct Journal {
    file: File,
    /// Where the line of each finished step begins, and how long it is.
    lines: HashMap<String, (u64, usize)>,
    end: u64,
}

impl ExportFolder {
    /// Opens or makes the folder; one of another dataset, or with something else in it, is refused.
    pub(crate) fn open(root: &Path, identity: &Identity) -> Result<Self, WriteError> {
        let private = root.join(PRIVATE);
        refuse_foreign(root, &private)?;
        fs::create_dir_all(&private).map_err(WriteError::storage(&private, "make the folder"))?;
        let lock = FolderLock::take(&private.join("lock"))
            .map_err(WriteError::storage(root, "be the only one that writes to the folder"))?;
        check_identity(root, &private.join(IDENTITY), identity)?;
        let path = private.join(JOURNAL);
        let unusable = || WriteError::storage(&path, "read and write the file");
        let file = OpenOptions::new().create(true).append(true).read(true).open(&path).map_err(unusable())?;
        let root = OutputRoot::new(root);
        let mut journal = Journal { file, lines: HashMap::new(), end: 0 };
        journal.index(&root).map_err(unusable())?;
        Ok(Self { root, journal: Mutex::new(journal), _lock: lock })
    }

    pub(crate) fn root(&self) -> &OutputRoot {
        &self.root
    }

    /// Whether a step is finished and its files are there.
    pub(crate) fn is_finished(&self, unit: &str) -> bool {
        self.lock().lines.contains_key(unit)
    }

    /// Writes down that a step is finished.
    pub(crate) fn record(&self, unit: &str, written: Written) -> Result<(), WriteError> {
        let line = Line { unit: unit.to_owned(), written };
        let mut bytes = serde_json::to_vec(&line).map_err(|e| WriteError::Mismatch(format!("the journal: {e}")))?;
        bytes.push(b'\n');
        let mut journal = self.lock();
        journal.file.write_all(&bytes).map_err(WriteError::storage(self.root.path(), "write the journal"))?;
        let begin = journal.end;
        journal.lines.insert(line.unit, (begin, bytes.len()));
        journal.end += bytes.len() as u64;
        Ok(())
    }

    /// What a finished step has written.
    pub(crate) fn written(&self, unit: &str) -> Result<Written, WriteError> {
        let read = || -> std::io::Result<Written> {
            let mut journal = self.lock();
            let (begin, length) = *journal.lines.get(unit).ok_or(ErrorKind::NotFound)?;
            let mut bytes = vec![0; length];
            journal.file.seek(SeekFrom::Start(begin))?;
            journal.file.read_exact(&mut bytes)?;
            Ok(serde_json::from_slice::<Line>(&bytes)?.written)
        };
        read().map_err(WriteError::storage(self.root.path(), "read the journal"))
    }

    /// Removes files that steps of a smaller or otherwise numbered source wrote and no step of this one has.
    pub(crate) fn remove_stale<'a>(
        &self,
        units: impl Iterator<Item = &'a str>,
        summaries: &BTreeSet<String>,
    ) -> Result<(), WriteError> {
        let current: BTreeSet<&str> = units.collect();
        let others: Vec<String> =
            self.lock().lines.keys().filter(|unit| !current.contains(unit.as_str())).cloned().collect();
        if others.is_empty() {
            return Ok(());
        }
        let mut kept = summaries.clone();
        for unit in current {
            kept.extend(self.written(unit)?.files.into_keys());
        }
        for unit in others {
            for path in self.written(&unit)?.files.keys().filter(|path| !kept.contains(*path)) {
                let place = self.root.at(path)?;
                match fs::remove_file(&place) {
                    Err(e) if e.kind() != ErrorKind::NotFound => {
                        return Err(WriteError::storage(&place, "remove a file of an earlier export")(e));
                    }
                    _ => {}
                }
            }
        }
        Ok(())
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Journal> {
        // A thread that panicked in here has left a line at most, which a later run passes over.
        self.journal.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

impl Journal {
    /// Finds the finished steps; lines that a killed run left torn, and steps whose files are gone or shorter, are not.
    fn index(&mut self, root: &OutputRoot) -> std::io::Result<()> {
        let mut reader = BufReader::new(&self.file);
        reader.seek(SeekFrom::Start(0))?;
        let mut bytes = Vec::new();
        loop {
            bytes.clear();
            let length = reader.read_until(b'\n', &mut bytes)?;
            if length == 0 {
                break;
            }
            if let Ok(line) = serde_json::from_slice::<Line>(&bytes) {
                let is_there = |(path, length): (&String, &u64)| {
                    let place = root.at(path).ok();
                    place.and_then(|place| fs::metadata(place).ok()).is_some_and(|file| file.len() == *length)
                };
                if line.written.files.iter().all(is_there) {
                    self.lines.insert(line.unit, (self.end, length));
                } else {
                    self.lines.remove(&line.unit);
                }
            }
            self.end += length as u64;
        }
        if !bytes.is_empty() || self.end > 0 {
            // Ends a line that a killed run may have left torn.
            self.file.write_all(b"\n")?;
            self.end += 1;
        }
        Ok(())
    }
}

fn refuse_foreign(root: &Path, private: &Path) -> Result<(), WriteError> {
    if private.join(IDENTITY).exists() || !root.exists() {
        return Ok(());
    }
    let mut entries = fs::read_dir(root).map_err(WriteError::storage(root, "read the folder"))?;
    // A run that was killed at once may have left the private folder alone.
    let foreign = entries.find_map(|entry| entry.ok().filter(|entry| entry.file_name() != PRIVATE));
    match foreign {
        None => Ok(()),
        Some(entry) => Err(WriteError::Unfit {
            path: root.to_owned(),
            expected: "an empty folder or one of an earlier trove export".into(),
            found: entry.file_name().to_string_lossy().into_owned(),
            remedy: "choose another --out".into(),
        }),
    }
}

fn check_identity(root: &Path, path: &Path, identity: &Identity) -> Result<(), WriteError> {
    let text = |identity: &Identity| {
        let Identity { format, trove, classes } = identity;
        format!("{format} by trove {trove} with the classes {classes}")
    };
    match read_regular(path, LARGEST_FILE) {
        Ok(bytes) => match serde_json::from_slice::<Identity>(&bytes) {
            Ok(found) if found == *identity => Ok(()),
            found => Err(WriteError::Unfit {
                path: root.to_owned(),
                expected: text(identity),
                found: found.map_or_else(|_| "something that cannot be read".into(), |found| text(&found)),
                remedy: "choose another --out".into(),
            }),
        },
        Err(e) if e.kind() == ErrorKind::NotFound => {
            let bytes = serde_json::to_vec(identity).map_err(|e| WriteError::Mismatch(e.to_string()))?;
            write_atomically(path, &bytes).map_err(WriteError::storage(path, "write the file"))
        }
        Err(e) => Err(WriteError::storage(path, "read the file")(e)),
    }
}

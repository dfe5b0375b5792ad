//! Files told apart by their contents. What was hashed once is known by size and time of change.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use anyhow::{Context, Result};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use trove_files::{LARGEST_TEXT, read_text};
use trove_write::{sha256, sha256_file, write_atomically};

use crate::cache;

/// A file that changed so recently may change again without its time telling: clocks of file systems are coarse.
const SETTLED: Duration = Duration::from_secs(2);
/// Files that are remembered.
const REMEMBERED: usize = 20_000;
/// Folders nested deeper than this are not looked into, as in `trove assets import`.
const DEEPEST: usize = 12;

/// A file as it was when it was hashed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Known {
    bytes: u64,
    modified_ns: u128,
    sha256: String,
}

/// SHA-256 of files, as far as the cache remembers them.
pub(crate) struct Contents {
    kept_in: Option<PathBuf>,
    known: BTreeMap<PathBuf, Known>,
    has_news: bool,
}

impl Contents {
    /// With what earlier runs have left in the cache.
    pub(crate) fn open() -> Self {
        Self::kept_in(cache::folder().map(|folder| folder.join("contents")))
    }

    fn kept_in(kept_in: Option<PathBuf>) -> Self {
        // A sum comes first: a wrong hash would be believed.
        let read = |path: &PathBuf| {
            let text = read_text(path, LARGEST_TEXT).ok()?;
            let (sum, known) = text.split_once('\n')?;
            (sha256(known.as_bytes()) == sum).then(|| serde_json::from_str(known).ok())?
        };
        let known = kept_in.as_ref().and_then(read).unwrap_or_default();
        Self { kept_in, known, has_news: false }
    }

    /// SHA-256 of each of some files, lower-case hexadecimal.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(crate) fn of(&mut self, files: &[PathBuf]) -> Result<Vec<String>> {
        let known = &self.known;
        let look = |path: &PathBuf| -> Result<(PathBuf, Known, bool)> {
            let unreadable = || format!("{}: expected a file that can be read", path.display());
            let canonical = path.canonicalize().with_context(unreadable)?;
            let found = fs::metadata(&canonical).with_context(unreadable)?;
            let modified = found.modified().unwrap_or(UNIX_EPOCH);
            let modified_ns = modified.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos());
            let as_known = known.get(&canonical).filter(|k| (k.bytes, k.modified_ns) == (found.len(), modified_ns));
            if let Some(as_known) = as_known {
                return Ok((canonical, as_known.clone(), false));
            }
            let settled = SystemTime::now().duration_since(modified).is_ok_and(|age| age > SETTLED);
            let known = Known { bytes: found.len(), modified_ns, sha256: sha256_file(&canonical)? };
            Ok((canonical, known, settled))
        };
        let found: Vec<(PathBuf, Known, bool)> = files.par_iter().map(look).collect::<Result<_>>()?;
        let hashes = found.iter().map(|(_, known, _)| known.sha256.clone()).collect();
        for (path, known, _) in found.into_iter().filter(|(_, _, is_new)| *is_new) {
            self.known.insert(path, known);
            self.has_news = true;
        }
        Ok(hashes)
    }

    /// One SHA-256 of several files: of their names below `root` and their contents, in the order of the names.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(crate) fn of_all(&mut self, root: &Path, files: &[PathBuf]) -> Result<String> {
        let hashes = self.of(files)?;
        let mut lines: Vec<String> =
            files.iter().zip(hashes).map(|(file, hash)| format!("{hash}  {}\n", below(root, file))).collect();
        lines.sort();
        Ok(sha256(lines.concat().as_bytes()))
    }
}

impl Drop for Contents {
    /// Remembers what was hashed; a cache that cannot be written costs time only.
    fn drop(&mut self) {
        let Some(path) = self.kept_in.as_ref().filter(|_| self.has_news) else { return };
        if self.known.len() > REMEMBERED {
            self.known.retain(|path, _| path.is_file());
        }
        while self.known.len() > REMEMBERED {
            self.known.pop_first();
        }
        let written = || -> Result<()> {
            fs::create_dir_all(path.parent().unwrap_or(Path::new("")))?;
            let known = serde_json::to_string(&self.known)?;
            Ok(write_atomically(path, format!("{}\n{known}", sha256(known.as_bytes())).as_bytes())?)
        };
        if let Err(error) = written() {
            tracing::debug!("{}: not kept: {error}", path.display());
        }
    }
}

/// A file's path from a folder, with `/`.
pub(crate) fn below(root: &Path, file: &Path) -> String {
    file.strip_prefix(root).unwrap_or(file).to_string_lossy().replace('\\', "/")
}

/// The regular files in a folder and in those below it, without hidden ones and without links.
pub(crate) fn files_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let (mut files, mut folders) = (Vec::new(), vec![(folder.to_owned(), 0)]);
    while let Some((path, depth)) = folders.pop() {
        let unreadable = || format!("{}: expected a folder that can be read", path.display());
        for entry in fs::read_dir(&path).with_context(unreadable)? {
            let entry = entry.with_context(unreadable)?;
            if entry.file_name().as_encoded_bytes().starts_with(b".") {
                continue;
            }
            let kind = entry.file_type().with_context(unreadable)?;
            if kind.is_dir() && depth < DEEPEST {
                folders.push((entry.path(), depth + 1));
            } else if kind.is_file() || (kind.is_symlink() && entry.path().is_file()) {
                files.push(entry.path());
            }
        }
    }
    files.sort();
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contents_are_known_by_size_and_time_and_a_damaged_cache_is_made_anew() {
        let folder = tempfile::tempdir().unwrap();
        let (file, cache) = (folder.path().join("a"), folder.path().join("cache/contents"));
        let old = SystemTime::now() - Duration::from_secs(60);
        let write = |text: &str, time| {
            fs::write(&file, text).unwrap();
            fs::File::options().write(true).open(&file).unwrap().set_modified(time).unwrap();
        };
        let hash = || Contents::kept_in(Some(cache.clone())).of(std::slice::from_ref(&file)).unwrap()[0].clone();
        write("abc", old);
        assert!(hash().starts_with("ba7816bf"), "SHA-256 of abc, FIPS 180-2");
        // The same size and time: it is not looked at again.
        write("abd", old);
        assert!(hash().starts_with("ba7816bf"));
        write("abd", old + Duration::from_secs(1));
        assert!(!hash().starts_with("ba7816bf"));
        for damaged in ["{".to_owned(), fs::read_to_string(&cache).unwrap().replace(&hash(), &"0".repeat(64))] {
            fs::write(&cache, damaged).unwrap();
            assert!(hash() == sha256(b"abd"));
        }
        // What has just been written is not remembered.
        write("abc", SystemTime::now());
        hash();
        write("abd", fs::metadata(&file).unwrap().modified().unwrap());
        assert!(!hash().starts_with("ba7816bf"));
    }

    #[test]
    fn a_folders_hash_is_that_of_its_names_and_contents() {
        let folder = tempfile::tempdir().unwrap();
        let hash = || {
            let files = files_in(folder.path()).unwrap();
            Contents::kept_in(None).of_all(folder.path(), &files).unwrap()
        };
        let mut seen = vec![hash()];
        for (name, text) in [("a", "1"), ("b/c", "2"), ("b/c", "3"), ("b/d", "3")] {
            fs::create_dir_all(folder.path().join("b")).unwrap();
            fs::write(folder.path().join(name), text).unwrap();
            seen.push(hash());
        }
        fs::write(folder.path().join(".hidden"), "x").unwrap();
        assert_eq!(&hash(), seen.last().unwrap());
        seen.sort();
        seen.dedup();
        assert_eq!(seen.len(), 5);
    }
}

//! Files that are whole or not there, below the folder that they belong to, and regular.
//!
//! What goes in: a path and bytes. What comes out: a file. This crate must not know what the bytes mean. Every file that
//! another crate opens is opened here.
//!
//! ```
//! use trove_files::write_atomically;
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("journal.json");
//! write_atomically(&path, b"[]")?;
//! write_atomically(&path, b"[1]")?; // whoever reads meanwhile finds one or the other
//! assert_eq!(std::fs::read(&path)?, b"[1]");
//! # Ok::<(), std::io::Error>(())
//! ```

mod budget;
mod component;
mod lock;
mod read;

pub use budget::{Budget, Exceeded};
pub use component::{OutputRoot, PathComponent, UnsafeName};
pub use lock::FolderLock;
pub use read::{Folder, LARGEST_FILE, LARGEST_TEXT, open_regular, read_regular, read_text};

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes a file under a hidden name beside `path` and then renames it, so that `path` holds the old bytes or the new
/// ones, never some, also after a power cut and where several processes write the same file.
///
/// # Errors
/// What the system says, or something at `path` that is neither a file nor missing; nothing is left of the hidden file
/// then.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_piecewise(path, |file| file.write_all(bytes))
}

/// [`write_atomically`] for bytes that do not fit into memory: `write` puts them into the file as they are made.
///
/// # Errors
/// What the system or `write` says, or something at `path` that is neither a file nor missing; nothing is left of the
/// hidden file then.
pub fn write_piecewise(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    read::replaceable(path)?;
    // Two processes that fill the same cache must not write into each other's file.
    let partial = hidden_beside(path, &format!("{}.partial", std::process::id()));
    let written = synced(&partial, write).and_then(|()| fs::rename(&partial, path));
    if written.is_err() {
        // The first error is the one to tell of.
        let _ = fs::remove_file(&partial);
    }
    written?;
    sync_folder(path.parent());
    Ok(())
}

/// Writes a file that is not there yet, whole at once; false where another process was first, whose file stays.
///
/// # Errors
/// What the system says; nothing is left of the hidden file then.
pub fn write_new(path: &Path, bytes: &[u8]) -> io::Result<bool> {
    let partial = hidden_beside(path, &format!("{}.partial", std::process::id()));
    let placed = write_synced(&partial, bytes).and_then(|()| match fs::hard_link(&partial, path) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(false),
        // Some file systems have no links; then the last of several that start at once wins.
        Err(_) if !path.exists() => fs::rename(&partial, path).map(|()| true),
        other => other.map(|()| true),
    });
    let _ = fs::remove_file(&partial);
    if matches!(placed, Ok(true)) {
        sync_folder(path.parent());
    }
    placed
}

/// Writes a file that a power cut leaves whole once this has returned.
///
/// # Errors
/// What the system says, or something at `path` that is neither a file nor missing.
pub fn write_synced(path: &Path, bytes: &[u8]) -> io::Result<()> {
    synced(path, |file| file.write_all(bytes))
}

fn synced(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    read::replaceable(path)?;
    let mut file = BufWriter::new(File::create(path)?);
    write(&mut file)?;
    file.into_inner()?.sync_all()
}

/// Makes what a folder lists last through a power cut where the system can do that; where it cannot, a rename is still
/// whole.
pub fn sync_folder(folder: Option<&Path>) {
    if let Some(folder) = folder.and_then(|folder| File::open(folder).ok()) {
        let _ = folder.sync_all();
    }
}

/// The sibling `.name.ending` of a path, which is listed by nobody.
pub fn hidden_beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(".");
    name.push(ending);
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_file_is_replaced_whole_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        for bytes in [&b"long before"[..], b"after"] {
            write_atomically(&path, bytes).unwrap();
            assert_eq!((fs::read(&path).unwrap(), names(folder.path())), (bytes.to_vec(), vec!["a.json".into()]));
        }
    }

    #[test]
    fn of_several_that_write_a_new_file_the_first_wins() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.json");
        assert!(write_new(&path, b"first").unwrap());
        assert!(!write_new(&path, b"second").unwrap());
        assert_eq!((fs::read(&path).unwrap(), names(folder.path())), (b"first".to_vec(), vec!["run.json".into()]));
    }

    #[test]
    fn what_cannot_be_put_in_its_place_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::create_dir_all(path.join("within")).unwrap();
        assert!(write_atomically(&path, b"x").is_err());
        assert_eq!(names(folder.path()), ["a"]);
        assert!(write_atomically(&folder.path().join("missing/a"), b"x").is_err());
    }
}

//! Files and folders that are whole or not there.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::WriteError;

/// A file that lies on the disk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenFile {
    /// Name relative to its folder.
    pub name: String,
    /// SHA-256 of its bytes, lower-case hexadecimal.
    pub sha256: String,
    /// Length.
    pub bytes: u64,
}

/// SHA-256 of a file's bytes, lower-case hexadecimal.
pub fn sha256_file(path: &Path) -> Result<String, WriteError> {
    let unreadable = || WriteError::storage(path, "read the file");
    let mut file = File::open(path).map_err(unreadable())?;
    let (mut hasher, mut buffer) = (Sha256::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut buffer).map_err(unreadable())? {
            0 => return Ok(hexadecimal(&hasher.finalize())),
            n => hasher.update(&buffer[..n]),
        }
    }
}

/// Writes a file under a hidden name beside `path` and then renames it, so that `path` holds the old bytes or the new
/// ones, never some.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let partial = partial_path(path);
    let written = write_synced(&partial, bytes)
        .and_then(|()| fs::rename(&partial, path).map_err(WriteError::storage(path, "put the file in its place")));
    if written.is_err() {
        // The first error is the one to tell of.
        let _ = fs::remove_file(&partial);
    }
    written?;
    sync_folder(path.parent());
    Ok(())
}

/// A folder in the making: files are collected under a hidden name beside its path, and it appears there at once.
pub(crate) struct FolderInTheMaking {
    path: PathBuf,
    partial: PathBuf,
    files: Vec<WrittenFile>,
    finished: bool,
}

impl FolderInTheMaking {
    /// Starts it, and clears away what an interrupted run has left of it.
    pub(crate) fn start(path: &Path) -> Result<Self, WriteError> {
        let partial = partial_path(path);
        match fs::remove_dir_all(&partial) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => {
                return Err(WriteError::storage(&partial, "remove what an interrupted run left")(e));
            }
            _ => {}
        }
        fs::create_dir_all(&partial).map_err(WriteError::storage(&partial, "make the folder"))?;
        Ok(Self { path: path.to_owned(), partial, files: Vec::new(), finished: false })
    }

    /// Adds a file.
    pub(crate) fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), WriteError> {
        write_synced(&self.partial.join(name), bytes)?;
        let sha256 = hexadecimal(&Sha256::digest(bytes));
        self.files.push(WrittenFile { name: name.to_owned(), sha256, bytes: bytes.len() as u64 });
        Ok(())
    }

    /// Puts the folder in its place.
    pub(crate) fn finish(mut self) -> Result<Vec<WrittenFile>, WriteError> {
        sync_folder(Some(&self.partial));
        fs::rename(&self.partial, &self.path)
            .map_err(WriteError::storage(&self.path, "put the folder in its place"))?;
        self.finished = true;
        sync_folder(self.path.parent());
        Ok(std::mem::take(&mut self.files))
    }
}

impl Drop for FolderInTheMaking {
    fn drop(&mut self) {
        if !self.finished {
            // Whoever drops it unfinished already has an error to tell of.
            let _ = fs::remove_dir_all(&self.partial);
        }
    }
}

/// The hidden sibling that a path is made under.
fn partial_path(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(".partial");
    path.with_file_name(name)
}

fn write_synced(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let write = || {
        let mut file = File::create(path)?;
        file.write_all(bytes)?;
        file.sync_all()
    };
    write().map_err(WriteError::storage(path, "write the file"))
}

/// Makes what a folder lists last through a power cut where the system can do that; where it cannot, a rename is still
/// whole.
fn sync_folder(folder: Option<&Path>) {
    if let Some(folder) = folder.and_then(|folder| File::open(folder).ok()) {
        let _ = folder.sync_all();
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

//! Files and folders that are whole or not there.

use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use trove_files::{hidden_beside, open_regular, sync_folder, write_synced};
use trove_format::WrittenFile;

use crate::WriteError;

/// SHA-256 of a file's bytes, lower-case hexadecimal.
///
/// # Errors
/// A file that cannot be read.
pub fn sha256_file(path: &Path) -> Result<String, WriteError> {
    let unreadable = || WriteError::storage(path, "read the file");
    let mut file = open_regular(path).map_err(unreadable())?;
    let (mut hasher, mut buffer) = (Sha256::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut buffer).map_err(unreadable())? {
            0 => return Ok(hexadecimal(&hasher.finalize())),
            n => hasher.update(&buffer[..n]),
        }
    }
}

/// SHA-256 of bytes, lower-case hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// Writes a file so that `path` holds the old bytes or the new ones, never some.
///
/// # Errors
/// A file system that refuses; what was at `path` is still there then.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    trove_files::write_atomically(path, bytes).map_err(WriteError::storage(path, "write the file"))
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
        let partial = hidden_beside(path, "partial");
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
        let path = self.partial.join(name);
        write_synced(&path, bytes).map_err(WriteError::storage(&path, "write the file"))?;
        let sha256 = sha256(bytes);
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

/// Bytes as lower-case hexadecimal digits.
pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

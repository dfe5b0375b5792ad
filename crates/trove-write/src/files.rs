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

/// Who makes folders, of several that may make the same ones at once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Maker {
    /// The only one: what others have left is cleared away.
    Alone,
    /// One of several, by a name that no other has.
    Among(String),
}

impl Maker {
    /// The end of the hidden names of its folders.
    fn ending(&self) -> String {
        match self {
            Self::Alone => PARTIAL.into(),
            Self::Among(name) => format!("{PART}{name}.{PARTIAL}"),
        }
    }
}

/// What hidden names of folders in the making end in.
const PARTIAL: &str = "partial";
/// And what stands before the maker's name there.
const PART: &str = "part-";

impl FolderInTheMaking {
    /// Starts it, and clears away what an interrupted run has left of it.
    pub(crate) fn start(path: &Path, maker: &Maker) -> Result<Self, WriteError> {
        let partial = hidden_beside(path, &maker.ending());
        let mut left = vec![partial.clone()];
        if let (Maker::Alone, Some(Ok(beside))) = (maker, path.parent().map(fs::read_dir)) {
            let start = hidden_beside(path, PART).into_os_string().into_encoded_bytes();
            let is_left = |found: &PathBuf| {
                let found = found.as_os_str().as_encoded_bytes();
                found.starts_with(&start) && found.ends_with(PARTIAL.as_bytes())
            };
            left.extend(beside.flatten().map(|entry| entry.path()).filter(is_left));
        }
        for folder in left {
            match fs::remove_dir_all(&folder) {
                Err(e) if e.kind() != io::ErrorKind::NotFound => {
                    return Err(WriteError::storage(&folder, "remove what an interrupted run left")(e));
                }
                _ => {}
            }
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

    /// Takes a file over from elsewhere, by a link where the file system has them, else as a copy.
    pub(crate) fn take(&mut self, from: &Path, file: &WrittenFile) -> Result<(), WriteError> {
        let path = self.partial.join(&file.name);
        fs::hard_link(from, &path)
            .or_else(|_| fs::copy(from, &path).and_then(|_| fs::File::options().write(true).open(&path)?.sync_all()))
            .map_err(WriteError::storage(from, "take the file over"))?;
        self.files.push(file.clone());
        Ok(())
    }

    /// Puts the folder in its place. Where another process was first with the same files, those stay.
    pub(crate) fn finish(mut self) -> Result<Vec<WrittenFile>, WriteError> {
        sync_folder(Some(&self.partial));
        if let Err(error) = fs::rename(&self.partial, &self.path) {
            if !self.lies_there() {
                return Err(WriteError::storage(&self.path, "put the folder in its place")(error));
            }
            return Ok(std::mem::take(&mut self.files)); // and the hidden folder goes
        }
        self.finished = true;
        sync_folder(self.path.parent());
        Ok(std::mem::take(&mut self.files))
    }
}

impl FolderInTheMaking {
    /// Whether a folder with the same files is in the place already.
    pub(crate) fn lies_there(&self) -> bool {
        let same =
            |file: &WrittenFile| sha256_file(&self.path.join(&file.name)).is_ok_and(|sha256| sha256 == file.sha256);
        !self.files.is_empty() && self.files.iter().all(same)
    }

    /// What was added to it, where [`FolderInTheMaking::lies_there`] holds and it is not needed.
    pub(crate) fn give_up(mut self) -> Vec<WrittenFile> {
        std::mem::take(&mut self.files)
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

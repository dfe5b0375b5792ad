//! One process at a time.

use std::fs::{File, OpenOptions, TryLockError};
use std::io;
use std::path::Path;

/// Holds other processes off a folder until it is dropped.
#[derive(Debug)]
pub struct FolderLock {
    /// Why it holds nobody off; some network file systems have no locks.
    pub unsupported: Option<io::Error>,
    _file: File,
}

impl FolderLock {
    /// Takes the lock of a folder, which is a file in it.
    ///
    /// # Errors
    /// [`io::ErrorKind::WouldBlock`] where another process has it; a file that cannot be written.
    pub fn take(path: &Path) -> io::Result<Self> {
        Self::by(path, File::try_lock)
    }

    /// Takes a share of the lock of a folder: others may have theirs meanwhile, but nobody the whole.
    ///
    /// # Errors
    /// [`io::ErrorKind::WouldBlock`] where another process has the whole; a file that cannot be written.
    pub fn share(path: &Path) -> io::Result<Self> {
        Self::by(path, File::try_lock_shared)
    }

    fn by(path: &Path, lock: fn(&File) -> Result<(), TryLockError>) -> io::Result<Self> {
        // Network file systems lend a share to those who may read, the whole to those who may write.
        let file = OpenOptions::new().create(true).truncate(false).read(true).write(true).open(path)?;
        match lock(&file) {
            Ok(()) => Ok(Self { unsupported: None, _file: file }),
            Err(TryLockError::WouldBlock) => Err(io::ErrorKind::WouldBlock.into()),
            Err(TryLockError::Error(error)) => Ok(Self { unsupported: Some(error), _file: file }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_one_process_s_until_it_lets_go() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lock");
        let first = FolderLock::take(&path).unwrap();
        assert_eq!(FolderLock::take(&path).unwrap_err().kind(), io::ErrorKind::WouldBlock);
        drop(first);
        assert!(FolderLock::take(&path).is_ok_and(|lock| lock.unsupported.is_none()));
    }

    #[test]
    fn shares_hold_off_whoever_wants_the_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lock");
        let shares = [FolderLock::share(&path).unwrap(), FolderLock::share(&path).unwrap()];
        assert_eq!(FolderLock::take(&path).unwrap_err().kind(), io::ErrorKind::WouldBlock);
        drop(shares);
        let whole = FolderLock::take(&path).unwrap();
        assert_eq!(FolderLock::share(&path).unwrap_err().kind(), io::ErrorKind::WouldBlock);
        drop(whole);
    }
}

//! Reading regular files, and nothing else.

use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Read};
use std::path::{Component, Path, PathBuf};

/// Larger recipes, tables and licences are refused, bytes.
pub const LARGEST_TEXT: u64 = 64 << 20;
/// Larger models, pictures and other files that are read whole are refused, bytes.
pub const LARGEST_FILE: u64 = 2 << 30;

/// Opens a regular file. A pipe, device, socket or folder is refused without waiting for it.
///
/// # Errors
/// What the system says, or what stands there instead of a regular file.
pub fn open_regular(path: &Path) -> io::Result<File> {
    // Opening a pipe waits for whoever writes to it, so this comes first.
    regular(&fs::metadata(path)?)?;
    let file = File::open(path)?;
    regular(&file.metadata()?)?;
    Ok(file)
}

/// The bytes of a regular file of at most `limit` bytes.
///
/// # Errors
/// As [`open_regular`], or a file that is larger.
pub fn read_regular(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let file = open_regular(path)?;
    let length = file.metadata()?.len();
    let too_large = |length| Err(io::Error::new(ErrorKind::FileTooLarge, format!("{length} of at most {limit} bytes")));
    if length > limit {
        return too_large(length);
    }
    let mut bytes = Vec::with_capacity(length as usize);
    // It may have grown since.
    file.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit { too_large(bytes.len() as u64) } else { Ok(bytes) }
}

/// As [`read_regular`], as text.
///
/// # Errors
/// As [`read_regular`], or bytes that are not UTF-8.
pub fn read_text(path: &Path, limit: u64) -> io::Result<String> {
    String::from_utf8(read_regular(path, limit)?).map_err(|error| io::Error::new(ErrorKind::InvalidData, error))
}

/// A folder whose files may name each other, but nothing outside it.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Of a folder; one that is not there has no files.
    pub fn new(path: &Path) -> Self {
        Self { path: path.to_owned() }
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The bytes of a regular file below the folder, of at most [`LARGEST_FILE`]. `name` is a path from `base`, which is
    /// a folder in this one; it may use `..` and links as long as it stays below.
    ///
    /// # Errors
    /// As [`Folder::file`] and [`read_regular`].
    pub fn read(&self, base: &Path, name: &str) -> io::Result<Vec<u8>> {
        read_regular(&self.file(base, Path::new(name))?, LARGEST_FILE)
    }

    /// The path of a regular file below the folder. `base` is a folder in it, `name` a path from there; both may use
    /// `..` and links as long as they stay below.
    ///
    /// # Errors
    /// What the system says, a name that is absolute, or a file that lies outside the folder or is not regular.
    pub fn file(&self, base: &Path, name: &Path) -> io::Result<PathBuf> {
        if name.components().any(|part| matches!(part, Component::RootDir | Component::Prefix(_))) {
            return Err(outside("an absolute path; name files by their place below the folder"));
        }
        let path = base.join(name);
        self.check(&path)?;
        Ok(path)
    }

    /// An error where a path is not that of a regular file below the folder.
    ///
    /// # Errors
    /// As [`Folder::file`].
    pub fn check(&self, path: &Path) -> io::Result<()> {
        let canonical = path.canonicalize()?;
        if !canonical.starts_with(self.path.canonicalize()?) {
            return Err(outside("lies outside the folder; copy the file into it"));
        }
        regular(&fs::metadata(&canonical)?)
    }
}

fn outside(why: &str) -> io::Error {
    io::Error::new(ErrorKind::PermissionDenied, why)
}

fn regular(found: &Metadata) -> io::Result<()> {
    match found.file_type() {
        kind if kind.is_file() => Ok(()),
        kind if kind.is_dir() => Err(io::Error::new(ErrorKind::IsADirectory, "a folder, not a file")),
        _ => Err(io::Error::new(ErrorKind::InvalidInput, "a pipe, device or socket, not a regular file")),
    }
}

/// An error where something other than a regular file lies at a path that is to be written.
pub(crate) fn replaceable(path: &Path) -> io::Result<()> {
    match fs::metadata(path) {
        // Renaming a file over a folder fails by itself, with the system's words.
        Ok(found) if found.is_dir() => Ok(()),
        Ok(found) => regular(&found),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "abc").unwrap();
        assert_eq!(read_regular(&path, 3).unwrap(), b"abc");
        assert_eq!(read_regular(&path, 2).unwrap_err().kind(), ErrorKind::FileTooLarge);
        fs::write(&path, b"\xff").unwrap();
        assert_eq!(read_text(&path, 9).unwrap_err().kind(), ErrorKind::InvalidData);
        assert_eq!(read_regular(folder.path(), 9).unwrap_err().kind(), ErrorKind::IsADirectory);
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_and_a_device_are_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        for path in [pipe.as_path(), Path::new("/dev/zero")] {
            assert!(open_regular(path).unwrap_err().to_string().contains("not a regular file"));
            assert!(replaceable(path).is_err());
        }
        assert!(replaceable(&folder.path().join("new")).is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn files_of_a_folder_are_below_it() {
        let around = tempfile::tempdir().unwrap();
        let inside = around.path().join("library");
        fs::create_dir_all(inside.join("maps")).unwrap();
        fs::write(around.path().join("secret"), "x").unwrap();
        fs::write(inside.join("a.png"), "x").unwrap();
        std::os::unix::fs::symlink(around.path().join("secret"), inside.join("out.png")).unwrap();
        std::os::unix::fs::symlink(inside.join("a.png"), inside.join("in.png")).unwrap();
        let folder = Folder::new(&inside);
        let file = |name: &str| folder.file(&inside.join("maps"), Path::new(name));
        for name in ["../a.png", "../in.png"] {
            assert!(file(name).is_ok(), "{name}");
        }
        let absolute = inside.join("a.png");
        for name in ["../out.png", "../../secret", "..", "missing", absolute.to_str().unwrap()] {
            assert!(file(name).is_err(), "{name}");
        }
    }
}

//! Reading and writing whole files.

use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use trove_files::{LARGEST_FILE, read_regular};

use crate::FormatError;

/// Version of the files' form. It rises when a reader of the last one would go wrong.
pub const FORMAT: u32 = 2;

/// A file's bytes.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, FormatError> {
    read_regular(path, LARGEST_FILE).map_err(|source| FormatError::Unreadable { path: path.to_owned(), source })
}

/// A file's bytes; `None` where it is not there.
pub(crate) fn bytes_if_there(path: &Path) -> Result<Option<Vec<u8>>, FormatError> {
    match read_regular(path, LARGEST_FILE) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(FormatError::Unreadable { path: path.to_owned(), source }),
    }
}

/// What bytes of `path` say.
pub(crate) fn parsed<T: DeserializeOwned>(path: &Path, bytes: &[u8], expected: &'static str) -> Result<T, FormatError> {
    serde_json::from_slice(bytes).map_err(|error| FormatError::damaged(path, expected, &error))
}

/// What bytes of `path` say that begin with the number of the format.
pub(crate) fn of_this_format<T: DeserializeOwned>(
    path: &Path,
    bytes: &[u8],
    expected: &'static str,
) -> Result<T, FormatError> {
    #[derive(Deserialize)]
    struct Versioned {
        format: Option<u32>,
    }
    let found = parsed::<Versioned>(path, bytes, expected)?.format;
    if found != Some(FORMAT) {
        return Err(FormatError::Version { path: path.to_owned(), expected: FORMAT, found });
    }
    parsed(path, bytes, expected)
}

/// A file's bytes: indented, with a line break at the end.
pub(crate) fn pretty(value: &impl Serialize) -> Vec<u8> {
    let mut bytes = serde_json::to_vec_pretty(value).expect("types of this crate have keys that are strings");
    bytes.push(b'\n');
    bytes
}

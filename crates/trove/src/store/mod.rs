//! Object stores (`s3://bucket/prefix`, `gs://…`, `az://…`): what is written there, and what is read from there.

mod fetch;
mod lease;
#[cfg(feature = "object-store")]
mod remote;
#[cfg(not(feature = "object-store"))]
#[path = "without.rs"]
mod remote;

use std::path::Path;
use std::time::SystemTime;

pub(crate) use fetch::fetched;
pub(crate) use lease::{Lease, fresh};
pub(crate) use remote::{Answer, Store};

/// Schemes of the stores that are known.
const SCHEMES: [&str; 9] = ["s3", "s3a", "gs", "az", "azure", "adl", "abfs", "abfss", "wasbs"];

/// An object in a store.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Object {
    /// Its name below the store's prefix, with `/` between the parts.
    pub(crate) name: String,
    /// Length, bytes.
    pub(crate) bytes: u64,
    /// Changes whenever the object does; `None` where the store tells none.
    pub(crate) version: Option<String>,
    /// When it was last written, by the store's clock.
    pub(crate) modified: SystemTime,
}

/// The address, where a path is one of an object store.
pub(crate) fn address(path: &Path) -> Option<&str> {
    let text = path.to_str()?;
    let (scheme, _) = text.split_once("://")?;
    SCHEMES.contains(&scheme).then(|| text.trim_end_matches('/'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_told_from_paths() {
        assert_eq!(address(Path::new("s3://bucket/a/b/")), Some("s3://bucket/a/b"));
        for path in ["out", "/tmp/s3/out", "s3:/bucket", "ftp://host/a", "C://out"] {
            assert_eq!(address(Path::new(path)), None, "{path}");
        }
    }
}

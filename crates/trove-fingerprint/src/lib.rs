//! Files → a fingerprint of their contents, the same on every machine; for build scripts.
//!
//! ```
//! let of_this_crate = trove_fingerprint::of(["src", "Cargo.toml"]);
//! assert_eq!(of_this_crate.len(), 16);
//! ```

use std::fs;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

/// The fingerprint of some files and of all files in some folders, 16 lower-case hexadecimal digits; what is missing does
/// not count. Tells Cargo to run the build script again once any of them changes.
pub fn of(paths: impl IntoIterator<Item = impl AsRef<Path>>) -> String {
    let mut files = Vec::new();
    for path in paths {
        let path = path.as_ref();
        // Cargo looks at all that is in a folder, and takes a file that is missing for one that has changed.
        if path.exists() {
            println!("cargo:rerun-if-changed={}", path.display());
        }
        collect(path, &mut files);
    }
    files.sort();
    let mut hasher = Sha256::new();
    for file in files {
        let bytes = fs::read(file).unwrap_or_default();
        hasher.update((bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    }
    hasher.finalize()[..8].iter().map(|byte| format!("{byte:02x}")).collect()
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if path.is_file() {
        files.push(path.to_owned());
    }
    for entry in fs::read_dir(path).into_iter().flatten().flatten() {
        collect(&entry.path(), files);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_file_below_a_folder_counts_and_its_place_on_the_machine_does_not() {
        let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
        let [one, other] = folders.each_ref().map(|folder| folder.path());
        for root in [one, other] {
            fs::create_dir_all(root.join("src/deep")).unwrap();
            fs::write(root.join("src/deep/a.rs"), "ab").unwrap();
            fs::write(root.join("src/b.rs"), "c").unwrap();
        }
        let found = |root: &Path| of([root.join("src"), root.join("build.rs")]);
        assert_eq!(found(one), found(other));
        // The same bytes cut elsewhere.
        fs::write(other.join("src/deep/a.rs"), "a").unwrap();
        fs::write(other.join("src/b.rs"), "bc").unwrap();
        assert_ne!(found(one), found(other));
        fs::write(other.join("src/deep/a.rs"), "ab").unwrap();
        fs::write(other.join("src/b.rs"), "c").unwrap();
        assert_eq!(found(one), found(other));
        fs::write(other.join("build.rs"), "").unwrap();
        assert_ne!(found(one), found(other));
    }
}

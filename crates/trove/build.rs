//! Gives the program a fingerprint of its sources and of the versions of its dependencies, the same whatever compiler
//! builds it: frames of two programs are not mixed in one folder.

use std::fs;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

fn main() {
    // A crate that is built alone lies beside no others and no lock file; then its own sources have to do.
    let lock = ["../../Cargo.lock", "Cargo.lock"].into_iter().map(PathBuf::from).find(|path| path.is_file());
    let mut files: Vec<PathBuf> = lock.into_iter().collect();
    let mut crates: Vec<PathBuf> = fs::read_dir("..").into_iter().flatten().flatten().map(|e| e.path()).collect();
    crates.sort();
    for folder in crates.iter().filter(|folder| folder.join("Cargo.toml").is_file()) {
        files.push(folder.join("Cargo.toml"));
        files.push(folder.join("build.rs"));
        for inner in ["src", "plans"] {
            collect(&folder.join(inner), &mut files);
        }
    }
    files.retain(|file| file.is_file());
    files.sort();
    let mut hasher = Sha256::new();
    for file in files {
        println!("cargo:rerun-if-changed={}", file.display());
        let bytes = fs::read(&file).unwrap_or_default();
        hasher.update((bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    }
    let digest: String = hasher.finalize()[..8].iter().map(|byte| format!("{byte:02x}")).collect();
    println!("cargo:rustc-env=TROVE_BUILD={digest}");
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    if folder.is_dir() {
        println!("cargo:rerun-if-changed={}", folder.display());
    }
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() { collect(&path, files) } else { files.push(path) }
    }
}

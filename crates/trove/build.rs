//! Gives the program a fingerprint of its sources and of the versions of its dependencies, the same whatever compiler
//! builds it: frames of two programs are not mixed in one folder.

use std::fs;
use std::path::PathBuf;

fn main() {
    // A crate that is built alone lies beside no others and no lock file; then its own sources have to do.
    let lock = ["../../Cargo.lock", "Cargo.lock"].into_iter().map(PathBuf::from).find(|path| path.is_file());
    let beside = fs::read_dir("..").into_iter().flatten().flatten().map(|entry| entry.path());
    let crates = beside.filter(|folder| folder.join("Cargo.toml").is_file());
    let sources = crates.flat_map(|folder| ["Cargo.toml", "build.rs", "src", "plans"].map(|part| folder.join(part)));
    println!("cargo:rustc-env=TROVE_BUILD={}", trove_fingerprint::of(lock.into_iter().chain(sources)));
}

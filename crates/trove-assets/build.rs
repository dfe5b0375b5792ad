//! Gives the crate a fingerprint of all that decides what it generates: a cached library is as old as its sources.

fn main() {
    let sources = trove_fingerprint::of(["src", "plans", "../trove-model/src"]);
    println!("cargo:rustc-env=TROVE_ASSETS_SOURCES={}-{sources}", env!("CARGO_PKG_VERSION"));
}

//! Every input that ever failed is read again, and every target is there for cargo-fuzz too.

#![allow(clippy::unwrap_used)] // all of this is tests

use std::fs;
use std::path::Path;

use trove_fuzz::{TARGETS, run_once, target};

#[test]
fn what_once_failed_does_not_fail_again() {
    let mut fed = 0;
    for folder in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus")).unwrap() {
        let folder = folder.unwrap();
        let name = folder.file_name().into_string().unwrap();
        assert!(target(&name).is_some(), "fuzz/corpus/{name}: expected the name of a target");
        for file in fs::read_dir(folder.path()).unwrap() {
            run_once(&name, &fs::read(file.unwrap().path()).unwrap());
            fed += 1;
        }
    }
    assert!(fed > 10, "{fed}");
}

#[test]
fn valid_inputs_are_read_and_are_what_mutations_start_from() {
    for target in TARGETS {
        let seeds = (target.seeds)();
        assert!(!seeds.is_empty() && seeds.iter().all(|seed| !seed.is_empty()), "{}", target.name);
        seeds.iter().for_each(|seed| run_once(target.name, seed));
    }
}

#[test]
fn cargo_fuzz_knows_every_target() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
    for target in TARGETS {
        let name = target.name;
        let text = fs::read_to_string(folder.join(format!("fuzz_targets/{name}.rs"))).unwrap();
        assert!(text.contains(&format!("run_once(\"{name}\", data)")), "{name}");
        assert!(manifest.contains(&format!("name = \"{name}\"\npath = \"fuzz_targets/{name}.rs\"")), "{name}");
    }
    assert_eq!(fs::read_dir(folder.join("fuzz_targets")).unwrap().count(), TARGETS.len());
}

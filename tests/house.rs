//! The rules of the house (see ARCHITECTURE.md), held by the tree itself.

#![allow(clippy::unwrap_used)] // all of this is tests
use std::path::{Path, PathBuf};

use trove_model::{CLASSES, ClassMap};

const STAGES: [&str; 6] = ["trove-read", "trove-assets", "trove-build", "trove-render", "trove-write", "trove-judge"];
/// Those that write to the disk.
const WRITING: [&str; 3] = ["trove-read", "trove-write", "trove-judge"];
/// Those that write or read JSON of our own: an output folder's, and the plain form's, which both readers and exporters know.
const TELLING: [&str; 3] = ["trove-read", "trove-write", "trove-judge"];
/// A file longer than this does more than one thing.
const LONGEST_FILE: usize = 800;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Names under `[dependencies]` of a crate's Cargo.toml.
fn dependencies(name: &str) -> Vec<String> {
    let text = std::fs::read_to_string(root().join("crates").join(name).join("Cargo.toml")).unwrap();
    let manifest: toml::Table = text.parse().unwrap();
    manifest.get("dependencies").and_then(|d| d.as_table()).map(|d| d.keys().cloned().collect()).unwrap_or_default()
}

/// The crates of this workspace among them.
fn ours(name: &str) -> Vec<String> {
    dependencies(name).into_iter().filter(|d| d.starts_with("trove")).collect()
}

fn sources(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, ending, found);
        } else if path.extension().is_some_and(|e| e == ending) {
            found.push(path);
        }
    }
}

#[test]
fn stages_know_the_model_and_not_each_other() {
    for stage in STAGES {
        let mut ours = ours(stage);
        if WRITING.contains(&stage) {
            ours.retain(|d| d != "trove-files");
        }
        if TELLING.contains(&stage) {
            ours.retain(|d| d != "trove-format");
        }
        // What a card runs too.
        if stage == "trove-render" {
            ours.retain(|d| d != "trove-trace");
        }
        assert_eq!(ours, ["trove-model"], "{stage}");
    }
    assert_eq!(dependencies("trove-files"), [""; 0]);
    assert_eq!(dependencies("trove-trace"), ["glam"]);
    assert_eq!(ours("trove-format"), ["trove-files", "trove-model"]);
    assert_eq!(ours("trove-py"), ["trove"]);
}

#[test]
fn the_model_knows_glam_and_on_request_serde() {
    assert_eq!(dependencies("trove-model"), ["glam", "serde"]);
    let text = std::fs::read_to_string(root().join("crates/trove-model/Cargo.toml")).unwrap();
    let manifest: toml::Table = text.parse().unwrap();
    assert_eq!(manifest["dependencies"]["serde"]["optional"].as_bool(), Some(true));
}

/// A string literal like `"lamp/curved"`, as ids of assets are.
fn id_in(line: &str) -> Option<&str> {
    let is_part =
        |part: &str| !part.is_empty() && part.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
    line.split('"').skip(1).step_by(2).find(|literal| literal.contains('/') && literal.split('/').all(is_part))
}

#[test]
fn the_builder_knows_no_id() {
    assert_eq!(id_in("    let lamp = named(\"lamp/curved\");"), Some("lamp/curved"));
    assert_eq!(id_in("    format!(\"{} km/h\", \"curved\")"), None);
    let mut files = Vec::new();
    sources(&root().join("crates/trove-build/src"), "rs", &mut files);
    files.retain(|file| !file.ends_with("tests.rs") && !file.ends_with("testing.rs"));
    assert!(files.len() > 50);
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let built = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        for (i, line) in built.lines().enumerate() {
            assert_eq!(id_in(line), None, "{}:{}: ask for tags instead", file.display(), i + 1);
        }
    }
}

/// Where a line opens or reads a file by itself.
fn opens(line: &str) -> bool {
    ["fs::read(", "fs::read_to_string(", "File::open(", "ImageReader::open(", "image::open("]
        .iter()
        .any(|o| line.contains(o))
}

#[test]
fn files_are_opened_in_one_place() {
    assert!(opens("let text = std::fs::read_to_string(path)?;") && !opens("read_text(path, LARGEST_TEXT)"));
    let mut files = Vec::new();
    sources(&root().join("crates"), "rs", &mut files);
    // What this program, the compiler and the kernel wrote.
    let own = [
        "trove-files/src",
        "trove-fingerprint/src",
        "build.rs",
        "tests.rs",
        "tests/",
        "testing.rs",
        "schemas.rs",
        "doctor.rs",
        "benches/",
        "examples/",
    ];
    files.retain(|file| !own.iter().any(|own| file.to_string_lossy().contains(own)));
    assert!(files.len() > 200);
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let built = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        for (i, line) in built.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//")) {
            assert!(!opens(line), "{}:{}: open it by trove_files", file.display(), i + 1);
        }
    }
}

#[test]
fn no_file_is_longer_than_it_should_be() {
    let mut files = Vec::new();
    sources(&root().join("crates"), "rs", &mut files);
    sources(&root().join("python"), "py", &mut files);
    assert!(files.len() > 50);
    for file in files {
        let lines = std::fs::read_to_string(&file).unwrap().lines().count();
        assert!(lines <= LONGEST_FILE, "{}: {lines} lines", file.display());
    }
}

#[test]
fn no_module_is_a_drawer_for_everything() {
    let mut files = Vec::new();
    sources(&root().join("crates"), "rs", &mut files);
    for file in files {
        let stem = file.file_stem().unwrap().to_string_lossy().into_owned();
        let drawer = ["util", "utils", "common", "helper", "helpers", "manager", "misc"].contains(&stem.as_str());
        assert!(!drawer, "{}", file.display());
    }
}

#[test]
fn the_documentation_has_the_table_of_classes() {
    let label = |set: &str, id: u8| format!("{id} {}", ClassMap::named(set).unwrap().class(id).unwrap().name);
    let text = std::fs::read_to_string(root().join("docs/output.md")).unwrap();
    for row in CLASSES.iter() {
        let fields = [
            row.class.id().to_string(),
            row.name.into(),
            if row.thing { "yes" } else { "no" }.into(),
            row.rgb.map(|channel| channel.to_string()).join(" "),
            label("trove13", row.class13),
            label("cityscapes", row.cityscapes_id),
            row.train_id.to_string(),
            row.coco_id.to_string(),
            label("camvid", row.camvid_id),
        ];
        let line = format!("| {} |", fields.join(" | "));
        assert!(text.lines().any(|l| l == line), "docs/output.md has no row {line}");
    }
}

//! The import graph inside each crate has no rings: files have floors, and arrows point down.
//!
//! An arrow runs from the file that names an item to the file that defines it: re-exports are followed to their ends,
//! so declaring a module or re-exporting from it ties no parent to its children. Tests inside the crates do not count.

#![allow(clippy::unwrap_used)] // all of this is tests
mod source;

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};

use source::{Arrows, Crate};

/// The same arrows between what lies side by side in a folder, each folder being one with the `mod.rs` that speaks for
/// it: `roads/kerb.rs → ground/drape.rs` is `roads → ground` there.
fn between_rooms(arrows: &Arrows) -> Arrows {
    let is_folder = |f: &Path| arrows.keys().any(|(a, b)| a.starts_with(f) || b.starts_with(f));
    let place = |file: &Path| {
        let plain = file.with_extension("");
        if is_folder(&plain) { plain.join("mod") } else { plain }
    };
    let mut rooms = Arrows::new();
    for ((a, b), names) in arrows {
        let (from, to) = (place(a), place(b));
        let shared = from.iter().zip(&to).take_while(|(x, y)| x == y).count();
        let room = |p: &Path| p.iter().take(shared + 1).collect::<PathBuf>();
        rooms.entry((room(&from), room(&to))).or_default().extend(names.iter().cloned());
    }
    rooms
}

/// A shortest way along arrows from somewhere back to there.
fn ring<'a>(next: &BTreeMap<&'a Path, Vec<&'a Path>>, start: &'a Path) -> Option<Vec<&'a Path>> {
    let mut before = BTreeMap::new();
    let mut waiting = VecDeque::from([start]);
    while let Some(at) = waiting.pop_front() {
        for &to in next.get(at).into_iter().flatten() {
            before.entry(to).or_insert_with(|| {
                waiting.push_back(to);
                at
            });
        }
    }
    let mut way = vec![start, *before.get(start)?];
    while way[way.len() - 1] != start {
        way.push(before[way[way.len() - 1]]);
    }
    way.reverse();
    Some(way)
}

/// A ring for each place that stands in one, the shortest first.
fn rings(arrows: &Arrows) -> Vec<Vec<&Path>> {
    let mut next = BTreeMap::<&Path, Vec<&Path>>::new();
    for (from, to) in arrows.keys() {
        next.entry(from).or_default().push(to);
    }
    let mut rings: Vec<Vec<&Path>> = next.keys().filter_map(|start| ring(&next, start)).collect();
    rings.sort_by_key(Vec::len);
    rings
}

/// Rings as text; of those that share an import the shortest alone.
fn told(arrows: &Arrows) -> String {
    let mut told = String::new();
    let mut shown = BTreeSet::new();
    for ring in rings(arrows) {
        let pairs: Vec<(PathBuf, PathBuf)> = ring.windows(2).map(|p| (p[0].into(), p[1].into())).collect();
        if pairs.iter().any(|p| shown.contains(p)) {
            continue;
        }
        told += &format!("\n{}", ring[0].display());
        for pair in pairs {
            told += &format!("\n    takes {:?} from {}", arrows[&pair], pair.1.display());
            shown.insert(pair);
        }
    }
    told
}

#[test]
fn no_files_and_no_folders_of_a_crate_import_each_other_in_a_ring() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().unwrap();
    let (mut found, mut total) = (String::new(), 0);
    let mut folders: Vec<PathBuf> = std::fs::read_dir(&crates).unwrap().flatten().map(|e| e.path()).collect();
    folders.sort();
    for folder in folders {
        let sources = Crate::read(&folder.join("src/lib.rs"));
        let arrows = sources.arrows(&crates);
        let rooms = between_rooms(&arrows);
        println!(
            "{}: {} imports from file to file, {} files in rings, {} folders or files beside each other in rings",
            folder.file_name().unwrap().display(),
            arrows.len(),
            rings(&arrows).len(),
            rings(&rooms).len()
        );
        found += &told(&rooms);
        total += arrows.len();
    }
    assert!(total > 500, "only {total} imports were understood");
    assert!(found.is_empty(), "these import each other in rings:{found}");
}

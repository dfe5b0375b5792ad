//! A `library.toml` completed: what its users wrote stays as it is, letter by letter.

use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use super::library_file::{AssetEntry, EnvironmentEntry, FILE_NAME, Guess, LibraryFile, SurfaceEntry};
use crate::ReadError;

/// Where the entries of a text stand.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Places {
    asset: Vec<AssetPlace>,
    surface: Vec<SurfacePlace>,
}

#[derive(Deserialize)]
struct AssetPlace {
    file: Spanned<String>,
}

#[derive(Deserialize)]
struct SurfacePlace {
    name: Spanned<String>,
}

const HEADER: &str = "\
# A library of models, textures and skies for TRoVE; docs/assets.md explains the keys.
# Guesses state their confidence (0 to 1) and reason. Correct what is wrong: imports keep what is here.
";

/// The text with the guesses of the entries that it has, and with those that it lacks at its end. `old` are the entries
/// of the text, in order, at the beginning of those in `file`.
pub(super) fn completed(text: &str, old: &LibraryFile, file: &LibraryFile) -> String {
    let mut out = if text.trim().is_empty() { header(file) } else { text.to_owned() };
    let places: Places = toml::from_str(text).unwrap_or_default();
    let assets = places.asset.iter().map(|p| p.file.span().end).zip(file.assets.iter().map(|e| &e.guesses));
    let surfaces = places.surface.iter().map(|p| p.name.span().end).zip(file.surfaces.iter().map(|e| &e.guesses));
    let mut inserts: Vec<(usize, &Vec<Guess>)> = assets.chain(surfaces).collect();
    // From the end on, so that places stay where they are.
    inserts.sort_by_key(|(at, _)| std::cmp::Reverse(*at));
    for (at, guesses) in inserts.into_iter().filter(|(_, g)| !g.is_empty()) {
        let rest = &out[at..];
        let line = rest.find('\n').map_or(rest.len(), |end| end);
        let after = rest[..line].trim_start();
        // Entries that are written in one line have no place for more.
        if after.is_empty() || after.starts_with('#') {
            let lines: String = guesses.iter().map(|g| format!("\n{}", guess_line(g))).collect();
            out.insert_str(at + line, &lines);
        }
    }
    if !out.ends_with('\n') {
        out.push('\n');
    }
    file.assets[old.assets.len()..].iter().for_each(|e| asset(&mut out, e));
    file.surfaces[old.surfaces.len()..].iter().for_each(|e| surface(&mut out, e));
    file.environments[old.environments.len()..].iter().for_each(|e| environment(&mut out, e));
    out
}

fn header(file: &LibraryFile) -> String {
    let mut out = HEADER.to_owned();
    for (key, value) in [("licence", &file.licence), ("author", &file.author), ("source", &file.source)] {
        text(&mut out, key, value.as_deref());
    }
    out
}

fn quoted(value: &str) -> String {
    toml::Value::String(value.to_owned()).to_string()
}

fn text(out: &mut String, key: &str, value: Option<&str>) {
    if let Some(value) = value {
        out.push_str(&format!("{key} = {}\n", quoted(value)));
    }
}

fn guess_line(guess: &Guess) -> String {
    let reason: String = guess.reason.chars().filter(|c| !c.is_control()).collect();
    format!("{} = {} # {:.2}: {reason}", guess.key, guess.value, guess.confidence)
}

fn guesses(out: &mut String, all: &[Guess]) {
    all.iter().for_each(|g| out.push_str(&format!("{}\n", guess_line(g))));
}

fn asset(out: &mut String, e: &AssetEntry) {
    out.push_str("\n[[asset]]\n");
    text(out, "file", Some(&e.file));
    text(out, "part", e.part.as_deref());
    guesses(out, &e.guesses);
}

fn surface(out: &mut String, e: &SurfaceEntry) {
    out.push_str("\n[[surface]]\n");
    text(out, "name", Some(&e.name));
    guesses(out, &e.guesses);
    text(out, "color", Some(&e.color));
    for (key, value) in [
        ("normal", &e.normal),
        ("roughness", &e.roughness),
        ("metalness", &e.metalness),
        ("occlusion", &e.occlusion),
        ("orm", &e.orm),
        ("displacement", &e.displacement),
        ("opacity", &e.opacity),
        ("emission", &e.emission),
    ] {
        text(out, key, value.as_deref());
    }
}

fn environment(out: &mut String, e: &EnvironmentEntry) {
    out.push_str("\n[[environment]]\n");
    text(out, "file", Some(&e.file));
    text(out, "licence", e.licence.as_deref());
}

/// Writes the file whole or not at all.
pub(super) fn write(folder: &Path, text: &str) -> Result<(), ReadError> {
    let path = folder.join(FILE_NAME);
    trove_files::write_atomically(&path, text.as_bytes()).map_err(|source| ReadError::io(&path, source))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_users_wrote_stays_and_what_is_missing_is_added_below() {
        let text = "# mine\n[[asset]]\nfile = \"a.glb\" # old\nkind = \"truck\"\n";
        let old = LibraryFile::parse(text).expect("a library");
        let mut file = old.clone();
        let guess = |key, value: &str| Guess { key, value: value.into(), confidence: 0.9, reason: "so".into() };
        file.assets[0].guesses.push(guess("up", "\"+y\""));
        let new =
            AssetEntry { file: "b \"1\".glb".into(), guesses: vec![guess("kind", "\"car\"")], ..AssetEntry::default() };
        file.assets.push(new);
        let out = completed(text, &old, &file);
        assert!(
            out.starts_with("# mine\n[[asset]]\nfile = \"a.glb\" # old\nup = \"+y\" # 0.90: so\nkind = \"truck\"\n"),
            "{out}"
        );
        let read = LibraryFile::parse(&out).expect("a library");
        assert_eq!((read.assets.len(), read.assets[1].file.as_str()), (2, "b \"1\".glb"));
        assert_eq!(read.assets[1].kind.as_deref(), Some("car"));
    }
}

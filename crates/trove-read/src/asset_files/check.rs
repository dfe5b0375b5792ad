//! What is wrong with a library's models and texture sets.

use std::collections::BTreeMap;
use std::path::Path;

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use trove_model::{Kind, Mesh, Outcome};

use super::asset::asset;
use super::library_file::{AssetEntry, FILE_NAME, LibraryFile, SurfaceEntry};
use super::load::{guarded, load_raw};
use super::names::kind_named;
use super::picture::{Pictures, decode};
use super::repair::{self, BUDGET};
use super::subjects::{self, Expected};
use super::{GLANCE_LIMIT, guess, lamp, tags};

/// Something that is wrong, or may be.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Finding {
    /// The model's or picture's file, from the library's folder.
    pub file: String,
    /// Whether the asset cannot be used as it is.
    pub severe: bool,
    /// What is expected and found.
    pub what: String,
    /// What to do.
    pub remedy: String,
}

/// Looks at everything in a folder's `library.toml`, which has to be there; findings in the order of files. A library
/// that cannot be read at all is one finding.
pub fn check(folder: &Path) -> Vec<Finding> {
    let file = match LibraryFile::read(folder) {
        Ok(file) => file,
        Err(e) => {
            let remedy = "correct it, or write one: `trove assets import FOLDER`";
            return vec![finding(FILE_NAME, true, e.to_string(), remedy)];
        }
    };
    let pictures = Pictures::new("check", folder, GLANCE_LIMIT);
    let of_asset = |entry: &AssetEntry| {
        let found = guarded(&folder.join(&entry.file), || Ok(of_asset(folder, &file, entry, &pictures)));
        found.unwrap_or_else(|e| vec![finding(&entry.file, true, e.to_string(), "leave it out of library.toml")])
    };
    let mut findings: Vec<Finding> = file.assets.par_iter().flat_map_iter(of_asset).collect();
    findings.extend(
        file.surfaces.par_iter().flat_map_iter(|entry| of_surface(&file, entry, &pictures)).collect::<Vec<_>>(),
    );
    for sky in &file.environments {
        if let Err(e) = pictures.folder.file(folder, Path::new(&sky.file)) {
            findings.push(finding(&sky.file, true, e.to_string(), "put it there, or remove it from library.toml"));
        }
    }
    findings.sort();
    findings.dedup();
    findings
}

fn finding(file: &str, severe: bool, what: impl Into<String>, remedy: impl Into<String>) -> Finding {
    Finding { file: file.to_owned(), severe, what: what.into(), remedy: remedy.into() }
}

fn of_asset(folder: &Path, file: &LibraryFile, entry: &AssetEntry, pictures: &Pictures) -> Vec<Finding> {
    let mut findings = Vec::new();
    if entry.kind.as_deref() == Some("none") {
        return findings;
    }
    let mut say = |severe, what: String, remedy: &str| findings.push(finding(&entry.file, severe, what, remedy));
    if entry.licence.is_none() && file.licence.is_none() {
        say(false, "no licence is known".into(), "write `licence = \"…\"` into library.toml, for it or for all");
    }
    let mut model = match load_raw(folder, entry, pictures) {
        Ok(model) => model,
        Err(e) => {
            say(true, e.to_string(), "fix the file, or remove it from library.toml");
            return findings;
        }
    };
    // Before repairs drop what is looked for.
    let lost = lost_textures(&model.notices);
    if let Some(name) = lost.first() {
        say(
            false,
            format!("{} textures are missing or cannot be read: {name}", lost.len()),
            "put them where the model looks for them",
        );
    }
    if model.mesh.triangles.len() > BUDGET {
        let what = format!("{} triangles, expected at most {BUDGET}", model.mesh.triangles.len());
        say(
            false,
            what,
            "it is simplified every time it is read; simplify it once: `gltfpack -i in.glb -o out.glb -si 0.1 -noq`",
        );
    }
    if let Err(e) = repair::repair(&mut model) {
        say(true, e.at(&folder.join(&entry.file)).to_string(), "fix the file, or remove it from library.toml");
        return findings;
    }
    for (outcome, what, example) in model.notices.iter().filter(|n| n.1.starts_with("triangles")) {
        say(
            *outcome == Outcome::Dropped && what.contains("no points"),
            format!("{what}: {example}"),
            "clean the mesh in a 3D program",
        );
    }
    let edges = Edges::of(&model.mesh);
    let volume = volume(&model.mesh);
    if edges.open_share() < 0.02 && volume < 0.0 {
        say(false, "its surfaces face inwards".into(), "flip its normals in a 3D program");
    } else if edges.flipped_share() > 0.05 {
        let what = format!("{:.0} % of its edges join surfaces that face opposite ways", 100.0 * edges.flipped_share());
        say(false, what, "make its normals consistent in a 3D program");
    }
    if let Some(Err(e)) = entry.light.as_ref().map(|light| lamp::luminaire(folder, light, pictures)) {
        say(true, e.to_string(), "correct the table, or `light` in library.toml");
    }
    let mut entry = entry.clone();
    if let Err(e) = guess::complete(&mut entry, &model, None) {
        say(true, e.at(&folder.join(FILE_NAME)).to_string(), "correct library.toml");
        return findings;
    }
    let kind = kind_named(entry.kind.as_deref(), "").ok().flatten().flatten();
    let needed = kind.map(tags::needed).unwrap_or_default();
    let has = entry.tags.as_deref().unwrap_or_default();
    if !needed.is_empty() && !has.iter().any(|tag| needed.contains(&tag.as_str())) {
        let what = format!("tags = {has:?}, none of which is asked for with its kind: it will hardly ever be placed");
        say(false, what, &format!("give it some of: {}", needed.join(", ")));
    }
    if let Ok(Some(asset)) = asset("", &entry, model)
        && let Some(what) = misfit(asset.size_m, kind, &entry.file)
    {
        say(false, what, "correct kind, up, front or size in library.toml");
    }
    findings
}

fn lost_textures(notices: &[(Outcome, &'static str, String)]) -> Vec<String> {
    notices.iter().filter(|n| n.1.starts_with("a texture") && n.0 == Outcome::Dropped).map(|n| n.2.clone()).collect()
}

/// What says that a size is not one of its kind.
fn misfit(size: DVec3, kind: Option<Kind>, file: &str) -> Option<String> {
    let subject =
        subjects::named(file).map(|n| n.subject).filter(|s| s.kind == kind).or(subjects::of_kind(kind?, None))?;
    let expected = Expected::of(subject, file);
    // Three times what is usual for the kind and the length of an arm beside it cannot be made to fit a box.
    let off = |shape: &[f32; 3]| {
        (0..3)
            .map(|i| ((size[i] as f32).max(0.01) / shape[i]).ln().abs() / (3.0 * subject.spread[i] + 0.25))
            .fold(0.0, f32::max)
    };
    let best = expected.shapes.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
    (off(best) > 1.0).then(|| {
        format!(
            "{:.2} × {:.2} × {:.2} m (length × width × height); its kind is about {:.1} × {:.1} × {:.1} m",
            size.x, size.y, size.z, best[0], best[1], best[2]
        )
    })
}

fn of_surface(file: &LibraryFile, entry: &SurfaceEntry, pictures: &Pictures) -> Vec<Finding> {
    let mut findings = Vec::new();
    if entry.kind.as_deref() == Some("none") {
        return findings;
    }
    if entry.licence.is_none() && file.licence.is_none() {
        findings.push(finding(&entry.color, false, "no licence is known", "write `licence = \"…\"` into library.toml"));
    }
    let maps = [
        &entry.normal,
        &entry.roughness,
        &entry.metalness,
        &entry.occlusion,
        &entry.orm,
        &entry.displacement,
        &entry.opacity,
        &entry.emission,
    ];
    for map in maps.into_iter().flatten().chain([&entry.color]) {
        let bytes = pictures.folder.read(pictures.folder.path(), map).map_err(|e| e.to_string());
        if let Err(found) = bytes.and_then(|bytes| decode(&bytes, map, GLANCE_LIMIT)) {
            findings.push(finding(map, *map == entry.color, found, "replace it, or remove it from library.toml"));
        }
    }
    findings
}

/// Volume inside a mesh, negative where its surfaces face inwards.
fn volume(mesh: &Mesh) -> f64 {
    let middle = mesh.bounds().map_or(Vec3::ZERO, |(low, high)| (low + high) / 2.0).as_dvec3();
    let corner = |i: u32| mesh.positions[i as usize].as_dvec3() - middle;
    mesh.triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2])))).sum::<f64>() / 6.0
}

/// How triangles meet, by the places of their corners.
struct Edges {
    /// Edges of one triangle, of two that run opposite ways as they should, and of two that run the same way.
    open: usize,
    sound: usize,
    flipped: usize,
}

impl Edges {
    fn of(mesh: &Mesh) -> Self {
        let key = |i: u32| mesh.positions[i as usize].to_array().map(|v| (v + 0.0).to_bits());
        let mut places: BTreeMap<[u32; 3], u32> = BTreeMap::new();
        let ids: Vec<u32> = (0..mesh.positions.len() as u32)
            .map(|i| {
                let next = places.len() as u32;
                *places.entry(key(i)).or_insert(next)
            })
            .collect();
        let mut runs: BTreeMap<(u32, u32), [usize; 2]> = BTreeMap::new();
        for t in &mesh.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])].map(|(a, b)| (ids[a as usize], ids[b as usize])) {
                runs.entry((a.min(b), a.max(b))).or_default()[usize::from(a > b)] += 1;
            }
        }
        let count = |is: fn(&[usize; 2]) -> bool| runs.values().filter(|r| is(r)).count();
        Self {
            open: count(|r| r[0] + r[1] == 1),
            sound: count(|r| *r == [1, 1]),
            flipped: count(|r| *r == [2, 0] || *r == [0, 2]),
        }
    }

    fn share(&self, part: usize) -> f64 {
        part as f64 / (self.open + self.sound + self.flipped).max(1) as f64
    }

    fn open_share(&self) -> f64 {
        self.share(self.open)
    }

    fn flipped_share(&self) -> f64 {
        self.share(self.flipped)
    }
}

//! Pictures that belong together, by the naming of Poly Haven, ambientCG and Quixel.

use std::collections::{BTreeMap, BTreeSet};

use trove_model::SurfaceKind;

use super::library_file::{Guess, SurfaceEntry};
use super::licence::{Terms, nearest};
use super::names::surface_kind_name;
use super::scan::{folder_of, stem_of};
use super::tags;
use super::words::{match_of, words};

/// What a picture of a set shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Role {
    Color,
    NormalGl,
    NormalDx,
    Normal,
    Roughness,
    Metalness,
    Occlusion,
    Orm,
    Displacement,
    Opacity,
    Emission,
}

/// Ends of names in small letters, longest first where one ends with another.
const ENDS: [(&str, Role); 47] = [
    ("normalgl", Role::NormalGl),
    ("normaldx", Role::NormalDx),
    ("nor_gl", Role::NormalGl),
    ("nor_dx", Role::NormalDx),
    ("normal_gl", Role::NormalGl),
    ("normal_dx", Role::NormalDx),
    ("normal_opengl", Role::NormalGl),
    ("normal_directx", Role::NormalDx),
    ("normal", Role::Normal),
    ("nor", Role::Normal),
    ("nrm", Role::Normal),
    ("n", Role::NormalDx),
    ("basecolor", Role::Color),
    ("base_color", Role::Color),
    ("albedo", Role::Color),
    ("diffuse", Role::Color),
    ("diff", Role::Color),
    ("color", Role::Color),
    ("colour", Role::Color),
    ("col", Role::Color),
    ("b", Role::Color),
    ("d", Role::Color),
    ("roughness", Role::Roughness),
    ("rough", Role::Roughness),
    ("metalness", Role::Metalness),
    ("metallic", Role::Metalness),
    ("metal", Role::Metalness),
    ("ambientocclusion", Role::Occlusion),
    ("ambient_occlusion", Role::Occlusion),
    ("occlusion", Role::Occlusion),
    ("ao", Role::Occlusion),
    ("orm", Role::Orm),
    ("arm", Role::Orm),
    ("aorm", Role::Orm),
    ("displacement", Role::Displacement),
    ("disp", Role::Displacement),
    ("height", Role::Displacement),
    ("h", Role::Displacement),
    ("bump", Role::Displacement),
    ("opacity", Role::Opacity),
    ("alpha", Role::Opacity),
    ("mask", Role::Opacity),
    ("emission", Role::Emission),
    ("emissive", Role::Emission),
    ("emit", Role::Emission),
    ("e", Role::Emission),
    ("glow", Role::Emission),
];

/// A picture's set and role; `None` where its name does not end as one of a set.
fn role(path: &str) -> Option<(String, Role)> {
    let mut stem = stem_of(path).to_lowercase();
    // Resolution and format: `_2k`, `_1K-JPG`, `-4K`.
    loop {
        let cut = stem.rfind(['_', '-', ' ']).filter(|at| {
            let word = &stem[at + 1..];
            let resolution =
                word.strip_suffix('k').is_some_and(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()));
            resolution || ["jpg", "png", "exr"].contains(&word)
        });
        match cut {
            Some(at) => stem.truncate(at),
            None => break,
        }
    }
    let ends = |end: &str| {
        let name = stem.strip_suffix(end)?.strip_suffix(['_', '-', ' ', '.'])?;
        // In the middle the resolution goes as well: `Asphalt_1K-JPG_Color`.
        Some(name.to_owned())
    };
    let (name, role) = ENDS.iter().find_map(|(end, role)| ends(end).map(|name| (name, *role)))?;
    let name = ["_1k", "_2k", "_4k", "_8k", "_16k", "-1k", "-2k", "-4k", "-8k"].iter().fold(name, |n, resolution| {
        n.trim_end_matches("-jpg").trim_end_matches("-png").trim_end_matches(resolution).to_owned()
    });
    Some((format!("{}/{name}", folder_of(path)), role))
}

/// The sets among pictures: a colour and at least one other map. Folders with models have their textures to themselves.
pub(super) fn sets(pictures: &[String], models: &[String], terms: &[(String, Terms)]) -> Vec<SurfaceEntry> {
    let taken: BTreeSet<&str> = models.iter().map(|m| folder_of(m)).collect();
    let mut sets: BTreeMap<String, BTreeMap<Role, &String>> = BTreeMap::new();
    for picture in pictures.iter().filter(|p| !taken.contains(folder_of(p))) {
        if let Some((set, role)) = role(picture) {
            sets.entry(set).or_default().entry(role).or_insert(picture);
        }
    }
    let whole = sets.into_values().filter(|maps| maps.contains_key(&Role::Color) && maps.len() > 1);
    let mut entries: Vec<SurfaceEntry> = whole.map(|maps| entry(&maps, terms)).collect();
    // Sets of one name in two folders are told apart by their folders.
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for entry in &mut entries {
        let count = seen.entry(entry.name.clone()).or_default();
        *count += 1;
        if *count > 1 {
            entry.name = format!("{}-{count}", entry.name);
        }
    }
    entries
}

fn entry(maps: &BTreeMap<Role, &String>, terms: &[(String, Terms)]) -> SurfaceEntry {
    let map = |role: Role| maps.get(&role).map(|p| (*p).clone());
    let color = map(Role::Color).unwrap_or_default();
    let name = role(&color)
        .map_or_else(|| stem_of(&color).to_owned(), |(set, _)| set.rsplit('/').next().unwrap_or_default().to_owned());
    let mut e = SurfaceEntry {
        name,
        normal: map(Role::NormalGl).or_else(|| map(Role::Normal)).or_else(|| map(Role::NormalDx)),
        roughness: map(Role::Roughness),
        metalness: map(Role::Metalness),
        occlusion: map(Role::Occlusion),
        orm: map(Role::Orm),
        displacement: map(Role::Displacement),
        opacity: map(Role::Opacity),
        emission: map(Role::Emission),
        color,
        ..SurfaceEntry::default()
    };
    let style = match (
        maps.contains_key(&Role::NormalGl),
        maps.contains_key(&Role::Normal),
        maps.contains_key(&Role::NormalDx),
    ) {
        (true, ..) => Some("gl"),
        (false, false, true) => Some("dx"),
        _ => None,
    };
    let mut guess = |key, value: String, confidence, reason: &str| {
        e.guesses.push(Guess { key, value, confidence, reason: reason.into() });
    };
    let found = kind_of(&e.name).or_else(|| kind_of(folder_of(&e.color)));
    let kind = found.as_ref().map(|f| f.0);
    let (confidence, reason) = found
        .map_or((0.4, "no word in its name is a known surface".into()), |f| (0.85, format!("{:?} in its name", f.1)));
    guess("kind", format!("{:?}", surface_kind_name(kind)), confidence, &reason);
    e.kind = Some(surface_kind_name(kind));
    if let Some((tags, tagged)) = kind.and_then(|kind| tags::of_surface(&e.name, kind)) {
        guess(tagged.key, tagged.value, tagged.confidence, &tagged.reason);
        e.tags = Some(tags);
    }
    let side = match kind {
        Some(SurfaceKind::Asphalt | SurfaceKind::Grass | SurfaceKind::Soil) => 3.0,
        _ => 2.0,
    };
    guess("size_m", format!("[{side:?}, {side:?}]"), 0.4, "usual for its kind; measure a stone or a tile in the image");
    e.size_m = Some([side, side]);
    if let Some(style) = style {
        guess("normal_style", format!("{style:?}"), 0.95, "its name");
        e.normal_style = Some(style.into());
    }
    if let Some(terms) = nearest(terms, &e.color) {
        guess("licence", toml::Value::String(terms.licence.clone()).to_string(), 0.9, &terms.file);
        e.licence = Some(terms.licence.clone());
    }
    e
}

/// Words in the names of texture sets; facades, covers and signs need to know their cells, so nobody guesses them.
const KINDS: [(SurfaceKind, &str); 11] = [
    (SurfaceKind::Asphalt, "asphalt|tarmac|road|bitumen"),
    (SurfaceKind::Paving, "paving|paving stones|pavement|cobblestone|cobble|tiles|tile|floor tiles|sidewalk|pflaster"),
    (SurfaceKind::Concrete, "concrete|cement|beton"),
    (SurfaceKind::Grass, "grass|lawn|meadow|gras"),
    (SurfaceKind::Soil, "soil|ground|dirt|mud|earth|forest floor|sand|erde"),
    (SurfaceKind::Gravel, "gravel|pebbles|ballast|kies"),
    (SurfaceKind::RoofTiles, "roofing tiles|roof tiles|roof|roofing|shingles|dachziegel"),
    (
        SurfaceKind::Wall,
        "brick|bricks|plaster|stucco|wall|painted plaster|rock wall|stone wall|clapboard|siding|ziegel",
    ),
    (SurfaceKind::Wall, "corrugated steel|corrugated iron|corrugated"),
    (SurfaceKind::FlatRoof, "roofing felt|bitumen roof|flat roof"),
    (SurfaceKind::Water, "water"),
];

fn kind_of(name: &str) -> Option<(SurfaceKind, &'static str)> {
    let words = words(name);
    let phrases = KINDS.iter().flat_map(|(kind, all)| all.split('|').map(move |p| (*kind, p)));
    let scored = phrases.map(|(kind, p)| (match_of(&words, p), kind, p)).filter(|s| s.0 > 0);
    scored.reduce(|a, b| if b.0 > a.0 { b } else { a }).map(|(_, kind, phrase)| (kind, phrase))
}

/// The names of sets that were found, as the library writes their files, for those already in it.
pub(super) fn is_known(known: &[SurfaceEntry], found: &SurfaceEntry) -> bool {
    known.iter().any(|k| k.color == found.color)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_of_three_makers_are_found() {
        let pictures: Vec<String> = [
            "a/brick_wall_001_diff_2k.jpg",
            "a/brick_wall_001_nor_gl_2k.exr",
            "a/brick_wall_001_arm_2k.jpg",
            "a/brick_wall_001_disp_2k.png",
            "b/PavingStones092_1K-JPG_Color.jpg",
            "b/PavingStones092_1K-JPG_NormalDX.jpg",
            "b/PavingStones092_1K-JPG_Roughness.jpg",
            "c/T_Gravel_xyz_4K_B.png",
            "c/T_Gravel_xyz_4K_N.png",
            "c/T_Gravel_xyz_4K_ORM.png",
            "d/holiday.jpg",
            "e/Lonely_Color.jpg",
        ]
        .map(String::from)
        .to_vec();
        let sets = sets(&pictures, &["x/car.fbx".into()], &[]);
        let kinds: Vec<&str> = sets.iter().filter_map(|s| s.kind.as_deref()).collect();
        assert_eq!(kinds, ["wall", "paving", "gravel"]);
        assert_eq!(sets[0].orm.as_deref(), Some("a/brick_wall_001_arm_2k.jpg"));
        assert_eq!((sets[0].normal_style.as_deref(), sets[1].normal_style.as_deref()), (Some("gl"), Some("dx")));
        assert_eq!(sets[2].normal.as_deref(), Some("c/T_Gravel_xyz_4K_N.png"));
        assert_eq!(sets[1].name, "pavingstones092");
    }
}

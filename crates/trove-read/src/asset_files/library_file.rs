//! `library.toml`: what a folder of models, textures and skies holds, and how to take it.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::Path;

use glam::DVec3;
use serde::Deserialize;
use trove_files::{LARGEST_TEXT, read_text};

use super::axes::Axis;
use super::fault::Fault;
use super::names::{class_named, kind_named, role_named, surface_kind_named};
use crate::ReadError;

/// The file's name in its folder.
pub const FILE_NAME: &str = "library.toml";

/// What stands in a `library.toml`, completed by guesses.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LibraryFile {
    /// Licence of everything that does not say otherwise (an SPDX name where it has one).
    pub licence: Option<String>,
    /// Who made what does not say otherwise.
    pub author: Option<String>,
    /// Where what does not say otherwise is from.
    pub source: Option<String>,
    /// Models, in the order of the file.
    #[serde(rename = "asset")]
    pub assets: Vec<AssetEntry>,
    /// Texture sets, in the order of the file.
    #[serde(rename = "surface")]
    pub surfaces: Vec<SurfaceEntry>,
    /// Skies, in the order of the file.
    #[serde(rename = "environment")]
    pub environments: Vec<EnvironmentEntry>,
}

/// A value that the file did not give.
#[derive(Clone, Debug, PartialEq)]
pub struct Guess {
    /// The key in `library.toml`.
    pub key: &'static str,
    /// The value as it is written there.
    pub value: String,
    /// How sure it is, 0 to 1.
    pub confidence: f32,
    /// What speaks for it.
    pub reason: String,
}

/// A model.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AssetEntry {
    /// Path from the library's folder, with `/`.
    pub file: String,
    /// The node to take, with all that hangs on it; everything without.
    pub part: Option<String>,
    /// [`Kind`](trove_model::Kind) in snake case, or `none` for what is not to be placed.
    pub kind: Option<String>,
    /// Name of the [`Class`](trove_model::Class) where it is not the kind's own.
    pub class: Option<String>,
    /// What it is besides its kind: lower-case words that the builder may ask for.
    pub tags: Option<Vec<String>>,
    /// The file's axis that points up.
    pub up: Option<Axis>,
    /// The file's axis that points forward.
    pub front: Option<Axis>,
    /// Metres a unit of the file; or else one of the two below.
    pub unit_m: Option<f64>,
    /// Metres from its lowest to its highest point.
    pub height_m: Option<f64>,
    /// Metres from its foremost to its rearmost point.
    pub length_m: Option<f64>,
    /// `standing`, `walking`, `running` or `sitting`, for people on foot.
    pub posture: Option<String>,
    /// What its materials do in a scene: names of [`Role`](trove_model::Role)s by the materials' names.
    pub roles: BTreeMap<String, String>,
    /// How its `street_lamp`s shine.
    pub light: Option<LightEntry>,
    /// How often it is drawn among those that fit as well; 1 is ordinary.
    pub commonness: Option<f32>,
    /// What of a building may stand there several times.
    pub repeats: RepeatsEntry,
    /// ISO 3166-1 codes of the countries in which it is met; without any: everywhere.
    pub countries: Vec<String>,
    /// Names of what its clothes are worn in ([`Outdoors`](trove_model::Outdoors)); without any: always.
    pub worn_in: Vec<String>,
    /// As the library's.
    pub licence: Option<String>,
    /// As the library's.
    pub author: Option<String>,
    /// As the library's.
    pub source: Option<String>,
    /// What of the above is guessed.
    #[serde(skip)]
    pub guesses: Vec<Guess>,
    /// Length, width and height that it has by the above, metres; `None` until [`super::import`] has measured it.
    #[serde(skip)]
    pub size_m: Option<DVec3>,
}

/// Slabs of a building along its front, along its depth and upwards: from and to, metres, of the model as it is placed: the
/// middle of its plan and its lowest point at 0, its front towards −y.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RepeatsEntry {
    /// A bay or some.
    pub x: Option<[f64; 2]>,
    /// A bay of its sides or some.
    pub y: Option<[f64; 2]>,
    /// A storey or some.
    pub z: Option<[f64; 2]>,
}

/// How a street lamp shines.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LightEntry {
    /// Path of an IES file from the library's folder; without, it is matt and shines down.
    pub table: Option<String>,
    /// All that it gives; those of its table without.
    pub lumens: Option<f32>,
    /// Colour temperature.
    pub kelvin: Option<f32>,
}

/// A texture set.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SurfaceEntry {
    /// Unique in its library.
    pub name: String,
    /// [`SurfaceKind`](trove_model::SurfaceKind) in snake case, or `none` for what is not to be used.
    pub kind: Option<String>,
    /// What it is besides its kind: lower-case words that the builder may ask for.
    pub tags: Option<Vec<String>>,
    /// Metres that the picture covers along u and v.
    pub size_m: Option<[f32; 2]>,
    /// For facades: bays and storeys in the picture; for covers, signs and rooms how many across and up.
    pub cells: Option<[u32; 2]>,
    /// Height of white in the displacement above black, metres.
    pub height_m: Option<f32>,
    /// Picture of the base colour.
    pub color: String,
    /// Picture of tangent-space normals.
    pub normal: Option<String>,
    /// `gl` (green up) or `dx` (green down).
    pub normal_style: Option<String>,
    /// Picture of perceptual roughness.
    pub roughness: Option<String>,
    /// Picture of metalness.
    pub metalness: Option<String>,
    /// Picture of ambient occlusion.
    pub occlusion: Option<String>,
    /// Occlusion, roughness and metalness in red, green and blue.
    pub orm: Option<String>,
    /// Picture of heights.
    pub displacement: Option<String>,
    /// Picture of coverage.
    pub opacity: Option<String>,
    /// Picture of what shines; surfaces shine by its mean.
    pub emission: Option<String>,
    /// As the library's.
    pub licence: Option<String>,
    /// What of the above is guessed.
    #[serde(skip)]
    pub guesses: Vec<Guess>,
}

/// No road scene has a larger model.
const LARGEST_M: f64 = 10_000.0;

/// A photographed sky, to be named in a recipe's `light.environment`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EnvironmentEntry {
    /// Path from the library's folder, with `/`.
    pub file: String,
    /// As the library's.
    pub licence: Option<String>,
}

impl<'de> Deserialize<'de> for Axis {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let unknown = || serde::de::Error::custom(format!("expected +x, -x, +y, -y, +z or -z, found {name:?}"));
        Self::from_name(&name).ok_or_else(unknown)
    }
}

impl LibraryFile {
    /// Reads a folder's `library.toml`.
    ///
    /// # Errors
    /// A file that is missing, is not TOML, or has a key or a value that libraries do not have.
    pub fn read(folder: &Path) -> Result<Self, ReadError> {
        let path = folder.join(FILE_NAME);
        let text = read_text(&path, LARGEST_TEXT).map_err(|source| match source.kind() {
            std::io::ErrorKind::NotFound => ReadError::Missing {
                path: folder.to_owned(),
                expected: FILE_NAME.into(),
                found: "a folder without it".into(),
                remedy: "write one: `trove assets import FOLDER`".into(),
            },
            _ => ReadError::io(&path, source),
        })?;
        Self::parse(&text).map_err(|fault| fault.at(&path))
    }

    pub(super) fn parse(text: &str) -> Result<Self, Fault> {
        let file: Self = toml::from_str(text).map_err(|e| {
            let line = e.span().map_or(1, |span| 1 + text.get(..span.start).map_or(0, |t| t.matches('\n').count()));
            let remedy = "correct it as docs/assets.md describes";
            Fault::new(format!("line {line}"), "a library", e.message(), remedy)
        })?;
        for entry in &file.assets {
            let place = format!("asset {:?}", entry.file);
            tags_are_words(entry.tags.as_deref(), &place)?;
            kind_named(entry.kind.as_deref(), &place)?;
            class_named(entry.class.as_deref(), &place)?;
            entry.roles.values().try_for_each(|role| role_named(role, &place).map(drop))?;
            if let Some(LightEntry { lumens, kelvin, .. }) = &entry.light {
                in_range(&place, "light.lumens", lumens.as_slice(), 1.0..=1e6)?;
                in_range(&place, "light.kelvin", kelvin.as_slice(), 1667.0..=25_000.0)?;
            }
            let is_code = |code: &&String| code.len() == 2 && code.chars().all(|c| c.is_ascii_uppercase());
            if let Some(wrong) = entry.countries.iter().find(|code| !is_code(code)) {
                let expected = "ISO 3166-1 codes of countries, such as \"GB\"";
                return Err(Fault::new(format!("{place}: countries"), expected, format!("{wrong:?}"), "correct it"));
            }
            let sizes = [entry.unit_m, entry.height_m, entry.length_m];
            if sizes.iter().flatten().count() > 1 {
                let expected = "one of unit_m, height_m and length_m";
                return Err(Fault::new(place, expected, "several", "leave one of them"));
            }
            if let Some(wrong) = sizes.into_iter().flatten().find(|s| !(*s > 0.0 && *s <= LARGEST_M)) {
                return Err(Fault::new(place, "a size above 0, at most 10 km", wrong.to_string(), "correct it"));
            }
            if let (Some(up), Some(front)) = (entry.up, entry.front)
                && up.is_along(front)
            {
                let found = format!("up {} and front {}", up.name(), front.name());
                return Err(Fault::new(place, "up and front at right angles", found, "correct one of them"));
            }
        }
        for entry in &file.surfaces {
            let place = format!("surface {:?}", entry.name);
            surface_kind_named(entry.kind.as_deref(), &place)?;
            tags_are_words(entry.tags.as_deref(), &place)?;
            numbers_make_sense(entry, &place)?;
        }
        Ok(file)
    }
}

fn numbers_make_sense(entry: &SurfaceEntry, place: &str) -> Result<(), Fault> {
    in_range(place, "size_m", entry.size_m.as_ref().map_or(&[], |size| size), 0.001..=1000.0)?;
    in_range(place, "height_m", entry.height_m.as_slice(), 0.0..=10.0)?;
    in_range(place, "cells", &entry.cells.unwrap_or([1; 2]).map(|n| n as f32), 1.0..=1000.0)
}

fn in_range(place: &str, key: &str, numbers: &[f32], range: RangeInclusive<f32>) -> Result<(), Fault> {
    let Some(wrong) = numbers.iter().find(|number| !range.contains(number)) else { return Ok(()) };
    let expected = format!("{} to {}", range.start(), range.end());
    Err(Fault::new(format!("{place}: {key}"), expected, wrong.to_string(), "correct it"))
}

/// A tag with a space or a capital in it would never be found.
fn tags_are_words(tags: Option<&[String]>, place: &str) -> Result<(), Fault> {
    let is_word = |tag: &&String| !tag.is_empty() && !tag.contains(|c: char| c.is_whitespace() || c.is_uppercase());
    match tags.unwrap_or_default().iter().find(|tag| !is_word(tag)) {
        None => Ok(()),
        Some(tag) => {
            let remedy = "write it like `chain-link`";
            Err(Fault::new(format!("{place}, tags"), "lower-case words without spaces", format!("{tag:?}"), remedy))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_are_named_with_their_place() {
        for (text, place, what) in [
            ("[[asset]]\nfile = \"a.glb\"\nkindd = \"car\"", "line 3", "kindd"),
            ("[[asset]]\nfile = \"a.glb\"\nkind = \"cra\"", "a.glb", "did you mean"),
            ("[[asset]]\nfile = \"a.glb\"\nup = \"top\"", "line 3", "+x, -x"),
            ("[[asset]]\nfile = \"a.glb\"\nup = \"+y\"\nfront = \"-y\"", "a.glb", "right angles"),
            ("[[asset]]\nfile = \"a.glb\"\nunit_m = 0.0", "a.glb", "above 0"),
            ("[[asset]]\nfile = \"a.glb\"\nunit_m = 1.0\nheight_m = 2.0", "a.glb", "several"),
            ("[[asset]]\nfile = \"a.glb\"\ntags = [\"chain link\"]", "a.glb", "chain-link"),
            ("[[surface]]\nname = \"a\"\ncolor = \"a.png\"\ntags = [\"Red\"]", "\"a\", tags", "lower-case"),
            ("[[asset]]\nfile = \"a.glb\"\nheight_m = 1e9", "a.glb", "10 km"),
            ("[[asset]]\nfile = \"a.glb\"\nlength_m = nan", "a.glb", "above 0"),
            ("[[surface]]\nname = \"a\"\ncolor = \"a.png\"\nsize_m = [nan, 1.0]", "\"a\": size_m", "0.001 to 1000"),
            ("[[surface]]\nname = \"a\"\ncolor = \"a.png\"\nheight_m = -1.0", "\"a\": height_m", "0 to 10"),
            ("[[surface]]\nname = \"a\"\ncolor = \"a.png\"\ncells = [4000000000, 1]", "\"a\": cells", "1 to 1000"),
            ("[[asset]\n", "line 1", "a library"),
        ] {
            let message = LibraryFile::parse(text).unwrap_err().at(Path::new("library.toml")).to_string();
            assert!(message.contains(place) && message.contains(what), "{message}");
        }
    }
}

//! Grids around the vehicle (TOML) → `GridPlan`s: those of benchmarks by name, and others from files of the same form.

use std::path::Path;

use glam::DVec3;
use serde::Deserialize;
use trove_files::{LARGEST_TEXT, read_text};
use trove_model::{ClassMap, GridForm, GridFrame, GridPlan, VoxelGrid};

use crate::toml_fault::{self, nearest};
use crate::{ReadError, read_class_map};

/// Grids that need no file, by name.
const PRESETS: [(&str, &str); 3] = [
    ("birds-eye", include_str!("presets/birds-eye.toml")),
    ("occ3d-nuscenes", include_str!("presets/occ3d-nuscenes.toml")),
    ("openoccupancy", include_str!("presets/openoccupancy.toml")),
];
/// More cells would not stay in memory beside the scene.
const MOST_CELLS: usize = 1 << 26;
const MOST_A_SIDE: usize = 4096;

/// A grid as its file has it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct GridFile {
    /// Whose numbers they are; for people.
    #[serde(rename = "source")]
    _source: Option<String>,
    #[serde(default)]
    frame: FrameName,
    low_m: [f64; 3],
    voxel_m: f64,
    cells: [usize; 3],
    /// A class map's name, or its file beside this one.
    classes: String,
    #[serde(default = "yes")]
    solid: bool,
    #[serde(default)]
    form: FormName,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum FrameName {
    #[default]
    Ego,
    Lidar,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum FormName {
    #[default]
    Dense,
    Sparse,
}

fn yes() -> bool {
    true
}

/// Names of the grids that need no file, in alphabetical order.
pub fn presets() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|(name, _)| *name)
}

/// A grid that needs no file; `None` for a name that is no such one's.
pub fn preset(name: &str) -> Option<GridPlan> {
    let (_, text) = PRESETS.iter().find(|(preset, _)| *preset == name)?;
    parse(name, text, None).ok()
}

/// Reads a grid's file, and the class map that it names.
///
/// # Errors
/// Files that cannot be read, are not TOML, or whose numbers make no grid.
pub fn read(path: &Path) -> Result<GridPlan, ReadError> {
    let text = read_text(path, LARGEST_TEXT).map_err(|source| ReadError::io(path, source))?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let fault = |(place, expected, found): Fault| ReadError::Format {
        path: path.to_owned(),
        place,
        expected,
        found,
        remedy: "see docs/grids.md".into(),
    };
    let classes = class_map(path).map(|beside| read_class_map(&path.with_file_name(beside))).transpose()?;
    parse(&name, &text, classes).map_err(fault)
}

/// The file of the class map that a grid's file names, as seen from there; `None` for a built-in map, and for a file that is
/// no grid.
pub fn class_map(path: &Path) -> Option<String> {
    let file: GridFile = toml::from_str(&read_text(path, LARGEST_TEXT).ok()?).ok()?;
    file.classes.ends_with(".toml").then_some(file.classes)
}

/// The place, what was expected there, and what was found.
type Fault = (String, String, String);

fn parse(name: &str, text: &str, own: Option<ClassMap>) -> Result<GridPlan, Fault> {
    let file: GridFile = toml::from_str(text)
        .map_err(|error| (toml_fault::place(text, &error), "a grid in TOML".to_owned(), error.message().to_owned()))?;
    let check = |key: &str, fits: bool, expected: &str, found: String| {
        if fits { Ok(()) } else { Err((key.to_owned(), expected.to_owned(), found)) }
    };
    check("voxel_m", (0.01..=100.0).contains(&file.voxel_m), "0.01 to 100", file.voxel_m.to_string())?;
    let cells: usize = file.cells.iter().fold(1, |product, &count| product.saturating_mul(count));
    let sides = file.cells.iter().all(|count| (1..=MOST_A_SIDE).contains(count));
    let expected = format!("1 to {MOST_A_SIDE} along each axis and at most {MOST_CELLS} in all");
    check("cells", sides && cells <= MOST_CELLS, &expected, format!("{:?}", file.cells))?;
    let near = file.low_m.iter().all(|m| m.abs() <= 10_000.0);
    check("low_m", near, "three numbers of at most 10000", format!("{:?}", file.low_m))?;
    let classes = ClassMap::named(&file.classes).or(own).ok_or_else(|| {
        let known = ClassMap::NAMES;
        let hint = nearest(&file.classes, known.into_iter());
        (
            "classes".to_owned(),
            format!("one of {}, or a FILE.toml", known.join(", ")),
            format!("{:?}{hint}", file.classes),
        )
    })?;
    Ok(GridPlan {
        name: name.to_owned(),
        grid: VoxelGrid { low_m: DVec3::from_array(file.low_m), voxel_m: file.voxel_m, counts: file.cells },
        frame: match file.frame {
            FrameName::Ego => GridFrame::Ego,
            FrameName::Lidar => GridFrame::Lidar,
        },
        classes,
        is_solid: file.solid,
        form: match file.form {
            FormName::Dense => GridForm::Dense,
            FormName::Sparse => GridForm::Sparse,
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_presets_are_as_their_benchmarks_say() {
        for (name, low, high, counts, free) in [
            ("birds-eye", [-50.0, -50.0, -2.0], [50.0, 50.0, 6.0], [200, 200, 16], 17),
            ("occ3d-nuscenes", [-40.0, -40.0, -1.0], [40.0, 40.0, 5.4], [200, 200, 16], 17),
            ("openoccupancy", [-51.2, -51.2, -5.0], [51.2, 51.2, 3.0], [512, 512, 40], 17),
        ] {
            let plan = preset(name).unwrap();
            let grid = plan.grid;
            assert_eq!((grid.low_m.to_array(), grid.counts, plan.classes.unlabelled), (low, counts, free));
            assert!((grid.low_m + grid.size() * grid.voxel_m - DVec3::from_array(high)).length() < 1e-9, "{name}");
        }
        assert_eq!(presets().collect::<Vec<_>>(), PRESETS.map(|(name, _)| name));
        assert_eq!(preset("occ3d"), None);
    }

    #[test]
    fn a_file_may_have_classes_of_its_own_and_what_makes_no_grid_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.toml");
        let good = "low_m = [0, -5, -1]\nvoxel_m = 0.5\ncells = [40, 20, 8]\nclasses = \"map.toml\"\nsolid = false\n";
        std::fs::write(
            folder.path().join("map.toml"),
            "unlabelled = 9\n[[class]]\nid = 1\nname = \"road\"\ntrove = [\"road\"]",
        )
        .unwrap();
        std::fs::write(&path, good).unwrap();
        let plan = read(&path).unwrap();
        assert_eq!((plan.name.as_str(), plan.classes.unlabelled, plan.is_solid), ("mine", 9, false));
        for (from, to, expect) in [
            ("cells = [40", "cells = [0", "cells: expected 1 to 4096"),
            ("cells = [40, 20, 8]", "cells = [4000, 4000, 40]", "at most 67108864"),
            ("voxel_m = 0.5", "voxel_m = 0", "voxel_m: expected 0.01 to 100, found 0"),
            ("map.toml", "occ3", "did you mean \"occ3d\"?"),
            ("map.toml", "other.toml", "other.toml"),
            ("solid", "full", "unknown field `full`"),
        ] {
            std::fs::write(&path, good.replace(from, to)).unwrap();
            let error = read(&path).unwrap_err().to_string();
            assert!(error.contains(expect), "{error}");
        }
    }
}

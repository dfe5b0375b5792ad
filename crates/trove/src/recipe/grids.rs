//! `[grids.NAME]`: cells around the vehicle.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail, ensure};
use serde::{Deserialize, Serialize};
use trove_files::PathComponent;
use trove_model::GridPlan;
use trove_read::grid;

use super::check::nearest;
use super::sensors::SensorsSection;

/// Grids by their names.
pub type GridsSection = BTreeMap<String, GridSection>;

/// `[grids.NAME]`
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct GridSection {
    /// A benchmark's grid, or a path that ends in `.toml`.
    pub preset: String,
}

/// Checks names.
pub(super) fn check_all(grids: &GridsSection, sensors: &SensorsSection) -> Result<()> {
    for (name, section) in grids {
        ensure!(PathComponent::new(name).is_ok(), "grids: expected names that folders can have, found {name:?}");
        ensure!(
            !sensors.contains_key(name),
            "grids.{name}: expected another name than a sensor's, since both are folders of a keyframe"
        );
        if section.file().is_none() && grid::preset(&section.preset).is_none() {
            let known: Vec<&str> = grid::presets().collect();
            let hint = nearest(&section.preset, &known);
            bail!(
                "grids.{name}.preset: expected one of {}, or a path that ends in .toml, found {:?}{hint}",
                known.join(", "),
                section.preset
            );
        }
    }
    Ok(())
}

impl GridSection {
    /// The file that says what it is, as the recipe has it; `None` for a preset.
    fn file(&self) -> Option<&Path> {
        self.preset.ends_with(".toml").then(|| Path::new(&self.preset))
    }

    /// The files that it is made from, as the recipe has them.
    pub fn files(&self, at: impl Fn(&Path) -> PathBuf) -> Vec<PathBuf> {
        let Some(file) = self.file() else { return Vec::new() };
        let classes = grid::class_map(&at(file)).map(|beside| file.with_file_name(beside));
        [file.to_owned()].into_iter().chain(classes).collect()
    }

    /// The grid itself; `at` is where its file lies.
    ///
    /// # Errors
    /// A file that cannot be read or makes no grid.
    pub fn plan(&self, at: impl Fn(&Path) -> PathBuf) -> Result<GridPlan> {
        match self.file() {
            Some(file) => Ok(grid::read(&at(file))?),
            None => match grid::preset(&self.preset) {
                Some(plan) => Ok(plan),
                None => bail!("grids: {:?} is no grid", self.preset),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_is_a_preset_or_a_file_with_a_name_of_its_own() {
        let sensors: SensorsSection = toml::from_str("[TOP]\nkind = \"lidar\"\npreset = \"vlp-16\"").unwrap();
        let parse = |text: &str| -> Result<GridsSection> {
            let grids: GridsSection = toml::from_str(text)?;
            check_all(&grids, &sensors)?;
            Ok(grids)
        };
        let grids = parse("[OCC3D]\npreset = \"occ3d-nuscenes\"\n[MINE]\npreset = \"a/my.toml\"").unwrap();
        assert_eq!(grids["OCC3D"].plan(|file| file.to_owned()).unwrap().grid.counts, [200, 200, 16]);
        assert_eq!(grids["MINE"].files(|file| file.to_owned()), [Path::new("a/my.toml")]);
        assert!(grids["MINE"].plan(|file| file.to_owned()).is_err());
        for (text, expect) in [
            ("[A]\npreset = \"occ3d-nuscene\"", "did you mean `occ3d-nuscenes`?"),
            ("[\"a/b\"]\npreset = \"openoccupancy\"", "names that folders can have"),
            ("[A]\npreset = \"openoccupancy\"\nsize = 3", "unknown field `size`"),
            ("[TOP]\npreset = \"openoccupancy\"", "another name than a sensor's"),
        ] {
            let error = format!("{:#}", parse(text).unwrap_err());
            assert!(error.contains(expect), "{error}");
        }
    }
}

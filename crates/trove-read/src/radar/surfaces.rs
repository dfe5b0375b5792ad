//! How surfaces reflect a radar's waves, as files tell.

use std::collections::BTreeMap;

use serde::Deserialize;
use trove_model::{CLASSES, Class, RadarSurface, RadarSurfaces};

use super::bounds::{Fault, within};

const BUILT_IN: &str = include_str!("surfaces.toml");

/// Kinds of surfaces by their names, and which classes and materials are of them.
#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct SurfacesFile {
    kinds: BTreeMap<String, SurfaceRow>,
    classes: BTreeMap<String, String>,
    materials: BTreeMap<String, String>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct SurfaceRow {
    reflectance: f64,
    #[serde(default)]
    diffuse: f64,
    spread: f64,
    #[serde(default)]
    height_mm: f64,
    #[serde(default)]
    passes: f64,
}

impl SurfacesFile {
    /// The built-in ones, with these in the place of those of the same names.
    pub(super) fn surfaces(self) -> Result<RadarSurfaces, Fault> {
        let mut all: Self = toml::from_str(BUILT_IN)
            .map_err(|error| ("surfaces".to_owned(), "surfaces in TOML".to_owned(), error.message().to_owned()))?;
        if let Some(name) = self.classes.keys().find(|name| !all.classes.contains_key(*name)) {
            return Err(("surfaces.classes".into(), "names of classes".into(), name.clone()));
        }
        if let Some(name) = self.materials.keys().find(|name| !all.materials.contains_key(*name)) {
            return Err(("surfaces.materials".into(), "metal or pane".into(), name.clone()));
        }
        all.kinds.extend(self.kinds);
        all.classes.extend(self.classes);
        all.materials.extend(self.materials);
        let mut of_class = [RadarSurface::default(); Class::ALL.len()];
        for row in CLASSES.iter() {
            of_class[usize::from(row.class.id())] = all.named("classes", row.name)?;
        }
        Ok(RadarSurfaces { of_class, metal: all.named("materials", "metal")?, pane: all.named("materials", "pane")? })
    }

    /// The surface of a class or a material.
    fn named(&self, table: &str, name: &str) -> Result<RadarSurface, Fault> {
        let names = if table == "classes" { &self.classes } else { &self.materials };
        let kind = names.get(name).map_or("", String::as_str);
        let known = || self.kinds.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
        let row = self.kinds.get(kind);
        let row = row.ok_or_else(|| (format!("surfaces.{table}.{name}"), known(), kind.to_owned()))?;
        let within = |key: &str, value: f64, low: f64, high: f64| {
            within(&format!("surfaces.kinds.{kind}.{key}"), value, low, high)
        };
        Ok(RadarSurface {
            reflectance: within("reflectance", row.reflectance, 0.0, 1.0)?,
            diffuse: within("diffuse", row.diffuse, 0.0, 1.0)?,
            spread: within("spread", row.spread, 0.02, 1.0)?,
            height_m: within("height_mm", row.height_mm, 0.0, 1000.0)? * 1e-3,
            passes: within("passes", row.passes, 0.0, 1.0)?,
        })
    }
}

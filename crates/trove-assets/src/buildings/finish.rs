//! What plans of buildings name: materials of their own, common ones, and surfaces of the library.

use glam::{Vec3, vec3};
use serde::Deserialize;
use trove_model::Material;

use super::site::Site;

/// Colour, roughness and metalness of what many buildings have.
const COMMON: [(&str, [f32; 3], f32, f32); 16] = [
    ("brick", [0.2, 0.115, 0.08], 0.9, 0.0),
    ("stock brick", [0.25, 0.19, 0.12], 0.9, 0.0),
    ("stone", [0.36, 0.34, 0.3], 0.85, 0.0),
    ("white", [0.55, 0.54, 0.51], 0.8, 0.0),
    ("white wood", [0.58, 0.58, 0.58], 0.6, 0.0),
    ("cream", [0.5, 0.45, 0.35], 0.85, 0.0),
    ("sheet metal", [0.34, 0.36, 0.37], 0.45, 0.0),
    ("grey", [0.3, 0.31, 0.32], 0.6, 0.0),
    ("dark", [0.06, 0.06, 0.062], 0.45, 0.0),
    ("louvres", [0.07, 0.07, 0.07], 0.6, 0.0),
    ("metal", [0.4, 0.41, 0.41], 0.45, 0.6),
    ("bronze", [0.1, 0.075, 0.05], 0.4, 0.3),
    ("lead", [0.16, 0.165, 0.17], 0.6, 0.2),
    ("timber", [0.17, 0.1, 0.055], 0.7, 0.0),
    ("door", [0.05, 0.07, 0.08], 0.4, 0.0),
    // Nothing is behind it: it mirrors the street, as two coated panes do, before a dark room.
    ("glass", [0.15, 0.17, 0.18], 0.04, 0.6),
];

/// A material of one building.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FinishPlan {
    /// The surface that it is, if it is no plain colour; colours multiply it.
    pub(super) surface: Option<String>,
    /// Where there are more than one, every copy of the building has one of them.
    #[serde(default)]
    pub(super) colors: Vec<[f32; 3]>,
    #[serde(default = "rough")]
    pub(super) roughness: f32,
    #[serde(default)]
    pub(super) metalness: f32,
}

fn rough() -> f32 {
    0.8
}

/// Whether a name needs no finish of the building's own; whether a surface is there shows when it is built.
pub(super) fn is_known(name: &str) -> bool {
    name.contains('/') || COMMON.iter().any(|common| common.0 == name)
}

/// The slot of a common finish or of a surface.
pub(super) fn common(site: &mut Site<'_>, name: &str) -> u16 {
    match COMMON.iter().find(|common| common.0 == name) {
        Some(&(name, color, roughness, metalness)) => {
            site.plain(Material { metalness, ..Material::plain(name, color.into(), roughness) })
        }
        None => site.surface(name),
    }
}

/// The slot of a building's own finish.
pub(super) fn own(site: &mut Site<'_>, name: &str, plan: &FinishPlan) -> u16 {
    let colors: Vec<Vec3> = plan.colors.iter().copied().map(Vec3::from_array).collect();
    let first = colors.first().copied();
    let material = match &plan.surface {
        Some(id) => {
            let bare = site.material(id);
            Material { name: format!("{id} as {name}"), base_color: first.unwrap_or(bare.base_color), ..bare }
        }
        None => {
            let color = first.unwrap_or(vec3(0.4, 0.39, 0.37));
            Material { metalness: plan.metalness, ..Material::plain(name, color, plan.roughness) }
        }
    };
    site.painted(material, if colors.len() > 1 { &colors } else { &[] })
}

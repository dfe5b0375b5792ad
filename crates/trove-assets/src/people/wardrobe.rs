//! What people wear, and the colours that it comes in.

use glam::{Vec3, vec3};
use trove_model::{Asset, Material, Outdoors};

use crate::shape::Model;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sleeve {
    Long,
    Short,
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Leg {
    Trousers,
    Shorts,
    Skirt,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Hair {
    Short,
    Long,
    Bun,
    Tail,
}

/// The cut of someone's clothes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outfit {
    pub(crate) sleeve: Sleeve,
    pub(crate) leg: Leg,
    pub(crate) hair: Hair,
    /// How far the cloth stands off the body.
    pub(crate) loose_m: f32,
    /// How far the top reaches below the hips, a share of the height.
    pub(crate) hem: f32,
}

impl Outfit {
    /// T-shirt and trousers.
    pub(crate) const CASUAL: Self =
        Self { sleeve: Sleeve::Short, leg: Leg::Trousers, hair: Hair::Short, loose_m: 0.006, hem: 0.02 };
    /// A jacket.
    pub(crate) const JACKET: Self = Self { sleeve: Sleeve::Long, loose_m: 0.016, hem: 0.04, ..Self::CASUAL };

    /// Someone in these clothes, built under an id; where they leave arms or legs bare, for warm days alone, and once more in a
    /// jacket and long trousers for all others.
    pub(crate) fn in_all_weathers(self, id: &str, build: impl Fn(&str, &Self) -> Asset) -> Vec<Asset> {
        if self.sleeve == Sleeve::Long && self.leg == Leg::Trousers {
            return vec![build(id, &self)];
        }
        let jacket = Self { hair: self.hair, ..Self::JACKET };
        let light = Asset { worn_in: vec![Outdoors::Warm], ..build(id, &self) };
        let others = vec![Outdoors::Mild, Outdoors::Wet, Outdoors::Cold];
        vec![light, Asset { worn_in: others, ..build(&format!("{id}-jacket"), &jacket) }]
    }
}

/// The slots of a person.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wardrobe {
    pub(crate) skin: u16,
    pub(crate) hair: u16,
    pub(crate) top: u16,
    pub(crate) bottom: u16,
    pub(crate) shoes: u16,
    /// Eyes, mouth, straps.
    pub(crate) dark: u16,
}

/// Light to dark, about as people of a large city are.
pub(crate) const SKINS: [Vec3; 7] = [
    vec3(0.56, 0.36, 0.27),
    vec3(0.5, 0.31, 0.22),
    vec3(0.47, 0.29, 0.19),
    vec3(0.42, 0.25, 0.16),
    vec3(0.33, 0.18, 0.11),
    vec3(0.19, 0.1, 0.06),
    vec3(0.1, 0.052, 0.033),
];
const HAIRS: [Vec3; 6] = [
    vec3(0.009, 0.008, 0.008),
    vec3(0.012, 0.01, 0.009),
    vec3(0.03, 0.018, 0.011),
    vec3(0.055, 0.03, 0.016),
    vec3(0.2, 0.13, 0.065),
    vec3(0.3, 0.29, 0.28),
];
/// Shirts and jackets.
pub(crate) const TOPS: [Vec3; 14] = [
    vec3(0.72, 0.72, 0.7),
    vec3(0.66, 0.67, 0.7),
    vec3(0.012, 0.012, 0.014),
    vec3(0.02, 0.02, 0.022),
    vec3(0.1, 0.1, 0.105),
    vec3(0.26, 0.26, 0.27),
    vec3(0.016, 0.025, 0.065),
    vec3(0.04, 0.085, 0.2),
    vec3(0.24, 0.35, 0.5),
    vec3(0.38, 0.022, 0.025),
    vec3(0.12, 0.02, 0.03),
    vec3(0.06, 0.1, 0.05),
    vec3(0.42, 0.33, 0.2),
    vec3(0.5, 0.26, 0.3),
];
const BOTTOMS: [Vec3; 9] = [
    vec3(0.02, 0.035, 0.075),
    vec3(0.03, 0.05, 0.1),
    vec3(0.06, 0.095, 0.17),
    vec3(0.011, 0.011, 0.013),
    vec3(0.015, 0.015, 0.017),
    vec3(0.06, 0.06, 0.065),
    vec3(0.28, 0.21, 0.13),
    vec3(0.2, 0.2, 0.2),
    vec3(0.05, 0.05, 0.035),
];
const SHOES: [Vec3; 5] = [
    vec3(0.01, 0.01, 0.011),
    vec3(0.015, 0.014, 0.014),
    vec3(0.62, 0.62, 0.6),
    vec3(0.08, 0.04, 0.02),
    vec3(0.2, 0.2, 0.21),
];

impl Wardrobe {
    /// Adds the slots to a model, tops and bottoms in the colours given or in everyone's.
    pub(crate) fn new(model: &mut Model, tops: &[Vec3], bottoms: &[Vec3]) -> Self {
        let mut slot = |name: &str, paints: &[Vec3], roughness: f32| {
            let cloth = matches!(name, "top" | "bottom");
            let material = Material {
                sheen: if cloth { 0.6 } else { 0.0 },
                subsurface: if name == "skin" { 0.7 } else { 0.0 },
                ..Material::plain(name, paints[paints.len() / 2], roughness)
            };
            model.slot(material, paints)
        };
        let or = |given: &[Vec3], usual: &[Vec3]| if given.is_empty() { usual.to_vec() } else { given.to_vec() };
        Self {
            skin: slot("skin", &SKINS, 0.5),
            hair: slot("hair", &HAIRS, 0.5),
            top: slot("top", &or(tops, &TOPS), 0.85),
            bottom: slot("bottom", &or(bottoms, &BOTTOMS), 0.85),
            shoes: slot("shoes", &SHOES, 0.6),
            dark: slot("dark", &[Vec3::splat(0.02)], 0.6),
        }
    }
}

//! The colours of leaves over the year.

use glam::{Vec3, vec3};
use serde::Deserialize;
use trove_model::{Foliage, Season};

use super::leaves::{BARE, FULL, THINNED, paint};

/// What leaves reflect over the year, linear RGB.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tones<'a> {
    pub(super) green: Vec3,
    pub(super) year: &'a Year,
}

/// What the seasons do to leaves; colours are linear RGB.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Year {
    #[default]
    Evergreen,
    /// They turn into these colours and fall.
    Turns(Vec<[f32; 3]>),
    /// The same, after blossoms in spring.
    Blossoms { spring: Vec<[f32; 3]>, autumn: Vec<[f32; 3]> },
    /// They turn, and stay as dead leaves until spring: hornbeam.
    Keeps([f32; 3]),
}

/// No two plants are of quite one green: factors on it.
const SHADES: [Vec3; 5] =
    [Vec3::ONE, vec3(1.14, 1.06, 0.95), vec3(0.88, 0.92, 0.9), vec3(1.06, 0.97, 0.9), vec3(0.96, 1.03, 0.95)];
/// Fresh leaves against those of summer.
const FRESH: Vec3 = vec3(1.42, 1.3, 1.02);
/// Twigs of bare crowns and stalks of beds.
pub(super) const TWIGS: Vec3 = vec3(0.1, 0.08, 0.065);

impl Tones<'_> {
    fn shades(color: Vec3) -> Vec<Vec3> {
        SHADES.map(|shade| paint(color * shade)).to_vec()
    }

    /// The paints of summer.
    pub(super) fn summer(&self) -> Vec<Vec3> {
        Self::shades(self.green)
    }

    /// The other seasons, for a slot of leaves.
    pub(super) fn seasons(&self, slot: u16) -> Vec<Foliage> {
        let foliage = |season, paints, alpha_cutoff| Foliage { season, slot, paints, alpha_cutoff };
        let all =
            |colors: &[[f32; 3]]| colors.iter().flat_map(|c| Self::shades(Vec3::from_array(*c))).collect::<Vec<_>>();
        let fresh = foliage(Season::Spring, Self::shades(self.green * FRESH), FULL);
        let bare = foliage(Season::Winter, Self::shades(TWIGS), BARE);
        match self.year {
            Year::Evergreen => Vec::new(),
            Year::Turns(colors) => vec![fresh, foliage(Season::Autumn, all(colors), THINNED), bare],
            Year::Blossoms { spring, autumn } => {
                let spring = foliage(Season::Spring, all(spring), FULL);
                vec![spring, foliage(Season::Autumn, all(autumn), THINNED), bare]
            }
            Year::Keeps(dead) => {
                let turned = foliage(Season::Autumn, all(&[*dead, self.green.to_array()]), FULL);
                vec![fresh, turned, foliage(Season::Winter, Self::shades(Vec3::from_array(*dead) * 0.8), THINNED)]
            }
        }
    }
}

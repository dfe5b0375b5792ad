//! The trees of the library: their measures, leaves, bark, colours over the year, and where they are planted.

use glam::{Vec3, vec3};
use trove_model::{Climate, Foliage, LeafType, Season};

use super::bark::Bark;
use super::leaves::{BARE, FULL, Outline, Sprig, THINNED, paint};
use Climate::{Arid, Cold, Mediterranean, Subtropical, Temperate, Tropical};

/// What leaves reflect over the year, linear RGB.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tones {
    pub(super) green: Vec3,
    pub(super) year: Year,
}

/// What the seasons do to leaves.
#[derive(Clone, Copy, Debug)]
pub(super) enum Year {
    Evergreen,
    /// They turn into these colours and fall.
    Turns(&'static [Vec3]),
    /// The same, after blossoms of these colours in spring.
    Blossoms(&'static [Vec3], &'static [Vec3]),
    /// They turn, and stay as dead leaves until spring: hornbeam.
    Keeps(Vec3),
}

/// No two plants are of quite one green: factors on it.
const SHADES: [Vec3; 5] =
    [Vec3::ONE, vec3(1.14, 1.06, 0.95), vec3(0.88, 0.92, 0.9), vec3(1.06, 0.97, 0.9), vec3(0.96, 1.03, 0.95)];
/// Fresh leaves against those of summer.
const FRESH: Vec3 = vec3(1.42, 1.3, 1.02);
/// Twigs of bare crowns and stalks of beds.
pub(super) const TWIGS: Vec3 = vec3(0.1, 0.08, 0.065);

const YELLOW: Vec3 = vec3(0.34, 0.25, 0.04);
const GOLD: Vec3 = vec3(0.38, 0.21, 0.03);
const ORANGE: Vec3 = vec3(0.33, 0.12, 0.025);
const RED: Vec3 = vec3(0.24, 0.045, 0.022);
const RUSSET: Vec3 = vec3(0.2, 0.1, 0.035);
const LATE_GREEN: Vec3 = vec3(0.15, 0.15, 0.045);

impl Tones {
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
        let all = |colors: &[Vec3]| colors.iter().flat_map(|c| Self::shades(*c)).collect::<Vec<_>>();
        let fresh = foliage(Season::Spring, Self::shades(self.green * FRESH), FULL);
        let bare = foliage(Season::Winter, Self::shades(TWIGS), BARE);
        match self.year {
            Year::Evergreen => Vec::new(),
            Year::Turns(colors) => vec![fresh, foliage(Season::Autumn, all(colors), THINNED), bare],
            Year::Blossoms(blossoms, colors) => {
                let spring = foliage(Season::Spring, all(blossoms), FULL);
                vec![spring, foliage(Season::Autumn, all(colors), THINNED), bare]
            }
            Year::Keeps(dead) => {
                let turned = foliage(Season::Autumn, all(&[dead, self.green]), FULL);
                vec![fresh, turned, foliage(Season::Winter, Self::shades(dead * 0.8), THINNED)]
            }
        }
    }
}

/// A kind of tree; measures are those of a grown one in a street.
pub(super) struct Species {
    pub(super) name: &'static str,
    pub(super) leaves: LeafType,
    pub(super) genera: &'static [&'static str],
    pub(super) habitat: &'static [(Climate, f32)],
    pub(super) height_m: f32,
    /// Largest radius of the crown.
    pub(super) radius_m: f32,
    /// Height at which branches begin, as a share of the whole.
    pub(super) clear: f32,
    /// Height in the crown (0 to 1), and the crown's radius there as a share of the largest.
    pub(super) profile: &'static [(f32, f32)],
    /// Clumps that the crown consists of, and their radius as a share of the crown's.
    pub(super) lobes: usize,
    pub(super) lobe: f32,
    /// Height of a clump as a share of its width.
    pub(super) flat: f32,
    /// How far up the crown the trunk goes on before it divides; negative: below the crown.
    pub(super) leader: f32,
    /// Points that branches grow to.
    pub(super) points: usize,
    /// Pull upwards in every step of growth.
    pub(super) lift: f32,
    pub(super) trunk_m: f32,
    /// How much the trunk's foot spreads.
    pub(super) roots: f32,
    pub(super) sprig: Sprig,
    pub(super) card_m: f32,
    /// Sprigs of a grown crown.
    pub(super) cards: usize,
    /// Upward pull on sprigs; negative where they hang.
    pub(super) hang: f32,
    pub(super) tones: Tones,
    pub(super) bark: Bark,
    pub(super) bark_color: Vec3,
}

const ROUND: &[(f32, f32)] = &[(0.0, 0.62), (0.2, 0.9), (0.42, 1.0), (0.7, 0.86), (0.9, 0.55), (1.0, 0.3)];
const WIDE: &[(f32, f32)] = &[(0.0, 0.7), (0.25, 1.0), (0.5, 0.98), (0.8, 0.75), (1.0, 0.4)];
const OVAL: &[(f32, f32)] = &[(0.0, 0.55), (0.15, 0.85), (0.38, 1.0), (0.65, 0.82), (0.88, 0.45), (1.0, 0.18)];
const UMBRELLA: &[(f32, f32)] = &[(0.0, 0.55), (0.3, 0.9), (0.6, 1.0), (0.85, 0.9), (1.0, 0.55)];
const DOME: &[(f32, f32)] = &[(0.0, 1.0), (0.3, 0.98), (0.65, 0.8), (1.0, 0.45)];
const COLUMN: &[(f32, f32)] = &[(0.0, 0.55), (0.1, 0.9), (0.4, 1.0), (0.75, 0.75), (1.0, 0.15)];

const fn leaves(outline: Outline, length: f32, width: f32, count: usize) -> Sprig {
    Sprig::Leaves { outline, length, width, count }
}

/// The plainest tree, of which the others differ.
const PLAIN: Species = Species {
    name: "",
    leaves: LeafType::Broad,
    genera: &[],
    habitat: &[],
    height_m: 10.5,
    radius_m: 3.9,
    clear: 0.26,
    profile: ROUND,
    lobes: 20,
    lobe: 0.4,
    flat: 0.85,
    leader: 0.35,
    points: 2300,
    lift: 0.05,
    trunk_m: 0.24,
    roots: 0.4,
    sprig: leaves(Outline::Oval(0.85), 0.15, 0.55, 8),
    card_m: 0.7,
    cards: 4200,
    hang: -0.1,
    tones: Tones { green: vec3(0.088, 0.127, 0.046), year: Year::Turns(&[YELLOW, LATE_GREEN]) },
    bark: Bark::Furrowed(0.045),
    bark_color: vec3(0.13, 0.11, 0.09),
};

pub(super) const SPECIES: [Species; 12] = [
    Species {
        name: "plane",
        genera: &["platanus", "plane"],
        habitat: &[(Tropical, 0.1), (Mediterranean, 1.5), (Temperate, 1.4), (Cold, 0.3)],
        height_m: 12.0,
        radius_m: 4.4,
        trunk_m: 0.3,
        lobes: 22,
        sprig: leaves(Outline::Palmate(0.42), 0.2, 1.0, 5),
        card_m: 0.8,
        cards: 5200,
        tones: Tones { green: vec3(0.100, 0.139, 0.048), year: Year::Turns(&[RUSSET, GOLD, LATE_GREEN]) },
        bark: Bark::Patches,
        bark_color: vec3(0.15, 0.145, 0.115),
        ..PLAIN
    },
    Species {
        name: "oak",
        genera: &["quercus", "oak", "fagus", "castanea", "aesculus"],
        habitat: &[(Tropical, 0.0), (Arid, 0.4), (Mediterranean, 0.8)],
        height_m: 14.0,
        radius_m: 5.4,
        clear: 0.22,
        profile: WIDE,
        lobes: 28,
        lobe: 0.34,
        leader: 0.2,
        points: 2800,
        lift: 0.02,
        trunk_m: 0.4,
        roots: 0.55,
        sprig: leaves(Outline::Wavy, 0.16, 0.55, 8),
        card_m: 0.85,
        cards: 5200,
        tones: Tones { green: vec3(0.076, 0.111, 0.040), year: Year::Turns(&[RUSSET, ORANGE, LATE_GREEN]) },
        bark: Bark::Furrowed(0.07),
        bark_color: vec3(0.115, 0.098, 0.078),
        ..PLAIN
    },
    Species {
        name: "maple",
        genera: &["acer", "maple"],
        habitat: &[(Tropical, 0.0), (Arid, 0.2), (Mediterranean, 0.5), (Subtropical, 0.5), (Cold, 1.3)],
        height_m: 10.5,
        radius_m: 3.7,
        profile: ROUND,
        lobes: 22,
        sprig: leaves(Outline::Palmate(0.62), 0.17, 1.05, 6),
        card_m: 0.7,
        tones: Tones { green: vec3(0.085, 0.127, 0.043), year: Year::Turns(&[RED, ORANGE, GOLD, YELLOW]) },
        bark: Bark::Furrowed(0.03),
        bark_color: vec3(0.15, 0.135, 0.115),
        ..PLAIN
    },
    Species {
        name: "lime",
        genera: &["tilia", "lime", "linden", "carpinus", "ulmus"],
        habitat: &[
            (Tropical, 0.0),
            (Arid, 0.0),
            (Subtropical, 0.3),
            (Mediterranean, 0.4),
            (Temperate, 1.6),
            (Cold, 1.6),
        ],
        height_m: 12.5,
        radius_m: 3.5,
        clear: 0.22,
        profile: OVAL,
        lobes: 26,
        lobe: 0.42,
        leader: 0.6,
        points: 2600,
        lift: 0.1,
        sprig: leaves(Outline::Oval(0.62), 0.125, 0.82, 9),
        card_m: 0.7,
        cards: 4600,
        tones: Tones { green: vec3(0.085, 0.132, 0.043), year: Year::Turns(&[YELLOW, YELLOW, LATE_GREEN]) },
        bark: Bark::Furrowed(0.035),
        bark_color: vec3(0.125, 0.115, 0.1),
        ..PLAIN
    },
    Species {
        name: "ash",
        genera: &["fraxinus", "robinia", "gleditsia", "sophora", "styphnolobium", "sorbus", "juglans"],
        habitat: &[(Tropical, 0.0), (Mediterranean, 0.8)],
        height_m: 11.0,
        radius_m: 3.9,
        clear: 0.28,
        lobes: 18,
        lobe: 0.38,
        leader: 0.3,
        sprig: Sprig::Feathered,
        card_m: 0.75,
        cards: 3700,
        tones: Tones { green: vec3(0.098, 0.144, 0.050), year: Year::Turns(&[YELLOW, LATE_GREEN]) },
        bark: Bark::Furrowed(0.05),
        bark_color: vec3(0.14, 0.13, 0.11),
        ..PLAIN
    },
    Species {
        name: "birch",
        genera: &["betula", "birch", "alnus"],
        habitat: &[
            (Tropical, 0.0),
            (Subtropical, 0.0),
            (Arid, 0.0),
            (Mediterranean, 0.1),
            (Temperate, 0.5),
            (Cold, 1.5),
        ],
        height_m: 11.5,
        radius_m: 2.5,
        clear: 0.24,
        profile: OVAL,
        lobes: 20,
        lobe: 0.42,
        leader: 0.85,
        points: 1700,
        lift: 0.06,
        trunk_m: 0.14,
        roots: 0.25,
        sprig: leaves(Outline::Triangle, 0.085, 0.75, 12),
        card_m: 0.62,
        cards: 3800,
        hang: -0.75,
        tones: Tones { green: vec3(0.104, 0.149, 0.050), year: Year::Turns(&[YELLOW, GOLD]) },
        bark: Bark::Birch,
        bark_color: vec3(0.56, 0.54, 0.5),
        ..PLAIN
    },
    Species {
        name: "poplar",
        genera: &["populus", "poplar"],
        habitat: &[(Tropical, 0.0), (Subtropical, 0.3), (Mediterranean, 0.6), (Temperate, 0.4), (Cold, 0.6)],
        height_m: 16.0,
        radius_m: 1.9,
        clear: 0.12,
        profile: COLUMN,
        lobes: 52,
        lobe: 0.42,
        flat: 1.5,
        leader: 0.9,
        points: 3200,
        lift: 0.45,
        trunk_m: 0.26,
        sprig: leaves(Outline::Triangle, 0.11, 0.9, 9),
        card_m: 0.66,
        cards: 4800,
        hang: 0.5,
        tones: Tones { green: vec3(0.091, 0.132, 0.048), year: Year::Turns(&[YELLOW, GOLD]) },
        bark: Bark::Furrowed(0.05),
        bark_color: vec3(0.15, 0.14, 0.12),
        ..PLAIN
    },
    Species {
        name: "cherry",
        genera: &["prunus", "cherry", "malus", "pyrus", "crataegus", "magnolia"],
        habitat: &[(Tropical, 0.0), (Arid, 0.3), (Mediterranean, 0.6), (Temperate, 0.7)],
        height_m: 6.5,
        radius_m: 2.8,
        clear: 0.3,
        profile: WIDE,
        lobes: 16,
        lobe: 0.42,
        leader: 0.1,
        points: 1700,
        lift: 0.08,
        trunk_m: 0.14,
        roots: 0.3,
        sprig: leaves(Outline::Oval(0.9), 0.14, 0.48, 9),
        card_m: 0.55,
        cards: 3800,
        tones: Tones {
            green: vec3(0.085, 0.123, 0.046),
            year: Year::Blossoms(&[vec3(0.44, 0.27, 0.31), vec3(0.46, 0.4, 0.4)], &[ORANGE, RED, GOLD]),
        },
        bark: Bark::Bands,
        bark_color: vec3(0.085, 0.06, 0.05),
        ..PLAIN
    },
    Species {
        name: "rain-tree",
        genera: &["samanea", "albizia", "delonix", "peltophorum", "pterocarpus", "acacia"],
        habitat: &[
            (Tropical, 2.0),
            (Subtropical, 0.5),
            (Arid, 0.5),
            (Mediterranean, 0.0),
            (Temperate, 0.0),
            (Cold, 0.0),
        ],
        height_m: 11.5,
        radius_m: 8.0,
        clear: 0.5,
        profile: DOME,
        lobes: 44,
        lobe: 0.24,
        flat: 0.55,
        // It divides well below its crown.
        leader: -0.4,
        points: 3600,
        lift: 0.0,
        trunk_m: 0.46,
        roots: 0.6,
        sprig: Sprig::Feathered,
        card_m: 1.05,
        cards: 5600,
        tones: Tones { green: vec3(0.081, 0.118, 0.041), year: Year::Evergreen },
        bark: Bark::Furrowed(0.06),
        bark_color: vec3(0.105, 0.09, 0.075),
        ..PLAIN
    },
    Species {
        name: "laurel-fig",
        genera: &[
            "ficus",
            "tabebuia",
            "cinnamomum",
            "hopea",
            "swietenia",
            "eucalyptus",
            "lagerstroemia",
            "olea",
            "citrus",
        ],
        habitat: &[(Tropical, 1.8), (Subtropical, 2.2), (Mediterranean, 0.8), (Temperate, 0.0), (Cold, 0.0)],
        height_m: 10.0,
        radius_m: 3.6,
        clear: 0.28,
        profile: ROUND,
        lobes: 20,
        lobe: 0.36,
        points: 2200,
        trunk_m: 0.22,
        sprig: leaves(Outline::Oval(0.95), 0.13, 0.42, 11),
        card_m: 0.7,
        cards: 3400,
        tones: Tones { green: vec3(0.068, 0.099, 0.038), year: Year::Evergreen },
        bark: Bark::Furrowed(0.03),
        bark_color: vec3(0.17, 0.155, 0.135),
        ..PLAIN
    },
    Species {
        name: "pine",
        leaves: LeafType::Needle,
        genera: &["pinus", "pine", "cedrus"],
        habitat: &[
            (Tropical, 0.05),
            (Subtropical, 0.3),
            (Arid, 0.3),
            (Temperate, 0.12),
            (Cold, 0.9),
            (Mediterranean, 1.0),
        ],
        height_m: 12.0,
        radius_m: 3.3,
        clear: 0.42,
        profile: UMBRELLA,
        lobes: 18,
        lobe: 0.33,
        flat: 0.6,
        leader: 0.7,
        points: 1500,
        lift: 0.02,
        trunk_m: 0.23,
        roots: 0.25,
        sprig: Sprig::Tufts,
        card_m: 0.62,
        cards: 5200,
        hang: 0.5,
        tones: Tones { green: vec3(0.063, 0.092, 0.043), year: Year::Evergreen },
        bark: Bark::Plates,
        bark_color: vec3(0.17, 0.105, 0.07),
    },
    Species {
        name: "cypress",
        leaves: LeafType::Needle,
        genera: &["cupressus", "cypress", "juniperus", "thuja", "chamaecyparis", "italica", "taxus"],
        habitat: &[
            (Tropical, 0.0),
            (Subtropical, 0.2),
            (Arid, 0.3),
            (Temperate, 0.05),
            (Cold, 0.0),
            (Mediterranean, 0.8),
        ],
        height_m: 10.5,
        radius_m: 0.95,
        clear: 0.05,
        profile: COLUMN,
        lobes: 60,
        lobe: 0.55,
        flat: 2.0,
        leader: 0.92,
        points: 2600,
        lift: 0.6,
        trunk_m: 0.15,
        roots: 0.2,
        sprig: Sprig::Scales,
        card_m: 0.5,
        cards: 5200,
        hang: 1.1,
        tones: Tones { green: vec3(0.054, 0.078, 0.036), year: Year::Evergreen },
        bark: Bark::Strips,
        bark_color: vec3(0.13, 0.11, 0.09),
    },
];

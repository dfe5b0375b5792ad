//! What grows where, and how it looks over the year.

use glam::Vec3;

/// Climates as far as plants in streets differ by them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Climate {
    /// Warm and wet all year.
    Tropical,
    /// Wet and hot in summer, without much frost.
    Subtropical,
    /// Dry in summer, mild in winter.
    Mediterranean,
    /// Dry all year.
    Arid,
    /// Frost in winter, green in summer.
    Temperate,
    /// Long winters.
    Cold,
}

/// Where winters are mild and summers dry: latitudes and longitudes from south-west to north-east.
const MEDITERRANEAN: [[f64; 4]; 5] = [
    [30.0, -10.0, 44.6, 37.0],
    [32.0, -125.0, 39.5, -116.5],
    [-38.0, -74.0, -30.0, -70.0],
    [-35.0, 17.0, -31.5, 20.5],
    [-36.0, 114.0, -30.0, 140.0],
];
/// Where hardly any rain falls.
const ARID: [[f64; 4]; 5] = [
    [14.0, -17.0, 31.5, 60.0],
    [31.0, -116.5, 37.5, -105.0],
    [24.0, 60.0, 33.0, 72.0],
    [-29.0, 114.0, -20.0, 142.0],
    [-28.0, -76.0, -15.0, -69.0],
];

impl Climate {
    /// The climate of a place, as far as its position tells; climate keeps to no border, so it is no part of a
    /// [`Locale`](crate::Locale).
    pub fn at(lat_deg: f64, lon_deg: f64) -> Self {
        let within = |areas: &[[f64; 4]]| {
            let inside = |a: &[f64; 4]| (a[0]..a[2]).contains(&lat_deg) && (a[1]..a[3]).contains(&lon_deg);
            areas.iter().any(inside)
        };
        // Continents are colder in the east: North America and Asia beyond the Pacific coast and Europe.
        let continental = (-110.0..-50.0).contains(&lon_deg) || (60.0..150.0).contains(&lon_deg);
        match lat_deg.abs() {
            _ if within(&ARID) => Self::Arid,
            _ if within(&MEDITERRANEAN) => Self::Mediterranean,
            lat if lat < 20.0 => Self::Tropical,
            lat if lat < 34.0 => Self::Subtropical,
            lat if lat < if continental { 48.0 } else { 58.0 } => Self::Temperate,
            _ => Self::Cold,
        }
    }
}

/// A part of the year as plants have it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Season {
    /// Blossoms and fresh leaves.
    Spring,
    /// Full leaves; all year where no other season is felt.
    #[default]
    Summer,
    /// Leaves turn and fall.
    Autumn,
    /// Deciduous plants are bare.
    Winter,
}

impl Season {
    /// Every season, from spring on.
    pub const ALL: [Self; 4] = [Self::Spring, Self::Summer, Self::Autumn, Self::Winter];

    /// Its name in recipes and manifests (`autumn`).
    pub fn name(self) -> &'static str {
        match self {
            Self::Spring => "spring",
            Self::Summer => "summer",
            Self::Autumn => "autumn",
            Self::Winter => "winter",
        }
    }

    /// The season of a time, nanoseconds since 1970 UTC, at a latitude and in a climate.
    pub fn at(time_ns: i64, lat_deg: f64, climate: Climate) -> Self {
        // South of the equator half a year on.
        let month = (month(time_ns) - 1 + if lat_deg < 0.0 { 6 } else { 0 }) % 12 + 1;
        match (climate, month) {
            (Climate::Tropical | Climate::Arid, _) => Self::Summer,
            (Climate::Subtropical, 12 | 1 | 2) => Self::Autumn,
            (Climate::Subtropical, 3) => Self::Spring,
            (Climate::Mediterranean, 3 | 4) | (Climate::Temperate, 4) | (Climate::Cold, 5) => Self::Spring,
            (Climate::Mediterranean, 11 | 12) | (Climate::Temperate, 10 | 11) | (Climate::Cold, 9 | 10) => Self::Autumn,
            (Climate::Mediterranean, 1 | 2) | (Climate::Temperate, 12 | 1..=3) | (Climate::Cold, 11 | 12 | 1..=4) => {
                Self::Winter
            }
            _ => Self::Summer,
        }
    }
}

/// The month of a Unix time, 1 to 12, to about a day.
fn month(time_ns: i64) -> u32 {
    const YEAR_DAYS: f64 = 365.2425;
    let day = (time_ns as f64 / 86_400e9).rem_euclid(YEAR_DAYS);
    (day / YEAR_DAYS * 12.0) as u32 + 1
}

/// How a plant is grown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum PlantForm {
    /// By itself.
    #[default]
    Free,
    /// A clipped piece along x, whose neighbours make a hedge with it.
    Hedge,
    /// A piece of a planted strip along x: flowers, low shrubs.
    Bed,
}

/// What leaves are, as OpenStreetMap's `leaf_type` tells them apart; palms apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum LeafType {
    /// Blades with veins.
    #[default]
    Broad,
    /// Needles and scales.
    Needle,
    /// A palm's.
    Frond,
}

/// What is known of an asset that is a plant.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Plant {
    /// Its individuals (young, grown, another one) have the same; `None`: the asset is the only one.
    pub species: Option<String>,
    /// How it is grown.
    pub form: PlantForm,
    /// What leaves it has.
    pub leaves: LeafType,
    /// What a map may call it: lower-case words of `species`, `taxon` or `genus` (`tilia`, `linden`).
    pub genera: Vec<String>,
    /// How common it is where; 1 in a climate that is not named, and where 0 it does not live.
    pub habitat: Vec<(Climate, f32)>,
    /// How its leaves look in seasons in which they differ from the asset's own.
    pub seasons: Vec<Foliage>,
}

/// The leaves of a season.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Foliage {
    /// When.
    pub season: Season,
    /// The slot of the mesh that shows them.
    pub slot: u16,
    /// What the slot's [`paints`](crate::Slot::paints) are then.
    pub paints: Vec<Vec3>,
    /// What its material's [`alpha_cutoff`](crate::Material::alpha_cutoff) is then: a texture whose leaves differ in alpha
    /// loses them one by one.
    pub alpha_cutoff: f32,
}

impl Plant {
    /// How common it is in a climate; 0: it does not live there.
    pub fn commonness(&self, climate: Climate) -> f32 {
        self.habitat.iter().find(|(c, _)| *c == climate).map_or(1.0, |(_, share)| *share)
    }

    /// Whether a word of a map's name of a species or genus (lower case) names it.
    pub fn is_called(&self, species: &str) -> bool {
        let mut words = species.split(|c: char| !c.is_alphanumeric());
        words.any(|word| self.genera.iter().any(|genus| genus == word))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cities_have_their_climates() {
        for (city, lat_deg, lon_deg, climate) in [
            ("Singapore", 1.30, 103.79, Climate::Tropical),
            ("Taipei", 25.05, 121.52, Climate::Subtropical),
            ("Monaco", 43.74, 7.43, Climate::Mediterranean),
            ("Berlin", 52.47, 13.44, Climate::Temperate),
            ("Boston", 42.35, -71.04, Climate::Temperate),
            ("Pittsburgh", 40.44, -79.99, Climate::Temperate),
            ("Palo Alto", 37.44, -122.14, Climate::Mediterranean),
            ("Phoenix", 33.45, -112.07, Climate::Arid),
            ("Karlsruhe", 49.01, 8.40, Climate::Temperate),
            ("Sydney", -33.87, 151.21, Climate::Subtropical),
            ("Helsinki", 60.17, 24.94, Climate::Cold),
            ("Miami", 25.76, -80.19, Climate::Subtropical),
        ] {
            assert_eq!(Climate::at(lat_deg, lon_deg), climate, "{city}");
        }
    }

    #[test]
    fn seasons_are_told_from_time_hemisphere_and_climate() {
        // 2018-07-24, 2020-11-15 and 2020-01-15.
        let times = [1_532_402_927_000_000_000, 1_605_398_400_000_000_000, 1_579_046_400_000_000_000];
        assert_eq!(times.map(month), [7, 11, 1]);
        for (lat_deg, climate, expected) in [
            (52.0, Climate::Temperate, [Season::Summer, Season::Autumn, Season::Winter]),
            (-42.0, Climate::Temperate, [Season::Winter, Season::Summer, Season::Summer]),
            (1.3, Climate::Tropical, [Season::Summer; 3]),
        ] {
            assert_eq!(times.map(|t| Season::at(t, lat_deg, climate)), expected);
        }
    }
}

//! The climate of a place, as far as its position tells: which plants grow there, how green its lawns are.

use trove_model::Drive;

/// Climates as far as plants in streets differ by them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Climate {
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
    /// The climate of the place where a drive was recorded.
    pub(super) fn of(drive: &Drive) -> Self {
        Self::at(drive.projection.origin_lat_deg, drive.projection.origin_lon_deg)
    }

    fn at(lat_deg: f64, lon_deg: f64) -> Self {
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

    /// Whether plants of the tropics live there.
    pub(super) fn is_frost_free(self) -> bool {
        !matches!(self, Self::Temperate | Self::Cold)
    }

    /// How dry lawns are: 0 lush, 1 straw.
    pub(super) fn dryness(self) -> f64 {
        match self {
            Self::Tropical => 0.42,
            Self::Subtropical => 0.3,
            Self::Mediterranean => 0.55,
            Self::Arid => 0.75,
            Self::Temperate => 0.3,
            Self::Cold => 0.35,
        }
    }

    /// How much of the ground under a tree its leaves cover at a month (1 to 12), 0 to 1, and how old they are, 0 (green)
    /// to 1 (brown).
    pub(super) fn litter(self, is_northern: bool, month: u32) -> [f64; 2] {
        let autumn = if is_northern { 10..=11 } else { 4..=5 };
        match self {
            Self::Temperate | Self::Cold if autumn.contains(&month) => [0.9, 0.45],
            Self::Temperate | Self::Cold => [0.12, 0.75],
            Self::Tropical => [0.32, 0.6],
            Self::Subtropical => [0.25, 0.6],
            Self::Mediterranean => [0.22, 0.7],
            Self::Arid => [0.15, 0.8],
        }
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
    fn leaves_fall_in_autumn() {
        assert!(Climate::Temperate.litter(true, 10)[0] > 3.0 * Climate::Temperate.litter(true, 7)[0]);
        assert_eq!(Climate::Temperate.litter(false, 5), Climate::Temperate.litter(true, 11));
    }
}

//! What a place's climate and season make of its ground and its people: how green lawns are, how many leaves lie about, what
//! is worn.

use trove_model::{Climate, Drive, Form, Outdoors, Precipitation, Season};

/// What plants grow under.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Conditions {
    /// Of the place.
    climate: Climate,
    /// Of the pictures.
    season: Season,
}

impl Conditions {
    /// Those of a drive's place at a time, nanoseconds since 1970 UTC, or in a given season.
    pub(crate) fn new(drive: &Drive, time_ns: i64, season: Option<Season>) -> Self {
        let (lat_deg, lon_deg) = (drive.projection.origin_lat_deg, drive.projection.origin_lon_deg);
        let climate = Climate::at(lat_deg, lon_deg);
        Self { climate, season: season.unwrap_or_else(|| Season::at(time_ns, lat_deg, climate)) }
    }

    /// The climate.
    pub(crate) fn climate(self) -> Climate {
        self.climate
    }

    /// The season.
    pub(crate) fn season(self) -> Season {
        self.season
    }

    /// What people dress for, where something falls or a share of the ground lies under snow. In the tropics rain is warm,
    /// and only snow, which a recipe may ask for anywhere, is not.
    pub(crate) fn outdoors(self, falling: Option<Precipitation>, snow: f64) -> Outdoors {
        let falls = falling.map(|f| f.form);
        match (self.climate, self.season) {
            _ if snow > 0.0 || falls == Some(Form::Snow) => Outdoors::Cold,
            (Climate::Tropical, _) => Outdoors::Warm,
            (Climate::Temperate | Climate::Cold, Season::Winter) => Outdoors::Cold,
            _ if falls == Some(Form::Rain) => Outdoors::Wet,
            (_, Season::Summer) => Outdoors::Warm,
            _ => Outdoors::Mild,
        }
    }

    /// How dry lawns are: 0 lush, 1 straw. Where it freezes grass pales in winter.
    pub(crate) fn dryness(self) -> f64 {
        let dryness: f64 = match self.climate {
            Climate::Tropical => 0.42,
            Climate::Subtropical | Climate::Temperate => 0.3,
            Climate::Mediterranean => 0.55,
            Climate::Arid => 0.75,
            Climate::Cold => 0.35,
        };
        let change = match self.season {
            Season::Spring => -0.12,
            Season::Summer => 0.0,
            Season::Autumn => 0.08,
            Season::Winter => 0.3,
        };
        (dryness + change).clamp(0.0, 1.0)
    }

    /// How much of the ground under a tree its leaves cover, 0 to 1, and how old they are, 0 (green) to 1 (brown).
    pub(crate) fn litter(self) -> [f64; 2] {
        match (self.season, self.climate) {
            (Season::Autumn, _) => [0.9, 0.45],
            (Season::Winter, _) => [0.4, 0.95],
            (_, Climate::Temperate | Climate::Cold) => [0.12, 0.75],
            (_, Climate::Tropical) => [0.32, 0.6],
            (_, Climate::Subtropical) => [0.25, 0.6],
            (_, Climate::Mediterranean) => [0.22, 0.7],
            (_, Climate::Arid) => [0.15, 0.8],
        }
    }

    /// How many flowers there are in lawns, 0 to 1.
    pub(crate) fn bloom(self) -> f64 {
        let common = 0.75 - 0.7 * self.dryness();
        match self.season {
            Season::Spring => (common * 1.6).min(1.0),
            Season::Summer => common,
            Season::Autumn => common * 0.3,
            Season::Winter => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaves_fall_in_autumn_and_lawns_pale_in_winter() {
        let of = |season: Season| Conditions { climate: Climate::Temperate, season };
        assert!(of(Season::Autumn).litter()[0] > 3.0 * of(Season::Summer).litter()[0]);
        assert!(of(Season::Winter).dryness() > of(Season::Summer).dryness() + 0.2);
        assert_eq!(of(Season::Winter).bloom(), 0.0);
    }

    #[test]
    fn people_dress_for_season_climate_rain_and_snow() {
        let falls = |form: Form| Some(Precipitation { form, rate_mm_h: 1.0 });
        let (rain, flakes) = (falls(Form::Rain), falls(Form::Snow));
        for (climate, season, falling, snow, expected) in [
            (Climate::Temperate, Season::Summer, None, 0.0, Outdoors::Warm),
            (Climate::Temperate, Season::Autumn, None, 0.0, Outdoors::Mild),
            (Climate::Temperate, Season::Summer, rain, 0.0, Outdoors::Wet),
            (Climate::Temperate, Season::Winter, None, 0.0, Outdoors::Cold),
            (Climate::Cold, Season::Winter, rain, 0.0, Outdoors::Cold),
            (Climate::Mediterranean, Season::Winter, None, 0.0, Outdoors::Mild),
            (Climate::Arid, Season::Summer, None, 0.0, Outdoors::Warm),
            (Climate::Tropical, Season::Summer, rain, 0.0, Outdoors::Warm),
            (Climate::Tropical, Season::Winter, None, 0.0, Outdoors::Warm),
            (Climate::Tropical, Season::Summer, None, 0.3, Outdoors::Cold),
            (Climate::Temperate, Season::Summer, flakes, 0.0, Outdoors::Cold),
        ] {
            let conditions = Conditions { climate, season };
            assert_eq!(conditions.outdoors(falling, snow), expected, "{climate:?} {season:?} {falling:?} {snow}");
        }
    }

    #[test]
    fn a_season_that_is_asked_for_is_taken() {
        let drive = Drive { projection: berlin(), ..crate::testing::drive() };
        let time_ns = drive.keyframes[0].time_ns;
        assert_eq!(Conditions::new(&drive, time_ns, None).season, Season::Summer);
        assert_eq!(Conditions::new(&drive, time_ns, Some(Season::Winter)).season, Season::Winter);
    }

    fn berlin() -> trove_model::MapProjection {
        let projection = crate::testing::drive().projection;
        trove_model::MapProjection { origin_lat_deg: 52.5, origin_lon_deg: 13.4, ..projection }
    }
}

//! `[variations]`: how many scenes a keyframe becomes, and what differs between them.

use std::path::PathBuf;

use anyhow::{Result, ensure};
use serde::{Deserialize, Serialize};

use super::check::check;
use super::light::LightSection;
use super::season::SeasonChoice;
use super::weather::{RAIN_MM_H, SNOWFALL_MM_H, VISIBILITY_M};

/// What may differ between variations; each has a seed of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Factor {
    /// Whose customs, climate and sun the place has.
    Place,
    /// Which models stand for recorded objects, but for people.
    Assets,
    /// Colours, wear and extras of vehicles.
    Paint,
    /// Who the people on foot are, and how they are dressed.
    People,
    /// Styles and colours of buildings, and heights that nobody knows.
    Facades,
    /// Surfaces of roads, sidewalks and land, markings that nobody knows, damage.
    Materials,
    /// Street furniture.
    Furniture,
    /// Species and individuals of plants, lawns and undergrowth.
    Vegetation,
    /// What plants, lawns and fallen leaves show.
    Season,
    /// Sun and sky.
    Light,
    /// How many road users there are.
    Traffic,
    /// Rain that has fallen.
    Wetness,
    /// Fog and haze.
    Fog,
    /// Rain that falls.
    Rain,
    /// Snow that falls.
    Snowfall,
    /// Snow that lies.
    Snow,
    /// Stops about the recipe's exposure.
    Exposure,
    /// Height and pitch of the cameras.
    Camera,
    /// Which other vehicles carry the rig, and how many.
    Rigs,
}

impl Factor {
    /// Every factor.
    #[rustfmt::skip]
    pub const ALL: [Self; 19] = [
        Self::Place, Self::Assets, Self::Paint, Self::People, Self::Facades, Self::Materials, Self::Furniture, Self::Vegetation,
        Self::Season, Self::Light, Self::Traffic, Self::Wetness, Self::Fog, Self::Rain, Self::Snowfall, Self::Snow, Self::Exposure,
        Self::Camera, Self::Rigs,
    ];

    /// Its name in recipes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Place => "place",
            Self::Assets => "assets",
            Self::Paint => "paint",
            Self::People => "people",
            Self::Facades => "facades",
            Self::Materials => "materials",
            Self::Furniture => "furniture",
            Self::Vegetation => "vegetation",
            Self::Season => "season",
            Self::Light => "light",
            Self::Traffic => "traffic",
            Self::Wetness => "wetness",
            Self::Fog => "fog",
            Self::Rain => "rain",
            Self::Snowfall => "snowfall",
            Self::Snow => "snow",
            Self::Exposure => "exposure",
            Self::Camera => "camera",
            Self::Rigs => "rigs",
        }
    }
}

/// The least and the most of what is drawn evenly in between.
pub type Range = [f64; 2];

/// `[variations]`
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct VariationsSection {
    /// Scenes per keyframe.
    pub count: u32,
    /// What differs; without it all that differs without a range, and all that has one.
    pub factors: Option<Vec<Factor>>,
    /// Whether v00 is the scene that the rest of the recipe tells of, with nothing drawn from the ranges.
    pub first_as_recorded: bool,
    /// The one factor that differs, all else being v00's, noise too; frames get a mask of what changed.
    pub counterfactual: Option<Factor>,
    /// Latitudes and longitudes of other places, in degrees; those that drive on the recording's side are drawn among.
    pub places: Option<Vec<[f64; 2]>>,
    /// Seasons to draw among.
    pub seasons: Option<Vec<SeasonChoice>>,
    /// As `weather.wetness`.
    pub wetness: Option<Range>,
    /// Share of the variations that are dry where wetness is drawn.
    pub dry_share: f64,
    /// As `weather.visibility_m`, drawn evenly by its logarithm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub visibility_m: Option<Range>,
    /// Share of the variations that have fog where it is drawn.
    #[serde(skip_serializing_if = "is_one")]
    pub fog_share: f64,
    /// As `weather.rain_mm_h`, drawn evenly by its logarithm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rain_mm_h: Option<Range>,
    /// Share of the variations in which it rains where rain is drawn.
    #[serde(skip_serializing_if = "is_one")]
    pub rain_share: f64,
    /// As `weather.snowfall_mm_h`, drawn evenly by its logarithm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub snowfall_mm_h: Option<Range>,
    /// Share of the variations in which it snows where snowfall is drawn.
    #[serde(skip_serializing_if = "is_one")]
    pub snowfall_share: f64,
    /// As `weather.snow`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub snow: Option<Range>,
    /// Share of the variations in which snow lies where it is drawn.
    #[serde(skip_serializing_if = "is_one")]
    pub snow_share: f64,
    /// Road users against the recorded number.
    pub traffic: Option<Range>,
    /// Cyclists among added road users, against what is usual at the place.
    pub cyclists: f64,
    /// Stops about the metered or fixed exposure.
    pub exposure_ev: Option<Range>,
    /// Above the recorded place, metres.
    pub camera_height_m: Option<Range>,
    /// Up from the recorded view, degrees.
    pub camera_pitch_deg: Option<Range>,
    /// As `views.other_vehicles`.
    pub other_vehicles: Option<[usize; 2]>,
    /// Sun and sky.
    pub light: VariedLight,
}

/// `[variations.light]`
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct VariedLight {
    /// Hours of the day by the sun, which is highest at 12.
    pub hours: Option<Range>,
    /// As `light.clouds`.
    pub clouds: Option<Range>,
    /// As `light.turbidity`.
    pub turbidity: Option<Range>,
    /// Pictures of skies, and the word `sky` for a computed one.
    pub environments: Vec<String>,
}

/// The computed sky among the environments.
pub const COMPUTED_SKY: &str = "sky";

impl Default for VariationsSection {
    fn default() -> Self {
        Self {
            count: 1,
            factors: None,
            first_as_recorded: true,
            counterfactual: None,
            places: None,
            seasons: None,
            wetness: None,
            dry_share: 0.5,
            visibility_m: None,
            fog_share: 1.0,
            rain_mm_h: None,
            rain_share: 1.0,
            snowfall_mm_h: None,
            snowfall_share: 1.0,
            snow: None,
            snow_share: 1.0,
            traffic: None,
            cyclists: 1.0,
            exposure_ev: None,
            camera_height_m: None,
            camera_pitch_deg: None,
            other_vehicles: None,
            light: VariedLight::default(),
        }
    }
}

impl VariationsSection {
    /// Whether a factor differs between variations.
    pub fn varies(&self, factor: Factor) -> bool {
        match (self.counterfactual, &self.factors) {
            (Some(only), _) => factor == only,
            (None, Some(factors)) => factors.contains(&factor),
            (None, None) => !factor.needs_range() || self.ranges().iter().any(|(f, _, given)| *f == factor && *given),
        }
    }

    /// The seasons to draw among.
    pub fn seasons(&self) -> Vec<SeasonChoice> {
        let all = [SeasonChoice::Spring, SeasonChoice::Summer, SeasonChoice::Autumn, SeasonChoice::Winter];
        self.seasons.clone().unwrap_or(all.to_vec())
    }

    /// How wet it may be.
    pub fn wetness(&self) -> Range {
        self.wetness.unwrap_or([0.0, 0.8])
    }

    /// How far one may see where there is fog.
    pub fn visibility_m(&self) -> Range {
        self.visibility_m.unwrap_or([50.0, 500.0])
    }

    /// How much it may rain where it does.
    pub fn rain_mm_h(&self) -> Range {
        self.rain_mm_h.unwrap_or([2.0, 50.0])
    }

    /// How much it may snow where it does.
    pub fn snowfall_mm_h(&self) -> Range {
        self.snowfall_mm_h.unwrap_or([0.3, 3.0])
    }

    /// How much of the ground snow may cover where it lies.
    pub fn snow(&self) -> Range {
        self.snow.unwrap_or([0.3, 1.0])
    }

    /// How many road users there may be against the recorded number.
    pub fn traffic(&self) -> Range {
        self.traffic.unwrap_or([0.5, 2.0])
    }

    /// Stops about the exposure.
    pub fn exposure_ev(&self) -> Range {
        self.exposure_ev.unwrap_or([-0.7, 0.7])
    }

    /// Metres above and degrees up from where the cameras were; one that is not given stays where the other is.
    pub fn camera(&self) -> [Range; 2] {
        match (self.camera_height_m, self.camera_pitch_deg) {
            (None, None) => [[-0.3, 0.3], [-3.0, 3.0]],
            (height_m, pitch_deg) => [height_m.unwrap_or_default(), pitch_deg.unwrap_or_default()],
        }
    }

    /// Every key with a range: its factor, its name, and whether it is given.
    fn ranges(&self) -> [(Factor, &'static str, bool); 16] {
        let light = &self.light;
        [
            (Factor::Place, "places", self.places.is_some()),
            (Factor::Season, "seasons", self.seasons.is_some()),
            (Factor::Wetness, "wetness", self.wetness.is_some()),
            (Factor::Fog, "visibility_m", self.visibility_m.is_some()),
            (Factor::Rain, "rain_mm_h", self.rain_mm_h.is_some()),
            (Factor::Snowfall, "snowfall_mm_h", self.snowfall_mm_h.is_some()),
            (Factor::Snow, "snow", self.snow.is_some()),
            (Factor::Traffic, "traffic", self.traffic.is_some()),
            (Factor::Exposure, "exposure_ev", self.exposure_ev.is_some()),
            (Factor::Camera, "camera_height_m", self.camera_height_m.is_some()),
            (Factor::Camera, "camera_pitch_deg", self.camera_pitch_deg.is_some()),
            (Factor::Rigs, "other_vehicles", self.other_vehicles.is_some()),
            (Factor::Light, "light.hours", light.hours.is_some()),
            (Factor::Light, "light.clouds", light.clouds.is_some()),
            (Factor::Light, "light.turbidity", light.turbidity.is_some()),
            (Factor::Light, "light.environments", !light.environments.is_empty()),
        ]
    }

    pub(super) fn check(&self, light: &LightSection) -> Result<()> {
        let within = |key: &str, range: Option<Range>, [low, high]: Range| {
            let [least, most] = range.unwrap_or([low, high]);
            let expected = format!("two numbers from {low} to {high}, the smaller first");
            check(
                &format!("variations.{key}"),
                format!("[{least}, {most}]"),
                low <= least && least <= most && most <= high,
                &expected,
            )
        };
        check("variations.count", self.count, (1..=100).contains(&self.count), "1 to 100")?;
        let shares = [
            ("dry_share", self.dry_share),
            ("fog_share", self.fog_share),
            ("rain_share", self.rain_share),
            ("snowfall_share", self.snowfall_share),
            ("snow_share", self.snow_share),
        ];
        for (key, share) in shares {
            check(&format!("variations.{key}"), share, (0.0..=1.0).contains(&share), "0 to 1")?;
        }
        within("wetness", self.wetness, [0.0, 1.0])?;
        within("visibility_m", self.visibility_m, VISIBILITY_M)?;
        within("rain_mm_h", self.rain_mm_h, RAIN_MM_H)?;
        within("snowfall_mm_h", self.snowfall_mm_h, SNOWFALL_MM_H)?;
        within("snow", self.snow, [0.0, 1.0])?;
        within("traffic", self.traffic, [0.0, 10.0])?;
        check("variations.cyclists", self.cyclists, (0.0..=100.0).contains(&self.cyclists), "0 to 100")?;
        within("exposure_ev", self.exposure_ev, [-8.0, 8.0])?;
        within("camera_height_m", self.camera_height_m, [-1.0, 3.0])?;
        within("camera_pitch_deg", self.camera_pitch_deg, [-20.0, 20.0])?;
        within("other_vehicles", self.other_vehicles.map(|r| r.map(|n| n as f64)), [0.0, 100.0])?;
        within("light.hours", self.light.hours, [0.0, 24.0])?;
        within("light.clouds", self.light.clouds, [0.0, 1.0])?;
        within("light.turbidity", self.light.turbidity, [1.7, 10.0])?;
        for [lat_deg, lon_deg] in self.places.iter().flatten() {
            check(
                "variations.places",
                format!("[{lat_deg}, {lon_deg}]"),
                (-85.0..=85.0).contains(lat_deg) && (-180.0..=180.0).contains(lon_deg),
                "a latitude of -85 to 85 and a longitude of -180 to 180",
            )?;
        }
        let has_seasons = self.seasons.as_ref().is_none_or(|s| !s.is_empty());
        ensure!(has_seasons, "variations.seasons: expected at least one season, found none; omit it for all");
        let of_sky = self.light.hours.or(self.light.clouds).or(self.light.turbidity).is_some();
        let has_sky = match self.light.environments.as_slice() {
            [] => !light.is_file(),
            names => names.iter().any(|name| name == COMPUTED_SKY),
        };
        ensure!(
            !of_sky || has_sky,
            "variations.light: hours, clouds and turbidity apply only to a computed sky, found only sky images; add \
             {COMPUTED_SKY:?} to variations.light.environments or remove them"
        );
        self.check_counterfactual()?;
        if let Some(factors) = &self.factors {
            for (factor, key, given) in self.ranges() {
                ensure!(
                    !given || factors.contains(&factor),
                    "variations.{key}: expected a factor that varies, found \"{0}\" left out of variations.factors; add \
                     \"{0}\" there or remove the key",
                    factor.name()
                );
            }
        }
        Ok(())
    }
}

impl VariationsSection {
    fn check_counterfactual(&self) -> Result<()> {
        let Some(only) = self.counterfactual else { return Ok(()) };
        let key = "variations.counterfactual";
        ensure!(self.count > 1, "{key}: expected variations.count of 2 or more, found 1; the others differ from v00");
        ensure!(self.first_as_recorded, "{key}: v00 is the recipe's own scene; remove variations.first_as_recorded");
        ensure!(
            self.factors.is_none(),
            "{key}: expected a single factor, found variations.factors too; remove one of them"
        );
        ensure!(
            !matches!(only, Factor::Camera | Factor::Rigs),
            "{key}: expected a factor that does not move the views, found \"{}\"",
            only.name()
        );
        let is_somewhere = only != Factor::Place || self.places.is_some();
        ensure!(is_somewhere, "{key}: expected other places for \"place\", found none; add variations.places");
        for (factor, range, given) in self.ranges() {
            ensure!(
                !given || factor == only,
                "variations.{range}: expected ranges only of \"{}\", the one factor that varies ({key}); remove the key",
                only.name()
            );
        }
        Ok(())
    }
}

impl Factor {
    /// Whether it differs only where a range is given, or where it is named.
    fn needs_range(self) -> bool {
        matches!(
            self,
            Self::Place
                | Self::Season
                | Self::Traffic
                | Self::Wetness
                | Self::Fog
                | Self::Rain
                | Self::Snowfall
                | Self::Snow
                | Self::Exposure
                | Self::Camera
        )
    }
}

/// What folders that were begun without it stand for.
fn is_one(share: &f64) -> bool {
    *share == 1.0
}

impl VariedLight {
    /// The environments as paths; `None` for a computed sky.
    pub fn environments(&self) -> impl Iterator<Item = Option<PathBuf>> {
        self.environments.iter().map(|name| (name != COMPUTED_SKY).then(|| PathBuf::from(name)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::Recipe;

    fn variations(text: &str) -> Result<VariationsSection> {
        let text = format!("[drive]\ndataset = \"nuscenes\"\nroot = \"data\"\n[variations]\n{text}");
        Ok(Recipe::parse(&text)?.variations)
    }

    #[test]
    fn what_has_a_range_varies_and_what_is_named_alone_varies_alone() {
        let plain = variations("").unwrap();
        assert!(plain.varies(Factor::Paint) && plain.varies(Factor::Light) && !plain.varies(Factor::Wetness));
        let ranged = variations("wetness = [0, 0.5]\n[variations.light]\nhours = [7, 19]\n").unwrap();
        assert!(ranged.varies(Factor::Wetness) && !ranged.varies(Factor::Season));
        let named = variations("factors = [\"season\"]\n").unwrap();
        let varying: Vec<Factor> = Factor::ALL.into_iter().filter(|f| named.varies(*f)).collect();
        assert_eq!((varying, named.seasons().len()), (vec![Factor::Season], 4));
        let single = variations("count = 3\ncounterfactual = \"traffic\"\ntraffic = [0.5, 3]\n").unwrap();
        let varying: Vec<Factor> = Factor::ALL.into_iter().filter(|f| single.varies(*f)).collect();
        assert_eq!((varying, single.traffic()), (vec![Factor::Traffic], [0.5, 3.0]));
    }

    #[test]
    fn a_range_out_of_sense_names_key_expectation_and_remedy() {
        for (text, expect) in [
            ("count = 0\n", "variations.count: expected 1 to 100, found 0"),
            (
                "visibility_m = [5, 200]\n",
                "variations.visibility_m: expected two numbers from 10 to 50000, the smaller first",
            ),
            ("fog_share = 2\n", "variations.fog_share: expected 0 to 1, found 2"),
            ("snow = [0, 2]\n", "variations.snow: expected two numbers from 0 to 1, the smaller first"),
            ("rain_mm_h = [0, 9]\n", "variations.rain_mm_h: expected two numbers from 0.1 to 200, the smaller first"),
            ("wetness = [0.5, 0.2]\n", "variations.wetness: expected two numbers from 0 to 1, the smaller first"),
            ("camera_pitch_deg = [-40, 0]\n", "variations.camera_pitch_deg: expected two numbers from -20 to 20"),
            ("[variations.light]\nhours = [7, 25]\n", "variations.light.hours"),
            ("places = [[100, 0]]\n", "variations.places: expected a latitude"),
            ("seasons = []\n", "omit it for all"),
            ("seasons = [\"monsoon\"]\n", "monsoon"),
            ("factors = [\"paint\"]\nwetness = [0, 1]\n", "add \"wetness\" there or remove the key"),
            ("factors = [\"colour\"]\n", "colour"),
            ("cyclists = -1\n", "variations.cyclists: expected 0 to 100"),
            ("traffic = [-1, 1]\n", "variations.traffic: expected two numbers from 0 to 10"),
            ("counterfactual = \"paint\"\n", "expected variations.count of 2 or more, found 1"),
            ("count = 2\ncounterfactual = \"camera\"\n", "does not move the views, found \"camera\""),
            ("count = 2\ncounterfactual = \"paint\"\nfactors = [\"paint\"]\n", "remove one of them"),
            ("count = 2\ncounterfactual = \"paint\"\nfirst_as_recorded = false\n", "v00 is the recipe's own scene"),
            ("count = 2\ncounterfactual = \"paint\"\ntraffic = [0, 2]\n", "expected ranges only of \"paint\""),
            ("exposre_ev = [0, 1]\n", "did you mean `exposure_ev`?"),
        ] {
            let message = format!("{:#}", variations(text).unwrap_err());
            assert!(message.contains(expect), "{message}");
        }
    }
}

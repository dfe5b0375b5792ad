//! `[weather]`: what rain, use and the season have left, and the air.

use anyhow::{Result, ensure};
use glam::DVec2;
use serde::{Deserialize, Serialize};
use trove_build::Weather;
use trove_model::{Fog, Form, Precipitation};

use super::check::{check, is_zero};
use super::season::SeasonChoice;

/// Least and most of visibilities, metres: the densest fogs, and haze.
pub(super) const VISIBILITY_M: [f64; 2] = [10.0, 50_000.0];
/// The same of heights over which fog thins out.
const FOG_HEIGHT_M: [f64; 2] = [2.0, 5000.0];

/// The same of rain, millimetres an hour: a drizzle, and the heaviest cloudbursts.
pub(super) const RAIN_MM_H: [f64; 2] = [0.1, 200.0];
/// The same of snow that falls, millimetres of water an hour.
pub(super) const SNOWFALL_MM_H: [f64; 2] = [0.05, 10.0];

/// What wind comes from where nobody says so.
const WEST_DEG: f64 = 270.0;

/// `[weather]`
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct WeatherSection {
    /// 0 (dry) to 1 (after heavy rain).
    pub wetness: f64,
    /// 0 (washed) to 1 (as streets are).
    pub dirt: f64,
    /// What time of the year plants show.
    pub season: SeasonChoice,
    /// Meteorological optical range of fog or haze, metres; without it the air is clear.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub visibility_m: Option<f64>,
    /// So far above the ground there is 1/e of the fog, metres; without it 0.4 times the visibility, 30 to 1000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fog_height_m: Option<f64>,
    /// Rain that falls, millimetres of water an hour.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rain_mm_h: Option<f64>,
    /// Snow that falls, millimetres of water an hour.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub snowfall_mm_h: Option<f64>,
    /// How fast the wind blows that carries rain, snow and spray, metres a second.
    #[serde(skip_serializing_if = "is_zero")]
    pub wind_mps: f64,
    /// Where it comes from, degrees from north through east; without it from the west.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wind_from_deg: Option<f64>,
    /// Share of level surfaces in the open that snow covers, 0 to 1.
    #[serde(skip_serializing_if = "is_zero")]
    pub snow: f64,
}

impl Default for WeatherSection {
    fn default() -> Self {
        let Weather { dirt, wetness, season: _, fog: _, falling: _, wind_mps, snow, people_respond: _ } =
            Weather::default();
        let season = SeasonChoice::default();
        Self {
            wetness,
            dirt,
            season,
            visibility_m: None,
            fog_height_m: None,
            rain_mm_h: None,
            snowfall_mm_h: None,
            wind_mps: wind_mps.length(),
            wind_from_deg: None,
            snow,
        }
    }
}

impl WeatherSection {
    /// What weather has done to the place, with fog of the visibility that is told.
    pub fn weather(&self) -> Weather {
        let fog = self.visibility_m.map(|visibility_m| self.fog(visibility_m));
        let rain = self.rain_mm_h.map(rain);
        let falling = self.snowfall_mm_h.map(snowfall).or(rain);
        let (dirt, wetness, season, snow) = (self.dirt, self.wetness, self.season.into(), self.snow);
        // From the north it blows to the south.
        let from = (90.0 - self.wind_from_deg.unwrap_or(WEST_DEG)).to_radians();
        let wind_mps = -DVec2::from_angle(from) * self.wind_mps;
        Weather { dirt, wetness, season, fog, falling, wind_mps, snow, ..Weather::default() }
    }

    /// Fog of a visibility, over a ground at 0.
    pub fn fog(&self, visibility_m: f64) -> Fog {
        let height_m = self.fog_height_m.unwrap_or_else(|| fog_height_m(visibility_m));
        Fog { visibility_m, height_m, ground_z_m: 0.0 }
    }

    /// `varies`: whether variations draw a visibility.
    pub(super) fn check(&self, varies: bool) -> Result<()> {
        let shares = [("weather.wetness", self.wetness), ("weather.dirt", self.dirt), ("weather.snow", self.snow)];
        for (key, share) in shares {
            check(key, share, (0.0..=1.0).contains(&share), "0 to 1")?;
        }
        let metres =
            [("visibility_m", self.visibility_m, VISIBILITY_M), ("fog_height_m", self.fog_height_m, FOG_HEIGHT_M)];
        let metres = metres.map(|(key, value, range)| (key, value, range, "metres"));
        let falling = [("rain_mm_h", self.rain_mm_h, RAIN_MM_H), ("snowfall_mm_h", self.snowfall_mm_h, SNOWFALL_MM_H)];
        let falling = falling.map(|(key, value, range)| (key, value, range, "millimetres an hour"));
        let wind = [
            ("wind_mps", Some(self.wind_mps), [0.0, 40.0], "metres a second"),
            ("wind_from_deg", self.wind_from_deg, [0.0, 360.0], "degrees"),
        ];
        for (key, value, [least, most], unit) in metres.into_iter().chain(falling).chain(wind) {
            let Some(value) = value else { continue };
            let expected = format!("{least} to {most} {unit}");
            check(&format!("weather.{key}"), value, (least..=most).contains(&value), &expected)?;
        }
        ensure!(
            self.rain_mm_h.is_none() || self.snowfall_mm_h.is_none(),
            "weather.snowfall_mm_h: expected rain or snow, found both; remove it or weather.rain_mm_h"
        );
        ensure!(
            self.fog_height_m.is_none() || self.visibility_m.is_some() || varies,
            "weather.fog_height_m: expected fog, found clear air; add weather.visibility_m"
        );
        Ok(())
    }
}

/// Rain of so many millimetres an hour.
pub fn rain(rate_mm_h: f64) -> Precipitation {
    Precipitation { form: Form::Rain, rate_mm_h }
}

/// Snow that falls, of so many millimetres of water an hour.
pub fn snowfall(rate_mm_h: f64) -> Precipitation {
    Precipitation { form: Form::Snow, rate_mm_h }
}

/// Share of the ground that what falls keeps covered with snow.
pub fn covered_by(falling: Precipitation) -> f64 {
    match falling.form {
        Form::Rain => 0.0,
        Form::Snow => (0.6 + 0.4 * falling.rate_mm_h.log10()).clamp(0.3, 1.0),
    }
}

/// How wet the ground is kept by rain, of which from about 1 mm an hour on there are puddles, and by what melts of snow that
/// covers a share of it.
pub fn wet_by(falling: Option<Precipitation>, snow: f64) -> f64 {
    let by_rain = falling
        .filter(|falling| falling.form == Form::Rain)
        .map_or(0.0, |rain| (0.5 + 0.25 * rain.rate_mm_h.log10()).clamp(0.4, 1.0));
    by_rain.max(0.35 * snow)
}

/// Fog through which about a third of the sun's light comes straight, as long as it is neither a mist on the ground nor as
/// high as haze.
fn fog_height_m(visibility_m: f64) -> f64 {
    (0.4 * visibility_m).clamp(30.0, 1000.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::Recipe;

    fn weather(text: &str) -> Result<WeatherSection> {
        let text = format!("[drive]\ndataset = \"nuscenes\"\nroot = \"data\"\n[weather]\n{text}");
        Ok(Recipe::parse(&text)?.weather)
    }

    #[test]
    fn wind_blows_from_where_it_is_said_to_come() {
        for (text, expected) in
            [("", [0.0; 2]), ("wind_mps = 6", [6.0, 0.0]), ("wind_mps = 6\nwind_from_deg = 0", [0.0, -6.0])]
        {
            let found = weather(text).unwrap().weather().wind_mps;
            assert!((found - DVec2::from(expected)).length() < 1e-9, "{text}: {found}");
        }
    }

    #[test]
    fn fog_is_there_where_a_visibility_is_and_nowhere_else() {
        assert_eq!(weather("wetness = 0.5").unwrap().weather().fog, None);
        let fog = |text| weather(text).unwrap().weather().fog.unwrap();
        assert_eq!((fog("visibility_m = 200").height_m, fog("visibility_m = 20").height_m), (80.0, 30.0));
        let low = fog("visibility_m = 200\nfog_height_m = 8");
        // 5 % is left after 200 m.
        assert_eq!((low.visibility_m, low.height_m), (200.0, 8.0));
        assert!(((-low.extinction_per_m() * 200.0).exp() - 0.05).abs() < 1e-12);
        for (text, expected) in [
            ("visibility_m = 5", "weather.visibility_m: expected 10 to 50000 metres, found 5"),
            ("visibility_m = 50\nfog_height_m = 0", "weather.fog_height_m: expected 2 to 5000 metres, found 0"),
            ("fog_height_m = 20", "add weather.visibility_m"),
            ("snowfall_mm_h = 50", "weather.snowfall_mm_h: expected 0.05 to 10 millimetres an hour, found 50"),
            ("snowfall_mm_h = 1\nrain_mm_h = 1", "expected rain or snow, found both"),
            ("wind_mps = 50", "weather.wind_mps: expected 0 to 40 metres a second, found 50"),
            ("snow = 2", "weather.snow: expected 0 to 1, found 2"),
            ("rain_mm_h = 0", "weather.rain_mm_h: expected 0.1 to 200 millimetres an hour, found 0"),
        ] {
            let found = weather(text).unwrap_err().to_string();
            assert!(found.contains(expected), "{found}");
        }
    }
}

//! `[light]`: sun and sky.

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use trove_build::{Moment, SkyChoice};
use trove_read::ClockTime;

use super::check::check;

/// `[light]`
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct LightSection {
    /// `capture-time`, `random`, or the path of an `.hdr` or `.exr` file.
    pub environment: String,
    /// Turns the file's surroundings counter-clockwise seen from above.
    pub rotation_deg: f64,
    /// Another time than the recording's, RFC 3339: `2018-08-01T15:26:00Z`.
    pub time: Option<String>,
    /// Linke turbidity; drawn without it.
    pub turbidity: Option<f64>,
    /// Mean reflectance of the ground, for the light that clouds and sky get back.
    pub ground_albedo: Option<f64>,
    /// Share of the sky that is clouded; drawn without it.
    pub clouds: Option<f64>,
}

impl Default for LightSection {
    fn default() -> Self {
        Self {
            environment: "capture-time".into(),
            rotation_deg: 0.0,
            time: None,
            turbidity: None,
            ground_albedo: None,
            clouds: None,
        }
    }
}

impl LightSection {
    /// Whether a photographed sky is asked for.
    pub fn is_file(&self) -> bool {
        !matches!(self.environment.as_str(), "capture-time" | "random")
    }

    /// The computed sky: the recording's own, or one that is drawn.
    ///
    /// # Errors
    /// As [`LightSection::time_ns`].
    pub fn sky(&self, is_drawn: bool) -> Result<SkyChoice> {
        let moment = match self.time_ns()? {
            Some(time_ns) => Moment::At(time_ns),
            None if self.environment == "capture-time" && !is_drawn => Moment::Capture,
            None => Moment::Drawn,
        };
        let Self { turbidity, ground_albedo, clouds, .. } = *self;
        Ok(SkyChoice { moment, turbidity, ground_albedo, clouds })
    }

    pub(super) fn check(&self) -> Result<()> {
        self.time_ns()?;
        check("light.rotation_deg", self.rotation_deg, self.rotation_deg.is_finite(), "a finite number")?;
        let is_within = |value: Option<f64>, low: f64, high: f64| value.is_none_or(|v| (low..=high).contains(&v));
        let shown = |value: Option<f64>| value.unwrap_or_default();
        check("light.turbidity", shown(self.turbidity), is_within(self.turbidity, 1.7, 10.0), "1.7 to 10")?;
        check("light.ground_albedo", shown(self.ground_albedo), is_within(self.ground_albedo, 0.0, 1.0), "0 to 1")?;
        check("light.clouds", shown(self.clouds), is_within(self.clouds, 0.0, 1.0), "0 to 1")?;
        let is_file = self.is_file();
        let of_sky = self.time.is_some() || self.turbidity.or(self.ground_albedo).or(self.clouds).is_some();
        ensure!(
            !(is_file && of_sky),
            "light: time, turbidity, ground_albedo and clouds apply only to a computed sky; remove them or the file \
             {:?} in light.environment",
            self.environment
        );
        ensure!(
            is_file || self.rotation_deg == 0.0,
            "light.rotation_deg: only a sky image can be rotated; the computed sun follows place and time"
        );
        Ok(())
    }

    /// The time that is told, nanoseconds since 1970 UTC.
    ///
    /// # Errors
    /// A `light.time` that is not RFC 3339 with date, time and offset, or is not from 1700 to 2200.
    pub fn time_ns(&self) -> Result<Option<i64>> {
        let Some(text) = &self.time else { return Ok(None) };
        let time = ClockTime::parse(text).filter(|time| time.ahead_s.is_some()).with_context(|| {
            format!(
                "light.time: expected date, time, and Z or an offset such as +08:00, from 1700 to 2200, such as \
                 \"2018-08-01T15:26:00Z\", found {text:?}"
            )
        })?;
        Ok(Some(time.utc_ns(0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_with_their_offset() {
        let section = |text: &str| LightSection { time: Some(text.into()), ..LightSection::default() };
        let noon_ns = Some(1_533_124_800_000_000_000);
        assert_eq!(section("2018-08-01T08:00:00-04:00").time_ns().unwrap(), noon_ns);
        for text in ["noon", "2018-08-01", "2018-08-01T15:26:00"] {
            assert!(section(text).check().unwrap_err().to_string().contains("light.time"), "{text}");
        }
    }

    #[test]
    fn a_file_has_no_weather_and_a_sky_no_rotation() {
        let file = LightSection { environment: "sky.hdr".into(), ..LightSection::default() };
        assert!(LightSection { rotation_deg: 30.0, ..file.clone() }.check().is_ok());
        assert!(LightSection { clouds: Some(0.3), ..file }.check().is_err());
        assert!(LightSection { rotation_deg: 30.0, ..LightSection::default() }.check().is_err());
        assert!(LightSection { turbidity: Some(0.5), ..LightSection::default() }.check().is_err());
    }
}

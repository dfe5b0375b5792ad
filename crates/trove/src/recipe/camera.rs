//! `[camera]`: what the pictures are taken with.

use std::collections::BTreeMap;

use anyhow::{Result, anyhow, ensure};
use serde::{Deserialize, Serialize};
use trove_build::LensChange;
use trove_format::LensModel;
use trove_model::{ExposureRule, Film, LensDrops, SensorModel, WhiteBalance};

use super::check::{check, is_zero};

/// `[camera]`
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct CameraSection {
    /// Brightness.
    pub exposure_ev: Exposure,
    /// Correction of a metered exposure, stops.
    pub compensation_ev: f64,
    /// Which light becomes white.
    pub white_balance: Balance,
    /// How steeply brightness runs around a grey card.
    pub contrast: f64,
    /// Time for which a row of the sensor is exposed; 0 is an instant.
    pub exposure_s: f64,
    /// From the first row's exposure to the last one's; 0 is a global shutter.
    pub readout_s: f64,
    /// Share of the glass before the lens that drops of water cover.
    #[serde(skip_serializing_if = "is_zero")]
    pub drops: f64,
    /// Lenses in place of the recorded ones, by the camera's name or `all`.
    pub lens: BTreeMap<String, LensSection>,
    /// Faults of a real camera; without it there are none.
    pub sensor: Option<SensorSection>,
}

/// `"auto"`, or the power of 2 that radiance is multiplied by.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Exposure {
    /// `"auto"`
    Metered(Metered),
    /// Stops.
    Fixed(f64),
}

/// The word `"auto"`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Metered {
    /// Metered.
    Auto,
}

/// Which light becomes white.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Balance {
    /// The picture's.
    Auto,
    /// D65.
    Daylight,
}

/// `[camera.lens.NAME]`
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct LensSection {
    /// Which model of distortion.
    pub model: LensModel,
    /// Its coefficients in OpenCV's order; those left out are 0.
    #[serde(default)]
    pub distortion: Vec<f64>,
    /// Focal length in pixels of the recording; without it the recorded one.
    pub focal_px: Option<f64>,
}

/// `[camera.sensor]`: a car's camera, unless told otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct SensorSection {
    /// Electrons that a pixel holds at white.
    pub full_well_e: f64,
    /// Noise of reading, electrons.
    pub read_noise_e: f64,
    /// Share of the light lost in the corners.
    pub vignetting: f64,
    /// Standard deviation of the blur, pixels.
    pub blur_px: f64,
    /// Between neighbouring colours in the corners, pixels.
    pub chromatic_aberration_px: f64,
    /// Share of the light that the lens scatters.
    pub glare: f64,
    /// 1 to 100; 0 is none.
    pub jpeg_quality: u8,
}

impl Default for CameraSection {
    fn default() -> Self {
        Self {
            exposure_ev: Exposure::Metered(Metered::Auto),
            compensation_ev: 0.0,
            white_balance: Balance::Auto,
            contrast: Film::CONTRAST,
            exposure_s: 0.0,
            readout_s: 0.0,
            drops: 0.0,
            lens: BTreeMap::new(),
            sensor: None,
        }
    }
}

impl Default for SensorSection {
    fn default() -> Self {
        let model = SensorModel::AUTOMOTIVE;
        Self {
            full_well_e: model.full_well_e,
            read_noise_e: model.read_noise_e,
            vignetting: model.vignetting,
            blur_px: model.blur_px,
            chromatic_aberration_px: model.chromatic_aberration_px,
            glare: model.glare,
            jpeg_quality: model.jpeg_quality.unwrap_or(0),
        }
    }
}

impl CameraSection {
    pub(super) fn check(&self) -> Result<()> {
        let stops = |key, ev: f64| check(key, ev, ev.abs() <= 64.0, "-64 to 64");
        if let Exposure::Fixed(ev) = self.exposure_ev {
            stops("camera.exposure_ev", ev)?;
        }
        stops("camera.compensation_ev", self.compensation_ev)?;
        check("camera.contrast", self.contrast, (0.2..=5.0).contains(&self.contrast), "0.2 to 5")?;
        for (key, seconds) in [("camera.exposure_s", self.exposure_s), ("camera.readout_s", self.readout_s)] {
            check(key, seconds, (0.0..=0.1).contains(&seconds), "0 to 0.1")?;
        }
        // As long as the renderer knows how things move.
        let open_s = self.exposure_s + self.readout_s;
        check("camera.exposure_s + camera.readout_s", open_s, open_s <= 0.1, "at most 0.1")?;
        let most = LensDrops::MOST;
        check("camera.drops", self.drops, (0.0..=most).contains(&self.drops), &format!("0 to {most}"))?;
        if let Some(sensor) = &self.sensor {
            let within = |key: &str, value: f64, most: f64| {
                check(&format!("camera.sensor.{key}"), value, (0.0..=most).contains(&value), &format!("0 to {most}"))
            };
            let full = sensor.full_well_e;
            check("camera.sensor.full_well_e", full, (1.0..=1e9).contains(&full), "1 to 1e9")?;
            within("read_noise_e", sensor.read_noise_e, 1e6)?;
            within("vignetting", sensor.vignetting, 0.99)?;
            within("blur_px", sensor.blur_px, 20.0)?;
            within("chromatic_aberration_px", sensor.chromatic_aberration_px, 20.0)?;
            within("glare", sensor.glare, 0.5)?;
            within("jpeg_quality", sensor.jpeg_quality.into(), 100.0)?;
        }
        self.lenses().map(drop)
    }

    /// The lenses that replace recorded ones.
    ///
    /// # Errors
    /// A lens whose model, coefficients or focal length cannot be used.
    pub fn lenses(&self) -> Result<BTreeMap<String, LensChange>> {
        let change = |(name, section): (&String, &LensSection)| {
            Ok((name.clone(), section.change().map_err(|e| anyhow!("camera.lens.{name}.{e}"))?))
        };
        self.lens.iter().map(change).collect()
    }

    /// From light to picture.
    pub fn film(&self) -> Film {
        let exposure = match self.exposure_ev {
            Exposure::Metered(Metered::Auto) => ExposureRule::Auto { compensation_ev: self.compensation_ev },
            Exposure::Fixed(ev) => ExposureRule::Fixed { ev },
        };
        let white_balance = match self.white_balance {
            Balance::Auto => WhiteBalance::Auto,
            Balance::Daylight => WhiteBalance::Daylight,
        };
        Film { exposure, white_balance, contrast: self.contrast, sensor: self.sensor.map(SensorModel::from) }
    }
}

impl LensSection {
    fn change(&self) -> Result<LensChange> {
        let distortion = self.model.distortion(&self.distortion).map_err(anyhow::Error::msg)?;
        let focal_px = self.focal_px;
        ensure!(
            focal_px.is_none_or(|f| f.is_finite() && f >= 1.0),
            "focal_px: expected 1 or more, found {}",
            focal_px.unwrap_or_default()
        );
        Ok(LensChange { focal_px, distortion })
    }
}

impl From<SensorSection> for SensorModel {
    fn from(section: SensorSection) -> Self {
        Self {
            full_well_e: section.full_well_e,
            read_noise_e: section.read_noise_e,
            vignetting: section.vignetting,
            blur_px: section.blur_px,
            chromatic_aberration_px: section.chromatic_aberration_px,
            glare: section.glare,
            jpeg_quality: (section.jpeg_quality > 0).then_some(section.jpeg_quality),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::Recipe;

    fn camera(text: &str) -> Result<CameraSection> {
        Ok(Recipe::parse(&format!("[drive]\ndataset = \"nuscenes\"\nroot = \"data\"\n{text}"))?.camera)
    }

    #[test]
    fn a_camera_is_perfect_and_automatic_unless_told_otherwise() {
        let plain = camera("").unwrap();
        assert_eq!(plain.film(), Film::default());
        assert!(plain.lenses().unwrap().is_empty());
        let fixed = camera("[camera]\nexposure_ev = 1\nwhite_balance = \"daylight\"\n").unwrap().film();
        assert_eq!(fixed.exposure, ExposureRule::Fixed { ev: 1.0 });
        assert_eq!(fixed.white_balance, WhiteBalance::Daylight);
        assert_eq!(camera("[camera]\ncontrast = 0.9\n").unwrap().film().contrast, 0.9);
    }

    #[test]
    fn an_empty_sensor_is_a_cars_and_each_of_its_faults_can_be_told() {
        assert_eq!(camera("[camera.sensor]\n").unwrap().film().sensor, Some(SensorModel::AUTOMOTIVE));
        let told = camera("[camera.sensor]\nblur_px = 1\njpeg_quality = 0\n").unwrap().film().sensor;
        assert_eq!(told, Some(SensorModel { blur_px: 1.0, jpeg_quality: None, ..SensorModel::AUTOMOTIVE }));
    }

    #[test]
    fn lenses_are_given_for_all_cameras_or_by_name() {
        let text = "[camera.lens.all]\nmodel = \"brown-conrady\"\ndistortion = [-0.3, 0.1]\n\
                    [camera.lens.CAM_BACK]\nmodel = \"kannala-brandt\"\nfocal_px = 500\n";
        let lenses = camera(text).unwrap().lenses().unwrap();
        assert_eq!(lenses["all"].distortion.coefficients(), [-0.3, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(
            (lenses["CAM_BACK"].distortion.name(), lenses["CAM_BACK"].focal_px),
            ("kannala-brandt", Some(500.0))
        );
    }

    #[test]
    fn a_value_that_no_camera_has_is_refused() {
        for (text, expect) in [
            ("[camera]\nexposure_s = 2\n", "camera.exposure_s: expected 0 to 0.1"),
            ("[camera]\nexposure_s = 0.06\nreadout_s = 0.06\n", "expected at most 0.1"),
            ("[camera]\ncontrast = 0\n", "camera.contrast: expected 0.2 to 5, found 0"),
            ("[camera]\ndrops = 0.6\n", "camera.drops: expected 0 to 0.5"),
            ("[camera.sensor]\nvignetting = 1.0\n", "camera.sensor.vignetting"),
            (
                "[camera.lens.all]\nmodel = \"pinhole\"\ndistortion = [0.1]\n",
                "camera.lens.all.distortion: expected at most 0",
            ),
            ("[camera.lens.A]\nmodel = \"kannala-brandt\"\nfocal_px = 0\n", "camera.lens.A.focal_px"),
            ("[camera]\nexposre_ev = 3\n", "did you mean `exposure_ev`?"),
        ] {
            let message = format!("{:#}", camera(text).unwrap_err());
            assert!(message.contains(expect), "{message}");
        }
    }
}

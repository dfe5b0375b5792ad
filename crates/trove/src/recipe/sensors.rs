//! `[sensors.NAME]`: what measures beside the cameras.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail, ensure};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};
use trove_build::{MountedLidar, MountedRadar};
use trove_files::PathComponent;
use trove_model::{Drive, Outcome, Pose, Radar, Report, RigLidar, Scanner, SweepPhase};
use trove_read::radar;
use trove_read::scanner::{self, Returns, ScannerChoice};

use super::check::{check, nearest};

/// How far a LiDAR that nobody placed stands above the roof's middle, metres.
const ABOVE_ROOF_M: f64 = 0.3;

/// How high above the ground a radar that nobody placed is in the middle of the front, metres.
const RADAR_HEIGHT_M: f64 = 0.5;

/// Sensors by their names.
pub type SensorsSection = BTreeMap<String, SensorSection>;

/// `[sensors.NAME]`
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct SensorSection {
    /// What it is.
    pub kind: SensorKind,
    /// A maker's LiDAR or radar, or a path that ends in `.toml`.
    pub preset: String,
    /// Sweeps a second of a LiDAR; without it the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate_hz: Option<f64>,
    /// Which returns a LiDAR tells; without it the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub returns: Option<Returns>,
    /// Where it is in Ego; without it a LiDAR is where the recording has it, else on the roof, and a radar in the front.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position_m: Option<[f64; 3]>,
    /// To the left of straight ahead, up, and leaning to its right; with `position_m`.
    #[serde(default)]
    pub yaw_deg: f64,
    /// Up.
    #[serde(default)]
    pub pitch_deg: f64,
    /// To its right.
    #[serde(default)]
    pub roll_deg: f64,
}

/// What a sensor is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SensorKind {
    /// Laser pulses.
    Lidar,
    /// Millimetre waves.
    Radar,
}

/// Checks names and numbers.
pub(super) fn check_all(sensors: &SensorsSection) -> Result<()> {
    for (name, sensor) in sensors {
        let key = |key: &str| format!("sensors.{name}.{key}");
        let fits = PathComponent::new(name);
        ensure!(fits.is_ok(), "sensors: expected names that folders can have, found {name:?}");
        if let Some(rate_hz) = sensor.rate_hz {
            check(&key("rate_hz"), rate_hz, (1.0..=200.0).contains(&rate_hz), "1 to 200")?;
        }
        for (name, deg) in [("yaw_deg", sensor.yaw_deg), ("pitch_deg", sensor.pitch_deg), ("roll_deg", sensor.roll_deg)]
        {
            check(&key(name), deg, (-360.0..=360.0).contains(&deg), "-360 to 360")?;
            let placed = deg == 0.0 || sensor.position_m.is_some();
            ensure!(placed, "{}: expected position_m beside it, found none", key(name));
        }
        if let Some(position_m) = sensor.position_m {
            let near = position_m.iter().all(|m| m.abs() <= 100.0);
            check(&key("position_m"), format!("{position_m:?}"), near, "three numbers of at most 100")?;
        }
        if sensor.kind == SensorKind::Radar {
            let of_lidars = [("rate_hz", sensor.rate_hz.is_some()), ("returns", sensor.returns.is_some())];
            if let Some((name, _)) = of_lidars.into_iter().find(|(_, is_set)| *is_set) {
                bail!("{}: expected none for a radar; its file says its cycle", key(name));
            }
        }
        let (is_known, known): (bool, Vec<&str>) = match sensor.kind {
            SensorKind::Lidar => {
                (scanner::preset(&sensor.preset, &sensor.choice()).is_some(), scanner::presets().collect())
            }
            SensorKind::Radar => (radar::preset(&sensor.preset).is_some(), radar::presets().collect()),
        };
        if sensor.file().is_none() && !is_known {
            let hint = nearest(&sensor.preset, &known);
            bail!(
                "{}: expected one of {}, or a path that ends in .toml, found {:?}{hint}",
                key("preset"),
                known.join(", "),
                sensor.preset
            );
        }
    }
    Ok(())
}

impl SensorSection {
    /// The file that says what it is, as the recipe has it; `None` for a preset.
    pub fn file(&self) -> Option<&Path> {
        self.preset.ends_with(".toml").then(|| Path::new(&self.preset))
    }

    fn choice(&self) -> ScannerChoice {
        ScannerChoice { rate_hz: self.rate_hz, returns: self.returns }
    }

    /// The LiDAR itself; `at` is where its file lies.
    ///
    /// # Errors
    /// A file that cannot be read or makes no LiDAR.
    pub fn scanner(&self, at: impl Fn(&Path) -> PathBuf) -> Result<Scanner> {
        match self.file() {
            Some(file) => Ok(scanner::read(&at(file), &self.choice())?),
            None => match scanner::preset(&self.preset, &self.choice()) {
                Some(scanner) => Ok(scanner),
                None => bail!("sensors: {:?} is no LiDAR", self.preset),
            },
        }
    }

    /// The radar itself; `at` is where its file lies.
    ///
    /// # Errors
    /// A file that cannot be read or makes no radar.
    pub fn radar(&self, at: impl Fn(&Path) -> PathBuf) -> Result<Radar> {
        match self.file() {
            Some(file) => Ok(radar::read(&at(file))?),
            None => match radar::preset(&self.preset) {
                Some(radar) => Ok(radar),
                None => bail!("sensors: {:?} is no radar", self.preset),
            },
        }
    }

    /// The radar on a drive's vehicle.
    pub fn mounted_radar(&self, name: &str, radar: Radar, drive: &Drive, report: &Report) -> MountedRadar {
        let position_m = self.position_m.map_or_else(|| in_front(drive, name, report), DVec3::from_array);
        MountedRadar { name: name.into(), radar, ego_from_radar: Pose::new(self.rotation(), position_m) }
    }

    /// The LiDAR on a drive's vehicle.
    pub fn mounted(&self, name: &str, scanner: Scanner, drive: &Drive, report: &Report) -> MountedLidar {
        let recorded = drive.lidars.iter().find(|lidar| lidar.name == name).or(drive.lidars.first());
        let mount = match (self.position_m, recorded) {
            (None, Some(recorded)) => RigLidar { name: name.into(), ..recorded.clone() },
            (position_m, _) => {
                let position_m = position_m.map_or_else(|| on_roof(drive, name, report), DVec3::from_array);
                let phase = SweepPhase::FORWARD;
                RigLidar { name: name.into(), ego_from_lidar: Pose::new(self.rotation(), position_m), phase }
            }
        };
        MountedLidar { scanner, mount }
    }

    /// Ego from the sensor's axes: x ahead, y left, z up.
    fn rotation(&self) -> DQuat {
        let [yaw, pitch, roll] = [self.yaw_deg, self.pitch_deg, self.roll_deg].map(f64::to_radians);
        DQuat::from_rotation_z(yaw) * DQuat::from_rotation_y(-pitch) * DQuat::from_rotation_x(roll)
    }
}

fn in_front(drive: &Drive, name: &str, report: &Report) -> DVec3 {
    report.note(Outcome::Guessed, "place of a radar, in the middle of the front", format!("{} {name}", drive.id));
    let body = drive.ego_body;
    DVec3::new(body.centre_ego.x + body.size_m.x / 2.0, body.centre_ego.y, RADAR_HEIGHT_M)
}

fn on_roof(drive: &Drive, name: &str, report: &Report) -> DVec3 {
    report.note(Outcome::Guessed, "place of a LiDAR, above the roof's middle", format!("{} {name}", drive.id));
    let body = drive.ego_body;
    body.centre_ego + DVec3::Z * (body.size_m.z / 2.0 + ABOVE_ROOF_M)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sensors(text: &str) -> Result<SensorsSection> {
        let sensors: SensorsSection = toml::from_str(text)?;
        check_all(&sensors)?;
        Ok(sensors)
    }

    #[test]
    fn a_lidar_is_a_preset_or_a_file_somewhere_on_the_vehicle() {
        let text = "[TOP]\nkind = \"lidar\"\npreset = \"hdl-32e\"\nrate_hz = 10\n\
                    [SIDE]\nkind = \"lidar\"\npreset = \"my.toml\"\nposition_m = [1, 0.9, 0.6]\nyaw_deg = 90";
        let sensors = sensors(text).unwrap();
        let scanner = sensors["TOP"].scanner(Path::to_owned).unwrap();
        assert_eq!(scanner.sweep_s, 0.1);
        assert_eq!(sensors["SIDE"].file(), Some(Path::new("my.toml")));
        assert!((sensors["SIDE"].rotation() * DVec3::X - DVec3::Y).length() < 1e-12);
        assert!(sensors["SIDE"].scanner(|_| "/nowhere/my.toml".into()).is_err());
    }

    #[test]
    fn what_makes_no_sensor_is_told() {
        for (text, expect) in [
            ("[A]\nkind = \"lidar\"\npreset = \"hdl-32\"", "did you mean `hdl-32e`?"),
            ("[A]\nkind = \"sonar\"\npreset = \"a\"", "sonar"),
            ("[A]\nkind = \"radar\"\npreset = \"hdl-32e\"", "expected one of ars408"),
            (
                "[A]\nkind = \"radar\"\npreset = \"ars408\"\nrate_hz = 10",
                "sensors.A.rate_hz: expected none for a radar",
            ),
            ("[A]\nkind = \"lidar\"\npreset = \"vlp-16\"\nrate_hz = 0", "sensors.A.rate_hz: expected 1 to 200"),
            ("[A]\nkind = \"lidar\"\npreset = \"vlp-16\"\nyaw_deg = 3", "position_m beside it"),
            ("[\"a/b\"]\nkind = \"lidar\"\npreset = \"vlp-16\"", "names that folders can have"),
        ] {
            let error = format!("{:#}", sensors(text).unwrap_err());
            assert!(error.contains(expect), "{error}");
        }
    }
}

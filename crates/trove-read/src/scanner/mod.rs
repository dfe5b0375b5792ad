//! LiDARs (TOML) → `Scanner`s: the makers' own by name, and others from files of the same form.

use std::f64::consts::TAU;
use std::path::Path;

use serde::Deserialize;
use trove_files::{LARGEST_TEXT, read_text};
use trove_model::{Scanner, ToldReturns};

use crate::ReadError;
use crate::toml_fault;

/// LiDARs that need no file, by name.
const PRESETS: [(&str, &str); 7] = [
    ("hdl-32e", include_str!("presets/hdl-32e.toml")),
    ("hdl-64e", include_str!("presets/hdl-64e.toml")),
    ("os1-128", include_str!("presets/os1-128.toml")),
    ("rs-m1", include_str!("presets/rs-m1.toml")),
    ("vlp-16", include_str!("presets/vlp-16.toml")),
    ("vlp-32c", include_str!("presets/vlp-32c.toml")),
    ("vls-128", include_str!("presets/vls-128.toml")),
];
/// More beams than any LiDAR sends in a sweep.
const MOST_BEAMS: usize = 4_000_000;
const MOST_RINGS: usize = 4096;

/// A LiDAR as its file has it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScannerFile {
    /// Whose numbers they are; for people.
    #[serde(rename = "source")]
    _source: Option<String>,
    /// Rings in the order of their numbers.
    elevations_deg: Vec<Rings>,
    /// A full turn without it.
    width_deg: Option<f64>,
    rate_hz: f64,
    /// From one column to the next …
    column_us: Option<f64>,
    /// … or how many there are in a sweep.
    columns: Option<usize>,
    divergence_mrad: f64,
    nearest_m: f64,
    farthest_m: f64,
    reach_m: f64,
    noise_m: f64,
    pulse_m: f64,
    /// How its intensities rise; evenly without it.
    intensity_exponent: Option<f64>,
    #[serde(default)]
    returns: Returns,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Rings {
    One(f64),
    Even { from: f64, to: f64, count: usize },
}

/// Which returns of a beam are told, as files name them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Returns {
    /// That of the most power.
    #[default]
    Strongest,
    /// The farthest.
    Last,
    /// Both.
    Dual,
}

impl From<Returns> for ToldReturns {
    fn from(returns: Returns) -> Self {
        match returns {
            Returns::Strongest => Self::Strongest,
            Returns::Last => Self::Last,
            Returns::Dual => Self::Dual,
        }
    }
}

/// What a user may set of a LiDAR.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScannerChoice {
    /// Sweeps a second; without it those of the file.
    pub rate_hz: Option<f64>,
    /// Which returns are told; without it those of the file.
    pub returns: Option<Returns>,
}

/// Names of the LiDARs that need no file, in alphabetical order.
pub fn presets() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|(name, _)| *name)
}

/// A LiDAR that needs no file; `None` for a name that is no such one's, or a choice that makes none.
pub fn preset(name: &str, choice: &ScannerChoice) -> Option<Scanner> {
    let (_, text) = PRESETS.iter().find(|(preset, _)| *preset == name)?;
    parse(name, text, choice).ok()
}

/// Reads a LiDAR's file.
///
/// # Errors
/// A file that cannot be read, is not TOML, or whose numbers make no LiDAR.
pub fn read(path: &Path, choice: &ScannerChoice) -> Result<Scanner, ReadError> {
    let text = read_text(path, LARGEST_TEXT).map_err(|source| ReadError::io(path, source))?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    parse(&name, &text, choice).map_err(|(place, expected, found)| ReadError::Format {
        path: path.to_owned(),
        place,
        expected,
        found,
        remedy: "see docs/lidar.md".into(),
    })
}

/// The place, what was expected there, and what was found.
type Fault = (String, String, String);

fn parse(name: &str, text: &str, choice: &ScannerChoice) -> Result<Scanner, Fault> {
    let file: ScannerFile = toml::from_str(text)
        .map_err(|error| (toml_fault::place(text, &error), "a LiDAR in TOML".to_owned(), error.message().to_owned()))?;
    let within = |key: &str, value: f64, low: f64, high: f64| {
        let fault = || (key.to_owned(), format!("{low} to {high}"), value.to_string());
        if value >= low && value <= high { Ok(value) } else { Err(fault()) }
    };
    let sweep_s = 1.0 / within("rate_hz", choice.rate_hz.unwrap_or(file.rate_hz), 1.0, 200.0)?;
    let columns = match (file.column_us, file.columns) {
        (Some(us), None) => (sweep_s / (within("column_us", us, 0.1, 1e5)? * 1e-6)).round() as usize,
        (None, Some(columns)) => columns,
        _ => return Err(("column_us".into(), "it or columns".into(), "both or neither".into())),
    };
    let width_rad = within("width_deg", file.width_deg.unwrap_or(360.0), 0.1, 360.0)?.to_radians().min(TAU);
    let elevations_rad = elevations(&file.elevations_deg)?;
    if columns == 0 || columns.saturating_mul(elevations_rad.len()) > MOST_BEAMS {
        return Err(("columns".into(), format!("1 to {MOST_BEAMS} beams a sweep"), columns.to_string()));
    }
    let nearest_m = within("nearest_m", file.nearest_m, 0.01, 100.0)?;
    Ok(Scanner {
        name: name.to_owned(),
        elevations_rad,
        width_rad,
        columns,
        sweep_s,
        divergence_rad: within("divergence_mrad", file.divergence_mrad, 0.0, 100.0)? * 1e-3,
        nearest_m,
        farthest_m: within("farthest_m", file.farthest_m, nearest_m, 2000.0)?,
        reach_m: within("reach_m", file.reach_m, 1.0, 2000.0)?,
        noise_m: within("noise_m", file.noise_m, 0.0, 1.0)?,
        pulse_m: within("pulse_m", file.pulse_m, 0.0, 10.0)?,
        intensity_exponent: within("intensity_exponent", file.intensity_exponent.unwrap_or(1.0), 0.1, 10.0)?,
        told: choice.returns.unwrap_or(file.returns).into(),
    })
}

fn elevations(rings: &[Rings]) -> Result<Vec<f64>, Fault> {
    let mut degrees: Vec<f64> = Vec::new();
    for rings in rings {
        match *rings {
            Rings::One(elevation) => degrees.push(elevation),
            Rings::Even { from, to, count } => {
                let step = (to - from) / count.saturating_sub(1).max(1) as f64;
                degrees.extend((0..count.min(MOST_RINGS + 1)).map(|i| from + step * i as f64));
            }
        }
    }
    let fits = degrees.iter().all(|degrees| degrees.abs() < 90.0);
    if !(1..=MOST_RINGS).contains(&degrees.len()) || !fits {
        let found = format!("{} of them", degrees.len());
        return Err(("elevations_deg".into(), format!("1 to {MOST_RINGS} between -90 and 90"), found));
    }
    Ok(degrees.into_iter().map(f64::to_radians).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_presets_are_as_their_makers_say() {
        let beams = |name: &str| preset(name, &ScannerChoice::default()).unwrap().beams();
        // Millions of beams a second.
        let rate: Vec<(&str, f64)> = presets()
            .map(|name| {
                let sweep_s = preset(name, &ScannerChoice::default()).unwrap().sweep_s;
                (name, (beams(name) as f64 / sweep_s / 1e4).round() / 100.0)
            })
            .collect();
        let expect = [
            ("hdl-32e", 0.69),
            ("hdl-64e", 1.33),
            ("os1-128", 2.62),
            ("rs-m1", 0.75),
            ("vlp-16", 0.29),
            ("vlp-32c", 0.58),
            ("vls-128", 2.4),
        ];
        assert_eq!(rate, expect);
        let hdl = preset("hdl-32e", &ScannerChoice::default()).unwrap();
        assert!((hdl.elevations_rad[0].to_degrees() + 30.67).abs() < 1e-9);
        assert!((hdl.elevations_rad[23].to_degrees()).abs() < 0.01, "the reference beam is level");
        let vls = preset("vls-128", &ScannerChoice::default()).unwrap();
        assert_eq!(vls.elevations_rad.len(), 128);
        assert!(vls.elevations_rad.is_sorted());
        let vlp = preset("vlp-32c", &ScannerChoice::default()).unwrap();
        assert_eq!(vlp.elevations_rad.len(), 32);
        assert!(vlp.elevations_rad.is_sorted());
        // Its table has thirds of a degree about the horizon.
        let level = vlp.elevations_rad.iter().filter(|rad| rad.to_degrees().abs() < 1e-3).count();
        assert_eq!(level, 1);
        assert!(preset("hdl-32", &ScannerChoice::default()).is_none());
    }

    #[test]
    fn a_choice_replaces_the_rate_and_the_returns() {
        let choice = ScannerChoice { rate_hz: Some(10.0), returns: Some(Returns::Dual) };
        let hdl = preset("hdl-32e", &choice).unwrap();
        assert_eq!((hdl.columns, hdl.sweep_s, hdl.told), (2170, 0.1, ToldReturns::Dual));
        assert!(preset("hdl-32e", &ScannerChoice { rate_hz: Some(0.0), returns: None }).is_none());
    }

    #[test]
    fn what_makes_no_lidar_is_told_with_its_place() {
        let good = PRESETS[0].1;
        for (from, to, expect) in [
            ("rate_hz = 20", "rate_hz = -1", "rate_hz"),
            ("column_us = 46.08", "", "column_us"),
            ("nearest_m", "nearst_m", "nearst_m"),
            ("farthest_m = 100", "farthest_m = nan", "farthest_m"),
            ("count = 32", "count = 99999", "elevations_deg"),
            ("pulse_m = 0.8", "pulse_m = 0.8\nintensity_exponent = 0", "intensity_exponent"),
            ("column_us = 46.08", "columns = 99999999", "columns"),
        ] {
            assert!(good.contains(from), "{from}");
            let (place, _, found) = parse("a", &good.replace(from, to), &ScannerChoice::default()).unwrap_err();
            assert!(format!("{place} {found}").contains(expect), "{place} {found}");
        }
    }
}

//! Radars (TOML) → `Radar`s: the makers' own by name, and others from files of the same form.

mod bounds;
mod surfaces;

use std::path::Path;

use serde::Deserialize;
use trove_files::{LARGEST_TEXT, read_text};
use trove_model::{Radar, RadarDirection, RadarScan};

use crate::ReadError;
use crate::toml_fault;
use bounds::{Fault, within};
use surfaces::SurfacesFile;

/// Radars that need no file, by name.
const PRESETS: [(&str, &str); 1] = [("ars408", include_str!("presets/ars408.toml"))];
/// Metres a second.
const LIGHT_MPS: f64 = 299_792_458.0;
/// More than any radar tells in a cycle.
const MOST: usize = 10_000;
const MOST_SCANS: usize = 8;

/// A radar as its file has it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RadarFile {
    /// Whose numbers they are; for people.
    #[serde(rename = "source")]
    _source: Option<String>,
    frequency_ghz: f64,
    cycle_ms: f64,
    most: usize,
    false_alarms: f64,
    faintest_dbsm: f64,
    stands_mps: f64,
    approach_mps: f64,
    departure_mps: f64,
    scans: Vec<ScanRow>,
    #[serde(default)]
    surfaces: SurfacesFile,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScanRow {
    name: String,
    nearest_m: f64,
    farthest_m: f64,
    elevation_deg: f64,
    range_resolution_m: f64,
    azimuth_resolution_deg: f64,
    speed_resolution_mps: f64,
    range_error_m: f64,
    speed_error_mps: f64,
    directions: Vec<DirectionRow>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DirectionRow {
    azimuth_deg: f64,
    reach_m: f64,
    error_deg: f64,
}

/// Names of the radars that need no file, in alphabetical order.
pub fn presets() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|(name, _)| *name)
}

/// A radar that needs no file; `None` for a name that is no such one's.
pub fn preset(name: &str) -> Option<Radar> {
    let (_, text) = PRESETS.iter().find(|(preset, _)| *preset == name)?;
    parse(name, text).ok()
}

/// Reads a radar's file.
///
/// # Errors
/// A file that cannot be read, is not TOML, or whose numbers make no radar.
pub fn read(path: &Path) -> Result<Radar, ReadError> {
    let text = read_text(path, LARGEST_TEXT).map_err(|source| ReadError::io(path, source))?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    parse(&name, &text).map_err(|(place, expected, found)| ReadError::Format {
        path: path.to_owned(),
        place,
        expected,
        found,
        remedy: "see docs/radar.md".into(),
    })
}

fn parse(name: &str, text: &str) -> Result<Radar, Fault> {
    let file: RadarFile = toml::from_str(text).map_err(|error| {
        let found = format!("{}{}", error.message(), toml_fault::hint(error.message()));
        (toml_fault::place(text, &error), "a radar in TOML".to_owned(), found)
    })?;
    if !(1..=MOST).contains(&file.most) {
        return Err(("most".into(), format!("1 to {MOST}"), file.most.to_string()));
    }
    if !(1..=MOST_SCANS).contains(&file.scans.len()) {
        return Err(("scans".into(), format!("1 to {MOST_SCANS} of them"), file.scans.len().to_string()));
    }
    Ok(Radar {
        name: name.to_owned(),
        wavelength_m: LIGHT_MPS / (within("frequency_ghz", file.frequency_ghz, 1.0, 300.0)? * 1e9),
        cycle_s: within("cycle_ms", file.cycle_ms, 1.0, 1000.0)? * 1e-3,
        most: file.most,
        false_alarms: within("false_alarms", file.false_alarms, 0.0, 100.0)?,
        faintest_dbsm: within("faintest_dbsm", file.faintest_dbsm, -100.0, 100.0)?,
        stands_mps: within("stands_mps", file.stands_mps, 0.0, 10.0)?,
        approach_mps: within("approach_mps", file.approach_mps, 0.1, 1000.0)?,
        departure_mps: within("departure_mps", file.departure_mps, 0.1, 1000.0)?,
        scans: file.scans.into_iter().map(scan).collect::<Result<_, _>>()?,
        surfaces: file.surfaces.surfaces()?,
    })
}

fn scan(row: ScanRow) -> Result<RadarScan, Fault> {
    let key = |key: &str| format!("scans.{}.{key}", row.name);
    let within = |name: &str, value: f64, low: f64, high: f64| within(&key(name), value, low, high);
    let directions = &row.directions;
    let in_order = directions.windows(2).all(|pair| pair[0].azimuth_deg < pair[1].azimuth_deg);
    if directions.len() < 2 || !in_order || directions[0].azimuth_deg != 0.0 {
        let found = directions.iter().map(|direction| direction.azimuth_deg.to_string()).collect::<Vec<_>>().join(", ");
        return Err((key("directions"), "two or more from azimuth_deg = 0 outwards".into(), found));
    }
    let direction = |direction: &DirectionRow| -> Result<_, Fault> {
        Ok(RadarDirection {
            azimuth_rad: within("directions.azimuth_deg", direction.azimuth_deg, 0.0, 85.0)?.to_radians(),
            reach_m: within("directions.reach_m", direction.reach_m, 1.0, 2000.0)?,
            error_rad: within("directions.error_deg", direction.error_deg, 0.0, 45.0)?.to_radians(),
        })
    };
    let nearest_m = within("nearest_m", row.nearest_m, 0.01, 100.0)?;
    Ok(RadarScan {
        nearest_m,
        farthest_m: within("farthest_m", row.farthest_m, nearest_m, 2000.0)?,
        elevation_rad: within("elevation_deg", row.elevation_deg, 0.5, 90.0)?.to_radians(),
        range_resolution_m: within("range_resolution_m", row.range_resolution_m, 0.01, 100.0)?,
        azimuth_resolution_rad: within("azimuth_resolution_deg", row.azimuth_resolution_deg, 0.05, 45.0)?.to_radians(),
        speed_resolution_mps: within("speed_resolution_mps", row.speed_resolution_mps, 0.001, 100.0)?,
        range_error_m: within("range_error_m", row.range_error_m, 0.0, 10.0)?,
        speed_error_mps: within("speed_error_mps", row.speed_error_mps, 0.0, 10.0)?,
        directions: directions.iter().map(direction).collect::<Result<_, _>>()?,
        name: row.name,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Class;

    #[test]
    fn the_ars408_is_as_its_data_sheet_says() {
        let ars = preset("ars408").unwrap();
        assert!((ars.wavelength_m - 0.003_919).abs() < 1e-6 && (ars.cycle_s - 0.072).abs() < 1e-12 && ars.most == 250);
        let widths: Vec<f64> = ars.scans.iter().map(|scan| scan.half_width_rad().to_degrees().round()).collect();
        let ranges: Vec<f64> = ars.scans.iter().map(|scan| scan.farthest_m).collect();
        assert_eq!((widths, ranges), (vec![9.0, 60.0], vec![250.0, 100.0]));
        let surfaces = &ars.surfaces;
        assert!(surfaces.of(Class::Car, false, false).reflectance > 0.9);
        assert!(surfaces.of(Class::Car, false, true).passes > 0.5, "glass");
        assert!(surfaces.of(Class::Barrier, true, false).reflectance > 0.9, "a guard rail");
        assert!(surfaces.of(Class::Human, false, false).reflectance < 0.5);
        assert!(preset("ars").is_none());
    }

    #[test]
    fn a_file_may_have_surfaces_of_its_own() {
        let text = format!("{}\n[surfaces.kinds.metal]\nreflectance = 0.5\nspread = 0.2\n", PRESETS[0].1);
        let own = parse("own", &text).unwrap().surfaces;
        let built_in = preset("ars408").unwrap().surfaces;
        assert_eq!((own.metal.reflectance, own.metal.diffuse), (0.5, 0.0));
        assert_eq!(own.pane, built_in.pane);
        assert_eq!(own.of_class[usize::from(Class::Bus.id())], own.metal);
    }

    #[test]
    fn what_makes_no_radar_is_told_with_its_place() {
        let good = PRESETS[0].1;
        for (from, to, expect) in [
            ("cycle_ms = 72", "cycle_ms = 0", "cycle_ms"),
            ("most = 250", "most = 0", "most"),
            ("farthest_m = 250", "farthest_m = 0.1", "scans.far.farthest_m"),
            ("elevation_deg = 14", "elevation_dg = 14", "did you mean \"elevation_deg\""),
            ("azimuth_deg = 4,", "azimuth_deg = 12,", "scans.far.directions"),
            ("[[scans]]\nname = \"near\"", "[surfaces.classes]\ncar = \"tin\"\n[[scans]]\nname = \"near\"", "tin"),
            ("[[scans]]\nname = \"near\"", "[surfaces.classes]\ncat = \"metal\"\n[[scans]]\nname = \"near\"", "cat"),
        ] {
            assert!(good.contains(from), "{from}");
            let (place, expected, found) = parse("a", &good.replace(from, to)).unwrap_err();
            assert!(format!("{place} {expected} {found}").contains(expect), "{place} {expected} {found}");
        }
    }
}

//! CSV of positions: one line of names, then one a position; commas, semicolons or tabs.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use glam::{DQuat, DVec3};
use trove_model::{Outcome, Report};

use super::fix::{Fault, Fix, yaw_of_heading};
use super::times::time_ns;
use crate::geodesy::{Ecef, east_north_up_from_ecef};

/// Names of columns by what is in them.
static COLUMNS: LazyLock<BTreeMap<String, Vec<String>>> =
    LazyLock::new(|| toml::from_str(include_str!("columns.toml")).expect("a table of lists, which a test reads"));

/// Which column holds what.
#[derive(Clone, Copy, Debug)]
struct Columns {
    time: usize,
    place: Place,
    heading: Option<usize>,
}

#[derive(Clone, Copy, Debug)]
enum Place {
    Geographic { lat: usize, lon: usize, alt: Option<usize> },
    Ecef { xyz: [usize; 3], wxyz: Option<[usize; 4]> },
}

/// Whether a text's first line has the columns of positions.
pub(super) fn is_trace(text: &str) -> bool {
    let first = text.lines().next().unwrap_or_default();
    columns(first, separator(first)).is_ok()
}

/// The positions in a file's order; lines that are none are reported.
pub(super) fn fixes(text: &str, report: &Report) -> Result<Vec<Fix>, Fault> {
    let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let (_, first) = lines.next().unwrap_or((0, ""));
    let separator = separator(first);
    let columns = columns(first, separator)?;
    let ecef = Ecef::new().ok_or_else(|| Fault::new("the file", "WGS84's projections", "none"))?;
    let mut fixes = Vec::new();
    for (i, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        match fix(line, separator, &columns, &ecef) {
            Some(fix) => fixes.push(fix),
            None => {
                report.note(Outcome::Dropped, "GPS: line that is no position", format!("line {}: {line:.80}", i + 1))
            }
        }
    }
    Ok(fixes)
}

fn separator(first: &str) -> char {
    [',', ';', '\t'].into_iter().max_by_key(|&c| first.matches(c).count()).unwrap_or(',')
}

fn columns(first: &str, separator: char) -> Result<Columns, Fault> {
    let first = first.trim_start_matches('\u{feff}');
    let names: Vec<String> = first.split(separator).map(|name| unquoted(name).to_lowercase()).collect();
    let at = |what: &str| {
        let known = COLUMNS.get(what)?;
        names.iter().position(|name| known.contains(name))
    };
    let all = |what: &[&str]| what.iter().map(|what| at(what)).collect::<Option<Vec<usize>>>();
    let place = match (at("lat"), at("lon"), all(&["ecef_x", "ecef_y", "ecef_z"]).as_deref()) {
        (Some(lat), Some(lon), _) => Some(Place::Geographic { lat, lon, alt: at("alt") }),
        (_, _, Some(&[x, y, z])) => {
            let wxyz = all(&["qw", "qx", "qy", "qz"]).and_then(|q| q.try_into().ok());
            Some(Place::Ecef { xyz: [x, y, z], wxyz })
        }
        _ => None,
    };
    match (at("time"), place) {
        (Some(time), Some(place)) => Ok(Columns { time, place, heading: at("heading") }),
        _ => {
            let expected = "columns time, and lat and lon, or ecef_x_m, ecef_y_m and ecef_z_m";
            let found: String = first.chars().take(200).collect();
            Err(Fault::new("line 1", expected, &format!("'{found}'")))
        }
    }
}

fn unquoted(text: &str) -> &str {
    text.trim().trim_matches('"').trim()
}

fn fix(line: &str, separator: char, columns: &Columns, ecef: &Ecef) -> Option<Fix> {
    let values: Vec<&str> = line.split(separator).map(unquoted).collect();
    let number = |column: usize| values.get(column)?.parse::<f64>().ok().filter(|v| v.is_finite());
    let time_ns = time_ns(values.get(columns.time)?)?;
    let heading = columns.heading.and_then(number).map(yaw_of_heading);
    match columns.place {
        Place::Geographic { lat, lon, alt } => {
            let (lat_deg, lon_deg) = (number(lat)?, number(lon)?);
            Some(Fix { time_ns, lat_deg, lon_deg, alt_m: alt.and_then(number), yaw_rad: heading })
        }
        Place::Ecef { xyz: [x, y, z], wxyz } => {
            let (lat_deg, lon_deg, alt_m) = ecef.geo_from_ecef(DVec3::new(number(x)?, number(y)?, number(z)?))?;
            let yaw_rad = wxyz.and_then(|[w, x, y, z]| {
                let rotation = DQuat::from_xyzw(number(x)?, number(y)?, number(z)?, number(w)?);
                let device = (rotation.length() > 0.5).then(|| rotation.normalize())?;
                let ahead = east_north_up_from_ecef(lat_deg, lon_deg) * (device * DVec3::X);
                (ahead.truncate().length() > 0.1).then(|| ahead.y.atan2(ahead.x))
            });
            Some(Fix { time_ns, lat_deg, lon_deg, alt_m: Some(alt_m), yaw_rad: yaw_rad.or(heading) })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_by_their_names_in_any_order() {
        assert_eq!(COLUMNS.len(), 12);
        let text =
            "\u{feff}\"Longitude\";note;Time;LATITUDE;course\n8.5;x;2020-01-01T00:00:01Z;49.0;90\n8.6;;bad;49;0\n";
        let report = Report::default();
        let read = fixes(text, &report).unwrap();
        let expected =
            Fix { time_ns: 1_577_836_801_000_000_000, lat_deg: 49.0, lon_deg: 8.5, alt_m: None, yaw_rad: Some(0.0) };
        assert_eq!(read, [expected]);
        assert_eq!(report.entries()[0].examples, ["line 3: 8.6;;bad;49;0"]);
        assert!(is_trace("t,lat,lon") && !is_trace("t,lat") && !is_trace(""));
        assert!(fixes("a,b\n", &report).unwrap_err().expected.contains("ecef_x_m"));
    }

    #[test]
    fn ecef_comes_with_the_heading_of_its_quaternion() {
        // On the equator at the meridian x is up, y east and z north; the device's x axis points north (z).
        let half = 0.5f64.sqrt();
        let text = format!("time_s,ecef_x_m,ecef_y_m,ecef_z_m,qw,qx,qy,qz\n1.5,6378147,0,0,{half},0,{},0\n", -half);
        let fix = fixes(&text, &Report::default()).unwrap()[0];
        assert!(fix.lat_deg.abs() < 1e-9 && fix.lon_deg.abs() < 1e-9 && (fix.alt_m.unwrap() - 10.0).abs() < 1e-3);
        assert!((fix.yaw_rad.unwrap() - std::f64::consts::FRAC_PI_2).abs() < 1e-9, "{fix:?}");
    }
}

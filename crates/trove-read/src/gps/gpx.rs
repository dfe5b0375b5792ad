//! GPX 1.0 and 1.1: the points of all tracks in their order.

use quick_xml::Reader;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use trove_model::{Outcome, Report};

use super::fix::{Fault, Fix, yaw_of_heading};
use super::times::time_ns;

/// Longer numbers and times are none, bytes.
const LONGEST_TEXT: usize = 100;

/// A point that is being read.
#[derive(Default)]
struct Point {
    lat_deg: Option<f64>,
    lon_deg: Option<f64>,
    alt_m: Option<f64>,
    time_ns: Option<i64>,
    heading_deg: Option<f64>,
}

/// The positions in a file's order; points that are none are reported.
pub(super) fn fixes(text: &str, report: &Report) -> Result<Vec<Fix>, Fault> {
    let mut reader = Reader::from_str(text);
    let (mut fixes, mut point, mut words, mut depth) = (Vec::new(), None::<Point>, String::new(), 0usize);
    loop {
        let event = reader.read_event();
        let byte = reader.buffer_position();
        let fault = |found: &str| Fault::new(&format!("byte {byte}"), "GPX", found);
        match event.map_err(|error| fault(&error.to_string()))? {
            Event::Start(element) => {
                depth += 1;
                words.clear();
                if depth == 1 && element.local_name().as_ref() != "gpx" {
                    return Err(fault("another element at the root"));
                }
                if element.local_name().as_ref() == "trkpt" {
                    point = Some(start(&element).ok_or_else(|| fault("damaged attributes"))?);
                }
            }
            Event::Empty(element) if element.local_name().as_ref() == "trkpt" => {
                report.note(Outcome::Dropped, "GPS: track point without a time", format!("byte {byte}"));
            }
            Event::Text(text) => {
                let text = text.as_ref();
                if words.len() + text.len() <= LONGEST_TEXT {
                    words.push_str(text);
                }
            }
            Event::End(element) => {
                depth = depth.saturating_sub(1);
                let number = || words.trim().parse::<f64>().ok().filter(|v| v.is_finite());
                if let Some(open) = &mut point {
                    match element.local_name().as_ref() {
                        "ele" => open.alt_m = number(),
                        "time" => open.time_ns = time_ns(&words),
                        "course" | "heading" => open.heading_deg = number(),
                        "trkpt" => {
                            match finished(open) {
                                Some(fix) => fixes.push(fix),
                                None => {
                                    let what = "GPS: track point without a time or a place";
                                    report.note(Outcome::Dropped, what, format!("byte {byte}"));
                                }
                            }
                            point = None;
                        }
                        _ => {}
                    }
                }
                words.clear();
            }
            Event::Eof if depth > 0 => return Err(fault("the end of the file before </gpx>")),
            Event::Eof => return Ok(fixes),
            _ => {}
        }
    }
}

fn start(element: &BytesStart) -> Option<Point> {
    let mut point = Point::default();
    for attribute in element.attributes() {
        let attribute = attribute.ok()?;
        let value = attribute.normalized_value(XmlVersion::Implicit1_0).ok()?;
        let number = || value.trim().parse::<f64>().ok().filter(|v| v.is_finite());
        match attribute.key.local_name().as_ref() {
            "lat" => point.lat_deg = number(),
            "lon" => point.lon_deg = number(),
            _ => {}
        }
    }
    Some(point)
}

fn finished(point: &Point) -> Option<Fix> {
    let (lat_deg, lon_deg) = point.lat_deg.zip(point.lon_deg)?;
    let yaw_rad = point.heading_deg.map(yaw_of_heading);
    Some(Fix { time_ns: point.time_ns?, lat_deg, lon_deg, alt_m: point.alt_m, yaw_rad })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_points_of_every_segment_are_read() {
        let text = r#"<?xml version="1.0"?><gpx xmlns="http://www.topografix.com/GPX/1/1"><metadata><time>2020-01-01T00:00:00Z</time></metadata>
            <trk><trkseg><trkpt lat="49.5" lon="8.25"><ele>110.5</ele><time>1970-01-01T00:00:01Z</time></trkpt></trkseg>
            <trkseg><trkpt lat="49.6" lon="8.25"><time>1970-01-01T00:00:02Z</time><extensions><course>0</course></extensions></trkpt>
            <trkpt lat="49.7" lon="8.25"></trkpt><trkpt lat="49.7" lon="8.25"/></trkseg></trk></gpx>"#;
        let report = Report::default();
        let read = fixes(text, &report).unwrap();
        let first = Fix { time_ns: 1_000_000_000, lat_deg: 49.5, lon_deg: 8.25, alt_m: Some(110.5), yaw_rad: None };
        assert_eq!(read[0], first);
        assert_eq!((read.len(), read[1].alt_m), (2, None));
        assert!((read[1].yaw_rad.unwrap() - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        assert_eq!(report.entries().iter().map(|e| e.count).sum::<u64>(), 2);
    }

    #[test]
    fn what_is_no_gpx_is_an_error_with_its_place() {
        for (text, expect) in [("<osm></osm>", "root"), ("<gpx><trk>", "end of the file"), ("<gpx></trk>", "byte")] {
            let Fault { place, found, .. } = fixes(text, &Report::default()).unwrap_err();
            assert!(format!("{place}: {found}").contains(expect), "{place}: {found}");
        }
    }
}

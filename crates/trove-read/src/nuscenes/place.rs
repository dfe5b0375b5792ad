//! Where on earth a log's coordinates begin.

use glam::DVec2;
use trove_model::{MapProjection, Outcome, Report};

use super::records::LogRecord;
use super::relatives::Relative;

/// The projection of a log, and whether it is that of its coordinates: by its own `trove_origin` keys, else by the name of
/// its map; where neither is known, whereabouts it was, or 0° N, 0° E.
pub(super) fn projection(
    relative: &Relative,
    log: Option<&LogRecord>,
    anchor_m: DVec2,
    report: &Report,
) -> (MapProjection, bool) {
    let location = log.map_or("", |l| l.location.as_str());
    let own = log.and_then(|l| l.trove_origin_lat_deg.zip(l.trove_origin_lon_deg));
    let own = own.filter(|(lat, lon)| lat.abs() < 89.0 && lon.abs() <= 180.0).map(|(lat, lon)| (lat, lon, true));
    let known = relative.place(location).map(|place| (place.lat_deg, place.lon_deg, place.is_origin));
    let Some((lat_deg, lon_deg, is_origin)) = own.or(known) else {
        let example = if location.is_empty() { "a log without location" } else { location };
        report.note(Outcome::Warned, "place of unknown origin: no street map can be aligned with the drive", example);
        return (MapProjection::spherical(0.0, 0.0, anchor_m), false);
    };
    let anchor_m = if is_origin { anchor_m } else { DVec2::ZERO };
    (MapProjection::spherical(lat_deg, lon_deg, anchor_m), is_origin)
}

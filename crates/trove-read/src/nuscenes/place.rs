//! Where on earth a log's coordinates begin.

use glam::DVec2;
use trove_model::{MapProjection, Outcome, Report};

use super::records::LogRecord;

/// The south-west corners of the four maps (latitude, longitude), as the devkit's `export_poses.py` has them.
const ORIGINS: [(&str, f64, f64); 4] = [
    ("boston-seaport", 42.336849169438615, -71.05785369873047),
    ("singapore-onenorth", 1.2882100868743724, 103.78475189208984),
    ("singapore-hollandvillage", 1.2993652317780957, 103.78217697143555),
    ("singapore-queenstown", 1.2782562240223188, 103.76741409301758),
];

/// The projection of a log, by its own `trove_origin` keys, else by the name of its map; `None` where neither is known.
pub(super) fn projection(log: Option<&LogRecord>, anchor_m: DVec2, report: &Report) -> Option<MapProjection> {
    let place = log.map_or("", |l| l.location.as_str());
    let own = log.and_then(|l| l.trove_origin_lat_deg.zip(l.trove_origin_lon_deg));
    let own = own.filter(|(lat, lon)| lat.abs() < 89.0 && lon.abs() <= 180.0);
    let known = ORIGINS.iter().find(|(name, ..)| *name == place).map(|&(_, lat, lon)| (lat, lon));
    let origin = own.or(known);
    if origin.is_none() {
        let example = if place.is_empty() { "a log without location" } else { place };
        report.note(Outcome::Warned, "place of unknown origin: no street map can be aligned with the drive", example);
    }
    origin.map(|(lat_deg, lon_deg)| MapProjection::spherical(lat_deg, lon_deg, anchor_m))
}

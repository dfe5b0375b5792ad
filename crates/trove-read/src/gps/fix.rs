//! One position of a trace.

/// Where the receiver was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fix {
    /// Nanoseconds since 1970 UTC, or since whatever the file counts from.
    pub(super) time_ns: i64,
    pub(super) lat_deg: f64,
    pub(super) lon_deg: f64,
    /// Height, metres; `None` where the file has none.
    pub(super) alt_m: Option<f64>,
    /// Radians counter-clockwise from east; `None` where the file does not say.
    pub(super) yaw_rad: Option<f64>,
}

/// Why a file is no trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    pub(super) place: String,
    pub(super) expected: String,
    pub(super) found: String,
}

impl Fault {
    pub(super) fn new(place: &str, expected: &str, found: &str) -> Self {
        Self { place: place.to_owned(), expected: expected.to_owned(), found: found.to_owned() }
    }
}

/// Radians counter-clockwise from east of a compass heading, degrees clockwise from north.
pub(super) fn yaw_of_heading(heading_deg: f64) -> f64 {
    (90.0 - heading_deg).to_radians()
}

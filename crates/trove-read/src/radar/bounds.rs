//! Numbers of radars' files, and what is wrong with them.

/// The place, what was expected there, and what was found.
pub(super) type Fault = (String, String, String);

/// A number that has to lie between two others.
pub(super) fn within(key: &str, value: f64, low: f64, high: f64) -> Result<f64, Fault> {
    let fault = || (key.to_owned(), format!("{low} to {high}"), value.to_string());
    if value >= low && value <= high { Ok(value) } else { Err(fault()) }
}

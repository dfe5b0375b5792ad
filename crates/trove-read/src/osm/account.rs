//! What became of the ways and relations of a file.

use trove_model::{Outcome, Report};

/// What became of the ways or relations in the area.
#[derive(Debug, Default)]
pub(super) struct Account {
    pub(super) in_area: u32,
    used: u32,
    reported: u32,
}

impl Account {
    /// Counts a thing that was used, or reports why it was not.
    pub(super) fn add(&mut self, done: Result<(), String>, what: &str, id: i64, report: &Report) {
        match done {
            Ok(()) => self.used += 1,
            Err(reason) => {
                self.reported += 1;
                report.note(Outcome::Dropped, &format!("osm: {what} not used: {reason}"), format!("{what} {id}"));
            }
        }
    }

    pub(super) fn measure(&self, what: &str, report: &Report) {
        report.measure(&format!("osm.{what}s_in_area"), f64::from(self.in_area));
        report.measure(&format!("osm.{what}s_used"), f64::from(self.used));
        report.measure(&format!("osm.{what}s_accounted"), f64::from(self.used + self.reported));
    }
}

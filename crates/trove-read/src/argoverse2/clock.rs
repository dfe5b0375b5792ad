//! The time of a log, whose date the dataset hides.

use trove_model::{Outcome, Report};

/// Logs count from the beginning of GPS time, 6 January 1980, for a few hours: nothing was recorded before this, 1990.
const EARLIEST_NS: i64 = 631_152_000_000_000_000;
/// 15 June 2020, 00:00 UTC.
const SUMMER_DAY_NS: i64 = 1_592_179_200_000_000_000;
const HOUR_NS: f64 = 3.6e12;
/// Early in the afternoon by the sun: light from the south-west.
const SOLAR_HOUR: f64 = 14.0;

/// What is added to a log's times: nothing where they are a date's, else so much that its first moment falls on a summer's
/// afternoon, which is reported.
pub(super) fn shift_ns(first_ns: i64, lon_deg: f64, log: &str, report: &Report) -> i64 {
    if first_ns >= EARLIEST_NS {
        return 0;
    }
    let what = "date and hour of an Argoverse 2 log, which hides them: 15 June, two hours after noon by the sun";
    report.note(Outcome::Guessed, what, log);
    (SUMMER_DAY_NS + ((SOLAR_HOUR - lon_deg / 15.0) * HOUR_NS).round() as i64).saturating_sub(first_ns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hidden_date_becomes_an_afternoon_and_another_stays() {
        let report = Report::default();
        assert_eq!(shift_ns(1_600_000_000_000_000_000, -80.0, "log", &report), 0);
        assert!(report.entries().is_empty());
        let first_ns = 315_966_253_660_357_000;
        let moved_ns = first_ns + shift_ns(first_ns, -80.0, "log", &report);
        // 19:20 UTC is 14:00 by the sun at 80° west.
        let minute = moved_ns as f64 / 6e10 % (24.0 * 60.0);
        assert!((minute - (19.0 * 60.0 + 20.0)).abs() < 1e-3, "{minute}");
        assert_eq!(report.entries()[0].examples, ["log"]);
        assert!(shift_ns(i64::MIN, 500.0, "log", &report) > 0);
    }
}

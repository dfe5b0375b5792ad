//! `timestamps.txt`: a line a frame, `2011-09-26 13:04:32.351950336`, by the clock of the recording computer.

use std::path::Path;

use super::facts::FACTS;
use super::text;
use crate::{ClockTime, ReadError};

/// The time of each frame, nanoseconds since 1970 UTC; `None` where a line is none.
pub(super) fn read(path: &Path) -> Result<Vec<Option<i64>>, ReadError> {
    Ok(text::read(path)?.lines().map(time_ns).collect())
}

/// When the frame of a number was taken that has no time, nanoseconds since 1970 UTC.
pub(super) fn unknown_ns(frame: usize) -> i64 {
    let start_ns = time_ns(&FACTS.unknown_time).expect("a test reads it");
    start_ns.saturating_add((frame as f64 * FACTS.frame_s * 1e9) as i64)
}

/// Nanoseconds since 1970 UTC; `None` for what is no time of KITTI's decades.
fn time_ns(line: &str) -> Option<i64> {
    let time = ClockTime::parse(line).filter(|time| time.ahead_s.is_none())?;
    Some(time.utc_ns(FACTS.utc_offset_s)).filter(|ns| *ns >= 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_summer_time_in_karlsruhe() {
        assert_eq!(time_ns("2011-09-26 13:04:32.351950336"), Some(1_317_035_072_351_950_336));
        for line in ["", "2011-09-26", "13:04:32", "2011-13-26 13:04:32", "2011-09-26 13:04:32Z", "yesterday"] {
            assert_eq!(time_ns(line), None, "{line}");
        }
        assert_eq!(unknown_ns(10) - unknown_ns(0), 1_000_000_000);
    }
}

//! Times as devices write them.

use crate::ClockTime;

/// No trace is of a time after 2096, or so long before 1970: differences of times fit into 64 bits.
const LATEST_NS: u64 = 4_000_000_000_000_000_000;

/// Nanoseconds of a time that is RFC 3339, or a number: seconds, or by its size milli-, micro- or nanoseconds.
pub(super) fn time_ns(text: &str) -> Option<i64> {
    of_any_unit(text).filter(|ns| ns.unsigned_abs() <= LATEST_NS)
}

fn of_any_unit(text: &str) -> Option<i64> {
    let text = text.trim();
    if let Ok(number) = text.parse::<i64>()
        && number.unsigned_abs() >= 100_000_000_000
    {
        // A number of seconds this large would be after the year 5000.
        let per_unit = match number.unsigned_abs() {
            ..100_000_000_000_000 => 1_000_000,
            100_000_000_000_000..100_000_000_000_000_000 => 1000,
            _ => 1,
        };
        return number.checked_mul(per_unit);
    }
    if let Ok(seconds) = text.parse::<f64>() {
        return (seconds.abs() < 4e9).then(|| (seconds * 1e9).round() as i64);
    }
    Some(ClockTime::parse(text)?.utc_ns(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_a_date_or_a_number_in_any_unit() {
        let seconds = 1_533_137_160_i64;
        for text in [
            "2018-08-01T15:26:00Z",
            "2018-08-01T11:26:00-04:00",
            "2018-08-01 15:26:00",
            "1533137160",
            "1533137160.0",
            "1533137160000",
            "1533137160000000",
            "1533137160000000000",
        ] {
            assert_eq!(time_ns(text), Some(seconds * 1_000_000_000), "{text}");
        }
        assert_eq!(time_ns("46408.547498"), Some(46_408_547_498_000), "since the device was switched on");
        assert_eq!(time_ns("2018-08-01T15:26:00.250Z"), Some(seconds * 1_000_000_000 + 250_000_000));
        for text in [
            "",
            "noon",
            "NaN",
            "inf",
            "2018-08-01",
            "15:26:00",
            "9999-12-31T23:59:59Z",
            "1e300",
            "2199-01-01T00:00:00Z",
            "-9e9",
            "9223372036854775807",
        ] {
            assert_eq!(time_ns(text), None, "{text}");
        }
    }
}

//! Dates with a time of day as files and recipes have them: RFC 3339, with or without an offset.

use toml::value::{Datetime, Offset};

const DAY_S: i64 = 86_400;
const SECOND_NS: i64 = 1_000_000_000;

/// What a clock shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClockTime {
    /// Since its own 1970 began, nanoseconds.
    local_ns: i64,
    /// How far it is ahead of UTC, seconds; `None` where it does not say.
    pub ahead_s: Option<i64>,
}

impl ClockTime {
    /// Of a text such as `2018-08-01T15:26:00.25+08:00`; `None` for what has no date or time, and outside the years 1700
    /// to 2200: nanoseconds in 64 bits reach from 1678 to 2261.
    pub fn parse(text: &str) -> Option<Self> {
        let Datetime { date: Some(date), time: Some(time), offset } = text.trim().parse().ok()? else { return None };
        if !(1700..=2200).contains(&date.year) {
            return None;
        }
        let days = days_from_civil(i64::from(date.year), i64::from(date.month), i64::from(date.day));
        let of_day_s = i64::from(time.hour) * 3600 + i64::from(time.minute) * 60 + time.second.map_or(0, i64::from);
        Some(Self {
            local_ns: (days * DAY_S + of_day_s) * SECOND_NS + time.nanosecond.map_or(0, i64::from),
            ahead_s: offset.map(|offset| match offset {
                Offset::Z => 0,
                Offset::Custom { minutes } => i64::from(minutes) * 60,
            }),
        })
    }

    /// Since 1970 UTC, nanoseconds; a clock that does not say is so many seconds ahead.
    pub fn utc_ns(self, else_ahead_s: i64) -> i64 {
        self.local_ns - self.ahead_s.unwrap_or(else_ahead_s) * SECOND_NS
    }
}

/// Days since 1970-01-01 of a Gregorian date, with years that start in March so that the leap day comes last.
fn days_from_civil(year: i64, month: i64, day: i64) -> i64 {
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let leap_days = year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
    365 * year + leap_days + (153 * month + 2) / 5 + day - 1 - 719_468
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_read_with_its_offset() {
        for (text, seconds, ahead_s) in [
            ("1970-01-01T00:00:00Z", 0, Some(0)),
            ("2018-08-01T15:26:00Z", 1_533_137_160, Some(0)),
            ("2018-08-01T11:26:00-04:00", 1_533_137_160, Some(-14_400)),
            ("2018-08-01 17:26:00", 1_533_137_160, None),
            ("2000-02-29T23:59:59Z", 951_868_799, Some(0)),
            ("1900-03-01T00:00:00Z", -2_203_891_200, Some(0)),
        ] {
            let time = ClockTime::parse(text).unwrap();
            assert_eq!((time.utc_ns(7200), time.ahead_s), (seconds * SECOND_NS, ahead_s), "{text}");
        }
        assert_eq!(ClockTime::parse("1970-01-01T00:00:00.25Z").unwrap().utc_ns(0), 250_000_000);
        for text in
            ["noon", "2018-08-01", "15:26:00", "1600-01-01T00:00:00Z", "9999-12-31T23:59:59Z", "2018-13-01T00:00:00Z"]
        {
            assert_eq!(ClockTime::parse(text), None, "{text}");
        }
    }
}

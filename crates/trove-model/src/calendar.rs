//! Days of the Gregorian calendar.

/// Days since 1970-01-01 of a Gregorian date, with years that start in March so that the leap day comes last.
///
/// Months count from 1 to 12 and days from 1; years are any whose days fit into 64 bits.
pub fn days_from_civil(year: i64, month: i64, day: i64) -> i64 {
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let leap_days = year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
    365 * year + leap_days + (153 * month + 2) / 5 + day - 1 - 719_468
}

//! What people write as a tag's value: lengths, counts, directions, speeds, years.

/// A length in metres from a number with or without a unit: `12`, `12.5 m`, `12,5`, `40'`, `12'6"`, `40 ft`; `None` for
/// anything else, for what is not finite and for negative lengths.
pub(super) fn length_m(text: &str) -> Option<f64> {
    const FOOT_M: f64 = 0.3048;
    let text = text.split(';').next()?.trim().trim_start_matches(['~', '<', '>', '=']).trim();
    if let Some((feet, inches)) = text.split_once(['\'', '’', '′']) {
        let inches = inches.trim().trim_end_matches(['"', '”', '″', '\'']).trim();
        let inches = if inches.is_empty() { 0.0 } else { decimal(inches)? };
        return Some(decimal(feet)? * FOOT_M + inches * FOOT_M / 12.0);
    }
    let unit_at = text.find(|c: char| c.is_alphabetic() || c == '"').unwrap_or(text.len());
    let (number, unit) = text.split_at(unit_at);
    let unit_m = match unit.trim().to_ascii_lowercase().as_str() {
        "" | "m" | "meter" | "meters" | "metre" | "metres" => 1.0,
        "cm" => 0.01,
        "km" => 1000.0,
        "ft" | "foot" | "feet" => FOOT_M,
        "in" | "inch" | "inches" | "\"" => FOOT_M / 12.0,
        _ => return None,
    };
    Some(decimal(number)? * unit_m)
}

/// A number that is not negative, with a point or a comma before the decimals; of a list the first.
pub(super) fn decimal(text: &str) -> Option<f64> {
    let text = text.split(';').next()?.trim();
    let value: f64 = match text.split_once(',') {
        Some((whole, decimals)) => format!("{whole}.{decimals}").parse().ok()?,
        None => text.parse().ok()?,
    };
    (value.is_finite() && value >= 0.0).then_some(value)
}

/// A heading, radians counter-clockwise from east, from a compass bearing (`285`, `NNE`).
pub(super) fn heading_rad(text: &str) -> Option<f64> {
    const POINTS: [&str; 16] =
        ["N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE", "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW"];
    let text = text.split(';').next()?.trim().trim_end_matches('°').trim();
    let name = text.to_ascii_uppercase();
    let bearing_deg = match POINTS.iter().position(|&point| point == name) {
        Some(point) => point as f64 * 22.5,
        None => text.parse().ok().filter(|deg: &f64| deg.abs() <= 720.0)?,
    };
    Some((90.0 - bearing_deg).rem_euclid(360.0).to_radians())
}

/// A speed limit, km/h, from a number with or without a unit (`50`, `30 mph`) or a zone's name (`DE:urban`, `DE:zone30`);
/// the inner `None` where it is not limited to a number (`none`, `signals`), the outer for anything else.
pub(super) fn speed_kmh(text: &str) -> Option<Option<f64>> {
    const MILE_KM: f64 = 1.609344;
    const KNOT_KMH: f64 = 1.852;
    let text = text.split(';').next()?.trim();
    if matches!(text, "none" | "signals" | "variable" | "national" | "DE:motorway") {
        return Some(None);
    }
    let (country, zone) = text.split_once(':').unwrap_or(("", text));
    // The usual limits of countries; few differ by more than 10 km/h.
    let kmh = match zone {
        "walk" | "living_street" => 7.0,
        "bicycle_road" | "school" => 30.0,
        "urban" if country == "GB" => 30.0 * MILE_KM,
        "urban" => 50.0,
        "rural" if country == "DE" || country == "AT" => 100.0,
        "rural" => 90.0,
        "trunk" => 110.0,
        "motorway" => 130.0,
        "nsl_single" => 60.0 * MILE_KM,
        "nsl_dual" => 70.0 * MILE_KM,
        limit => {
            let limit = limit.trim_start_matches("zone").trim_start_matches(':');
            let (number, unit) = limit.split_at(limit.find(char::is_alphabetic).unwrap_or(limit.len()));
            let unit_kmh = match unit {
                "" if matches!(country, "GB" | "US") => MILE_KM,
                "" | "km/h" | "kmh" | "kph" => 1.0,
                "mph" => MILE_KM,
                "knots" => KNOT_KMH,
                _ => return None,
            };
            decimal(number)? * unit_kmh
        }
    };
    (1.0..=300.0).contains(&kmh).then_some(Some(kmh))
}

/// The year in a date however vague (`1968`, `2014-11-15`, `~1900`, `1890s`, `before 1950`; `C19` is its middle).
pub(super) fn year(text: &str) -> Option<i32> {
    let century = text.trim().strip_prefix('C').and_then(|n| n.get(..2)?.parse::<i32>().ok());
    let digits = |text: &str| text.len() == 4 && text.bytes().all(|b| b.is_ascii_digit());
    let mut numbers = text.split(|c: char| !c.is_ascii_digit()).filter(|number| digits(number));
    let year = numbers.next().and_then(|number| number.parse().ok()).or(century.map(|c| c * 100 - 50))?;
    (500..=2100).contains(&year).then_some(year)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_are_read_with_their_units_and_zones() {
        let check = |text: &str, expect: Option<Option<f64>>| {
            assert_eq!(speed_kmh(text).map(|kmh| kmh.map(f64::round)), expect, "{text}");
        };
        check("50", Some(Some(50.0)));
        check("30 mph", Some(Some(48.0)));
        check("25mph", Some(Some(40.0)));
        check("5 knots", Some(Some(9.0)));
        check("DE:urban", Some(Some(50.0)));
        check("DE:zone30", Some(Some(30.0)));
        check("FR:zone:20", Some(Some(20.0)));
        check("GB:zone20", Some(Some(32.0)));
        check("none", Some(None));
        check("signals", Some(None));
        for text in ["", "fast", "-3", "1e9", "50 m", "DE:", ":", "RO:x", "NaN"] {
            check(text, None);
        }
    }

    #[test]
    fn dates_have_their_year() {
        let check = |text: &str, expect| assert_eq!(year(text), expect, "{text}");
        check("1968", Some(1968));
        check("2014-11-15", Some(2014));
        check("~1900", Some(1900));
        check("1890s", Some(1890));
        check("before 1950", Some(1950));
        check("1930..1935", Some(1930));
        check("C19", Some(1850));
        for text in ["", "C", "old", "19", "99999", "0000", "C1é"] {
            check(text, None);
        }
    }

    #[test]
    fn lengths_are_read_as_people_write_them() {
        let check = |text: &str, expect: Option<f64>| {
            let found = length_m(text);
            let near = matches!((found, expect), (Some(a), Some(b)) if (a - b).abs() < 1e-6);
            assert!(near || found == expect, "{text}: {found:?}, expected {expect:?}");
        };
        check("12", Some(12.0));
        check(" 12.5 ", Some(12.5));
        check("12 m", Some(12.0));
        check("180m", Some(180.0));
        check("12,5", Some(12.5));
        check("12,5 m", Some(12.5));
        check("~7", Some(7.0));
        check("40'", Some(12.192));
        check("12'6\"", Some(3.81));
        check("40 ft", Some(12.192));
        check("39 feet", Some(11.8872));
        check("300 cm", Some(3.0));
        check("5;6", Some(5.0));
        for text in ["", "m", "high", "-3", "NaN", "inf", "1e999", "12 storeys", "1,2,3", "'", "5-6"] {
            check(text, None);
        }
    }

    #[test]
    fn north_is_a_quarter_turn_from_east() {
        let degrees = |text: &str| heading_rad(text).map(|rad| rad.to_degrees().round());
        assert_eq!(degrees("N"), Some(90.0));
        assert_eq!(degrees("90"), Some(0.0));
        assert_eq!(degrees("ssw"), Some(248.0));
        assert_eq!(degrees("285°"), Some(165.0));
        assert_eq!(degrees("forward"), None);
        assert_eq!(degrees("NaN"), None);
    }
}

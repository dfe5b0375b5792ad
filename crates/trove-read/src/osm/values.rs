//! What people write as a tag's value: lengths, counts, directions.

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

#[cfg(test)]
mod tests {
    use super::*;

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

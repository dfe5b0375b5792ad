//! What a traffic sign says: `traffic_sign` in words or in a country's numbers.

use trove_model::MappedSign;

use super::tagged::Tagged;
use super::values::speed_kmh;
use super::vocabulary::{AMERICAN_SIGNS, GERMAN_SIGNS, SIGNS, Said};

/// What a sign says; of several on a post the first that is known. `None` where nothing is tagged.
pub(super) fn sign(tagged: &Tagged) -> Option<MappedSign> {
    let text = tagged.tags.get("traffic_sign");
    let mut on_post = text.split([',', ';']).map(|code| read(code, tagged.tags.get("maxspeed")));
    if on_post.clone().all(|said| said == Said::Nothing) {
        return None;
    }
    let known = on_post.find_map(|said| match said {
        Said::Meaning(sign) => Some(sign),
        Said::Nothing | Said::Unknown => None,
    });
    if known.is_none() {
        tagged.refuse("unknown traffic_sign", text);
    }
    Some(known.unwrap_or(MappedSign::Other))
}

/// What a single sign says: `give_way`, `DE:205`, `US:R2-1[35]`; a limit without a number is the road's `maxspeed`.
fn read(code: &str, maxspeed: &str) -> Said<MappedSign> {
    let code = code.trim();
    let (code, number) = code.strip_suffix(']').and_then(|code| code.split_once('[')).unwrap_or((code, maxspeed));
    let (country, name) = code.split_once(':').unwrap_or(("", code));
    let name = name.trim().to_lowercase();
    let limit = |text: &str| match speed_kmh(text).flatten() {
        Some(limit_kmh) => Said::Meaning(MappedSign::SpeedLimit { limit_kmh }),
        None => Said::Unknown,
    };
    match country {
        "US" if name == "r2-1" && number.parse::<u16>().is_ok() => limit(&format!("{number} mph")),
        "US" if name == "r2-1" => limit(number),
        "US" => AMERICAN_SIGNS.read(&name),
        // Numbers without a country are Germany's, where people leave it out.
        "" if name == "maxspeed" => limit(number),
        "" if !name.starts_with(|c: char| c.is_ascii_digit()) => SIGNS.read(&name),
        "" | "DE" => {
            // A variant (`101-10`, `274-30`) says what its sign says.
            let (sign, variant) = name.split_once('-').unwrap_or((&name, number));
            if matches!(sign, "274" | "274.1") { limit(variant) } else { GERMAN_SIGNS.read(sign) }
        }
        _ => Said::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_are_read_in_words_and_in_the_numbers_of_their_country() {
        let check = |code: &str, expect| assert_eq!(read(code, "50"), expect, "{code}");
        let limit = |limit_kmh| Said::Meaning(MappedSign::SpeedLimit { limit_kmh });
        check("stop", Said::Meaning(MappedSign::Stop));
        check("DE:205", Said::Meaning(MappedSign::GiveWay));
        check("206", Said::Meaning(MappedSign::Stop));
        check("DE:283-10", Said::Meaning(MappedSign::NoStopping));
        check("DE:274[30]", limit(30.0));
        check("DE:274-70", limit(70.0));
        check("DE:274.1", limit(50.0));
        check("maxspeed", limit(50.0));
        check("US:R1-1", Said::Meaning(MappedSign::Stop));
        check("US:R2-1[25]", limit(25.0 * 1.609_344));
        // Not Germany's number.
        check("AT:206", Said::Unknown);
        for code in ["yes", "", "DE:", ":", "DE:-"] {
            check(code, Said::Nothing);
        }
        for code in ["DE:298", "[", "]", "maxspeed[]", "274[", "US:R2-1[é]", "-"] {
            check(code, Said::Unknown);
        }
    }
}

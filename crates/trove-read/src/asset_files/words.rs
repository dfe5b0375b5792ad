//! Names of files, nodes and materials → words.

/// The words of a name in small letters: `realistic_CopSUV-2` → realistic, cop, suv. Numbers are left out.
pub(super) fn words(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let mut words = vec![String::new()];
    for (i, &c) in letters.iter().enumerate() {
        let before = i.checked_sub(1).map(|j| letters[j]);
        let after = letters.get(i + 1);
        let inner = before.is_some_and(|b| b.is_lowercase())
            || (before.is_some_and(char::is_uppercase) && after.is_some_and(|a| a.is_lowercase()));
        if !c.is_alphabetic() || (c.is_uppercase() && inner) {
            words.push(String::new());
        }
        if c.is_alphabetic() {
            words.last_mut().expect("there is always one").extend(c.to_lowercase());
        }
    }
    words.retain(|w| !w.is_empty());
    words
}

/// How well a phrase of one to three words is among the words, by its letters: all of it as whole words, or, for long
/// ones, as the beginning or the end of a word. 0: it is not there.
pub(super) fn match_of(words: &[String], phrase: &str) -> usize {
    let phrase: String = phrase.split(' ').collect();
    let letters = phrase.chars().count();
    for from in 0..words.len() {
        let mut joined = String::new();
        for word in words.iter().skip(from).take(3) {
            joined.push_str(word);
            let plural = joined.strip_suffix('s').filter(|_| letters > 2);
            if joined == phrase || plural == Some(&phrase) {
                // Chinese words are short and say much.
                return if phrase.is_ascii() { 2 * letters } else { 6 * letters };
            }
        }
    }
    let part = |w: &String| letters >= 5 && (w.starts_with(&phrase) || w.ends_with(&phrase));
    let inside = !phrase.is_ascii() && words.iter().any(|w| w.contains(&phrase));
    if words.iter().any(part) || inside { letters } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_many_styles_fall_into_words() {
        for (name, expected) in [
            ("realistic_CopSUV-2", "realistic cop suv"),
            ("SM_Veh_Car_01", "sm veh car"),
            ("SimpleCarHigh", "simple car high"),
            ("prius_hybrid__Hybrid", "prius hybrid hybrid"),
            ("Straßenlaterne 3", "straßenlaterne"),
        ] {
            assert_eq!(words(name).join(" "), expected, "{name}");
        }
    }

    #[test]
    fn phrases_are_found_joined_apart_and_in_the_plural() {
        for name in ["StreetLight", "streetlight_2", "street lights", "old-street-light"] {
            assert!(match_of(&words(name), "street light") > 10, "{name}");
        }
        assert_eq!(match_of(&words("businessman"), "bus"), 0);
        assert!(match_of(&words("hatchbackblue"), "hatchback") > 0);
    }
}

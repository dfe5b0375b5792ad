//! What is wrong with a file of plans.

/// A mistake in a file of plans: where it is, what was expected, what was found and what to do. Whoever read the file
/// adds its path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{place}: expected {expected}, found {found}{remedy}")]
pub struct PlanError {
    /// The entry and the key (`car "kombi": profile.length_m`), or the line.
    pub place: String,
    /// What belongs there.
    pub expected: String,
    /// What is there.
    pub found: String,
    /// What to do, with the mark that parts it from the rest; empty where it is plain.
    pub remedy: String,
}

impl PlanError {
    pub(super) fn new(place: impl Into<String>, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self { place: place.into(), expected: expected.into(), found: found.into(), remedy: String::new() }
    }

    pub(super) fn do_this(self, remedy: impl AsRef<str>) -> Self {
        Self { remedy: format!("; {}", remedy.as_ref()), ..self }
    }

    /// Names the one of `known` that is nearest to what was found.
    pub(super) fn or_near<'a>(self, unknown: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        let nearest = known.into_iter().min_by_key(|name| strsim::damerau_levenshtein(unknown, name));
        match nearest {
            Some(name) => self.do_this(format!("did you mean `{name}`?")),
            None => self,
        }
    }

    /// From what the parser of TOML says of an entry, whose own words name the key last.
    pub(super) fn of_entry(place: &str, error: &toml::de::Error) -> Self {
        let whole = error.to_string();
        let keys = whole.rsplit_once("in `").and_then(|(_, keys)| keys.split_once('`')).map(|(keys, _)| keys);
        let message = error.message().lines().next().unwrap_or_default();
        let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
        let at = |key: Option<&str>| {
            let path: Vec<&str> = keys.into_iter().chain(key).collect();
            if path.is_empty() { place.to_owned() } else { format!("{place}: {}", path.join(".")) }
        };
        let first = quoted.first().copied().unwrap_or_default();
        let known = quoted.iter().skip(1).copied();
        if message.starts_with("unknown field") {
            Self::new(at(Some(first)), "a known key", "one that is not").or_near(first, known)
        } else if message.starts_with("unknown variant") {
            let names = quoted[1..].join(", ");
            Self::new(at(None), format!("one of {names}"), format!("`{first}`")).or_near(first, known)
        } else if message.starts_with("missing field") {
            Self::new(at(Some(first)), "a value", "none").do_this("write it, or take it from another with `like`")
        } else if let Some((found, expected)) = message.split_once(", expected ") {
            let found = found.trim_start_matches("invalid type: ").trim_start_matches("invalid value: ");
            Self::new(at(None), expected, found)
        } else {
            Self::new(at(None), "another value", message)
        }
    }
}

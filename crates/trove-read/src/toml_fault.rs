//! Where a file that people write in TOML is wrong, and what may be meant.

/// The line of the parser's error (`line 12`), from 1.
pub(crate) fn place(text: &str, error: &toml::de::Error) -> String {
    let before = error.span().and_then(|span| text.get(..span.start)).unwrap_or_default();
    format!("line {}", 1 + before.matches('\n').count())
}

/// Behind the parser's message about a word that it does not know, the nearest of those that it does.
pub(crate) fn hint(message: &str) -> String {
    let mut names = message.split('`').skip(1).step_by(2);
    match names.next() {
        Some(unknown) if message.starts_with("unknown") => nearest(unknown, names),
        _ => String::new(),
    }
}

/// `; did you mean …?` with the nearest of some names.
pub(crate) fn nearest<'n>(wrong: &str, names: impl Iterator<Item = &'n str>) -> String {
    let nearest = names.min_by_key(|name| strsim::damerau_levenshtein(wrong, name));
    nearest.map(|name| format!("; did you mean {name:?}?")).unwrap_or_default()
}

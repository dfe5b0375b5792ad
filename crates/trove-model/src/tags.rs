//! Words that say what a model or a surface is.

/// A sorted set of unique, non-empty lower-case words (`brick`, `speed-30`).
///
/// The builder asks for what it needs by kind, tags and size; an id only names a thing, and nothing is read into it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tags(Vec<String>);

impl Tags {
    /// These words in lower case, trimmed, sorted and each once; empty ones are left out.
    pub fn new<W: AsRef<str>>(words: impl IntoIterator<Item = W>) -> Self {
        let mut words: Vec<String> = words.into_iter().map(|w| w.as_ref().trim().to_lowercase()).collect();
        words.retain(|w| !w.is_empty());
        words.sort_unstable();
        words.dedup();
        Self(words)
    }

    /// Whether the word, in lower case, is among them.
    pub fn has(&self, word: &str) -> bool {
        self.0.binary_search_by(|w| w.as_str().cmp(word)).is_ok()
    }

    /// Whether all of the words are among them; true for no words.
    pub fn has_all<W: AsRef<str>>(&self, words: &[W]) -> bool {
        words.iter().all(|w| self.has(w.as_ref()))
    }

    /// Whether one of the words is among them; false for no words.
    pub fn has_any<W: AsRef<str>>(&self, words: &[W]) -> bool {
        words.iter().any(|w| self.has(w.as_ref()))
    }

    /// The words in alphabetical order.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(String::as_str)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::Tags;

    #[test]
    fn words_are_a_sorted_set_in_lower_case() {
        let tags = Tags::new(["Red", " brick", "", "red", "speed-30"]);
        assert_eq!(tags.iter().collect::<Vec<_>>(), ["brick", "red", "speed-30"]);
        assert_eq!(tags, Tags::new(["speed-30", "brick", "red"]));
    }

    #[test]
    fn only_whole_words_are_had() {
        let tags = Tags::new(["brick-row", "speed-30"]);
        for (word, had) in [("brick-row", true), ("speed-30", true), ("brick", false), ("speed-3", false), ("", false)]
        {
            assert_eq!(tags.has(word), had, "{word}");
        }
        assert!(tags.has_all(&["speed-30", "brick-row"]) && !tags.has_all(&["speed-30", "brick"]));
        assert!(tags.has_any(&["speed-30", "brick"]) && !tags.has_any::<&str>(&[]) && tags.has_all::<&str>(&[]));
    }
}

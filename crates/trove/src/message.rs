//! An error as one line.

/// What went wrong and why, each cause once: some errors of the stages name their cause in their own text.
pub(crate) fn of(error: &anyhow::Error) -> String {
    let text =
        error.chain().skip(1).map(ToString::to_string).fold(error.to_string(), |text, cause| {
            if text.contains(&cause) { text } else { format!("{text}: {cause}") }
        });
    shown(&text)
}

/// Text from files as a terminal may have it: control characters but line breaks and tabs are escaped.
pub(crate) fn shown(text: &str) -> String {
    let plain = |c: char| !c.is_control() || matches!(c, '\n' | '\t');
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if plain(c) { shown.push(c) } else { shown.extend(c.escape_unicode()) }
    }
    shown
}

#[cfg(test)]
mod tests {
    use anyhow::anyhow;

    #[test]
    fn names_do_not_command_the_terminal() {
        let error = anyhow!("no scene \u{1b}]0;x\u{7}").context("a\u{9b}2J\nb");
        assert_eq!(super::of(&error), "a\\u{9b}2J\nb: no scene \\u{1b}]0;x\\u{7}");
    }

    #[test]
    fn a_cause_that_was_named_is_not_named_again() {
        let error = anyhow!("disk full").context("a.png: cannot be written (disk full)").context("frame 3");
        assert_eq!(super::of(&error), "frame 3: a.png: cannot be written (disk full)");
    }
}

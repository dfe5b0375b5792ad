//! An error as one line.

/// What went wrong and why, each cause once: some errors of the stages name their cause in their own text.
pub(crate) fn of(error: &anyhow::Error) -> String {
    error
        .chain()
        .skip(1)
        .map(ToString::to_string)
        .fold(error.to_string(), |text, cause| if text.contains(&cause) { text } else { format!("{text}: {cause}") })
}

#[cfg(test)]
mod tests {
    use anyhow::anyhow;

    #[test]
    fn a_cause_that_was_named_is_not_named_again() {
        let error = anyhow!("disk full").context("a.png: cannot be written (disk full)").context("frame 3");
        assert_eq!(super::of(&error), "frame 3: a.png: cannot be written (disk full)");
    }
}

//! `trove curate`, `trove recolor`, `trove evaluate`: verdicts on datasets, printed and written.

pub(crate) mod curate;
pub(crate) mod evaluate;
pub(crate) mod recolor;

use trove_judge::LabelSet;

fn label_set(name: &str) -> Result<LabelSet, String> {
    LabelSet::named(name).ok_or_else(|| format!("expected one of {}", LabelSet::NAMES.join(", ")))
}

/// A share of 1.
fn share(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|share| (0.0..=1.0).contains(share)).ok_or("expected a number from 0 to 1".into())
}

//! `trove curate`, `trove recolor`, `trove evaluate`, `trove verify --labels`: verdicts on datasets, printed and written.

pub(crate) mod audit;
pub(crate) mod curate;
pub(crate) mod evaluate;
pub(crate) mod recolor;
mod weights;

/// A share of 1.
fn share(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|share| (0.0..=1.0).contains(share)).ok_or("expected a number from 0 to 1".into())
}

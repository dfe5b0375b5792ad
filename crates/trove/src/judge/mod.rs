//! `trove curate`, `trove recolor`, `trove evaluate`: verdicts on datasets, printed and written.

pub(crate) mod curate;
pub(crate) mod evaluate;
pub(crate) mod recolor;

use std::sync::OnceLock;

use trove_judge::LabelSet;

use crate::progress::Progress;

/// How far the reading of pictures is; made with the first of them.
#[derive(Default)]
struct Pictures(OnceLock<Progress>);

impl Pictures {
    /// One more picture is done, of `total`.
    fn done(&self, done: usize, total: usize) {
        let progress = self.0.get_or_init(|| Progress::new(total));
        progress.frame_done();
        if done == total { progress.finish() } else { progress.within(0.0) }
    }
}

fn label_set(name: &str) -> Result<LabelSet, String> {
    LabelSet::named(name).ok_or_else(|| format!("expected one of {}", LabelSet::NAMES.join(", ")))
}

/// A share of 1.
fn share(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|share| (0.0..=1.0).contains(share)).ok_or("expected a number from 0 to 1".into())
}

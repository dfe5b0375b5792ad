//! `trove curate`, `trove recolor`, `trove evaluate`: verdicts on datasets, printed and written.

pub(crate) mod curate;
pub(crate) mod evaluate;
pub(crate) mod recolor;

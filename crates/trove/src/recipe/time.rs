//! `[time]`: moments between keyframes.

use anyhow::{Result, ensure};
use serde::{Deserialize, Serialize};

use super::check::check;

/// `[time]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct TimeSection {
    /// Moments a second, keyframes among them; 0: the keyframes alone.
    #[serde(default)]
    pub rate_hz: f64,
}

impl TimeSection {
    pub(super) fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// One in `every` keyframes is asked for, 1 where they are listed; `None` for a place that nobody drove through.
    pub(super) fn check(&self, every: Option<usize>) -> Result<()> {
        let Self { rate_hz } = *self;
        let expected = "0 (the keyframes alone) to 1000 moments a second, such as 10";
        check("time.rate_hz", rate_hz, (0.0..=1000.0).contains(&rate_hz), expected)?;
        if rate_hz > 0.0 {
            ensure!(
                every.is_some(),
                "time.rate_hz: expected 0 for a [place], whose views do not follow one another, found {rate_hz}; remove it"
            );
            let every = every.unwrap_or(1);
            ensure!(
                every <= 1,
                "time.rate_hz: expected drive.keyframes = \"all\" or a list with neighbours, such as [4, 5, 6], found \
                 {{ every = {every} }}, which leaves no two neighbours to be between; change it or remove time.rate_hz"
            );
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_a_number_of_moments_between_neighbouring_keyframes() {
        let told = |rate_hz: f64, every: Option<usize>| {
            TimeSection { rate_hz }.check(every).map_err(|error| error.to_string()).err().unwrap_or_default()
        };
        for rate_hz in [0.0, 0.5, 10.0, 1000.0] {
            assert_eq!(told(rate_hz, Some(1)), "");
        }
        for rate_hz in [-1.0, 1000.5, f64::NAN, f64::INFINITY] {
            let error = told(rate_hz, Some(1));
            assert!(error.starts_with("time.rate_hz: expected 0") && error.contains(&rate_hz.to_string()), "{error}");
        }
        assert_eq!(told(0.0, Some(5)), "");
        assert!(told(10.0, Some(5)).contains("{ every = 5 }"));
        assert_eq!(told(0.0, None), "");
        assert!(told(10.0, None).contains("[place]"));
    }
}

//! Draws from the Poisson distribution.

use trove_model::Random;

/// Mean count from which on it is drawn from a normal distribution, which is near enough then.
const MANY: f64 = 40.0;

/// A draw from the Poisson distribution.
pub(crate) fn poisson(mean: f64, random: &mut Random) -> f64 {
    if mean >= MANY {
        return (mean + mean.sqrt() * random.normal()).round().max(0.0);
    }
    // Inversion: the chances of 0, 1, 2 … are gone through until the drawn number is used up.
    let (mut left, mut chance, mut count) = (random.unit(), (-mean).exp(), 0.0);
    while left >= chance && count < 10.0 * MANY {
        left -= chance;
        count += 1.0;
        chance *= mean / count;
    }
    count
}

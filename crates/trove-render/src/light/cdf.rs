//! Drawing from a list of weights.

/// Cumulative shares of a list of weights; what it draws and what it says of a probability come from the same numbers.
///
/// Numbers next to each other are drawn from numbers next to each other, so even samples stay even.
pub(super) struct Cdf {
    /// `cumulative[i]` is the share of all weights before the `i`-th; one longer than the list, from 0 to 1.
    cumulative: Vec<f32>,
    /// Where the search for a number starts, by the number's place in [0, 1): a step or two before its entry.
    guide: Vec<u32>,
}

impl Cdf {
    /// From at least one weight, none of them negative; where none is positive all are drawn alike.
    pub(super) fn new(weights: &[f64]) -> Self {
        assert!(!weights.is_empty(), "nothing to draw from");
        let total: f64 = weights.iter().sum();
        let even = total <= 0.0;
        let mut sum = 0.0;
        let mut cumulative = Vec::with_capacity(weights.len() + 1);
        cumulative.push(0.0);
        for (i, &w) in weights.iter().enumerate() {
            sum += w;
            let share = if even { (i + 1) as f64 / weights.len() as f64 } else { sum / total };
            cumulative.push(share as f32);
        }
        let n = weights.len();
        let start = |k: usize| cumulative.partition_point(|&c| c <= k as f32 / n as f32).clamp(1, n) as u32 - 1;
        let guide = (0..n).map(start).collect();
        Self { cumulative, guide }
    }

    /// Which one `u` in [0, 1) falls on, and where in it, again in [0, 1).
    pub(super) fn draw(&self, u: f32) -> (usize, f32) {
        let n = self.guide.len();
        let mut i = self.guide[((u * n as f32) as usize).min(n - 1)] as usize;
        // The product above may be rounded up to the next place.
        while i > 0 && self.cumulative[i] > u {
            i -= 1;
        }
        while i + 1 < n && self.cumulative[i + 1] <= u {
            i += 1;
        }
        let width = self.probability(i);
        let rest = if width > 0.0 { (u - self.cumulative[i]) / width } else { 0.0 };
        (i, rest.clamp(0.0, 1.0 - f32::EPSILON))
    }

    /// Probability of the `i`-th.
    pub(super) fn probability(&self, i: usize) -> f32 {
        self.cumulative[i + 1] - self.cumulative[i]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_entry_is_drawn_as_often_as_it_weighs() {
        let weights = [0.0, 3.0, 1.0, 0.0, 4.0, 0.0];
        let cdf = Cdf::new(&weights);
        let mut drawn = [0; 6];
        for k in 0..8000 {
            let (i, rest) = cdf.draw((k as f32 + 0.5) / 8000.0);
            assert!((0.0..1.0).contains(&rest));
            drawn[i] += 1;
        }
        assert_eq!(drawn, [0, 3000, 1000, 0, 4000, 0]);
        assert!(weights.iter().enumerate().all(|(i, w)| (f64::from(cdf.probability(i)) - w / 8.0).abs() < 1e-6));
        assert!(cdf.probability(cdf.draw(1.0 - f32::EPSILON / 2.0).0) > 0.0);
    }

    #[test]
    fn darkness_is_drawn_evenly() {
        let cdf = Cdf::new(&[0.0; 4]);
        assert_eq!((cdf.draw(0.6).0, cdf.probability(3)), (2, 0.25));
    }
}

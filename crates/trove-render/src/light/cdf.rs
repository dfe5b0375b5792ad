//! Lists of weights to draw from, made ready.

#[cfg(test)]
use trove_trace::light::Cdf;

/// Lists of weights, one after the other.
#[derive(Default)]
pub(super) struct Lists {
    pub(super) cumulative: Vec<f32>,
    pub(super) guide: Vec<u32>,
}

impl Lists {
    /// Appends at least one weight, none of them negative; where none is positive all are drawn alike.
    pub(super) fn append(&mut self, weights: &[f64]) {
        assert!(!weights.is_empty(), "nothing to draw from");
        let total: f64 = weights.iter().sum();
        let even = total <= 0.0;
        let mut sum = 0.0;
        let first = self.cumulative.len();
        self.cumulative.push(0.0);
        for (i, &w) in weights.iter().enumerate() {
            sum += w;
            let share = if even { (i + 1) as f64 / weights.len() as f64 } else { sum / total };
            self.cumulative.push(share as f32);
        }
        let (n, cumulative) = (weights.len(), &self.cumulative[first..]);
        let start = |k: usize| cumulative.partition_point(|&c| c <= k as f32 / n as f32).clamp(1, n) as u32 - 1;
        self.guide.extend((0..n).map(start));
    }

    /// All as one list.
    #[cfg(test)]
    pub(super) fn one(&self) -> Cdf<'_> {
        Cdf { cumulative: &self.cumulative, guide: &self.guide }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(weights: &[f64]) -> Lists {
        let mut lists = Lists::default();
        lists.append(weights);
        lists
    }

    #[test]
    fn every_entry_is_drawn_as_often_as_it_weighs() {
        let weights = [0.0, 3.0, 1.0, 0.0, 4.0, 0.0];
        let lists = of(&weights);
        let cdf = lists.one();
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
        let lists = of(&[0.0; 4]);
        let cdf = lists.one();
        assert_eq!((cdf.draw(0.6).0, cdf.probability(3)), (2, 0.25));
    }
}

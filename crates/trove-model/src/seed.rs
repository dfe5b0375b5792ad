//! Randomness that can be repeated.
//!
//! SplitMix64 (Steele, Lea, Flood 2014) is written out here, eight lines, so that a recipe gives the same bytes
//! whatever a library's next version draws.

/// Where a stream of random numbers starts; children with other names or indices are independent of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Seed(pub u64);

impl Seed {
    /// The seed of a named part.
    pub fn child(self, name: &str) -> Self {
        // FNV-1a over the name, then mixed with the parent.
        let hash =
            name.bytes().fold(0xcbf2_9ce4_8422_2325u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
        Self(mix(self.0 ^ mix(hash)))
    }

    /// The seed of the `index`-th of many.
    pub fn nth(self, index: u64) -> Self {
        Self(mix(self.0 ^ mix(index.wrapping_add(0x9e37_79b9_7f4a_7c15))))
    }

    /// Numbers from here on.
    pub fn random(self) -> Random {
        Random { state: self.0 }
    }
}

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mix(self.state)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in [low, high).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in 0..len.
    ///
    /// # Panics
    /// Where `len` is 0.
    pub fn index(&mut self, len: usize) -> usize {
        assert!(len > 0, "nothing to draw from");
        ((u128::from(self.bits()) * len as u128) >> 64) as usize
    }

    /// One of some items; `None` where there are none.
    pub fn pick<'a, T>(&mut self, items: &'a [T]) -> Option<&'a T> {
        (!items.is_empty()).then(|| &items[self.index(items.len())])
    }

    /// An index, each drawn in proportion to its weight (0 or more, of any sum); `None` where all weights are 0.
    pub fn weighted(&mut self, weights: impl IntoIterator<Item = f64, IntoIter: Clone>) -> Option<usize> {
        weighted_at(self.unit(), weights)
    }

    /// True with probability `p`.
    pub fn chance(&mut self, p: f64) -> bool {
        self.unit() < p
    }

    /// Normal with mean 0 and variance 1 (Box–Muller).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.unit()).cos()
    }
}

/// As [`Random::weighted`], for a number that was drawn in [0, 1).
pub fn weighted_at(unit: f64, weights: impl IntoIterator<Item = f64, IntoIter: Clone>) -> Option<usize> {
    let weights = weights.into_iter();
    let mut left = unit * weights.clone().sum::<f64>();
    let mut last = None;
    for (i, weight) in weights.enumerate().filter(|(_, weight)| *weight > 0.0) {
        left -= weight;
        if left < 0.0 {
            return Some(i);
        }
        // Rounding may leave a little after the last weight.
        last = Some(i);
    }
    last
}

fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_the_same_numbers_for_ever() {
        let mut random = Seed(7).child("trees").nth(3).random();
        let drawn = [random.bits(), random.bits()];
        let mut again = Seed(7).child("trees").nth(3).random();
        assert_eq!(drawn, [again.bits(), again.bits()]);
        assert_eq!(Seed(0).random().bits(), 0xe220_a839_7b1d_cdaf); // published first output of SplitMix64 for 0
    }

    #[test]
    fn siblings_differ() {
        assert_ne!(Seed(7).child("a"), Seed(7).child("b"));
        assert_ne!(Seed(7).nth(0), Seed(7).nth(1));
    }

    #[test]
    fn indices_are_drawn_as_often_as_they_weigh() {
        let mut random = Seed(2).random();
        let mut counts = [0u32; 4];
        for _ in 0..10_000 {
            counts[random.weighted([2.0, 0.0, 5.0, 3.0]).unwrap()] += 1;
        }
        let chi2: f64 =
            [(0, 2000.0), (2, 5000.0), (3, 3000.0)].map(|(i, n)| (f64::from(counts[i]) - n).powi(2) / n).iter().sum();
        assert!(chi2 < 13.8 && counts[1] == 0, "χ² = {chi2}, {counts:?}"); // 99.9 % of 2 degrees of freedom
        assert_eq!(random.weighted([0.0, 0.0]), None);
        assert_eq!(random.weighted([]), None);
    }

    #[test]
    fn uniform_numbers_fill_the_interval_evenly() {
        let mut random = Seed(1).random();
        let mut bins = [0u32; 10];
        for _ in 0..10_000 {
            bins[random.index(10)] += 1;
        }
        let chi2: f64 = bins.iter().map(|&n| (f64::from(n) - 1000.0).powi(2) / 1000.0).sum();
        assert!(chi2 < 27.9, "χ² = {chi2}"); // 99.9 % of 9 degrees of freedom
    }
}

//! Drawing from a list of weights.

/// Cumulative shares of a list of weights; what it draws and what it says of a probability come from the same numbers.
///
/// Numbers next to each other are drawn from numbers next to each other, so even samples stay even.
#[derive(Clone, Copy)]
pub struct Cdf<'a> {
    /// The share of all weights before each of them; one longer than the list, from 0 to 1.
    pub cumulative: &'a [f32],
    /// Where the search for a number starts, by the number's place in [0, 1): a step or two before its entry.
    pub guide: &'a [u32],
}

impl Cdf<'_> {
    /// Which one `u` in [0, 1) falls on, and where in it, again in [0, 1).
    #[inline]
    pub fn draw(&self, u: f32) -> (usize, f32) {
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
    #[inline]
    pub fn probability(&self, i: usize) -> f32 {
        self.cumulative[i + 1] - self.cumulative[i]
    }
}

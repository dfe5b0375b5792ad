//! Mean and standard deviation of colours, gathered in parts.

/// Count, mean and sum of squared differences of three channels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    count: f64,
    mean: [f64; 3],
    squares: [f64; 3],
}

impl Statistics {
    /// Of a picture's pixels.
    pub fn of(pixels: &[[f32; 3]]) -> Self {
        let mut all = Self::default();
        // Sums of few numbers lose little; blocks are then joined (Chan, Golub and LeVeque 1983).
        for block in pixels.chunks(4096) {
            let count = block.len() as f64;
            let mean = std::array::from_fn(|c| block.iter().map(|p| f64::from(p[c])).sum::<f64>() / count);
            let squares = std::array::from_fn(|c| block.iter().map(|p| (f64::from(p[c]) - mean[c]).powi(2)).sum());
            all.join(&Self { count, mean, squares });
        }
        all
    }

    /// Takes another's pixels in.
    pub fn join(&mut self, other: &Self) {
        let count = self.count + other.count;
        if other.count == 0.0 {
            return;
        }
        for c in 0..3 {
            let apart = other.mean[c] - self.mean[c];
            self.squares[c] += other.squares[c] + apart * apart * self.count * other.count / count;
            self.mean[c] += apart * other.count / count;
        }
        self.count = count;
    }

    /// Means; zeros without pixels.
    pub fn mean(&self) -> [f64; 3] {
        self.mean
    }

    /// Standard deviations; zeros without pixels.
    pub fn deviation(&self) -> [f64; 3] {
        self.squares.map(|s| if self.count > 0.0 { (s / self.count).sqrt() } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_joined_are_the_whole_and_the_whole_is_the_closed_form() {
        // 0, 1, …, n − 1 have mean (n − 1) / 2 and variance (n² − 1) / 12.
        let pixels: Vec<[f32; 3]> = (0..10_000).map(|i| [i as f32, 5.0, -(i as f32)]).collect();
        let whole = Statistics::of(&pixels);
        let mut parts = Statistics::of(&pixels[..1234]);
        parts.join(&Statistics::of(&pixels[1234..]));
        parts.join(&Statistics::default());
        for found in [whole, parts] {
            assert!((found.mean()[0] - 4999.5).abs() < 1e-6 && (found.mean()[2] + 4999.5).abs() < 1e-6);
            assert!((found.deviation()[0] - ((1e8 - 1.0) / 12.0f64).sqrt()).abs() < 1e-6);
            assert_eq!(found.deviation()[1], 0.0);
        }
    }
}

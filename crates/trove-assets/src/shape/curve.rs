//! Smooth functions through points.

/// A function through knots that never overshoots them (Fritsch and Carlson's monotone cubic); constant beyond its ends.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    knots: Vec<(f32, f32)>,
    slopes: Vec<f32>,
}

impl Curve {
    /// Through at least one knot (x, value), x rising.
    pub(crate) fn new(knots: &[(f32, f32)]) -> Self {
        let secants: Vec<f32> = knots.windows(2).map(|w| (w[1].1 - w[0].1) / (w[1].0 - w[0].0)).collect();
        let slopes = (0..knots.len())
            .map(|i| {
                let (before, after) = (i.checked_sub(1).and_then(|k| secants.get(k)), secants.get(i));
                match (before, after) {
                    (Some(&a), Some(&b)) if a * b > 0.0 => {
                        let (h, k) = (knots[i].0 - knots[i - 1].0, knots[i + 1].0 - knots[i].0);
                        let (w1, w2) = (2.0 * k + h, k + 2.0 * h);
                        (w1 + w2) / (w1 / a + w2 / b)
                    }
                    (Some(_), Some(_)) => 0.0,
                    (Some(&a), None) | (None, Some(&a)) => a,
                    (None, None) => 0.0,
                }
            })
            .collect();
        Self { knots: knots.to_vec(), slopes }
    }

    /// Its value at x.
    pub(crate) fn at(&self, x: f32) -> f32 {
        let next = self.knots.partition_point(|k| k.0 <= x);
        if next == 0 {
            return self.knots[0].1;
        }
        if next == self.knots.len() {
            return self.knots[next - 1].1;
        }
        let ((x0, y0), (x1, y1)) = (self.knots[next - 1], self.knots[next]);
        let (h, t) = (x1 - x0, (x - x0) / (x1 - x0));
        let (d0, d1) = (self.slopes[next - 1] * h, self.slopes[next] * h);
        let (a, b) = (2.0 * (y0 - y1) + d0 + d1, 3.0 * (y1 - y0) - 2.0 * d0 - d1);
        ((a * t + b) * t + d0) * t + y0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_passes_its_knots_and_stays_between_them() {
        let curve = Curve::new(&[(0.0, 1.0), (1.0, 1.0), (2.0, 3.0), (5.0, 3.5)]);
        for (x, y) in [(-1.0, 1.0), (0.0, 1.0), (0.5, 1.0), (2.0, 3.0), (9.0, 3.5)] {
            assert!((curve.at(x) - y).abs() < 1e-5);
        }
        assert!((0..100).all(|i| (1.0..=3.5).contains(&curve.at(i as f32 * 0.05))));
    }
}

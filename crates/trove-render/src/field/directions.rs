//! What becomes of light by direction.

use trove_trace::field::{ByDirection, PARTS, direction_in};

/// Directions across a part that kernels are measured with.
const ACROSS: usize = 3;

/// What becomes of light from all parts: a row of weights for each part.
pub(crate) struct Kernel(Vec<[f32; PARTS]>);

impl Kernel {
    /// By a function of the cosine between the parts' directions; each row sums to `sum`.
    pub(crate) fn new(sum: f32, of: impl Fn(f32) -> f32) -> Self {
        let within = |part| {
            let share = |k: usize| (k as f32 + 0.5) / ACROSS as f32;
            (0..ACROSS * ACROSS).map(move |k| direction_in(part, [share(k % ACROSS), share(k / ACROSS)]))
        };
        let row = |to| {
            let mut row: [f32; PARTS] =
                std::array::from_fn(|from| within(to).map(|a| within(from).map(|b| of(a.dot(b))).sum::<f32>()).sum());
            let total: f32 = row.iter().sum();
            row.iter_mut().for_each(|weight| *weight *= sum / total);
            row
        };
        Self((0..PARTS).map(row).collect())
    }

    pub(crate) fn of(&self, light: &ByDirection) -> ByDirection {
        std::array::from_fn(|to| self.0[to].iter().zip(light).map(|(&weight, &light)| weight * light).sum())
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use glam::Vec3;

    use super::*;

    #[test]
    fn light_lights_surfaces_as_its_closed_form_says() {
        let kernel = Kernel::new(PI, |cos| cos.max(0.0));
        assert!(kernel.of(&[Vec3::ONE; PARTS]).iter().all(|of| (of.x - PI).abs() < 1e-4));
        // Radiance 1 + z gives π + 2π/3 z (Ramamoorthi and Hanrahan 2001).
        let height = |part| direction_in(part, [0.5; 2]).z;
        let lit = kernel.of(&std::array::from_fn(|part| Vec3::splat(1.0 + height(part))));
        for (part, lit) in lit.iter().enumerate() {
            let expected = PI + 2.0 * PI / 3.0 * height(part);
            assert!((lit.x - expected).abs() < 0.15, "{part}: {lit} instead of {expected}");
        }
    }
}

//! Into which directions a lamp shines.

use glam::Vec3;

/// How brightly a lamp's front shines into each direction, relative to a reference; between the directions of its table it is
/// bilinear.
///
/// Directions are those of the mesh: azimuths from +x (a vehicle's front) towards +y (its left), elevations from the plane of
/// both towards +z.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    azimuths_deg: Vec<f32>,
    elevations_deg: Vec<f32>,
    /// A row for each elevation.
    shares: Vec<f32>,
    /// What all of it gives, as a share of what a matt surface of the reference's brightness would that faces +x.
    flux_share: f32,
}

impl Beam {
    /// From a table with azimuths and elevations that grow, one share for each pair of them; `None` for another. Directions
    /// beyond the table have the share at its edge.
    pub fn new(azimuths_deg: Vec<f32>, elevations_deg: Vec<f32>, shares: Vec<f32>) -> Option<Self> {
        let grows = |values: &[f32]| !values.is_empty() && values.is_sorted_by(|a, b| a < b);
        let is_sound = grows(&azimuths_deg)
            && grows(&elevations_deg)
            && shares.len() == azimuths_deg.len() * elevations_deg.len()
            && shares.iter().all(|share| share.is_finite() && *share >= 0.0);
        if !is_sound {
            return None;
        }
        let mut beam = Self { azimuths_deg, elevations_deg, shares, flux_share: 0.0 };
        // Quarters of a degree over the front.
        let step_deg = 0.25f32;
        let across = |i: i32| (i as f32 + 0.5) * step_deg - 90.0;
        let cell_sr = step_deg.to_radians().powi(2);
        let row = |e: f32| -> f32 {
            let cos = e.to_radians().cos();
            (0..720).map(across).map(|a| beam.at(a, e) * a.to_radians().cos()).sum::<f32>() * cos * cos * cell_sr
        };
        beam.flux_share = (0..720).map(|i| row(across(i))).sum::<f32>() / std::f32::consts::PI;
        Some(beam)
    }

    /// Share into a direction of the mesh, of any length but 0.
    pub fn share(&self, direction: Vec3) -> f32 {
        let azimuth = direction.y.atan2(direction.x);
        let elevation = direction.z.atan2(direction.truncate().length());
        self.at(azimuth.to_degrees(), elevation.to_degrees())
    }

    /// What all of it gives, as a share of what a matt surface of the reference's brightness would that faces +x.
    pub fn flux_share(&self) -> f32 {
        self.flux_share
    }

    fn at(&self, azimuth_deg: f32, elevation_deg: f32) -> f32 {
        let (x, fx) = between(&self.azimuths_deg, azimuth_deg);
        let (y, fy) = between(&self.elevations_deg, elevation_deg);
        let width = self.azimuths_deg.len();
        let (x1, y1) = ((x + 1).min(width - 1), (y + 1).min(self.elevations_deg.len() - 1));
        let share = |x: usize, y: usize| self.shares[y * width + x];
        let lower = share(x, y) * (1.0 - fx) + share(x1, y) * fx;
        let upper = share(x, y1) * (1.0 - fx) + share(x1, y1) * fx;
        lower * (1.0 - fy) + upper * fy
    }
}

/// Index of the last value that is not beyond `at`, and how far `at` is on its way to the next.
fn between(values: &[f32], at: f32) -> (usize, f32) {
    let above = values.partition_point(|value| *value <= at);
    let below = above.saturating_sub(1);
    match values.get(above) {
        Some(next) if above > 0 => (below, (at - values[below]) / (next - values[below])),
        _ => (below, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_those_of_the_table_bilinear_between_and_constant_beyond() {
        let beam = Beam::new(vec![-10.0, 0.0, 20.0], vec![-5.0, 5.0], vec![0.0, 1.0, 0.5, 0.2, 0.4, 0.6]).unwrap();
        let toward = |azimuth_deg: f32, elevation_deg: f32| {
            let (a, e) = (azimuth_deg.to_radians(), elevation_deg.to_radians());
            beam.share(Vec3::new(a.cos() * e.cos(), a.sin() * e.cos(), e.sin()) * 3.0)
        };
        for ((azimuth_deg, elevation_deg), expected) in [
            ((0.0, -5.0), 1.0),
            ((20.0, 5.0), 0.6),
            ((-5.0, -5.0), 0.5),
            ((10.0, 0.0), 0.625),
            ((90.0, 80.0), 0.6),
            ((-170.0, -60.0), 0.0),
        ] {
            assert!((toward(azimuth_deg, elevation_deg) - expected).abs() < 1e-3, "{azimuth_deg} {elevation_deg}");
        }
        for shares in [vec![1.0; 5], vec![f32::NAN; 6], vec![-1.0; 6]] {
            assert!(Beam::new(vec![-10.0, 0.0, 20.0], vec![-5.0, 5.0], shares).is_none());
        }
        assert!(Beam::new(vec![1.0, 1.0], vec![0.0], vec![1.0; 2]).is_none());
    }

    #[test]
    fn a_matt_front_gives_all_and_a_cone_of_light_its_part() {
        let all = Beam::new(vec![0.0], vec![0.0], vec![1.0]).unwrap();
        assert!((all.flux_share() - 1.0).abs() < 1e-3, "{}", all.flux_share());
        // Within 30° above and below alone: ∫ cos² over elevations times 2, over π.
        let band = vec![-30.01, -30.0, 30.0, 30.01];
        let band = Beam::new(vec![0.0], band, vec![0.0, 1.0, 1.0, 0.0]).unwrap();
        let e = 30.0f32.to_radians();
        let expected = 2.0 * (e + e.sin() * e.cos()) / std::f32::consts::PI;
        assert!((band.flux_share() - expected).abs() < 5e-3, "{} {expected}", band.flux_share());
    }
}

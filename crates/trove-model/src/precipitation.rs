//! Rain that falls.

/// Drops a cubic metre and a millimetre of diameter, for diameters near nothing (Marshall and Palmer 1948).
const MOST_PER_M3_MM: f64 = 8000.0;

/// Steady rain, by how much falls: its drops have the sizes of Marshall and Palmer (1948).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rain {
    /// Millimetres of water an hour: 1 a drizzle, 10 heavy rain, 50 a cloudburst.
    pub rate_mm_h: f64,
}

impl Rain {
    /// With how many millimetres of diameter drops become e times fewer, as its inverse.
    fn slope_per_mm(self) -> f64 {
        4.1 * self.rate_mm_h.powf(-0.21)
    }

    /// Drops in a cubic metre that are larger than a diameter in metres.
    pub fn drops_per_m3(self, larger_than_m: f64) -> f64 {
        MOST_PER_M3_MM / self.slope_per_mm() * (-self.slope_per_mm() * larger_than_m * 1e3).exp()
    }

    /// Diameter in metres of a drop larger than another diameter, drawn by `unit`, 0 to less than 1.
    pub fn diameter_m(self, larger_than_m: f64, unit: f64) -> f64 {
        larger_than_m - (-unit).ln_1p() / self.slope_per_mm() * 1e-3
    }

    /// How fast a drop falls, metres a second (Atlas, Srivastava and Sekhon 1973).
    pub fn speed_mps(diameter_m: f64) -> f64 {
        (9.65 - 10.3 * (-600.0 * diameter_m).exp()).max(0.0)
    }

    /// What a metre takes from light, as the exponent of its loss: what drops cover. What they bend by diffraction goes on
    /// within a pixel.
    pub fn extinction_per_m(self) -> f64 {
        // π/4 of the second moment of the sizes, in mm²/m³.
        std::f64::consts::FRAC_PI_2 * MOST_PER_M3_MM / self.slope_per_mm().powi(3) * 1e-6
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drops_are_drawn_as_they_are_counted_and_cover_what_is_told() {
        for rate_mm_h in [1.0, 10.0, 50.0] {
            let rain = Rain { rate_mm_h };
            let n = 200_000;
            let diameters = || (0..n).map(|i| rain.diameter_m(0.0, (f64::from(i) + 0.5) / f64::from(n)));
            let share = diameters().filter(|d| *d > 1e-3).count() as f64 / f64::from(n);
            assert!((share - rain.drops_per_m3(1e-3) / rain.drops_per_m3(0.0)).abs() < 1e-4);
            let covered = diameters().map(|d| std::f64::consts::FRAC_PI_4 * d * d).sum::<f64>() / f64::from(n);
            let covered = covered * rain.drops_per_m3(0.0);
            assert!((covered / rain.extinction_per_m() - 1.0).abs() < 1e-3, "{covered}");
            // As much water arrives as is said to, up to how well the two laws fit each other.
            let water = |d: f64| std::f64::consts::PI / 6.0 * d.powi(3) * Rain::speed_mps(d);
            let falls_m_s = diameters().map(water).sum::<f64>() / f64::from(n) * rain.drops_per_m3(0.0);
            let mm_h = falls_m_s * 1e3 * 3600.0;
            assert!((0.75..1.25).contains(&(mm_h / rate_mm_h)), "{mm_h} for {rate_mm_h}");
        }
    }
}

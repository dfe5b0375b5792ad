//! Rain and snow that fall.

/// What falls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Drops of water.
    Rain,
    /// Flakes of snow.
    Snow,
}

/// Steady rain or snowfall, by how much comes down: its drops have the sizes of Marshall and Palmer (1948), its flakes those of
/// Gunn and Marshall (1958).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Precipitation {
    /// What falls.
    pub form: Form,
    /// Millimetres of water an hour: of rain 1 is a drizzle, 10 heavy and 50 a cloudburst; of snow 0.5 is light and 3 heavy.
    pub rate_mm_h: f64,
}

/// A flake is so many times as wide as the drop that it melts to: a tenth as dense as water.
const FLAKE: f64 = 2.15;

impl Precipitation {
    /// Pieces a cubic metre and a millimetre of diameter, for diameters near nothing.
    fn most_per_m3_mm(self) -> f64 {
        match self.form {
            Form::Rain => 8000.0,
            Form::Snow => 3800.0 * self.rate_mm_h.powf(-0.87) / FLAKE,
        }
    }

    /// With how many millimetres of diameter pieces become e times fewer, as its inverse.
    fn slope_per_mm(self) -> f64 {
        match self.form {
            Form::Rain => 4.1 * self.rate_mm_h.powf(-0.21),
            Form::Snow => 2.55 * self.rate_mm_h.powf(-0.48) / FLAKE,
        }
    }

    /// Drops or flakes in a cubic metre that are larger than a diameter in metres.
    pub fn pieces_per_m3(self, larger_than_m: f64) -> f64 {
        self.most_per_m3_mm() / self.slope_per_mm() * (-self.slope_per_mm() * larger_than_m * 1e3).exp()
    }

    /// Diameter in metres of a piece larger than another diameter, drawn by `unit`, 0 to less than 1.
    pub fn diameter_m(self, larger_than_m: f64, unit: f64) -> f64 {
        larger_than_m - (-unit).ln_1p() / self.slope_per_mm() * 1e-3
    }

    /// How fast a piece falls, metres a second: drops by Atlas, Srivastava and Sekhon (1973), flakes by Langleben (1954).
    pub fn speed_mps(self, diameter_m: f64) -> f64 {
        match self.form {
            Form::Rain => (9.65 - 10.3 * (-600.0 * diameter_m).exp()).max(0.0),
            Form::Snow => 1.6 * (diameter_m / FLAKE * 100.0).powf(0.3),
        }
    }

    /// What a metre takes from light, as the exponent of its loss: what pieces cover. What they bend by diffraction goes on
    /// within a pixel.
    pub fn extinction_per_m(self) -> f64 {
        // π/4 of the second moment of the sizes, in mm²/m³.
        std::f64::consts::FRAC_PI_2 * self.most_per_m3_mm() / self.slope_per_mm().powi(3) * 1e-6
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_drawn_as_they_are_counted_and_cover_what_is_told() {
        let rain = [1.0, 10.0, 50.0].map(|rate_mm_h| (Form::Rain, rate_mm_h, 1.0));
        // What a flake melts to.
        let snow = [0.5, 1.0, 3.0].map(|rate_mm_h| (Form::Snow, rate_mm_h, FLAKE));
        for (form, rate_mm_h, wider) in rain.into_iter().chain(snow) {
            let falling = Precipitation { form, rate_mm_h };
            let n = 200_000;
            let diameters = || (0..n).map(|i| falling.diameter_m(0.0, (f64::from(i) + 0.5) / f64::from(n)));
            let share = diameters().filter(|d| *d > 1e-3).count() as f64 / f64::from(n);
            assert!((share - falling.pieces_per_m3(1e-3) / falling.pieces_per_m3(0.0)).abs() < 1e-4);
            let covered = diameters().map(|d| std::f64::consts::FRAC_PI_4 * d * d).sum::<f64>() / f64::from(n);
            let covered = covered * falling.pieces_per_m3(0.0);
            assert!((covered / falling.extinction_per_m() - 1.0).abs() < 1e-3, "{covered}");
            // As much water arrives as is said to, up to how well the two laws fit each other.
            let water = |d: f64| std::f64::consts::PI / 6.0 * (d / wider).powi(3) * falling.speed_mps(d);
            let falls_m_s = diameters().map(water).sum::<f64>() / f64::from(n) * falling.pieces_per_m3(0.0);
            let mm_h = falls_m_s * 1e3 * 3600.0;
            assert!((0.75..1.25).contains(&(mm_h / rate_mm_h)), "{mm_h} for {rate_mm_h}");
        }
    }
}

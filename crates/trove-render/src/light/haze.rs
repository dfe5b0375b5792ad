//! Haze of a turbidity.

use glam::Vec3;
use trove_trace::light::Haze;

use super::sun;

/// Heights over which air and haze thin out to 1/e, metres (Preetham, Shirley, Smits 1999, appendix A.1).
const AIR_M: f64 = 8400.0;
const HAZE_M: f64 = 1250.0;

/// What air of a turbidity takes from light near the ground.
pub(super) fn haze(turbidity: f64) -> Haze {
    let [air, haze] = sun::thicknesses(turbidity);
    Haze { extinction_per_m: Vec3::from_array([0, 1, 2].map(|i| (air[i] / AIR_M + haze[i] / HAZE_M) as f32)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contrast of 2 % is the least that is seen (Koschmieder 1924): ranges that airports report of fair and of humid air.
    #[test]
    fn one_sees_as_far_as_the_turbidity_says() {
        let range_m = |turbidity: f64| -(0.02f32).ln() / haze(turbidity).extinction_per_m.y;
        assert!((50_000.0..150_000.0).contains(&range_m(2.0)), "{}", range_m(2.0));
        assert!((20_000.0..50_000.0).contains(&range_m(4.0)), "{}", range_m(4.0));
        assert!((8_000.0..20_000.0).contains(&range_m(7.0)), "{}", range_m(7.0));
    }

    #[test]
    fn what_is_far_away_turns_blue_in_clear_air() {
        let passes = haze(2.0).transmittance(5000.0);
        assert!(passes.x > passes.y && passes.y > passes.z && passes.z > 0.6, "{passes}");
        assert_eq!(haze(2.0).transmittance(0.0), Vec3::ONE);
    }
}

//! Sunlight as it reaches the ground.

use glam::Vec3;
use trove_trace::light::SUN_RADIUS_RAD;

/// Irradiance of a surface that faces the sun outside the atmosphere, linear Rec. 709 with a mean brightness of 1: a
/// black body of 5800 K is a little warmer than the white point.
const OUTSIDE: Vec3 = Vec3::new(1.07, 0.985, 0.94);

/// Wavelengths that stand for red, green and blue, micrometres.
const WAVELENGTHS_UM: [f64; 3] = [0.610, 0.550, 0.465];

/// Optical thickness of 0.35 cm of ozone at these wavelengths.
const OZONE: [f64; 3] = [0.043, 0.030, 0.005];

/// Share of sunlight that reaches the ground from a sun at `elevation_rad`, for red, green and blue: air (Rayleigh),
/// haze (Ångström with exponent 1.3) and ozone as in Preetham, Shirley, Smits 1999, appendix A.2, along the air mass
/// of Kasten and Young 1989. Their haze, 0.046 for a turbidity, leaves a setting sun a tenth of what is measured, since
/// Linke's turbidity is one of all wavelengths.
pub(super) fn transmittance(elevation_rad: f64, turbidity: f64) -> Vec3 {
    let elevation_deg = elevation_rad.to_degrees().max(0.0);
    let air_mass = 1.0 / (elevation_rad.max(0.0).sin() + 0.50572 * (elevation_deg + 6.07995).powf(-1.6364));
    let [air, haze] = thicknesses(turbidity);
    Vec3::from_array([0, 1, 2].map(|i| (-air_mass * (air[i] + haze[i] + OZONE[i])).exp() as f32))
}

/// Optical thicknesses of the whole atmosphere above the ground for red, green and blue: of its air and of its haze.
pub(super) fn thicknesses(turbidity: f64) -> [[f64; 3]; 2] {
    let haze = 0.025 * (turbidity - 1.0).max(0.0);
    [WAVELENGTHS_UM.map(|um| 0.008735 * um.powf(-4.08)), WAVELENGTHS_UM.map(|um| haze * um.powf(-1.3))]
}

/// Irradiance of a surface that faces the sun, where `outside` is its mean over the colours above the atmosphere; the
/// disk goes down over its own diameter.
pub(super) fn irradiance(elevation_rad: f64, turbidity: f64, outside: f32) -> Vec3 {
    let radius = f64::from(SUN_RADIUS_RAD);
    let risen = ((elevation_rad + radius) / (2.0 * radius)).clamp(0.0, 1.0) as f32;
    OUTSIDE * transmittance(elevation_rad, turbidity) * outside * risen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_low_sun_is_dim_and_red_and_a_sunken_sun_is_dark() {
        let (high, low) = (irradiance(1.0, 3.0, 1.0), irradiance(0.07, 3.0, 1.0));
        assert!(low.x < 0.5 * high.x && low.x / low.z > 3.0 * high.x / high.z, "{high} {low}");
        assert_eq!(irradiance(-0.01, 3.0, 1.0), Vec3::ZERO);
    }
}

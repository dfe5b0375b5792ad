//! The sun's disk.

use std::f32::consts::TAU;

use glam::Vec3;

/// Angular radius as seen from Earth (mean of the year).
pub const RADIUS_RAD: f32 = 0.267 * std::f32::consts::PI / 180.0;

/// Irradiance of a surface that faces the sun outside the atmosphere, linear Rec. 709 with a mean brightness of 1: a
/// black body of 5800 K is a little warmer than the white point.
const OUTSIDE: Vec3 = Vec3::new(1.07, 0.985, 0.94);

/// Wavelengths that stand for red, green and blue, micrometres.
const WAVELENGTHS_UM: [f64; 3] = [0.610, 0.550, 0.465];

/// Optical thickness of 0.35 cm of ozone at these wavelengths.
const OZONE: [f64; 3] = [0.043, 0.030, 0.005];

/// A disk of even colour, darker towards its limb.
pub(super) struct Sun {
    to_sun: Vec3,
    /// Axes across the disk.
    across: [Vec3; 2],
    /// Mean radiance of the disk.
    radiance: Vec3,
}

impl Sun {
    /// The sun that gives `irradiance` to a surface that faces it; `None` where it gives none.
    pub(super) fn new(to_sun: Vec3, irradiance: Vec3) -> Option<Self> {
        let (a, b) = to_sun.any_orthonormal_pair();
        (irradiance.max_element() > 0.0).then(|| Self { to_sun, across: [a, b], radiance: irradiance / solid_angle() })
    }

    /// Irradiance of a level surface that looks up.
    pub(super) fn level_irradiance(&self) -> Vec3 {
        self.radiance * solid_angle() * self.to_sun.z.max(0.0)
    }

    /// A direction on the disk, evenly over its solid angle.
    pub(super) fn draw(&self, u: [f32; 2]) -> Vec3 {
        let fall = u[0] * fall();
        let r = (fall * (2.0 - fall)).sqrt();
        let (sin, cos) = (TAU * u[1]).sin_cos();
        ((1.0 - fall) * self.to_sun + r * (cos * self.across[0] + sin * self.across[1])).normalize()
    }

    /// Density over solid angle with which a direction is drawn.
    pub(super) fn pdf(&self, direction: Vec3) -> f32 {
        if self.share_of_radius(direction) < 1.0 { 1.0 / solid_angle() } else { 0.0 }
    }

    /// Radiance of the disk; 0 beside it.
    pub(super) fn radiance(&self, direction: Vec3) -> Vec3 {
        let r = self.share_of_radius(direction);
        if r >= 1.0 {
            return Vec3::ZERO;
        }
        // Linear limb darkening with the coefficient 0.6, whose mean over the disk is 0.8.
        let cos_from_normal = (1.0 - r * r).sqrt();
        self.radiance * ((0.4 + 0.6 * cos_from_normal) / 0.8)
    }

    /// Distance from the centre in radii; the chord, which is the angle to one part in a million here.
    fn share_of_radius(&self, direction: Vec3) -> f32 {
        (direction - self.to_sun).length() / (2.0 * (RADIUS_RAD * 0.5).sin())
    }
}

/// 1 − cos of the radius, which single precision would lose in the cosine itself.
fn fall() -> f32 {
    2.0 * (RADIUS_RAD * 0.5).sin().powi(2)
}

fn solid_angle() -> f32 {
    TAU * fall()
}

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
    let radius = f64::from(RADIUS_RAD);
    let risen = ((elevation_rad + radius) / (2.0 * radius)).clamp(0.0, 1.0) as f32;
    OUTSIDE * transmittance(elevation_rad, turbidity) * outside * risen
}

#[cfg(test)]
mod tests {
    use trove_model::Seed;

    use super::*;

    #[test]
    fn the_disk_gives_the_irradiance_that_it_was_made_of() {
        let to_sun = Vec3::new(0.3, -0.5, 0.6).normalize();
        let sun = Sun::new(to_sun, Vec3::new(3.0, 2.0, 1.0)).unwrap();
        let n = 64;
        let mut sum = Vec3::ZERO;
        for i in 0..n * n {
            let d = sun.draw([((i / n) as f32 + 0.5) / n as f32, ((i % n) as f32 + 0.5) / n as f32]);
            assert!(sun.pdf(d) > 0.0 && d.is_normalized());
            sum += sun.radiance(d) * d.dot(to_sun) / sun.pdf(d);
        }
        assert!((sum / (n * n) as f32 - Vec3::new(3.0, 2.0, 1.0)).length() < 5e-3, "{sum}");
        let beside = (to_sun + to_sun.any_orthonormal_vector() * 1.01 * RADIUS_RAD).normalize();
        assert_eq!((sun.pdf(beside), sun.radiance(beside)), (0.0, Vec3::ZERO));
    }

    #[test]
    fn directions_cover_the_disk_evenly() {
        let to_sun = Vec3::new(-0.2, 0.7, 0.4).normalize();
        let sun = Sun::new(to_sun, Vec3::ONE).unwrap();
        // 16 rings of the same solid angle, cut into 16 sectors.
        let (mut drawn, draws) = ([0.0f64; 256], 100_000);
        let mut random = Seed(8).random();
        for _ in 0..draws {
            let d = sun.draw([random.unit() as f32, random.unit() as f32]);
            let [x, y] = sun.across.map(|axis| d.dot(axis));
            let ring = (16.0 * sun.share_of_radius(d).powi(2)) as usize;
            let sector = ((y.atan2(x) / TAU + 0.5) * 16.0) as usize;
            drawn[ring.min(15) * 16 + sector.min(15)] += 1.0;
        }
        let expected = f64::from(draws) * f64::from(sun.pdf(to_sun) * solid_angle()) / 256.0;
        let chi2: f64 = drawn.iter().map(|n| (n - expected).powi(2) / expected).sum();
        assert!(chi2 < 330.52, "χ² = {chi2}"); // 99.9 % of 255 degrees of freedom
    }

    #[test]
    fn a_low_sun_is_dim_and_red_and_a_sunken_sun_is_dark() {
        let (high, low) = (irradiance(1.0, 3.0, 1.0), irradiance(0.07, 3.0, 1.0));
        assert!(low.x < 0.5 * high.x && low.x / low.z > 3.0 * high.x / high.z, "{high} {low}");
        assert_eq!(irradiance(-0.01, 3.0, 1.0), Vec3::ZERO);
        assert!(Sun::new(Vec3::X, Vec3::ZERO).is_none());
    }
}

//! The sun's disk.

use core::f32::consts::{PI, TAU};

use glam::Vec3;

use crate::math::{sqrt, turn, unit};

/// Angular radius of the sun as seen from Earth (mean of the year).
pub const SUN_RADIUS_RAD: f32 = 0.267 * PI / 180.0;

/// Sine of half of it, by two terms of its series.
const SIN_HALF: f32 = SUN_RADIUS_RAD / 2.0 * (1.0 - SUN_RADIUS_RAD * SUN_RADIUS_RAD / 24.0);
/// 1 − its cosine, which single precision would lose in the cosine itself.
const FALL: f32 = 2.0 * SIN_HALF * SIN_HALF;
const SOLID_ANGLE_SR: f32 = TAU * FALL;

/// A disk of even colour, darker towards its limb.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Sun {
    to_sun: Vec3,
    /// Axes across the disk.
    across: [Vec3; 2],
    /// Mean radiance of the disk.
    radiance: Vec3,
}

impl Sun {
    /// The sun that gives `irradiance` to a surface that faces it.
    pub fn new(to_sun: Vec3, irradiance: Vec3) -> Self {
        let (a, b) = to_sun.any_orthonormal_pair();
        Self { to_sun, across: [a, b], radiance: irradiance / SOLID_ANGLE_SR }
    }

    /// Irradiance of a level surface that looks up.
    pub fn level_irradiance(&self) -> Vec3 {
        self.radiance * SOLID_ANGLE_SR * self.to_sun.z.max(0.0)
    }

    /// A direction on the disk, evenly over its solid angle.
    #[inline]
    pub fn draw(&self, u: [f32; 2]) -> Vec3 {
        let fall = u[0] * FALL;
        let r = sqrt(fall * (2.0 - fall));
        let (sin, cos) = turn(u[1]);
        unit((1.0 - fall) * self.to_sun + r * (cos * self.across[0] + sin * self.across[1]))
    }

    /// Density over solid angle with which a direction is drawn.
    #[inline]
    pub fn pdf(&self, direction: Vec3) -> f32 {
        if self.share_of_radius(direction) < 1.0 { 1.0 / SOLID_ANGLE_SR } else { 0.0 }
    }

    /// Radiance of the disk; 0 beside it.
    #[inline]
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        let r = self.share_of_radius(direction);
        if r >= 1.0 {
            return Vec3::ZERO;
        }
        // Linear limb darkening with the coefficient 0.6, whose mean over the disk is 0.8.
        let cos_from_normal = sqrt(1.0 - r * r);
        self.radiance * ((0.4 + 0.6 * cos_from_normal) / 0.8)
    }

    /// Distance from the centre in radii; the chord, which is the angle to one part in a million here.
    #[inline(always)]
    fn share_of_radius(&self, direction: Vec3) -> f32 {
        sqrt((direction - self.to_sun).length_squared()) / (2.0 * SIN_HALF)
    }
}

#[cfg(test)]
mod tests {
    use trove_model::Seed;

    use super::*;

    #[test]
    fn the_disk_gives_the_irradiance_that_it_was_made_of() {
        let to_sun = Vec3::new(0.3, -0.5, 0.6).normalize();
        let sun = Sun::new(to_sun, Vec3::new(3.0, 2.0, 1.0));
        let n = 64;
        let mut sum = Vec3::ZERO;
        for i in 0..n * n {
            let d = sun.draw([((i / n) as f32 + 0.5) / n as f32, ((i % n) as f32 + 0.5) / n as f32]);
            assert!(sun.pdf(d) > 0.0 && d.is_normalized());
            sum += sun.radiance(d) * d.dot(to_sun) / sun.pdf(d);
        }
        assert!((sum / (n * n) as f32 - Vec3::new(3.0, 2.0, 1.0)).length() < 5e-3, "{sum}");
        let beside = (to_sun + to_sun.any_orthonormal_vector() * 1.01 * SUN_RADIUS_RAD).normalize();
        assert_eq!((sun.pdf(beside), sun.radiance(beside)), (0.0, Vec3::ZERO));
    }

    #[test]
    fn directions_cover_the_disk_evenly() {
        let to_sun = Vec3::new(-0.2, 0.7, 0.4).normalize();
        let sun = Sun::new(to_sun, Vec3::ONE);
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
        let expected = f64::from(draws) * f64::from(sun.pdf(to_sun) * SOLID_ANGLE_SR) / 256.0;
        let chi2: f64 = drawn.iter().map(|n| (n - expected).powi(2) / expected).sum();
        assert!(chi2 < 330.52, "χ² = {chi2}"); // 99.9 % of 255 degrees of freedom
    }
}

//! How a street lamp shines.

use glam::{Mat3, Vec3};

use crate::ies::{IesFault, candelas};
use crate::{Beam, luminance};

/// From the nadir to the horizon.
const ELEVATIONS_DEG: [f32; 10] = [-90.0, -80.0, -70.0, -60.0, -50.0, -40.0, -30.0, -20.0, -10.0, 0.0];

/// The light of a lamp that is switched on.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Luminaire {
    /// How brightly it shines into each direction of its mesh, relative to the others.
    pub intensity: Beam,
    /// All that it gives, lumens.
    pub lumens: f32,
    /// The temperature of the black body whose colour it has, kelvins.
    pub kelvin: f32,
}

impl Default for Luminaire {
    /// A matt lens below a lamp of 10,000 lm, warm white.
    fn default() -> Self {
        let intensity = Beam::of(&[0.0], &ELEVATIONS_DEG, |toward| (-toward.z).max(0.0));
        Self { intensity: intensity.expect("elevations grow"), lumens: 10_000.0, kelvin: 3000.0 }
    }
}

impl Luminaire {
    /// From the text of an IES file (ANSI/IES LM-63, type C), with the lumens of its table.
    ///
    /// Its plane C = 90°, the side of the street, is along the mesh's +x, and C = 0° along −y.
    ///
    /// # Errors
    /// What is wrong in the text, and in which line.
    pub fn from_ies(text: &str) -> Result<Self, IesFault> {
        let intensity = candelas(text)?;
        Ok(Self { lumens: intensity.flux(), intensity, ..Self::default() })
    }

    /// Its colour, linear Rec. 709 of luminance 1; from 1667 to 25,000 K, beyond which it is that of the nearest.
    pub fn color(&self) -> Vec3 {
        // The Planckian locus by cubic splines (Kim and others, US patent 7,024,034), CIE 1931.
        let t = 1000.0 / self.kelvin.clamp(1667.0, 25_000.0);
        let cubic = |k: [f32; 4], x: f32| ((k[0] * x + k[1]) * x + k[2]) * x + k[3];
        let x = if t > 0.25 {
            cubic([-0.266_12, -0.234_36, 0.877_70, 0.179_91], t)
        } else {
            cubic([-3.025_85, 2.107_04, 0.222_63, 0.240_39], t)
        };
        let y = if t > 1000.0 / 2222.0 {
            cubic([-1.106_38, -1.348_11, 2.185_56, -0.202_20], x)
        } else if t > 0.25 {
            cubic([-0.954_95, -1.374_19, 2.091_37, -0.167_49], x)
        } else {
            cubic([3.081_76, -5.873_39, 3.751_13, -0.370_01], x)
        };
        let rgb_from_xyz = Mat3::from_cols(
            Vec3::new(3.240_97, -0.969_244, 0.055_63),
            Vec3::new(-1.537_383, 1.875_968, -0.203_977),
            Vec3::new(-0.498_611, 0.041_555, 1.056_972),
        );
        let rgb = (rgb_from_xyz * Vec3::new(x / y, 1.0, (1.0 - x - y) / y)).max(Vec3::ZERO);
        rgb / luminance(rgb)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_run_from_sodium_to_daylight_at_one_luminance() {
        let color = |kelvin: f32| Luminaire { kelvin, ..Luminaire::default() }.color();
        for kelvin in [1000.0, 2000.0, 2222.0, 2700.0, 4000.0, 6504.0, 40_000.0] {
            let luminance = luminance(color(kelvin));
            assert!((luminance - 1.0).abs() < 1e-5, "{kelvin} K: {luminance}");
        }
        // The black body of D65's temperature lies a little towards magenta from it.
        assert!(color(6504.0).abs_diff_eq(Vec3::ONE, 0.06), "{}", color(6504.0));
        // By CIE 1931 x 0.5267, y 0.4133.
        assert!(color(2000.0).abs_diff_eq(Vec3::new(2.5205, 0.6468, 0.0204), 0.01), "{}", color(2000.0));
        let blue = [1800.0, 2400.0, 3000.0, 4000.0, 5600.0].map(|kelvin| color(kelvin).z);
        assert!(blue.is_sorted_by(|a, b| a < b), "{blue:?}");
    }

    #[test]
    fn an_ordinary_lamp_is_matt_and_shines_down() {
        let Luminaire { intensity, .. } = Luminaire::default();
        assert!((intensity.flux() / std::f32::consts::PI - 1.0).abs() < 0.01, "{}", intensity.flux());
        assert_eq!(intensity.share(Vec3::new(1.0, 0.0, 0.01)), 0.0);
    }
}

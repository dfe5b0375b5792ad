//! The colours that cars have.

use glam::Vec3;

/// How often cars of a colour are met, as shares of their sum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[allow(missing_docs)] // the names are the definition
pub struct CarColors {
    pub white: f64,
    pub silver: f64,
    pub gray: f64,
    pub black: f64,
    pub red: f64,
    /// Brown, beige, gold, orange and yellow.
    pub natural: f64,
    pub green: f64,
    pub blue: f64,
}

/// From this share of its brightest component on a colour is one.
const LEAST_SATURATION: f32 = 0.35;
/// Reflectances that part white, silver, grey and black.
const GRAYS: [f32; 3] = [0.55, 0.2, 0.03];
/// Hues that part red, natural colours, green, blue and red again, degrees.
const HUES_DEG: [f32; 4] = [15.0, 70.0, 170.0, 290.0];

impl CarColors {
    /// Weights to draw one of several paints (linear RGB) by: those that look alike have their colour's share together.
    pub fn weights(&self, paints: &[Vec3]) -> Vec<f64> {
        let shares = [self.white, self.silver, self.gray, self.black, self.red, self.natural, self.green, self.blue];
        let mut counts = [0u32; 8];
        paints.iter().for_each(|paint| counts[family(*paint)] += 1);
        paints.iter().map(|paint| shares[family(*paint)] / f64::from(counts[family(*paint)])).collect()
    }
}

/// The index of a colour, in the order of the fields.
fn family(paint: Vec3) -> usize {
    let (most, least) = (paint.max_element(), paint.min_element());
    if most - least < LEAST_SATURATION * most || most <= 0.0 {
        let gray = paint.element_sum() / 3.0;
        return GRAYS.iter().position(|limit| gray >= *limit).unwrap_or(3);
    }
    let spread = most - least;
    let sixths = if most == paint.x {
        (paint.y - paint.z) / spread
    } else if most == paint.y {
        2.0 + (paint.z - paint.x) / spread
    } else {
        4.0 + (paint.x - paint.y) / spread
    };
    let hue_deg = (60.0 * sixths).rem_euclid(360.0);
    4 + HUES_DEG.iter().position(|limit| hue_deg < *limit).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use glam::vec3;

    use super::*;

    #[test]
    fn paints_are_taken_for_what_people_call_them() {
        let called = [
            (vec3(0.76, 0.76, 0.74), 0),
            (vec3(0.42, 0.43, 0.44), 1),
            (vec3(0.09, 0.095, 0.1), 2),
            (vec3(0.008, 0.008, 0.009), 3),
            (Vec3::ZERO, 3),
            (vec3(0.35, 0.012, 0.015), 4),
            (vec3(0.16, 0.008, 0.02), 4),
            (vec3(0.24, 0.19, 0.12), 5),
            (vec3(0.62, 0.33, 0.015), 5),
            (vec3(0.03, 0.07, 0.04), 6),
            (vec3(0.012, 0.025, 0.08), 7),
        ];
        for (paint, expected) in called {
            assert_eq!(family(paint), expected, "{paint}");
        }
    }

    #[test]
    fn a_colour_is_as_common_as_the_place_says_in_however_many_shades() {
        let colors =
            CarColors { white: 0.4, silver: 0.1, gray: 0.1, black: 0.1, red: 0.1, natural: 0.1, green: 0.0, blue: 0.1 };
        let [white, blue, navy, green] =
            [Vec3::splat(0.7), vec3(0.02, 0.05, 0.3), vec3(0.01, 0.02, 0.08), vec3(0.03, 0.07, 0.04)];
        assert_eq!(colors.weights(&[blue, white, navy, green]), [0.05, 0.4, 0.05, 0.0]);
    }
}

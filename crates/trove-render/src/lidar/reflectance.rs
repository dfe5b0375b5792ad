//! What of a laser's light comes straight back from a surface.
//!
//! The material scatters it as it scatters all light, looked at from where it comes: Lambert's cosine for matt surfaces,
//! Oren and Nayar's brighter slant for rough ones, highlights where lacquer, metal or water face the sensor. Colours say how
//! bright things are to the eye; at 905 nm some are not.

use std::f32::consts::PI;

use glam::Vec3;
use trove_model::Class;
use trove_trace::Surface;

use crate::material::PreparedMaterial;

/// The brightest that a detector tells apart, of what a white matt surface sends back: new sheeting is far above it.
pub(super) const MOST: f32 = 100.0;
/// What leaves and blades send back at 905 nm (Jacquemoud, Baret 1990), relative to a green that is 0.1 bright.
const LEAF: f32 = 0.45;
const LEAF_GREEN: f32 = 0.1;
/// So much greener than red and blue a plant is all leaf.
const ALL_LEAF: f32 = 0.3;
/// Dyes let 905 nm pass to the fibres below, whatever their colour.
const FIBRE: f32 = 0.4;

/// Of what a white matt surface that faces the sensor sends back: 0 to [`MOST`].
pub(super) fn backscattered(surface: &Surface, material: &PreparedMaterial, class: Class, width_m: f32) -> f32 {
    let (scattered, _) = material.shade(surface, width_m, 0.5).eval(surface.wo);
    let cos = surface.wo.dot(surface.geometric).max(0.0);
    let matt = infrared(scattered * PI, class, cos);
    (matt + MOST * material.retroreflection() * cos).min(MOST)
}

/// What an RGB of backscattered light is at 905 nm.
fn infrared(rgb: Vec3, class: Class, cos: f32) -> f32 {
    // The nearest of the three.
    let red = rgb.x;
    match class {
        Class::Tree | Class::Bush | Class::Ground => {
            let green = (rgb.y - rgb.x.max(rgb.z)) / rgb.y.max(1e-6);
            let leaf = LEAF * (rgb.y / LEAF_GREEN).min(cos);
            red + (leaf - red) * (green / ALL_LEAF).clamp(0.0, 1.0)
        }
        Class::Human | Class::CycleRider | Class::MotorcycleRider => red.max((red + FIBRE * cos) / 2.0),
        _ => red,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    #[test]
    fn plants_are_bright_and_their_wood_is_not() {
        let leaf = infrared(vec3(0.04, 0.1, 0.02), Class::Tree, 1.0);
        let bark = infrared(vec3(0.12, 0.09, 0.06), Class::Tree, 1.0);
        assert!((leaf - LEAF).abs() < 1e-6 && (bark - 0.12).abs() < 1e-6, "{leaf} {bark}");
        assert_eq!(infrared(vec3(0.04, 0.1, 0.02), Class::Car, 1.0), 0.04, "green paint");
        assert!(infrared(Vec3::splat(0.01), Class::Human, 1.0) > 0.2, "black cloth");
    }
}

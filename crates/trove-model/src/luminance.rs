//! How bright a colour is.

use glam::Vec3;

/// Brightness of a linear colour (Rec. 709).
pub fn luminance(rgb: Vec3) -> f32 {
    rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

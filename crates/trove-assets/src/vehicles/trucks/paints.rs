//! Paints of what lorries and trailers carry, linear light.

use glam::{Vec3, vec3};

const WHITE: Vec3 = vec3(0.72, 0.72, 0.7);
pub(super) const BOXES: [Vec3; 6] = [WHITE, WHITE, WHITE, WHITE, vec3(0.5, 0.52, 0.54), vec3(0.03, 0.1, 0.3)];
pub(super) const CANVAS: [Vec3; 5] = [
    vec3(0.5, 0.5, 0.48),
    vec3(0.1, 0.11, 0.12),
    vec3(0.04, 0.1, 0.24),
    vec3(0.05, 0.14, 0.09),
    vec3(0.36, 0.04, 0.04),
];

pub(super) const CANOPY: [Vec3; 3] = [vec3(0.5, 0.49, 0.46), vec3(0.09, 0.12, 0.17), vec3(0.3, 0.3, 0.28)];
pub(super) const OLIVE: [Vec3; 3] = [vec3(0.09, 0.1, 0.055), vec3(0.05, 0.1, 0.07), vec3(0.06, 0.1, 0.2)];
pub(super) const TIPPERS: [Vec3; 4] =
    [vec3(0.5, 0.2, 0.02), vec3(0.06, 0.12, 0.25), vec3(0.35, 0.36, 0.36), vec3(0.3, 0.03, 0.02)];

pub(super) const MUNICIPAL: [Vec3; 4] = [vec3(0.6, 0.25, 0.02), WHITE, vec3(0.06, 0.22, 0.08), vec3(0.5, 0.5, 0.48)];
pub(super) const FIRE: [Vec3; 2] = [vec3(0.4, 0.012, 0.012), vec3(0.46, 0.02, 0.012)];
pub(super) const TANKS: [Vec3; 3] = [vec3(0.66, 0.67, 0.68), WHITE, vec3(0.1, 0.2, 0.4)];

//! Dogs.

use glam::{Vec3, vec3};
use trove_model::{Asset, Kind, Material};

use crate::shape::{Blend, Limb, Model, Shape};

/// A walking dog of a size.
pub(crate) fn assets() -> Vec<Asset> {
    vec![dog("animal/dog", 1.0), dog("animal/dog-small", 0.62)]
}

fn dog(id: &str, scale: f32) -> Asset {
    let coats = [
        vec3(0.25, 0.13, 0.06),
        vec3(0.015, 0.013, 0.012),
        vec3(0.5, 0.42, 0.3),
        vec3(0.3, 0.29, 0.28),
        vec3(0.12, 0.06, 0.03),
    ];
    let mut model = Model::default();
    let coat = model.slot(Material::plain("coat", coats[0], 0.9), &coats);
    let dark = model.slot(Material::plain("nose", Vec3::splat(0.012), 0.4), &[]);
    let limb = Limb::new;
    let mut limbs = vec![
        limb(vec3(-0.2, 0.0, 0.45), vec3(0.2, 0.0, 0.43), 0.095, 0.125).wide(Vec3::Y, 0.85),
        limb(vec3(0.22, 0.0, 0.48), vec3(0.36, 0.0, 0.64), 0.085, 0.065),
        limb(vec3(0.37, 0.0, 0.67), vec3(0.4, 0.0, 0.67), 0.078, 0.075),
        limb(vec3(0.42, 0.0, 0.65), vec3(0.53, 0.0, 0.62), 0.046, 0.034),
        limb(vec3(-0.26, 0.0, 0.49), vec3(-0.44, 0.0, 0.62), 0.03, 0.016),
    ];
    for (i, side) in [1.0, -1.0].into_iter().enumerate() {
        let swing = if i == 0 { 0.1 } else { -0.08 };
        let y = side * 0.065;
        let elbow = vec3(0.18 + swing * 0.3, y, 0.24);
        limbs.push(limb(vec3(0.2, y, 0.42), elbow, 0.055, 0.032));
        limbs.push(limb(elbow, vec3(0.19 + swing, y, 0.03), 0.03, 0.024));
        limbs.push(limb(vec3(0.19 + swing, y, 0.025), vec3(0.23 + swing, y, 0.022), 0.026, 0.022));
        let hock = vec3(-0.27 - swing * 0.6, y, 0.2);
        limbs.push(limb(vec3(-0.2, y, 0.42), vec3(-0.16 - swing * 0.3, y, 0.29), 0.075, 0.05));
        limbs.push(limb(vec3(-0.16 - swing * 0.3, y, 0.29), hock, 0.045, 0.027));
        limbs.push(limb(hock, vec3(-0.23 - swing, y, 0.03), 0.025, 0.022));
        limbs.push(limb(vec3(-0.23 - swing, y, 0.025), vec3(-0.19 - swing, y, 0.022), 0.026, 0.022));
        limbs.push(limb(vec3(0.35, side * 0.06, 0.73), vec3(0.33, side * 0.085, 0.65), 0.022, 0.02));
    }
    let mut blend = Blend::new(limbs, 0.035);
    blend.floor_m = 0.0;
    let size = Vec3::splat(scale);
    model.add(coat, blend.surface(0.02).scaled(size));
    model.add(dark, Shape::ellipsoid(vec3(0.016, 0.02, 0.016), 10).moved(vec3(0.565, 0.0, 0.635)).scaled(size));
    for side in [1.0, -1.0] {
        model.add(dark, Shape::ellipsoid(Vec3::splat(0.01), 8).moved(vec3(0.46, side * 0.04, 0.695)).scaled(size));
    }
    model.asset(id, Kind::Animal, Kind::Animal.class())
}

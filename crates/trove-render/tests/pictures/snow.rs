//! Snow on a courtyard with a roof, a tree and what stands about.

use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec2, DVec3, Vec3};
use trove_model::{Class, Material, Raster, Scene, Shot, Snow, SnowLeft};

use crate::studio::*;

/// Dark ground, a roof 3 m above it at x = 0, a crown as dense as a roof at x = 8, and a trunk at x = −8.
fn courtyard(snow: Option<Snow>) -> Scene {
    let dark = || Material { ior: 1.0, ..Material::plain("dark", Vec3::splat(0.1), 1.0) };
    let mut scene = empty(uniform(1.0));
    let mut block = |class: Class, half_m: DVec3, middle: DVec3| {
        let placement = DAffine3::from_scale_rotation_translation(half_m, DQuat::IDENTITY, middle);
        put(&mut scene, cube(), dark(), placement);
        scene.instances.last_mut().unwrap().class = class;
    };
    block(Class::Road, DVec3::new(20.0, 20.0, 0.5), DVec3::new(0.0, 0.0, -0.5));
    block(Class::Building, DVec3::new(2.0, 2.0, 0.05), DVec3::new(0.0, 0.0, 3.0));
    block(Class::Tree, DVec3::new(2.0, 2.0, 0.05), DVec3::new(8.0, 0.0, 3.0));
    block(Class::Tree, DVec3::new(0.2, 0.2, 1.5), DVec3::new(-8.0, 0.0, 1.5));
    scene.light.snow = snow;
    scene
}

#[test]
fn snow_lies_on_ground_and_roofs_and_neither_under_roofs_nor_on_trunks() {
    let left = SnowLeft { origin: DVec2::new(10.0, -20.0), cell_m: 1.0, shares: Raster::filled(10, 5, 0) };
    let scene = courtyard(Some(Snow { cover: 1.0, left: Some(Arc::new(left)) }));
    let bare = courtyard(None);
    for kernel in kernels() {
        let renderer = renderer(kernel, 2);
        let white = |eye: DVec3, target: DVec3, half_width_m: f64| {
            let shot = Shot { spp: 256, ..shot(eye, target, half_width_m) };
            let picture = take(&renderer, &scene, &shot);
            let is_white = |rgb: &&[f32; 3]| rgb[1] > 0.3;
            let labels = [&scene, &bare].map(|scene| {
                let prepared = renderer.prepare(scene).unwrap();
                let labels = renderer.render(&prepared, &shot, false, &|_| false).unwrap().labels;
                (labels.class.data, labels.instance.data, labels.depth_m.data, labels.normal.data)
            });
            assert!(labels[0] == labels[1], "{kernel:?}: labels tell of snow");
            picture.data.iter().filter(is_white).count() as f64 / picture.data.len() as f64
        };
        let at = DVec3::new;
        let open = white(at(0.0, -14.0, 8.0), at(0.0, -10.0, 0.0), 3.0);
        let roof = white(at(0.0, 0.0, 9.0), at(0.0, 0.0, 3.0), 1.8);
        let below_roof = white(at(0.0, 0.0, 2.5), at(0.0, 0.0, 0.0), 1.0);
        let below_crown = white(at(8.0, 0.0, 2.5), at(8.0, 0.0, 0.0), 1.0);
        let trunk = white(at(-8.0, -5.0, 1.5), at(-8.0, -0.2, 1.5), 0.15);
        let driven = white(at(15.0, -22.0, 8.0), at(15.0, -17.5, 0.0), 1.5);
        let shares = [open, roof, below_roof, below_crown, trunk, driven];
        assert!(open >= 0.95 && roof >= 0.95 && below_crown >= 0.95, "{kernel:?}: {shares:?}");
        assert!(below_roof < 0.01 && trunk < 0.01 && driven < 0.01, "{kernel:?}: {shares:?}");
    }
}

#[test]
fn half_a_cover_hides_half_of_the_ground() {
    let scene = courtyard(Some(Snow { cover: 0.5, left: None }));
    let picture = take(
        &renderer(trove_render::KernelChoice::Obvhs, 2),
        &scene,
        &shot(DVec3::new(0.0, -12.0, 14.0), DVec3::new(0.0, -12.0, 0.0), 7.0),
    );
    let share = (mean(&picture) - 0.1) / (0.87 - 0.1);
    assert!((share - 0.5).abs() < 0.12, "{share}");
}

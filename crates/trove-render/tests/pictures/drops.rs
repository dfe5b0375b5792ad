//! Drops on the glass before a lens.

use glam::{DAffine3, DQuat, DVec3, Vec3};
use trove_model::{Distortion, Lens, LensDrops, Material, Scene, Seed, Shot};

use crate::studio::*;

/// Refractive index of water.
const WATER: f64 = 1.333;

/// 96×64 pixels to the north.
fn view(distortion: Distortion, share: f64) -> Shot {
    let lens = Lens { width_px: 96, height_px: 64, fx_px: 80.0, fy_px: 80.0, cx_px: 48.0, cy_px: 32.0, distortion };
    let drops = (share > 0.0).then_some(LensDrops { share, seed: Seed(4) });
    Shot { lens, drops, spp: 4, ..shot(DVec3::ZERO, DVec3::Y, 0.5) }
}

/// A white ball before a dark sky.
fn ball_in_the_dark() -> Scene {
    let mut scene = empty(uniform(0.2));
    let white = Material { ior: 1.0, ..Material::plain("white", Vec3::ONE, 1.0) };
    let placement = DAffine3::from_scale_rotation_translation(DVec3::splat(2.0), DQuat::IDENTITY, DVec3::Y * 8.0);
    put(&mut scene, ball(), white, placement);
    scene
}

/// Of light that comes evenly from everywhere the share that steep drops send on to the lens: that of their base through
/// which light may come at all, less what the surface reflects (Fresnel).
fn passed(contact_deg: f64) -> f64 {
    let most = contact_deg.to_radians().sin();
    let steps = 2000;
    let ring = |i: i32| {
        let sin = (f64::from(i) + 0.5) / f64::from(steps) * most;
        let sin_air = sin * WATER;
        if sin_air >= 1.0 {
            return 0.0;
        }
        let (cos, cos_air) = ((1.0 - sin * sin).sqrt(), (1.0 - sin_air * sin_air).sqrt());
        let across = (WATER * cos - cos_air) / (WATER * cos + cos_air);
        let along = (WATER * cos_air - cos) / (WATER * cos_air + cos);
        (1.0 - 0.5 * (across * across + along * along)) * 2.0 * sin / (most * most)
    };
    (0..steps).map(ring).sum::<f64>() * most / f64::from(steps)
}

#[test]
fn in_even_surroundings_drops_take_what_they_reflect_and_mirror_and_nothing_else() {
    // Large enough a field that the mean over its drops is that of all.
    let renderer = renderer(kernels().next().unwrap(), 2);
    let fisheye = Distortion::kannala_brandt(&[]).unwrap();
    let picture = take(&renderer, &empty(uniform(1.0)), &view(fisheye, 0.3));
    assert!(picture.data.iter().flatten().all(|c| (0.0..1.0001).contains(c)), "a drop adds light");
    let left = f64::from(mean(&picture));
    let [most, least] = [60.0, 80.0].map(|contact_deg| 1.0 - 0.3 * (1.0 - passed(contact_deg)));
    assert!(left > least - 0.02 && left < most + 0.02, "{left}, expected {least} to {most}");
}

#[test]
fn a_pixel_without_drops_keeps_its_bytes_and_labels_know_of_none() {
    let (renderer, scene) = (renderer(kernels().next().unwrap(), 2), ball_in_the_dark());
    let prepared = renderer.prepare(&scene).unwrap();
    for distortion in [Distortion::None, Distortion::kannala_brandt(&[0.02]).unwrap(), Distortion::Equirectangular] {
        let [dry, wet] = [0.0, 0.01].map(|share| {
            let capture = renderer.render(&prepared, &view(distortion, share), true, &|_| false).unwrap();
            (capture.color.unwrap().radiance.data, capture.labels)
        });
        let same = dry.0.iter().zip(&wet.0).filter(|(dry, wet)| dry == wet).count() as f64 / dry.0.len() as f64;
        assert!((0.2..0.99).contains(&same), "{same} of the pixels are the same with {}", distortion.name());
        let labels = [dry.1, wet.1].map(|l| (l.class.data, l.instance.data, l.depth_m.data, l.normal.data));
        assert!(labels[0] == labels[1], "labels tell of drops");
    }
}

#[test]
fn drops_stay_on_the_glass_and_are_others_on_another_glass() {
    let (renderer, scene) = (renderer(kernels().next().unwrap(), 2), empty(uniform(1.0)));
    let shot = view(Distortion::None, 0.2);
    let seen = |seed: u64, drops: u64, eye: DVec3| {
        let drops = Some(LensDrops { share: 0.2, seed: Seed(drops) });
        let pose = trove_model::Pose::new(shot.world_from_camera.rotation, eye);
        take(&renderer, &scene, &Shot { seed: Seed(seed), drops, world_from_camera: pose, ..shot.clone() })
    };
    let first = seen(1, 4, DVec3::ZERO);
    let differs = |other: Picture| {
        let apart = first.data.iter().zip(&other.data).map(|(a, b)| (a[1] - b[1]).abs());
        apart.fold(0.0, f32::max)
    };
    assert!(differs(seen(2, 4, DVec3::new(5.0, 20.0, 1.0))) < 0.01);
    assert!(differs(seen(1, 5, DVec3::ZERO)) > 0.1);
}

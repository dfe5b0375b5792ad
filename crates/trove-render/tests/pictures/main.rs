//! Pictures whose radiance is known in closed form, pictures that must be equal, and pictures of small sets that are held
//! to converged ones and to those of a plain path tracer.

#![allow(clippy::unwrap_used)] // its functions are tests too

mod converged;
mod drops;
mod field;
mod plain;
mod sets;
mod snow;
mod studio;

use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3, Vec3, vec3};
use trove_model::{
    Beam, Class, ColorSpace, EnvironmentMap, Fog, Form, InstanceId, Lens, Material, Mesh, Precipitation, Puff, Scene,
    Shot, Texture,
};
use trove_render::{KernelChoice, RenderError, Renderer};

use studio::*;

#[test]
fn a_white_ball_in_a_white_world_cannot_be_seen() {
    let white = |roughness: f32| Material::plain("white", Vec3::ONE, roughness);
    // Layers below others are scaled for one direction alone, which keeps energy to some percent.
    let sorts = [
        ("Lambert", Material { ior: 1.0, ..white(1.0) }, 1e-3),
        ("plaster", white(1.0), 0.01),
        ("plastic", white(0.3), 0.01),
        ("metal", Material { metalness: 1.0, ..white(0.5) }, 0.01),
        ("mirror", Material { metalness: 1.0, ..white(0.0) }, 0.01),
        ("car paint", Material { coat: 1.0, flakes: 1.0, ..white(0.4) }, 0.03),
        ("cloth", Material { sheen: 1.0, ..white(1.0) }, 0.03),
        ("leaf", Material { translucency: 0.5, ..white(0.5) }, 0.02),
        ("wet stone", Material { wetness: 0.4, ..white(0.8) }, 0.05),
    ];
    for (name, material, tolerance) in sorts {
        let picture = look(&renderer(KernelChoice::Obvhs, 2), &scene(ball(), material), 1024, 0.8);
        let mean = mean(&picture);
        assert!((mean - 1.0).abs() < tolerance, "{name}: {mean}");
    }
}

#[test]
fn a_black_ball_in_fog_fades_by_koschmieder_s_law_into_white() {
    let fog = Fog { visibility_m: 100.0, height_m: 60.0, ground_z_m: 0.0 };
    let black = || Material { ior: 1.0, ..Material::plain("black", Vec3::ZERO, 1.0) };
    let renderer = renderer(KernelChoice::Obvhs, 2);
    for away_m in [20.0, 50.0] {
        // So small that fog, which mostly sends light onwards, hardly misses what the ball keeps back; and a grain of dust that
        // says where fog ends below.
        let mut scene = empty(uniform(1.0));
        scene.light.fog = Some(fog);
        let at = |y: f64, z: f64, size: f64| {
            DAffine3::from_scale_rotation_translation(DVec3::splat(size), DQuat::IDENTITY, DVec3::new(0.0, y, z))
        };
        put(&mut scene, ball(), black(), at(away_m, 0.0, 0.001));
        put(&mut scene, ball(), black(), at(0.0, -30.0, 0.01));
        let toward = |z: f64, spp: u32| {
            let shot = shot(DVec3::ZERO, DVec3::new(0.0, away_m, z), 0.0006);
            mean(&take(&renderer, &scene, &Shot { spp, ..shot }))
        };
        let expected = 1.0 - (-20.0f64.ln() * away_m / 100.0).exp() as f32;
        let (on_it, beside) = (toward(0.0, 1536), toward(3.0, 512));
        assert!((on_it / expected - 1.0).abs() < 0.01, "{away_m} m: {on_it} instead of {expected}");
        assert!((beside - 1.0).abs() < 0.01, "{away_m} m: {beside} beside it");
    }
}

#[test]
fn spray_takes_the_place_of_what_is_behind_it_as_its_thickness_says_and_is_white_in_a_white_world() {
    let puff = |y: f64| Puff { centre: DVec3::new(0.0, y, 0.2), radius_m: [1.0, 0.8], extinction_per_m: 0.6 };
    let puffs = vec![puff(6.0), puff(7.1)];
    let depth: f64 = puffs.iter().map(|puff| puff.optical_depth(DVec3::ZERO, DVec3::Y, 20.0)).sum();
    let mut scene = empty(uniform(1.0));
    let away = DAffine3::from_scale_rotation_translation(DVec3::splat(0.001), DQuat::IDENTITY, DVec3::Y * 20.0);
    put(&mut scene, ball(), Material { ior: 1.0, ..Material::plain("black", Vec3::ZERO, 1.0) }, away);
    scene.light.spray = vec![puffs];
    let toward = |z: f64| {
        let shot = shot(DVec3::ZERO, DVec3::new(0.0, 20.0, z), 0.0006);
        mean(&take(&renderer(KernelChoice::Obvhs, 2), &scene, &Shot { spp: 1024, ..shot }))
    };
    let (on_it, beside, expected) = (toward(0.0), toward(0.3), 1.0 - (-depth).exp() as f32);
    assert!((0.4..0.8).contains(&expected) && (on_it / expected - 1.0).abs() < 0.02, "{on_it} instead of {expected}");
    assert!((beside - 1.0).abs() < 1e-3, "{beside}");
}

#[test]
fn the_sun_lights_the_ground_below_fog_as_photons_that_meet_every_droplet_say() {
    // 40° up, in a black sky.
    let (width, height, elevation_deg) = (720, 360, 40.25f64);
    let mut sky = EnvironmentMap { name: "sun".into(), width, height, rgb: vec![[0.0; 3]; 720 * 360] };
    let row = (2.0 * (90.0 - elevation_deg)) as usize;
    sky.rgb[row * 720 + 360] = [1e5; 3];
    let mut scene = empty(sky);
    let albedo = 0.3;
    let matt = Material { ior: 1.0, ..Material::plain("matt", Vec3::splat(albedo), 1.0) };
    let level = DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    put(&mut scene, wall(), matt, DAffine3::from_scale_rotation_translation(DVec3::splat(800.0), level, DVec3::ZERO));
    let shot = Shot { spp: 512, ..shot(DVec3::Z * 0.02, DVec3::Y * 0.001, 0.005) };
    let mut seen = |fog: Option<Fog>| {
        scene.light.fog = fog;
        f64::from(mean(&take(&renderer(KernelChoice::Obvhs, 2), &scene, &shot)))
    };
    let clear = seen(None);
    let found = seen(Some(Fog { visibility_m: 30.0, height_m: 20.0, ground_z_m: 0.0 })) / clear;
    let (depth, height) = (20.0f64.ln() / 30.0 * 20.0, elevation_deg.to_radians().sin());
    let expected = plain::hits_below_fog(depth, 0.85, height, f64::from(albedo), 400_000);
    // Droplets that are taken together, and the most that a sample may bring, lose two hundredths of this light.
    assert!((found / expected - 1.0).abs() < 0.03, "{found} instead of {expected}");
}

#[test]
fn rain_in_a_white_world_is_not_seen_and_before_a_black_wall_it_is() {
    let renderer = renderer(KernelChoice::Obvhs, 2);
    let mut scene = empty(uniform(1.0));
    scene.light.falling = Some(Precipitation { form: Form::Rain, rate_mm_h: 60.0 });
    let shot = Shot { spp: 64, ..shot(DVec3::ZERO, DVec3::Y, 0.5) };
    let black = || Material { ior: 1.0, ..Material::plain("black", Vec3::ZERO, 1.0) };
    let at = |y: f64, z: f64, size: f64| {
        DAffine3::from_scale_rotation_translation(DVec3::splat(size), DQuat::IDENTITY, DVec3::new(0.0, y, z))
    };
    // A grain of dust that says where rain ends below.
    put(&mut scene, ball(), black(), at(0.0, -30.0, 0.01));
    let white = mean(&take(&renderer, &scene, &shot));
    assert!((white - 1.0).abs() < 0.01, "{white}");
    put(&mut scene, ball(), black(), at(25.0, 0.0, 14.0));
    let before_black = take(&renderer, &scene, &shot);
    // Streaks stand out from the air between them.
    let mut values: Vec<f32> = before_black.data.iter().map(|rgb| rgb[1]).collect();
    values.sort_by(f32::total_cmp);
    let [middle, bright] = [0.5, 0.99].map(|share| values[(values.len() as f64 * share) as usize]);
    assert!(middle < 0.2 && bright > middle + 0.02, "{middle} {bright}");
}

#[test]
fn rain_splashes_on_a_road_and_not_on_leaves() {
    let seen = |class: Class| {
        let mut scene = empty(uniform(1.0));
        let wide = DAffine3::from_scale(DVec3::splat(30.0)) * DAffine3::from_translation(DVec3::NEG_Z);
        put(&mut scene, cube(), Material { ior: 1.0, ..Material::plain("black", Vec3::ZERO, 1.0) }, wide);
        scene.instances[0].class = class;
        scene.light.falling = Some(Precipitation { form: Form::Rain, rate_mm_h: 100.0 });
        let shot = shot(DVec3::new(0.0, 0.0, 0.5), DVec3::new(0.0, 1.0, 0.0), 0.15);
        let (fx_px, fy_px) = (8.0 * shot.lens.fx_px, 8.0 * shot.lens.fy_px);
        let lens = Lens { width_px: 128, height_px: 128, fx_px, fy_px, cx_px: 64.0, cy_px: 64.0, ..shot.lens };
        take(&renderer(KernelChoice::Obvhs, 2), &scene, &Shot { lens, spp: 4, ..shot })
    };
    let [road, leaves] = [Class::Road, Class::Tree].map(seen);
    let brighter = |(a, b): (&[f32; 3], &[f32; 3])| a[1] - b[1];
    let by_splashes: Vec<f32> = road.data.iter().zip(&leaves.data).map(brighter).collect();
    let share = by_splashes.iter().filter(|b| **b > 1e-3).count() as f32 / by_splashes.len() as f32;
    assert!((0.05..0.95).contains(&share), "{share}");
}

#[test]
fn a_grey_ball_in_a_white_world_is_as_bright_as_its_albedo() {
    let grey = Material { ior: 1.0, ..Material::plain("grey", Vec3::splat(0.5), 1.0) };
    let picture = look(&renderer(KernelChoice::Obvhs, 2), &scene(ball(), grey), 16, 0.2);
    // Seen from the front a rough ball is a little darker than from all sides.
    assert!((mean(&picture) - 0.5).abs() < 0.01, "{}", mean(&picture));
}

#[test]
fn a_glowing_room_is_as_bright_as_its_bounces_add_up() {
    for (albedo, emission) in [(0.2, 0.8), (0.5, 0.25), (0.8, 0.2)] {
        let glow =
            Material { emission: Vec3::splat(emission), ior: 1.0, ..Material::plain("glow", Vec3::splat(albedo), 0.0) };
        let around_camera = DAffine3::from_scale_rotation_translation(DVec3::splat(2.0), DQuat::IDENTITY, EYE);
        let mut scene = empty(uniform(1.0));
        put(&mut scene, inside_out(cube()), glow, around_camera);
        let picture = look(&renderer(KernelChoice::Obvhs, 2), &scene, 64, 0.8);
        // e / (1 − a) without what comes over more than 7 surfaces.
        let expected = emission / (1.0 - albedo) * (1.0 - albedo.powi(8));
        assert!((mean(&picture) / expected - 1.0).abs() < 0.01, "{} instead of {expected}", mean(&picture));
    }
}

#[test]
fn a_lamp_shines_forwards_alone() {
    let lamp = Material { emission: Vec3::ONE, ..Material::plain("lamp", Vec3::ZERO, 1.0) };
    for kernel in kernels() {
        let from = |eye: DVec3| take(&renderer(kernel, 1), &scene(wall(), lamp.clone()), &shot(eye, DVec3::ZERO, 0.2));
        let [front, back] = [EYE, -EYE].map(|eye| mean(&from(eye)));
        assert!(front > 0.99 && back < 0.2, "{kernel:?}: {front}, {back}");
    }
}

#[test]
fn a_clear_pane_in_a_white_world_cannot_be_seen() {
    let glass = Material { transmission: 1.0, ..Material::plain("glass", Vec3::ONE, 0.0) };
    let picture = look(&renderer(KernelChoice::Obvhs, 2), &scene(wall(), glass), 16, 0.2);
    assert!((mean(&picture) - 1.0).abs() < 0.01, "{}", mean(&picture));
}

#[test]
fn light_falls_through_holes_and_not_beside_them() {
    let mut chequered =
        Texture { name: "chequered".into(), width: 64, height: 64, rgba: Vec::new(), color_space: ColorSpace::Srgb };
    // Left half open, right half closed.
    chequered.rgba = (0..64 * 64).map(|i| [0, 0, 0, if i % 64 < 32 { 0 } else { 255 }]).collect();
    let leaf = Material {
        base_color_map: Some(Arc::new(chequered)),
        alpha_cutoff: 0.5,
        ior: 1.0,
        ..Material::plain("leaf", Vec3::ONE, 1.0)
    };
    for kernel in kernels() {
        let picture = look(&renderer(kernel, 1), &scene(wall(), leaf.clone()), 4, 0.2);
        let (left, right) = (picture.at(2, 8)[0], picture.at(13, 8)[0]);
        assert!((left - 1.0).abs() < 1e-3 && right < 1e-3, "{kernel:?}: {left}, {right}");
    }
}

#[test]
fn one_thread_and_two_give_the_same_bytes() {
    for kernel in kernels() {
        let [one, two] = [1, 2].map(|threads| look(&renderer(kernel, threads), &crowd(), 4, 0.6));
        assert!(one == two, "{kernel:?}");
    }
}

#[test]
fn all_kernels_see_the_same() {
    let pictures: Vec<_> = kernels().map(|kernel| look(&renderer(kernel, 2), &crowd(), 16, 0.6)).collect();
    for other in &pictures[1..] {
        let pairs = pictures[0].data.iter().flatten().zip(other.data.iter().flatten());
        let difference: f32 = pairs.map(|(a, b)| (a - b).abs()).sum::<f32>() / other.data.len() as f32;
        assert!(difference < 0.01, "{difference}");
    }
}

#[test]
fn the_carrier_is_not_seen_by_its_camera() {
    let mut shot = Shot { spp: 4, ..shot(EYE, DVec3::ZERO, 0.2) };
    let scene = scene(wall(), Material::plain("black", Vec3::ZERO, 1.0));
    let renderer = renderer(KernelChoice::Obvhs, 1);
    let prepared = renderer.prepare(&scene).unwrap();
    shot.carrier = Some(InstanceId(1));
    let seen = renderer.render(&prepared, &shot, true, &|_| false).unwrap().color.unwrap().radiance;
    assert!((mean(&seen) - 1.0).abs() < 1e-3);
}

#[test]
fn a_mesh_with_nan_is_refused_by_name() {
    let mut mesh = ball();
    mesh.positions[3].x = f32::NAN;
    let refused = renderer(KernelChoice::Obvhs, 1).prepare(&scene(mesh, Material::default()));
    let Err(RenderError::Scene { place, .. }) = refused else { panic!("accepted") };
    assert_eq!(place, "mesh 0");
}

#[test]
fn an_empty_scene_and_an_empty_mesh_are_no_trouble() {
    for kernel in kernels() {
        let renderer = renderer(kernel, 1);
        let mut nothing = scene(Mesh::default(), Material::default());
        assert!((mean(&look(&renderer, &nothing, 1, 0.2)) - 1.0).abs() < 1e-3);
        nothing.instances.clear();
        assert!((mean(&look(&renderer, &nothing, 1, 0.2)) - 1.0).abs() < 1e-3);
    }
}

#[test]
fn a_stopped_picture_is_none() {
    let renderer = renderer(KernelChoice::Obvhs, 1);
    let prepared = renderer.prepare(&crowd()).unwrap();
    assert!(renderer.render(&prepared, &shot(EYE, DVec3::ZERO, 0.6), true, &|_| true).is_none());
}

/// Where the camera of most tests stands, looking north.
const EYE: DVec3 = DVec3::new(0.0, -4.0, 0.0);

/// A picture of what is at the origin, `half_width_m` of which are seen to each side.
fn look(renderer: &Renderer, scene: &Scene, spp: u32, half_width_m: f64) -> Picture {
    take(renderer, scene, &Shot { spp, ..shot(EYE, DVec3::ZERO, half_width_m) })
}

/// One thing at the origin in a world that is white all around.
fn scene(mesh: Mesh, material: Material) -> Scene {
    let mut scene = empty(uniform(1.0));
    put(&mut scene, mesh, material, DAffine3::IDENTITY);
    scene
}

/// Turned, mirrored and stretched balls.
fn crowd() -> Scene {
    let mut scene = scene(ball(), Material { coat: 1.0, ..Material::plain("paint", vec3(0.6, 0.1, 0.1), 0.4) });
    for i in 1..6u32 {
        let turn = DQuat::from_rotation_y(f64::from(i));
        let size = DVec3::new(0.2, 0.3, if i % 2 == 0 { 0.2 } else { -0.4 });
        let place = DVec3::new(0.2 * f64::from(i) - 0.6, -0.5, 0.3);
        let mut another = scene.instances[0].clone();
        another.id = InstanceId(i + 1);
        another.world_from_mesh = DAffine3::from_scale_rotation_translation(size, turn, place);
        scene.instances.push(another);
    }
    scene
}

#[test]
fn a_beam_lights_a_wall_as_its_table_says() {
    let beam =
        Beam::new(vec![-20.0, 0.0, 20.0], vec![-5.0, 0.0, 10.0], vec![0.1, 0.8, 0.3, 0.2, 1.0, 0.6, 0.0, 0.05, 0.0]);
    let beam = beam.unwrap();
    // 10 cm wide, its front along the mesh's x, which looks north.
    let front = Mesh {
        positions: vec![vec3(0.0, -0.05, -0.05), vec3(0.0, 0.05, -0.05), vec3(0.0, 0.05, 0.05), vec3(0.0, -0.05, 0.05)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let lamp = Material {
        emission: Vec3::splat(50.0),
        beam: Some(Arc::new(beam.clone())),
        ..Material::plain("lamp", Vec3::ZERO, 1.0)
    };
    let mut scene = empty(uniform(0.0));
    put(&mut scene, front, lamp, DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_2));
    let white = Material { ior: 1.0, ..Material::plain("white", Vec3::splat(0.5), 0.0) };
    let far = DAffine3::from_scale_rotation_translation(DVec3::splat(8.0), DQuat::IDENTITY, DVec3::Y * 10.0);
    put(&mut scene, wall(), white, far);
    for kernel in kernels() {
        let renderer = renderer(kernel, 2);
        for (left_deg, up_deg) in [(0.0f64, 0.0f64), (10.0, 0.0), (-10.0, 0.0), (0.0, 5.0), (5.0, -2.5), (-15.0, -5.0)]
        {
            let [left, up] = [left_deg, up_deg].map(|a| a.to_radians());
            let toward = DVec3::new(-left.sin() * up.cos(), left.cos() * up.cos(), up.sin());
            let point = toward * (10.0 / toward.y);
            let view = Shot { spp: 256, ..shot(DVec3::new(2.0, 4.0, 3.0), point, 0.02) };
            let found = mean(&take(&renderer, &scene, &view));
            let share =
                beam.share(Vec3::new((left.cos() * up.cos()) as f32, (left.sin() * up.cos()) as f32, up.sin() as f32));
            // Both face along y.
            let expected = 0.5 / std::f64::consts::PI * 50.0 * 0.01 * toward.y.powi(2) / point.length_squared();
            let expected = expected as f32 * share;
            assert!((found / expected - 1.0).abs() < 0.02, "{kernel:?} {left_deg}° {up_deg}°: {found} {expected}");
        }
    }
}

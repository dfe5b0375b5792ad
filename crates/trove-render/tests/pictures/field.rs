//! Fog whose light is read from a field, held to fog in which every droplet is met.

use glam::{DAffine3, DVec3, Vec3};
use trove_model::{Environment, Fog, Material, Mesh, PhysicalSky, Scene, Seed, Shot};
use trove_render::KernelChoice;

use crate::sets::{self, quad};
use crate::studio::{empty, mean, put, renderer, shot, take, uniform};

/// Level ground in fog under a clear sky; two rows of walls leave a street between them where they are asked for.
fn street(albedo: f32, has_walls: bool) -> Scene {
    let mut scene = empty(uniform(0.0));
    scene.light.environment = Environment::Sky(PhysicalSky {
        to_sun: DVec3::new(0.3, -0.6, 0.7).normalize(),
        moon: None,
        turbidity: 3.0,
        ground_albedo: 0.2,
        cloud_cover: 0.0,
        cloud_seed: 4,
    });
    scene.light.fog = Some(Fog { visibility_m: 200.0, height_m: 50.0, ground_z_m: 0.0 });
    let matt = |albedo: f32| Material::plain("matt", Vec3::splat(albedo), 1.0);
    let ground: Mesh = quad(Vec3::new(-2000.0, -2000.0, 0.0), Vec3::X * 4000.0, Vec3::Y * 4000.0);
    put(&mut scene, ground, matt(albedo), DAffine3::IDENTITY);
    if has_walls {
        for side in [-1.0, 1.0] {
            let wall: Mesh = quad(Vec3::new(10.0 * side, 200.0 * side, 0.0), Vec3::Y * (-400.0 * side), Vec3::Z * 20.0);
            put(&mut scene, wall, matt(0.3), DAffine3::IDENTITY);
        }
    }
    scene
}

/// At a height of 1.6 m.
fn towards(x: f64, y: f64, z: f64) -> Shot {
    let eye = DVec3::Z * 1.6;
    shot(eye, eye + DVec3::new(x, y, z), 0.05)
}

#[test]
fn light_that_is_read_is_the_light_that_droplets_send_on() {
    let renderer = renderer(KernelChoice::Obvhs, 2);
    let away = towards(0.0, 1.0, 0.0);
    let to_sun = towards(0.0, -1.0, 0.0);
    let upwards = towards(0.0, 1.0, 1.0);
    let wall = towards(1.0, 0.0, 0.0);
    // Along a street the coarse grids' nodes behind its walls let too much light in.
    let cases = [
        ("black ground, from the sun", street(0.0, false), &away, 0.03),
        ("black ground, to the sun", street(0.0, false), &to_sun, 0.03),
        ("white ground, to the sun", street(0.8, false), &to_sun, 0.03),
        ("white ground, upwards", street(0.8, false), &upwards, 0.03),
        ("a wall", street(0.5, true), &wall, 0.04),
        ("along walls", street(0.5, true), &to_sun, 0.15),
    ];
    for (name, scene, shot, most) in cases {
        let seen = |cache| mean(&take(&renderer, &scene, &Shot { cache, spp: 200, seed: Seed(3), ..shot.clone() }));
        let (followed, read) = (seen(false), seen(true));
        assert!((read / followed - 1.0).abs() < most, "{name}: {read} instead of {followed}");
    }
}

#[test]
fn light_that_is_read_has_less_noise_and_is_the_same_for_any_number_of_threads() {
    let (scene, shot) = (street(0.5, true), towards(0.3, 1.0, -0.2));
    let picture = |cache, threads| {
        let renderer = renderer(KernelChoice::Obvhs, threads);
        take(&renderer, &scene, &Shot { cache, spp: 8, ..shot.clone() })
    };
    let spread = |cache| {
        let picture = picture(cache, 2);
        let mean = mean(&picture);
        picture.data.iter().map(|rgb| (rgb[1] / mean - 1.0).powi(2)).sum::<f32>()
    };
    let (followed, read) = (spread(false), spread(true));
    assert!(2.0 * read < followed, "{read} and {followed}");
    assert_eq!(picture(true, 1).data, picture(true, 2).data);
}

#[test]
fn in_clear_air_nothing_is_read() {
    let renderer = renderer(KernelChoice::Obvhs, 2);
    for set in sets::all() {
        let picture = |cache| take(&renderer, &set.scene, &Shot { cache, spp: 4, ..set.shot.clone() });
        assert_eq!(picture(true).data, picture(false).data, "{}", set.name);
    }
}

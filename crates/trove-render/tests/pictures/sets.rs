//! Six small sets, each of which shows one way of light.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3, Vec2, Vec3, vec3};
use trove_model::{ColorSpace, EnvironmentMap, Material, Mesh, Scene, Seed, Shot, Texture};

use crate::studio::{ball, cube, empty, inside_out, put, shot, uniform};

/// A scene and how it is looked at.
pub(crate) struct Set {
    /// Of its reference.
    pub(crate) name: &'static str,
    pub(crate) scene: Scene,
    pub(crate) shot: Shot,
}

/// All of them.
pub(crate) fn all() -> [Set; 6] {
    [sun_and_shadow(), window(), car_paint(), leaves(), lamps(), coloured_corner()]
}

/// A box on the ground in the evening sun, and a wall behind it.
pub(crate) fn sun_and_shadow() -> Set {
    let mut scene = empty(sky(0.3, Some(3.0)));
    put(&mut scene, ground(), plaster(vec3(0.3, 0.28, 0.25)), DAffine3::IDENTITY);
    put(
        &mut scene,
        quad(vec3(-3.0, 2.0, 0.0), Vec3::X * 6.0, Vec3::Z * 1.5),
        plaster(vec3(0.6, 0.5, 0.4)),
        DAffine3::IDENTITY,
    );
    put(&mut scene, cube(), plaster(vec3(0.2, 0.3, 0.5)), block(DVec3::new(0.2, 0.3, 0.5), DVec3::splat(0.5)));
    Set { name: "sun-and-shadow", scene, shot: shot(DVec3::new(-1.0, -6.0, 3.0), DVec3::new(0.3, 0.5, 0.6), 2.2) }
}

/// A room that is lit through a window.
fn window() -> Set {
    let mut scene = empty(sky(0.5, Some(2.0)));
    let walls = [
        quad(vec3(-2.0, -2.0, 0.0), Vec3::X * 4.0, Vec3::Y * 4.0),
        quad(vec3(-2.0, -2.0, 2.5), Vec3::Y * 4.0, Vec3::X * 4.0),
        quad(vec3(-2.0, 2.0, 0.0), Vec3::X * 4.0, Vec3::Z * 2.5),
        quad(vec3(-2.0, -2.0, 0.0), Vec3::Y * 4.0, Vec3::Z * 2.5),
        quad(vec3(2.0, 2.0, 0.0), -Vec3::Y * 4.0, Vec3::Z * 2.5),
        // Around the opening, 2 m × 1.4 m.
        quad(vec3(2.0, -2.0, 0.0), -Vec3::X * 4.0, Vec3::Z * 0.7),
        quad(vec3(2.0, -2.0, 2.1), -Vec3::X * 4.0, Vec3::Z * 0.4),
        quad(vec3(-1.0, -2.0, 0.7), -Vec3::X, Vec3::Z * 1.4),
        quad(vec3(2.0, -2.0, 0.7), -Vec3::X, Vec3::Z * 1.4),
    ];
    for wall in walls {
        put(&mut scene, wall, plaster(vec3(0.6, 0.55, 0.5)), DAffine3::IDENTITY);
    }
    let pane = Material { transmission: 1.0, ..Material::plain("pane", vec3(0.9, 0.95, 0.92), 0.0) };
    put(&mut scene, quad(vec3(1.0, -2.0, 0.7), -Vec3::X * 2.0, Vec3::Z * 1.4), pane, DAffine3::IDENTITY);
    Set { name: "window", scene, shot: shot(DVec3::new(-1.5, 1.7, 1.5), DVec3::new(0.4, -1.5, 0.7), 2.5) }
}

/// Lacquer over flakes, and rough metal, under a sky with the sun in it.
fn car_paint() -> Set {
    let mut scene = empty(sky(0.5, Some(3.0)));
    let paint = Material { coat: 1.0, flakes: 1.0, ..Material::plain("paint", vec3(0.5, 0.05, 0.04), 0.4) };
    let metal = Material { metalness: 1.0, ..Material::plain("metal", vec3(0.9, 0.7, 0.4), 0.45) };
    put(&mut scene, ground(), plaster(Vec3::splat(0.25)), DAffine3::IDENTITY);
    put(&mut scene, ball(), paint, block(DVec3::new(-0.9, 0.0, 0.8), DVec3::splat(0.8)));
    put(&mut scene, ball(), metal, block(DVec3::new(0.9, 0.0, 0.8), DVec3::splat(0.8)));
    Set { name: "car-paint", scene, shot: shot(DVec3::new(0.0, -6.0, 2.0), DVec3::Z * 0.7, 2.0) }
}

/// Leaves that are cut out of cards and let light through.
fn leaves() -> Set {
    let mut scene = empty(sky(0.4, Some(3.0)));
    put(&mut scene, ground(), plaster(vec3(0.2, 0.18, 0.15)), DAffine3::IDENTITY);
    let texel = |i: i32| {
        let (x, y) = (f64::from(i % 64) / 31.5 - 1.0, f64::from(i / 64) / 31.5 - 1.0);
        [200, 220, 150, if x * x + 4.0 * y * y < 1.0 { 255 } else { 0 }]
    };
    let ellipse = Texture {
        name: "ellipse".into(),
        width: 64,
        height: 64,
        rgba: (0..64 * 64).map(texel).collect(),
        color_space: ColorSpace::Srgb,
    };
    let leaf = Material {
        base_color_map: Some(Arc::new(ellipse)),
        alpha_cutoff: 0.5,
        translucency: 0.5,
        ..Material::plain("leaf", vec3(0.4, 0.7, 0.2), 0.5)
    };
    let mut random = Seed(3).random();
    for _ in 0..40 {
        let mut between = |low, high| random.range(low, high);
        let at = DVec3::new(between(-1.2, 1.2), between(-0.8, 0.8), between(0.3, 2.0));
        let turn = DQuat::from_euler(glam::EulerRot::XYZ, between(-1.5, 1.5), between(-0.6, 0.6), between(-1.5, 1.5));
        let card = DAffine3::from_scale_rotation_translation(DVec3::splat(0.4), turn, at);
        put(&mut scene, crate::studio::wall(), leaf.clone(), card);
    }
    Set { name: "leaves", scene, shot: shot(DVec3::new(1.0, -5.0, 2.0), DVec3::Z * 0.9, 1.5) }
}

/// Lamps of unlike brightness along a wall at dusk.
fn lamps() -> Set {
    let mut scene = empty(sky(0.3, None));
    put(&mut scene, ground(), plaster(Vec3::splat(0.4)), DAffine3::IDENTITY);
    put(
        &mut scene,
        quad(vec3(-4.0, 1.5, 0.0), Vec3::X * 8.0, Vec3::Z * 3.0),
        plaster(Vec3::splat(0.5)),
        DAffine3::IDENTITY,
    );
    for i in 0..14 {
        let brightness = [4.0, 1.0, 2.0][i % 3];
        let lamp =
            Material { emission: vec3(1.0, 0.7, 0.4) * brightness, ..Material::plain("lamp", Vec3::splat(0.05), 1.0) };
        let at = DVec3::new(0.6 * i as f64 - 4.0, if i % 2 == 0 { 1.2 } else { 0.2 }, 0.6 + 0.3 * (i % 4) as f64);
        put(&mut scene, cube(), lamp, block(at, DVec3::splat(0.12)));
    }
    Set { name: "lamps", scene, shot: shot(DVec3::new(0.0, -6.0, 3.0), DVec3::new(0.0, 1.0, 0.6), 2.5) }
}

/// A closed room with a red wall, a green one and a lamp in the ceiling.
fn coloured_corner() -> Set {
    let mut scene = empty(uniform(1.0));
    put(&mut scene, inside_out(cube()), plaster(Vec3::splat(0.7)), block(DVec3::Z, DVec3::ONE));
    let beside = |x: f32| quad(vec3(x, x.signum(), 0.0), Vec3::Y * -2.0 * x.signum(), Vec3::Z * 2.0);
    put(&mut scene, beside(-0.99), plaster(vec3(0.6, 0.05, 0.05)), DAffine3::IDENTITY);
    put(&mut scene, beside(0.99), plaster(vec3(0.05, 0.5, 0.08)), DAffine3::IDENTITY);
    let turned = DQuat::from_rotation_z(0.4);
    let tall =
        DAffine3::from_scale_rotation_translation(DVec3::new(0.25, 0.25, 0.5), turned, DVec3::new(0.3, 0.3, 0.5));
    put(&mut scene, cube(), plaster(Vec3::splat(0.7)), tall);
    let lamp = Material { emission: Vec3::splat(5.0), ..Material::plain("lamp", Vec3::splat(0.1), 1.0) };
    put(&mut scene, cube(), lamp, block(DVec3::new(0.0, 0.0, 1.9), DVec3::new(0.3, 0.3, 0.02)));
    Set { name: "coloured-corner", scene, shot: shot(DVec3::new(0.0, -0.95, 1.0), DVec3::new(0.0, 1.0, 0.9), 1.6) }
}

fn plaster(color: Vec3) -> Material {
    Material::plain("plaster", color, 1.0)
}

pub(crate) fn block(middle: DVec3, half_m: DVec3) -> DAffine3 {
    DAffine3::from_scale_rotation_translation(half_m, DQuat::IDENTITY, middle)
}

/// A square of 40 m that looks up.
fn ground() -> Mesh {
    quad(vec3(-20.0, -20.0, 0.0), Vec3::X * 40.0, Vec3::Y * 40.0)
}

/// A parallelogram that looks along u × v.
pub(crate) fn quad(corner: Vec3, u: Vec3, v: Vec3) -> Mesh {
    Mesh {
        positions: vec![corner, corner + u, corner + u + v, corner + v],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// A blue sky of some radiance at the zenith; the sun, of some irradiance, stands 35° high in the south-west.
fn sky(zenith: f32, sun: Option<f32>) -> EnvironmentMap {
    let (width, height) = (256u32, 128u32);
    let row = |y: u32| {
        let up = (FRAC_PI_2 - std::f64::consts::PI * (f64::from(y) + 0.5) / f64::from(height)).sin() as f32;
        let color = if up > 0.0 { vec3(0.7, 0.9, 1.3) * (1.5 - 0.5 * up) } else { Vec3::splat(0.3) };
        [(color * zenith).to_array(); 256]
    };
    let mut rgb: Vec<[f32; 3]> = (0..height).flat_map(row).collect();
    if let Some(irradiance) = sun {
        let (x, y) = (213, 39);
        let from_zenith = std::f32::consts::PI * (y as f32 + 0.5) / height as f32;
        let solid_angle = (std::f32::consts::PI / height as f32).powi(2) * from_zenith.sin();
        rgb[y * width as usize + x] = (vec3(1.1, 1.0, 0.8) * (irradiance / solid_angle)).to_array();
    }
    EnvironmentMap { name: "sky".into(), width, height, rgb }
}

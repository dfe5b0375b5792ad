//! Drops and flakes before the camera: each draws a streak while light is gathered, as bright as what it refracts or
//! scatters.
//!
//! A falling drop gathers light from a wide field behind it (Garg and Nayar 2007), and a flake from all sides, so all that are
//! near each other have the brightness of paths through a few. Those too far away to be told apart are part of the air.

use glam::{DVec2, DVec3, IVec3, Vec3};
use rayon::prelude::*;
use trove_model::{Form, Precipitation, Raster, Seed, Shot};

use super::integrate::{Cone, Path};
use super::wave::Wave;
use crate::PreparedScene;
use crate::accel::{Coherence, PACKET};
use crate::motion::MIDDLE;
use crate::ray::Ray;
use crate::sampling::{Basis, Sampler, disk};

/// Smaller ones are too many and cover too little.
const SMALLEST_M: f64 = 0.5e-3;
/// Farther ones are in the air, and nearer ones too blurred.
const REACH_M: [f64; 2] = [0.3, 15.0];
/// Streaks that cover less of their pixels are not seen.
const LEAST_COVER: f64 = 0.002;
/// Opening of a car's camera, whose focus is far away.
pub(crate) const APERTURE_M: f64 = 3e-3;
/// What a picture that is taken in an instant takes it for.
const EXPOSURE_S: f64 = 1.0 / 250.0;
/// Side of the cubes in which they are counted.
const CELL_M: f64 = 1.0;
/// Places in the picture where their brightness is told, and paths at each.
const NODES: [u32; 2] = [24, 14];
const PATHS: u32 = 64;
/// Distance at which it is.
const TYPICAL_M: f32 = 3.0;
/// Refractive index of water.
pub(crate) const WATER: f32 = 1.333;

/// What one of them draws.
struct Streak {
    ends_px: [DVec2; 2],
    width_px: f64,
    /// Pixels that it would cover if it stood.
    area_px: f64,
    /// Depth along the camera's axis; less than 0 behind a fisheye.
    depth_m: f32,
    place: Vec3,
}

/// Draws what falls before a shot's camera into its picture.
pub(crate) fn draw(
    scene: &PreparedScene,
    shot: &Shot,
    falling: Precipitation,
    depth_m: &Raster<f32>,
    picture: &mut Raster<[f32; 3]>,
) {
    let cover = cover(&in_the_open(scene, streaks(shot, falling)), depth_m);
    let light = light(scene, shot, falling.form, depth_m);
    let (width, height) = (f64::from(picture.width), f64::from(picture.height));
    let pixel = |(i, rgb): (usize, &mut [f32; 3])| {
        let share = cover.data[i];
        if share > 0.0 {
            let (x, y) = (i as u32 % cover.width, i as u32 / cover.width);
            let at = DVec2::new((f64::from(x) + 0.5) / width, (f64::from(y) + 0.5) / height);
            *rgb = Vec3::from_array(*rgb).lerp(between(&light, at), share).to_array();
        }
    };
    picture.data.par_iter_mut().enumerate().for_each(pixel);
}

/// All of them, sheltered or not.
fn streaks(shot: &Shot, falling: Precipitation) -> Vec<Streak> {
    let eye = shot.world_from_camera.translation;
    let around = (REACH_M[1] / CELL_M).ceil() as i32;
    let middle = (eye / CELL_M).floor().as_ivec3();
    let field_rad = field_rad(shot);
    let seed = Seed(shot.time_ns as u64).child("rain");
    let rows = -around..=around;
    let cells: Vec<IVec3> = rows
        .clone()
        .flat_map(|z| rows.clone().map(move |y| (y, z)))
        .flat_map(|(y, z)| rows.clone().map(move |x| IVec3::new(x, y, z)))
        .collect();
    let in_cell = |cell: &IVec3| -> Vec<Streak> {
        let cell = middle + *cell;
        if !may_be_seen(shot, field_rad, (cell.as_dvec3() + 0.5) * CELL_M) {
            return Vec::new();
        }
        let mut random = cell.to_array().into_iter().fold(seed, |seed, part| seed.nth(part as u64)).random();
        let mean = falling.pieces_per_m3(SMALLEST_M) * CELL_M.powi(3);
        let count = (mean + random.unit()) as usize;
        let mut piece = || {
            let place = DVec3::new(random.unit(), random.unit(), random.unit());
            let diameter_m = falling.diameter_m(SMALLEST_M, random.unit());
            streak(shot, (cell.as_dvec3() + place) * CELL_M, diameter_m, falling.speed_mps(diameter_m))
        };
        (0..count).filter_map(|_| piece()).collect()
    };
    cells.par_iter().flat_map_iter(in_cell).collect()
}

/// Those of them that have nothing above them.
fn in_the_open(scene: &PreparedScene, streaks: Vec<Streak>) -> Vec<Streak> {
    let is_open = |group: &[Streak]| {
        let mut rays = [Ray::new(Vec3::ZERO, Vec3::Z); PACKET];
        rays.iter_mut()
            .zip(group)
            .for_each(|(ray, streak)| *ray = Ray { time: MIDDLE, ..Ray::new(streak.place, Vec3::Z) });
        let mut light = [Vec3::ONE; PACKET];
        scene.any(&rays[..group.len()], Coherence::Coherent, &mut light[..group.len()]);
        light.map(|light| light.min_element() > 0.5)
    };
    let open: Vec<bool> =
        streaks.par_chunks(PACKET).flat_map_iter(|group| is_open(group).into_iter().take(group.len())).collect();
    streaks.into_iter().zip(open).filter_map(|(streak, is_open)| is_open.then_some(streak)).collect()
}

/// Whether anything within a cell's reach of its middle may be in the picture.
fn may_be_seen(shot: &Shot, field_rad: f64, middle: DVec3) -> bool {
    let point = shot.world_from_camera.inverse().point(middle);
    let (distance_m, half_m) = (point.length(), CELL_M * 0.9);
    if distance_m > REACH_M[1] + half_m {
        return false;
    }
    if distance_m < 2.0 * half_m {
        return true;
    }
    point.angle_between(DVec3::Z) < field_rad + (half_m / distance_m).asin()
}

/// The widest angle to its axis at which a camera sees, by its picture's corners and the middles of its sides.
pub(crate) fn field_rad(shot: &Shot) -> f64 {
    let (width, height) = (f64::from(shot.lens.width_px), f64::from(shot.lens.height_px));
    let rim = (0..9).map(|i| DVec2::new(width * f64::from(i % 3) / 2.0, height * f64::from(i / 3) / 2.0));
    let angle = |pixel| {
        shot.lens.unproject(pixel).map_or(std::f64::consts::PI, |direction| direction.z.clamp(-1.0, 1.0).acos())
    };
    rim.map(angle).fold(0.0, f64::max)
}

/// What is drawn by what falls through a place in World in the exposure's middle; `None` where it is hardly seen.
fn streak(shot: &Shot, place: DVec3, diameter_m: f64, speed_mps: f64) -> Option<Streak> {
    let point = shot.world_from_camera.inverse().point(place);
    let distance_m = point.length();
    if !(REACH_M[0]..=REACH_M[1]).contains(&distance_m) {
        return None;
    }
    let pixel_rad = shot.lens.pixel_rad(point / distance_m);
    let to_px = 1.0 / (distance_m * pixel_rad);
    let area_px = std::f64::consts::FRAC_PI_4 * (diameter_m * to_px).powi(2);
    let width_px = ((diameter_m + APERTURE_M) * to_px).max(1.0);
    let exposure_s = if shot.shutter.exposure_s > 0.0 { shot.shutter.exposure_s } else { EXPOSURE_S };
    let falls_mps = DVec3::NEG_Z * speed_mps;
    let middle_px = shot.lens.project(point).filter(|pixel| shot.lens.contains(*pixel))?;
    let row = middle_px.y / f64::from(shot.lens.height_px);
    let ends_px = [0.0, 1.0].map(|within| {
        let after_s = shot.shutter.time_s(row, 0.5) + (within - 0.5) * exposure_s;
        shot.lens.project(shot.world_from_camera_at(after_s).inverse().point(place + falls_mps * after_s))
    });
    let [Some(from), Some(to)] = ends_px else { return None };
    let cover = area_px / (width_px * (width_px + from.distance(to)));
    (cover > LEAST_COVER).then(|| Streak {
        ends_px: [from, to],
        width_px,
        area_px,
        depth_m: point.z as f32,
        place: place.as_vec3(),
    })
}

/// Share of each pixel's light that streaks before what it shows take the place of.
fn cover(streaks: &[Streak], depth_m: &Raster<f32>) -> Raster<f32> {
    let mut cover = depth_m.map(|_| 0.0f32);
    for Streak { ends_px: [from, to], width_px, area_px, depth_m: own_m, .. } in streaks {
        let steps = (2.0 * from.distance(*to) / width_px).ceil().max(1.0);
        let radius = width_px / 2.0 + 0.5;
        // A soft disc of this radius has so many pixels.
        let whole = std::f64::consts::PI * (radius * radius - radius + 1.0 / 3.0);
        let share = (area_px / steps / whole) as f32;
        for step in 0..steps as u32 {
            let middle = from.lerp(*to, (f64::from(step) + 0.5) / steps);
            let [low, high] = [middle - radius, middle + radius].map(|p| p.floor().as_ivec2());
            for y in low.y.max(0)..=high.y.min(cover.height as i32 - 1) {
                for x in low.x.max(0)..=high.x.min(cover.width as i32 - 1) {
                    let away = middle.distance(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
                    let (x, y) = (x as u32, y as u32);
                    if away < radius && depth_m.at(x, y).abs() > own_m.abs() {
                        let pixel = cover.at_mut(x, y);
                        *pixel += (1.0 - *pixel) * share * (radius - away).min(1.0) as f32;
                    }
                }
            }
        }
    }
    cover
}

/// Radiance of what falls across the picture, row by row.
fn light(scene: &PreparedScene, shot: &Shot, form: Form, depth_m: &Raster<f32>) -> Vec<Vec3> {
    let seed = shot.seed.child("rain");
    let node = |i: u32| {
        let [x, y] = [i % NODES[0], i / NODES[0]];
        let at = |k: u32, n: u32, size: u32| (f64::from(k) + 0.5) / f64::from(n) * f64::from(size);
        let pixel = DVec2::new(at(x, NODES[0], shot.lens.width_px), at(y, NODES[1], shot.lens.height_px));
        let Some(direction) = shot.lens.unproject(pixel) else { return Vec3::ZERO };
        let free_m = *depth_m.at(pixel.x as u32, pixel.y as u32) / direction.z.max(0.05) as f32;
        let towards = shot.world_from_camera.vector(direction).as_vec3();
        let origin = shot.world_from_camera.translation.as_vec3() + towards * TYPICAL_M.min(0.8 * free_m);
        let mut wave = Wave::default();
        for k in 0..PATHS {
            let mut sampler = Sampler::new(seed, [x, y], k, PATHS.ilog2());
            let (onwards, which) = (sampler.next2(), sampler.next2());
            let from = match form {
                Form::Rain => through_drop(towards, onwards, which[0]),
                Form::Snow => anywhere(onwards),
            };
            let ray = Ray::new(origin, from);
            wave.paths.push(Path::new(ray, Cone { width_m: 0.0, spread_rad: 0.05 }, sampler));
        }
        wave.run(scene);
        wave.paths.iter().map(|path| path.sample().radiance).sum::<Vec3>() / PATHS as f32
    };
    (0..NODES[0] * NODES[1]).into_par_iter().map(node).collect()
}

/// Where a ray comes from that leaves a round drop against a direction: reflected at its front or refracted twice.
fn through_drop(direction: Vec3, u: [f32; 2], which: f32) -> Vec3 {
    let [x, y] = disk(u);
    let sin = (x * x + y * y).sqrt().min(0.9999);
    let (into, inside) = (sin.asin(), (sin / WATER).asin());
    let reflected = reflectance(sin);
    let turned = if which < reflected { std::f32::consts::PI - 2.0 * into } else { 2.0 * (into - inside) };
    // Reflected away from the drop's middle, refracted towards it.
    let outwards = Basis::about(direction).to_world(Vec3::new(x, y, 0.0) / sin.max(1e-6));
    let side = if which < reflected { outwards } else { -outwards };
    (direction * turned.cos() + side * turned.sin()).normalize()
}

/// What the surface between air and water reflects of light whose way makes an angle with its normal in air, given the sine
/// (Fresnel, unpolarised).
pub(crate) fn reflectance(sin: f32) -> f32 {
    let (into, inside) = (sin.asin(), (sin / WATER).asin());
    let (s, p) = (into - inside, into + inside);
    if sin < 1e-3 {
        ((WATER - 1.0) / (WATER + 1.0)).powi(2)
    } else {
        0.5 * ((s.sin() / p.sin()).powi(2) + (s.tan() / p.tan()).powi(2))
    }
}

/// Where a ray comes from that a flake scatters: from all sides alike.
fn anywhere(u: [f32; 2]) -> Vec3 {
    let (z, turn) = (1.0 - 2.0 * u[0], std::f32::consts::TAU * u[1]);
    (Vec3::new(turn.cos(), turn.sin(), 0.0) * (1.0 - z * z).max(0.0).sqrt()).with_z(z)
}

/// The brightness at a place in the picture, 0 to 1 from its upper left corner.
fn between(light: &[Vec3], at: DVec2) -> Vec3 {
    let place = |c: f64, n: u32| (c * f64::from(n) - 0.5).clamp(0.0, f64::from(n - 1));
    let (x, y) = (place(at.x, NODES[0]), place(at.y, NODES[1]));
    let node = |x: f64, y: f64| {
        light[(y.min(f64::from(NODES[1] - 1)) as u32 * NODES[0] + x.min(f64::from(NODES[0] - 1)) as u32) as usize]
    };
    let (right, down) = ((x - x.floor()) as f32, (y - y.floor()) as f32);
    let upper = node(x, y).lerp(node(x + 1.0, y), right);
    upper.lerp(node(x, y + 1.0).lerp(node(x + 1.0, y + 1.0), right), down)
}

#[cfg(test)]
mod tests {
    use trove_model::{Distortion, Lens, Pose};

    use super::*;

    /// A camera that looks along y.
    fn shot() -> Shot {
        let lens = Lens {
            width_px: 400,
            height_px: 300,
            fx_px: 320.0,
            fy_px: 320.0,
            cx_px: 200.0,
            cy_px: 150.0,
            distortion: Distortion::None,
        };
        let north = glam::DQuat::from_mat3(&glam::DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y));
        Shot::new("test", lens, Pose::new(north, DVec3::Z * 2.0))
    }

    #[test]
    fn a_drop_draws_a_streak_as_long_as_it_falls_and_covers_as_much_as_its_disc() {
        let (shot, diameter_m, ahead_m) = (shot(), 3e-3, 1.5);
        let streak = streak(&shot, DVec3::new(0.1, ahead_m, 2.0), diameter_m, 8.0).unwrap();
        let [from, to] = streak.ends_px;
        let length_px = 8.0 * EXPOSURE_S * 320.0 / ahead_m;
        assert!((to - from - DVec2::Y * length_px).length() < 0.05, "{from} {to} {length_px}");
        let far = Raster::filled(400, 300, f32::INFINITY);
        let covered: f32 = cover(std::slice::from_ref(&streak), &far).data.iter().sum();
        let disc_px = std::f64::consts::FRAC_PI_4 * (diameter_m * 320.0 / ahead_m).powi(2);
        assert!((f64::from(covered) / disc_px - 1.0).abs() < 0.05, "{covered} {disc_px}");
        let near = Raster::filled(400, 300, 1.0);
        assert!(cover(&[streak], &near).data.iter().all(|share| *share == 0.0));
    }

    #[test]
    fn drops_cover_as_much_of_the_picture_as_the_rain_has_of_them() {
        // Of drops that are seen as large as these, hardly any are left out as too small.
        let shot = Shot { shutter: trove_model::Shutter { exposure_s: 1e-4, readout_s: 0.0 }, ..shot() };
        let rain = Precipitation { form: Form::Rain, rate_mm_h: 20.0 };
        let far = Raster::filled(400, 300, f32::INFINITY);
        let streaks: Vec<Streak> = (0..6)
            .flat_map(|i| streaks(&Shot { time_ns: i, ..shot.clone() }, rain))
            .filter(|streak| streak.depth_m < 4.0)
            .collect();
        let covered: f64 = cover(&streaks, &far).data.iter().map(|share| f64::from(*share)).sum::<f64>() / 6.0;
        let second_moment = |d_mm: f64| d_mm * d_mm * (-4.1 * 20.0f64.powf(-0.21) * d_mm).exp() * 1e-6;
        let steps = 10_000;
        let per_m: f64 =
            (0..steps).map(|i| second_moment(0.5 + 7.5 * (f64::from(i) + 0.5) / f64::from(steps))).sum::<f64>()
                * 8000.0
                * 7.5
                / f64::from(steps)
                * std::f64::consts::FRAC_PI_4;
        let expected = per_m * (4.0 - REACH_M[0]) * 400.0 * 300.0;
        assert!((covered / expected - 1.0).abs() < 0.1, "{covered} {expected}");
    }

    #[test]
    fn a_drop_bends_light_as_a_ball_of_water_does() {
        // Geometric optics without diffraction: a mean cosine of 0.77 (half of 0.885 that both have together).
        let (side, mut sum) = (200, 0.0);
        for i in 0..side * side {
            let u = [(i % side) as f32 + 0.5, (i / side) as f32 + 0.5].map(|u| u / side as f32);
            let on = through_drop(Vec3::Y, u, (i as f32 * 0.618_034).fract());
            assert!(on.is_normalized());
            sum += on.dot(Vec3::Y);
        }
        let mean = sum / (side * side) as f32;
        assert!((0.72..0.84).contains(&mean), "{mean}");
    }
}
